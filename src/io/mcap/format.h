/* What MCAP files consist of: https://mcap.dev/spec (version 0). */
#ifndef RLF_IO_MCAP_FORMAT_H
#define RLF_IO_MCAP_FORMAT_H

#include "io/picture/picture.h"
#include "relief/base.h"

#include <string.h>

#define IO_MCAP_MAGIC_SIZE 8
extern const uint8_t io_mcap_magic[IO_MCAP_MAGIC_SIZE];

typedef enum io_mcap_op {
    IO_MCAP_HEADER = 0x01,
    IO_MCAP_FOOTER = 0x02,
    IO_MCAP_SCHEMA = 0x03,
    IO_MCAP_CHANNEL = 0x04,
    IO_MCAP_MESSAGE = 0x05,
    IO_MCAP_CHUNK = 0x06,
    IO_MCAP_MESSAGE_INDEX = 0x07,
    IO_MCAP_CHUNK_INDEX = 0x08,
    IO_MCAP_STATISTICS = 0x0B,
    IO_MCAP_METADATA = 0x0C,
    IO_MCAP_METADATA_INDEX = 0x0D,
    IO_MCAP_SUMMARY_OFFSET = 0x0E,
    IO_MCAP_DATA_END = 0x0F
} io_mcap_op;

#define IO_MCAP_RECORD_HEAD 9   /* opcode and length */
#define IO_MCAP_MESSAGE_HEAD 22 /* channel, sequence and two times */
#define IO_MCAP_FOOTER_SIZE (IO_MCAP_RECORD_HEAD + 20)

typedef enum io_mcap_compression {
    IO_MCAP_PLAIN = 0,
    IO_MCAP_ZSTD = 1,
    IO_MCAP_LZ4 = 2
} io_mcap_compression;

/* Bytes that are taken apart from the front. Past their end everything is 0 and `is_bad` is set. */
typedef struct io_mcap_cursor {
    const uint8_t *data;
    size_t size; /* left */
    bool is_bad;
} io_mcap_cursor;

/* `size` bytes, or NULL. */
static inline const uint8_t *io_mcap_take(io_mcap_cursor *c, uint64_t size)
{
    if (c->is_bad || size > c->size) {
        c->is_bad = true;
        return NULL;
    }
    const uint8_t *data = c->data;
    c->data += size;
    c->size -= (size_t)size;
    return data;
}

static inline uint64_t io_mcap_take_number(io_mcap_cursor *c, size_t size)
{
    uint64_t value = 0;
    const uint8_t *data = io_mcap_take(c, size);
    if (data != NULL) {
        for (size_t i = 0; i < size; i++) {
            value |= (uint64_t)data[i] << 8 * i;
        }
    }
    return value;
}

/* A string or a map with its length of 4 bytes in front. */
static inline io_mcap_cursor io_mcap_take_block(io_mcap_cursor *c)
{
    const uint64_t size = io_mcap_take_number(c, 4);
    const uint8_t *data = io_mcap_take(c, size);
    return (io_mcap_cursor){data, data != NULL ? (size_t)size : 0, data == NULL};
}

/* One record: its opcode, and what it holds; 0 at the end, or when the rest is none. */
static inline uint8_t io_mcap_take_record(io_mcap_cursor *c, io_mcap_cursor *out)
{
    if (c->size == 0) {
        return 0;
    }
    const uint8_t op = (uint8_t)io_mcap_take_number(c, 1);
    const uint64_t size = io_mcap_take_number(c, 8);
    const uint8_t *data = io_mcap_take(c, size);
    *out = (io_mcap_cursor){data, data != NULL ? (size_t)size : 0, data == NULL};
    return data != NULL ? op : 0;
}

static inline bool io_mcap_equals(const io_mcap_cursor *block, const char *text)
{
    return block->size == strlen(text) && memcmp(block->data, text, block->size) == 0;
}

/* Copy of a string as text, cut to what fits. */
static inline void io_mcap_copy(const io_mcap_cursor *block, char *out, size_t size)
{
    const size_t length = block->size < size - 1 ? block->size : size - 1;
    if (length > 0) {
        memcpy(out, block->data, length);
    }
    out[length] = '\0';
}

/* ---- Compression of chunks ---- */

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

/* ---- Names in Relief's own recordings ---- */

#define IO_TOPIC_DEPTH_RVL "/relief/depth/image_raw/compressedDepth"
#define IO_TOPIC_DEPTH_RAW "/relief/depth/image_raw"
#define IO_TOPIC_DEPTH_INFO "/relief/depth/camera_info"
#define IO_TOPIC_COLOR "/relief/color/image_raw/compressed"
#define IO_TOPIC_COLOR_INFO "/relief/color/camera_info"
#define IO_TOPIC_POSE "/relief/pose"

#define IO_TOPIC_FRAME "/relief/frame"

#define IO_FRAME_DEPTH "relief_depth_optical_frame"
#define IO_FRAME_COLOR "relief_color_optical_frame"
#define IO_FRAME_WORLD "relief_world"

/* Keys of the Metadata record "relief": what ROS 2 has no message for. */
#define IO_KEY_UNITS "units_per_metre"
#define IO_KEY_DEPTH_MIN "depth_min_m"
#define IO_KEY_DEPTH_MAX "depth_max_m"
#define IO_KEY_NOISE_0 "noise_c0"
#define IO_KEY_NOISE_1 "noise_c1"
#define IO_KEY_NOISE_2 "noise_c2"
#define IO_KEY_FLAGS "frame_flags"
#define IO_KEY_SOURCE "source"
#define IO_KEY_DEVICE "device"
#define IO_KEY_GRAVITY "gravity_m_s2" /* "X Y Z" */
#define IO_KEY_SIMULATED "is_simulated"
#define IO_KEY_RATE "frames_per_second"
#define IO_KEY_NOTES "frame_notes" /* there are: what is not noted of a frame is as usual */
#define IO_KEY_UNIX_OFFSET "unix_minus_stamp_ns"

#endif
