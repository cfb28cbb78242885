/* What is in an MCAP file: from its summary, or from its records one after the other. */
#include "io/mcap/read.h"

#include <zlib.h>

#define SUMMARY_MAX ((uint64_t)256 << 20)
#define RECORD_MAX ((uint64_t)16 << 20) /* of a schema, a channel, metadata */

static int32_t add_chunk(io_mcap_reader *reader, uint64_t offset)
{
    io_mcap_chunk *chunk = io_mcap_list_add(&reader->chunks, sizeof(*chunk));
    if (chunk == NULL) {
        reader->lacks_memory = true;
        return -1;
    }
    *chunk = (io_mcap_chunk){.offset = offset};
    return reader->chunks.count - 1;
}

/* ---- from record to record ------------------------------------------------------------------ */

static void take_loose_message(io_mcap_reader *reader, uint64_t offset)
{
    uint8_t head[IO_MCAP_MESSAGE_HEAD];
    if (io_mcap_read_at(reader, offset + IO_MCAP_RECORD_HEAD, head, sizeof(head))) {
        io_mcap_cursor c = {head, sizeof(head), false};
        const uint16_t id = (uint16_t)io_mcap_take_number(&c, 2);
        io_mcap_take(&c, 4);
        io_mcap_list_message(reader, id, io_mcap_take_number(&c, 8), -1, offset);
    }
}

static void take_small(io_mcap_reader *reader, uint8_t op, uint64_t offset, uint64_t size)
{
    io_buffer buffer = {0};
    if (size <= RECORD_MAX &&
        io_mcap_read_block(reader, offset + IO_MCAP_RECORD_HEAD, size, &buffer) == RLF_OK) {
        const io_mcap_cursor record = {buffer.data, (size_t)size, false};
        if (op == IO_MCAP_SCHEMA) {
            io_mcap_take_schema(reader, record);
        } else if (op == IO_MCAP_CHANNEL) {
            io_mcap_take_channel(reader, record);
        } else {
            io_mcap_take_metadata(reader, record);
        }
    }
    io_buffer_free(&buffer);
}

static void take_record(io_mcap_reader *reader, uint8_t op, uint64_t offset, uint64_t size)
{
    if (op == IO_MCAP_SCHEMA || op == IO_MCAP_CHANNEL || op == IO_MCAP_METADATA) {
        take_small(reader, op, offset, size);
    } else if (op == IO_MCAP_MESSAGE && size >= IO_MCAP_MESSAGE_HEAD) {
        take_loose_message(reader, offset);
    } else if (op == IO_MCAP_CHUNK) {
        const int32_t chunk = add_chunk(reader, offset);
        if (chunk >= 0) {
            io_mcap_walk_chunk(reader, chunk);
        }
    }
}

/* A message outside chunks; others are passed over. */
static void take_loose(io_mcap_reader *reader, uint8_t op, uint64_t offset, uint64_t size)
{
    if (op == IO_MCAP_MESSAGE && size >= IO_MCAP_MESSAGE_HEAD) {
        take_loose_message(reader, offset);
    }
}

/* Goes from record to record, from the file's beginning to the end of its data. Returns where it
 * stopped: at a record that is none, or at the end. */
static uint64_t walk(io_mcap_reader *reader,
                     void (*take)(io_mcap_reader *, uint8_t, uint64_t, uint64_t))
{
    uint64_t offset = IO_MCAP_MAGIC_SIZE;
    uint8_t head[IO_MCAP_RECORD_HEAD];
    while (!reader->lacks_memory && io_mcap_read_at(reader, offset, head, sizeof(head))) {
        io_mcap_cursor c = {head, sizeof(head), false};
        const uint8_t op = (uint8_t)io_mcap_take_number(&c, 1);
        const uint64_t size = io_mcap_take_number(&c, 8);
        const uint64_t left = reader->size - offset - IO_MCAP_RECORD_HEAD;
        if (op == 0 || op == IO_MCAP_DATA_END || op == IO_MCAP_FOOTER || size > left) {
            reader->is_to_end = op == IO_MCAP_DATA_END || op == IO_MCAP_FOOTER;
            break;
        }
        take(reader, op, offset, size);
        offset += IO_MCAP_RECORD_HEAD + size;
    }
    return offset;
}

/* ---- with a summary ------------------------------------------------------------------------- */

/* False when the block is not one of whole MessageIndex records. */
static bool list_indexes(io_mcap_reader *reader, int32_t chunk, uint64_t offset, uint64_t size)
{
    if (size == 0 || size > SUMMARY_MAX ||
        io_mcap_read_block(reader, offset, size, &reader->packed) != RLF_OK) {
        return false;
    }
    const int32_t count = reader->messages.count;
    io_mcap_cursor c = {reader->packed.data, (size_t)size, false};
    while (c.size > 0 && !c.is_bad) {
        io_mcap_cursor record = {0};
        if (io_mcap_take_record(&c, &record) != IO_MCAP_MESSAGE_INDEX) {
            c.is_bad = true;
            break;
        }
        const uint16_t id = (uint16_t)io_mcap_take_number(&record, 2);
        io_mcap_cursor places = io_mcap_take_block(&record);
        while (places.size >= 16) {
            const uint64_t time = io_mcap_take_number(&places, 8);
            io_mcap_list_message(reader, id, time, chunk, io_mcap_take_number(&places, 8));
        }
        c.is_bad = c.is_bad || record.is_bad;
    }
    reader->messages.count = c.is_bad ? count : reader->messages.count;
    return !c.is_bad;
}

/* The chunk's own index, or else the chunk. */
static void take_chunk_index(io_mcap_reader *reader, io_mcap_cursor record)
{
    io_mcap_take(&record, 16);
    const uint64_t offset = io_mcap_take_number(&record, 8);
    const uint64_t length = io_mcap_take_number(&record, 8);
    io_mcap_take_block(&record);
    const uint64_t index_length = io_mcap_take_number(&record, 8);
    if (record.is_bad || offset > reader->size || length > reader->size - offset) {
        reader->bad_chunks++;
        return;
    }
    const int32_t chunk = add_chunk(reader, offset);
    if (chunk >= 0 && !list_indexes(reader, chunk, offset + length, index_length)) {
        io_mcap_walk_chunk(reader, chunk);
    }
}

static void take_metadata_index(io_mcap_reader *reader, io_mcap_cursor record)
{
    const uint64_t offset = io_mcap_take_number(&record, 8);
    const uint64_t length = io_mcap_take_number(&record, 8);
    io_buffer buffer = {0};
    if (!record.is_bad && length >= IO_MCAP_RECORD_HEAD && length <= RECORD_MAX &&
        io_mcap_read_block(reader, offset, length, &buffer) == RLF_OK) {
        io_mcap_cursor c = {buffer.data, (size_t)length, false};
        io_mcap_cursor inner = {0};
        if (io_mcap_take_record(&c, &inner) == IO_MCAP_METADATA) {
            io_mcap_take_metadata(reader, inner);
        }
    }
    io_buffer_free(&buffer);
}

/* Records of one kind. Schemas go first, then channels, then what needs them. */
static int32_t take_all(io_mcap_reader *reader, io_mcap_cursor summary, io_mcap_op op,
                        void (*take)(io_mcap_reader *, io_mcap_cursor))
{
    int32_t count = 0;
    while (summary.size > 0 && !summary.is_bad) {
        io_mcap_cursor record = {0};
        if (io_mcap_take_record(&summary, &record) == op) {
            take(reader, record);
            count++;
        }
    }
    return count;
}

/* How many messages of each channel are listed so far, as io_mcap_sort counts them again. */
static void count_listed(io_mcap_reader *reader)
{
    io_mcap_channel *channels = reader->channels.items;
    const io_mcap_message *messages = reader->messages.items;
    for (int32_t i = 0; i < reader->channels.count; i++) {
        channels[i].count = 0;
    }
    for (int32_t i = 0; i < reader->messages.count; i++) {
        channels[messages[i].channel].count++;
    }
}

/* Whether Statistics count as many messages of each channel as are listed. */
static void take_statistics(io_mcap_reader *reader, io_mcap_cursor record)
{
    io_mcap_take(&record, 8 + 2 + 4 + 4 + 4 + 4 + 8 + 8);
    io_mcap_cursor counts = io_mcap_take_block(&record);
    const io_mcap_channel *channels = reader->channels.items;
    bool is_all = !record.is_bad;
    count_listed(reader);
    while (counts.size > 0 && !counts.is_bad) {
        const int32_t channel =
            io_mcap_find_channel(reader, (uint16_t)io_mcap_take_number(&counts, 2));
        const uint64_t count = io_mcap_take_number(&counts, 8);
        is_all = is_all && (channel < 0 || (uint64_t)channels[channel].count >= count);
    }
    reader->lists_all = is_all && !counts.is_bad;
}

/* Where the summary is: *out_begin 0 = there is none. False when the end of the file is not that of
 * an MCAP file. */
static bool find_summary(const io_mcap_reader *reader, uint64_t *out_begin, uint64_t *out_size,
                         uint32_t *out_crc)
{
    uint8_t end[IO_MCAP_FOOTER_SIZE + IO_MCAP_MAGIC_SIZE];
    if (reader->size < 2 * IO_MCAP_MAGIC_SIZE + IO_MCAP_FOOTER_SIZE) {
        return false;
    }
    const uint64_t footer_at = reader->size - sizeof(end);
    if (!io_mcap_read_at(reader, footer_at, end, sizeof(end)) ||
        memcmp(end + IO_MCAP_FOOTER_SIZE, io_mcap_magic, IO_MCAP_MAGIC_SIZE) != 0) {
        return false;
    }
    io_mcap_cursor c = {end, IO_MCAP_FOOTER_SIZE, false};
    io_mcap_cursor footer = {0};
    const uint8_t op = io_mcap_take_record(&c, &footer);
    *out_begin = io_mcap_take_number(&footer, 8);
    io_mcap_take(&footer, 8);
    *out_crc = (uint32_t)io_mcap_take_number(&footer, 4);
    *out_size = footer_at - *out_begin;
    return op == IO_MCAP_FOOTER && *out_begin < footer_at;
}

static io_mcap_summary take_summary(io_mcap_reader *reader, io_mcap_cursor summary)
{
    take_all(reader, summary, IO_MCAP_SCHEMA, io_mcap_take_schema);
    take_all(reader, summary, IO_MCAP_CHANNEL, io_mcap_take_channel);
    take_all(reader, summary, IO_MCAP_METADATA_INDEX, take_metadata_index);
    /* Without channels it says nothing about what the chunks hold. */
    if (take_all(reader, summary, IO_MCAP_CHUNK_INDEX, take_chunk_index) == 0 ||
        reader->channels.count == 0) {
        return IO_MCAP_SUMMARY_NONE;
    }
    take_all(reader, summary, IO_MCAP_STATISTICS, take_statistics);
    if (!reader->lists_all) {
        walk(reader, take_loose);
    }
    return IO_MCAP_SUMMARY_READ;
}

io_mcap_summary io_mcap_read_summary(io_mcap_reader *reader)
{
    uint64_t begin, size;
    uint32_t crc;
    if (!find_summary(reader, &begin, &size, &crc)) {
        return IO_MCAP_SUMMARY_NOT_CLOSED;
    }
    if (begin == 0) {
        return IO_MCAP_SUMMARY_NONE;
    }
    io_buffer buffer = {0};
    /* The CRC also covers the footer up to itself. */
    const uint64_t footer = IO_MCAP_FOOTER_SIZE - 4;
    const bool is_good =
        size <= SUMMARY_MAX &&
        io_mcap_read_block(reader, begin, size + footer, &buffer) == RLF_OK &&
        (crc == 0 || crc == (uint32_t)crc32_z(0, buffer.data, (size_t)(size + footer)));
    io_mcap_summary result = IO_MCAP_SUMMARY_DAMAGED;
    if (is_good) {
        result = take_summary(reader, (io_mcap_cursor){buffer.data, (size_t)size, false});
    }
    io_buffer_free(&buffer);
    return result;
}

/* ---- without one ---------------------------------------------------------------------------- */

bool io_mcap_scan(io_mcap_reader *reader, uint64_t *out_end)
{
    uint8_t magic[IO_MCAP_MAGIC_SIZE];
    if (!io_mcap_read_at(reader, 0, magic, sizeof(magic)) ||
        memcmp(magic, io_mcap_magic, sizeof(magic)) != 0) {
        return false;
    }
    *out_end = walk(reader, take_record);
    return true;
}
