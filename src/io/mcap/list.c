/* What is in an MCAP file, from its records one after the other: a summary repeats the channels,
 * and behind each chunk may be an index of its messages. */
#include "io/mcap/mcap.h"

#define RECORD_MAX ((uint64_t)16 << 20) /* of a schema, a channel, metadata */
#define INDEX_MAX ((uint64_t)256 << 20) /* of a chunk */

/* ---- records that say what is in the file --------------------------------------------------- */

static const io_mcap_schema *find_schema(const io_mcap_reader *reader, uint16_t id)
{
    for (int32_t i = 0; i < reader->schema_count; i++) {
        if (reader->schemas[i].id == id) {
            return &reader->schemas[i];
        }
    }
    return NULL;
}

static void take_schema(io_mcap_reader *reader, cursor record)
{
    io_mcap_schema schema = {.id = cursor_u16(&record)};
    cursor_text(&record, schema.name, sizeof(schema.name));
    for (int type = IO_ROS_OTHER + 1; type < IO_ROS_TYPE_COUNT && !record.is_short; type++) {
        if (strcmp(schema.name, io_ros_type_name((io_ros_type)type)) == 0) {
            schema.type = (io_ros_type)type;
        }
    }
    const bool is_wanted = schema.type != IO_ROS_OTHER || io_ros_is_stranger(schema.name);
    if (record.is_short || !is_wanted || find_schema(reader, schema.id) != NULL) {
        return;
    }
    if (io_list_grow((void **)(void *)&reader->schemas, reader->schema_count, 1,
                     &reader->schema_room, sizeof(schema)) == RLF_OK) {
        reader->schemas[reader->schema_count++] = schema;
    }
}

static void take_channel(io_mcap_reader *reader, cursor record)
{
    char topic[IO_ROS_TOPIC_MAX], encoding[32];
    const uint16_t id = cursor_u16(&record);
    const io_mcap_schema *schema = find_schema(reader, cursor_u16(&record));
    cursor_text(&record, topic, sizeof(topic));
    cursor_text(&record, encoding, sizeof(encoding));
    if (record.is_short || schema == NULL) {
        return;
    }
    if (schema->type != IO_ROS_OTHER && strcmp(encoding, "cdr") == 0) {
        io_ros_log_add_channel(reader->log, id, schema->type, topic, INT32_MAX);
    } else {
        io_ros_log_add_stranger(reader->log, topic, schema->name, encoding);
    }
}

static void take_message(io_mcap_reader *reader, cursor record, int32_t chunk, uint64_t offset)
{
    const uint16_t id = cursor_u16(&record);
    cursor_u32(&record);
    const uint64_t time = cursor_u64(&record);
    if (!record.is_short && time <= INT64_MAX) {
        io_ros_log_add_message(reader->log, id, (int64_t)time, chunk, offset);
    }
}

static void take_metadata(io_mcap_reader *reader, cursor record)
{
    char name[16];
    cursor_text(&record, name, sizeof(name));
    cursor pairs = cursor_block(&record);
    if (record.is_short || strcmp(name, "relief") != 0 ||
        pairs.left >= sizeof(reader->metadata) - 1) {
        return;
    }
    memset(reader->metadata, 0, sizeof(reader->metadata));
    char *out = reader->metadata;
    while (pairs.left > 0) {
        /* The two lengths of a pair take more room than the two zeros that end its texts. */
        for (int i = 0; i < 2; i++) {
            const cursor text = cursor_block(&pairs);
            cursor_copy(text, out, text.left + 1);
            out += text.left + 1;
        }
        if (pairs.is_short) {
            memset(reader->metadata, 0, sizeof(reader->metadata));
            return;
        }
    }
}

/* Others are passed over. `chunk` -1: in the file itself. */
static void take_record(io_mcap_reader *reader, uint8_t op, cursor record, int32_t chunk,
                        uint64_t offset)
{
    switch (op) {
    case IO_MCAP_SCHEMA: take_schema(reader, record); break;
    case IO_MCAP_CHANNEL: take_channel(reader, record); break;
    case IO_MCAP_METADATA: take_metadata(reader, record); break;
    case IO_MCAP_MESSAGE: take_message(reader, record, chunk, offset); break;
    default: break;
    }
}

/* ---- chunks --------------------------------------------------------------------------------- */

static void add_chunk(io_mcap_reader *reader, uint64_t offset, uint64_t end)
{
    if (io_list_grow((void **)(void *)&reader->chunks, reader->chunk_count, 1, &reader->chunk_room,
                     sizeof(reader->chunks[0])) != RLF_OK) {
        reader->log->lacks_memory = true;
        return;
    }
    reader->chunks[reader->chunk_count++] =
        (io_mcap_chunk){.offset = offset, .index_begin = end, .index_end = end};
}

/* One index record: times and places of a channel's messages. False when it is cut short. */
static bool list_places(io_ros_log *log, cursor record, int32_t chunk)
{
    const uint16_t id = cursor_u16(&record);
    cursor places = cursor_block(&record);
    while (places.data != NULL && places.left >= 16) {
        const uint64_t time = cursor_u64(&places);
        const uint64_t offset = cursor_u64(&places);
        if (time <= INT64_MAX) {
            io_ros_log_add_message(log, id, (int64_t)time, chunk, offset);
        }
    }
    return !record.is_short;
}

/* False when there is no index, or it is not one of whole records. */
static bool list_indexes(io_mcap_reader *reader, int32_t index)
{
    const io_mcap_chunk *chunk = &reader->chunks[index];
    const uint64_t size = chunk->index_end - chunk->index_begin;
    if (size == 0 || size > INDEX_MAX ||
        io_mcap_read_block(reader, chunk->index_begin, size, &reader->packed) != RLF_OK) {
        return false;
    }
    const int32_t count = reader->log->message_count;
    cursor c = {reader->packed.data, (size_t)size, false};
    bool is_good = true;
    while (c.left > 0 && is_good) {
        cursor record = {0};
        is_good = io_mcap_take_record(&c, &record) == IO_MCAP_MESSAGE_INDEX;
        is_good = is_good && list_places(reader->log, record, index);
    }
    if (!is_good) {
        io_ros_log_cut(reader->log, count);
    }
    return is_good;
}

static void look_into(io_mcap_reader *reader, int32_t index)
{
    cursor c;
    if (!io_mcap_load_chunk(reader, index, &c)) {
        return;
    }
    const uint8_t *begin = c.data;
    while (c.left > 0) {
        const uint64_t offset = (uint64_t)(c.data - begin);
        cursor record = {0};
        const uint8_t op = io_mcap_take_record(&c, &record);
        take_record(reader, op, record, index, offset);
    }
}

/* ---- the walk ------------------------------------------------------------------------------- */

typedef struct walk {
    uint64_t end;             /* where the data ends, or the walk did before it */
    bool is_to_end;           /* it came to the end of the data */
    bool is_summary_complete; /* which names the channels */
} walk;

static void take_from_file(io_mcap_reader *reader, uint8_t op, uint64_t offset, uint64_t size)
{
    const uint64_t content = offset + IO_MCAP_RECORD_HEAD;
    io_mcap_chunk *last = reader->chunk_count > 0 ? &reader->chunks[reader->chunk_count - 1] : NULL;
    if (op == IO_MCAP_CHUNK) {
        add_chunk(reader, offset, content + size);
    } else if (op == IO_MCAP_MESSAGE_INDEX && last != NULL && offset == last->index_end) {
        last->index_end = content + size;
    } else if (op == IO_MCAP_MESSAGE || op == IO_MCAP_SCHEMA || op == IO_MCAP_CHANNEL ||
               op == IO_MCAP_METADATA) {
        const uint64_t wanted = op == IO_MCAP_MESSAGE ? IO_MCAP_MESSAGE_HEAD : size;
        if (wanted <= size && wanted <= RECORD_MAX &&
            io_mcap_read_block(reader, content, wanted, &reader->packed) == RLF_OK) {
            const cursor record = {reader->packed.data, (size_t)wanted, false};
            take_record(reader, op, record, -1, offset);
        }
    }
}

/* Goes from record to record, to the end of the file or to what is none. */
static walk walk_file(io_mcap_reader *reader)
{
    walk w = {0};
    uint64_t offset = IO_MCAP_MAGIC_SIZE;
    uint8_t head[IO_MCAP_RECORD_HEAD];
    while (!reader->log->lacks_memory && io_mcap_read_at(reader, offset, head, sizeof(head))) {
        cursor c = {head, sizeof(head), false};
        const uint8_t op = cursor_u8(&c);
        const uint64_t size = cursor_u64(&c);
        const uint64_t left = (uint64_t)reader->file.size - offset - IO_MCAP_RECORD_HEAD;
        const bool is_end = op == IO_MCAP_DATA_END || op == IO_MCAP_FOOTER;
        w.end = w.is_to_end ? w.end : offset;
        w.is_to_end = w.is_to_end || is_end;
        if (op == 0 || op == IO_MCAP_FOOTER || size > left) {
            return w;
        }
        w.is_summary_complete |= w.is_to_end && op == IO_MCAP_CHANNEL;
        take_from_file(reader, op, offset, size);
        offset += IO_MCAP_RECORD_HEAD + size;
    }
    w.end = w.is_to_end ? w.end : offset;
    return w;
}

static bool has_magic(const io_mcap_reader *reader, int64_t offset)
{
    uint8_t magic[IO_MCAP_MAGIC_SIZE];
    return offset >= 0 && io_mcap_read_at(reader, (uint64_t)offset, magic, sizeof(magic)) &&
           memcmp(magic, io_mcap_magic, sizeof(magic)) == 0;
}

static rlf_result list_all(io_mcap_reader *reader)
{
    const int64_t size = reader->file.size;
    const char *path = reader->file.path;
    if (!has_magic(reader, 0)) {
        return rlf_fail(
            RLF_ERROR_FORMAT,
            "%s: is not an MCAP file, or has less than its first bytes: record it again", path);
    }
    const bool is_closed =
        size > 2 * IO_MCAP_MAGIC_SIZE && has_magic(reader, size - IO_MCAP_MAGIC_SIZE);
    const walk w = walk_file(reader);
    const bool is_whole = is_closed && w.is_to_end;
    for (int32_t i = 0; i < reader->chunk_count; i++) {
        if (!is_whole || !w.is_summary_complete || !list_indexes(reader, i)) {
            look_into(reader, i);
        }
    }
    const int chunks = (int)(reader->chunk_count - reader->bad_chunks);
    const int messages = (int)reader->log->message_count;
    if (!is_closed) {
        rlf_log(RLF_LOG_WARNING,
                "%s: was not closed as it should have been: its %d whole chunks, and %d messages, "
                "were found by reading all of it",
                path, chunks, messages);
    } else if (!w.is_to_end) {
        rlf_log(RLF_LOG_WARNING,
                "%s: is damaged (byte %llu of %llu): its %d whole chunks, and %d messages, were "
                "found by reading all of it",
                path, (unsigned long long)w.end, (unsigned long long)size, chunks, messages);
    }
    return io_ros_log_sort(reader->log);
}

/* ---- open and close ------------------------------------------------------------------------- */

rlf_result io_mcap_reader_open(const char *path, io_ros_log *log, io_mcap_reader **out)
{
    io_mcap_reader *reader = rlf_alloc(sizeof(*reader));
    *out = reader;
    if (reader == NULL) {
        return RLF_ERROR_MEMORY;
    }
    reader->log = log;
    log->self = reader;
    log->read = io_mcap_message;
    rlf_result result = io_file_open(&reader->file, path, "check the name");
    result = result == RLF_OK ? list_all(reader) : result;
    if (result != RLF_OK) {
        io_mcap_reader_close(out);
    }
    return result;
}

void io_mcap_reader_close(io_mcap_reader **reader)
{
    io_mcap_reader *r = *reader;
    *reader = NULL;
    if (r == NULL) {
        return;
    }
    io_file_close(&r->file);
    rlf_free(r->schemas);
    rlf_free(r->chunks);
    io_buffer_free(&r->packed);
    io_buffer_free(&r->loose);
    io_buffer_free(&r->plain);
    io_ros_cache_free(&r->cache);
    rlf_free(r);
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
