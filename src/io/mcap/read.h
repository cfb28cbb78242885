/* Reading MCAP: any file, whole or cut off, with or without a summary. */
#ifndef RLF_IO_MCAP_READ_H
#define RLF_IO_MCAP_READ_H

#include "io/mcap/format.h"
#include "io/ros/log.h"

typedef struct io_mcap_reader io_mcap_reader;

/* Opens, and lists what is there in the log, whose name is set. A file that was not closed, or is
 * damaged, is listed as far as it is whole, with a warning. */
rlf_result io_mcap_reader_open(const char *path, io_ros_log *log, io_mcap_reader **out);
void io_mcap_reader_close(io_mcap_reader **reader);

/* Value of a key of the Metadata record "relief", or NULL. */
const char *io_mcap_metadata(const io_mcap_reader *reader, const char *key);

/* ---- What the parts of the reader share ---- */

typedef struct io_mcap_schema {
    uint16_t id;
    io_ros_type type;
    char name[64]; /* of type IO_ROS_OTHER: of pictures that are not read */
} io_mcap_schema;

typedef struct io_mcap_chunk {
    uint64_t offset;                 /* of the record */
    uint64_t index_begin, index_end; /* the index records behind it; the same = none */
    bool is_bad;                     /* and was told */
} io_mcap_chunk;

#define IO_MCAP_METADATA_MAX 8192

struct io_mcap_reader {
    io_file file;
    io_ros_log *log;
    io_mcap_schema *schemas;
    io_mcap_chunk *chunks;
    int32_t schema_count, schema_room, chunk_count, chunk_room, bad_chunks;
    io_ros_cache cache;
    io_buffer packed; /* a chunk before it is decompressed, a record of the file */
    io_buffer loose;  /* a message outside chunks */
    io_buffer plain;  /* a message that was compressed by itself */
    char metadata[IO_MCAP_METADATA_MAX]; /* key, 0, value, 0, ..., 0 */
};

/* Bytes of the file; false when they are not all there. */
bool io_mcap_read_at(const io_mcap_reader *reader, uint64_t offset, void *out, size_t size);
/* The same into a buffer of the reader. */
rlf_result io_mcap_read_block(const io_mcap_reader *reader, uint64_t offset, uint64_t size,
                              io_buffer *buffer);

/* Chunk `index` decompressed and checked; false when it is damaged, which is told once for all. */
bool io_mcap_load_chunk(io_mcap_reader *reader, int32_t index, cursor *out);

/* A log's `read`. RLF_ERROR_FORMAT when its chunk is damaged. */
rlf_result io_mcap_message(void *reader, const io_ros_message *message, io_cdr_reader *out);

#endif
