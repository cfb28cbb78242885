/* Compression of chunks through libzstd and liblz4. */
#include "io/mcap/format.h"

#include <lz4frame.h>
#include <zstd.h>

/* JPEG and RVL have little left to squeeze: the fastest level finds it. */
#define ZSTD_LEVEL 1
/* lz4 shrinks at most 255 times (its length bytes), and a frame has a head. */
#define LZ4_RATIO_MAX 255

struct io_mcap_compressor {
    ZSTD_CCtx *zstd;
    ZSTD_DCtx *unzstd;
    LZ4F_dctx *unlz4;
};

rlf_result io_mcap_compressor_create(io_mcap_compressor **out)
{
    io_mcap_compressor *c = rlf_alloc(sizeof(*c));
    *out = NULL;
    if (c == NULL) {
        return RLF_ERROR_MEMORY;
    }
    c->zstd = ZSTD_createCCtx();
    c->unzstd = ZSTD_createDCtx();
    if (c->zstd == NULL || c->unzstd == NULL ||
        LZ4F_isError(LZ4F_createDecompressionContext(&c->unlz4, LZ4F_VERSION))) {
        io_mcap_compressor_destroy(&c);
        return rlf_fail(RLF_ERROR_MEMORY, "out of memory for zstd and lz4");
    }
    *out = c;
    return RLF_OK;
}

void io_mcap_compressor_destroy(io_mcap_compressor **compressor)
{
    io_mcap_compressor *c = *compressor;
    if (c != NULL) {
        ZSTD_freeCCtx(c->zstd);
        ZSTD_freeDCtx(c->unzstd);
        LZ4F_freeDecompressionContext(c->unlz4);
        rlf_free(c);
        *compressor = NULL;
    }
}

static const char *const names[3] = {"", "zstd", "lz4"};

const char *io_mcap_compression_name(io_mcap_compression compression)
{
    return names[compression];
}

bool io_mcap_compression_parse(const io_mcap_cursor *name, io_mcap_compression *out)
{
    for (int i = 0; i < 3; i++) {
        if (io_mcap_equals(name, names[i])) {
            *out = (io_mcap_compression)i;
            return !name->is_bad;
        }
    }
    return false;
}

rlf_result io_mcap_compress(io_mcap_compressor *c, io_mcap_compression compression,
                            const uint8_t *data, size_t size, io_byte_buffer *out)
{
    if (compression == IO_MCAP_PLAIN) {
        io_byte_buffer_add(out, data, size);
        return io_byte_buffer_check(out);
    }
    const bool is_zstd = compression == IO_MCAP_ZSTD;
    LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
    preferences.frameInfo.contentSize = size;
    const size_t bound =
        is_zstd ? ZSTD_compressBound(size) : LZ4F_compressFrameBound(size, &preferences);
    uint8_t *place = io_byte_buffer_reserve(out, bound);
    if (place == NULL) {
        return io_byte_buffer_check(out);
    }
    const size_t got = is_zstd ? ZSTD_compressCCtx(c->zstd, place, bound, data, size, ZSTD_LEVEL)
                               : LZ4F_compressFrame(place, bound, data, size, &preferences);
    if (is_zstd ? ZSTD_isError(got) : LZ4F_isError(got)) {
        return rlf_fail(RLF_ERROR_MEMORY,
                        "%s refuses to compress %zu bytes: use --compression "
                        "none",
                        names[compression], size);
    }
    io_byte_buffer_grow(out, got);
    return RLF_OK;
}

bool io_mcap_can_become(io_mcap_compression compression, const uint8_t *data, size_t size,
                        uint64_t out_size)
{
    if (compression == IO_MCAP_PLAIN) {
        return size == out_size;
    }
    if (compression == IO_MCAP_LZ4) {
        return out_size / LZ4_RATIO_MAX <= size;
    }
    const unsigned long long said = ZSTD_getFrameContentSize(data, size);
    return said == ZSTD_CONTENTSIZE_UNKNOWN || said == out_size;
}

uint64_t io_mcap_zstd_size(const uint8_t *data, size_t size)
{
    static const uint8_t magic[4] = {0x28, 0xB5, 0x2F, 0xFD};
    if (size < sizeof(magic) || memcmp(data, magic, sizeof(magic)) != 0) {
        return 0;
    }
    const unsigned long long said = ZSTD_getFrameContentSize(data, size);
    return said == ZSTD_CONTENTSIZE_UNKNOWN || said == ZSTD_CONTENTSIZE_ERROR ? 0 : said;
}

static bool unlz4(LZ4F_dctx *context, const uint8_t *data, size_t size, uint8_t *out,
                  size_t out_size)
{
    LZ4F_resetDecompressionContext(context);
    size_t done = 0;
    while (size > 0) {
        size_t taken = size;
        size_t made = out_size - done;
        const size_t left = LZ4F_decompress(context, out + done, &made, data, &taken, NULL);
        done += made;
        data += taken;
        size -= taken;
        if (left == 0) {
            return done == out_size;
        }
        if (LZ4F_isError(left) || (made == 0 && taken == 0)) {
            return false;
        }
    }
    return false;
}

bool io_mcap_decompress(io_mcap_compressor *c, io_mcap_compression compression, const uint8_t *data,
                        size_t size, uint8_t *out, size_t out_size)
{
    if (compression == IO_MCAP_LZ4) {
        return unlz4(c->unlz4, data, size, out, out_size);
    }
    if (compression == IO_MCAP_ZSTD) {
        return ZSTD_decompressDCtx(c->unzstd, out, out_size, data, size) == out_size;
    }
    if (size == out_size && size > 0) {
        memcpy(out, data, size);
    }
    return size == out_size;
}
