/* Compression of chunks. */
#ifndef RLF_IO_MCAP_COMPRESS_H
#define RLF_IO_MCAP_COMPRESS_H

#include "io/codec/byte_buffer.h"
#include "io/mcap/format.h"

/* Work memory of zstd and lz4. One thread at a time. */
typedef struct io_mcap_compressor io_mcap_compressor;

rlf_result io_mcap_compressor_create(io_mcap_compressor **out);
void io_mcap_compressor_destroy(io_mcap_compressor **compressor);

/* As the file format calls it: "zstd", "lz4" or "". */
const char *io_mcap_compression_name(io_mcap_compression compression);
/* False for a name that this build does not know. */
bool io_mcap_compression_parse(const io_mcap_cursor *name, io_mcap_compression *out);

/* What a frame of zstd says that it unpacks to; 0 = it is none, or does not say. */
uint64_t io_mcap_zstd_size(const uint8_t *data, size_t size);

/* Appends the compressed bytes. */
rlf_result io_mcap_compress(io_mcap_compressor *compressor, io_mcap_compression compression,
                            const uint8_t *data, size_t size, io_byte_buffer *out);
/* Whether `size` bytes could be that many once decompressed, as far as their head tells: asked
 * before memory is taken for them. */
bool io_mcap_can_become(io_mcap_compression compression, const uint8_t *data, size_t size,
                        uint64_t out_size);
/* Fills all of `out`; false when the bytes are damaged or are not exactly so many. */
bool io_mcap_decompress(io_mcap_compressor *compressor, io_mcap_compression compression,
                        const uint8_t *data, size_t size, uint8_t *out, size_t out_size);

#endif
