/* Reading MCAP: any file, whole or cut off, with or without a summary. */
#ifndef RLF_IO_MCAP_READ_H
#define RLF_IO_MCAP_READ_H

#include "io/clip/clip.h"
#include "io/file.h"
#include "io/mcap/format.h"
#include "io/ros/messages.h"

#define IO_MCAP_TOPIC_MAX 256
#define IO_MCAP_CHANNELS_READ_MAX 512 /* of the types looked for */
/* No chunk larger than this is read: it is what bounds the memory. */
#define IO_MCAP_CHUNK_MAX ((uint64_t)256 << 20)
/* No more messages than this are listed: three days of a camera's pictures. */
#define IO_MCAP_MESSAGES_MAX (1 << 24)

/* A stream of messages of a type that is looked for. */
typedef struct io_mcap_channel {
    uint16_t id;
    io_ros_type type;
    char topic[IO_MCAP_TOPIC_MAX];
    int32_t first, count; /* of its messages, in order of log time */
} io_mcap_channel;

typedef struct io_mcap_message {
    int64_t time_ns; /* log time */
    uint64_t offset; /* of the record, in the chunk or in the file */
    int32_t chunk;   /* -1 = in none */
    int32_t channel;
} io_mcap_message;

typedef struct io_mcap_reader io_mcap_reader;

/* Opens and lists what is there. A file that was not closed, or whose summary is damaged, is
 * scanned, with a warning. */
rlf_result io_mcap_reader_open(const char *path, io_mcap_reader **out);
void io_mcap_reader_close(io_mcap_reader **reader);

int32_t io_mcap_channel_count(const io_mcap_reader *reader);
const io_mcap_channel *io_mcap_channel_at(const io_mcap_reader *reader, int32_t index);
const io_mcap_message *io_mcap_message_at(const io_mcap_reader *reader, int32_t index);
/* Content of a message, valid until the next call. RLF_ERROR_FORMAT when its chunk is damaged. */
rlf_result io_mcap_read(io_mcap_reader *reader, int32_t index, io_cdr_reader *out);
/* Topics of pictures in messages that are not read, as text; "" = none. */
const char *io_mcap_strangers(const io_mcap_reader *reader);
/* Value of a key of the Metadata record "relief", or NULL. */
const char *io_mcap_metadata(const io_mcap_reader *reader, const char *key);

/* ---- What the parts of the reader share ---- */

/* A list that grows; `size` of an item is given with every call. */
typedef struct io_mcap_list {
    void *items;
    int32_t count, capacity;
} io_mcap_list;

/* Room for one more at the end (then counted), or NULL. */
void *io_mcap_list_add(io_mcap_list *list, size_t size);

typedef struct io_mcap_schema {
    uint16_t id;
    io_ros_type type;
    char name[64]; /* of type IO_ROS_OTHER: of pictures that are not read */
} io_mcap_schema;

typedef struct io_mcap_chunk {
    uint64_t offset; /* of the record */
    bool is_bad;     /* and was told */
} io_mcap_chunk;

/* Two, since the depth and the colour of a frame may lie in neighbours. */
#define IO_MCAP_CACHED 2

typedef struct io_mcap_cached {
    int32_t chunk; /* -1 = none */
    uint64_t used; /* when, in calls */
    io_buffer buffer;
    size_t size;
} io_mcap_cached;

#define IO_MCAP_METADATA_MAX 8192

struct io_mcap_reader {
    io_file file;
    uint64_t size; /* of the file */
    io_mcap_compressor *compressor;
    io_mcap_list schemas, channels, chunks, messages;
    io_buffer packed; /* a chunk before it is decompressed, a summary, a block of indexes */
    io_buffer loose;  /* a message outside chunks */
    io_buffer plain;  /* a message that was compressed by itself */
    io_mcap_cached cache[IO_MCAP_CACHED];
    uint64_t calls;
    int32_t bad_chunks;
    bool lists_all;                      /* Statistics: as many messages as there are */
    bool is_to_end;                      /* a walk came to the end of the data */
    bool is_full;                        /* more messages than are listed */
    bool lacks_memory;                   /* a list could not grow */
    char strangers[512];                 /* topics of pictures that are not read */
    char metadata[IO_MCAP_METADATA_MAX]; /* key, 0, value, 0, ..., 0 */
};

/* Bytes of the file; false when they are not all there. */
bool io_mcap_read_at(const io_mcap_reader *reader, uint64_t offset, void *out, size_t size);
/* The same into a buffer of the reader. */
rlf_result io_mcap_read_block(const io_mcap_reader *reader, uint64_t offset, uint64_t size,
                              io_buffer *buffer);

/* -1 = none of that id. */
int32_t io_mcap_find_channel(const io_mcap_reader *reader, uint16_t id);

/* Brings the messages into order: by channel, then by time. */
void io_mcap_sort(io_mcap_reader *reader);

/* Records that say what is in the file; others are passed over. `chunk` -1: in the file itself. */
void io_mcap_take_schema(io_mcap_reader *reader, io_mcap_cursor record);
void io_mcap_take_channel(io_mcap_reader *reader, io_mcap_cursor record);
void io_mcap_take_metadata(io_mcap_reader *reader, io_mcap_cursor record);
void io_mcap_list_message(io_mcap_reader *reader, uint16_t channel_id, uint64_t time, int32_t chunk,
                          uint64_t offset);

/* Chunk `index` decompressed and checked; NULL when it is damaged, which is told once for all. */
const io_mcap_cached *io_mcap_load_chunk(io_mcap_reader *reader, int32_t index);
/* Lists what is in a chunk by looking into it. */
void io_mcap_walk_chunk(io_mcap_reader *reader, int32_t index);

typedef enum io_mcap_summary {
    IO_MCAP_SUMMARY_READ = 0,
    IO_MCAP_SUMMARY_NONE,      /* closed, and without an index of its chunks, as it may be */
    IO_MCAP_SUMMARY_DAMAGED,   /* closed, but what it says is not to be trusted */
    IO_MCAP_SUMMARY_NOT_CLOSED /* the end is not that of an MCAP file */
} io_mcap_summary;

/* Lists the file from its summary, with the messages that are in no chunk. */
io_mcap_summary io_mcap_read_summary(io_mcap_reader *reader);
/* Lists the file from its beginning, up to *out_end. False when it does not begin as one. */
bool io_mcap_scan(io_mcap_reader *reader, uint64_t *out_end);

#endif
