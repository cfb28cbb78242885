/* The triangle mesh of the grid over the picture (thesis fig. 4.3 and 4.5). */
#include "render/soft/views.h"

#include "render/soft/draw.h"
#include "render/soft/soft.h"

#define SPACING_PX 8  /* of the full depth image, as with the thesis's scale factor */
#define JUMP_MAX 0.15 /* of the nearer depth: a longer edge bridges two things */

typedef struct mesh_view {
    soft *s;
    const rlf_surface *surface;
    double near_z, far_z;
} mesh_view;

static bool place(const mesh_view *view, int32_t index, soft_point *out)
{
    if (!(view->surface->depth[index] > 0.0f)) {
        return false;
    }
    rlf_vec3 p = rlf_transform(&view->s->T_picture_depth, rlf_surface_point(view->surface, index));
    return p.z > SOFT_NEAR_Z && rlf_camera_project(&view->s->camera, p, &out->x, &out->y);
}

static void draw_edge(const mesh_view *view, int32_t from, int32_t to)
{
    soft_point a, b;
    double za = view->surface->depth[from];
    double zb = view->surface->depth[to];
    double jump = za < zb ? zb - za : za - zb;
    if (jump > JUMP_MAX * rlf_min(za, zb) || !place(view, from, &a) || !place(view, to, &b)) {
        return;
    }
    double t = (za - view->near_z) / (view->far_z - view->near_z);
    soft_draw_line(&view->s->image, a, b, soft_color_near_far(0.7 * t));
}

void soft_draw_mesh(soft *s, const rlf_surface *surface)
{
    mesh_view view = {s, surface, s->def.rig.depth_min_m, s->def.rig.depth_max_m};
    if (!(view.far_z > view.near_z)) {
        view.near_z = 0.5;
        view.far_z = 4.5;
    }
    int32_t factor = surface->scale_factor > 0 ? surface->scale_factor : 1;
    int32_t step = factor < SPACING_PX ? SPACING_PX / factor : 1;
    int32_t w = surface->width;
    for (int32_t y = 0; y < surface->height; y += step) {
        for (int32_t x = 0; x < w; x += step) {
            int32_t n = y * w + x;
            bool has_right = x + step < w;
            bool has_below = y + step < surface->height;
            if (has_right) {
                draw_edge(&view, n, n + step);
            }
            if (has_below) {
                draw_edge(&view, n, n + step * w);
            }
            if (has_right && has_below) {
                draw_edge(&view, n + step, n + step * w); /* shared by T1 and T2 */
            }
        }
    }
}
