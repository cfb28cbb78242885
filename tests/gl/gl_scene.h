/* Small scenes with known answers for the renderer tests. */
#ifndef RLF_TEST_GL_SCENE_H
#define RLF_TEST_GL_SCENE_H

#include "relief/compositor.h"
#include "render/gl/gl_compositor.h"

#include <stdio.h>
#include <string.h>

enum { SCENE_WIDTH = 160, SCENE_HEIGHT = 120, SCENE_BODIES = 8 };

/* A frame and a surface over the same depth, a colour image, and some bodies. */
typedef struct gl_scene {
    rlf_rig rig;
    float ray_x[SCENE_WIDTH * SCENE_HEIGHT], ray_y[SCENE_WIDTH * SCENE_HEIGHT];
    float depth[SCENE_WIDTH * SCENE_HEIGHT];
    float normal[3][SCENE_WIDTH * SCENE_HEIGHT]; /* not of the surface until a test says so */
    uint8_t color[4 * 320 * 240];
    rlf_frame frame;
    rlf_surface surface;
    rlf_body_state bodies[SCENE_BODIES];
    rlf_snapshot snapshot;
    rlf_render_input input;
} gl_scene;

/* Depth and colour camera are the same pinhole; the wall is 2 m away; no bodies. */
static inline void gl_scene_init(gl_scene *s)
{
    memset(s, 0, sizeof(*s));
    rlf_camera camera = {SCENE_WIDTH, SCENE_HEIGHT, 140, 140, 79.3, 60.1, RLF_DISTORTION_NONE, {0}};
    s->rig = (rlf_rig){.depth = camera,
                       .color = camera,
                       .T_color_depth = rlf_pose_identity(),
                       .has_color = true,
                       .depth_min_m = 0.5,
                       .depth_max_m = 4.5};
    for (int32_t i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++) {
        rlf_vec3 ray;
        (void)rlf_camera_unproject(&camera, i % SCENE_WIDTH, i / SCENE_WIDTH, &ray);
        s->ray_x[i] = (float)ray.x;
        s->ray_y[i] = (float)ray.y;
        s->depth[i] = 2.0f;
    }
    for (int32_t i = 0; i < 320 * 240; i++) {
        s->color[4 * i] = (uint8_t)(40 + i % 97);
        s->color[4 * i + 1] = (uint8_t)(60 + i % 71);
        s->color[4 * i + 2] = (uint8_t)(200 - i % 53);
        s->color[4 * i + 3] = 255;
    }
    s->frame.rig = &s->rig;
    s->frame.depth_f32 = s->depth;
    s->frame.depth_stride = SCENE_WIDTH * (ptrdiff_t)sizeof(float);
    s->frame.color = (rlf_image_rgba8){s->color, SCENE_WIDTH, SCENE_HEIGHT, 4 * SCENE_WIDTH};
    s->surface.width = SCENE_WIDTH;
    s->surface.height = SCENE_HEIGHT;
    s->surface.scale_factor = 1;
    s->surface.camera = camera;
    s->surface.ray_x = s->ray_x;
    s->surface.ray_y = s->ray_y;
    s->surface.depth = s->depth;
    s->snapshot.gravity = rlf_vec3_make(0, 9.81, 0);
    s->snapshot.bodies = s->bodies;
    s->input.frame = &s->frame;
    s->input.surface = &s->surface;
    s->input.snapshot = &s->snapshot;
    s->input.T_world_camera = rlf_pose_identity();
    s->input.view = RLF_VIEW_CAMERA;
}

static inline rlf_compositor_def gl_scene_def(const gl_scene *s, rlf_occlusion occlusion)
{
    rlf_compositor_def def = rlf_compositor_def_default();
    def.rig = s->rig;
    def.grid = s->surface.camera;
    def.ray_x = s->ray_x;
    def.ray_y = s->ray_y;
    def.occlusion = occlusion;
    return def;
}

static inline rlf_body_state *gl_scene_add(gl_scene *s, rlf_shape shape, rlf_vec3 p, rlf_quat q)
{
    static const float colors[3][3] = {{1.0f, 0.3f, 0.1f}, {0.2f, 0.9f, 0.3f}, {0.3f, 0.4f, 1.0f}};
    rlf_body_state *body = &s->bodies[s->snapshot.body_count];
    body->shape = shape;
    body->T_world_body.p = p;
    body->T_world_body.q = q;
    memcpy(body->color, colors[s->snapshot.body_count % 3], sizeof(body->color));
    s->snapshot.body_count++;
    return body;
}

static inline rlf_shape gl_scene_box(double x, double y, double z)
{
    rlf_shape shape = {.type = RLF_SHAPE_BOX, .size = {x, y, z}};
    return shape;
}

/* z at which the ray (x, y, 1) enters a box, or 0 when it misses (the slab test). */
static inline double gl_scene_ray_box(const rlf_body_state *box, rlf_vec3 ray)
{
    rlf_pose T = box->T_world_body;
    rlf_vec3 from = rlf_transform_inverse(&T, rlf_vec3_make(0, 0, 0));
    rlf_vec3 d = rlf_rotate(rlf_quat_conjugate(T.q), ray);
    const double o[3] = {from.x, from.y, from.z};
    const double v[3] = {d.x, d.y, d.z};
    const double half[3] = {0.5 * box->shape.size.x, 0.5 * box->shape.size.y,
                            0.5 * box->shape.size.z};
    double enter = 0.0;
    double leave = 1e9;
    for (int i = 0; i < 3; i++) {
        double a = (-half[i] - o[i]) / v[i];
        double b = (half[i] - o[i]) / v[i];
        enter = rlf_max(enter, rlf_min(a, b));
        leave = rlf_min(leave, rlf_max(a, b));
    }
    return enter < leave ? enter : 0.0;
}

/* 0 when OpenGL can be had; else prints why not, for `return 77`. */
static inline int gl_scene_probe(void)
{
    gl_context context;
    if (gl_context_open(CONTEXT_API_ANY, &context) != RLF_OK) {
        printf("SKIPPED: %s\n", rlf_error_text());
        return 77;
    }
    printf("OpenGL: %s\n", context.renderer);
    gl_context_close(&context);
    return 0;
}

/* Intersection over union of two masks. */
typedef struct gl_scene_overlap {
    int32_t both, any;
} gl_scene_overlap;

static inline void gl_scene_count(gl_scene_overlap *overlap, bool a, bool b)
{
    overlap->both += a && b;
    overlap->any += a || b;
}

static inline double gl_scene_iou(const gl_scene_overlap *overlap)
{
    return overlap->any > 0 ? (double)overlap->both / overlap->any : 1.0;
}

#endif
