/* Reading MCAP files: the lists, and messages out of them. */
#define _POSIX_C_SOURCE 200809L
#include "io/mcap/reader.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define LIST_FIRST 64

void *io_mcap_list_add(io_mcap_list *list, size_t size)
{
    if (list->count == list->capacity) {
        const int32_t capacity = list->capacity > 0 ? list->capacity * 2 : LIST_FIRST;
        void *items = rlf_alloc_array((size_t)capacity, size);
        if (items == NULL) {
            return NULL;
        }
        if (list->count > 0) {
            memcpy(items, list->items, (size_t)list->count * size);
        }
        rlf_free(list->items);
        list->items = items;
        list->capacity = capacity;
    }
    return (char *)list->items + (size_t)list->count++ * size;
}

bool io_mcap_read_at(const io_mcap_reader *reader, uint64_t offset, void *out, size_t size)
{
    if (offset > reader->size || size > reader->size - offset) {
        return false;
    }
    size_t done = 0;
    while (done < size) {
        const ssize_t got =
            pread(reader->file, (char *)out + done, size - done, (off_t)(offset + done));
        if (got <= 0 && !(got < 0 && errno == EINTR)) {
            return false;
        }
        done += got > 0 ? (size_t)got : 0;
    }
    return true;
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

/* ---- lists ------------------------------------------------------------------------------------
 */

void io_mcap_take_schema(io_mcap_reader *reader, io_mcap_cursor record)
{
    const uint16_t id = (uint16_t)io_mcap_take_number(&record, 2);
    const io_mcap_cursor name = io_mcap_take_block(&record);
    for (int type = IO_ROS_OTHER + 1; type < IO_ROS_TYPE_COUNT && !name.is_bad; type++) {
        if (io_mcap_equals(&name, io_ros_type_name((io_ros_type)type))) {
            io_mcap_schema *schema = io_mcap_list_add(&reader->schemas, sizeof(*schema));
            if (schema != NULL && reader->schemas.count < IO_MCAP_CHANNELS_READ_MAX) {
                *schema = (io_mcap_schema){id, (io_ros_type)type};
            } else if (schema != NULL) {
                reader->schemas.count--;
            }
        }
    }
}

static io_ros_type type_of_schema(const io_mcap_reader *reader, uint16_t id)
{
    const io_mcap_schema *schemas = reader->schemas.items;
    for (int32_t i = 0; i < reader->schemas.count; i++) {
        if (schemas[i].id == id) {
            return schemas[i].type;
        }
    }
    return IO_ROS_OTHER;
}

static int32_t find_channel(const io_mcap_reader *reader, uint16_t id)
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
    const io_ros_type type = type_of_schema(reader, (uint16_t)io_mcap_take_number(&record, 2));
    const io_mcap_cursor topic = io_mcap_take_block(&record);
    const io_mcap_cursor encoding = io_mcap_take_block(&record);
    if (record.is_bad || type == IO_ROS_OTHER || !io_mcap_equals(&encoding, "cdr") ||
        topic.size >= IO_MCAP_TOPIC_MAX || find_channel(reader, id) >= 0 ||
        reader->channels.count >= IO_MCAP_CHANNELS_READ_MAX) {
        return;
    }
    io_mcap_channel *channel = io_mcap_list_add(&reader->channels, sizeof(*channel));
    if (channel != NULL) {
        *channel = (io_mcap_channel){.id = id, .type = type};
        io_mcap_copy(&topic, channel->topic, sizeof(channel->topic));
    }
}

void io_mcap_list_message(io_mcap_reader *reader, uint16_t channel_id, uint64_t time, int32_t chunk,
                          uint64_t offset)
{
    const int32_t channel = find_channel(reader, channel_id);
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

/* ---- open and close ---------------------------------------------------------------------------
 */

static rlf_result open_file(io_mcap_reader *reader, const char *path)
{
    struct stat status;
    if (strlen(path) >= sizeof(reader->path)) {
        return rlf_fail(RLF_ERROR_INVALID, "%.100s...: the path is too long: use a shorter one",
                        path);
    }
    memcpy(reader->path, path, strlen(path) + 1);
    reader->file = open(path, O_RDONLY | O_CLOEXEC);
    if (reader->file < 0 || fstat(reader->file, &status) != 0) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be opened: %s: check the name", path,
                        strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        return rlf_fail(RLF_ERROR_IO, "%s: is not a regular file: give the name of a file", path);
    }
    reader->size = (uint64_t)status.st_size;
    return io_mcap_compressor_create(&reader->compressor);
}

static void forget(io_mcap_reader *reader)
{
    reader->schemas.count = 0;
    reader->channels.count = 0;
    reader->chunks.count = 0;
    reader->messages.count = 0;
    for (int i = 0; i < IO_MCAP_CACHED; i++) {
        reader->cache[i].chunk = -1;
    }
}

static rlf_result list_all(io_mcap_reader *reader)
{
    forget(reader);
    if (!io_mcap_read_summary(reader)) {
        forget(reader);
        if (!io_mcap_scan(reader)) {
            return rlf_fail(RLF_ERROR_FORMAT,
                            "%s: is not an MCAP file, or has less than its first bytes: record it "
                            "again",
                            reader->path);
        }
        rlf_log(RLF_LOG_WARNING,
                "%s: was not closed as it should have been, or has no index: its %d whole chunks "
                "were found by reading all of it",
                reader->path, (int)(reader->chunks.count - reader->bad_chunks));
    }
    if (reader->is_full) {
        rlf_log(RLF_LOG_WARNING, "%s: has more than %d messages: the rest is left out",
                reader->path, IO_MCAP_MESSAGES_MAX);
    }
    io_mcap_sort(reader);
    return reader->lacks_memory
               ? rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory for its index", reader->path)
               : RLF_OK;
}

rlf_result io_mcap_reader_open(const char *path, io_mcap_reader **out)
{
    *out = NULL;
    io_mcap_reader *reader = rlf_alloc(sizeof(*reader));
    if (reader == NULL) {
        return RLF_ERROR_MEMORY;
    }
    reader->file = -1;
    rlf_result result = open_file(reader, path);
    if (result == RLF_OK) {
        result = list_all(reader);
    }
    if (result != RLF_OK) {
        io_mcap_reader_close(&reader);
        return result;
    }
    *out = reader;
    return RLF_OK;
}

void io_mcap_reader_close(io_mcap_reader **reader)
{
    io_mcap_reader *r = *reader;
    *reader = NULL;
    if (r == NULL) {
        return;
    }
    if (r->file >= 0) {
        close(r->file);
    }
    io_mcap_compressor_destroy(&r->compressor);
    rlf_free(r->schemas.items);
    rlf_free(r->channels.items);
    rlf_free(r->chunks.items);
    rlf_free(r->messages.items);
    io_buffer_free(&r->packed);
    io_buffer_free(&r->loose);
    for (int i = 0; i < IO_MCAP_CACHED; i++) {
        io_buffer_free(&r->cache[i].buffer);
    }
    rlf_free(r);
}

/* ---- what others ask --------------------------------------------------------------------------
 */

int32_t io_mcap_channel_count(const io_mcap_reader *reader)
{
    return reader->channels.count;
}

const io_mcap_channel *io_mcap_channel_at(const io_mcap_reader *reader, int32_t index)
{
    return (const io_mcap_channel *)reader->channels.items + index;
}

const io_mcap_message *io_mcap_message_at(const io_mcap_reader *reader, int32_t index)
{
    return (const io_mcap_message *)reader->messages.items + index;
}

void io_mcap_set_time(io_mcap_reader *reader, int32_t index, int64_t time_ns)
{
    ((io_mcap_message *)reader->messages.items)[index].time_ns = time_ns;
}

static rlf_result fail_message(const io_mcap_reader *reader, const io_mcap_message *m)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s: a message of %s at %.3f s is damaged: record it again",
                    reader->path, io_mcap_channel_at(reader, m->channel)->topic,
                    1e-9 * (double)m->time_ns);
}

/* Content of a record that is expected to be a message of the channel. */
static rlf_result take_message(const io_mcap_reader *reader, const io_mcap_message *m,
                               io_mcap_cursor bytes, io_cdr_span *out)
{
    io_mcap_cursor record = {0};
    const uint8_t op = io_mcap_take_record(&bytes, &record);
    const uint16_t id = (uint16_t)io_mcap_take_number(&record, 2);
    io_mcap_take(&record, IO_MCAP_MESSAGE_HEAD - 2);
    if (op != IO_MCAP_MESSAGE || record.is_bad ||
        id != io_mcap_channel_at(reader, m->channel)->id) {
        return fail_message(reader, m);
    }
    *out = (io_cdr_span){record.data, record.size};
    return RLF_OK;
}

static rlf_result read_loose(io_mcap_reader *reader, const io_mcap_message *m, io_cdr_span *out)
{
    uint64_t size = 0;
    if (!io_mcap_read_at(reader, m->offset + 1, &size, sizeof(size)) || size > IO_MCAP_CHUNK_MAX ||
        io_mcap_read_block(reader, m->offset, size + IO_MCAP_RECORD_HEAD, &reader->loose) !=
            RLF_OK) {
        return fail_message(reader, m);
    }
    const io_mcap_cursor bytes = {reader->loose.data, (size_t)size + IO_MCAP_RECORD_HEAD, false};
    return take_message(reader, m, bytes, out);
}

rlf_result io_mcap_read(io_mcap_reader *reader, int32_t index, io_cdr_span *out)
{
    const io_mcap_message *m = io_mcap_message_at(reader, index);
    if (m->chunk < 0) {
        return read_loose(reader, m, out);
    }
    const io_mcap_cached *chunk = io_mcap_load_chunk(reader, m->chunk);
    if (chunk == NULL || m->offset > chunk->size) {
        return fail_message(reader, m);
    }
    const io_mcap_cursor bytes = {chunk->buffer.data + m->offset, chunk->size - (size_t)m->offset,
                                  false};
    return take_message(reader, m, bytes, out);
}
