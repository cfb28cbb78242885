/* ROS 1 bags (format 2.0): which messages there are, and their bytes. */
#ifndef RLF_IO_ROS_BAG_H
#define RLF_IO_ROS_BAG_H

#include "io/file.h"

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
int32_t bag_entry_count(const bag *self);
const bag_entry *bag_entry_at(const bag *self, int32_t index);

/* Whether bytes come at little cost, so that times may be read from the messages themselves. */
bool bag_is_fast(const bag *self);

/* A message's bytes; valid until the next call. The name is the bag's. */
rlf_result bag_message(bag *self, const bag_entry *entry, io_bytes *out);

#endif
