/* The surface stage beside other libraries, on one clip that all of them read. */
#ifndef RELIEF_APP_BENCH_PEERS_H
#define RELIEF_APP_BENCH_PEERS_H

#include "bench/bench.h"

#include <jansson.h>

/* Values of bench_clip.label. */
#define CLIP_LABEL_PERSON 1
#define CLIP_LABEL_NOTHING 255

/* Frames of the synthetic room with their truth: ten without anybody, then with a person. */
typedef struct bench_clip {
    rlf_rig rig;
    int32_t frame_count;
    size_t pixels;   /* of a frame */
    uint16_t *depth; /* millimetres, frame after frame; 0 = missing */
    float *z;        /* true depth, metres */
    float *normal;   /* true normals, three a pixel */
    uint8_t *label;  /* CLIP_LABEL_, others: one per thing */
} bench_clip;

rlf_result bench_clip_create(bench_clip *out);
void bench_clip_destroy(bench_clip *clip);
/* Writes PATH (a text line "width height frames fx fy cx cy", then the depth) and PATH.gt (per
 * frame true z, normals, labels), all little endian. */
rlf_result bench_clip_write(const bench_clip *clip, const char *path);

/* How good one frame is. Interior: farther than 3 pixels from where the label or the normal
 * changes (normals) or the depth jumps by 4 cm (depth). Shares in percent. */
typedef struct bench_quality {
    double interior_normals, interior_median_deg, interior_wrong; /* wrong: by more than 30 deg */
    double edge_normals, edge_wrong;
    double plane_lost, plane_wrong, plane_invented; /* a plane with 1 % of its pixels missing */
    double regions, big_regions, in_big_regions;
    double recall, precision;
    double interior_rmse_mm, edge_wrong_40_mm, holes_filled;
} bench_quality;

/* Judges the surface of a clip's frame; all but the plane's figures. */
void bench_quality_measure(const bench_clip *clip, int32_t frame, const rlf_surface *surface,
                           bench_quality *out);

/* Times profile live on the clip, reads the results of the peers' harness (lines "peer stage width
 * height threads median min cpu n" and "Q peer stage width height threads key value") and prints
 * one table per stage. Adds its rows to the table, ratio: peer's least time / ours, which a busy
 * machine disturbs less than medians taken at different moments. *out_json: the whole as JSON, the
 * caller's. */
rlf_result bench_peers_run(const bench_options *o, bench_table *table, json_t **out_json);
/* Whether a file holds results of the harness. */
rlf_result bench_peers_check(const char *path);

#endif
