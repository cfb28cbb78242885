/* The steps of the surface stage, in the order in which they run. Each reads finished planes and
 * writes others; none allocates. */
#ifndef RLF_SURFACE_STEPS_H
#define RLF_SURFACE_STEPS_H

#include "kernel/batch.h"
#include "surface/stage.h"

/* ---- depth/frame.c: the steps in their order ---- */
/* `raw`: depth as it came; `kept`: without mixed pixels. */
void depth_read_frame(rlf_reconstruct *stage, const rlf_frame *frame, float *raw, float *kept,
                      uint8_t *reason);
/* Says where thin things must be though `kept` has nothing. */
void depth_track_thin(rlf_reconstruct *stage, const float *kept, const rlf_slot *slot);
/* In `kept` dropped pixels are recalled, and noise is averaged over time. */
void depth_average(rlf_reconstruct *stage, const float *raw, float *kept, uint8_t *reason);
/* Small holes of the slot's depth are filled. `was_seen`: 1 where there was a depth before. */
void depth_fill(rlf_reconstruct *stage, const rlf_frame *frame, const float *kept, rlf_slot *slot,
                uint8_t *was_seen);

/* ---- depth/temporal_recall.c: dropped pixels from memory; `depth` holds what was seen ---- */
/* Something has moved about pixel (x, y) lately, up to the frame before; false in the first frames,
 * which cannot tell, and always true without averaging over time. */
bool temporal_may_move(const rlf_reconstruct *stage, int32_t x, int32_t y);
/* The next pixels of row y, from x on, of which that is true; x0 = x1 when there are none. */
rlf_span temporal_next_moving(const rlf_reconstruct *stage, int32_t x, int32_t y);
/* `raw`: the depth as it came. Pixels that are not recalled but believed after all are OK again. */
void temporal_recall(const rlf_reconstruct *stage, const float *raw, float *depth, uint8_t *reason);

/* ---- depth/temporal_mean.c: depth that does not change is averaged over time ---- */
void temporal_mean(rlf_reconstruct *stage, float *depth, const uint8_t *reason);

/* ---- depth/oversmooth.c ---- */
/* Takes back where a plane has put pixels of `smooth` away from what was `seen` there and about
 * them, and their normals: in blocks that may move. */
void oversmooth_undo(const rlf_reconstruct *stage, const float *seen, float *smooth,
                     float *const normal[3]);

/* ---- depth/fill.c ---- */
/* Fills gaps of at most RLF_FILL_GAP pixels between valid ones of the slot's depth. What shows the
 * background takes its normal too, where planes have been fitted to the others. `was_seen`:
 * 1 where there was a depth before. */
void rlf_fill_holes(const rlf_reconstruct *stage, rlf_slot *slot, uint8_t *was_seen);

/* ---- normals/frame.c: the steps in their order ---- */
/* The slot's depth is `kept` with its noise averaged within planes, and has their normals. */
void normals_smooth(rlf_reconstruct *stage, const float *kept, rlf_slot *slot);
/* Normals at creases, of what no plane explains and of what was filled: contours and what is beside
 * them go on from sharp creases, not from blended ones. */
void normals_complete(rlf_reconstruct *stage, rlf_slot *slot, const uint8_t *was_seen);
/* Normals that need to know what moves, and all by the methods that fit no planes. */
void normals_finish(rlf_reconstruct *stage, const float *kept, rlf_slot *slot);

/* ---- normals/vote.c ---- */
bool vote_is_wanted(const rlf_reconstruct_def *def);
/* What frames agree on at pixel i; NULL = nothing. */
const rlf_vote *vote_at(const rlf_reconstruct *stage, ptrdiff_t i);
/* What follows is not called when normals.vote.votes is NULL. */
/* Counts this frame's votes. Normals of the background's pixels that vote become those that most
 * frames agree on, and so does the depth of those that were filled on another side. After
 * rlf_background_update. */
void vote_normals(const rlf_reconstruct *stage, const rlf_slot *slot);
/* The pixels from `first` on whose mark is not 0 vote from now on. */
void vote_watch(const rlf_reconstruct *stage, ptrdiff_t first, const uint8_t *marks, int32_t count);

/* ---- normals ---- */
typedef struct rlf_normals_job {
    rlf_normal_method method;
    bool face_camera;
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const float *filled;          /* depth with holes filled: they take normals from beside them;
                                     NULL = the same as depth */
    const rlf_depth_noise *noise; /* NULL = clean */
    const float *frames;          /* plane: of how many frames depth is the mean; NULL = of one */
    float lasting;                /* error of inverse depth that stays in any mean, 1/m */
    float *out[3];
    float *smooth; /* depth of the planes, when the method fits any; NULL = not wanted */
    rlf_pool *pool;
} rlf_normals_job;

/* With the stage's method, rays and noise. */
rlf_normals_job rlf_normals_job_make(const rlf_reconstruct *stage, const float *depth,
                                     float *const out[3]);
void rlf_normals_compute(const rlf_normals_job *job);
/* Six faces, four faces, and eq. 4.3. */
void rlf_normals_local(const rlf_normals_job *job);
void rlf_normals_slope(const rlf_normals_job *job);
void rlf_normals_plane(const rlf_normals_job *job);
/* The two halves of rlf_normals_plane: planes of what was seen, then normals of the other pixels of
 * `filled`. */
void rlf_normals_plane_fit(const rlf_normals_job *job);
void rlf_normals_plane_complete(const rlf_normals_job *job);
/* normals/wide.c: whether a sensor is so rough that it needs wider planes; the rays of a coarser
 * picture, from those of the one before, which is `width` wide; and after rlf_normals_plane_fit
 * planes from 20 and 40 pixels where they agree with its own, in job->out and job->smooth. */
bool rlf_wide_is_wanted(const rlf_reconstruct_def *def, const image_grid *grid);
void rlf_wide_fill_rays(const float *ray_x, const float *ray_y, int32_t width, rlf_wide *out);
void rlf_normals_widen(const rlf_reconstruct *stage, const rlf_normals_job *job);
/* normals/lasting.c: measures how much of the noise stays in the means over time. */
void rlf_lasting_measure(rlf_reconstruct *stage, const float *depth);
/* Exact inverse-depth normal of one pixel, for those that no plane explains. */
void rlf_normals_slope_pixel(const rlf_normals_job *job, int32_t x, int32_t y);

/* normals/contour.c: normals of pixels that were filled beside depth contours, and of seen ones
 * near contours of what moves; after rlf_fill_holes. `known`: 1 where depth was not filled. */
void rlf_normals_contour(const rlf_reconstruct *stage, const rlf_slot *slot, const uint8_t *known,
                         const contour_scratch *scratch);

/* Normals of seen and recalled pixels at creases, from the faces that meet there; after
 * rlf_fill_holes. */
void rlf_normals_crease(const rlf_reconstruct *stage, const rlf_slot *slot, const uint8_t *known);

/* ---- segment/segment.c ---- */
/* The member that stands for the set that a is in. */
int32_t rlf_component_root(int32_t *parent, int32_t a);
/* Connected components of the members of work.links, over their links, into work.runs; numbered
 * from 1 in raster order. work.size holds their pixel counts. `spans`: where the members of each
 * row are; NULL = anywhere. Returns their number. */
int32_t rlf_components_find(const rlf_reconstruct *stage, const rlf_span *spans);
/* Runs of equal numbers of a plane, into work.runs. */
void rlf_runs_find(rlf_reconstruct *stage, const int32_t *number);

/* Writes work.links from depth and (when not NULL) the members' mask, within the spans. */
void rlf_segment_links(const rlf_reconstruct *stage, rlf_segment_method method, const float *depth,
                       const uint8_t *mask, const rlf_span *spans);
/* Eq. 4.4: 1 where a pixel is valid and within tau of its right and lower neighbours. */
void rlf_segment_thesis_bits(const image_grid *grid, double tau, const float *depth,
                             const uint8_t *mask, uint8_t *bits);
/* Fig. 4.12: grows labels to the left and top over valid members without a label. */
void rlf_segment_dilate(const image_grid *grid, double tau, const float *depth, const uint8_t *mask,
                        int32_t *label);

/* ---- segment/region.c ---- */
/* Metres: chin and neck, arm and chest, a foot behind a table's leg are one person. In the
 * foreground, steps of a hand's breadth do not separate. */
#define RLF_PERSON_STEP_M 0.12f

typedef struct rlf_layer_in {
    rlf_layer layer;
    rlf_segment_method method;
    const float *depth;
    float *const *normal;          /* planes; OBJECTS only */
    int32_t steps_done;            /* OBJECTS: of rlf_objects_step, with this layer ... */
    int32_t *kept;                 /* ... and a plane that nobody else wrote meanwhile */
    const uint8_t *mask;           /* members; NULL = every valid pixel */
    const rlf_span *spans;         /* where they are; NULL = anywhere */
    bool has_components;           /* work.runs holds them already ... */
    int32_t component_count;       /* ... and so many */
    const int32_t *previous_label; /* labels of this layer one surface ago; NULL = none */
    const uint8_t *previous_mask;  /* where they count; NULL = everywhere */
    const rlf_region *previous;
    int32_t previous_count;
    int64_t elapsed_ns; /* since then */
} rlf_layer_in;

typedef struct rlf_layer_out {
    rlf_region *regions; /* region_capacity */
    int32_t *points;     /* NULL = not kept */
    int32_t region_count, point_count;
} rlf_layer_out;

/* Segments one layer into regions with stable labels and their statistics. Leaves work.runs with
 * the numbers 1..region_count of the regions, and < 0, one number for each, in pieces too small to
 * be one. */
void rlf_layer_segment(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out);

/* Gives pieces too small to be regions to the region around them: a foot behind a table leg. Those
 * that have none around them stay as they are. */
void rlf_region_adopt(rlf_reconstruct *stage, const float *depth, rlf_layer_out *out);

/* The region has a run of row y, too. */
void rlf_region_grow(rlf_region *region, const rlf_run *run, int32_t y);
/* Writes the regions' labels where the runs are. */
void rlf_region_write_labels(const rlf_reconstruct *stage, const rlf_layer_out *out,
                             int32_t *label);

/* ---- segment/region_track.c ---- */
/* Gives each region the label it had, by largest overlap; that of something hidden that it is a
 * part of; or a new one. */
void rlf_region_track(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out);

/* ---- segment/region_stats.c ---- */
typedef struct rlf_region_sum {
    rlf_region_lanes points;
    rlf_region_axes axes; /* from the longest to the shortest, from the centroid */
} rlf_region_sum;
/* Rectangle, boxes, centroid, plane residual and point list of the regions in work.runs. Its cost
 * is that of their pixels, whatever the number of regions. */
void rlf_region_measure(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out);
/* Whether it is a plane up to noise. */
bool rlf_region_is_flat(const rlf_reconstruct *stage, const rlf_region *region);

/* ---- background/sight.c ---- */
void rlf_sight_reset(rlf_sight *sight);
/* Of the frame that was read, before it changes the background. */
void rlf_sight_take(rlf_reconstruct *stage, const rlf_slot *slot);
/* ---- background/background.c, background/adaptive.c ---- */
/* Updates the model with slot->depth and writes slot->foreground. */
void rlf_background_update(rlf_reconstruct *stage, const float *kept, rlf_slot *slot);
void rlf_background_adaptive_update(rlf_reconstruct *stage, const float *kept, rlf_slot *slot);
/* 1 in slot->foreground where the 3x3 majority of `seen` is foreground, RLF_SEEN_UNKNOWN where it
 * is unknown; and the spans of that. */
void background_majority(rlf_reconstruct *stage, const rlf_slot *slot, uint8_t *seen);
/* Components of slot->foreground; those that are unknown are decided. */
void background_find_front(rlf_reconstruct *stage, const rlf_slot *slot);
/* ---- background/given.c ---- */
/* Asks for the room behind each pixel and writes slot->foreground. What is known of the frame
 * before is carried into this one's camera. */
void background_given_update(rlf_reconstruct *stage, rlf_slot *slot);
/* ---- motion/carry.c ---- */
/* stage->previous as the camera of this frame would have seen it: its foreground and regions. */
void motion_carry(rlf_reconstruct *stage, const rlf_pose *T_now_before);
/* ---- background/depart.c: what stood and starts to move; all do nothing without its planes ----
 */
/* The things of the background are those that thickness/static_pieces.c has just found. */
void rlf_depart_take(rlf_reconstruct *stage);
/* What has left and is seen is FOREGROUND in `seen`; its model follows it. */
void rlf_depart_follow(rlf_reconstruct *stage, const rlf_slot *slot, uint8_t *seen);
/* Makes foreground of things that start to move; after the 3x3 majority. */
void rlf_depart_find(rlf_reconstruct *stage, rlf_slot *slot);

/* background/unknown.c: pixels of slot->foreground that are RLF_SEEN_UNKNOWN become background
 * where they go on what is seen of it; the others are decided when work.runs holds the foreground's
 * components, stage->component_count of them. */
void rlf_background_reveal(rlf_reconstruct *stage, const rlf_slot *slot);
void rlf_background_decide_unknown(rlf_reconstruct *stage, const rlf_slot *slot);
/* background/hidden.c: pixels without depth that a thing hides become foreground and get its depth
 * and normal; learns which return nothing by themselves. While the background is learnt, that only.
 * Before the pixels of slot->foreground are linked. Leaves background.covered: RLF_COVERED where it
 * was done. */
enum { RLF_COVERED = 2 };
void rlf_background_cover(rlf_reconstruct *stage, const float *kept, const rlf_slot *slot,
                          bool is_learning);
/* How far from z counts as another depth, metres. */
float rlf_background_gate(const rlf_reconstruct_def *def, float z);
/* The model of pixel i is z from now on, as if so many samples had shown it. */
void background_put(rlf_reconstruct *stage, int32_t i, float z, uint8_t weight);
/* Nothing is in front. */
void background_clear_front(const rlf_reconstruct *stage, const rlf_slot *slot);
/* Where the first and the last foreground pixel of a row are. */
rlf_span rlf_background_span(const uint8_t *foreground, int32_t width);
void rlf_background_reset(rlf_background *background, const image_grid *grid);
/* Depth and those of the frames before it show another room than the model. */
bool rlf_background_is_cut(rlf_reconstruct *stage, const float *depth);

/* ---- background/image.c ---- */
/* Tiles of a grid, the last of a row or column cut short. */
static inline int32_t background_image_tiles(const image_grid *grid)
{
    return ((grid->width + BACKGROUND_TILE - 1) / BACKGROUND_TILE) *
           ((grid->height + BACKGROUND_TILE - 1) / BACKGROUND_TILE);
}
size_t background_image_crop_size(void);
/* Pixels of the tile at (x, y) were replaced. */
void background_image_changed(rlf_background *background, const image_grid *grid, int32_t x,
                              int32_t y, int32_t count);
/* The image that surfaces refer to; NULL while the background is being learnt. */
const background_image *background_image_newest(const rlf_reconstruct *stage);
/* Makes a new image from the model: depth, normals, regions; at once, or when it is due a part of
 * it per frame. Where `slot`, which may be NULL, shows the background, edges are as sharp as there.
 */
void background_image_publish(rlf_reconstruct *stage, const rlf_slot *slot);
void background_image_advance(rlf_reconstruct *stage, const rlf_slot *slot);

/* ---- motion/rigid.c, thickness/thickness.c ---- */
void rlf_velocity_estimate(rlf_reconstruct *stage, rlf_slot *slot);
/* `raw`: depth as the sensor gave it. */
void rlf_thickness_estimate(rlf_reconstruct *stage, rlf_slot *slot, const float *raw);

/* ---- segment/frame.c ---- */
/* Labels and regions of both layers of the slot. */
void segment_frame(rlf_reconstruct *stage, rlf_slot *slot);

/* ---- publish.c ---- */
/* The part of the surface that is known when depth and normals are. */
void surface_publish_seen(const rlf_reconstruct *stage, rlf_slot *slot);
void surface_publish(rlf_reconstruct *stage, const rlf_frame *frame, rlf_slot *slot);

#endif
