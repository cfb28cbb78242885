/* What the parts of the MCAP writer share. */
#ifndef RLF_IO_MCAP_WRITER_H
#define RLF_IO_MCAP_WRITER_H

#include "io/file.h"
#include "io/mcap/compress.h"
#include "io/mcap/write.h"

/* What the index says about a chunk, and how the file stood behind it. */
typedef struct chunk_entry {
    uint64_t begin, length, index_length;
    int64_t first_ns, last_ns;
    uint64_t compressed, plain;
    uint64_t index_at[IO_MCAP_CHANNELS_MAX]; /* 0 = none */
    uint32_t messages[IO_MCAP_CHANNELS_MAX];
    uint32_t crc; /* of the file up to its end */
} chunk_entry;

struct io_mcap_writer {
    char path[IO_PATH_MAX];
    int file;
    uint64_t size; /* of what is whole on the disk */
    uint32_t crc;
    int write_errno; /* of the first write that failed; 0 = none */
    io_mcap_compression compression;
    io_mcap_compressor *compressor;
    io_byte_buffer head; /* schemas, channels, metadata, until the first chunk takes them */
    io_byte_buffer schemas, channels, metadata;
    uint16_t schema_count, channel_count;
    uint32_t metadata_count;
    io_byte_buffer chunk;                       /* the records gathered */
    io_byte_buffer index[IO_MCAP_CHANNELS_MAX]; /* their times and places */
    uint32_t sequence[IO_MCAP_CHANNELS_MAX];
    int64_t first_ns, last_ns; /* of them */
    size_t message_at;         /* where the message being written begins */
    uint16_t message_channel;
    int64_t message_ns;
    int64_t synced_ns; /* when the disk was last waited for */
    io_byte_buffer out;
    io_byte_buffer entries; /* chunk_entry */
};

size_t io_mcap_begin_record(io_byte_buffer *buffer, io_mcap_op op);
void io_mcap_end_record(io_byte_buffer *buffer, size_t begin);
void io_mcap_set_u64(io_byte_buffer *buffer, size_t at, uint64_t value);
void io_mcap_put_text(io_byte_buffer *buffer, const char *text);

/* All of it, or nothing: a half is cut off again, and write_errno set. */
bool io_mcap_append(io_mcap_writer *writer, const io_byte_buffer *bytes);
/* The error line for write_errno. */
rlf_result io_mcap_fail_write(const io_mcap_writer *writer);
/* Closes the file. */
void io_mcap_free_writer(io_mcap_writer *writer);

#endif
