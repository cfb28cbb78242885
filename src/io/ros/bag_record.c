/* Records of a bag: a header of named fields, then data. */
#include "io/ros/bag.h"
#include "io/little.h"

/* Headers hold a topic's name and a few numbers. */
#define HEADER_MAX 65536u

/* The value of a field "name=value" when it is the named one. */
static bool is_field(cursor field, const char *name, cursor *out)
{
    const size_t length = strlen(name);
    if (field.left <= length || memcmp(field.data, name, length) != 0 ||
        field.data[length] != '=') {
        return false;
    }
    *out = (cursor){field.data + length + 1, field.left - length - 1, false};
    return true;
}

static void copy_text(cursor value, char *out, size_t capacity)
{
    const size_t size = value.left < capacity ? value.left : capacity - 1;
    memcpy(out, value.data, size);
    out[size] = '\0';
}

/* Reads the fields of a record's header. */
static void parse_header(cursor fields, bag_record *out)
{
    memset(out, 0, sizeof(*out));
    out->op = -1;
    while (fields.left > 0) {
        cursor field = cursor_block(&fields);
        cursor value;
        if (is_field(field, "op", &value)) {
            out->op = cursor_u8(&value);
        } else if (is_field(field, "conn", &value)) {
            out->connection = cursor_u32(&value);
        } else if (is_field(field, "count", &value)) {
            out->count = cursor_u32(&value);
        } else if (is_field(field, "size", &value)) {
            out->size = cursor_u32(&value);
        } else if (is_field(field, "time", &value)) {
            out->time_ns = cursor_time(&value);
        } else if (is_field(field, "topic", &value)) {
            copy_text(value, out->topic, sizeof(out->topic));
        } else if (is_field(field, "compression", &value)) {
            copy_text(value, out->compression, sizeof(out->compression));
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

bool bag_read_at(const bag *self, int64_t position, void *out, size_t size)
{
    return io_file_read_at(&self->file, position, out, size) == size;
}

bool bag_read_record(bag *self, int64_t position, bag_record *out)
{
    uint32_t header_size = 0;
    if (!bag_read_at(self, position, &header_size, 4)) {
        return false;
    }
    io_little(&header_size, 1, sizeof(header_size));
    if (header_size > HEADER_MAX ||
        io_buffer_reserve(&self->message, (size_t)header_size + 4) != RLF_OK ||
        !bag_read_at(self, position + 4, self->message.data, (size_t)header_size + 4)) {
        return false;
    }
    parse_header((cursor){self->message.data, header_size, false}, out);
    io_little_read(self->message.data + header_size, &out->data_size, 4);
    out->data = 8 + (int64_t)header_size;
    return out->data_size <= self->file.size - position - out->data;
}
