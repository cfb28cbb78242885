/* Section "picture": is a body hidden where it ought to be? Every way of occlusion sees
 * the same frames of the synthetic room, with a walking person and with nobody. */
#include "eval/picture/picture.h"

#include "command.h"
#include "eval/picture/edges.h"
#include "eval/picture/light.h"
#include "eval/picture/oracle.h"
#include "eval/picture/truth.h"
#include "eval/table.h"
#include "relief/synthetic.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define WARM_UP 30 /* frames: the background is learnt */

typedef struct picture_method {
    rlf_profile profile;
    rlf_occlusion occlusion;
    bool is_default; /* of the profile */
} picture_method;

static const picture_method methods[] = {
    {RLF_PROFILE_LIVE, RLF_OCCLUSION_SOFT, true},
    {RLF_PROFILE_LIVE, RLF_OCCLUSION_DEPTH, false},
    {RLF_PROFILE_THESIS, RLF_OCCLUSION_THESIS, true},
};
#define METHOD_COUNT ((int)(sizeof(methods) / sizeof(methods[0])))

/* One method at work on one seed of one scene. */
typedef struct picture_run {
    rlf_source *source;
    rlf_pipeline *pipeline;
    rlf_compositor *compositor;
    picture_truth truth;
    picture_oracle oracle;
    rlf_body_state bodies[PICTURE_BODIES];
    rlf_snapshot snapshot;
    float *alpha[2]; /* of this picture and of the one before */
} picture_run;

static void close_run(picture_run *run)
{
    picture_truth_finish(&run->truth);
    rlf_free(run->alpha[0]);
    rlf_free(run->alpha[1]);
    rlf_compositor_destroy(&run->compositor);
    rlf_pipeline_destroy(&run->pipeline);
    picture_oracle_destroy(&run->oracle);
    rlf_source_destroy(&run->source);
}

static rlf_result open_run(picture_run *run, const picture_method *method, const char *scene,
                           int32_t oracle, int64_t seed)
{
    char name[96];
    (void)snprintf(name, sizeof(name), "synthetic:%s?seed=%lld&frames=-1", scene, (long long)seed);
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    rlf_result result = rlf_synthetic_parse(name, &synthetic);
    synthetic.enable_truth = (oracle & EVAL_ORACLE_SURFACE) != 0;
    result = result == RLF_OK ? rlf_synthetic_create(&synthetic, &run->source) : result;
    if (result != RLF_OK) {
        return result;
    }
    rlf_pipeline_def def = rlf_pipeline_def_default(method->profile, run->source, NULL);
    def.enable_render = false;
    result = rlf_pipeline_create(&def, &run->pipeline);
    if (result != RLF_OK) {
        return result;
    }
    rlf_compositor_def compositor = rlf_pipeline_get_compositor_def(run->pipeline);
    compositor.occlusion = method->occlusion;
    result = picture_oracle_create(run->source, oracle, &run->oracle);
    if (result != RLF_OK) {
        return result;
    }
    picture_oracle_change_def(&run->oracle, &compositor);
    result = rlf_compositor_create_soft(&compositor, &run->compositor);
    if (result == RLF_OK) {
        run->snapshot.bodies = run->bodies;
        result = picture_place_bodies((uint64_t)seed, run->source, run->bodies,
                                      &run->snapshot.body_count);
    }
    if (result == RLF_OK) {
        result = picture_truth_init(&run->truth, &rlf_source_get_info(run->source)->rig,
                                    run->bodies, run->snapshot.body_count);
    }
    size_t pixels = (size_t)synthetic.color_width * (size_t)synthetic.color_height;
    for (int i = 0; i < 2 && result == RLF_OK; i++) {
        run->alpha[i] = rlf_alloc_array(pixels, sizeof(float));
        result = run->alpha[i] != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    return result;
}

/* The next frame's picture; its matte becomes alpha[0]. */
static rlf_result draw_frame(picture_run *run)
{
    rlf_pipeline_output frame;
    rlf_result result = rlf_pipeline_step(run->pipeline, &frame);
    if (result != RLF_OK) {
        return result;
    }
    rlf_render_input input = {.frame = &frame.frame,
                              .surface = frame.surface,
                              .snapshot = &run->snapshot,
                              .T_world_camera = rlf_pose_identity()};
    rlf_render_output out;
    result = picture_oracle_change_input(&run->oracle, &run->truth, &input);
    if (result == RLF_OK) {
        result = rlf_compositor_render(run->compositor, &input, &out);
    }
    float *swap = run->alpha[0];
    run->alpha[0] = run->alpha[1];
    run->alpha[1] = swap;
    for (int32_t i = 0; result == RLF_OK && i < out.matte.width * out.matte.height; i++) {
        run->alpha[0][i] = (float)out.matte.data[i] * (1.0f / 255.0f);
    }
    return result;
}

/* Pictures after the warm-up, and which of them are judged. All are drawn: what is steady over time
 * must have time. */
typedef struct picture_schedule {
    int64_t frames, first, every;
} picture_schedule;

static rlf_result run_frames(picture_run *run, const picture_schedule *s, bool is_still,
                             picture_errors *e)
{
    rlf_result result = RLF_OK;
    bool has_truth = false;
    for (int64_t i = -WARM_UP; result == RLF_OK && i < s->frames && !command_interrupted; i++) {
        result = draw_frame(run);
        bool is_judged = i >= s->first && (i - s->first) % s->every == 0;
        if (result == RLF_OK && is_judged && !(is_still && has_truth)) {
            result = picture_truth_update(&run->truth, run->source);
        }
        if (result == RLF_OK && is_judged) {
            picture_oracle_change_alpha(&run->oracle, &run->truth, run->alpha[0]);
            picture_errors_add(e, &run->truth, run->alpha[0],
                               is_still && has_truth ? run->alpha[1] : NULL);
            has_truth = true;
        }
    }
    return result;
}

/* Which pictures are made of which methods. */
typedef struct picture_plan {
    picture_schedule schedules[2]; /* with a walking person, then with nobody */
    int32_t oracle;                /* bits of eval_oracle_part: what is true */
    bool with_all;                 /* methods that no profile has by itself, too */
} picture_plan;

static rlf_result measure_seed(const picture_plan *plan, const picture_method *method,
                               bool is_still, int64_t seed, picture_errors *out)
{
    const picture_schedule *schedule = &plan->schedules[is_still];
    picture_run run = {0};
    rlf_result result = open_run(&run, method, is_still ? "empty" : "room", plan->oracle, seed);
    result = result == RLF_OK ? run_frames(&run, schedule, is_still, out) : result;
    close_run(&run);
    return result;
}

/* ---- figures -------------------------------------------------------------------------------- */

typedef struct picture_figure {
    const char *key, *title, *hard_key, *hard_title;
    bool is_still;
    double (*value)(const picture_errors *e);
} picture_figure;

static double ratio(double part, double whole)
{
    return whole > 0.0 ? part / whole : NAN;
}
static double person_mean(const picture_errors *e)
{
    return picture_mean(&e->person);
}
static double person_p95(const picture_errors *e)
{
    return picture_percentile(&e->person, 95);
}
static double things_mean(const picture_errors *e)
{
    return picture_mean(&e->things);
}
static double things_p95(const picture_errors *e)
{
    return picture_percentile(&e->things, 95);
}
static double hidden_iou(const picture_errors *e)
{
    return ratio((double)e->both_hidden, (double)e->either_hidden);
}
static double hidden_percent(const picture_errors *e)
{
    return 100.0 * ratio((double)e->hidden, (double)e->pixels);
}
static double alpha_error(const picture_errors *e)
{
    return ratio(e->band_sum, (double)e->band_count);
}
static double flicker(const picture_errors *e)
{
    return ratio(e->flicker_sum, (double)e->flicker_count);
}
static double order_percent(const picture_errors *e)
{
    return 100.0 * ratio((double)e->order, (double)e->pixels);
}
static double order_far_percent(const picture_errors *e)
{
    return 100.0 * ratio((double)e->order_far, (double)e->pixels);
}

#define FIGURE(key, title, is_still, value)                                                        \
    {                                                                                              \
        key, title, "hard_" key, "hard occlusion: " title, is_still, value                         \
    }
static const picture_figure figures[] = {
    FIGURE("person_mean_px", "edges of a walking person: off by, px", false, person_mean),
    FIGURE("person_p95_px", "edges of a walking person: p95, px", false, person_p95),
    FIGURE("things_mean_px", "edges of things: off by, px", false, things_mean),
    FIGURE("things_p95_px", "edges of things: p95, px", false, things_p95),
    FIGURE("hidden_percent", "hidden pixels: share of the bodies', %", false, hidden_percent),
    FIGURE("hidden_iou", "hidden pixels: IoU", false, hidden_iou),
    FIGURE("alpha_error", "alpha within 9 px of an edge: error", false, alpha_error),
    FIGURE("order_percent", "wrong though 5 cm apart, %", false, order_percent),
    FIGURE("order_far_percent", "  more than 3 px from an edge, %", false, order_far_percent),
    FIGURE("still_mean_px", "still room, edges: off by, px", true, things_mean),
    FIGURE("still_p95_px", "still room, edges: p95, px", true, things_p95),
    FIGURE("still_hidden_iou", "still room, hidden pixels: IoU", true, hidden_iou),
    FIGURE("still_alpha_error", "still room, alpha: error", true, alpha_error),
    FIGURE("still_flicker", "still room, alpha: change per picture", true, flicker),
};
#define FIGURE_COUNT (sizeof(figures) / sizeof(figures[0]))

/* ---- rows ------------------------------------------------------------------------------------ */

#define JUDGED_FIRST 20 /* picture after the warm-up; the person walks before bodies now */
#define JUDGED_EVERY 12
#define JUDGED_COUNT 5
#define STILL_PICTURES 12

static const picture_plan a_few = {
    .schedules = {
        {JUDGED_FIRST + JUDGED_EVERY * (JUDGED_COUNT - 1) + 1, JUDGED_FIRST, JUDGED_EVERY},
        {STILL_PICTURES, 0, 1}}};

/* Rows of methods that no profile has by itself have their own keys and titles. */
static rlf_result add_rows(eval_table *table, const picture_plan *plan,
                           const picture_method *method, int64_t seed, picture_errors errors[2])
{
    memset(errors, 0, 2 * sizeof(*errors));
    for (int still = 0; still < 2; still++) {
        rlf_result result = measure_seed(plan, method, still != 0, seed, &errors[still]);
        if (result != RLF_OK) {
            return result;
        }
    }
    for (size_t i = 0; i < FIGURE_COUNT; i++) {
        eval_table_add(table, "picture", method->is_default ? figures[i].key : figures[i].hard_key,
                       method->is_default ? figures[i].title : figures[i].hard_title,
                       method->profile, figures[i].value(&errors[figures[i].is_still]));
    }
    return RLF_OK;
}

static rlf_result run_methods(eval_table *table, const picture_plan *plan, int64_t seed,
                              int profile_mask)
{
    picture_errors *errors = rlf_alloc_array(2, sizeof(*errors));
    rlf_result result = errors != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int m = 0; m < METHOD_COUNT && result == RLF_OK; m++) {
        bool is_wanted = plan->with_all || methods[m].is_default;
        if (is_wanted && (profile_mask & (1 << methods[m].profile))) {
            result = add_rows(table, plan, &methods[m], seed, errors);
        }
    }
    rlf_free(errors);
    if (result == RLF_OK && plan->oracle == 0 && (profile_mask & (1 << RLF_PROFILE_LIVE))) {
        result = picture_light_run(table, seed);
    }
    return result;
}

rlf_result eval_picture_run(eval_table *table, int64_t seed, int profile_mask)
{
    return run_methods(table, &a_few, seed, profile_mask);
}

rlf_result eval_picture_run_whole(eval_table *table, int64_t seed, int64_t frames, int32_t oracle,
                                  int profile_mask)
{
    if (oracle != 0) {
        profile_mask &= 1 << RLF_PROFILE_LIVE;
    }
    const picture_plan plan = {
        .schedules = {{frames, 0, 1}, {frames, 0, 1}}, .oracle = oracle, .with_all = true};
    return run_methods(table, &plan, seed, profile_mask);
}
