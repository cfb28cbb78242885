/* How the cost grows: with pixels, with regions, with people, with bodies. */
#include "bench/bench.h"
#include "command.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define WARM_UP 10 /* frames, of them BENCH_EMPTY_FRAMES empty */
#define FRAMES 16
#define LOOP_BODIES 100
#define LOOP_FROM 60 /* frames: a person walks about the room from then on */
#define LOOP_TO 124

static const int32_t sizes[][2] = {{160, 120}, {320, 240},  {512, 424},  {640, 480},
                                   {960, 540}, {1280, 720}, {1920, 1080}};
static const int32_t region_counts[] = {1, 4, 16, 64, 225};
static const int32_t people_counts[] = {0, 1, 2, 4, 8};
static const int32_t row_counts[] = {2, 4, 8};
static const int32_t body_counts[] = {2, 100, 1000};
#define MOST_ROOMS 5 /* of a sweep */
#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

/* The surface stage of profile live on an analytic room. */
typedef struct lane {
    rlf_source *source;
    rlf_reconstruct *stage;
    int32_t regions;
    timing_series ms, ratio; /* the latter beside the first lane's same frame */
} lane;

static rlf_result open_lane(const bench_room *room, rlf_pool *pool, lane *out)
{
    rlf_result result = bench_source_create(room, &out->source);
    if (result == RLF_OK) {
        const rlf_rig *rig = &rlf_source_get_info(out->source)->rig;
        rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
        def.pool = pool;
        result = rlf_reconstruct_create(&def, &out->stage);
    }
    return result;
}

static rlf_result step_lane(lane *l, double *out_ms)
{
    rlf_frame frame;
    const rlf_surface *surface = NULL;
    rlf_result result = rlf_source_next(l->source, &frame);
    int64_t start = rlf_clock_ns();
    result = result == RLF_OK ? rlf_reconstruct_process(l->stage, &frame, &surface) : result;
    *out_ms = (double)(rlf_clock_ns() - start) * 1e-6;
    l->regions = result == RLF_OK ? surface->region_count : 0;
    return result;
}

/* One frame of each lane after the other, so that all meet the same machine. */
static rlf_result run_lanes(lane *lanes, int count)
{
    rlf_result result = RLF_OK;
    for (int f = 0; f < WARM_UP + FRAMES && result == RLF_OK && !command_interrupted; f++) {
        double first = NAN;
        for (int i = 0; i < count && result == RLF_OK; i++) {
            double ms;
            result = step_lane(&lanes[i], &ms);
            first = i == 0 ? ms : first;
            if (f >= WARM_UP) {
                timing_add(&lanes[i].ms, ms);
                timing_add(&lanes[i].ratio, ms / first);
            }
        }
    }
    return result;
}

/* Gives lanes that have run, to be given back with rlf_free; NULL where they could not. */
static rlf_result time_rooms(const bench_room *rooms, int count, rlf_pool *pool, lane **out)
{
    lane *lanes = rlf_alloc_array((size_t)count, sizeof(*lanes));
    rlf_result result = lanes != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int i = 0; i < count && result == RLF_OK; i++) {
        result = open_lane(&rooms[i], pool, &lanes[i]);
    }
    result = result == RLF_OK ? run_lanes(lanes, count) : result;
    for (int i = 0; i < count && lanes != NULL; i++) {
        rlf_reconstruct_destroy(&lanes[i].stage);
        rlf_source_destroy(&lanes[i].source);
    }
    if (result != RLF_OK) {
        rlf_free(lanes);
        lanes = NULL;
    }
    *out = lanes;
    return result;
}

/* Ratio: nanoseconds per pixel beside those of 512x424 (rows before it are set afterwards). */
static rlf_result sweep_sizes(rlf_pool *pool, bench_table *table)
{
    int32_t first = table->count;
    double reference = NAN;
    for (int i = 0; i < COUNT(sizes); i++) {
        bench_room room = {sizes[i][0], sizes[i][1], 1, 16, false};
        char name[BENCH_NAME];
        lane *timed;
        rlf_result result = time_rooms(&room, 1, pool, &timed);
        if (result != RLF_OK) {
            return result;
        }
        snprintf(name, sizeof(name), "%dx%d", (int)room.width, (int)room.height);
        double per_pixel = timing_percentile(&timed->ms, 50) / ((double)room.width * room.height);
        reference = room.width == 512 ? per_pixel : reference;
        bench_add_series(table, "resolution", name, &timed->ms, per_pixel);
        rlf_free(timed);
    }
    for (int32_t i = first; i < table->count; i++) {
        table->rows[i].ratio /= reference;
    }
    return RLF_OK;
}

enum room_sweep { SWEEP_REGIONS, SWEEP_PEOPLE, SWEEP_ROW };

/* Ratio: beside the same frames of the sweep's first row. */
static rlf_result sweep_room(enum room_sweep kind, const int32_t *counts, int count, rlf_pool *pool,
                             bench_table *table)
{
    static const char *const groups[] = {"regions", "people", "people of the same pixels"};
    bench_room rooms[MOST_ROOMS];
    for (int i = 0; i < count; i++) {
        rooms[i] = (bench_room){512, 424, counts[i], kind == SWEEP_ROW ? 0 : 4, kind == SWEEP_ROW};
        if (kind == SWEEP_REGIONS) {
            rooms[i].people = 0;
            rooms[i].plates = counts[i];
        }
    }
    lane *timed;
    rlf_result result = time_rooms(rooms, count, pool, &timed);
    for (int i = 0; i < count && result == RLF_OK; i++) {
        char name[BENCH_NAME];
        snprintf(name, sizeof(name), "%d", (int)counts[i]);
        if (kind == SWEEP_REGIONS) {
            snprintf(name, sizeof(name), "%d (%d found)", (int)counts[i], (int)timed[i].regions);
        }
        bench_add_series(table, groups[kind], name, &timed[i].ms,
                         timing_percentile(&timed[i].ratio, 50));
    }
    rlf_free(timed);
    return result;
}

/* Cubes of 10 cm in a block above floor and table, all falling at once. */
static rlf_result make_bodies(int32_t count, rlf_scene *out)
{
    memset(out, 0, sizeof(*out));
    out->gravity = rlf_vec3_make(0, 9.81, 0);
    out->bodies = rlf_alloc_array((size_t)count, sizeof(*out->bodies));
    if (out->bodies == NULL) {
        return RLF_ERROR_MEMORY;
    }
    out->body_count = count;
    for (int32_t i = 0; i < count; i++) {
        out->bodies[i] = rlf_body_def_default();
        out->bodies[i].position = rlf_vec3_make(-0.72 + 0.16 * (i % 10), 0.7 - 0.14 * (i / 100),
                                                1.6 + 0.13 * (i / 10 % 10));
    }
    return RLF_OK;
}

/* Physics by itself, or the whole loop with its picture. */
static rlf_result time_bodies(const bench_options *o, int32_t count, bool is_loop,
                              timing_series *out)
{
    rlf_scene scene;
    rlf_result result = make_bodies(count, &scene);
    if (result != RLF_OK) {
        return result;
    }
    session_options options = session_options_default();
    options.source = is_loop ? "synthetic:room" : "synthetic:room?color=0";
    options.scene = &scene;
    options.thread_count = o->threads;
    options.enable_render = is_loop;
    session s;
    result = session_open(&options, &s);
    rlf_scene_destroy(&scene);
    if (result != RLF_OK) {
        return result;
    }
    memset(out, 0, sizeof(*out));
    int first = is_loop ? LOOP_FROM : WARM_UP, end = is_loop ? LOOP_TO : 2 * (WARM_UP + FRAMES);
    for (int i = 0; i < end && result == RLF_OK && !command_interrupted; i++) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(s.pipeline, &frame);
        if (result == RLF_OK && i >= first) {
            const rlf_stage_times *ms = &frame.times;
            double others = ms->capture_ms + ms->surface_ms + ms->render_ms;
            timing_add(out, ms->physics_ms + (is_loop ? others : 0.0));
        }
    }
    session_close(&s);
    return result;
}

/* Ratio: per body, beside that of 100 bodies. */
static rlf_result sweep_bodies(const bench_options *o, timing_series *series, bench_table *table)
{
    int32_t first = table->count;
    double reference = NAN;
    for (int i = 0; i < COUNT(body_counts); i++) {
        char name[BENCH_NAME];
        rlf_result result = time_bodies(o, body_counts[i], false, series);
        if (result != RLF_OK) {
            return result;
        }
        double per_body = timing_percentile(series, 50) / body_counts[i];
        reference = body_counts[i] == 100 ? per_body : reference;
        snprintf(name, sizeof(name), "%d", (int)body_counts[i]);
        bench_add_series(table, "bodies", name, series, per_body);
    }
    for (int32_t i = first; i < table->count; i++) {
        table->rows[i].ratio /= reference;
    }
    return RLF_OK;
}

/* Ratio: frames per second. */
static rlf_result time_loop(const bench_options *o, timing_series *series, bench_table *table)
{
    rlf_result result = time_bodies(o, LOOP_BODIES, true, series);
    if (result == RLF_OK) {
        double ms = timing_percentile(series, 50);
        bench_add_series(table, "loop", "100 bodies", series, ms > 0.0 ? 1000.0 / ms : NAN);
    }
    return result;
}

static rlf_result run_all(const bench_options *o, rlf_pool *pool, timing_series *series,
                          bench_table *table)
{
    rlf_result result = sweep_sizes(pool, table);
    if (result == RLF_OK) {
        result = sweep_room(SWEEP_REGIONS, region_counts, COUNT(region_counts), pool, table);
    }
    if (result == RLF_OK) {
        result = sweep_room(SWEEP_PEOPLE, people_counts, COUNT(people_counts), pool, table);
    }
    if (result == RLF_OK) {
        result = sweep_room(SWEEP_ROW, row_counts, COUNT(row_counts), pool, table);
    }
    result = result == RLF_OK ? sweep_bodies(o, series, table) : result;
    return result == RLF_OK ? time_loop(o, series, table) : result;
}

rlf_result bench_sweeps_run(const bench_options *o, bench_table *table)
{
    fprintf(stderr, "sweeps\n");
    rlf_pool *pool = NULL;
    timing_series *series = rlf_alloc(sizeof(*series));
    rlf_result result = rlf_pool_create(o->threads, &pool);
    result = series != NULL ? result : RLF_ERROR_MEMORY;
    if (result == RLF_OK) {
        result = run_all(o, pool, series, table);
    }
    rlf_free(series);
    rlf_pool_destroy(&pool);
    return result;
}

static void print_sweep(const bench_table *table, const char *group, const char *title)
{
    printf("%s\n", title);
    for (int32_t i = 0; i < table->count; i++) {
        const bench_row *row = &table->rows[i];
        if (strcmp(row->group, group) == 0) {
            printf("  %-20s %9.3f %9.3f %8.2f\n", row->name, row->median, row->p95, row->ratio);
        }
    }
}

void bench_sweeps_print(const bench_table *table)
{
    printf("\nscaling, profile live: ms median, p95, ratio\n");
    print_sweep(table, "resolution", "surface, pixels; ratio: per pixel beside 512x424");
    print_sweep(table, "regions", "surface, regions at 512x424; ratio: beside the first");
    print_sweep(table, "people", "surface, people at 512x424; ratio: beside the first");
    print_sweep(table, "people of the same pixels",
                "surface, people who fill the same pixels together; ratio: beside the first");
    print_sweep(table, "bodies", "physics, bodies at 512x424; ratio: per body beside 100");
    print_sweep(table, "loop",
                "whole loop, pictures of 960x540; instead of a ratio: frames per second");
}
