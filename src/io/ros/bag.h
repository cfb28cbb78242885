/* ROS 1 bags (format 2.0): which messages there are, and their bytes. */
#ifndef RLF_IO_ROS_BAG_H
#define RLF_IO_ROS_BAG_H

#include "io/little.h"
#include "io/ros/log.h"

typedef struct bag bag;

/* Lists the bag's messages in the log, whose name is set: from the index, or by looking through the
 * chunks that have none. What follows the last whole record is left out with a warning. */
rlf_result bag_open(const char *path, io_ros_log *log, bag **out);
void bag_close(bag **self);

/* Whether bytes come at little cost, so that times may be read from the messages themselves. */
bool bag_is_fast(const bag *self);

/* ---- What the parts of the reader share ---- */

/* A chunk that unpacks to more is passed over: rosbag begins a new one after 768 KiB, so only a
 * single huge message makes one large. */
#define BAG_CHUNK_MAX ((uint32_t)64 << 20)

enum { BAG_OP_MESSAGE = 2, BAG_OP_INDEX = 4, BAG_OP_CHUNK = 5, BAG_OP_CONNECTION = 7 };

typedef struct bag_chunk {
    int64_t position;           /* of its bytes in the file */
    uint32_t packed_size, size; /* in the file, and unpacked */
    io_packing packing;
    int64_t index_begin, index_end; /* the index records behind it; the same = none */
} bag_chunk;

struct bag {
    io_file file;
    io_ros_log *log;
    bag_chunk *chunks;
    int32_t chunk_count, chunk_room;
    bool is_warned; /* of a chunk that cannot be unpacked */
    io_ros_cache cache;
    io_buffer packed, message;
};

/* A record's header and where its data is. */
typedef struct bag_record {
    int op; /* -1 = none given */
    uint32_t connection, count, size;
    int64_t time_ns;
    char topic[IO_ROS_TOPIC_MAX];
    char compression[16];
    int64_t data; /* offset of the data from the start of the record */
    uint32_t data_size;
} bag_record;

/* The value of a field "name=value" when it is the named one. */
bool bag_is_field(cursor field, const char *name, cursor *out);

/* A record in memory; false when it is cut short. The cursor moves behind it. */
bool bag_parse_record(cursor *c, bag_record *out, cursor *out_data);

/* A record in the file, without its data; false when it is cut short. */
bool bag_read_record(bag *self, int64_t position, bag_record *out);
/* The data of a record, into the buffer. */
bool bag_read_data(const bag *self, int64_t position, const bag_record *record, io_buffer *buffer,
                   cursor *out);

/* A log's `read`. */
rlf_result bag_message(void *self, const io_ros_message *message, io_cdr_reader *out);

/* The unpacked chunk; valid until two others were asked for. */
rlf_result bag_unpack(bag *self, int32_t chunk, cursor *out);

/* Whether this build can unpack such chunks; else RLF_ERROR_UNSUPPORTED with what to do. */
rlf_result bag_check_packing(const char *path, io_packing packing);

#endif
