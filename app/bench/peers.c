/* Ours and theirs in one table per stage. */
#include "bench/peers.h"
#include "command.h"
#include "eval/sections.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PASSES 2
#define JUDGED_FRAME 40 /* as the harness */
#define FIRST_TIMED 12  /* frame of the clip: background and temporal filters have started */
#define STAGES_MAX 160
#define VALUES_MAX 8

/* A quality figure: the harness's key, and the head of its column. */
typedef struct column {
    const char *key, *head;
} column;

/* One stage of the surface and what its table shows. `steps` of ours do it. */
typedef struct peer_group {
    char letter; /* the harness's stages begin with it */
    const char *title;
    const char *ours;
    uint32_t steps; /* bit of each rlf_surface_step */
    column columns[VALUES_MAX];
} peer_group;

#define STEP(name) (1u << RLF_SURFACE_##name)
static const peer_group groups[] = {
    {'B',
     "normals (peers: from points they are given; ours: from raw depth, filter included)",
     "read+flying+smooth+fill+complete",
     STEP(READ) | STEP(FLYING) | STEP(SMOOTH) | STEP(FILL) | STEP(COMPLETE) | STEP(NORMALS),
     {{"interior_normals_pct", "inner%"},
      {"interior_err_deg_median", "median"},
      {"interior_wrong_over30deg_pct", ">30%"},
      {"edge_normals_pct", "edge%"},
      {"edge_wrong_over30deg_pct", "edge>30%"},
      {"nan1pct_valid_pixels_without_normal_pct", "lost%"},
      {"nan1pct_valid_pixels_wrong_over10deg_pct", "spoilt%"},
      {"nan1pct_invalid_pixels_given_normal_pct", "invented%"}}},
    {'C',
     "segmentation (ours: with boxes, moments, tracks)",
     "segment",
     STEP(SEGMENT),
     {{"regions_all", "regions"},
      {"regions_big", "big"},
      {"valid_pixels_in_big_regions_pct", "in big%"}}},
    {'D',
     "background and foreground",
     "background",
     STEP(BACKGROUND),
     {{"fg_recall_pct", "recall%"}, {"fg_precision_pct", "precision%"}}},
    {'F',
     "depth filter and holes (ours: with normals, and over time)",
     "flying+smooth+fill+steady",
     STEP(FLYING) | STEP(SMOOTH) | STEP(FILL) | STEP(STEADY),
     {{"interior_rmse_mm", "RMSE mm"},
      {"edge_pixels_wrong_over40mm_pct", "edge>40mm%"},
      {"holes_filled_pct", "filled%"}}},
};
#define GROUP_COUNT ((int)(sizeof(groups) / sizeof(groups[0])))

typedef struct peer_stage {
    char peer[24], stage[64];
    double ms, least_ms;
    double values[VALUES_MAX]; /* by the group's columns; NAN = none */
} peer_stage;

typedef struct peer_results {
    peer_stage stages[STAGES_MAX];
    int32_t count;
} peer_results;

static const peer_group *group_of(const char *stage)
{
    for (int g = 0; g < GROUP_COUNT; g++) {
        if (stage[0] == groups[g].letter && stage[1] == '_') {
            return &groups[g];
        }
    }
    return NULL;
}

/* The entry of a peer's stage, made when it is new; NULL when it is of no group or there is no
 * room. */
static peer_stage *stage_of(peer_results *r, const char *peer, const char *stage)
{
    for (int32_t i = 0; i < r->count; i++) {
        if (strcmp(r->stages[i].peer, peer) == 0 && strcmp(r->stages[i].stage, stage) == 0) {
            return &r->stages[i];
        }
    }
    if (group_of(stage) == NULL || r->count == STAGES_MAX) {
        return NULL;
    }
    peer_stage *s = &r->stages[r->count++];
    snprintf(s->peer, sizeof(s->peer), "%s", peer);
    snprintf(s->stage, sizeof(s->stage), "%s", stage);
    s->ms = s->least_ms = NAN;
    for (int k = 0; k < VALUES_MAX; k++) {
        s->values[k] = NAN;
    }
    return s;
}

static void set_value(peer_stage *s, const char *key, double value)
{
    const peer_group *g = group_of(s->stage);
    for (int k = 0; k < VALUES_MAX; k++) {
        if (g->columns[k].key != NULL && strcmp(g->columns[k].key, key) == 0) {
            s->values[k] = value;
        }
    }
}

static void take_line(peer_results *r, const char *line)
{
    char peer[24], stage[64], key[64];
    int width, height, threads;
    double value, least;
    if (sscanf(line, "Q %23s %63s %d %d %d %63s %lf", peer, stage, &width, &height, &threads, key,
               &value) == 7) {
        peer_stage *s = stage_of(r, peer, stage);
        if (s != NULL) {
            set_value(s, key, value);
        }
    } else if (line[0] != 'Q' && sscanf(line, "%23s %63s %d %d %d %lf %lf", peer, stage, &width,
                                        &height, &threads, &value, &least) == 7) {
        peer_stage *s = stage_of(r, peer, stage);
        if (s != NULL) {
            s->ms = value;
            s->least_ms = least;
        }
    }
}

/* Behind what is there already: ours. */
static rlf_result read_results(const char *path, peer_results *out)
{
    int32_t first = out->count;
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be read; run script/bench --peers DIR", path);
    }
    char line[512];
    while (fgets(line, sizeof(line), file) != NULL) {
        take_line(out, line);
    }
    fclose(file);
    return out->count > first
               ? RLF_OK
               : rlf_fail(RLF_ERROR_FORMAT, "%s: holds no results of the peers", path);
}

/* ---- ours ------------------------------------------------------------------------------------ */

typedef struct our_times {
    timing_series groups[GROUP_COUNT]; /* sums of a group's steps, per frame */
} our_times;

static void add_times(our_times *t, const rlf_surface_times *times)
{
    for (int g = 0; g < GROUP_COUNT; g++) {
        double sum = 0.0;
        for (int s = 0; s < RLF_SURFACE_STEP_COUNT; s++) {
            sum += groups[g].steps & (1u << s) ? times->step_ms[s] : 0.0;
        }
        timing_add(&t->groups[g], sum);
    }
}

static rlf_result run_clip(const bench_clip *clip, rlf_reconstruct *stage, our_times *t,
                           bench_quality *quality)
{
    rlf_surface_times times;
    rlf_reconstruct_set_times(stage, &times);
    for (int32_t k = 0; k < PASSES * clip->frame_count && !command_interrupted; k++) {
        int32_t index = k % clip->frame_count;
        if (index == 0) {
            rlf_reconstruct_reset(stage);
        }
        rlf_frame frame = {.sequence = (uint64_t)k,
                           .time_ns = k * INT64_C(33333333),
                           .rig = &clip->rig,
                           .depth_u16 = clip->depth + clip->pixels * (size_t)index,
                           .depth_stride = clip->rig.depth.width * (ptrdiff_t)sizeof(uint16_t),
                           .depth_units_per_metre = 1000.0};
        const rlf_surface *surface = NULL;
        rlf_result result = rlf_reconstruct_process(stage, &frame, &surface);
        if (result != RLF_OK) {
            return result;
        }
        if (index >= FIRST_TIMED) {
            add_times(t, &times);
        }
        if (k == JUDGED_FRAME) {
            bench_quality_measure(clip, index, surface, quality);
        }
    }
    return RLF_OK;
}

/* The plane with holes, from the section of `relief eval` that draws it. */
static rlf_result measure_holes(bench_quality *q)
{
    eval_table *table = rlf_alloc(sizeof(*table));
    if (table == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = eval_planes_run(table, 1, 1 << RLF_PROFILE_LIVE);
    if (result == RLF_OK) {
        const char *const keys[3] = {"holes_lost_percent", "holes_spoilt_percent",
                                     "holes_invented_percent"};
        double *const values[3] = {&q->plane_lost, &q->plane_wrong, &q->plane_invented};
        for (int k = 0; k < 3; k++) {
            *values[k] = eval_table_find(table, "planes", keys[k])->values[RLF_PROFILE_LIVE][0];
        }
    }
    rlf_free(table);
    return result;
}

/* Our stages, as the first entries of the results. */
static void add_ours(const our_times *t, const bench_quality *q, peer_results *out)
{
    const double values[GROUP_COUNT][VALUES_MAX] = {
        {q->interior_normals, q->interior_median_deg, q->interior_wrong, q->edge_normals,
         q->edge_wrong, q->plane_lost, q->plane_wrong, q->plane_invented},
        {q->regions, q->big_regions, q->in_big_regions},
        {q->recall, q->precision},
        {q->interior_rmse_mm, q->edge_wrong_40_mm, q->holes_filled}};
    for (int g = 0; g < GROUP_COUNT; g++) {
        char name[64];
        snprintf(name, sizeof(name), "%c_%s", groups[g].letter, groups[g].ours);
        peer_stage *s = stage_of(out, "relief", name);
        s->ms = timing_percentile(&t->groups[g], 50);
        s->least_ms = timing_percentile(&t->groups[g], 0);
        memcpy(s->values, values[g], sizeof(s->values));
    }
}

static rlf_result measure_ours(peer_results *out)
{
    bench_clip clip;
    bench_quality quality;
    memset(&quality, 0, sizeof(quality));
    our_times *times = rlf_alloc(sizeof(*times));
    rlf_reconstruct *stage = NULL;
    rlf_result result = bench_clip_create(&clip);
    result = times != NULL ? result : RLF_ERROR_MEMORY;
    if (result == RLF_OK) {
        rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &clip.rig);
        result = rlf_reconstruct_create(&def, &stage);
    }
    result = result == RLF_OK ? run_clip(&clip, stage, times, &quality) : result;
    result = result == RLF_OK ? measure_holes(&quality) : result;
    if (result == RLF_OK) {
        add_ours(times, &quality, out);
    }
    rlf_reconstruct_destroy(&stage);
    rlf_free(times);
    bench_clip_destroy(&clip);
    return result;
}

/* ---- the table ------------------------------------------------------------------------------- */

static int by_time(const void *a, const void *b)
{
    double x = ((const peer_stage *)a)->least_ms, y = ((const peer_stage *)b)->least_ms;
    return (x > y) - (x < y);
}

static void print_group(const peer_group *g, const peer_results *r, double ours_least,
                        bench_table *table)
{
    printf("\n%s\n%-46s %8s %8s %8s", g->title, "", "median", "least", "/ ours");
    for (int k = 0; k < VALUES_MAX && g->columns[k].key != NULL; k++) {
        printf(" %10s", g->columns[k].head);
    }
    printf("\n");
    for (int32_t i = 0; i < r->count; i++) {
        const peer_stage *s = &r->stages[i];
        if (group_of(s->stage) != g || isnan(s->ms)) {
            continue;
        }
        char name[96];
        snprintf(name, sizeof(name), "%s %s", s->peer, s->stage + 2);
        double ratio = s->least_ms / ours_least;
        printf("%-46s %8.3f %8.3f %8.2f", name, s->ms, s->least_ms, ratio);
        for (int k = 0; k < VALUES_MAX && g->columns[k].key != NULL; k++) {
            char text[24];
            snprintf(text, sizeof(text), isnan(s->values[k]) ? "-" : "%.4g", s->values[k]);
            printf(" %10s", text);
        }
        printf("\n");
        bench_add(table, "peers", name, "ms", s->ms, NAN, ratio);
    }
}

static void print_all(peer_results *r, bench_table *table)
{
    double ours[GROUP_COUNT];
    for (int g = 0; g < GROUP_COUNT; g++) {
        ours[g] = r->stages[g].least_ms;
    }
    qsort(r->stages, (size_t)r->count, sizeof(r->stages[0]), by_time);
    for (int g = 0; g < GROUP_COUNT; g++) {
        print_group(&groups[g], r, ours[g], table);
    }
}

rlf_result bench_peers_run(const bench_options *o, bench_table *table)
{
    peer_results *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    fprintf(stderr, "peers\n");
    rlf_result result = measure_ours(r);
    result = result == RLF_OK ? read_results(o->peers_path, r) : result;
    if (result == RLF_OK) {
        print_all(r, table);
    }
    rlf_free(r);
    return result;
}
