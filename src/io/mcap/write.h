/* Writing MCAP: messages gather in a chunk; a chunk is written whole, with its indexes, and reaches
 * the disk before the next one begins. What is on the disk is readable at any moment. */
#ifndef RLF_IO_MCAP_WRITE_H
#define RLF_IO_MCAP_WRITE_H

#include "io/codec/byte_buffer.h"
#include "io/mcap/format.h"

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
rlf_result io_mcap_writer_create(const char *path, io_mcap_compression compression,
                                 io_mcap_writer **out);

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

#endif
