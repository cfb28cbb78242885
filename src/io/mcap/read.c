/* Reading MCAP files: chunks, and messages out of them. */
#include "io/mcap/mcap.h"

#include <zlib.h>
#include <zstd.h>

/* No chunk larger than this is read: it is what bounds the memory. */
#define CHUNK_MAX ((uint64_t)256 << 20)
/* The most that is in front of a chunk's bytes: numbers, and the name of the compression. */
#define CHUNK_HEAD_MAX (IO_MCAP_RECORD_HEAD + 8 + 8 + 8 + 4 + 4 + 16 + 8)
/* lz4 shrinks at most 255 times (its length bytes), and a frame has a head. */
#define LZ4_RATIO_MAX 255

/* ---- bytes of the file ----------------------------------------------------------------------- */

bool io_mcap_read_at(const io_mcap_reader *reader, uint64_t offset, void *out, size_t size)
{
    const uint64_t whole = (uint64_t)reader->file.size;
    return offset <= whole && size <= whole - offset &&
           io_file_read_at(&reader->file, (int64_t)offset, out, size) == size;
}

rlf_result io_mcap_read_block(const io_mcap_reader *reader, uint64_t offset, uint64_t size,
                              io_buffer *buffer)
{
    const uint64_t whole = (uint64_t)reader->file.size;
    if (offset > whole || size > whole - offset) {
        return RLF_ERROR_FORMAT;
    }
    rlf_result result = io_buffer_reserve(buffer, size > 0 ? (size_t)size : 1);
    if (result == RLF_OK && !io_mcap_read_at(reader, offset, buffer->data, (size_t)size)) {
        result = RLF_ERROR_IO;
    }
    return result;
}

/* ---- chunks --------------------------------------------------------------------------------- */

typedef struct chunk_head {
    uint64_t plain_size, packed_size;
    uint64_t packed_at; /* in the file */
    uint32_t crc;       /* 0 = none */
    io_packing packing;
} chunk_head;

/* Says what is wrong, or returns NULL. */
static const char *read_head(const io_mcap_reader *reader, uint64_t offset, chunk_head *out)
{
    uint8_t bytes[CHUNK_HEAD_MAX];
    char packing[16];
    const uint64_t left = (uint64_t)reader->file.size - offset;
    const size_t size = left < CHUNK_HEAD_MAX ? (size_t)left : CHUNK_HEAD_MAX;
    cursor c = {bytes, io_mcap_read_at(reader, offset, bytes, size) ? size : 0, false};
    const uint8_t op = cursor_u8(&c);
    const uint64_t record = cursor_u64(&c);
    cursor_take(&c, 16);
    out->plain_size = cursor_u64(&c);
    out->crc = cursor_u32(&c);
    cursor_text(&c, packing, sizeof(packing));
    out->packed_size = cursor_u64(&c);
    if (c.is_short || op != IO_MCAP_CHUNK) {
        return "its head is damaged";
    }
    const uint64_t head = (uint64_t)(c.data - bytes) - IO_MCAP_RECORD_HEAD;
    out->packed_at = offset + IO_MCAP_RECORD_HEAD + head;
    if (record < head || out->packed_size > record - head ||
        out->packed_size > (uint64_t)reader->file.size - out->packed_at) {
        return "it is cut short";
    }
    out->packing = IO_PACKING_NONE;
    while (strcmp(packing, io_mcap_packing_name(out->packing)) != 0) {
        if (++out->packing == IO_PACKING_BZ2) {
            return "its compression is neither zstd nor lz4";
        }
    }
    return out->plain_size > CHUNK_MAX || out->packed_size > CHUNK_MAX ? "it is larger than 256 MiB"
                                                                       : NULL;
}

/* Whether the bytes could be that many once unpacked, as far as their head tells: asked before
 * memory is taken for them. */
static bool can_become(const chunk_head *head, const uint8_t *data)
{
    if (head->packing == IO_PACKING_NONE) {
        return head->packed_size == head->plain_size;
    }
    if (head->packing == IO_PACKING_LZ4) {
        return head->plain_size / LZ4_RATIO_MAX <= head->packed_size;
    }
    const unsigned long long said = ZSTD_getFrameContentSize(data, (size_t)head->packed_size);
    return said == ZSTD_CONTENTSIZE_UNKNOWN || said == head->plain_size;
}

static const char *unpack_into(io_mcap_reader *reader, const chunk_head *head, io_ros_unpacked *out)
{
    if (io_mcap_read_block(reader, head->packed_at, head->packed_size, &reader->packed) != RLF_OK) {
        return "it cannot be read";
    }
    if (!can_become(head, reader->packed.data)) {
        return "its sizes contradict each other";
    }
    out->size = (size_t)head->plain_size;
    if (io_buffer_reserve(&out->bytes, out->size > 0 ? out->size : 1) != RLF_OK) {
        return "there is not enough memory for it";
    }
    if (!io_unpack(head->packing, reader->packed.data, (size_t)head->packed_size, out->bytes.data,
                   out->size)) {
        return "it cannot be decompressed";
    }
    const bool is_right =
        head->crc == 0 || head->crc == (uint32_t)crc32_z(0, out->bytes.data, out->size);
    return is_right ? NULL : "its CRC is wrong";
}

bool io_mcap_load_chunk(io_mcap_reader *reader, int32_t index, cursor *out)
{
    io_mcap_chunk *chunk = &reader->chunks[index];
    io_ros_unpacked *place = io_ros_cache_find(&reader->cache, index);
    if (chunk->is_bad) {
        return false;
    }
    if (place->chunk1 == 0) {
        chunk_head head;
        const char *problem = read_head(reader, chunk->offset, &head);
        problem = problem == NULL ? unpack_into(reader, &head, place) : problem;
        chunk->is_bad = problem != NULL;
        if (chunk->is_bad && reader->bad_chunks++ == 0) {
            rlf_log(RLF_LOG_WARNING,
                    "%s: the chunk at byte %llu is left out: %s; the same goes for others like it",
                    reader->file.path, (unsigned long long)chunk->offset, problem);
        }
        place->chunk1 = chunk->is_bad ? 0 : index + 1;
    }
    *out = (cursor){place->bytes.data, place->size, false};
    return !chunk->is_bad;
}

/* ---- messages ------------------------------------------------------------------------------- */

/* `ros2 bag record --compression-mode message` packs each message by itself. */
static bool unpack_message(io_mcap_reader *reader, cursor *inout)
{
    const uint64_t size = io_zstd_size(inout->data, inout->left);
    if (size == 0) {
        return true;
    }
    if (size > CHUNK_MAX || io_buffer_reserve(&reader->plain, (size_t)size) != RLF_OK ||
        !io_unpack(IO_PACKING_ZSTD, inout->data, inout->left, reader->plain.data, (size_t)size)) {
        return false;
    }
    *inout = (cursor){reader->plain.data, (size_t)size, false};
    return true;
}

static bool read_loose(io_mcap_reader *reader, uint64_t offset, cursor *out)
{
    uint64_t size = 0;
    if (!io_mcap_read_at(reader, offset + 1, &size, sizeof(size))) {
        return false;
    }
    io_little(&size, 1, sizeof(size));
    size += IO_MCAP_RECORD_HEAD;
    if (size < IO_MCAP_RECORD_HEAD || size > CHUNK_MAX ||
        io_mcap_read_block(reader, offset, size, &reader->loose) != RLF_OK) {
        return false;
    }
    *out = (cursor){reader->loose.data, (size_t)size, false};
    return true;
}

/* The content of a record that is expected to be a message of the channel. */
static bool find_message(io_mcap_reader *reader, const io_ros_message *m, cursor *out)
{
    cursor bytes;
    if (m->chunk < 0 ? !read_loose(reader, m->offset, &bytes)
                     : !io_mcap_load_chunk(reader, m->chunk, &bytes) || m->offset > bytes.left) {
        return false;
    }
    cursor_take(&bytes, m->chunk < 0 ? 0 : (size_t)m->offset);
    const uint8_t op = io_mcap_take_record(&bytes, out);
    const uint16_t id = cursor_u16(out);
    cursor_take(out, IO_MCAP_MESSAGE_HEAD - 2);
    return op == IO_MCAP_MESSAGE && !out->is_short && id == reader->log->channels[m->channel].id &&
           unpack_message(reader, out);
}

rlf_result io_mcap_message(void *self, const io_ros_message *m, io_cdr_reader *out)
{
    io_mcap_reader *reader = self;
    cursor bytes = {0};
    const bool is_found = find_message(reader, m, &bytes);
    *out = io_cdr_open(bytes.data, is_found ? bytes.left : 0);
    return is_found ? RLF_OK
                    : rlf_fail(RLF_ERROR_FORMAT,
                               "%s: a message of %s at %.3f s is damaged: record it again",
                               reader->file.path, reader->log->channels[m->channel].topic,
                               1e-9 * (double)m->time_ns);
}
