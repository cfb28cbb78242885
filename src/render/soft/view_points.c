/* The surface's points and the bodies from a free viewpoint.
 *
 * Points are drawn as squares as large as the surface between them, into a depth buffer; then the
 * bodies as in the main view, with that buffer for the real world. */
#include "render/soft/views.h"

#include "render/render.h"
#include "render/soft/passes.h"
#include "render/soft/draw.h"
#include "render/soft/soft.h"

#define SPLAT_MAX 12.0 /* pixels: half a square */
#define FRUSTUM_M 0.25 /* length of the camera that is drawn */

/* The middle of the sensor's range. */
static double pivot_of(const rlf_rig *rig)
{
    return rig->depth_max_m > rig->depth_min_m ? 0.5 * (rig->depth_min_m + rig->depth_max_m) : 2.5;
}

void soft_clear_view(soft *s)
{
    for (int32_t y = 0; y < s->image.height; y++) {
        uint8_t *row = rlf_rgba8_row(&s->image, y);
        float *z = rlf_f32_row(&s->real.z, y);
        for (int32_t x = 0; x < s->image.width; x++) {
            soft_put(row + 4 * (ptrdiff_t)x, soft_color_dark());
            z[x] = 0.0f;
        }
    }
}

/* Pixels from low to high within 0..size. */
static int32_t cell(double at, int32_t size)
{
    return (int32_t)rlf_clamp(at, 0.0, size);
}

static void draw_square(soft *s, soft_point at, double half, float z, soft_color color)
{
    int32_t x1 = cell(at.x + half + 0.5, s->image.width);
    int32_t y1 = cell(at.y + half + 0.5, s->image.height);
    for (int32_t y = cell(at.y - half + 0.5, s->image.height); y < y1; y++) {
        float *depth = rlf_f32_row(&s->real.z, y);
        uint8_t *row = rlf_rgba8_row(&s->image, y);
        for (int32_t x = cell(at.x - half + 0.5, s->image.width); x < x1; x++) {
            if (!(depth[x] > 0.0f) || z < depth[x]) {
                depth[x] = z;
                soft_put(row + 4 * (ptrdiff_t)x, color);
            }
        }
    }
}

static void draw_point(soft *s, const rlf_render_input *input, int32_t i, float z, soft_color color)
{
    const rlf_surface *surface = input->surface;
    rlf_vec3 p = {z * surface->ray_x[i], z * surface->ray_y[i], z};
    soft_point at;
    p = rlf_transform(&s->T_picture_depth, p);
    if (p.z > SOFT_NEAR_Z && rlf_camera_project(&s->camera, p, &at.x, &at.y)) {
        double half = 0.8 * s->camera.fx / surface->camera.fx * z / p.z;
        draw_square(s, at, rlf_clamp(half, 0.5, SPLAT_MAX), (float)p.z, color);
    }
}

/* What is behind the foreground is known from before; its colour is not. */
static void draw_all_points(soft *s, const rlf_render_input *input)
{
    const rlf_surface *surface = input->surface;
    for (int32_t i = 0; i < surface->width * surface->height; i++) {
        float z = surface->depth[i];
        float behind = surface->background_depth != NULL ? surface->background_depth[i] : 0.0f;
        if (z > 0.0f) {
            draw_point(s, input, i, z, soft_grid_color(s, input, i, z));
        }
        if (behind > 0.0f && (!(z > 0.0f) || behind > 1.05f * z)) {
            draw_point(s, input, i, behind, soft_color_unseen());
        }
    }
}

void soft_draw_frustum(const soft *s)
{
    const rlf_camera *k = &s->def.grid;
    soft_point ends[5];
    bool is_seen[5];
    for (int i = 0; i < 5; i++) {
        rlf_vec3 p = {0, 0, 0};
        if (i > 0) {
            double u = i == 1 || i == 4 ? -0.5 : k->width - 0.5;
            double v = i <= 2 ? -0.5 : k->height - 0.5;
            p = rlf_vec3_make((u - k->cx) / k->fx, (v - k->cy) / k->fy, 1.0);
            p = rlf_scale(p, FRUSTUM_M);
        }
        p = rlf_transform(&s->T_picture_depth, p);
        is_seen[i] = p.z > SOFT_NEAR_Z && rlf_camera_project(&s->camera, p, &ends[i].x, &ends[i].y);
    }
    for (int i = 1; i < 5; i++) {
        int next = i % 4 + 1;
        if (is_seen[0] && is_seen[i]) {
            soft_draw_line(&s->image, ends[0], ends[i], soft_rgb(255, 255, 255));
        }
        if (is_seen[i] && is_seen[next]) {
            soft_draw_line(&s->image, ends[i], ends[next], soft_rgb(255, 255, 255));
        }
    }
}

rlf_result soft_draw_points(soft *s, const rlf_render_input *input)
{
    const rlf_camera camera = s->camera;
    const rlf_pose T_picture_depth = s->T_picture_depth;
    const rlf_occlusion occlusion = s->def.occlusion;
    rlf_camera pinhole = camera;
    pinhole.distortion_model = RLF_DISTORTION_NONE;
    rlf_pose T_view_depth = render_orbit_pose(&input->orbit, pivot_of(&s->def.rig));
    soft_set_viewpoint(s, &pinhole, &T_view_depth);
    s->def.occlusion = RLF_OCCLUSION_DEPTH;
    soft_clear_view(s);
    draw_all_points(s, input);
    rlf_result result = soft_scene_build(s, input);
    if (result == RLF_OK && s->scene.body_count > 0) {
        soft_draw_bodies(s, false);
    }
    soft_draw_frustum(s);
    s->def.occlusion = occlusion;
    soft_set_viewpoint(s, &camera, &T_picture_depth);
    return result;
}
