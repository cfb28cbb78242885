/* The end of an MCAP file: the summary, also when the disk is full. */
#define _POSIX_C_SOURCE 200809L
#include "io/mcap/mcap.h"

#include <errno.h>
#include <unistd.h>
#include <zlib.h>

static size_t entry_count(const io_mcap_writer *w)
{
    return w->entries.size / sizeof(chunk_entry);
}

static chunk_entry *entry_at(const io_mcap_writer *w, size_t index)
{
    return (chunk_entry *)(void *)w->entries.data + index;
}

static void put_chunk_index(io_mcap_writer *w, const chunk_entry *entry)
{
    io_byte_buffer *b = &w->out;
    uint32_t channels = 0;
    for (int i = 0; i < IO_MCAP_CHANNELS_MAX; i++) {
        channels += entry->index_at[i] != 0;
    }
    const size_t record = io_mcap_begin_record(b, IO_MCAP_CHUNK_INDEX);
    io_put_u64(b, (uint64_t)entry->first_ns);
    io_put_u64(b, (uint64_t)entry->last_ns);
    io_put_u64(b, entry->begin);
    io_put_u64(b, entry->length);
    io_put_u32(b, channels * 10);
    for (uint16_t i = 0; i < IO_MCAP_CHANNELS_MAX; i++) {
        if (entry->index_at[i] != 0) {
            io_put_u16(b, (uint16_t)(i + 1));
            io_put_u64(b, entry->index_at[i]);
        }
    }
    io_put_u64(b, entry->index_length);
    io_mcap_put_text(b, io_mcap_packing_name(w->packing));
    io_put_u64(b, entry->compressed);
    io_put_u64(b, entry->plain);
    io_mcap_end_record(b, record);
}

static uint64_t count_messages(const io_mcap_writer *w, uint64_t counts[IO_MCAP_CHANNELS_MAX])
{
    uint64_t all = 0;
    memset(counts, 0, IO_MCAP_CHANNELS_MAX * sizeof(counts[0]));
    for (size_t i = 0; i < entry_count(w); i++) {
        for (int c = 0; c < IO_MCAP_CHANNELS_MAX; c++) {
            counts[c] += entry_at(w, i)->messages[c];
            all += entry_at(w, i)->messages[c];
        }
    }
    return all;
}

static void put_statistics(io_mcap_writer *w)
{
    io_byte_buffer *b = &w->out;
    uint64_t counts[IO_MCAP_CHANNELS_MAX];
    const uint64_t all = count_messages(w, counts);
    uint64_t first = 0;
    uint64_t last = 0;
    for (size_t i = 0; i < entry_count(w); i++) {
        const chunk_entry *e = entry_at(w, i);
        first = i == 0 || (uint64_t)e->first_ns < first ? (uint64_t)e->first_ns : first;
        last = (uint64_t)e->last_ns > last ? (uint64_t)e->last_ns : last;
    }
    const size_t record = io_mcap_begin_record(b, IO_MCAP_STATISTICS);
    io_put_u64(b, all);
    io_put_u16(b, w->schema_count);
    io_put_u32(b, w->channel_count);
    io_put_u32(b, 0);
    io_put_u32(b, w->metadata_count);
    io_put_u32(b, (uint32_t)entry_count(w));
    io_put_u64(b, first);
    io_put_u64(b, last);
    io_put_u32(b, w->channel_count * 10u);
    for (uint16_t i = 0; i < w->channel_count; i++) {
        io_put_u16(b, (uint16_t)(i + 1));
        io_put_u64(b, counts[i]);
    }
    io_mcap_end_record(b, record);
}

/* Where a group of the summary is, for readers that look for one kind only. */
static void put_offset(io_byte_buffer *offsets, io_mcap_op op, uint64_t begin, uint64_t end)
{
    if (end > begin) {
        const size_t record = io_mcap_begin_record(offsets, IO_MCAP_SUMMARY_OFFSET);
        io_put_u8(offsets, (uint8_t)op);
        io_put_u64(offsets, begin);
        io_put_u64(offsets, end - begin);
        io_mcap_end_record(offsets, record);
    }
}

static void put_summary(io_mcap_writer *w, io_byte_buffer *offsets)
{
    io_byte_buffer *b = &w->out;
    uint64_t at = w->size + b->size;
    io_byte_buffer_add(b, w->schemas.data, w->schemas.size);
    put_offset(offsets, IO_MCAP_SCHEMA, at, w->size + b->size);
    at = w->size + b->size;
    io_byte_buffer_add(b, w->channels.data, w->channels.size);
    put_offset(offsets, IO_MCAP_CHANNEL, at, w->size + b->size);
    at = w->size + b->size;
    put_statistics(w);
    put_offset(offsets, IO_MCAP_STATISTICS, at, w->size + b->size);
    at = w->size + b->size;
    for (size_t i = 0; i < entry_count(w); i++) {
        put_chunk_index(w, entry_at(w, i));
    }
    put_offset(offsets, IO_MCAP_CHUNK_INDEX, at, w->size + b->size);
    at = w->size + b->size;
    io_byte_buffer_add(b, w->metadata.data, w->metadata.size);
    put_offset(offsets, IO_MCAP_METADATA_INDEX, at, w->size + b->size);
}

/* Everything behind the last chunk. */
static bool append_end(io_mcap_writer *w)
{
    io_byte_buffer *b = &w->out;
    io_byte_buffer offsets = {0};
    b->size = 0;
    size_t record = io_mcap_begin_record(b, IO_MCAP_DATA_END);
    io_put_u32(b, w->crc);
    io_mcap_end_record(b, record);
    const size_t summary = b->size;
    put_summary(w, &offsets);
    const uint64_t offsets_at = w->size + b->size;
    io_byte_buffer_add(b, offsets.data, offsets.size);
    record = io_mcap_begin_record(b, IO_MCAP_FOOTER);
    io_put_u64(b, w->size + summary);
    io_put_u64(b, offsets_at);
    io_mcap_set_u64(b, record - 8,
                    IO_MCAP_FOOTER_SIZE - IO_MCAP_RECORD_HEAD); /* the CRC covers it */
    if (!b->is_short) {
        io_put_u32(b, (uint32_t)crc32_z(0, b->data + summary, b->size - summary));
    }
    io_byte_buffer_add(b, io_mcap_magic, IO_MCAP_MAGIC_SIZE);
    const bool is_whole = !b->is_short && !offsets.is_short;
    io_byte_buffer_free(&offsets);
    return is_whole && io_mcap_append(w, b);
}

/* Takes the last chunk off the file, which makes room for its end. */
static bool drop_chunk(io_mcap_writer *w)
{
    const size_t count = entry_count(w);
    if (count == 0 || ftruncate(w->file, (off_t)entry_at(w, count - 1)->begin) != 0) {
        return false;
    }
    w->size = entry_at(w, count - 1)->begin;
    w->crc = count > 1 ? entry_at(w, count - 2)->crc : 0; /* 0 = not known */
    w->entries.size -= sizeof(chunk_entry);
    return lseek(w->file, (off_t)w->size, SEEK_SET) >= 0;
}

rlf_result io_mcap_writer_close(io_mcap_writer **writer, io_mcap_written *out)
{
    io_mcap_writer *w = *writer;
    *writer = NULL;
    if (w == NULL) {
        return RLF_OK;
    }
    rlf_result result = io_mcap_flush(w);
    const int first_errno = w->write_errno;
    bool is_whole = false;
    do {
        w->write_errno = 0;
        is_whole = append_end(w);
    } while (!is_whole && w->write_errno != 0 && drop_chunk(w));
    if (!is_whole && result == RLF_OK) {
        w->write_errno = w->write_errno != 0 ? w->write_errno : ENOMEM;
        result = io_mcap_fail_write(w);
    } else if (first_errno != 0) {
        w->write_errno = first_errno;
        result = io_mcap_fail_write(w);
    }
    if (out != NULL) {
        *out = (io_mcap_written){.bytes = w->size, .chunks = entry_count(w)};
        out->messages = count_messages(w, out->of_channel);
    }
    (void)fdatasync(w->file);
    const bool is_closed = close(w->file) == 0;
    w->file = -1;
    if (!is_closed && result == RLF_OK) {
        w->write_errno = errno;
        result = io_mcap_fail_write(w);
    }
    io_mcap_free_writer(w);
    return result;
}
