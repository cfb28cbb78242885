/* Writing MCAP files. */
#define _POSIX_C_SOURCE 200809L
#include "io/mcap/mcap.h"
#include "io/little.h"

#include <errno.h>
#include <lz4frame.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

/* Half of the usual time between two chunks, so that each of these reaches the disk. */
#define SYNC_INTERVAL_NS 500000000

const uint8_t io_mcap_magic[IO_MCAP_MAGIC_SIZE] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

/* ---- records -------------------------------------------------------------------------------- */

size_t io_mcap_begin_record(io_byte_buffer *b, io_mcap_op op)
{
    io_put_u8(b, (uint8_t)op);
    io_put_u64(b, 0);
    return b->size;
}

void io_mcap_set_u64(io_byte_buffer *b, size_t at, uint64_t value)
{
    io_little(&value, 1, sizeof(value));
    if (!b->is_short) {
        memcpy(b->data + at, &value, sizeof(value));
    }
}

void io_mcap_end_record(io_byte_buffer *b, size_t begin)
{
    io_mcap_set_u64(b, begin - 8, b->size - begin);
}

void io_mcap_put_text(io_byte_buffer *b, const char *text)
{
    io_put_u32(b, (uint32_t)strlen(text));
    io_byte_buffer_add(b, text, strlen(text));
}

/* ---- the file ------------------------------------------------------------------------------- */

rlf_result io_mcap_fail_write(const io_mcap_writer *w)
{
    return rlf_fail(RLF_ERROR_IO,
                    "%s: cannot be written any further: %s: what was recorded before is kept; free "
                    "some space or write elsewhere",
                    w->path, strerror(w->write_errno));
}

bool io_mcap_append(io_mcap_writer *w, const io_byte_buffer *b)
{
    size_t done = 0;
    while (done < b->size && w->write_errno == 0) {
        const ssize_t got = write(w->file, b->data + done, b->size - done);
        if (got > 0) {
            done += (size_t)got;
        } else if (got < 0 && errno != EINTR) {
            w->write_errno = errno;
        }
    }
    if (w->write_errno == 0) {
        w->crc = (uint32_t)crc32_z(w->crc, b->data, b->size);
        w->size += b->size;
        return true;
    }
    if (ftruncate(w->file, (off_t)w->size) == 0) {
        lseek(w->file, (off_t)w->size, SEEK_SET);
    }
    return false;
}

void io_mcap_free_writer(io_mcap_writer *w)
{
    if (w->file >= 0) {
        close(w->file);
    }
    io_byte_buffer_free(&w->head);
    io_byte_buffer_free(&w->schemas);
    io_byte_buffer_free(&w->channels);
    io_byte_buffer_free(&w->metadata);
    io_byte_buffer_free(&w->chunk);
    for (int i = 0; i < IO_MCAP_CHANNELS_MAX; i++) {
        io_byte_buffer_free(&w->index[i]);
    }
    io_byte_buffer_free(&w->out);
    io_byte_buffer_free(&w->entries);
    rlf_free(w);
}

static rlf_result open_file(io_mcap_writer *w, const char *path)
{
    if (strlen(path) >= sizeof(w->path)) {
        return rlf_fail(RLF_ERROR_INVALID, "%.100s...: the path is too long: use a shorter one",
                        path);
    }
    memcpy(w->path, path, strlen(path) + 1);
    return io_out_open_in_place(path, &w->file);
}

rlf_result io_mcap_writer_create(const char *path, io_packing packing, io_mcap_writer **out)
{
    *out = NULL;
    io_mcap_writer *w = rlf_alloc(sizeof(*w));
    if (w == NULL) {
        return RLF_ERROR_MEMORY;
    }
    w->file = -1;
    w->packing = packing;
    rlf_result result = open_file(w, path);
    if (result == RLF_OK) {
        char library[32];
        snprintf(library, sizeof(library), "relief %d.%d.%d", RLF_VERSION_MAJOR, RLF_VERSION_MINOR,
                 RLF_VERSION_PATCH);
        io_byte_buffer_add(&w->head, io_mcap_magic, IO_MCAP_MAGIC_SIZE);
        const size_t record = io_mcap_begin_record(&w->head, IO_MCAP_HEADER);
        io_mcap_put_text(&w->head, "ros2");
        io_mcap_put_text(&w->head, library);
        io_mcap_end_record(&w->head, record);
        result = io_byte_buffer_check(&w->head);
    }
    if (result != RLF_OK) {
        io_mcap_free_writer(w);
        return result;
    }
    *out = w;
    return RLF_OK;
}

/* ---- what goes before the messages ---------------------------------------------------------- */

/* The record also stands in the summary. */
static void add_twice(io_mcap_writer *w, const io_byte_buffer *b, size_t from)
{
    if (!b->is_short) {
        io_byte_buffer_add(&w->head, b->data + from, b->size - from);
    }
}

void io_mcap_add_schema(io_mcap_writer *w, const char *name, const char *text)
{
    const size_t from = w->schemas.size;
    const size_t record = io_mcap_begin_record(&w->schemas, IO_MCAP_SCHEMA);
    io_put_u16(&w->schemas, ++w->schema_count);
    io_mcap_put_text(&w->schemas, name);
    io_mcap_put_text(&w->schemas, "ros2msg");
    io_mcap_put_text(&w->schemas, text);
    io_mcap_end_record(&w->schemas, record);
    add_twice(w, &w->schemas, from);
}

uint16_t io_mcap_add_channel(io_mcap_writer *w, const char *topic, const char *qos)
{
    if (!RLF_ASSERT(w->channel_count < IO_MCAP_CHANNELS_MAX)) {
        return w->channel_count;
    }
    const size_t from = w->channels.size;
    const size_t record = io_mcap_begin_record(&w->channels, IO_MCAP_CHANNEL);
    io_put_u16(&w->channels, ++w->channel_count);
    io_put_u16(&w->channels, w->schema_count);
    io_mcap_put_text(&w->channels, topic);
    io_mcap_put_text(&w->channels, "cdr");
    static const char key[] = "offered_qos_profiles";
    io_put_u32(&w->channels, (uint32_t)(8 + strlen(key) + strlen(qos)));
    io_mcap_put_text(&w->channels, key);
    io_mcap_put_text(&w->channels, qos);
    io_mcap_end_record(&w->channels, record);
    add_twice(w, &w->channels, from);
    return w->channel_count;
}

void io_mcap_add_metadata(io_mcap_writer *w, const char *name, const io_mcap_pair *pairs,
                          size_t count)
{
    const uint64_t at = w->size + w->head.size;
    const size_t begin = w->head.size;
    const size_t record = io_mcap_begin_record(&w->head, IO_MCAP_METADATA);
    io_mcap_put_text(&w->head, name);
    size_t size = 0;
    for (size_t i = 0; i < count; i++) {
        size += 8 + strlen(pairs[i].key) + strlen(pairs[i].value);
    }
    io_put_u32(&w->head, (uint32_t)size);
    for (size_t i = 0; i < count; i++) {
        io_mcap_put_text(&w->head, pairs[i].key);
        io_mcap_put_text(&w->head, pairs[i].value);
    }
    io_mcap_end_record(&w->head, record);
    const size_t index = io_mcap_begin_record(&w->metadata, IO_MCAP_METADATA_INDEX);
    io_put_u64(&w->metadata, at);
    io_put_u64(&w->metadata, w->head.size - begin);
    io_mcap_put_text(&w->metadata, name);
    io_mcap_end_record(&w->metadata, index);
    w->metadata_count++;
}

/* ---- compression ---------------------------------------------------------------------------- */

/* JPEG and RVL have little left to squeeze: the fastest level finds it. */
#define ZSTD_LEVEL 1

const char *io_mcap_packing_name(io_packing packing)
{
    return packing == IO_PACKING_ZSTD ? "zstd" : packing == IO_PACKING_LZ4 ? "lz4" : "";
}

rlf_result io_mcap_compress(io_packing packing, const uint8_t *data, size_t size,
                            io_byte_buffer *out)
{
    if (packing == IO_PACKING_NONE) {
        io_byte_buffer_add(out, data, size);
        return io_byte_buffer_check(out);
    }
    const bool is_zstd = packing == IO_PACKING_ZSTD;
    LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
    preferences.frameInfo.contentSize = size;
    const size_t bound =
        is_zstd ? ZSTD_compressBound(size) : LZ4F_compressFrameBound(size, &preferences);
    uint8_t *place = io_byte_buffer_reserve(out, bound);
    if (place == NULL) {
        return io_byte_buffer_check(out);
    }
    const size_t got = is_zstd ? ZSTD_compress(place, bound, data, size, ZSTD_LEVEL)
                               : LZ4F_compressFrame(place, bound, data, size, &preferences);
    if (is_zstd ? ZSTD_isError(got) : LZ4F_isError(got)) {
        return rlf_fail(RLF_ERROR_MEMORY,
                        "%s refuses to compress %zu bytes: use --compression "
                        "none",
                        io_mcap_packing_name(packing), size);
    }
    io_byte_buffer_grow(out, got);
    return RLF_OK;
}

/* ---- messages and chunks -------------------------------------------------------------------- */

io_byte_buffer *io_mcap_begin(io_mcap_writer *w, uint16_t channel, int64_t time_ns)
{
    const uint64_t time = time_ns > 0 ? (uint64_t)time_ns : 0;
    w->message_at = w->chunk.size;
    w->message_channel = channel;
    w->message_ns = (int64_t)time;
    io_mcap_begin_record(&w->chunk, IO_MCAP_MESSAGE);
    io_put_u16(&w->chunk, channel);
    io_put_u32(&w->chunk, w->sequence[channel - 1]);
    io_put_u64(&w->chunk, time);
    io_put_u64(&w->chunk, time);
    return &w->chunk;
}

void io_mcap_end(io_mcap_writer *w, bool is_good)
{
    if (!is_good || w->chunk.is_short) {
        w->chunk.size = w->message_at;
        return;
    }
    io_mcap_end_record(&w->chunk, w->message_at + IO_MCAP_RECORD_HEAD);
    const bool is_first = w->message_at == 0;
    w->first_ns = is_first || w->message_ns < w->first_ns ? w->message_ns : w->first_ns;
    w->last_ns = is_first || w->message_ns > w->last_ns ? w->message_ns : w->last_ns;
    io_put_u64(&w->index[w->message_channel - 1], (uint64_t)w->message_ns);
    io_put_u64(&w->index[w->message_channel - 1], w->message_at);
    w->sequence[w->message_channel - 1]++;
}

size_t io_mcap_gathered(const io_mcap_writer *w)
{
    return w->chunk.size;
}

static rlf_result put_chunk(io_mcap_writer *w, chunk_entry *entry)
{
    io_byte_buffer *b = &w->out;
    entry->begin = w->size + b->size;
    const size_t record = io_mcap_begin_record(b, IO_MCAP_CHUNK);
    io_put_u64(b, (uint64_t)entry->first_ns);
    io_put_u64(b, (uint64_t)entry->last_ns);
    io_put_u64(b, entry->plain);
    io_put_u32(b, (uint32_t)crc32_z(0, w->chunk.data, w->chunk.size));
    io_mcap_put_text(b, io_mcap_packing_name(w->packing));
    io_put_u64(b, 0);
    const size_t begin = b->size;
    rlf_result result = io_mcap_compress(w->packing, w->chunk.data, w->chunk.size, b);
    entry->compressed = b->size - begin;
    io_mcap_set_u64(b, begin - 8, entry->compressed);
    io_mcap_end_record(b, record);
    entry->length = w->size + b->size - entry->begin;
    return result;
}

static void put_indexes(io_mcap_writer *w, chunk_entry *entry)
{
    io_byte_buffer *b = &w->out;
    const size_t begin = b->size;
    for (uint16_t i = 0; i < w->channel_count; i++) {
        if (w->index[i].size == 0) {
            continue;
        }
        entry->index_at[i] = w->size + b->size;
        entry->messages[i] = (uint32_t)(w->index[i].size / 16);
        const size_t record = io_mcap_begin_record(b, IO_MCAP_MESSAGE_INDEX);
        io_put_u16(b, (uint16_t)(i + 1));
        io_put_u32(b, (uint32_t)w->index[i].size);
        io_byte_buffer_add(b, w->index[i].data, w->index[i].size);
        io_mcap_end_record(b, record);
        w->index[i].size = 0;
    }
    entry->index_length = b->size - begin;
}

/* The head alone when no message was gathered. */
static rlf_result put_out(io_mcap_writer *w, chunk_entry *entry)
{
    w->out.size = 0;
    io_byte_buffer_add(&w->out, w->head.data, w->head.size);
    rlf_result result = io_byte_buffer_check(&w->head);
    if (result == RLF_OK && w->chunk.size > 0) {
        entry->first_ns = w->first_ns;
        entry->last_ns = w->last_ns;
        entry->plain = w->chunk.size;
        result = put_chunk(w, entry);
        put_indexes(w, entry);
    }
    return result == RLF_OK ? io_byte_buffer_check(&w->out) : result;
}

rlf_result io_mcap_flush(io_mcap_writer *w)
{
    if (w->write_errno != 0) {
        return io_mcap_fail_write(w);
    }
    if (w->chunk.size == 0 && w->head.size == 0) {
        return io_byte_buffer_check(&w->chunk);
    }
    chunk_entry entry;
    memset(&entry, 0, sizeof(entry));
    rlf_result result = put_out(w, &entry);
    w->chunk.size = 0;
    if (result != RLF_OK) {
        return result;
    }
    if (!io_mcap_append(w, &w->out)) {
        return io_mcap_fail_write(w);
    }
    w->head.size = 0;
    if (entry.length > 0) {
        entry.crc = w->crc;
        io_byte_buffer_add(&w->entries, &entry, sizeof(entry));
    }
    /* Turning a clip into another kind writes many chunks a second. */
    const int64_t now = rlf_clock_ns();
    if (now - w->synced_ns >= SYNC_INTERVAL_NS) {
        w->synced_ns = now;
        (void)fdatasync(w->file); /* a pipe has no disk behind it: that is no failure */
    }
    return io_byte_buffer_check(&w->entries);
}
