/* Reading MCAP files: opening, and messages out of them. */
#include "io/mcap/read.h"

/* ---- open and close ------------------------------------------------------------------------- */

static void forget(io_mcap_reader *reader)
{
    reader->schemas.count = 0;
    reader->channels.count = 0;
    reader->chunks.count = 0;
    reader->messages.count = 0;
    reader->bad_chunks = 0;
    reader->strangers[0] = '\0';
    for (int i = 0; i < IO_MCAP_CACHED; i++) {
        reader->cache[i].chunk = -1;
    }
}

static void tell_scan(const io_mcap_reader *reader, io_mcap_summary summary, uint64_t end)
{
    const int chunks = (int)(reader->chunks.count - reader->bad_chunks);
    if (summary == IO_MCAP_SUMMARY_NOT_CLOSED) {
        rlf_log(RLF_LOG_WARNING,
                "%s: was not closed as it should have been: its %d whole chunks, and %d messages, "
                "were found by reading all of it",
                reader->file.path, chunks, (int)reader->messages.count);
    } else if (summary == IO_MCAP_SUMMARY_DAMAGED || !reader->is_to_end) {
        rlf_log(RLF_LOG_WARNING,
                "%s: is damaged (byte %llu of %llu): its %d whole chunks, and %d messages, were "
                "found by reading all of it",
                reader->file.path, (unsigned long long)end, (unsigned long long)reader->size,
                chunks, (int)reader->messages.count);
    }
}

static rlf_result list_all(io_mcap_reader *reader)
{
    forget(reader);
    const io_mcap_summary summary = io_mcap_read_summary(reader);
    if (summary != IO_MCAP_SUMMARY_READ) {
        uint64_t end = 0;
        forget(reader);
        if (!io_mcap_scan(reader, &end)) {
            return rlf_fail(RLF_ERROR_FORMAT,
                            "%s: is not an MCAP file, or has less than its first bytes: record it "
                            "again",
                            reader->file.path);
        }
        tell_scan(reader, summary, end);
    }
    if (reader->is_full) {
        rlf_log(RLF_LOG_WARNING, "%s: has more than %d messages: the rest is left out",
                reader->file.path, IO_MCAP_MESSAGES_MAX);
    }
    io_mcap_sort(reader);
    return reader->lacks_memory
               ? rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory for its index", reader->file.path)
               : RLF_OK;
}

rlf_result io_mcap_reader_open(const char *path, io_mcap_reader **out)
{
    *out = NULL;
    io_mcap_reader *reader = rlf_alloc(sizeof(*reader));
    if (reader == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = io_file_open(&reader->file, path, "check the name");
    reader->size = (uint64_t)reader->file.size;
    result = result == RLF_OK ? io_mcap_compressor_create(&reader->compressor) : result;
    result = result == RLF_OK ? list_all(reader) : result;
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
    io_file_close(&r->file);
    io_mcap_compressor_destroy(&r->compressor);
    rlf_free(r->schemas.items);
    rlf_free(r->channels.items);
    rlf_free(r->chunks.items);
    rlf_free(r->messages.items);
    io_buffer_free(&r->packed);
    io_buffer_free(&r->loose);
    io_buffer_free(&r->plain);
    for (int i = 0; i < IO_MCAP_CACHED; i++) {
        io_buffer_free(&r->cache[i].buffer);
    }
    rlf_free(r);
}

/* ---- what others ask ------------------------------------------------------------------------ */

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

const char *io_mcap_strangers(const io_mcap_reader *reader)
{
    return reader->strangers;
}

static rlf_result fail_message(const io_mcap_reader *reader, const io_mcap_message *m)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s: a message of %s at %.3f s is damaged: record it again",
                    reader->file.path, io_mcap_channel_at(reader, m->channel)->topic,
                    1e-9 * (double)m->time_ns);
}

/* `ros2 bag record --compression-mode message` packs each message by itself. */
static rlf_result unpack_message(io_mcap_reader *reader, const io_mcap_message *m,
                                 io_cdr_span *inout)
{
    const uint64_t size = io_mcap_zstd_size(inout->data, inout->size);
    if (size == 0) {
        return RLF_OK;
    }
    if (size > IO_MCAP_CHUNK_MAX) {
        return fail_message(reader, m);
    }
    rlf_result result = io_buffer_reserve(&reader->plain, (size_t)size);
    if (result == RLF_OK && !io_mcap_decompress(reader->compressor, IO_MCAP_ZSTD, inout->data,
                                                inout->size, reader->plain.data, (size_t)size)) {
        return fail_message(reader, m);
    }
    *inout = (io_cdr_span){reader->plain.data, (size_t)size};
    return result;
}

/* Content of a record that is expected to be a message of the channel. */
static rlf_result take_message(io_mcap_reader *reader, const io_mcap_message *m,
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
    return unpack_message(reader, m, out);
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

static rlf_result read_message(io_mcap_reader *reader, int32_t index, io_cdr_span *out)
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

rlf_result io_mcap_read(io_mcap_reader *reader, int32_t index, io_cdr_reader *out)
{
    io_cdr_span bytes = {NULL, 0};
    rlf_result result = read_message(reader, index, &bytes);
    *out = io_cdr_open(bytes.data, bytes.size);
    return result;
}
