/* Writing MCAP: messages gather in a chunk; a chunk is written whole, with its indexes, and reaches
 * the disk before the next one begins. What is on the disk is readable at any moment. */
#ifndef RLF_IO_MCAP_WRITE_H
#define RLF_IO_MCAP_WRITE_H

#include "io/file.h"
#include "io/mcap/format.h"
#include "io/picture/picture.h"

#define IO_MCAP_CHANNELS_MAX 16 /* and schemas */

typedef struct io_mcap_writer io_mcap_writer;

/* A pair of a Metadata record. */
typedef struct io_mcap_pair {
    const char *key;
    const char *value;
} io_mcap_pair;

typedef struct io_mcap_written {
    uint64_t bytes, messages, chunks;
    uint64_t of_channel[IO_MCAP_CHANNELS_MAX]; /* messages; that of id 1 first */
} io_mcap_written;

/* Makes the file, or replaces what is there. */
rlf_result io_mcap_writer_create(const char *path, io_packing packing, io_mcap_writer **out);

/* Before the first message. Ids count from 1; a channel has the schema added last. */
void io_mcap_add_schema(io_mcap_writer *writer, const char *name, const char *text);
uint16_t io_mcap_add_channel(io_mcap_writer *writer, const char *topic, const char *qos);
void io_mcap_add_metadata(io_mcap_writer *writer, const char *name, const io_mcap_pair *pairs,
                          size_t count);

/* Begins a message; its content is to be appended to the buffer that this returns. */
io_byte_buffer *io_mcap_begin(io_mcap_writer *writer, uint16_t channel, int64_t time_ns);
/* Ends the message; false given: takes it back. */
void io_mcap_end(io_mcap_writer *writer, bool is_good);
/* Bytes of the chunk that is being gathered. */
size_t io_mcap_gathered(const io_mcap_writer *writer);
/* Writes the chunk and waits until the disk has it, unless that was done just before. */
rlf_result io_mcap_flush(io_mcap_writer *writer);

/* Writes what is gathered, and the summary. When the disk is full what was written before is kept
 * and made a whole file; the error says so. The pointer is nulled even then. */
rlf_result io_mcap_writer_close(io_mcap_writer **writer, io_mcap_written *out);

/* Appends the packed bytes. */
rlf_result io_mcap_compress(io_packing packing, const uint8_t *data, size_t size,
                            io_byte_buffer *out);

/* ---- What the parts of the MCAP writer share ---- */

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
    io_packing packing;
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
