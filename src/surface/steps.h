/* The steps of the surface stage, in the order in which they run. Each reads finished planes and
 * writes others; none allocates. */
#ifndef RLF_SURFACE_STEPS_H
#define RLF_SURFACE_STEPS_H

#include "surface/stage.h"

/* ---- points.c: eq. 4.1 ---- */
/* Raw depth of the frame, every factor-th pixel, to metres with reasons. */
void rlf_points_read(const rlf_reconstruct *stage, const rlf_frame *frame, float *depth,
                     uint8_t *reason);

/* ---- flying.c, fill.c ---- */
void rlf_flying_remove(const rlf_reconstruct *stage, const float *raw, float *depth,
                       uint8_t *reason);
/* Fills gaps of at most RLF_FILL_GAP pixels between valid ones; `depth` is read, `out` written. */
enum { RLF_FILL_GAP = 8 };
void rlf_fill_holes(const rlf_reconstruct *stage, const float *depth, float *out, uint8_t *reason);

/* ---- hold.c: dropped pixels from memory; `depth` holds what was seen ---- */
void rlf_hold_recall(const rlf_reconstruct *stage, float *depth, uint8_t *reason);

/* ---- steady.c: depth that does not change is averaged over time; needs the slot's normals ---- */
void rlf_steady_update(const rlf_reconstruct *stage, rlf_slot *slot);
void rlf_steady_reset(rlf_steady *steady, int32_t count);

/* ---- normals ---- */
typedef struct rlf_normals_job {
    rlf_normal_method method;
    bool face_camera;
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const float *filled;          /* depth with holes filled: they take normals from beside them;
                                     NULL = the same as depth */
    const rlf_depth_noise *noise; /* NULL = clean */
    float *out[3];
    float *smooth; /* depth of the planes, when the method fits any; NULL = not wanted */
    rlf_pool *pool;
} rlf_normals_job;

/* With the stage's method, rays and noise. */
rlf_normals_job rlf_normals_job_make(const rlf_reconstruct *stage, const float *depth,
                                     float *const out[3]);
void rlf_normals_compute(const rlf_normals_job *job);
void rlf_normals_faces(const rlf_normals_job *job);
void rlf_normals_thesis(const rlf_normals_job *job);
void rlf_normals_slope(const rlf_normals_job *job);
void rlf_normals_plane(const rlf_normals_job *job);
/* The two halves of rlf_normals_plane: planes of what was seen, then normals of the other pixels of
 * `filled`. */
void rlf_normals_plane_fit(const rlf_normals_job *job);
void rlf_normals_plane_complete(const rlf_normals_job *job);
/* Exact inverse-depth normal of one pixel, for those that no plane explains. */
void rlf_normals_slope_pixel(const rlf_normals_job *job, int32_t x, int32_t y);

/* ---- components.c ---- */
enum { RLF_LINK_MEMBER = 1, RLF_LINK_LEFT = 2, RLF_LINK_UP = 4 };
/* 4-connected components of the members, over the links to the left and up, numbered from 1 in
 * raster order into work.component; work.size holds their pixel counts. Returns their number. */
int32_t rlf_components_find(const rlf_reconstruct *stage);

/* ---- segment.c ---- */
/* Writes work.links from depth and (when not NULL) the members' mask. */
void rlf_segment_links(const rlf_reconstruct *stage, rlf_segment_method method, const float *depth,
                       const uint8_t *mask);
/* Eq. 4.4: 1 where a pixel is valid and within tau of its right and lower neighbours. */
void rlf_segment_thesis_bits(const rlf_grid *grid, double tau, const float *depth,
                             const uint8_t *mask, uint8_t *bits);
/* Fig. 4.12: grows labels to the left and top over valid members without a label. */
void rlf_segment_dilate(const rlf_grid *grid, double tau, const float *depth, const uint8_t *mask,
                        int32_t *label);

/* ---- region.c ---- */
typedef struct rlf_layer_in {
    rlf_layer layer;
    rlf_segment_method method;
    const float *depth;
    const uint8_t *mask;           /* members; NULL = every valid pixel */
    const int32_t *previous_label; /* labels of this layer one surface ago; NULL = none */
    const uint8_t *previous_mask;  /* where they count; NULL = everywhere */
    const rlf_region *previous;
    int32_t previous_count;
    int64_t elapsed_ns; /* since then */
} rlf_layer_in;

typedef struct rlf_layer_out {
    int32_t *label;
    rlf_region *regions; /* region_capacity */
    int32_t *points;     /* NULL = not kept */
    int32_t region_count, point_count;
} rlf_layer_out;

/* Segments one layer into regions with stable labels and their statistics. */
void rlf_layer_segment(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out);

/* Gives pixel i, which belongs to a piece too small to be a region, to the region around it: a foot
 * behind a table leg. Its label stays 0 when there is none. */
void rlf_region_adopt(const rlf_grid *grid, const float *depth, ptrdiff_t i, int32_t *label,
                      rlf_region *regions, int32_t count);

/* ---- region_track.c ---- */
/* Gives each region the label it had, by largest overlap, or a new one. `number` is the plane of
 * region numbers 1..out->region_count; writes regions[k].label. */
void rlf_region_track(rlf_reconstruct *stage, const rlf_layer_in *in, const int32_t *number,
                      rlf_layer_out *out);

/* ---- region_stats.c ---- */
typedef struct rlf_region_sum {
    double s[3], ss[6]; /* of points; xx xy xz yy yz zz */
} rlf_region_sum;
/* Rectangle, box, centroid, plane residual and point list of regions numbered in `number`. */
void rlf_region_measure(rlf_reconstruct *stage, const rlf_layer_in *in, const int32_t *number,
                        rlf_layer_out *out);

/* ---- background.c, background_average.c, background_adaptive.c ---- */
/* Updates the model with slot->depth and writes slot->foreground. */
void rlf_background_update(rlf_reconstruct *stage, rlf_slot *slot);
void rlf_background_average_update(rlf_reconstruct *stage, rlf_slot *slot);
void rlf_background_adaptive_update(rlf_reconstruct *stage, rlf_slot *slot);
/* Takes still foreground into the model, and back out; slot->foreground is finished. */
void rlf_background_absorb(rlf_reconstruct *stage, const rlf_slot *slot);
/* Makes a new sheet from the model: depth, normals, regions. */
void rlf_background_publish(rlf_reconstruct *stage);
void rlf_background_reset(rlf_background *background, int32_t count);

/* ---- velocity.c, thickness.c ---- */
void rlf_velocity_estimate(rlf_reconstruct *stage, rlf_slot *slot);
void rlf_thickness_estimate(rlf_reconstruct *stage, rlf_slot *slot);

#endif
