/* What the MCAP reader knows: lists that grow, and bytes of the file. */
#include "io/mcap/read.h"

#include "io/ros/recording.h"

#include <stdlib.h>

void *io_mcap_list_add(io_mcap_list *list, size_t size)
{
    return io_list_grow(&list->items, list->count, 1, &list->capacity, size) == RLF_OK
               ? (char *)list->items + (size_t)list->count++ * size
               : NULL;
}

bool io_mcap_read_at(const io_mcap_reader *reader, uint64_t offset, void *out, size_t size)
{
    return offset <= reader->size && size <= reader->size - offset &&
           io_file_read_at(&reader->file, (int64_t)offset, out, size) == size;
}

rlf_result io_mcap_read_block(const io_mcap_reader *reader, uint64_t offset, uint64_t size,
                              io_buffer *buffer)
{
    if (offset > reader->size || size > reader->size - offset) {
        return RLF_ERROR_FORMAT;
    }
    rlf_result result = io_buffer_reserve(buffer, size > 0 ? (size_t)size : 1);
    if (result == RLF_OK && !io_mcap_read_at(reader, offset, buffer->data, (size_t)size)) {
        result = RLF_ERROR_IO;
    }
    return result;
}

/* ---- lists ---------------------------------------------------------------------------------- */

static const io_mcap_schema *find_schema(const io_mcap_reader *reader, uint16_t id)
{
    const io_mcap_schema *schemas = reader->schemas.items;
    for (int32_t i = 0; i < reader->schemas.count; i++) {
        if (schemas[i].id == id) {
            return &schemas[i];
        }
    }
    return NULL;
}

void io_mcap_take_schema(io_mcap_reader *reader, io_mcap_cursor record)
{
    io_mcap_schema schema = {.id = (uint16_t)io_mcap_take_number(&record, 2)};
    const io_mcap_cursor name = io_mcap_take_block(&record);
    io_mcap_copy(&name, schema.name, sizeof(schema.name));
    for (int type = IO_ROS_OTHER + 1; type < IO_ROS_TYPE_COUNT && !name.is_bad; type++) {
        if (io_mcap_equals(&name, io_ros_type_name((io_ros_type)type))) {
            schema.type = (io_ros_type)type;
        }
    }
    const bool is_wanted = schema.type != IO_ROS_OTHER || io_ros_is_stranger(schema.name);
    if (name.is_bad || !is_wanted || find_schema(reader, schema.id) != NULL ||
        reader->schemas.count >= IO_MCAP_CHANNELS_READ_MAX) {
        return;
    }
    io_mcap_schema *place = io_mcap_list_add(&reader->schemas, sizeof(*place));
    if (place != NULL) {
        *place = schema;
    }
}

/* A topic of pictures whose messages are not read. */
static void note_stranger(io_mcap_reader *reader, const io_mcap_schema *schema,
                          const io_mcap_cursor *topic, const io_mcap_cursor *encoding)
{
    char name[IO_MCAP_TOPIC_MAX], how[32];
    if (io_ros_is_stranger(schema->name)) {
        io_mcap_copy(topic, name, sizeof(name));
        io_mcap_copy(encoding, how, sizeof(how));
        io_ros_add_stranger(reader->strangers, sizeof(reader->strangers), name, schema->name, how);
    }
}

int32_t io_mcap_find_channel(const io_mcap_reader *reader, uint16_t id)
{
    const io_mcap_channel *channels = reader->channels.items;
    for (int32_t i = 0; i < reader->channels.count; i++) {
        if (channels[i].id == id) {
            return i;
        }
    }
    return -1;
}

void io_mcap_take_channel(io_mcap_reader *reader, io_mcap_cursor record)
{
    const uint16_t id = (uint16_t)io_mcap_take_number(&record, 2);
    const io_mcap_schema *schema = find_schema(reader, (uint16_t)io_mcap_take_number(&record, 2));
    const io_mcap_cursor topic = io_mcap_take_block(&record);
    const io_mcap_cursor encoding = io_mcap_take_block(&record);
    const bool is_read =
        schema != NULL && schema->type != IO_ROS_OTHER && io_mcap_equals(&encoding, "cdr");
    if (!record.is_bad && schema != NULL && !is_read) {
        note_stranger(reader, schema, &topic, &encoding);
    }
    if (record.is_bad || !is_read || topic.size >= IO_MCAP_TOPIC_MAX ||
        io_mcap_find_channel(reader, id) >= 0 ||
        reader->channels.count >= IO_MCAP_CHANNELS_READ_MAX) {
        return;
    }
    io_mcap_channel *channel = io_mcap_list_add(&reader->channels, sizeof(*channel));
    if (channel != NULL) {
        *channel = (io_mcap_channel){.id = id, .type = schema->type};
        io_mcap_copy(&topic, channel->topic, sizeof(channel->topic));
    }
}

void io_mcap_list_message(io_mcap_reader *reader, uint16_t channel_id, uint64_t time, int32_t chunk,
                          uint64_t offset)
{
    const int32_t channel = io_mcap_find_channel(reader, channel_id);
    if (channel < 0 || time > INT64_MAX) {
        return;
    }
    if (reader->messages.count >= IO_MCAP_MESSAGES_MAX) {
        reader->is_full = true;
        return;
    }
    io_mcap_message *message = io_mcap_list_add(&reader->messages, sizeof(*message));
    if (message == NULL) {
        reader->lacks_memory = true;
        return;
    }
    *message = (io_mcap_message){(int64_t)time, offset, chunk, channel};
}

void io_mcap_take_metadata(io_mcap_reader *reader, io_mcap_cursor record)
{
    const io_mcap_cursor name = io_mcap_take_block(&record);
    io_mcap_cursor pairs = io_mcap_take_block(&record);
    if (record.is_bad || !io_mcap_equals(&name, "relief") ||
        pairs.size >= sizeof(reader->metadata) - 1) {
        return;
    }
    memset(reader->metadata, 0, sizeof(reader->metadata));
    char *out = reader->metadata;
    while (pairs.size > 0) {
        /* The two lengths of a pair take more room than the two zeros that end its texts. */
        for (int i = 0; i < 2; i++) {
            const io_mcap_cursor text = io_mcap_take_block(&pairs);
            io_mcap_copy(&text, out, text.size + 1);
            out += text.size + 1;
        }
        if (pairs.is_bad) {
            memset(reader->metadata, 0, sizeof(reader->metadata));
            return;
        }
    }
}

const char *io_mcap_metadata(const io_mcap_reader *reader, const char *key)
{
    for (const char *text = reader->metadata; *text != '\0';) {
        const char *value = text + strlen(text) + 1;
        if (strcmp(text, key) == 0) {
            return value;
        }
        text = value + strlen(value) + 1;
    }
    return NULL;
}

static int compare(const void *a, const void *b)
{
    const io_mcap_message *x = a;
    const io_mcap_message *y = b;
    if (x->channel != y->channel) {
        return x->channel < y->channel ? -1 : 1;
    }
    if (x->time_ns != y->time_ns) {
        return x->time_ns < y->time_ns ? -1 : 1;
    }
    if (x->chunk != y->chunk) {
        return x->chunk < y->chunk ? -1 : 1;
    }
    return (x->offset > y->offset) - (x->offset < y->offset);
}

void io_mcap_sort(io_mcap_reader *reader)
{
    io_mcap_channel *channels = reader->channels.items;
    const io_mcap_message *messages = reader->messages.items;
    if (reader->messages.count > 0) {
        qsort(reader->messages.items, (size_t)reader->messages.count, sizeof(messages[0]), compare);
    }
    for (int32_t i = 0; i < reader->channels.count; i++) {
        channels[i].first = 0;
        channels[i].count = 0;
    }
    for (int32_t i = 0; i < reader->messages.count; i++) {
        io_mcap_channel *channel = &channels[messages[i].channel];
        channel->first = channel->count == 0 ? i : channel->first;
        channel->count++;
    }
}
