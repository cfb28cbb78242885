/* Every stage of both profiles, the surface stage's steps, and memory. */
#include "bench/bench.h"
#include "command.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MIB (1.0 / (1024.0 * 1024.0))

typedef struct bench_case {
    const char *name;
    rlf_profile profile;
    int32_t scale_factor;
} bench_case;

static const bench_case cases[] = {
    {"live_1", RLF_PROFILE_LIVE, 1},
    {"live_8", RLF_PROFILE_LIVE, 8},
    {"thesis_1", RLF_PROFILE_THESIS, 1},
    {"thesis_8", RLF_PROFILE_THESIS, 8},
};
#define CASE_COUNT ((int)(sizeof(cases) / sizeof(cases[0])))

/* Stages in the order in which they run; the last is their sum. */
enum { CAPTURE, SURFACE, PHYSICS, RENDER, LOOP, STAGE_COUNT };
static const char *const stage_names[STAGE_COUNT] = {"capture", "surface", "physics", "render",
                                                     "loop"};

typedef struct case_times {
    timing_series stages[STAGE_COUNT];
    timing_series steps[RLF_SURFACE_STEP_COUNT];
    bench_floor floor;
    int32_t width, height;
} case_times;

static void add_frame(case_times *t, const rlf_pipeline_output *frame,
                      const rlf_surface_times *steps)
{
    const rlf_stage_times *ms = &frame->times;
    const double stages[STAGE_COUNT] = {
        ms->capture_ms, ms->surface_ms, ms->physics_ms, ms->render_ms,
        ms->capture_ms + ms->surface_ms + ms->physics_ms + ms->render_ms};
    for (int i = 0; i < STAGE_COUNT; i++) {
        timing_add(&t->stages[i], stages[i]);
    }
    for (int i = 0; i < RLF_SURFACE_STEP_COUNT; i++) {
        timing_add(&t->steps[i], steps->step_ms[i]);
    }
    t->width = frame->surface->width;
    t->height = frame->surface->height;
}

/* The floor runs after each frame, so that both meet the same machine. */
static rlf_result run_frames(session *s, int64_t frames, case_times *t)
{
    rlf_surface_times steps;
    memset(&steps, 0, sizeof(steps));
    rlf_pipeline_set_surface_times(s->pipeline, &steps);
    rlf_result result = RLF_OK;
    for (int64_t i = 0; result == RLF_OK && i < frames && !command_interrupted;) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(s->pipeline, &frame);
        if (result == RLF_OK) {
            add_frame(t, &frame, &steps);
            if (i++ == 0) {
                result = bench_floor_open(t->width, t->height, &t->floor);
            }
            if (result == RLF_OK) {
                bench_floor_run(&t->floor);
            }
        } else if (result == RLF_NO_FRAME) {
            result = RLF_OK;
        }
    }
    bench_floor_close(&t->floor);
    if (result == RLF_END && t->width == 0) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: has no frames",
                        rlf_source_get_info(s->source)->name);
    }
    return result == RLF_END ? RLF_OK : result;
}

static session_options options_of(const bench_case *c, const bench_options *o)
{
    session_options options = session_options_default();
    options.source = o->source;
    options.use_default_scene = true;
    options.profile = c->profile;
    options.scale_factor = c->scale_factor;
    options.thread_count = o->threads;
    return options;
}

static void report_times(const bench_case *c, const case_times *t, bench_table *table)
{
    char name[BENCH_NAME];
    double floor_ms = timing_percentile(&t->floor.times, 50);
    double surface_ms = timing_percentile(&t->stages[SURFACE], 50);
    for (int i = 0; i < STAGE_COUNT; i++) {
        double ratio = i == SURFACE && floor_ms > 0.0 ? surface_ms / floor_ms : NAN;
        bench_add_series(table, c->name, stage_names[i], &t->stages[i], ratio);
    }
    bench_add_series(table, c->name, "floor", &t->floor.times, NAN);
    double least_floor = timing_percentile(&t->floor.times, 0);
    double least_surface = timing_percentile(&t->stages[SURFACE], 0);
    bench_add(table, c->name, "surface least", "ms", least_surface, NAN,
              least_floor > 0.0 ? least_surface / least_floor : NAN);
    for (int i = 0; i < RLF_SURFACE_STEP_COUNT; i++) {
        snprintf(name, sizeof(name), "surface/%s", rlf_surface_step_name((rlf_surface_step)i));
        double share = timing_percentile(&t->steps[i], 50) / surface_ms;
        bench_add_series(table, c->name, name, &t->steps[i], surface_ms > 0.0 ? share : NAN);
    }
    double pixels = (double)t->width * t->height;
    bench_add(table, c->name, "width", "pixels", t->width, t->width, NAN);
    bench_add(table, c->name, "height", "pixels", t->height, t->height, NAN);
    bench_add(table, c->name, "floor read", "bytes", BENCH_FLOOR_READ * pixels,
              BENCH_FLOOR_READ * pixels, NAN);
    bench_add(table, c->name, "floor written", "bytes", BENCH_FLOOR_WRITTEN * pixels,
              BENCH_FLOOR_WRITTEN * pixels, NAN);
}

static void add_memory(bench_table *table, const char *group, const char *name, int64_t bytes)
{
    double mib = (double)bytes * MIB;
    bench_add(table, group, name, "MiB", mib, mib, NAN);
}

/* Each stage made by itself, of the very def that the pipeline has. */
static rlf_result measure_memory(const bench_case *c, const bench_options *o, bench_table *table)
{
    session_options options = options_of(c, o);
    session s;
    rlf_reconstruct *reconstruct = NULL;
    rlf_world *world = NULL;
    rlf_compositor *compositor = NULL;
    int64_t before = bench_memory_now();
    rlf_source *source = NULL;
    rlf_result result = rlf_open_source(o->source, NULL, &source);
    add_memory(table, c->name, "memory/capture", bench_memory_now() - before);
    if (result == RLF_OK && o->json_path != NULL) {
        result = rlf_file_check(o->json_path); /* what is read is not written */
    }
    rlf_source_destroy(&source);
    result = result == RLF_OK ? session_open(&options, &s) : result;
    if (result != RLF_OK) {
        return result;
    }
    add_memory(table, c->name, "memory/whole", bench_memory_now() - before);
    rlf_pipeline_def def = rlf_pipeline_def_default(c->profile, s.source, s.pool);
    session_set_scale(&def.reconstruct, c->scale_factor);
    before = bench_memory_now();
    result = rlf_reconstruct_create(&def.reconstruct, &reconstruct);
    add_memory(table, c->name, "memory/surface", bench_memory_now() - before);
    before = bench_memory_now();
    result = result == RLF_OK ? rlf_world_create(&def.world, &world) : result;
    add_memory(table, c->name, "memory/physics", bench_memory_now() - before);
    rlf_compositor_def render = rlf_pipeline_get_compositor_def(s.pipeline);
    before = bench_memory_now();
    result = result == RLF_OK ? rlf_compositor_create_soft(&render, &compositor) : result;
    add_memory(table, c->name, "memory/render", bench_memory_now() - before);
    rlf_compositor_destroy(&compositor);
    rlf_world_destroy(&world);
    rlf_reconstruct_destroy(&reconstruct);
    session_close(&s);
    return result;
}

static rlf_result run_case(const bench_case *c, const bench_options *o, bench_table *table)
{
    case_times *t = rlf_alloc(sizeof(*t)); /* large: samples */
    if (t == NULL) {
        return RLF_ERROR_MEMORY;
    }
    session_options options = options_of(c, o);
    session s;
    rlf_result result = session_open(&options, &s);
    if (result == RLF_OK) {
        result = run_frames(&s, o->frames, t);
        session_close(&s);
    }
    if (result == RLF_OK) {
        report_times(c, t, table);
        result = measure_memory(c, o, table);
    }
    rlf_free(t);
    return result;
}

rlf_result bench_cases_run(const bench_options *o, bench_table *table)
{
    rlf_result result = RLF_OK;
    for (int i = 0; i < CASE_COUNT && result == RLF_OK; i++) {
        fprintf(stderr, "%s (%d of %d)\n", cases[i].name, i + 1, CASE_COUNT);
        result = run_case(&cases[i], o, table);
    }
    return result;
}

static double median(const bench_table *table, int c, const char *name)
{
    const bench_row *row = bench_find(table, cases[c].name, name);
    return row != NULL ? row->median : NAN;
}

/* One line per name: median and 95th percentile of each case. */
static void print_line(const bench_table *table, const char *name, const char *title)
{
    printf("%-22s", title);
    for (int c = 0; c < CASE_COUNT; c++) {
        const bench_row *row = bench_find(table, cases[c].name, name);
        printf(" %9.3f %9.3f", row->median, row->p95);
    }
    printf("\n");
}

static void print_one(const bench_table *table, const char *name, const char *title,
                      const char *format)
{
    printf("%-22s", title);
    for (int c = 0; c < CASE_COUNT; c++) {
        printf(format, median(table, c, name));
    }
    printf("\n");
}

static void print_head(const bench_table *table)
{
    printf("%-22s", "ms: median, p95");
    for (int c = 0; c < CASE_COUNT; c++) {
        char head[64];
        snprintf(head, sizeof(head), "%s %.0fx%.0f", cases[c].name, median(table, c, "width"),
                 median(table, c, "height"));
        printf(" %19s", head);
    }
    printf("\n");
}

void bench_cases_print(const bench_options *o, const bench_table *table)
{
    printf("%s, two cubes, headless, %lld frames, threads %d\n", o->source, (long long)o->frames,
           (int)o->threads);
    print_head(table);
    for (int i = 0; i < STAGE_COUNT; i++) {
        print_line(table, stage_names[i], stage_names[i]);
    }
    for (int i = 0; i < RLF_SURFACE_STEP_COUNT; i++) {
        char name[BENCH_NAME], title[BENCH_NAME];
        const char *step = rlf_surface_step_name((rlf_surface_step)i);
        snprintf(name, sizeof(name), "surface/%s", step);
        snprintf(title, sizeof(title), "  surface: %s", step);
        print_line(table, name, title);
    }
    print_line(table, "floor", "floor");
    print_one(table, "floor read", "  bytes read", " %19.0f");
    print_one(table, "floor written", "  bytes written", " %19.0f");
    printf("%-22s", "surface / floor");
    for (int c = 0; c < CASE_COUNT; c++) {
        printf(" %19.1f", bench_find(table, cases[c].name, "surface")->ratio);
    }
    printf("\n%-22s", "  of the least times");
    for (int c = 0; c < CASE_COUNT; c++) {
        printf(" %19.1f", bench_find(table, cases[c].name, "surface least")->ratio);
    }
    printf("\n%-22s", "frames per second");
    for (int c = 0; c < CASE_COUNT; c++) {
        printf(" %19.1f", 1000.0 / median(table, c, "loop"));
    }
    printf("\n");
    static const char *const memory[5] = {"capture", "surface", "physics", "render", "whole"};
    for (int i = 0; i < 5; i++) {
        char name[BENCH_NAME], title[BENCH_NAME];
        snprintf(name, sizeof(name), "memory/%s", memory[i]);
        snprintf(title, sizeof(title), "MiB: %s", memory[i]);
        print_one(table, name, title, " %19.2f");
    }
    printf("the thesis reports 10 frames per second at 64x53 (3.4 GHz Xeon, Quadro K2000)\n");
}
