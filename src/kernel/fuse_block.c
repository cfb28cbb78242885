/* One block of the volume takes in one view.
 *
 * Newcombe et al. 2011 take the depth along the ray for the distance. Here each pixel has a plane:
 * the distance from that is true on slanted surfaces, and does not depend on where in the pixel a
 * voxel falls, nor, with the pixel's own ray in it, on the lens. So one pixel serves for four rows
 * of voxels, two by two: the plane is as true for them as for the line in their middle. */
#include "kernel/fuse.h"

enum { LANES = RLF_FUSE_SIDE, PAIR = 2 * LANES };

/* Colour is kept this near to a surface, voxels: what its cells reach. */
#define COLOR_REACH 2.0f
/* A distance from no plane at all, steps. */
#define NO_PLANE 1e9f

/* Eight places in a line along x, in the middle of four rows. */
typedef struct lanes {
    float x[LANES], y[LANES], z[LANES];
    int32_t pixel[LANES];    /* of the source, 0 where there is none */
    float is_in[LANES];      /* 1 or 0 */
    float truncation[LANES]; /* steps */
    float distance[LANES];   /* from the pixel's plane, steps */
    float way[2][LANES];     /* what it gains from voxel to voxel along y and z */
    float weight[LANES];     /* of a surface that is seen; 0 = none is */
    float carving[LANES];    /* of free space that is seen; 0 = none is */
} lanes;

/* Sixteen voxels: two rows, one after the other in memory. */
typedef struct row_lanes {
    float seen[PAIR];      /* observed distance, steps, cut at the truncation */
    float weight[PAIR];    /* of the observation; 0 = none */
    float most_kept[PAIR]; /* weight that what was there may have beside it */
} row_lanes;

RLF_KERNEL_PART void project(const rlf_fuse_view *view, const float start[3], const float step[3],
                             lanes *restrict l)
{
    const float width = (float)view->width, height = (float)view->height;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        float along = (float)i;
        l->x[i] = start[0] + along * step[0];
        l->y[i] = start[1] + along * step[1];
        l->z[i] = start[2] + along * step[2];
        int32_t is_ahead = l->z[i] > RLF_FUSE_NEAREST_M ? 1 : 0;
        float inverse = 1.0f / (l->z[i] > RLF_FUSE_NEAREST_M ? l->z[i] : RLF_FUSE_NEAREST_M);
        float u = view->fx * l->x[i] * inverse + (view->cx + 0.5f);
        float v = view->fy * l->y[i] * inverse + (view->cy + 0.5f);
        int32_t right = u >= 0.0f ? 1 : 0, left = u < width ? 1 : 0;
        int32_t below = v >= 0.0f ? 1 : 0, above = v < height ? 1 : 0;
        int32_t is_in = is_ahead & right & left & below & above;
        /* Clamped, for a number that is too large has no integer. */
        u = u >= 0.0f ? u : 0.0f;
        v = v >= 0.0f ? v : 0.0f;
        u = u < width ? u : 0.0f;
        v = v < height ? v : 0.0f;
        l->is_in[i] = is_in != 0 ? 1.0f : 0.0f;
        l->pixel[i] = is_in * ((int32_t)v * view->width + (int32_t)u);
    }
}

/* From the pinhole's pixels to the source's. */
RLF_KERNEL_PART void look_up(const int32_t *restrict source_of, lanes *restrict l)
{
    for (int32_t i = 0; i < LANES; i++) {
        int32_t pixel = source_of[l->pixel[i]];
        l->is_in[i] = pixel < 0 ? 0.0f : l->is_in[i];
        l->pixel[i] = pixel < 0 ? 0 : pixel;
    }
}

RLF_KERNEL_PART void weigh(const rlf_fuse_view *view, lanes *restrict l)
{
    const float steps = RLF_FUSE_STEPS / view->voxel;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        float sigma = rlf_kernel_sigma(view->noise, l->z[i]);
        float t = sigma * view->sigmas;
        t = t < view->truncation_least ? view->truncation_least : t;
        l->truncation[i] = steps * (t > view->truncation_most ? view->truncation_most : t);
        float share = view->nearest_sigma / sigma;
        share = share > 1.0f ? 1.0f : share;
        l->weight[i] = RLF_FUSE_WEIGHT * (share * share);
    }
}

/* Distances and weights; returns whether any place has one. */
RLF_KERNEL_PART bool observe(const rlf_fuse_view *view, const rlf_fuse_place *place,
                             lanes *restrict l)
{
    const float steps = RLF_FUSE_STEPS / view->voxel;
    const float *sy = place->step[1], *sz = place->step[2];
    float nx[LANES], ny[LANES], nz[LANES], offset[LANES], least[LANES];
    for (int32_t i = 0; i < LANES; i++) {
        const rlf_fuse_plane *plane = &view->planes[l->pixel[i]];
        nx[i] = plane->x;
        ny[i] = plane->y;
        nz[i] = plane->z;
        offset[i] = plane->offset;
        least[i] = view->least[l->pixel[i]];
    }
    float any = 0.0f;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        float z = l->z[i], t = l->truncation[i];
        float distance = steps * (nx[i] * l->x[i] + ny[i] * l->y[i] + nz[i] * z - offset[i]);
        float wy = steps * (nx[i] * sy[0] + ny[i] * sy[1] + nz[i] * sy[2]);
        float wz = steps * (nx[i] * sz[0] + ny[i] * sz[1] + nz[i] * sz[2]);
        float reach = t + rlf_kernel_abs(wy) + rlf_kernel_abs(wz);
        /* Ones and noughts: choices within choices would not be vectorised. */
        float has_plane = (offset[i] < 0.0f ? 1.0f : 0.0f) * l->is_in[i];
        float near = has_plane * (rlf_kernel_abs(distance) <= reach ? 1.0f : 0.0f);
        float far = ((least[i] - z) * steps > t ? 1.0f : 0.0f) * l->is_in[i];
        /* Slanted pixels say less: a cosine of the angle, but for the ray's own slant. */
        float facing = -offset[i] / (z > RLF_FUSE_NEAREST_M ? z : RLF_FUSE_NEAREST_M);
        facing = facing > 1.0f ? 1.0f : facing;
        float weight = l->weight[i], slanted = weight * facing;
        l->distance[i] = has_plane * distance + (1.0f - has_plane) * NO_PLANE;
        l->way[0][i] = wy;
        l->way[1][i] = wz;
        l->carving[i] = far * (weight < 1.0f ? 1.0f : weight);
        l->weight[i] = near * (slanted < 1.0f ? 1.0f : slanted);
    }
    for (int32_t i = 0; i < LANES; i++) {
        any += l->weight[i] + l->carving[i];
    }
    return any > 0.0f;
}

/* What is seen at the two rows that are `back` voxels from the middle along z. */
RLF_KERNEL_PART void observe_pair(const rlf_fuse_view *view, const lanes *restrict l, float back,
                                  row_lanes *restrict r)
{
    const float carve_weight = view->carve_weight;
    RLF_KERNEL_UNROLLED(2)
    for (int32_t k = 0; k < 2; k++) {
        const float up = (float)k - 0.5f;
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            float t = l->truncation[i];
            float distance = l->distance[i] + up * l->way[0][i] + back * l->way[1][i];
            /* A number, not a choice: that would not be vectorised. */
            int32_t is_near = rlf_kernel_abs(distance) <= t;
            float near = (float)is_near, far = 1.0f - near;
            r->seen[k * LANES + i] = near * distance + far * t;
            r->weight[k * LANES + i] = near * l->weight[i] + far * l->carving[i];
            r->most_kept[k * LANES + i] =
                near * RLF_FUSE_WEIGHT_MOST + far * (carve_weight * l->carving[i]);
        }
    }
}

RLF_KERNEL_PART void mix_distance(const row_lanes *restrict r, int16_t *restrict distance,
                                  const uint8_t *restrict weight)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < PAIR; i++) {
        float old = (float)weight[i], add = r->weight[i];
        old = old > r->most_kept[i] ? r->most_kept[i] : old;
        float sum = old + add;
        float mean = ((float)distance[i] * old + r->seen[i] * add) / (sum > 0.0f ? sum : 1.0f);
        /* Rounded to the nearest by a cut: nothing is below -32 voxels. */
        int32_t rounded = (int32_t)(mean + 32768.5f) - 32768;
        distance[i] = (int16_t)(add > 0.0f ? rounded : distance[i]);
    }
}

RLF_KERNEL_PART void mix_weight(const row_lanes *restrict r, uint8_t *restrict weight)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < PAIR; i++) {
        float old_weight = (float)weight[i];
        float kept = old_weight > r->most_kept[i] ? r->most_kept[i] : old_weight;
        float sum = kept + r->weight[i];
        sum = sum > RLF_FUSE_WEIGHT_MOST ? RLF_FUSE_WEIGHT_MOST : sum;
        weight[i] = (uint8_t)(r->weight[i] > 0.0f ? (int32_t)(sum + 0.5f) : weight[i]);
    }
}

/* A mean over the last few frames, so that a change of the lamp is followed. */
RLF_KERNEL_PART uint8_t mixed(uint8_t old, int32_t seen, float old_weight, float weight)
{
    const float most = 4.0f * RLF_FUSE_WEIGHT;
    float kept = old_weight > most ? most : old_weight;
    float mean = ((float)old * kept + (float)seen * weight) / (kept + weight);
    return (uint8_t)(mean + 0.5f);
}

/* Of the voxels of one row that are near a surface; `l` is the row itself. The weights are those
 * before this view. */
RLF_KERNEL_PART void mix_color(const rlf_fuse_view *view, const lanes *l, const float *seen,
                               const float *weight, int32_t row, rlf_fuse_block *block)
{
    const bool has_chroma = (row & 1) == 0 && ((row >> 3) & 1) == 0;
    for (int32_t i = 0; i < LANES; i++) {
        const uint8_t *c = &view->rgba[4 * (ptrdiff_t)l->pixel[i]];
        const bool is_near = rlf_kernel_abs(seen[i]) < COLOR_REACH * RLF_FUSE_STEPS;
        if (!is_near || weight[i] == 0.0f || l->is_in[i] == 0.0f || c[3] == 0) {
            continue;
        }
        const int32_t at = row * LANES + i;
        int32_t luma = (77 * c[0] + 150 * c[1] + 29 * c[2]) >> 8;
        luma = luma < 1 ? 1 : luma;
        const bool is_first = block->grey[at] == 0;
        const float old = is_first ? 0.0f : (float)block->weight[at];
        block->grey[at] = mixed(block->grey[at], luma, old, weight[i]);
        if (has_chroma && (i & 1) == 0) {
            const int32_t cell = (row >> 4) * 16 + ((row & 7) >> 1) * 4 + (i >> 1);
            const int32_t blue = (c[2] - luma + 256) >> 1, red = (c[0] - luma + 256) >> 1;
            block->chroma[0][cell] = mixed(block->chroma[0][cell], blue, old, weight[i]);
            block->chroma[1][cell] = mixed(block->chroma[1][cell], red, old, weight[i]);
        }
    }
}

/* Whether a row has voxels near to a surface; in `missing`, whether one of these has no colour. */
RLF_KERNEL_PART bool is_near_surface(const float seen[LANES], const uint8_t *grey, bool *missing)
{
    int32_t near = 0, bare = 0;
    for (int32_t i = 0; i < LANES; i++) {
        int32_t is_near = rlf_kernel_abs(seen[i]) < COLOR_REACH * RLF_FUSE_STEPS;
        near |= is_near;
        bare |= is_near & (grey[i] == 0);
    }
    *missing = bare != 0;
    return near != 0;
}

/* The pixels along a line at (y, z) of the block. */
RLF_KERNEL_PART void find_pixels(const rlf_fuse_view *view, const rlf_fuse_place *place, float y,
                                 float z, lanes *restrict l)
{
    float start[3];
    for (int32_t k = 0; k < 3; k++) {
        start[k] = place->origin[k] + y * place->step[1][k] + z * place->step[2][k];
    }
    project(view, start, place->step[0], l);
    if (view->source_of != NULL) {
        look_up(view->source_of, l);
    }
}

/* One row of four at a time, in turn: colours change less than what a frame costs. */
RLF_KERNEL_PART void color_pair(const rlf_fuse_view *view, const rlf_fuse_place *place,
                                const row_lanes *r, int32_t row, rlf_fuse_block *block)
{
    for (int32_t k = 0; k < 2; k++, row++) {
        const float *seen = &r->seen[k * LANES], *weight = &r->weight[k * LANES];
        const int32_t turn = (row & 1) | (row >> 2 & 2);
        bool missing;
        if (is_near_surface(seen, &block->grey[row * LANES], &missing) &&
            (missing || turn == view->color_turn)) {
            lanes l;
            find_pixels(view, place, (float)(row % LANES), (float)(row / LANES), &l);
            mix_color(view, &l, seen, weight, row, block);
        }
    }
}

RLF_KERNEL bool rlf_kernel_fuse_block(const rlf_fuse_view *view, const rlf_fuse_place *place,
                                      rlf_fuse_block *restrict block)
{
    bool any = false;
    for (int32_t four = 0; four < LANES * LANES / 4; four++) {
        const int32_t y = four % 4 * 2, z = four / 4 * 2;
        lanes l;
        find_pixels(view, place, (float)y + 0.5f, (float)z + 0.5f, &l);
        weigh(view, &l);
        if (!observe(view, place, &l)) {
            continue;
        }
        any = true;
        for (int32_t k = 0; k < 2; k++) {
            const int32_t row = (z + k) * LANES + y;
            row_lanes r;
            observe_pair(view, &l, (float)k - 0.5f, &r);
            if (view->rgba != NULL) {
                color_pair(view, place, &r, row, block);
            }
            mix_distance(&r, &block->distance[row * LANES], &block->weight[row * LANES]);
            mix_weight(&r, &block->weight[row * LANES]);
        }
    }
    return any;
}

/* Of each half row the least distance in front, with the voxel's place in its eighth in the low
 * bits: numbers of 16 bits, so that a register has eight. */
RLF_KERNEL_PART void find_front(const rlf_fuse_block *block, uint16_t least[4][LANES])
{
    enum { EIGHTH = RLF_FUSE_VOXELS / 8, NEAR = (int32_t)RLF_FUSE_STEPS };
    for (int32_t row = 0; row < LANES * LANES; row++) {
        uint16_t *best = least[(row >> 2 & 1) | (row >> 5) << 1];
        const int16_t *distance = &block->distance[row * LANES];
        const uint16_t first = (uint16_t)((row & 3) * 4 + (row >> 3 & 3) * 16);
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            /* A surface right on a voxel is 0 there: of its front a whole voxel is in front. */
            uint16_t d = (uint16_t)(distance[i] - 1);
            uint16_t key = (uint16_t)(d * EIGHTH + first + (i & 3));
            uint16_t none = d < NEAR ? 0 : RLF_FUSE_NO_VOXEL;
            key |= none;
            best[i] = key < best[i] ? key : best[i];
        }
    }
}

/* How many voxels one may go from `d` by `step`: two, for noise counts less over a longer way. */
RLF_KERNEL_PART int32_t reach(const int16_t *d, int32_t step, int32_t room)
{
    const bool has_one = room > 0 && d[step] != RLF_FUSE_UNKNOWN;
    const bool has_two = has_one && room > 1 && d[2 * step] != RLF_FUSE_UNKNOWN;
    return (has_one ? 1 : 0) + (has_two ? 1 : 0);
}

/* What the distance gains along an axis, steps a voxel. */
RLF_KERNEL_PART float slope(const rlf_fuse_block *block, int32_t voxel, int32_t axis)
{
    const int32_t step = 1 << (3 * axis), at = voxel >> (3 * axis) & 7;
    const int16_t *d = &block->distance[voxel];
    const int32_t low = reach(d, -step, at), high = reach(d, step, 7 - at);
    const int32_t way = low + high;
    return (float)(d[high * step] - d[-low * step]) / (float)(way > 0 ? way : 1);
}

RLF_KERNEL_PART rlf_fuse_patch patch_at(const rlf_fuse_block *block, int32_t voxel)
{
    const int32_t ahead = (block->distance[voxel] - 1) >> 2; /* at most 255 */
    rlf_fuse_patch out = {.voxel = (uint16_t)voxel, .ahead = (uint8_t)ahead};
    float g[3], size2 = 0.0f;
    for (int32_t k = 0; k < 3; k++) {
        g[k] = slope(block, voxel, k);
        size2 += g[k] * g[k];
    }
    const float least = RLF_FUSE_STEPS / 4;
    const float scale = size2 > least * least ? 127.0f / sqrtf(size2) : 0.0f;
    for (int32_t k = 0; k < 3; k++) {
        out.normal[k] = (int8_t)(g[k] * scale);
    }
    return out;
}

RLF_KERNEL rlf_fuse_summary rlf_kernel_fuse_summary(const rlf_fuse_block *block)
{
    int16_t nearest = INT16_MAX, lowest = INT16_MAX;
    for (int32_t i = 0; i < RLF_FUSE_VOXELS; i++) {
        int16_t d = block->distance[i], size = (int16_t)(d < 0 ? -d : d);
        nearest = size < nearest ? size : nearest;
        lowest = d < lowest ? d : lowest;
    }
    rlf_fuse_summary out = {.nearest = nearest, .lowest = lowest};
    uint16_t least[4][LANES];
    memset(least, 0xff, sizeof(least));
    find_front(block, least);
    for (int32_t k = 0; k < 8; k++) {
        uint16_t best = RLF_FUSE_NO_VOXEL;
        for (int32_t i = 0; i < 4; i++) {
            uint16_t key = least[k >> 1][4 * (k & 1) + i];
            best = key < best ? key : best;
        }
        const int32_t at = best & 63;
        const int32_t x = 4 * (k & 1) + (at & 3), y = 4 * (k >> 1 & 1) + (at >> 2 & 3);
        const int32_t z = 4 * (k >> 2) + (at >> 4);
        out.front[k] = (rlf_fuse_patch){.voxel = RLF_FUSE_NO_VOXEL};
        if (best != RLF_FUSE_NO_VOXEL) {
            out.front[k] = patch_at(block, (z * LANES + y) * LANES + x);
        }
    }
    return out;
}
