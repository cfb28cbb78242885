/* What the harness prints, sorted into the stages that we have. */
#include "bench/peers_results.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define STEP(name) (1u << RLF_SURFACE_##name)
const peer_group peer_groups[PEER_GROUPS] = {
    {'B',
     "normals (peers: from points they are given; ours: from raw depth, filter included)",
     "read+flying+smooth+fill+complete",
     STEP(READ) | STEP(FLYING) | STEP(SMOOTH) | STEP(FILL) | STEP(COMPLETE) | STEP(NORMALS),
     {{"interior_normals_pct", "inner%"},
      {"interior_err_deg_median", "median deg"},
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

const peer_group *peer_group_of(const char *stage)
{
    for (int g = 0; g < PEER_GROUPS; g++) {
        if (stage[0] == peer_groups[g].letter && stage[1] == '_') {
            return &peer_groups[g];
        }
    }
    return NULL;
}

peer_stage *peer_stage_of(peer_results *r, const char *peer, const char *stage)
{
    for (int32_t i = 0; i < r->count; i++) {
        if (strcmp(r->stages[i].peer, peer) == 0 && strcmp(r->stages[i].stage, stage) == 0) {
            return &r->stages[i];
        }
    }
    if (peer_group_of(stage) == NULL || r->count == PEER_STAGES_MAX) {
        return NULL;
    }
    peer_stage *s = &r->stages[r->count++];
    snprintf(s->peer, sizeof(s->peer), "%s", peer);
    snprintf(s->stage, sizeof(s->stage), "%s", stage);
    s->ms = s->least_ms = NAN;
    for (int k = 0; k < PEER_VALUES_MAX; k++) {
        s->values[k] = NAN;
    }
    return s;
}

static void set_value(peer_stage *s, const char *key, double value)
{
    const peer_group *g = peer_group_of(s->stage);
    for (int k = 0; k < PEER_VALUES_MAX; k++) {
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
        peer_stage *s = peer_stage_of(r, peer, stage);
        if (s != NULL) {
            set_value(s, key, value);
        }
    } else if (line[0] != 'Q' && sscanf(line, "%23s %63s %d %d %d %lf %lf", peer, stage, &width,
                                        &height, &threads, &value, &least) == 7) {
        peer_stage *s = peer_stage_of(r, peer, stage);
        if (s != NULL) {
            s->ms = value;
            s->least_ms = least;
        }
    }
}

rlf_result peer_results_read(const char *path, peer_results *out)
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
