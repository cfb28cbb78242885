/* Our stages on the peers' clip, beside the results of their harness. */
#include "bench/peers.h"

#include "bench/peers_results.h"
#include "bench/peers_table.h"
#include "command.h"
#include "eval/analytic.h"
#include "eval/measures/percent.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PASSES 2
#define JUDGED_FRAME 40 /* as the harness */
#define FIRST_TIMED 12  /* frame of the clip: background and temporal filters have started */
#define HOLE_SHARE 0.01
#define SPOILT_DEG 10.0

typedef struct our_times {
    timing_series groups[PEER_GROUPS]; /* sums of a group's steps, per frame */
} our_times;

/* What peers do in one call each, ours does with less: of one frame, with nothing dropped, recalled
 * or filled. Only these two stages are another thing then. */
static const peer_group plain_groups[] = {
    {.letter = 'B',
     .ours = "read+smooth+complete, one frame, no holes",
     .steps = 1u << RLF_SURFACE_READ | 1u << RLF_SURFACE_SMOOTH | 1u << RLF_SURFACE_COMPLETE},
    {.letter = 'F', .ours = "smooth, one frame, no holes", .steps = 1u << RLF_SURFACE_SMOOTH},
};
#define PLAIN_GROUPS ((int)(sizeof(plain_groups) / sizeof(plain_groups[0])))

static rlf_reconstruct_def plain_def(const rlf_rig *rig)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
    def.enable_flying_removal = def.enable_hold = def.enable_steadying = def.enable_fill = false;
    def.enable_edge_normals = def.enable_velocity = def.enable_thickness = false;
    return def;
}

static void add_times(our_times *t, const peer_group *groups, int count,
                      const rlf_surface_times *times)
{
    for (int g = 0; g < count; g++) {
        double sum = 0.0;
        for (int s = 0; s < RLF_SURFACE_STEP_COUNT; s++) {
            sum += groups[g].steps & (1u << s) ? times->step_ms[s] : 0.0;
        }
        timing_add(&t->groups[g], sum);
    }
}

static rlf_result run_stage(const bench_clip *clip, rlf_reconstruct *stage,
                            const peer_group *groups, int count, our_times *t,
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
            add_times(t, groups, count, &times);
        }
        if (k == JUDGED_FRAME) {
            bench_quality_measure(clip, index, surface, quality);
        }
    }
    return RLF_OK;
}

static rlf_result run_clip(const bench_clip *clip, const rlf_reconstruct_def *def,
                           const peer_group *groups, int count, our_times *t,
                           bench_quality *quality)
{
    rlf_reconstruct *stage = NULL;
    rlf_result result = rlf_reconstruct_create(def, &stage);
    result = result == RLF_OK ? run_stage(clip, stage, groups, count, t, quality) : result;
    rlf_reconstruct_destroy(&stage);
    return result;
}

/* Counts of the pixels of a plane with holes. */
typedef struct hole_counts {
    int64_t valid, lost, spoilt, holes, invented;
} hole_counts;

static void count_hole(const rlf_surface *s, int32_t i, float depth, hole_counts *c)
{
    const rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]}, real = {0, 0, -1};
    const bool has_normal = rlf_length(n) > 0.5;
    if (depth > 0.0f) {
        const double off = rlf_atan2(rlf_length(rlf_cross(n, real)), rlf_dot(n, real));
        c->valid++;
        c->lost += !has_normal;
        c->spoilt += has_normal && off * 180.0 / RLF_PI > SPOILT_DEG;
    } else {
        c->holes++;
        c->invented += has_normal && s->reason[i] != RLF_REASON_FILLED;
    }
}

/* A wall 2 m away of which one pixel in a hundred is missing, as section planes of `relief-lab
 * eval` draws it. */
static rlf_result measure_holes(bench_quality *q)
{
    eval_stage stage;
    eval_random random = eval_random_start(1);
    hole_counts c = {0};
    const rlf_surface *surface = NULL;
    rlf_result result = eval_stage_open(RLF_PROFILE_LIVE, &stage);
    const int32_t count = stage.rig.depth.width * stage.rig.depth.height;
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        stage.depth[i] = eval_random_uniform(&random) < HOLE_SHARE ? 0.0f : 2.0f;
    }
    result = result == RLF_OK ? eval_stage_process(&stage, &surface) : result;
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        count_hole(surface, i, stage.depth[i], &c);
    }
    eval_stage_close(&stage);
    q->plane_lost = eval_percent(c.lost, c.valid);
    q->plane_wrong = eval_percent(c.spoilt, c.valid);
    q->plane_invented = eval_percent(c.invented, c.holes);
    return result;
}

/* Figures of a stage in the order of its group's columns. */
static void set_values(const bench_quality *q, char letter, double out[PEER_VALUES_MAX])
{
    const double values[PEER_GROUPS][PEER_VALUES_MAX] = {
        {q->interior_normals, q->interior_median_deg, q->interior_wrong, q->edge_normals,
         q->edge_wrong, q->plane_lost, q->plane_wrong, q->plane_invented},
        {q->regions, q->big_regions, q->in_big_regions},
        {q->recall, q->precision},
        {q->interior_rmse_mm, q->edge_wrong_40_mm, q->holes_filled}};
    for (int g = 0; g < PEER_GROUPS; g++) {
        if (peer_groups[g].letter == letter) {
            memcpy(out, values[g], sizeof(values[g]));
        }
    }
}

/* Our stages as entries of the results, behind what is there. */
static void add_ours(const peer_group *groups, int count, const our_times *t,
                     const bench_quality *q, peer_results *out)
{
    for (int g = 0; g < count; g++) {
        char name[64];
        snprintf(name, sizeof(name), "%c_%s", groups[g].letter, groups[g].ours);
        peer_stage *s = peer_stage_of(out, "relief", name);
        s->ms = timing_percentile(&t->groups[g], 50);
        s->least_ms = timing_percentile(&t->groups[g], 0);
        set_values(q, groups[g].letter, s->values);
    }
}

/* Profile live. */
static rlf_result measure_live(const bench_clip *clip, our_times *times, peer_results *out)
{
    bench_quality quality = {.regions = 0};
    const rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &clip->rig);
    rlf_result result = run_clip(clip, &def, peer_groups, PEER_GROUPS, times, &quality);
    result = result == RLF_OK ? measure_holes(&quality) : result;
    if (result == RLF_OK) {
        add_ours(peer_groups, PEER_GROUPS, times, &quality, out);
    }
    return result;
}

static rlf_result measure_plain(const bench_clip *clip, our_times *times, peer_results *out)
{
    bench_quality quality = {.plane_lost = NAN, .plane_wrong = NAN, .plane_invented = NAN};
    const rlf_reconstruct_def def = plain_def(&clip->rig);
    rlf_result result = run_clip(clip, &def, plain_groups, PLAIN_GROUPS, times, &quality);
    if (result == RLF_OK) {
        add_ours(plain_groups, PLAIN_GROUPS, times, &quality, out);
    }
    return result;
}

/* Ours are the first entries, one per group, then the plain ones. */
static rlf_result measure_ours(peer_results *out)
{
    bench_clip clip;
    our_times *times = rlf_alloc_array(2, sizeof(*times));
    rlf_result result = bench_clip_create(&clip);
    result = times != NULL ? result : RLF_ERROR_MEMORY;
    result = result == RLF_OK ? measure_live(&clip, &times[0], out) : result;
    result = result == RLF_OK ? measure_plain(&clip, &times[1], out) : result;
    rlf_free(times);
    bench_clip_destroy(&clip);
    return result;
}

rlf_result bench_peers_check(const char *path)
{
    peer_results *r = rlf_alloc(sizeof(*r));
    rlf_result result = r != NULL ? peer_results_read(path, r) : RLF_ERROR_MEMORY;
    rlf_free(r);
    return result;
}

rlf_result bench_peers_run(const bench_options *o, bench_table *table, json_t **out_json)
{
    peer_results *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    fprintf(stderr, "peers\n");
    rlf_result result = measure_ours(r);
    result = result == RLF_OK ? peer_results_read(o->peers_path, r) : result;
    if (result == RLF_OK) {
        peer_table_print(r, table);
        *out_json = peer_table_json(r);
    }
    rlf_free(r);
    return result;
}
