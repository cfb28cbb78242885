/* An analytic scene for compositor tests: a wall, with or without a strip before it, seen by a
 * depth and a colour camera side by side. */
#ifndef RLF_TEST_RENDER_SCENE_H
#define RLF_TEST_RENDER_SCENE_H

#include "relief/compositor.h"

#include <stdlib.h>
#include <string.h>

#define SCENE_BODY_MAX 16
#define SCENE_PLANE_COUNT 11

typedef struct render_scene {
    rlf_rig rig;
    rlf_camera grid;
    float *ray_x, *ray_y, *planes[SCENE_PLANE_COUNT];
    int32_t *label;
    uint8_t *reason, *foreground, *color;
    rlf_region region;
    rlf_surface surface;
    rlf_frame frame;
    rlf_body_state bodies[SCENE_BODY_MAX];
    rlf_snapshot snapshot;
    rlf_render_input input;
} render_scene;

enum { PLANE_DEPTH = 0, PLANE_NORMAL = 1, PLANE_VELOCITY = 4, PLANE_THICKNESS = 7, PLANE_BACK = 8 };

static inline rlf_rig scene_rig(void)
{
    rlf_camera depth = {
        .width = 512, .height = 424, .fx = 365.5, .fy = 365.5, .cx = 255.5, .cy = 211.5};
    rlf_camera color = {
        .width = 960, .height = 540, .fx = 540.5, .fy = 540.5, .cx = 479.5, .cy = 269.5};
    rlf_rig rig = {.depth = depth,
                   .color = color,
                   .T_color_depth = rlf_pose_identity(),
                   .has_color = true,
                   .depth_min_m = 0.5,
                   .depth_max_m = 4.5};
    rig.T_color_depth.p.x = -0.052;
    return rig;
}

static inline void scene_fill_rays(render_scene *s)
{
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        rlf_vec3 ray;
        rlf_camera_unproject(&s->grid, i % s->grid.width, i / s->grid.width, &ray);
        s->ray_x[i] = (float)ray.x;
        s->ray_y[i] = (float)ray.y;
    }
}

static inline void scene_fill_color(render_scene *s)
{
    int32_t width = s->rig.color.width;
    for (int32_t i = 0; i < width * s->rig.color.height; i++) {
        uint8_t grey = (uint8_t)(90 + (i % width / 8 + i / width / 8) % 2 * 20);
        memset(s->color + 4 * (size_t)i, grey, 3);
        s->color[4 * (size_t)i + 3] = 255;
    }
}

/* Wall at z_wall; nothing in front of it. Free with scene_free. */
static inline render_scene *scene_make(double z_wall)
{
    render_scene *s = calloc(1, sizeof(*s));
    s->rig = scene_rig();
    s->grid = s->rig.depth;
    size_t count = (size_t)s->grid.width * (size_t)s->grid.height;
    s->ray_x = calloc(count, sizeof(float));
    s->ray_y = calloc(count, sizeof(float));
    for (int i = 0; i < SCENE_PLANE_COUNT; i++) {
        s->planes[i] = calloc(count, sizeof(float));
    }
    s->label = calloc(count, sizeof(int32_t));
    s->reason = calloc(count, 1);
    s->foreground = calloc(count, 1);
    s->color = malloc((size_t)s->rig.color.width * (size_t)s->rig.color.height * 4);
    scene_fill_rays(s);
    scene_fill_color(s);
    for (size_t i = 0; i < count; i++) {
        s->planes[PLANE_DEPTH][i] = (float)z_wall;
        s->planes[PLANE_BACK][i] = (float)z_wall;
        s->planes[PLANE_NORMAL + 2][i] = -1.0f;
        s->label[i] = 1;
    }
    float **p = s->planes;
    s->surface = (rlf_surface){.width = s->grid.width,
                               .height = s->grid.height,
                               .scale_factor = 1,
                               .camera = s->grid,
                               .ray_x = s->ray_x,
                               .ray_y = s->ray_y,
                               .depth = p[0],
                               .normal_x = p[1],
                               .normal_y = p[2],
                               .normal_z = p[3],
                               .velocity_x = p[4],
                               .velocity_y = p[5],
                               .velocity_z = p[6],
                               .thickness = p[7],
                               .label = s->label,
                               .reason = s->reason,
                               .foreground = s->foreground,
                               .background_depth = p[8],
                               .background_label = s->label};
    s->frame = (rlf_frame){.rig = &s->rig,
                           .color = {s->color, s->rig.color.width, s->rig.color.height,
                                     4 * (ptrdiff_t)s->rig.color.width}};
    s->snapshot = (rlf_snapshot){.gravity = {0, 9.81, 0}, .bodies = s->bodies};
    s->input = (rlf_render_input){.frame = &s->frame,
                                  .surface = &s->surface,
                                  .snapshot = &s->snapshot,
                                  .T_world_camera = rlf_pose_identity()};
    return s;
}

static inline void scene_free(render_scene *s)
{
    free(s->ray_x);
    free(s->ray_y);
    for (int i = 0; i < SCENE_PLANE_COUNT; i++) {
        free(s->planes[i]);
    }
    free(s->label);
    free(s->reason);
    free(s->foreground);
    free(s->color);
    free(s);
}

/* Something at depth z in grid columns [first, end), from top to bottom. */
static inline void scene_add_strip(render_scene *s, int32_t first, int32_t end, double z)
{
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        if (i % s->grid.width >= first && i % s->grid.width < end) {
            s->planes[PLANE_DEPTH][i] = (float)z;
            s->foreground[i] = 1;
            s->label[i] = 2;
        }
    }
}

static inline rlf_body_state *scene_add_body(render_scene *s, rlf_shape shape, rlf_vec3 position)
{
    rlf_body_state *body = &s->bodies[s->snapshot.body_count++];
    *body = (rlf_body_state){.shape = shape, .mass = 1, .color = {1.0f, 0.5f, 0.2f}};
    body->T_world_body = rlf_pose_identity();
    body->T_world_body.p = position;
    return body;
}

static inline rlf_shape scene_box(double size)
{
    return (rlf_shape){.type = RLF_SHAPE_BOX, .size = {size, size, size}};
}

static inline rlf_compositor_def scene_def(const render_scene *s)
{
    rlf_compositor_def def = rlf_compositor_def_default();
    def.rig = s->rig;
    def.grid = s->grid;
    def.ray_x = s->ray_x;
    def.ray_y = s->ray_y;
    return def;
}

#endif
