/* A file of messages, of ROS 1 or 2: what its topics are, and where each message lies. */
#ifndef RLF_IO_ROS_LOG_H
#define RLF_IO_ROS_LOG_H

#include "io/file.h"
#include "io/ros/messages.h"

#define IO_ROS_TOPIC_MAX 256

/* A topic of a type that is read. Its messages are first .. first + count - 1, by their times. */
typedef struct io_ros_channel {
    uint32_t id; /* the file's */
    io_ros_type type;
    char topic[IO_ROS_TOPIC_MAX];
    int32_t limit; /* so many messages are listed */
    int32_t first, count;
} io_ros_channel;

/* Where a message is. */
typedef struct io_ros_message {
    int64_t time_ns; /* when it was recorded */
    uint64_t offset; /* of its record, in the unpacked chunk or in the file */
    int32_t chunk;   /* -1 = in none */
    int32_t channel;
} io_ros_message;

/* Zero it, but for the first members and the last two. */
typedef struct io_ros_log {
    const char *name; /* for error lines; stays while the log does */
    bool is_ros1;
    bool is_live;       /* of a running camera: nothing can be recorded anew */
    bool has_own_poses; /* the driver's; tf is not asked */
    io_ros_channel *channels;
    io_ros_message *messages;
    int32_t channel_count, channel_room, message_count, message_room;
    bool is_full, lacks_memory; /* some are not listed */
    char strangers[512];        /* topics of pictures in messages that are not read; "" = none */
    void *self;
    /* The message's bytes stay valid until the next call. */
    rlf_result (*read)(void *self, const io_ros_message *message, io_cdr_reader *out);
} io_ros_log;

/* Index of a channel; -1 = none of that id. */
int32_t io_ros_log_find(const io_ros_log *log, uint32_t id);
/* An id that is there stays as it is. */
void io_ros_log_add_channel(io_ros_log *log, uint32_t id, io_ros_type type, const char *topic,
                            int32_t limit);
/* Nothing where there is no such channel, or it has as many as it may. */
void io_ros_log_add_message(io_ros_log *log, uint32_t id, int64_t time_ns, int32_t chunk,
                            uint64_t offset);
/* Takes the last ones away again, down to so many. */
void io_ros_log_cut(io_ros_log *log, int32_t message_count);
/* Once all are added. RLF_ERROR_MEMORY when there was too little for them. */
rlf_result io_ros_log_sort(io_ros_log *log);
void io_ros_log_free(io_ros_log *log);

/* Message `index` of a channel. */
static inline const io_ros_message *io_ros_log_at(const io_ros_log *log, int32_t channel,
                                                  int32_t index)
{
    return &log->messages[log->channels[channel].first + index];
}

static inline rlf_result io_ros_log_read(const io_ros_log *log, int32_t channel, int32_t index,
                                         io_cdr_reader *out)
{
    return log->read(log->self, io_ros_log_at(log, channel, index), out);
}

/* Whether messages of a type are pictures or depth in a form that is not read. */
bool io_ros_is_stranger(const char *type);
/* Of such a type: adds "TOPIC (TYPE, ENCODING)" to the strangers, once. `encoding` may be "". */
void io_ros_log_add_stranger(io_ros_log *log, const char *topic, const char *type,
                             const char *encoding);

/* ---- Chunks of a file, unpacked ---- */

typedef struct io_ros_unpacked {
    int32_t chunk1; /* plus one; 0 = none */
    uint64_t used;  /* larger = later */
    io_buffer bytes;
    size_t size;
} io_ros_unpacked;

/* Two, since the depth and the colour of a frame may lie in neighbours. */
typedef struct io_ros_cache {
    io_ros_unpacked slots[2];
    uint64_t clock;
} io_ros_cache;

/* The chunk's place, or with chunk1 0 one to unpack it into: then set chunk1 and size. */
io_ros_unpacked *io_ros_cache_find(io_ros_cache *cache, int32_t chunk);
void io_ros_cache_free(io_ros_cache *cache);

typedef enum io_packing {
    IO_PACKING_NONE,
    IO_PACKING_ZSTD,
    IO_PACKING_LZ4,
    IO_PACKING_BZ2
} io_packing;

/* Fills all of `out`; false when the bytes are damaged, are not exactly so many, or are packed in a
 * way that this build does not know. */
bool io_unpack(io_packing packing, const uint8_t *data, size_t size, uint8_t *out, size_t out_size);

/* What bytes that zstd packed say that they become; 0 = they are none, or do not say. */
uint64_t io_zstd_size(const uint8_t *data, size_t size);

#endif
