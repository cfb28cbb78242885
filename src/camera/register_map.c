/* What becomes of the depth image's own pixels: seen by the colour camera, hidden or beyond. */
#include "camera/register.h"

#include <string.h>

#define NEARER 0.98f /* of a pixel's depth: what is nearer hides it */

void rlf_registration_find_pixels(const rlf_registration *r, const float *depth, int32_t y,
                                  ptrdiff_t stride, int32_t *out)
{
    if (!RLF_ASSERT(r != NULL && depth != NULL && out != NULL && y >= 0 && y < r->height)) {
        return;
    }
    enum { PART = 64 };
    float u[PART], v[PART], scale[PART], z[PART];
    const rlf_kernel_points points = {u, v, scale, z};
    const float right = (float)r->color.width - 0.5f, bottom = (float)r->color.height - 0.5f;
    for (int32_t x = 0; x < r->width; x += PART) {
        const int32_t count = r->width - x < PART ? r->width - x : PART;
        registration_project(r, depth, y, x, x + count, &points);
        for (int32_t i = 0; i < count; i++) {
            const bool is_inside = (scale[i] > 0.0f) & (z[i] < RLF_KERNEL_NOTHING) &
                                   (u[i] > -0.5f) & (v[i] > -0.5f) & (u[i] < right) &
                                   (v[i] < bottom);
            const float column = is_inside ? u[i] : 0.0f, row = is_inside ? v[i] : 0.0f;
            const int32_t byte =
                (int32_t)(row + 0.5f) * (int32_t)stride + 4 * (int32_t)(column + 0.5f);
            out[x + i] = is_inside ? byte : -1;
        }
    }
}

/* Row `y` of the depth image; its points are in r->points. */
static void map_row(const rlf_registration *r, const rlf_plane_f32 *registered, uint8_t *out)
{
    const rlf_kernel_points *at = &r->points;
    const float right = (float)r->color.width - 0.5f;
    const float bottom = (float)r->color.height - 0.5f;
    for (int32_t i = 0; i < r->width; i++) {
        uint8_t state = RLF_REGISTERED_EMPTY;
        if (at->scale[i] > 0.0f) {
            bool is_inside = at->z[i] < RLF_KERNEL_NOTHING && at->u[i] > -0.5f &&
                             at->v[i] > -0.5f && at->u[i] < right && at->v[i] < bottom;
            state = RLF_REGISTERED_OUTSIDE;
            if (is_inside) {
                const float *line = rlf_f32_row(registered, (int32_t)(at->v[i] + 0.5f));
                float nearest = line[(int32_t)(at->u[i] + 0.5f)];
                bool is_hidden = nearest > 0.0f && nearest < NEARER * at->z[i];
                state = is_hidden ? RLF_REGISTERED_HIDDEN : RLF_REGISTERED_VISIBLE;
            }
        }
        out[i] = state;
    }
}

void rlf_registration_align(rlf_registration *r, const float *depth, const rlf_aligned *out)
{
    if (!RLF_ASSERT(r != NULL && depth != NULL && out != NULL)) {
        return;
    }
    rlf_registration_apply(r, depth, &out->depth, &out->state);
    for (int32_t y = 0; out->seen != NULL && y < r->height; y++) {
        size_t first = (size_t)y * (size_t)r->width;
        registration_project(r, depth, y, 0, r->width, &r->points);
        map_row(r, &out->depth, out->seen + first);
    }
}
