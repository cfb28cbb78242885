/* A clip in the frame loop with the default camera, and what that decides of it. */
#include "eval/moving/standing.h"

#include "command.h"
#include "relief/io.h"
#include "relief/pipeline.h"

#include <math.h>
#include <string.h>

#define DARK_FROM 20
#define DARK_TO 35
#define DARKER 16      /* divides the picture's values */
#define STILL_M 2e-4   /* a true motion of less, and ... */
#define STILL_RAD 1e-4 /* ... less than that in a frame is none */
#define PERSON_FROM 15
#define PERSON_PARTS 4

/* The clip as the loop gets it. */
typedef struct disguise {
    rlf_source *source;
    standing_case kind;
    int64_t frame;
    rlf_pose T_world_camera; /* of the newest frame: the truth, */
    bool has_pose;           /* where there is one */
    float *depth;
    uint8_t *rgba;
} disguise;

/* Distance along z to an ellipsoid about `centre` whose axes are turned by `angle` about y. */
static double to_ellipsoid(rlf_vec3 ray, rlf_vec3 centre, rlf_vec3 radii, double angle)
{
    const rlf_quat back = rlf_quat_from_axis_angle(rlf_vec3_make(0.0, 1.0, 0.0), -angle);
    const rlf_vec3 d = rlf_rotate(back, ray), c = rlf_rotate(back, centre);
    const rlf_vec3 way = {d.x / radii.x, d.y / radii.y, d.z / radii.z};
    const rlf_vec3 to = {c.x / radii.x, c.y / radii.y, c.z / radii.z};
    const double a = rlf_dot(way, way), b = rlf_dot(way, to);
    const double root = b * b - a * (rlf_dot(to, to) - 1.0);
    return root > 0.0 ? (b - sqrt(root)) / a : 1e9;
}

/* Trunk, head and two arms, 1.1 m away, that turn by 100 degrees a second to both sides. */
static void put_person(disguise *d, const rlf_rig *rig)
{
    static const rlf_vec3 centres[PERSON_PARTS] = {
        {0.0, 0.25, 0.0}, {0.0, -0.45, 0.0}, {-0.34, 0.2, -0.1}, {0.34, 0.2, -0.1}};
    static const rlf_vec3 radii[PERSON_PARTS] = {
        {0.27, 0.58, 0.17}, {0.12, 0.16, 0.13}, {0.08, 0.36, 0.1}, {0.08, 0.36, 0.1}};
    const double t = (double)(d->frame - PERSON_FROM) / 30.0;
    const double angle = sin(2.0 * RLF_PI * 0.3 * t);
    const rlf_vec3 place = {0.1 * sin(1.3 * t), 0.0, 1.1};
    const rlf_quat turn = rlf_quat_from_axis_angle(rlf_vec3_make(0.0, 1.0, 0.0), angle);
    for (int32_t i = 0; i < rig->depth.width * rig->depth.height; i++) {
        rlf_vec3 ray;
        if (!rlf_camera_unproject(&rig->depth, i % rig->depth.width, i / rig->depth.width, &ray)) {
            continue;
        }
        for (int k = 0; k < PERSON_PARTS; k++) {
            const rlf_vec3 centre = rlf_add(place, rlf_rotate(turn, centres[k]));
            const double z = to_ellipsoid(ray, centre, radii[k], angle);
            const bool is_nearer = z < 8.0 && (!(d->depth[i] > 0.0f) || z < (double)d->depth[i]);
            d->depth[i] = is_nearer ? (float)z : d->depth[i];
        }
    }
}

static void take_depth(disguise *d, rlf_frame *frame)
{
    const rlf_camera *k = &frame->rig->depth;
    for (int32_t i = 0; i < k->width * k->height; i++) {
        const int32_t x = i % k->width, y = i / k->width;
        const char *row = frame->depth_u16 != NULL ? (const char *)frame->depth_u16
                                                   : (const char *)frame->depth_f32;
        row += y * frame->depth_stride;
        d->depth[i] =
            frame->depth_u16 != NULL
                ? (float)(((const uint16_t *)(const void *)row)[x] / frame->depth_units_per_metre)
                : ((const float *)(const void *)row)[x];
    }
    frame->depth_u16 = NULL;
    frame->depth_f32 = d->depth;
    frame->depth_stride = k->width * (ptrdiff_t)sizeof(float);
}

static void darken(disguise *d, rlf_frame *frame)
{
    rlf_image_rgba8 *c = &frame->color;
    for (int32_t y = 0; y < c->height && c->data != NULL; y++) {
        for (int32_t x = 0; x < 4 * c->width; x++) {
            const uint8_t value = c->data[y * c->stride + x];
            d->rgba[4 * y * c->width + x] = (uint8_t)(x % 4 == 3 ? value : value / DARKER);
        }
    }
    if (c->data != NULL) {
        c->data = d->rgba;
        c->stride = 4 * (ptrdiff_t)c->width;
    }
}

static rlf_result next(void *self, rlf_frame *out)
{
    disguise *d = self;
    const rlf_result result = rlf_source_next(d->source, out);
    if (result != RLF_OK) {
        return result;
    }
    d->has_pose = out->has_pose;
    d->T_world_camera = out->T_world_camera;
    out->has_pose = false;
    if (d->kind == STANDING_PERSON && d->frame >= PERSON_FROM) {
        take_depth(d, out);
        put_person(d, out->rig);
    }
    if (d->kind == STANDING_DARK && d->frame >= DARK_FROM && d->frame < DARK_TO) {
        darken(d, out);
    }
    d->frame++;
    return RLF_OK;
}

typedef struct standing_run {
    disguise clip;
    rlf_pool *pool;
    rlf_source *source;
    rlf_scene scene;
    rlf_pipeline *pipeline;
    rlf_pose T_true, T_found; /* of the frame before */
    bool was_tracked, has_begun;
    int64_t frame, begun, stopped_ns, waited_since_ns, world_ns;
} standing_run;

static rlf_result open_run(standing_run *run, const char *text)
{
    rlf_result result = rlf_pool_create(1, &run->pool);
    if (result == RLF_OK) {
        result = rlf_open_source(text, run->pool, &run->clip.source);
    }
    if (result != RLF_OK) {
        return result;
    }
    const rlf_source_info *info = rlf_source_get_info(run->clip.source);
    const rlf_rig *rig = &info->rig;
    run->clip.depth = rlf_alloc_array((size_t)rig->depth.width * (size_t)rig->depth.height, 4);
    run->clip.rgba = rlf_alloc_array((size_t)rig->color.width * (size_t)rig->color.height + 1, 4);
    if (run->clip.depth == NULL || run->clip.rgba == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const rlf_source_methods methods = {.next = next};
    result = rlf_source_create_custom(&methods, info, &run->clip, &run->source);
    if (result == RLF_OK) {
        result = rlf_scene_create_two_cubes(&run->scene);
    }
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, run->source, run->pool);
        def.scene = &run->scene;
        def.camera = RLF_CAMERA_AUTO;
        def.enable_render = false;
        result = rlf_pipeline_create(&def, &run->pipeline);
    }
    return result;
}

static void close_run(standing_run *run)
{
    rlf_pipeline_destroy(&run->pipeline);
    rlf_scene_destroy(&run->scene);
    rlf_source_destroy(&run->source);
    rlf_source_destroy(&run->clip.source);
    rlf_pool_destroy(&run->pool);
    rlf_free(run->clip.depth);
    rlf_free(run->clip.rgba);
}

static rlf_pose way_of(const rlf_pose *from, const rlf_pose *to)
{
    const rlf_pose back = rlf_pose_invert(from);
    return rlf_pose_mul(&back, to);
}

/* The truth: when the camera began to move, and when it stopped. */
static void follow_truth(standing_run *run, int64_t time_ns)
{
    const rlf_pose way = way_of(&run->T_true, &run->clip.T_world_camera);
    const double turn = 2.0 * rlf_length(rlf_vec3_make(way.q.x, way.q.y, way.q.z));
    const bool moves =
        run->frame > 0 && run->clip.has_pose && (rlf_length(way.p) > STILL_M || turn > STILL_RAD);
    if (moves) {
        run->begun = run->has_begun ? run->begun : run->frame;
        run->has_begun = true;
        run->stopped_ns = time_ns;
    }
}

/* How far this frame's pose leaps away from the truth. */
static double leap_mm(const standing_run *run, const rlf_pipeline_output *f)
{
    const rlf_pose went = way_of(&run->T_true, &run->clip.T_world_camera);
    const rlf_pose found = way_of(&run->T_found, &f->T_world_camera);
    return 1000.0 *
           rlf_length(rlf_sub(found.p, run->clip.has_pose ? went.p : rlf_vec3_make(0, 0, 0)));
}

static void judge(standing_run *run, const rlf_pipeline_output *f, standing_figures *out)
{
    const bool is_tracked = f->track != NULL;
    const int64_t now = f->frame.time_ns;
    follow_truth(run, now);
    if (is_tracked && !run->was_tracked) {
        const bool is_first = run->has_begun && out->told < 0;
        out->alarms += !is_first;
        out->told = is_first ? (int32_t)(run->frame - run->begun) : out->told;
        out->snap_mm = rlf_max(out->snap_mm, leap_mm(run, f));
    }
    if (!is_tracked && run->was_tracked) {
        out->stands_s = run->has_begun ? (double)(now - run->stopped_ns) * 1e-9 : out->stands_s;
        out->jump_mm = rlf_max(out->jump_mm, leap_mm(run, f));
    }
    run->waited_since_ns =
        run->frame == 0 || f->snapshot->time_ns > run->world_ns ? now : run->waited_since_ns;
    out->wait_s = rlf_max(out->wait_s, (double)(now - run->waited_since_ns) * 1e-9);
    run->world_ns = f->snapshot->time_ns;
    run->was_tracked = is_tracked;
    run->T_true = run->clip.T_world_camera;
    run->T_found = f->T_world_camera;
    run->frame++;
}

rlf_result standing_measure(const char *source, standing_case kind, int64_t frames,
                            standing_figures *out)
{
    static standing_run run;
    memset(&run, 0, sizeof(run));
    *out = (standing_figures){.told = -1, .stands_s = -1.0};
    run.clip.kind = kind;
    rlf_result result = open_run(&run, source);
    rlf_pipeline_output frame;
    while (result == RLF_OK && !command_interrupted && (frames == 0 || run.frame < frames)) {
        result = rlf_pipeline_step(run.pipeline, &frame);
        if (result == RLF_OK) {
            judge(&run, &frame, out);
        }
    }
    out->frames = (int32_t)run.frame;
    close_run(&run);
    return result == RLF_END ? RLF_OK : result;
}
