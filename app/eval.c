/* `relief eval`: accuracy of both profiles against the synthetic room's ground truth. */
#include "eval.h"
#include "command.h"
#include "eval_picture.h"
#include "eval_solid.h"
#include "session.h"

#include <getopt.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define THROWN_BODIES 60

typedef struct eval_options {
    const char *scene; /* synthetic scene's name */
    int64_t frames, seeds;
    const char *json_path;
    int profile_mask; /* bit 0 live, bit 1 thesis */
} eval_options;

/* Everything measured for one profile. */
typedef struct eval_run {
    rlf_profile profile;
    eval_depth depth;
    eval_normals normals;
    eval_foreground foreground;
    eval_solid solid;
    eval_collisions collisions;
    timing times;
    int32_t grid_width, grid_height;
} eval_run;

static void print_help(void)
{
    printf("usage: relief eval [OPTIONS]\n\n"
           "Runs the synthetic room through both profiles and measures normals, foreground and\n"
           "collisions against ground truth, and the time of each stage.\n\n"
           "  --scene NAME      room (default), empty, thesis, chair, book, hand,\n"
           "                    or picture: what hides bodies, at the colour camera\n"
           "  --frames N        frames per seed, default 200\n"
           "  --seeds N         seeds 1..N of the sensor noise, default 2\n"
           "  --profile NAME    live, thesis or both (default)\n"
           "  --json FILE       write the figures as JSON too\n\n"
           "examples:\n"
           "  relief eval\n"
           "  relief eval --scene thesis --seeds 5 --json eval.json\n");
}

static const struct option long_options[] = {
    {"scene", required_argument, NULL, 's'},
    {"frames", required_argument, NULL, 'f'},
    {"seeds", required_argument, NULL, 'n'},
    {"profile", required_argument, NULL, 'p'},
    {"json", required_argument, NULL, 'j'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

static int take_profile(eval_options *o)
{
    rlf_profile profile;
    if (strcmp(optarg, "both") == 0) {
        o->profile_mask = 3;
    } else if (session_parse_profile(optarg, &profile)) {
        o->profile_mask = 1 << profile;
    } else {
        return command_usage("eval", "--profile '%s': use live, thesis or both", optarg);
    }
    return -1;
}

static int parse(int argc, char **argv, eval_options *o)
{
    *o = (eval_options){.scene = "room", .frames = 200, .seeds = 2, .profile_mask = 3};
    int option;
    int status = -1;
    while (status < 0 && (option = getopt_long(argc, argv, "h", long_options, NULL)) != -1) {
        switch (option) {
        case 's': o->scene = optarg; break;
        case 'j': o->json_path = optarg; break;
        case 'p': status = take_profile(o); break;
        case 'f':
            if (!command_parse_int(optarg, 20, 100000, &o->frames)) {
                status = command_usage("eval", "--frames '%s': use 20 to 100000", optarg);
            }
            break;
        case 'n':
            if (!command_parse_int(optarg, 1, 1000, &o->seeds)) {
                status = command_usage("eval", "--seeds '%s': use 1 to 1000", optarg);
            }
            break;
        case 'h':
            print_help();
            status = EXIT_DONE;
            break;
        default: status = EXIT_USAGE; break;
        }
    }
    return status < 0 && argc != optind ? command_usage("eval", "takes no SOURCE") : status;
}

/* One frame's truth against its surface; `band` and `scratch` hold a byte per depth pixel. */
static void measure_frame(eval_run *run, rlf_source *source, const rlf_pipeline_output *frame,
                          uint8_t *band, uint8_t *scratch)
{
    const rlf_truth *truth = rlf_source_get_truth(source);
    const rlf_rig *rig = frame->frame.rig;
    eval_mark_band(truth->depth, rig->depth.width, rig->depth.height, band, scratch);
    eval_depth_add(&run->depth, frame->surface, &frame->frame, truth);
    eval_normals_add(&run->normals, frame->surface, truth, rig, band);
    eval_foreground_add(&run->foreground, frame->surface, truth, rig);
    eval_solid_add(&run->solid, frame->surface, truth, rig);
    eval_collisions_add(&run->collisions, frame->snapshot, source);
    const rlf_stage_times *t = &frame->times;
    timing_add_frame(&run->times, t, t->capture_ms + t->surface_ms + t->physics_ms + t->render_ms);
    run->grid_width = frame->surface->width;
    run->grid_height = frame->surface->height;
}

static rlf_result run_frames(eval_run *run, session *s, int64_t frame_count)
{
    const rlf_camera *depth = &rlf_source_get_info(s->source)->rig.depth;
    size_t pixels = (size_t)depth->width * (size_t)depth->height;
    uint8_t *band = rlf_alloc(pixels);
    uint8_t *scratch = rlf_alloc(pixels);
    rlf_result result = eval_depth_init(&run->depth, depth);
    result = band != NULL && scratch != NULL ? result : RLF_ERROR_MEMORY;
    for (int64_t i = 0; result == RLF_OK && i < frame_count && !command_interrupted; i++) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(s->pipeline, &frame);
        if (result == RLF_OK) {
            measure_frame(run, s->source, &frame, band, scratch);
        }
    }
    rlf_free(band);
    rlf_free(scratch);
    eval_depth_finish(&run->depth);
    return result == RLF_END ? RLF_OK : result;
}

static rlf_result run_seed(eval_run *run, const eval_options *o, int64_t seed)
{
    char source[128];
    snprintf(source, sizeof(source), "synthetic:%s?seed=%lld&frames=%lld", o->scene,
             (long long)seed, (long long)o->frames);
    rlf_scene scene;
    rlf_result result = eval_collisions_scene((uint64_t)seed, THROWN_BODIES, &scene);
    if (result != RLF_OK) {
        return result;
    }
    session_options options = session_options_default();
    options.source = source;
    options.profile = run->profile;
    options.scene = &scene;
    session s;
    result = session_open(&options, &s);
    rlf_scene_destroy(&scene);
    if (result != RLF_OK) {
        return result;
    }
    eval_collisions_restart(&run->collisions);
    result = eval_solid_restart(&run->solid, &rlf_source_get_info(s.source)->rig);
    result = result == RLF_OK ? run_frames(run, &s, o->frames) : result;
    session_close(&s);
    return result;
}

typedef double (*figure_fn)(const eval_run *run);

typedef struct figure {
    const char *key;
    const char *title;
    figure_fn value;
} figure;

#define ANGLE_FIGURES(band, name)                                                                  \
    static double band##_median(const eval_run *r)                                                 \
    {                                                                                              \
        return eval_median_deg(&r->normals.band);                                                  \
    }                                                                                              \
    static double band##_mean(const eval_run *r)                                                   \
    {                                                                                              \
        return eval_mean_deg(&r->normals.band);                                                    \
    }                                                                                              \
    static double band##_wrong(const eval_run *r)                                                  \
    {                                                                                              \
        return eval_wrong_percent(&r->normals.band);                                               \
    }                                                                                              \
    static double band##_missing(const eval_run *r)                                                \
    {                                                                                              \
        return eval_missing_percent(&r->normals.band);                                             \
    }
ANGLE_FIGURES(interior, "interior")
ANGLE_FIGURES(band, "edge band")
ANGLE_FIGURES(seen, "edge band, seen pixels")
#undef ANGLE_FIGURES

#define DEPTH_FIGURES(group)                                                                       \
    static double group##_rms(const eval_run *r)                                                   \
    {                                                                                              \
        return eval_depth_rms_mm(&r->depth.group.seen);                                            \
    }                                                                                              \
    static double group##_raw_rms(const eval_run *r)                                               \
    {                                                                                              \
        return eval_depth_rms_mm(&r->depth.group.raw);                                             \
    }                                                                                              \
    static double group##_flying(const eval_run *r)                                                \
    {                                                                                              \
        return eval_depth_flying_percent(&r->depth.group.seen);                                    \
    }                                                                                              \
    static double group##_raw_flying(const eval_run *r)                                            \
    {                                                                                              \
        return eval_depth_flying_percent(&r->depth.group.raw);                                     \
    }                                                                                              \
    static double group##_missing_depth(const eval_run *r)                                         \
    {                                                                                              \
        return eval_depth_missing_percent(&r->depth.group);                                        \
    }                                                                                              \
    static double group##_raw_missing(const eval_run *r)                                           \
    {                                                                                              \
        return eval_depth_raw_missing_percent(&r->depth.group);                                    \
    }                                                                                              \
    static double group##_filled(const eval_run *r)                                                \
    {                                                                                              \
        return eval_depth_filled_percent(&r->depth.group);                                         \
    }                                                                                              \
    static double group##_filled_rms(const eval_run *r)                                            \
    {                                                                                              \
        return eval_depth_rms_mm(&r->depth.group.filled);                                          \
    }                                                                                              \
    static double group##_filled_wrong(const eval_run *r)                                          \
    {                                                                                              \
        return eval_depth_other_side_percent(&r->depth.group.filled);                              \
    }
DEPTH_FIGURES(still)
DEPTH_FIGURES(moving)
#undef DEPTH_FIGURES

static double fg_precision(const eval_run *r)
{
    return eval_precision(&r->foreground.all);
}
static double fg_recall(const eval_run *r)
{
    return eval_recall(&r->foreground.all);
}
static double fg_f(const eval_run *r)
{
    return eval_f_measure(&r->foreground.all);
}
static double fg_f_valid(const eval_run *r)
{
    return eval_f_measure(&r->foreground.valid);
}
static double body_exit_cm(const eval_run *r)
{
    return eval_exit_mean_cm(&r->solid.body);
}
static double body_exit_close(const eval_run *r)
{
    return eval_exit_close_percent(&r->solid.body);
}
static double book_exit_cm(const eval_run *r)
{
    return eval_exit_mean_cm(&r->solid.book);
}
static double speed_median(const eval_run *r)
{
    return eval_speed_median_percent(&r->solid.normal);
}
static double speed_mean(const eval_run *r)
{
    return eval_speed_mean_percent(&r->solid.normal);
}
static double velocity_median(const eval_run *r)
{
    return eval_speed_median_percent(&r->solid.full);
}
static double still_zero(const eval_run *r)
{
    const eval_solid *s = &r->solid;
    return s->still > 0 ? 100.0 * (double)s->still_zero / (double)s->still : 0.0;
}
static double phantoms_soon(const eval_run *r)
{
    return eval_phantom_percent(r->solid.phantoms.left_soon, r->solid.phantoms.seen_soon);
}
static double phantoms_late(const eval_run *r)
{
    return eval_phantom_percent(r->solid.phantoms.left_late, r->solid.phantoms.seen_late);
}
static double bounces(const eval_run *r)
{
    return (double)r->collisions.bounces;
}
static double bounce_mean(const eval_run *r)
{
    return eval_mean_deg(&r->collisions.angles);
}
static double phantom(const eval_run *r)
{
    return r->collisions.bounces
               ? 100.0 * (double)r->collisions.phantom / (double)r->collisions.bounces
               : 0.0;
}
static double bounce_wrong(const eval_run *r)
{
    return eval_wrong_percent(&r->collisions.angles);
}

static double bounce_unexplained(const eval_run *r)
{
    const eval_collisions *c = &r->collisions;
    return c->angles.count > 0 ? 100.0 * (double)c->unexplained / (double)c->angles.count : 0.0;
}
static double entries(const eval_run *r)
{
    return (double)r->collisions.entries;
}
static double capture_ms(const eval_run *r)
{
    return timing_percentile(&r->times.capture, 50);
}
static double surface_ms(const eval_run *r)
{
    return timing_percentile(&r->times.surface, 50);
}
static double physics_ms(const eval_run *r)
{
    return timing_percentile(&r->times.physics, 50);
}
static double render_ms(const eval_run *r)
{
    return timing_percentile(&r->times.render, 50);
}
static double loop_ms(const eval_run *r)
{
    return timing_percentile(&r->times.frame, 50);
}

static const figure figures[] = {
    {"depth_still_rmse_mm", "depth where nothing changed for 1 s: RMSE, mm", still_rms},
    {"depth_still_raw_rmse_mm", "  of the raw frame, mm", still_raw_rms},
    {"depth_still_flying_percent", "  flying pixels, %", still_flying},
    {"depth_still_raw_flying_percent", "  of the raw frame, %", still_raw_flying},
    {"depth_still_missing_percent", "  missing, %", still_missing_depth},
    {"depth_still_raw_missing_percent", "  of the raw frame, %", still_raw_missing},
    {"depth_still_filled_percent", "  filled, %", still_filled},
    {"depth_still_filled_rmse_mm", "  filled: RMSE, mm", still_filled_rms},
    {"depth_still_filled_wrong_percent", "  filled: wrong side of an edge, %", still_filled_wrong},
    {"depth_moving_rmse_mm", "depth of what is new in a frame: RMSE, mm", moving_rms},
    {"depth_moving_raw_rmse_mm", "  of the raw frame, mm", moving_raw_rms},
    {"depth_moving_flying_percent", "  flying pixels, %", moving_flying},
    {"depth_moving_raw_flying_percent", "  of the raw frame, %", moving_raw_flying},
    {"depth_moving_missing_percent", "  missing, %", moving_missing_depth},
    {"depth_moving_raw_missing_percent", "  of the raw frame, %", moving_raw_missing},
    {"depth_moving_filled_percent", "  filled, %", moving_filled},
    {"depth_moving_filled_rmse_mm", "  filled: RMSE, mm", moving_filled_rms},
    {"depth_moving_filled_wrong_percent", "  filled: wrong side of an edge, %",
     moving_filled_wrong},
    {"normals_interior_median_deg", "normals, interior: median error, deg", interior_median},
    {"normals_interior_mean_deg", "  mean error, deg", interior_mean},
    {"normals_interior_over_30_percent", "  more than 30 deg off, %", interior_wrong},
    {"normals_interior_missing_percent", "  missing, %", interior_missing},
    {"normals_band_median_deg", "normals, 6-pixel edge band: median, deg", band_median},
    {"normals_band_mean_deg", "  mean error, deg", band_mean},
    {"normals_band_over_30_percent", "  more than 30 deg off, %", band_wrong},
    {"normals_band_missing_percent", "  missing, %", band_missing},
    {"normals_band_seen_median_deg", "  without filled pixels: median, deg", seen_median},
    {"normals_band_seen_mean_deg", "  mean error, deg", seen_mean},
    {"normals_band_seen_over_30_percent", "  more than 30 deg off, %", seen_wrong},
    {"normals_band_seen_missing_percent", "  missing, %", seen_missing},
    {"foreground_precision", "foreground, all pixels: precision", fg_precision},
    {"foreground_recall", "  recall", fg_recall},
    {"foreground_f", "  F", fg_f},
    {"foreground_f_valid", "  F where the sensor gave a depth", fg_f_valid},
    {"exit_mean_cm", "thickness of people: mean exit error, cm", body_exit_cm},
    {"exit_within_5_cm_percent", "  within 5 cm, %", body_exit_close},
    {"book_exit_mean_cm", "  of a held book: mean, cm", book_exit_cm},
    {"speed_median_percent", "speed along the normal (> 0.2 m/s): median, %", speed_median},
    {"speed_mean_percent", "  mean error, %", speed_mean},
    {"velocity_median_percent", "  whole vector: median error, %", velocity_median},
    {"still_zero_percent", "  still pixels exactly still, %", still_zero},
    {"background_phantoms_soon_percent", "phantoms 3 frames after (-1: none), %", phantoms_soon},
    {"background_phantoms_late_percent", "  30 frames after, %", phantoms_late},
    {"bounces", "bounces on the real scene", bounces},
    {"bounces_phantom_percent", "  where nothing real is, %", phantom},
    {"bounces_mean_deg", "  mean error of the contact normal, deg", bounce_mean},
    {"bounces_over_30_percent", "  more than 30 deg off, %", bounce_wrong},
    {"bounces_unexplained_percent", "    and not at an edge, %", bounce_unexplained},
    {"entries", "times a body in view got inside something", entries},
    {"capture_ms", "median ms: capture (with truth)", capture_ms},
    {"surface_ms", "  surface", surface_ms},
    {"physics_ms", "  physics (60 bodies)", physics_ms},
    {"render_ms", "  render (60 bodies)", render_ms},
    {"loop_ms", "  whole loop", loop_ms},
};
#define FIGURE_COUNT (sizeof(figures) / sizeof(figures[0]))

static void print_table(const eval_run *runs, int run_count, const eval_options *o)
{
    printf("synthetic:%s, %lld seeds x %lld frames, %d thrown cubes\n", o->scene,
           (long long)o->seeds, (long long)o->frames, THROWN_BODIES);
    printf("%-46s", "");
    for (int r = 0; r < run_count; r++) {
        char head[32];
        snprintf(head, sizeof(head), "%s %dx%d",
                 runs[r].profile == RLF_PROFILE_LIVE ? "live" : "thesis", (int)runs[r].grid_width,
                 (int)runs[r].grid_height);
        printf(" %15s", head);
    }
    printf("\n");
    for (size_t i = 0; i < FIGURE_COUNT; i++) {
        printf("%-46s", figures[i].title);
        for (int r = 0; r < run_count; r++) {
            printf(" %15.4g", figures[i].value(&runs[r]));
        }
        printf("\n");
    }
}

static rlf_result write_json(const eval_run *runs, int run_count, const eval_options *o)
{
    json_t *root = json_pack("{s:s, s:I, s:I}", "scene", o->scene, "seeds", (json_int_t)o->seeds,
                             "frames", (json_int_t)o->frames);
    for (int r = 0; r < run_count; r++) {
        json_t *values = json_object();
        for (size_t i = 0; i < FIGURE_COUNT; i++) {
            json_object_set_new(values, figures[i].key, json_real(figures[i].value(&runs[r])));
        }
        json_object_set_new(root, runs[r].profile == RLF_PROFILE_LIVE ? "live" : "thesis", values);
    }
    int failed = json_dump_file(root, o->json_path, JSON_INDENT(2));
    json_decref(root);
    return failed ? rlf_fail(RLF_ERROR_IO, "%s: cannot be written; choose another --json file",
                             o->json_path)
                  : RLF_OK;
}

static rlf_result measure_profile(eval_run *run, const eval_options *o)
{
    rlf_result result = eval_collisions_init(&run->collisions, THROWN_BODIES);
    for (int64_t seed = 1; result == RLF_OK && seed <= o->seeds && !command_interrupted; seed++) {
        fprintf(stderr, "%s: seed %lld of %lld\n",
                run->profile == RLF_PROFILE_LIVE ? "live" : "thesis", (long long)seed,
                (long long)o->seeds);
        result = run_seed(run, o, seed);
    }
    eval_collisions_finish(&run->collisions);
    eval_solid_finish(&run->solid);
    return result;
}

int eval_main(int argc, char **argv)
{
    eval_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    if (strcmp(options.scene, "picture") == 0) {
        return eval_picture_main(options.frames, options.seeds, options.json_path);
    }
    eval_run *runs = rlf_alloc_array(2, sizeof(*runs)); /* large: histograms and samples */
    if (runs == NULL) {
        return command_failed();
    }
    int run_count = 0;
    rlf_result result = RLF_OK;
    for (int profile = 0; profile < 2 && result == RLF_OK; profile++) {
        if (options.profile_mask & (1 << profile)) {
            runs[run_count].profile = (rlf_profile)profile;
            result = measure_profile(&runs[run_count++], &options);
        }
    }
    if (result == RLF_OK) {
        print_table(runs, run_count, &options);
    }
    if (result == RLF_OK && options.json_path != NULL) {
        result = write_json(runs, run_count, &options);
    }
    rlf_free(runs);
    return result == RLF_OK ? EXIT_DONE : command_failed();
}
