/* Lists of a bag's messages. */
#include "io/ros/bag.h"

#include <stdlib.h>

#define ENTRIES_MAX (4 << 20) /* nearly two days at 30 per second */

static rlf_result add_entry(bag *self, int32_t chunk, bag_connection *connection, int64_t time_ns,
                            uint32_t offset)
{
    if (connection->count >= connection->limit) {
        return RLF_OK;
    }
    rlf_result result = bag_grow(self, (void **)&self->entries, self->entry_count,
                                 &self->entry_capacity, sizeof(self->entries[0]), ENTRIES_MAX);
    if (result == RLF_OK) {
        const int32_t index = (int32_t)(connection - self->connections);
        self->entries[self->entry_count++] = (bag_entry){time_ns, chunk, index, offset};
        connection->count++;
    }
    return result;
}

/* One index record: the times and places of a connection's messages in the chunk before it. */
static rlf_result read_index_record(bag *self, int32_t chunk, int64_t position,
                                    const bag_record *record)
{
    bag_connection *connection = bag_find_connection(self, record->connection);
    if (record->op != BAG_OP_INDEX || connection == NULL ||
        connection->count >= connection->limit) {
        return RLF_OK;
    }
    rlf_result result = io_buffer_reserve(&self->packed, record->data_size);
    if (result != RLF_OK ||
        !bag_read_at(self, position + record->data, self->packed.data, record->data_size)) {
        return result;
    }
    cursor c = {self->packed.data, record->data_size, false};
    for (uint32_t i = 0; i < record->count && c.left >= 12 && result == RLF_OK; i++) {
        const int64_t time_ns = cursor_time(&c);
        result = add_entry(self, chunk, connection, time_ns, cursor_u32(&c));
    }
    return result;
}

static rlf_result read_chunk_index(bag *self, int32_t index)
{
    const bag_chunk chunk = self->chunks[index];
    rlf_result result = RLF_OK;
    bag_record record;
    for (int64_t position = chunk.index_begin; position < chunk.index_end && result == RLF_OK;
         position += record.data + record.data_size) {
        if (!bag_read_record(self, position, &record)) {
            break;
        }
        result = read_index_record(self, index, position, &record);
    }
    return result;
}

/* Looks through a chunk that the recorder did not live to index. */
static rlf_result read_chunk(bag *self, int32_t index)
{
    io_bytes bytes;
    rlf_result result = bag_unpack(self, index, &bytes);
    cursor c = {bytes.data, bytes.size, false};
    while (result == RLF_OK && c.left > 0) {
        const uint32_t offset = (uint32_t)(c.data - bytes.data);
        bag_record record;
        cursor data;
        if (!bag_parse_record(&c, &record, &data) || record.op != BAG_OP_MESSAGE) {
            continue;
        }
        bag_connection *connection = bag_find_connection(self, record.connection);
        if (connection != NULL) {
            result = add_entry(self, index, connection, record.time_ns, offset);
        }
    }
    return result;
}

static int compare_entries(const void *a, const void *b)
{
    const bag_entry *x = a;
    const bag_entry *y = b;
    if (x->connection != y->connection) {
        return x->connection < y->connection ? -1 : 1;
    }
    if (x->time_ns != y->time_ns) {
        return x->time_ns < y->time_ns ? -1 : 1;
    }
    if (x->chunk != y->chunk) {
        return x->chunk < y->chunk ? -1 : 1;
    }
    return (x->offset > y->offset) - (x->offset < y->offset);
}

static void sort_entries(bag *self)
{
    if (self->entry_count > 0) {
        qsort(self->entries, (size_t)self->entry_count, sizeof(self->entries[0]), compare_entries);
    }
    for (int32_t i = self->entry_count - 1; i >= 0; i--) {
        self->connections[self->entries[i].connection].first = i;
    }
}

rlf_result bag_index(bag *self)
{
    rlf_result result = RLF_OK;
    bool is_warned = false;
    for (int32_t i = 0; i < self->chunk_count && result == RLF_OK; i++) {
        const bag_chunk *chunk = &self->chunks[i];
        const bool has_index = chunk->index_end > chunk->index_begin;
        result = has_index ? read_chunk_index(self, i) : read_chunk(self, i);
        if (result == RLF_ERROR_FORMAT) {
            if (!is_warned) {
                rlf_log(RLF_LOG_WARNING, "%s; what it holds is left out", rlf_error_text());
            }
            is_warned = true;
            result = RLF_OK;
        }
    }
    sort_entries(self);
    return result;
}
