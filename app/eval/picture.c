/* `relief eval --scene picture`: is a body hidden where it ought to be? Every way of occlusion sees
 * the same frames of the synthetic room, with a walking person and with nobody. */
#include "eval/picture.h"
#include "command.h"
#include "json_file.h"

#include "relief/synthetic.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define WARM_UP 30 /* frames: the background is learnt */

typedef struct picture_method {
    const char *key, *title;
    rlf_profile profile;
    rlf_occlusion occlusion;
} picture_method;

static const picture_method methods[] = {
    {"live_soft", "live, soft", RLF_PROFILE_LIVE, RLF_OCCLUSION_SOFT},
    {"live_hard", "live, hard", RLF_PROFILE_LIVE, RLF_OCCLUSION_DEPTH},
    {"thesis_layers", "thesis, layers", RLF_PROFILE_THESIS, RLF_OCCLUSION_THESIS},
};
#define METHOD_COUNT ((int)(sizeof(methods) / sizeof(methods[0])))

/* One method at work on one seed of one scene. */
typedef struct picture_run {
    rlf_source *source;
    rlf_pipeline *pipeline;
    rlf_compositor *compositor;
    picture_truth truth;
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
    rlf_source_destroy(&run->source);
}

static rlf_result open_run(picture_run *run, const picture_method *method, const char *scene,
                           int64_t seed)
{
    char name[96];
    (void)snprintf(name, sizeof(name), "synthetic:%s?seed=%lld&frames=-1", scene, (long long)seed);
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    rlf_result result = rlf_synthetic_parse(name, &synthetic);
    synthetic.enable_truth = false;
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
static rlf_result draw_frame(picture_run *run, picture_errors *e)
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
    int64_t start = rlf_clock_ns();
    result = rlf_compositor_render(run->compositor, &input, &out);
    double ms = (double)(rlf_clock_ns() - start) * 1e-6;
    e->ms = e->ms > 0.0 && e->ms < ms ? e->ms : ms;
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
        result = draw_frame(run, e);
        bool is_judged = i >= s->first && (i - s->first) % s->every == 0;
        if (result == RLF_OK && is_judged && !(is_still && has_truth)) {
            result = picture_truth_update(&run->truth, run->source);
        }
        if (result == RLF_OK && is_judged) {
            picture_errors_add(e, &run->truth, run->alpha[0],
                               is_still && has_truth ? run->alpha[1] : NULL);
            has_truth = true;
        }
    }
    return result;
}

static rlf_result measure_seed(const picture_method *method, bool is_still,
                               const picture_schedule *schedule, int64_t seed, picture_errors *out)
{
    picture_run run = {0};
    rlf_result result = open_run(&run, method, is_still ? "empty" : "room", seed);
    result = result == RLF_OK ? run_frames(&run, schedule, is_still, out) : result;
    close_run(&run);
    return result;
}

static rlf_result measure(const picture_method *method, bool is_still, int64_t frame_count,
                          int64_t seed_count, picture_errors *out)
{
    rlf_result result = RLF_OK;
    const picture_schedule every_frame = {frame_count, 0, 1};
    for (int64_t seed = 1; seed <= seed_count && result == RLF_OK && !command_interrupted; seed++) {
        result = measure_seed(method, is_still, &every_frame, seed, out);
    }
    return result;
}

/* ---- figures -------------------------------------------------------------------------------- */

typedef struct picture_figure {
    const char *key, *title;
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
static double least_ms(const picture_errors *e)
{
    return e->ms;
}

static const picture_figure figures[] = {
    {"person_mean_px", "edges of a walking person: off by, px", false, person_mean},
    {"person_p95_px", "edges of a walking person: p95, px", false, person_p95},
    {"things_mean_px", "edges of things: off by, px", false, things_mean},
    {"things_p95_px", "edges of things: p95, px", false, things_p95},
    {"hidden_percent", "hidden pixels: share of the bodies', %", false, hidden_percent},
    {"hidden_iou", "hidden pixels: IoU", false, hidden_iou},
    {"alpha_error", "alpha within 9 px of an edge: error", false, alpha_error},
    {"order_percent", "wrong though 5 cm apart, %", false, order_percent},
    {"order_far_percent", "  more than 3 px from an edge, %", false, order_far_percent},
    {"still_mean_px", "still room, edges: off by, px", true, things_mean},
    {"still_p95_px", "still room, edges: p95, px", true, things_p95},
    {"still_hidden_iou", "still room, hidden pixels: IoU", true, hidden_iou},
    {"still_alpha_error", "still room, alpha: error", true, alpha_error},
    {"still_flicker", "still room, alpha: change per picture", true, flicker},
    {"picture_ms", "picture of 20 bodies, one thread, least ms", false, least_ms},
};
#define FIGURE_COUNT (sizeof(figures) / sizeof(figures[0]))

static void print_table(const picture_errors errors[METHOD_COUNT][2])
{
    printf("%-46s", "");
    for (int m = 0; m < METHOD_COUNT; m++) {
        printf(" %15s", methods[m].title);
    }
    printf("\n");
    for (size_t i = 0; i < FIGURE_COUNT; i++) {
        printf("%-46s", figures[i].title);
        for (int m = 0; m < METHOD_COUNT; m++) {
            double value = figures[i].value(&errors[m][figures[i].is_still]);
            char text[24];
            snprintf(text, sizeof(text), "%.4g", value);
            printf(" %15s", isnan(value) ? "-" : text);
        }
        printf("\n");
    }
}

static rlf_result write_json(const picture_errors errors[METHOD_COUNT][2], const char *path)
{
    json_t *root = json_object();
    for (int m = 0; m < METHOD_COUNT; m++) {
        json_t *values = json_object();
        for (size_t i = 0; i < FIGURE_COUNT; i++) {
            double value = figures[i].value(&errors[m][figures[i].is_still]);
            json_object_set_new(values, figures[i].key, json_file_number(value));
        }
        json_object_set_new(root, methods[m].key, values);
    }
    return json_file_write(path, root);
}

int eval_picture_main(int64_t frame_count, int64_t seed_count, const char *json_path)
{
    picture_errors(*errors)[2] = rlf_alloc_array((size_t)METHOD_COUNT, sizeof(*errors));
    if (errors == NULL) {
        return command_failed();
    }
    rlf_result result = RLF_OK;
    for (int m = 0; m < METHOD_COUNT && result == RLF_OK; m++) {
        for (int still = 0; still < 2 && result == RLF_OK; still++) {
            fprintf(stderr, "%s: %s\n", methods[m].title, still ? "still room" : "walking person");
            result = measure(&methods[m], still != 0, frame_count, seed_count, &errors[m][still]);
        }
    }
    if (result == RLF_OK && !command_interrupted) {
        printf("bodies in the synthetic room at the colour camera, %lld seeds x %lld frames\n",
               (long long)seed_count, (long long)frame_count);
        print_table((const picture_errors(*)[2])errors);
        result =
            json_path != NULL ? write_json((const picture_errors(*)[2])errors, json_path) : RLF_OK;
    }
    rlf_free(errors);
    if (command_interrupted) {
        return command_stopped("eval");
    }
    return result == RLF_OK ? EXIT_DONE : command_failed();
}

/* ---- rows of `relief eval` ------------------------------------------------------------------- */

#define JUDGED_FIRST 20 /* picture after the warm-up; the person walks before bodies now */
#define JUDGED_EVERY 12
#define JUDGED_COUNT 5
#define STILL_PICTURES 12

static rlf_result add_rows(eval_table *table, const picture_method *method, int64_t seed,
                           picture_errors errors[2])
{
    const picture_schedule schedules[2] = {
        {JUDGED_FIRST + JUDGED_EVERY * (JUDGED_COUNT - 1) + 1, JUDGED_FIRST, JUDGED_EVERY},
        {STILL_PICTURES, 0, 1}};
    memset(errors, 0, 2 * sizeof(*errors));
    for (int still = 0; still < 2; still++) {
        rlf_result result =
            measure_seed(method, still != 0, &schedules[still], seed, &errors[still]);
        if (result != RLF_OK) {
            return result;
        }
    }
    for (size_t i = 0; i < FIGURE_COUNT; i++) {
        if (figures[i].value != least_ms) { /* `relief bench` times */
            eval_table_add(table, "picture", figures[i].key, figures[i].title, method->profile,
                           figures[i].value(&errors[figures[i].is_still]));
        }
    }
    return RLF_OK;
}

rlf_result eval_picture_run(eval_table *table, int64_t seed, int profile_mask)
{
    picture_errors *errors = rlf_alloc_array(2, sizeof(*errors));
    rlf_result result = errors != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int m = 0; m < METHOD_COUNT && result == RLF_OK; m++) {
        bool is_default = methods[m].occlusion != RLF_OCCLUSION_DEPTH;
        if (is_default && (profile_mask & (1 << methods[m].profile))) {
            result = add_rows(table, &methods[m], seed, errors);
        }
    }
    rlf_free(errors);
    return result;
}
