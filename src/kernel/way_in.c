/* What is known of surfaces on the way in from their outlines. */
#include "kernel/outline.h"

static const float most_apart = 0.05f; /* share of the depth, of samples of one surface */

/* Pixels of one step, -1 outside of the image, and how far in they are. */
RLF_KERNEL_PART void place_step(const rlf_way *way, const rlf_way_from *restrict from, float steps,
                                int32_t *restrict place, float *restrict s)
{
    const int32_t width = way->width, height = way->height;
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        float x = (float)from->x[k], y = (float)from->y[k];
        float out_x = from->outline.x[k], out_y = from->outline.y[k];
        int32_t sx = (int32_t)(x - steps * out_x + 0.5f), sy = (int32_t)(y - steps * out_y + 0.5f);
        int32_t inside = (sx >= 0) & (sy >= 0) & (sx < width) & (sy < height);
        place[k] = inside ? sy * width + sx : -1;
        s[k] = from->outline.distance[k] + (float)(from->x[k] - sx) * out_x +
               (float)(from->y[k] - sy) * out_y;
    }
}

/* One step's samples as they are; of pixels outside of the image those of the first ones. */
typedef struct step_samples {
    float depth[RLF_BATCH], known[RLF_BATCH];
} step_samples;

RLF_KERNEL_PART void read_step(const rlf_way *way, const int32_t *restrict first,
                               const int32_t *restrict place, step_samples *restrict out,
                               rlf_normals *restrict normal)
{
    const float *depth = way->depth;
    const float *nx = way->normal[0], *ny = way->normal[1], *nz = way->normal[2];
    const uint8_t *known = way->known;
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        int32_t i = place[k] >= 0 ? place[k] : first[k];
        out->depth[k] = depth[i];
        out->known[k] = known[i] != 0 ? 1.0f : 0.0f;
        /* What is not known counts nothing, and is not read: another worker may be making it. */
        int32_t n = known[i] != 0 ? i : first[k];
        normal->x[k] = nx[n];
        normal->y[k] = ny[n];
        normal->z[k] = nz[n];
    }
}

RLF_KERNEL void rlf_kernel_way_in(const rlf_way *way, const rlf_way_from *restrict from,
                                  int32_t first_step, rlf_way_in *restrict in,
                                  int32_t *restrict inner)
{
    int32_t first[RLF_BATCH], place[RLF_BATCH];
    float z[RLF_BATCH], goes_on[RLF_BATCH];
    step_samples at;
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        first[k] = inner[k] = from->y[k] * way->width + from->x[k];
        z[k] = way->depth[first[k]];
        in->ray_x[k] = way->ray_x[first[k]];
        in->ray_y[k] = way->ray_y[first[k]];
        goes_on[k] = 1.0f;
    }
    for (int32_t step = 0; step < RLF_OUTLINE_STEPS; step++) {
        rlf_normals *normal = &in->normal[step];
        place_step(way, from, (float)(step + first_step), place, in->s[step]);
        read_step(way, first, place, &at, normal);
        for (int32_t k = 0; k < RLF_BATCH; k++) {
            float near = rlf_kernel_abs(at.depth[k] - z[k]) <= most_apart * z[k] ? 1.0f : 0.0f;
            goes_on[k] *= place[k] >= 0 ? near : 0.0f;
            inner[k] = goes_on[k] > 0.0f ? place[k] : inner[k];
            float weight = at.known[k] * goes_on[k];
            normal->x[k] *= weight;
            normal->y[k] *= weight;
            normal->z[k] *= weight;
        }
    }
}
