/* Chunks and messages, unpacked by the libraries that this build has. */
#include "io/ros/log.h"

#ifdef RLF_HAVE_MCAP
#include <zstd.h>
#endif
#if defined(RLF_HAVE_MCAP) || defined(RLF_HAVE_LZ4)
#include <lz4frame.h>
#endif
#ifdef RLF_HAVE_BZ2
#include <bzlib.h>
#endif

#include <string.h>

#if defined(RLF_HAVE_MCAP) || defined(RLF_HAVE_LZ4)
static bool unpack_lz4(const uint8_t *data, size_t size, uint8_t *out, size_t out_size)
{
    LZ4F_dctx *context = NULL;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) {
        return false;
    }
    size_t taken = 0, made = 0;
    for (size_t hint = 1; hint != 0;) {
        size_t in_step = size - taken;
        size_t out_step = out_size - made;
        hint = LZ4F_decompress(context, out + made, &out_step, data + taken, &in_step, NULL);
        taken += in_step;
        made += out_step;
        if (LZ4F_isError(hint) || (in_step == 0 && out_step == 0)) {
            break;
        }
    }
    LZ4F_freeDecompressionContext(context);
    return made == out_size;
}
#else
#define unpack_lz4(data, size, out, out_size) false
#endif

#ifdef RLF_HAVE_BZ2
static bool unpack_bz2(const uint8_t *data, size_t size, uint8_t *out, size_t out_size)
{
    unsigned made = (unsigned)out_size;
    /* The library does not write to its input; its interface is older than const. */
    const int code = BZ2_bzBuffToBuffDecompress((char *)out, &made, (char *)(uintptr_t)data,
                                                (unsigned)size, 0, 0);
    return code == BZ_OK && made == out_size;
}
#else
#define unpack_bz2(data, size, out, out_size) false
#endif

#ifdef RLF_HAVE_MCAP
#define unpack_zstd(data, size, out, out_size)                                                     \
    (ZSTD_decompress(out, out_size, data, size) == (out_size))

uint64_t io_zstd_size(const uint8_t *data, size_t size)
{
    static const uint8_t magic[4] = {0x28, 0xB5, 0x2F, 0xFD};
    if (size < sizeof(magic) || memcmp(data, magic, sizeof(magic)) != 0) {
        return 0;
    }
    const unsigned long long said = ZSTD_getFrameContentSize(data, size);
    return said == ZSTD_CONTENTSIZE_UNKNOWN || said == ZSTD_CONTENTSIZE_ERROR ? 0 : said;
}
#else
#define unpack_zstd(data, size, out, out_size) false
#endif

bool io_unpack(io_packing packing, const uint8_t *data, size_t size, uint8_t *out, size_t out_size)
{
    if (size == 0 || out_size == 0) { /* there are no bytes to point to */
        return out_size == 0;
    }
    switch (packing) {
    case IO_PACKING_ZSTD: return unpack_zstd(data, size, out, out_size);
    case IO_PACKING_LZ4: return unpack_lz4(data, size, out, out_size);
    case IO_PACKING_BZ2: return unpack_bz2(data, size, out, out_size);
    case IO_PACKING_NONE: break;
    }
    if (size == out_size) {
        memcpy(out, data, size);
    }
    return size == out_size;
}
