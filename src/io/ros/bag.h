/* ROS 1 bags (format 2.0): which messages there are, and their bytes. */
#ifndef RLF_IO_ROS_BAG_H
#define RLF_IO_ROS_BAG_H

#include "io/file.h"
#include "io/little.h"

#define BAG_TEXT_MAX 256

/* A topic with the type of its messages. */
typedef struct bag_connection {
    uint32_t id;
    char topic[BAG_TEXT_MAX];
    char type[64];
    int32_t limit; /* set by the caller before bag_index: how many messages to list; 0 = none */
    int32_t count; /* listed */
    int32_t first; /* entry; only where count > 0 */
} bag_connection;

/* Where a message is. */
typedef struct bag_entry {
    int64_t time_ns; /* when it was recorded */
    int32_t chunk, connection;
    uint32_t offset; /* of its record in the unpacked chunk */
} bag_entry;

typedef struct bag bag;

/* Finds chunks and connections. What follows the last whole record is left out with a warning. */
rlf_result bag_open(const char *path, bag **out);
void bag_close(bag **self);

int32_t bag_connection_count(const bag *self);
bag_connection *bag_connection_at(bag *self, int32_t index);

/* Lists the messages of the connections with a limit: from the index, or by looking through the
 * chunks that have none. */
rlf_result bag_index(bag *self);
const bag_entry *bag_entry_at(const bag *self, int32_t index);

/* Whether bytes come at little cost, so that times may be read from the messages themselves. */
bool bag_is_fast(const bag *self);

/* A message's bytes; valid until the next call. The name is the bag's. */
rlf_result bag_message(bag *self, const bag_entry *entry, io_bytes *out);

/* ---- What the parts of the reader share ---- */

/* A chunk that unpacks to more is passed over: rosbag begins a new one after 768 KiB, so only a
 * single huge message makes one large. */
#define BAG_CHUNK_MAX ((uint32_t)64 << 20)

enum { BAG_OP_MESSAGE = 2, BAG_OP_INDEX = 4, BAG_OP_CHUNK = 5, BAG_OP_CONNECTION = 7 };

typedef enum bag_packing { BAG_PACKING_NONE, BAG_PACKING_LZ4, BAG_PACKING_BZ2 } bag_packing;

typedef struct bag_chunk {
    int64_t position;           /* of its bytes in the file */
    uint32_t packed_size, size; /* in the file, and unpacked */
    bag_packing packing;
    int64_t index_begin, index_end; /* the index records behind it; the same = none */
} bag_chunk;

/* An unpacked chunk that is kept. */
typedef struct bag_cache {
    int32_t chunk; /* -1 = none */
    uint64_t used; /* larger = later */
    io_buffer bytes;
    size_t size;
} bag_cache;

struct bag {
    io_file file;
    bag_chunk *chunks;
    int32_t chunk_count, chunk_capacity;
    bag_connection *connections;
    int32_t connection_count, connection_capacity;
    bag_entry *entries;
    int32_t entry_count, entry_capacity;
    bag_cache caches[2]; /* depth and colour of one time may lie in neighbouring chunks */
    uint64_t clock;
    io_buffer packed, message;
};

/* A record's header and where its data is. */
typedef struct bag_record {
    int op; /* -1 = none given */
    uint32_t connection, count, size;
    int64_t time_ns;
    char topic[BAG_TEXT_MAX];
    char compression[16];
    int64_t data; /* offset of the data from the start of the record */
    uint32_t data_size;
} bag_record;

/* A record in memory; false when it is cut short. The cursor moves behind it. */
bool bag_parse_record(cursor *c, bag_record *out, cursor *out_data);

/* Reads exactly `size` bytes; false at the end of the file. */
bool bag_read_at(const bag *self, int64_t position, void *out, size_t size);

/* A record in the file, without its data; false when it is cut short. */
bool bag_read_record(bag *self, int64_t position, bag_record *out);

bag_connection *bag_find_connection(bag *self, uint32_t id);

/* Makes room for one more element; `limit` bounds the memory that a hostile file can ask for. */
rlf_result bag_grow(const bag *self, void **array, int32_t count, int32_t *capacity, size_t size,
                    int32_t limit);

/* The unpacked chunk; valid until two others were asked for. */
rlf_result bag_unpack(bag *self, int32_t chunk, io_bytes *out);

/* Whether this build can unpack such chunks; else RLF_ERROR_UNSUPPORTED with what to do. */
rlf_result bag_check_packing(const char *path, bag_packing packing);

#endif
