/* Records of a bag: a header of named fields, then data; chunks of them, and messages. */
#include "io/ros/bag.h"

#include "base/messages.h"

/* Headers hold a topic's name and a few numbers. */
#define HEADER_MAX 65536u

bool bag_is_field(cursor field, const char *name, cursor *out)
{
    const size_t length = strlen(name);
    if (field.left <= length || memcmp(field.data, name, length) != 0 ||
        field.data[length] != '=') {
        return false;
    }
    *out = (cursor){field.data + length + 1, field.left - length - 1, false};
    return true;
}

/* Reads the fields of a record's header. */
static void parse_header(cursor fields, bag_record *out)
{
    memset(out, 0, sizeof(*out));
    out->op = -1;
    while (fields.left > 0) {
        cursor field = cursor_block(&fields);
        cursor value;
        if (bag_is_field(field, "op", &value)) {
            out->op = cursor_u8(&value);
        } else if (bag_is_field(field, "conn", &value)) {
            out->connection = cursor_u32(&value);
        } else if (bag_is_field(field, "count", &value)) {
            out->count = cursor_u32(&value);
        } else if (bag_is_field(field, "size", &value)) {
            out->size = cursor_u32(&value);
        } else if (bag_is_field(field, "time", &value)) {
            out->time_ns = cursor_time(&value);
        } else if (bag_is_field(field, "topic", &value)) {
            cursor_copy(value, out->topic, sizeof(out->topic));
        } else if (bag_is_field(field, "compression", &value)) {
            cursor_copy(value, out->compression, sizeof(out->compression));
        }
    }
}

bool bag_parse_record(cursor *c, bag_record *out, cursor *out_data)
{
    const uint8_t *begin = c->data;
    const cursor fields = cursor_block(c);
    parse_header(fields, out);
    *out_data = cursor_block(c);
    out->data = c->is_short ? 0 : out_data->data - begin;
    out->data_size = (uint32_t)out_data->left;
    return !c->is_short;
}

static bool read_at(const bag *self, int64_t position, void *out, size_t size)
{
    return io_file_read_at(&self->file, position, out, size) == size;
}

bool bag_read_record(bag *self, int64_t position, bag_record *out)
{
    uint32_t header_size = 0;
    if (!read_at(self, position, &header_size, 4)) {
        return false;
    }
    io_little(&header_size, 1, sizeof(header_size));
    if (header_size > HEADER_MAX ||
        io_buffer_reserve(&self->message, (size_t)header_size + 4) != RLF_OK ||
        !read_at(self, position + 4, self->message.data, (size_t)header_size + 4)) {
        return false;
    }
    parse_header((cursor){self->message.data, header_size, false}, out);
    io_little_read(self->message.data + header_size, &out->data_size, 4);
    out->data = 8 + (int64_t)header_size;
    return out->data_size <= self->file.size - position - out->data;
}

bool bag_read_data(const bag *self, int64_t position, const bag_record *record, io_buffer *buffer,
                   cursor *out)
{
    const size_t size = record->data_size;
    if (io_buffer_reserve(buffer, size) != RLF_OK ||
        !read_at(self, position + record->data, buffer->data, size)) {
        return false;
    }
    *out = (cursor){buffer->data, size, false};
    return true;
}

/* ---- chunks --------------------------------------------------------------------------------- */

rlf_result bag_check_packing(const char *path, io_packing packing)
{
#ifdef RLF_HAVE_BZ2
    const bool has_bz2 = true;
#else
    const bool has_bz2 = false;
#endif
#if defined(RLF_HAVE_LZ4) || defined(RLF_HAVE_MCAP)
    const bool has_lz4 = true;
#else
    const bool has_lz4 = false;
#endif
    const bool is_lz4 = packing == IO_PACKING_LZ4;
    if ((is_lz4 && !has_lz4) || (packing == IO_PACKING_BZ2 && !has_bz2)) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: is packed with %s, which this build was made without: run rosbag "
                        "decompress, or %s",
                        path, is_lz4 ? "lz4" : "bz2",
                        is_lz4 ? RLF_GET_PART("liblz4-dev", "script/bootstrap", "RELIEF_WITH_LZ4")
                               : RLF_GET_PART("libbz2-dev", "script/bootstrap", "RELIEF_WITH_BZ2"));
    }
    return RLF_OK;
}

static rlf_result unpack_into(bag *self, int32_t index, io_ros_unpacked *out)
{
    const bag_chunk *chunk = &self->chunks[index];
    const char *name = self->file.path;
    if (chunk->size > BAG_CHUNK_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: a chunk of %u bytes claims to unpack to %u: record in smaller chunks",
                        name, (unsigned)chunk->packed_size, (unsigned)chunk->size);
    }
    rlf_result result = io_buffer_reserve(&out->bytes, chunk->size);
    result = result == RLF_OK ? io_buffer_reserve(&self->packed, chunk->packed_size) : result;
    if (result != RLF_OK) {
        return result;
    }
    if (!read_at(self, chunk->position, self->packed.data, chunk->packed_size)) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be read: check the disk", name);
    }
    const bool is_emptied = chunk->size == 0 && chunk->packed_size > 0;
    if (is_emptied || !io_unpack(chunk->packing, self->packed.data, chunk->packed_size,
                                 out->bytes.data, chunk->size)) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: a compressed chunk is damaged: copy or record it again", name);
    }
    out->chunk1 = index + 1;
    out->size = chunk->size;
    return RLF_OK;
}

rlf_result bag_unpack(bag *self, int32_t chunk, cursor *out)
{
    io_ros_unpacked *place = io_ros_cache_find(&self->cache, chunk);
    rlf_result result = place->chunk1 == 0 ? unpack_into(self, chunk, place) : RLF_OK;
    *out = (cursor){place->bytes.data, result == RLF_OK ? place->size : 0, false};
    return result;
}

/* ---- messages ------------------------------------------------------------------------------- */

static bool is_message_of(const bag *self, const io_ros_message *message, const bag_record *record)
{
    return record->op == BAG_OP_MESSAGE &&
           record->connection == self->log->channels[message->channel].id;
}

/* Straight from the file, so that one message does not cost a whole chunk. */
static bool read_plain(bag *self, const io_ros_message *message, cursor *out)
{
    const bag_chunk *chunk = &self->chunks[message->chunk];
    const int64_t position = chunk->position + (int64_t)message->offset;
    bag_record record;
    return bag_read_record(self, position, &record) && is_message_of(self, message, &record) &&
           position + record.data + record.data_size <= chunk->position + chunk->size &&
           bag_read_data(self, position, &record, &self->message, out);
}

rlf_result bag_message(void *handle, const io_ros_message *message, io_cdr_reader *out)
{
    bag *self = handle;
    cursor data = {0};
    bool is_good;
    if (self->chunks[message->chunk].packing == IO_PACKING_NONE) {
        is_good = read_plain(self, message, &data);
    } else {
        cursor chunk;
        bag_record record;
        rlf_result result = bag_unpack(self, message->chunk, &chunk);
        if (result != RLF_OK) {
            return result;
        }
        is_good = cursor_take(&chunk, message->offset) != NULL && chunk.left > 0 &&
                  bag_parse_record(&chunk, &record, &data) && is_message_of(self, message, &record);
    }
    *out = io_ros1_open(data.data, data.left);
    return is_good ? RLF_OK
                   : rlf_fail(RLF_ERROR_FORMAT,
                              "%s: a message is damaged or cut short: copy or record it again",
                              self->file.path);
}
