/* One block of the volume takes in one view.
 *
 * Newcombe et al. 2011 take the depth along the ray for the distance. Here each pixel has a plane:
 * the distance from that is true on slanted surfaces, and does not depend on where in the pixel a
 * voxel falls, nor, with the pixel's own ray in it, on the lens. */
#include "kernel/fuse.h"

enum { LANES = RLF_FUSE_SIDE };

/* Nothing nearer is fused, metres. */
static const float nearest_m = 0.05f;

/* Eight voxels in a row. */
typedef struct lanes {
    float x[LANES], y[LANES], z[LANES];
    int32_t pixel[LANES];    /* of the source, 0 where there is none */
    float is_in[LANES];      /* 1 or 0 */
    float truncation[LANES]; /* metres */
    float seen[LANES];       /* observed distance, metres, cut at the truncation */
    float weight[LANES];     /* of the observation; 0 = none */
    float most_kept[LANES];  /* weight that what was there may have beside it */
    float is_near[LANES];    /* the surface itself was seen, not only free space */
} lanes;

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
        int32_t is_ahead = l->z[i] > nearest_m ? 1 : 0;
        float inverse = 1.0f / (l->z[i] > nearest_m ? l->z[i] : nearest_m);
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
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        float sigma = rlf_kernel_sigma(view->noise, l->z[i]);
        float t = sigma * view->sigmas;
        t = t < view->truncation_least ? view->truncation_least : t;
        l->truncation[i] = t > view->truncation_most ? view->truncation_most : t;
        float share = view->nearest_sigma / sigma;
        share = share > 1.0f ? 1.0f : share;
        l->weight[i] = RLF_FUSE_WEIGHT * (share * share);
    }
}

/* Distances and weights; returns whether any voxel has one. */
RLF_KERNEL_PART bool observe(const rlf_fuse_view *view, lanes *restrict l)
{
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
        float t = l->truncation[i], z = l->z[i];
        float distance = nx[i] * l->x[i] + ny[i] * l->y[i] + nz[i] * z - offset[i];
        float size = rlf_kernel_abs(distance);
        /* Ones and noughts: choices within choices would not be vectorised. */
        float near = (size <= t ? 1.0f : 0.0f) * (offset[i] < 0.0f ? 1.0f : 0.0f) * l->is_in[i];
        float far = (least[i] - z > t ? 1.0f : 0.0f) * (1.0f - near) * l->is_in[i];
        /* Slanted pixels say less: a cosine of the angle, but for the ray's own slant. */
        float facing = -offset[i] / (z > nearest_m ? z : nearest_m);
        facing = facing > 1.0f ? 1.0f : facing;
        float weight = l->weight[i] * (1.0f - near + near * facing);
        weight = weight < 1.0f ? 1.0f : weight;
        l->most_kept[i] = near * RLF_FUSE_WEIGHT_MOST + far * (view->carve_weight * weight);
        l->seen[i] = near * distance + far * t;
        l->is_near[i] = near;
        l->weight[i] = weight * (near + far);
    }
    for (int32_t i = 0; i < LANES; i++) {
        any += l->weight[i];
    }
    return any > 0.0f;
}

RLF_KERNEL_PART void mix_distance(const rlf_fuse_view *view, const lanes *restrict l,
                                  int16_t *restrict distance, const uint8_t *restrict weight)
{
    const float steps = RLF_FUSE_STEPS / view->voxel;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        float old_weight = (float)weight[i];
        old_weight = old_weight > l->most_kept[i] ? l->most_kept[i] : old_weight;
        float sum = old_weight + l->weight[i];
        float mean = ((float)distance[i] * old_weight + l->seen[i] * steps * l->weight[i]) /
                     (sum > 0.0f ? sum : 1.0f);
        /* Rounded to the nearest by a cut: nothing is below -32 voxels. */
        int32_t rounded = (int32_t)(mean + 32768.5f) - 32768;
        distance[i] = (int16_t)(l->weight[i] > 0.0f ? rounded : distance[i]);
    }
}

RLF_KERNEL_PART void mix_weight(const lanes *restrict l, uint8_t *restrict weight)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        float old_weight = (float)weight[i];
        float kept = old_weight > l->most_kept[i] ? l->most_kept[i] : old_weight;
        float sum = kept + l->weight[i];
        sum = sum > RLF_FUSE_WEIGHT_MOST ? RLF_FUSE_WEIGHT_MOST : sum;
        weight[i] = (uint8_t)(l->weight[i] > 0.0f ? (int32_t)(sum + 0.5f) : weight[i]);
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

/* The weights are those before this view. */
static void mix_color(const rlf_fuse_view *view, const lanes *l, int32_t row, rlf_fuse_block *block)
{
    const bool has_chroma = (row & 1) == 0 && ((row >> 3) & 1) == 0;
    for (int32_t i = 0; i < LANES; i++) {
        const uint8_t *c = &view->rgba[4 * (ptrdiff_t)l->pixel[i]];
        if (l->is_near[i] == 0.0f || c[3] == 0) {
            continue;
        }
        const int32_t at = row * LANES + i;
        int32_t luma = (77 * c[0] + 150 * c[1] + 29 * c[2]) >> 8;
        luma = luma < 1 ? 1 : luma;
        const bool is_first = block->grey[at] == 0;
        const float old = is_first ? 0.0f : (float)block->weight[at];
        block->grey[at] = mixed(block->grey[at], luma, old, l->weight[i]);
        if (has_chroma && (i & 1) == 0) {
            const int32_t cell = (row >> 4) * 16 + ((row & 7) >> 1) * 4 + (i >> 1);
            const int32_t blue = (c[2] - luma + 256) >> 1, red = (c[0] - luma + 256) >> 1;
            block->chroma[0][cell] = mixed(block->chroma[0][cell], blue, old, l->weight[i]);
            block->chroma[1][cell] = mixed(block->chroma[1][cell], red, old, l->weight[i]);
        }
    }
}

RLF_KERNEL void rlf_kernel_fuse_block(const rlf_fuse_view *view, const rlf_fuse_place *place,
                                      rlf_fuse_block *restrict block)
{
    for (int32_t row = 0; row < LANES * LANES; row++) {
        const float y = (float)(row % LANES), z = (float)(row / LANES);
        float start[3];
        for (int32_t k = 0; k < 3; k++) {
            start[k] = place->origin[k] + y * place->step[1][k] + z * place->step[2][k];
        }
        lanes l;
        project(view, start, place->step[0], &l);
        if (view->source_of != NULL) {
            look_up(view->source_of, &l);
        }
        weigh(view, &l);
        if (!observe(view, &l)) {
            continue;
        }
        const int32_t at = row * LANES;
        mix_distance(view, &l, &block->distance[at], &block->weight[at]);
        if (view->rgba != NULL) {
            mix_color(view, &l, row, block);
        }
        mix_weight(&l, &block->weight[at]);
    }
}

RLF_KERNEL rlf_fuse_summary rlf_kernel_fuse_summary(const rlf_fuse_block *block)
{
    int32_t nearest = INT16_MAX, lowest = INT16_MAX;
    for (int32_t i = 0; i < RLF_FUSE_VOXELS; i++) {
        int32_t d = block->weight[i] > 0 ? block->distance[i] : INT16_MAX;
        int32_t size = d < 0 ? -d : d;
        nearest = size < nearest ? size : nearest;
        lowest = d < lowest ? d : lowest;
    }
    const rlf_fuse_summary out = {nearest, lowest};
    return out;
}
