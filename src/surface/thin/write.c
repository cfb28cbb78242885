/* What a slab is known to be where it is seen: how thick, and edge-on how fast. */
#include "surface/thickness/thickness.h"
#include "surface/thin/slab.h"

static const double edge_on = 0.2;  /* sine of the angle between the face and the view */
static const double slowest = 0.08; /* m/s: what is slower may rest */

/* One slab and the frame that it is written to. */
typedef struct writer {
    const image_grid *grid;
    const slab *slab;
    slab_view view, wide; /* `wide`: by a pixel, as outlines are seen */
    const float *behind;
    bool is_edge_on;
    rlf_slot *slot;
} writer;

/* An edge shows little of its motion: what was filled of it has the slab's. */
static void move_pixel(const writer *w, rlf_vec3 p, int32_t x, int32_t y)
{
    const ptrdiff_t i = (ptrdiff_t)y * w->grid->width + x;
    rlf_vec3 arm = rlf_sub(p, w->slab->pose.p);
    rlf_vec3 v = rlf_add(w->slab->speed, rlf_cross(w->slab->spin, arm));
    if (rlf_length(v) > slowest) {
        const rlf_span here = {x, x + 1};
        w->slot->moved[y] = rlf_span_unite(w->slot->moved[y], here);
        w->slot->velocity[0][i] = (float)v.x;
        w->slot->velocity[1][i] = (float)v.y;
        w->slot->velocity[2][i] = (float)v.z;
    }
}

static void write_pixel(const writer *w, int32_t x, int32_t y)
{
    const ptrdiff_t i = (ptrdiff_t)y * w->grid->width + x;
    const float z = w->slot->depth[i], behind = w->behind[i];
    const double u = w->grid->ray_x[i], v = w->grid->ray_y[i];
    const rlf_vec3 p = image_grid_point(w->grid, w->slot->depth, i);
    double enter, leave;
    if (!(z > 0.0f) || !slab_is_near(&w->view, p, THIN_NEAR_M) ||
        (!slab_cut_ray(&w->view, u, v, &enter, &leave) &&
         !slab_cut_ray(&w->wide, u, v, &enter, &leave))) {
        return;
    }
    const float deep = (float)leave - z, thickness = deep > RLF_THINNEST_M ? deep : RLF_THINNEST_M;
    const bool is_cut = behind > 0.0f && z + thickness > behind;
    w->slot->thickness[i] = !is_cut ? thickness : behind > z ? behind - z : 0.0f;
    if (w->is_edge_on && w->slot->reason[i] != RLF_REASON_OK) {
        move_pixel(w, p, x, y);
    }
}

void thin_write(const thin *state, const image_grid *grid, const float *behind, rlf_slot *slot)
{
    for (int32_t k = 0; k < state->count; k++) {
        const slab *s = &state->item[k];
        writer w = {.grid = grid, .slab = s, .view = slab_look(s), .behind = behind, .slot = slot};
        const double facing = rlf_dot(w.view.axis[2], rlf_normalize(w.view.centre));
        w.is_edge_on = facing < edge_on && facing > -edge_on;
        w.wide = w.view;
        for (int c = 0; c < 3; c++) {
            w.wide.half[c] += w.view.centre.z / grid->camera.fx;
        }
        const rlf_rect window = slab_window(grid, &w.view, 1);
        for (int32_t y = window.y0; y < window.y1; y++) {
            for (int32_t x = window.x0; x < window.x1; x++) {
                if (slot->foreground[(ptrdiff_t)y * grid->width + x] != 0) {
                    write_pixel(&w, x, y);
                }
            }
        }
    }
}
