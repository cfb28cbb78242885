/* Chunks of a bag, unpacked. */
#include "io/ros/bag.h"

#include "base/messages.h"

#ifdef RLF_HAVE_LZ4
#include <lz4frame.h>
#endif
#ifdef RLF_HAVE_BZ2
#include <bzlib.h>
#endif

static rlf_result fail_damaged(const io_bytes *in)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s: a compressed chunk is damaged: copy or record it again",
                    in->name);
}

#ifdef RLF_HAVE_LZ4
static const bool has_lz4 = true;

static rlf_result unpack_lz4(const io_bytes *in, uint8_t *out, size_t out_size)
{
    LZ4F_dctx *context = NULL;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory while reading it", in->name);
    }
    size_t in_done = 0;
    size_t out_done = 0;
    for (size_t hint = 1; hint != 0;) {
        size_t in_step = in->size - in_done;
        size_t out_step = out_size - out_done;
        hint =
            LZ4F_decompress(context, out + out_done, &out_step, in->data + in_done, &in_step, NULL);
        in_done += in_step;
        out_done += out_step;
        if (LZ4F_isError(hint) || (in_step == 0 && out_step == 0)) {
            break;
        }
    }
    LZ4F_freeDecompressionContext(context);
    return out_done == out_size ? RLF_OK : fail_damaged(in);
}
#else
static const bool has_lz4 = false;
#define unpack_lz4(in, out, out_size) fail_damaged(in)
#endif

#ifdef RLF_HAVE_BZ2
static const bool has_bz2 = true;

static rlf_result unpack_bz2(const io_bytes *in, uint8_t *out, size_t out_size)
{
    unsigned size = (unsigned)out_size;
    /* The library does not write to its input; its interface is older than const. */
    const int code = BZ2_bzBuffToBuffDecompress((char *)out, &size, (char *)(uintptr_t)in->data,
                                                (unsigned)in->size, 0, 0);
    return code == BZ_OK && size == out_size ? RLF_OK : fail_damaged(in);
}
#else
static const bool has_bz2 = false;
#define unpack_bz2(in, out, out_size) fail_damaged(in)
#endif

rlf_result bag_check_packing(const char *path, bag_packing packing)
{
    if ((packing == BAG_PACKING_LZ4 && !has_lz4) || (packing == BAG_PACKING_BZ2 && !has_bz2)) {
        const bool is_lz4 = packing == BAG_PACKING_LZ4;
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: is packed with %s, which this build was made without: run rosbag "
                        "decompress, or %s",
                        path, is_lz4 ? "lz4" : "bz2",
                        is_lz4 ? RLF_GET_PART("liblz4-dev", "script/bootstrap", "RELIEF_WITH_LZ4")
                               : RLF_GET_PART("libbz2-dev", "script/bootstrap", "RELIEF_WITH_BZ2"));
    }
    return RLF_OK;
}

/* Unpacks `in` into exactly out_size bytes. */
static rlf_result decompress(const io_bytes *in, bag_packing packing, uint8_t *out, size_t out_size)
{
    if (in->size == 0 || out_size == 0) { /* there are no bytes to point to */
        return in->size == out_size ? RLF_OK : fail_damaged(in);
    }
    switch (packing) {
    case BAG_PACKING_LZ4: return unpack_lz4(in, out, out_size);
    case BAG_PACKING_BZ2: return unpack_bz2(in, out, out_size);
    case BAG_PACKING_NONE: break;
    }
    if (in->size != out_size) {
        return fail_damaged(in);
    }
    memcpy(out, in->data, out_size);
    return RLF_OK;
}

static rlf_result unpack_into(bag *self, int32_t index, bag_cache *cache)
{
    const bag_chunk *chunk = &self->chunks[index];
    cache->chunk = -1;
    if (chunk->size > BAG_CHUNK_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: a chunk of %u bytes claims to unpack to %u: record in smaller chunks",
                        self->file.path, (unsigned)chunk->packed_size, (unsigned)chunk->size);
    }
    rlf_result result = io_buffer_reserve(&cache->bytes, chunk->size);
    result = result == RLF_OK ? io_buffer_reserve(&self->packed, chunk->packed_size) : result;
    if (result != RLF_OK) {
        return result;
    }
    if (!bag_read_at(self, chunk->position, self->packed.data, chunk->packed_size)) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be read: check the disk", self->file.path);
    }
    const io_bytes in = {self->file.path, self->packed.data, chunk->packed_size};
    result = decompress(&in, chunk->packing, cache->bytes.data, chunk->size);
    if (result == RLF_OK) {
        cache->chunk = index;
        cache->size = chunk->size;
    }
    return result;
}

rlf_result bag_unpack(bag *self, int32_t chunk, io_bytes *out)
{
    bag_cache *found = NULL;
    bag_cache *oldest = &self->caches[0];
    for (int i = 0; i < 2; i++) {
        bag_cache *cache = &self->caches[i];
        found = cache->chunk == chunk ? cache : found;
        oldest = cache->used < oldest->used ? cache : oldest;
    }
    rlf_result result = RLF_OK;
    if (found == NULL) {
        found = oldest;
        result = unpack_into(self, chunk, found);
    }
    found->used = ++self->clock;
    *out = (io_bytes){self->file.path, found->bytes.data, result == RLF_OK ? found->size : 0};
    return result;
}
