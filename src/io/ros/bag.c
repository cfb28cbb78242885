/* ROS 1 bags: one walk through the file, then the lists of the messages. */
#include "io/ros/bag.h"

#define MAGIC "#ROSBAG V2.0\n"
#define CHUNKS_MAX (4 << 20)
/* Of what does not change one message is enough; transforms come spread over a few. */
#define FEW 256

/* ---- the walk ------------------------------------------------------------------------------- */

static void add_connection(bag *self, const bag_record *record, cursor data)
{
    char type[64] = "";
    while (data.left > 0) {
        cursor value;
        if (bag_is_field(cursor_block(&data), "type", &value)) {
            cursor_copy(value, type, sizeof(type));
        }
    }
    const io_ros_type known = io_ros1_type_of(type);
    const bool is_picture = known == IO_ROS_IMAGE || known == IO_ROS_COMPRESSED_IMAGE;
    if (known != IO_ROS_OTHER) {
        io_ros_log_add_channel(self->log, record->connection, known, record->topic,
                               is_picture                    ? INT32_MAX
                               : known == IO_ROS_CAMERA_INFO ? 1
                                                             : FEW);
    }
    io_ros_log_add_stranger(self->log, record->topic, known == IO_ROS_OTHER ? type : "", "");
    self->log->has_own_poses |= strncmp(record->topic, "/device_", 8) == 0;
}

static rlf_result add_chunk(bag *self, int64_t position, const bag_record *record)
{
    io_packing packing = IO_PACKING_NONE;
    if (strcmp(record->compression, "lz4") == 0) {
        packing = IO_PACKING_LZ4;
    } else if (strcmp(record->compression, "bz2") == 0) {
        packing = IO_PACKING_BZ2;
    } else if (strcmp(record->compression, "none") != 0) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: a chunk is compressed with \"%s\": run rosbag decompress",
                        self->file.path, record->compression);
    }
    rlf_result result = bag_check_packing(self->file.path, packing);
    if (result != RLF_OK) {
        return result;
    }
    const bool is_plain = packing == IO_PACKING_NONE;
    /* LZ4 packs 255 bytes into one at most. */
    if ((is_plain && record->size != record->data_size) ||
        (packing == IO_PACKING_LZ4 && record->size / 256 > record->data_size)) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: a chunk of %u bytes claims to hold %u: copy or record it again",
                        self->file.path, (unsigned)record->data_size, (unsigned)record->size);
    }
    if (self->chunk_count >= CHUNKS_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY,
                        "%s: holds more than %d records: cut it with rosbag filter",
                        self->file.path, CHUNKS_MAX);
    }
    result = io_list_grow((void **)(void *)&self->chunks, self->chunk_count, 1, &self->chunk_room,
                          sizeof(self->chunks[0]));
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
    if (last == NULL || last->packing != IO_PACKING_NONE ||
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
    cursor data;
    if (record->op == BAG_OP_CHUNK) {
        return add_chunk(self, position, record);
    }
    if (record->op == BAG_OP_INDEX && last != NULL && position == last->index_end) {
        last->index_end = position + record->data + record->data_size;
    } else if (record->op == BAG_OP_CONNECTION &&
               bag_read_data(self, position, record, &self->packed, &data)) {
        add_connection(self, record, data);
    }
    return RLF_OK;
}

/* *out_is_indexed: connections are repeated at the end of a file that was closed. */
static rlf_result scan(bag *self, bool *out_is_indexed)
{
    int64_t position = (int64_t)strlen(MAGIC);
    *out_is_indexed = false;
    while (position < self->file.size) {
        bag_record record;
        rlf_result result = RLF_ERROR_FORMAT;
        if (bag_read_record(self, position, &record)) {
            const bool is_inside = extend_chunk(self, position, &record);
            result = is_inside ? RLF_OK : add_record(self, position, &record);
            *out_is_indexed |= record.op == BAG_OP_CONNECTION && !is_inside;
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
    return RLF_OK;
}

/* ---- messages ------------------------------------------------------------------------------- */

/* Looks through a chunk that the recorder did not live to index, or for its connections. */
static rlf_result look_into(bag *self, int32_t index, bool wants_messages)
{
    cursor c;
    rlf_result result = bag_unpack(self, index, &c);
    const uint8_t *begin = c.data;
    if (result == RLF_ERROR_FORMAT && !self->is_warned) {
        self->is_warned = true;
        rlf_log(RLF_LOG_WARNING, "%s; what it holds is left out", rlf_error_text());
    }
    while (c.left > 0) {
        const uint64_t offset = (uint64_t)(c.data - begin);
        bag_record record;
        cursor data;
        if (!bag_parse_record(&c, &record, &data)) {
            break;
        }
        if (record.op == BAG_OP_CONNECTION) {
            add_connection(self, &record, data);
        } else if (record.op == BAG_OP_MESSAGE && wants_messages) {
            io_ros_log_add_message(self->log, record.connection, record.time_ns, index, offset);
        }
    }
    return result == RLF_ERROR_FORMAT ? RLF_OK : result;
}

/* The index records behind a chunk: times and places of each connection's messages in it. */
static void read_indexes(bag *self, int32_t index)
{
    const bag_chunk *chunk = &self->chunks[index];
    bag_record record;
    for (int64_t position = chunk->index_begin;
         position < chunk->index_end && bag_read_record(self, position, &record);
         position += record.data + record.data_size) {
        cursor c;
        if (record.op != BAG_OP_INDEX || io_ros_log_find(self->log, record.connection) < 0 ||
            !bag_read_data(self, position, &record, &self->packed, &c)) {
            continue;
        }
        for (uint32_t i = 0; i < record.count && c.left >= 12; i++) {
            const int64_t time_ns = cursor_time(&c);
            io_ros_log_add_message(self->log, record.connection, time_ns, index, cursor_u32(&c));
        }
    }
}

static rlf_result list_messages(bag *self, bool is_indexed)
{
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < self->chunk_count && result == RLF_OK && !is_indexed; i++) {
        result = look_into(self, i, false);
    }
    for (int32_t i = 0; i < self->chunk_count && result == RLF_OK; i++) {
        if (self->chunks[i].index_end > self->chunks[i].index_begin) {
            read_indexes(self, i);
        } else {
            result = look_into(self, i, true);
        }
    }
    return result == RLF_OK ? io_ros_log_sort(self->log) : result;
}

/* ---- opening -------------------------------------------------------------------------------- */

static rlf_result open_all(bag *self, const char *path)
{
    char magic[sizeof(MAGIC) - 1];
    bool is_indexed = false;
    rlf_result result = io_file_open(&self->file, path, "check the name");
    if (result == RLF_OK &&
        (io_file_read_at(&self->file, 0, magic, sizeof(magic)) != sizeof(magic) ||
         memcmp(magic, MAGIC, sizeof(magic)) != 0)) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is no ROS bag of version 2.0: run rosbag fix, or give the right file",
                        path);
    }
    result = result == RLF_OK ? scan(self, &is_indexed) : result;
    return result == RLF_OK ? list_messages(self, is_indexed) : result;
}

rlf_result bag_open(const char *path, io_ros_log *log, bag **out)
{
    bag *self = rlf_alloc(sizeof(*self));
    *out = self;
    if (self == NULL) {
        return RLF_ERROR_MEMORY;
    }
    self->log = log;
    log->is_ros1 = true;
    log->self = self;
    log->read = bag_message;
    rlf_result result = open_all(self, path);
    if (result != RLF_OK) {
        bag_close(out);
    }
    return result;
}

void bag_close(bag **handle)
{
    bag *self = *handle;
    *handle = NULL;
    if (self == NULL) {
        return;
    }
    io_file_close(&self->file);
    rlf_free(self->chunks);
    io_ros_cache_free(&self->cache);
    io_buffer_free(&self->packed);
    io_buffer_free(&self->message);
    rlf_free(self);
}

bool bag_is_fast(const bag *self)
{
    for (int32_t i = 0; i < self->chunk_count; i++) {
        if (self->chunks[i].packing == IO_PACKING_BZ2) {
            return false;
        }
    }
    return true;
}
