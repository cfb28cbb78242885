/* The nearest depth of each tile of a surface, tile by tile in rows. */
#include "environment/depth_tiles.h"

#include "kernel/kernel.h"

#define NOTHING 1e9f /* depth where nothing is seen */

RLF_KERNEL_PART void take_nearer(const float *restrict depth, const float *restrict back,
                                 int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float front = depth[i] > 0.0f ? depth[i] : NOTHING;
        float behind = back[i] > 0.0f ? back[i] : NOTHING;
        float here = front < behind ? front : behind;
        out[i] = here < out[i] ? here : out[i];
    }
}

RLF_KERNEL_PART void take_front(const float *restrict depth, const float *restrict back,
                                int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float behind = back[i];
        out[i] = depth[i] > 0.0f ? depth[i] : behind;
    }
}

/* Rows of pixels from these on; front NULL = not wanted. */
typedef struct sheets {
    const float *depth, *back;
    float *front;
} sheets;

/* Nearest of a row of tiles: `lines` rows of pixels. */
RLF_KERNEL static void find_nearest(const sheets *from, int32_t width, int32_t lines,
                                    float *restrict out)
{
    enum { BLOCK = 64 * DEPTH_TILE };
    for (int32_t x0 = 0; x0 < width; x0 += BLOCK) {
        const int32_t count = width - x0 < BLOCK ? width - x0 : BLOCK;
        float nearest[BLOCK];
        for (int32_t i = 0; i < BLOCK; i++) {
            nearest[i] = NOTHING;
        }
        for (int32_t y = 0; y < lines; y++) {
            const ptrdiff_t first = (ptrdiff_t)y * width + x0;
            take_nearer(from->depth + first, from->back + first, count, nearest);
            if (from->front != NULL) {
                take_front(from->depth + first, from->back + first, count, from->front + first);
            }
        }
        for (int32_t i = 0; i < count; i += DEPTH_TILE) {
            float least = nearest[i];
            for (int32_t k = 1; k < DEPTH_TILE; k++) {
                least = nearest[i + k] < least ? nearest[i + k] : least;
            }
            out[(x0 + i) / DEPTH_TILE] = least;
        }
    }
}

rlf_result depth_tiles_create(int32_t width, int32_t height, depth_tiles *out)
{
    out->columns = (width + DEPTH_TILE - 1) / DEPTH_TILE;
    out->rows = (height + DEPTH_TILE - 1) / DEPTH_TILE;
    out->nearest = rlf_alloc_array((size_t)out->columns * (size_t)out->rows, sizeof(float));
    return out->nearest != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void depth_tiles_destroy(depth_tiles *tiles)
{
    rlf_free(tiles->nearest);
    tiles->nearest = NULL;
}

typedef struct tiles_job {
    const rlf_surface *surface;
    depth_tiles *tiles;
    float *front;
} tiles_job;

static void update_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const tiles_job *job = context;
    const rlf_surface *surface = job->surface;
    (void)worker;
    const float *back =
        surface->background_depth != NULL ? surface->background_depth : surface->depth;
    for (int32_t row = begin; row < end; row++) {
        const int32_t y = row * DEPTH_TILE;
        const int32_t left = surface->height - y;
        const ptrdiff_t first = (ptrdiff_t)y * surface->width;
        const sheets from = {surface->depth + first, back + first,
                             job->front != NULL ? job->front + first : NULL};
        find_nearest(&from, surface->width, left < DEPTH_TILE ? left : DEPTH_TILE,
                     job->tiles->nearest + row * job->tiles->columns);
    }
}

void depth_tiles_update(depth_tiles *tiles, const rlf_surface *surface, rlf_pool *pool,
                        float *front)
{
    tiles_job job = {surface, tiles, front};
    rlf_parallel_for(pool, tiles->rows, 8, update_rows, &job);
    float nearest = NOTHING;
    for (int32_t i = 0; i < tiles->columns * tiles->rows; i++) {
        nearest = tiles->nearest[i] < nearest ? tiles->nearest[i] : nearest;
    }
    tiles->least = nearest < NOTHING ? nearest : 0.0f;
}
