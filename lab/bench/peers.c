/* Our stages on the peers' clip, beside the results of their harness. */
#include "bench/peers.h"

#include "bench/peers_results.h"
#include "bench/peers_table.h"
#include "command.h"
#include "eval/sections.h"
#include "eval/table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PASSES 2
#define JUDGED_FRAME 40 /* as the harness */
#define FIRST_TIMED 12  /* frame of the clip: background and temporal filters have started */
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

/* The plane with holes, from the section of `relief-lab eval` that draws it. */
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
