/* Are bodies in the shadow of real things where they ought to be? Every picture is drawn with and
 * without real shade; where the one is darker is compared with rays through the true scene. */
#include "eval/picture/light.h"

#include "eval/picture/truth.h"
#include "eval/table.h"
#include "relief/pipeline.h"
#include "relief/synthetic.h"

#include <math.h>
#include <stdio.h>

#define TRIES 20000 /* of bodies */
#define WARM_UP 50  /* frames: the background is learnt, the person comes in */
#define EVERY 15    /* frames between those that are judged */
#define JUDGED 4
#define STEP 3           /* pixels between those that are judged, both ways */
#define LEAST_FACING 0.3 /* of a body's surface to the light: below, shade is hard to tell */
#define REACH_M 2.5
#define LIFT_M 0.002
#define AMBIENT 0.3 /* of the renderers' light, and the share of the rest that is taken */
#define TAKEN 0.85

/* To the right and away, to the left, and out of the room's depth towards the camera. */
static const rlf_vec3 lights[] = {{0.3, 0.8, 0.5}, {-0.6, 0.7, 0.1}, {0.4, 0.7, -0.5}};
#define LIGHT_COUNT ((int)(sizeof(lights) / sizeof(lights[0])))

typedef struct light_run {
    rlf_source *source;
    rlf_pipeline *pipeline;
    rlf_compositor *compositors[LIGHT_COUNT][2]; /* without and with real shade */
    rlf_body_state bodies[PICTURE_BODIES];
    rlf_snapshot snapshot;
    uint64_t random;
    rlf_camera camera;
    rlf_vec3 origin; /* of the colour camera, depth camera frame */
} light_run;

typedef struct shade_counts {
    int64_t pixels, wrong, both, either, shadowed;
} shade_counts;

static void close_run(light_run *run)
{
    for (int i = 0; i < 2 * LIGHT_COUNT; i++) {
        rlf_compositor_destroy(&run->compositors[i / 2][i % 2]);
    }
    rlf_pipeline_destroy(&run->pipeline);
    rlf_source_destroy(&run->source);
}

/* lamp NULL = the room's own. */
static rlf_result open_source(light_run *run, int64_t seed, const rlf_vec3 *lamp)
{
    char name[96];
    (void)snprintf(name, sizeof(name), "synthetic:room?seed=%lld&frames=-1", (long long)seed);
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    rlf_result result = rlf_synthetic_parse(name, &synthetic);
    synthetic.enable_truth = false;
    synthetic.lamp = lamp != NULL ? *lamp : synthetic.lamp;
    result = result == RLF_OK ? rlf_synthetic_create(&synthetic, &run->source) : result;
    if (result != RLF_OK) {
        return result;
    }
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, run->source, NULL);
    def.enable_render = false;
    return rlf_pipeline_create(&def, &run->pipeline);
}

static rlf_result open_run(light_run *run, int64_t seed)
{
    rlf_result result = open_source(run, seed, NULL);
    for (int i = 0; i < 2 * LIGHT_COUNT && result == RLF_OK; i++) {
        rlf_compositor_def compositor = rlf_pipeline_get_compositor_def(run->pipeline);
        compositor.light_direction = rlf_normalize(lights[i / 2]);
        compositor.enable_real_shade = i % 2 != 0;
        compositor.enable_real_ambient = false; /* is not what is judged */
        result = rlf_compositor_create_soft(&compositor, &run->compositors[i / 2][i % 2]);
    }
    const rlf_rig *rig = &rlf_source_get_info(run->source)->rig;
    run->camera = rig->color;
    run->origin = rlf_neg(rig->T_color_depth.p);
    run->snapshot.bodies = run->bodies;
    run->random = (uint64_t)seed * 977 + 11;
    return result;
}

/* A point on a body, and its outward normal. */
typedef struct body_point {
    rlf_vec3 p, normal;
    int32_t body; /* -1 = none */
} body_point;

static rlf_result is_truly_shadowed(light_run *run, const body_point *at, rlf_vec3 to_light,
                                    bool *out)
{
    float distance = 0.0f;
    int32_t label = 0;
    rlf_vec3 from = rlf_mad(at->p, at->normal, LIFT_M);
    rlf_result result = rlf_synthetic_cast(run->source, from, &to_light, 1, &distance, &label);
    bool is_shell = label == RLF_SYNTHETIC_LABEL_WALL || label == RLF_SYNTHETIC_LABEL_CEILING;
    *out = distance > 0.0f && (double)distance < REACH_M && !is_shell;
    return result;
}

/* Bodies that touch nothing, every second one with its middle in the shadow of something real. */
static rlf_result place_bodies(light_run *run, rlf_vec3 to_light)
{
    int32_t *count = &run->snapshot.body_count;
    *count = 0;
    for (int i = 0; i < TRIES && *count < PICTURE_BODIES; i++) {
        rlf_body_state body = picture_random_body(&run->random);
        bool is_free = false;
        rlf_result result = picture_is_free(run->source, run->bodies, *count, &body, &is_free);
        body_point middle = {.p = body.T_world_body.p};
        bool is_shadowed = false;
        if (result == RLF_OK && is_free) {
            result = is_truly_shadowed(run, &middle, to_light, &is_shadowed);
        }
        if (result != RLF_OK) {
            return result;
        }
        if (is_free && is_shadowed == (*count % 2 != 0)) {
            run->bodies[(*count)++] = body;
        }
    }
    return RLF_OK;
}

static body_point find_point(const light_run *run, int32_t x, int32_t y)
{
    rlf_vec3 ray = {(x - run->camera.cx) / run->camera.fx, (y - run->camera.cy) / run->camera.fy,
                    1.0};
    body_point found = {.body = -1};
    double nearest = 1e9;
    for (int32_t i = 0; i < run->snapshot.body_count; i++) {
        double z = picture_enter_body(&run->bodies[i], run->origin, ray);
        if (z > 0.0 && z < nearest) {
            nearest = z;
            found.body = i;
        }
    }
    if (found.body >= 0) {
        found.p = rlf_mad(run->origin, ray, nearest);
        found.normal = picture_normal_of_body(&run->bodies[found.body], found.p);
    }
    return found;
}

/* True when another body is between the point and the light: not what is measured. */
static bool is_in_a_bodys_shadow(const light_run *run, const body_point *at, rlf_vec3 to_light)
{
    for (int32_t i = 0; i < run->snapshot.body_count; i++) {
        if (i != at->body && picture_enter_body(&run->bodies[i], at->p, to_light) > 0.0) {
            return true;
        }
    }
    return false;
}

/* One pixel of a body that faces the light. */
static rlf_result judge_pixel(light_run *run, const rlf_render_output out[2], const body_point *at,
                              rlf_vec3 to_light, int32_t pixel, shade_counts *counts)
{
    const int32_t x = pixel % run->camera.width;
    const int32_t y = pixel / run->camera.width;
    double facing = rlf_dot(at->normal, to_light);
    bool is_seen = rlf_u8_row(&out[1].matte, y)[x] == 255;
    if (!is_seen || facing < LEAST_FACING || is_in_a_bodys_shadow(run, at, to_light)) {
        return RLF_OK;
    }
    bool is_shadowed = false;
    rlf_result result = is_truly_shadowed(run, at, to_light, &is_shadowed);
    double value[2] = {0.0, 0.0};
    for (int i = 0; i < 2; i++) {
        const uint8_t *color = rlf_rgba8_row(&out[i].image, y) + 4 * (ptrdiff_t)x;
        value[i] = color[0] * color[0] + color[1] * color[1] + color[2] * color[2]; /* light */
    }
    double direct = (1.0 - AMBIENT) * facing;
    double half = 1.0 - 0.5 * TAKEN * direct / (AMBIENT + direct);
    bool is_dark = value[1] < half * value[0];
    counts->pixels++;
    counts->wrong += is_dark != is_shadowed ? 1 : 0;
    counts->shadowed += is_shadowed ? 1 : 0;
    counts->both += is_dark && is_shadowed ? 1 : 0;
    counts->either += is_dark || is_shadowed ? 1 : 0;
    return result;
}

static rlf_result judge_frame(light_run *run, const rlf_pipeline_output *frame,
                              shade_counts *counts)
{
    rlf_render_input input = {.frame = &frame->frame,
                              .surface = frame->surface,
                              .snapshot = &run->snapshot,
                              .T_world_camera = rlf_pose_identity()};
    rlf_result result = RLF_OK;
    for (int l = 0; l < LIGHT_COUNT && result == RLF_OK; l++) {
        rlf_vec3 to_light = rlf_neg(rlf_normalize(lights[l]));
        rlf_render_output out[2];
        result = place_bodies(run, to_light);
        for (int i = 0; i < 2 && result == RLF_OK; i++) {
            result = rlf_compositor_render(run->compositors[l][i], &input, &out[i]);
        }
        for (int32_t y = 0; y < run->camera.height; y += STEP) {
            for (int32_t x = 0; x < run->camera.width && result == RLF_OK; x += STEP) {
                body_point at = find_point(run, x, y);
                if (at.body >= 0) {
                    result =
                        judge_pixel(run, out, &at, to_light, y * run->camera.width + x, counts);
                }
            }
        }
    }
    return result;
}

static rlf_result measure(light_run *run, int64_t seed, shade_counts *counts)
{
    rlf_result result = open_run(run, seed);
    for (int i = 0; result == RLF_OK && i <= WARM_UP + EVERY * (JUDGED - 1); i++) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(run->pipeline, &frame);
        if (result == RLF_OK && i >= WARM_UP && (i - WARM_UP) % EVERY == 0) {
            result = judge_frame(run, &frame, counts);
        }
    }
    return result;
}

/* ---- where the light is ---------------------------------------------------------------------- */

#define FOUND_AFTER 12 /* frames */

/* Right before the room, left of it, above it, and the room's own lamp. */
static const rlf_vec3 lamps[] = {
    {3.0, -2.2, -1.0}, {-3.0, -0.5, 1.0}, {0.5, -6.0, 2.0}, {-0.7, -1.85, 1.5}};
#define LAMP_COUNT ((int)(sizeof(lamps) / sizeof(lamps[0])))

/* From the lamp to the middle of what is seen. */
static rlf_vec3 true_direction(const rlf_surface *s, rlf_vec3 lamp)
{
    rlf_vec3 sum = {0, 0, 0};
    double count = 0.0;
    for (int32_t i = 0; i < s->width * s->height; i++) {
        if (s->depth[i] > 0.0f) {
            sum = rlf_add(sum, rlf_surface_point(s, i));
            count += 1.0;
        }
    }
    return rlf_normalize(rlf_sub(rlf_scale(sum, 1.0 / count), lamp));
}

/* Cosine of the angle between the light that is found and the true one. */
static rlf_result find_light(light_run *run, int64_t seed, rlf_vec3 lamp, double *out_cosine)
{
    rlf_result result = open_source(run, seed, &lamp);
    if (result == RLF_OK) {
        rlf_compositor_def compositor = rlf_pipeline_get_compositor_def(run->pipeline);
        compositor.estimates_light_direction = true;
        result = rlf_compositor_create_soft(&compositor, &run->compositors[0][0]);
    }
    for (int i = 0; result == RLF_OK && i < FOUND_AFTER; i++) {
        rlf_pipeline_output frame;
        rlf_render_output out;
        result = rlf_pipeline_step(run->pipeline, &frame);
        rlf_render_input input = {
            .frame = &frame.frame, .surface = frame.surface, .T_world_camera = rlf_pose_identity()};
        if (result == RLF_OK) {
            result = rlf_compositor_render(run->compositors[0][0], &input, &out);
        }
        if (result == RLF_OK) {
            *out_cosine = rlf_dot(out.light_direction, true_direction(frame.surface, lamp));
        }
    }
    return result;
}

static rlf_result add_direction(eval_table *table, int64_t seed)
{
    double sum = 0.0;
    for (int i = 0; i < LAMP_COUNT; i++) {
        light_run run = {0};
        double cosine = 1.0;
        rlf_result result = find_light(&run, seed, lamps[i], &cosine);
        close_run(&run);
        if (result != RLF_OK) {
            return result;
        }
        sum += acos(rlf_clamp(cosine, -1.0, 1.0)) * 180.0 / RLF_PI;
    }
    eval_table_add(table, "picture", "light_off_deg", "direction of the light: off by, degrees",
                   RLF_PROFILE_LIVE, sum / LAMP_COUNT);
    return RLF_OK;
}

rlf_result picture_light_run(eval_table *table, int64_t seed)
{
    light_run run = {0};
    shade_counts counts = {0};
    rlf_result result = measure(&run, seed, &counts);
    close_run(&run);
    if (result != RLF_OK) {
        return result;
    }
    const double all = counts.pixels > 0 ? (double)counts.pixels : NAN;
    const double either = counts.either > 0 ? (double)counts.either : NAN;
    eval_table_add(table, "picture", "real_shade_percent", "bodies in real things' shadow, %",
                   RLF_PROFILE_LIVE, 100.0 * (double)counts.shadowed / all);
    eval_table_add(table, "picture", "real_shade_right_percent", "  lit or shadowed: right, %",
                   RLF_PROFILE_LIVE, 100.0 * (1.0 - (double)counts.wrong / all));
    eval_table_add(table, "picture", "real_shade_iou", "  shadowed pixels: IoU", RLF_PROFILE_LIVE,
                   (double)counts.both / either);
    return add_direction(table, seed);
}
