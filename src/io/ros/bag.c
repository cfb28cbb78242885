/* ROS 1 bags: opening and messages. */
#include "io/ros/bag.h"

#define MAGIC "#ROSBAG V2.0\n"
#define CHUNKS_MAX (4 << 20)
#define CONNECTIONS_MAX 4096

rlf_result bag_grow(const bag *self, void **array, int32_t count, int32_t *capacity, size_t size,
                    int32_t limit)
{
    if (count >= limit) {
        return rlf_fail(RLF_ERROR_CAPACITY,
                        "%s: holds more than %d records: cut it with rosbag filter",
                        self->file.path, (int)limit);
    }
    return io_list_grow(array, count, 1, capacity, size);
}

bag_connection *bag_find_connection(bag *self, uint32_t id)
{
    /* Most recorders count from 0. */
    if (id < (uint32_t)self->connection_count && self->connections[id].id == id) {
        return &self->connections[id];
    }
    for (int32_t i = 0; i < self->connection_count; i++) {
        if (self->connections[i].id == id) {
            return &self->connections[i];
        }
    }
    return NULL;
}

static rlf_result add_connection(bag *self, const bag_record *record, cursor data)
{
    if (bag_find_connection(self, record->connection) != NULL) {
        return RLF_OK;
    }
    rlf_result result =
        bag_grow(self, (void **)&self->connections, self->connection_count,
                 &self->connection_capacity, sizeof(self->connections[0]), CONNECTIONS_MAX);
    if (result != RLF_OK) {
        return result;
    }
    bag_connection *c = &self->connections[self->connection_count++];
    memset(c, 0, sizeof(*c));
    c->id = record->connection;
    memcpy(c->topic, record->topic, sizeof(c->topic));
    while (data.left > 0) {
        const cursor field = cursor_block(&data);
        if (field.left > 5 && memcmp(field.data, "type=", 5) == 0) {
            const size_t length =
                field.left - 5 < sizeof(c->type) ? field.left - 5 : sizeof(c->type) - 1;
            memcpy(c->type, field.data + 5, length);
        }
    }
    return RLF_OK;
}

static rlf_result add_chunk(bag *self, int64_t position, const bag_record *record)
{
    bag_packing packing = BAG_PACKING_NONE;
    if (strcmp(record->compression, "lz4") == 0) {
        packing = BAG_PACKING_LZ4;
    } else if (strcmp(record->compression, "bz2") == 0) {
        packing = BAG_PACKING_BZ2;
    } else if (strcmp(record->compression, "none") != 0) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: a chunk is compressed with \"%s\": run rosbag decompress",
                        self->file.path, record->compression);
    }
    rlf_result result = bag_check_packing(self->file.path, packing);
    if (result != RLF_OK) {
        return result;
    }
    const bool is_plain = packing == BAG_PACKING_NONE;
    /* LZ4 packs 255 bytes into one at most. */
    if ((is_plain && record->size != record->data_size) ||
        (packing == BAG_PACKING_LZ4 && record->size / 256 > record->data_size)) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: a chunk of %u bytes claims to hold %u: copy or record it again",
                        self->file.path, (unsigned)record->data_size, (unsigned)record->size);
    }
    result = bag_grow(self, (void **)&self->chunks, self->chunk_count, &self->chunk_capacity,
                      sizeof(self->chunks[0]), CHUNKS_MAX);
    if (result == RLF_OK) {
        const int64_t end = position + record->data + record->data_size;
        self->chunks[self->chunk_count++] = (bag_chunk){
            position + record->data, record->data_size, record->size, packing, end, end};
    }
    return result;
}

/* A recorder that dies leaves its last chunk with a size of 0 and the records behind it. */
static bool extend_chunk(bag *self, int64_t position, const bag_record *record)
{
    bag_chunk *last = self->chunk_count > 0 ? &self->chunks[self->chunk_count - 1] : NULL;
    const int64_t size = record->data + record->data_size;
    if (last == NULL || last->packing != BAG_PACKING_NONE ||
        position != last->position + last->size || size > BAG_CHUNK_MAX - (int64_t)last->size ||
        (record->op != BAG_OP_CONNECTION && record->op != BAG_OP_MESSAGE)) {
        return false;
    }
    last->size += (uint32_t)size;
    last->packed_size = last->size;
    last->index_begin = last->index_end = position + size;
    return true;
}

static rlf_result add_record(bag *self, int64_t position, const bag_record *record)
{
    bag_chunk *last = self->chunk_count > 0 ? &self->chunks[self->chunk_count - 1] : NULL;
    if (record->op == BAG_OP_CHUNK) {
        return add_chunk(self, position, record);
    }
    if (record->op == BAG_OP_INDEX && last != NULL && position == last->index_end) {
        last->index_end = position + record->data + record->data_size;
        return RLF_OK;
    }
    if (record->op != BAG_OP_CONNECTION) {
        return RLF_OK;
    }
    rlf_result result = io_buffer_reserve(&self->packed, record->data_size);
    if (result == RLF_OK &&
        bag_read_at(self, position + record->data, self->packed.data, record->data_size)) {
        result =
            add_connection(self, record, (cursor){self->packed.data, record->data_size, false});
    }
    return result;
}

/* Connections are repeated at the end of a file that was closed; else the chunks tell. */
static rlf_result find_connections(bag *self)
{
    for (int32_t i = 0; i < self->chunk_count; i++) {
        io_bytes bytes;
        rlf_result result = bag_unpack(self, i, &bytes);
        if (result == RLF_ERROR_FORMAT) {
            rlf_log(RLF_LOG_WARNING, "%s; what it holds is left out", rlf_error_text());
        } else if (result != RLF_OK) {
            return result;
        }
        cursor c = {bytes.data, bytes.size, false};
        while (c.left > 0) {
            bag_record record;
            cursor data;
            if (bag_parse_record(&c, &record, &data) && record.op == BAG_OP_CONNECTION) {
                result = add_connection(self, &record, data);
                if (result != RLF_OK) {
                    return result;
                }
            }
        }
    }
    return RLF_OK;
}

static rlf_result scan(bag *self)
{
    int64_t position = (int64_t)strlen(MAGIC);
    bool is_indexed = false;
    while (position < self->file.size) {
        bag_record record;
        rlf_result result = RLF_ERROR_FORMAT;
        if (bag_read_record(self, position, &record)) {
            const bool is_inside = extend_chunk(self, position, &record);
            result = is_inside ? RLF_OK : add_record(self, position, &record);
            is_indexed = is_indexed || (record.op == BAG_OP_CONNECTION && !is_inside);
            if (result != RLF_OK && result != RLF_ERROR_FORMAT) {
                return result;
            }
        }
        if (result != RLF_OK) {
            rlf_log(RLF_LOG_WARNING,
                    "%s: is damaged or cut short at byte %lld of %lld: what is before is read",
                    self->file.path, (long long)position, (long long)self->file.size);
            break;
        }
        position += record.data + record.data_size;
    }
    return is_indexed ? RLF_OK : find_connections(self);
}

static rlf_result check_magic(bag *self)
{
    char magic[sizeof(MAGIC) - 1];
    if (!bag_read_at(self, 0, magic, sizeof(magic)) || memcmp(magic, MAGIC, sizeof(magic)) != 0) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is no ROS bag of version 2.0: run rosbag fix, or give the right file",
                        self->file.path);
    }
    return RLF_OK;
}

rlf_result bag_open(const char *path, bag **out)
{
    *out = NULL;
    bag *self = rlf_alloc(sizeof(*self));
    if (self == NULL) {
        return RLF_ERROR_MEMORY;
    }
    self->caches[0].chunk = self->caches[1].chunk = -1;
    rlf_result result = io_file_open(&self->file, path, "check the name");
    result = result == RLF_OK ? check_magic(self) : result;
    result = result == RLF_OK ? scan(self) : result;
    if (result != RLF_OK) {
        bag_close(&self);
        return result;
    }
    *out = self;
    return RLF_OK;
}

void bag_close(bag **handle)
{
    bag *self = *handle;
    if (self == NULL) {
        return;
    }
    io_file_close(&self->file);
    rlf_free(self->chunks);
    rlf_free(self->connections);
    rlf_free(self->entries);
    for (int i = 0; i < 2; i++) {
        io_buffer_free(&self->caches[i].bytes);
    }
    io_buffer_free(&self->packed);
    io_buffer_free(&self->message);
    rlf_free(self);
    *handle = NULL;
}

int32_t bag_connection_count(const bag *self)
{
    return self->connection_count;
}

bag_connection *bag_connection_at(bag *self, int32_t index)
{
    return &self->connections[index];
}

const bag_entry *bag_entry_at(const bag *self, int32_t index)
{
    return &self->entries[index];
}

bool bag_is_fast(const bag *self)
{
    for (int32_t i = 0; i < self->chunk_count; i++) {
        if (self->chunks[i].packing == BAG_PACKING_BZ2) {
            return false;
        }
    }
    return true;
}

static rlf_result fail_message(const bag *self)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: a message is damaged or cut short: copy or record it again",
                    self->file.path);
}

static bool is_message_of(const bag *self, const bag_entry *entry, const bag_record *record)
{
    return record->op == BAG_OP_MESSAGE &&
           record->connection == self->connections[entry->connection].id;
}

/* Straight from the file, so that one message does not cost a whole chunk. */
static rlf_result read_plain(bag *self, const bag_entry *entry, io_bytes *out)
{
    const bag_chunk *chunk = &self->chunks[entry->chunk];
    const int64_t position = chunk->position + entry->offset;
    bag_record record;
    if (!bag_read_record(self, position, &record) || !is_message_of(self, entry, &record) ||
        position + record.data + record.data_size > chunk->position + chunk->size) {
        return fail_message(self);
    }
    rlf_result result = io_buffer_reserve(&self->message, record.data_size);
    if (result == RLF_OK &&
        !bag_read_at(self, position + record.data, self->message.data, record.data_size)) {
        return fail_message(self);
    }
    *out = (io_bytes){self->file.path, self->message.data, record.data_size};
    return result;
}

rlf_result bag_message(bag *self, const bag_entry *entry, io_bytes *out)
{
    if (self->chunks[entry->chunk].packing == BAG_PACKING_NONE) {
        return read_plain(self, entry, out);
    }
    io_bytes chunk;
    rlf_result result = bag_unpack(self, entry->chunk, &chunk);
    if (result != RLF_OK) {
        return result;
    }
    if (entry->offset >= chunk.size) {
        return fail_message(self);
    }
    cursor c = {chunk.data + entry->offset, chunk.size - entry->offset, false};
    bag_record record;
    cursor data;
    if (!bag_parse_record(&c, &record, &data) || !is_message_of(self, entry, &record)) {
        return fail_message(self);
    }
    *out = (io_bytes){self->file.path, data.data, data.left};
    return RLF_OK;
}
