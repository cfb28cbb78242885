/* Chunks: decompressing, checking and looking into them. */
#include "io/mcap/read.h"

#include <zlib.h>

/* The most that is in front of a chunk's bytes: numbers, and the name of the compression. */
#define CHUNK_HEAD_MAX (IO_MCAP_RECORD_HEAD + 8 + 8 + 8 + 4 + 4 + 16 + 8)

typedef struct chunk_head {
    uint64_t plain_size, packed_size;
    uint64_t packed_at; /* in the file */
    uint32_t crc;       /* 0 = none */
    io_mcap_compression compression;
} chunk_head;

/* Says what is wrong, or returns NULL. */
static const char *read_head(const io_mcap_reader *reader, uint64_t offset, chunk_head *out)
{
    uint8_t bytes[CHUNK_HEAD_MAX];
    const uint64_t left = offset < reader->size ? reader->size - offset : 0;
    const size_t size = left < CHUNK_HEAD_MAX ? (size_t)left : CHUNK_HEAD_MAX;
    io_mcap_cursor c = {bytes, size, !io_mcap_read_at(reader, offset, bytes, size)};
    const uint8_t op = (uint8_t)io_mcap_take_number(&c, 1);
    const uint64_t record = io_mcap_take_number(&c, 8);
    const uint8_t *begin = c.data;
    io_mcap_take(&c, 16);
    out->plain_size = io_mcap_take_number(&c, 8);
    out->crc = (uint32_t)io_mcap_take_number(&c, 4);
    const io_mcap_cursor name = io_mcap_take_block(&c);
    out->packed_size = io_mcap_take_number(&c, 8);
    if (c.is_bad || op != IO_MCAP_CHUNK) {
        return "its head is damaged";
    }
    const uint64_t head = (uint64_t)(c.data - begin);
    out->packed_at = offset + IO_MCAP_RECORD_HEAD + head;
    if (record < head || out->packed_size > record - head ||
        out->packed_size > reader->size - out->packed_at) {
        return "it is cut short";
    }
    if (!io_mcap_compression_parse(&name, &out->compression)) {
        return "its compression is neither zstd nor lz4";
    }
    return out->plain_size > IO_MCAP_CHUNK_MAX || out->packed_size > IO_MCAP_CHUNK_MAX
               ? "it is larger than 256 MiB"
               : NULL;
}

static const char *load(io_mcap_reader *reader, const chunk_head *head, io_mcap_cached *out)
{
    if (io_mcap_read_block(reader, head->packed_at, head->packed_size, &reader->packed) != RLF_OK) {
        return "it cannot be read";
    }
    const uint8_t *packed = reader->packed.data;
    if (!io_mcap_can_become(head->compression, packed, (size_t)head->packed_size,
                            head->plain_size)) {
        return "its sizes contradict each other";
    }
    out->size = (size_t)head->plain_size;
    if (io_buffer_reserve(&out->buffer, out->size > 0 ? out->size : 1) != RLF_OK) {
        return "there is not enough memory for it";
    }
    if (!io_mcap_decompress(reader->compressor, head->compression, packed,
                            (size_t)head->packed_size, out->buffer.data, out->size)) {
        return "it cannot be decompressed";
    }
    const bool is_right =
        head->crc == 0 || head->crc == (uint32_t)crc32_z(0, out->buffer.data, out->size);
    return is_right ? NULL : "its CRC is wrong";
}

static void tell(io_mcap_reader *reader, io_mcap_chunk *chunk, const char *problem)
{
    if (chunk->is_bad) {
        return;
    }
    chunk->is_bad = true;
    if (reader->bad_chunks++ == 0) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the chunk at byte %llu is left out: %s; the same goes for others like it",
                reader->file.path, (unsigned long long)chunk->offset, problem);
    }
}

/* The one used longest ago. */
static io_mcap_cached *oldest(io_mcap_reader *reader)
{
    io_mcap_cached *found = &reader->cache[0];
    for (int i = 1; i < IO_MCAP_CACHED; i++) {
        found = reader->cache[i].used < found->used ? &reader->cache[i] : found;
    }
    return found;
}

const io_mcap_cached *io_mcap_load_chunk(io_mcap_reader *reader, int32_t index)
{
    io_mcap_chunk *chunk = (io_mcap_chunk *)reader->chunks.items + index;
    reader->calls++;
    for (int i = 0; i < IO_MCAP_CACHED; i++) {
        if (reader->cache[i].chunk == index) {
            reader->cache[i].used = reader->calls;
            return &reader->cache[i];
        }
    }
    if (chunk->is_bad) {
        return NULL;
    }
    io_mcap_cached *place = oldest(reader);
    place->chunk = -1;
    chunk_head head;
    const char *problem = read_head(reader, chunk->offset, &head);
    problem = problem == NULL ? load(reader, &head, place) : problem;
    if (problem != NULL) {
        tell(reader, chunk, problem);
        return NULL;
    }
    place->chunk = index;
    place->used = reader->calls;
    return place;
}

void io_mcap_walk_chunk(io_mcap_reader *reader, int32_t index)
{
    const io_mcap_cached *chunk = io_mcap_load_chunk(reader, index);
    if (chunk == NULL) {
        return;
    }
    io_mcap_cursor c = {chunk->buffer.data, chunk->size, false};
    while (c.size > 0 && !c.is_bad) {
        const uint64_t offset = chunk->size - c.size;
        io_mcap_cursor record = {0};
        switch (io_mcap_take_record(&c, &record)) {
        case IO_MCAP_SCHEMA: io_mcap_take_schema(reader, record); break;
        case IO_MCAP_CHANNEL: io_mcap_take_channel(reader, record); break;
        case IO_MCAP_MESSAGE: {
            const uint16_t id = (uint16_t)io_mcap_take_number(&record, 2);
            io_mcap_take(&record, 4);
            io_mcap_list_message(reader, id, io_mcap_take_number(&record, 8), index, offset);
            break;
        }
        default: break;
        }
    }
}
