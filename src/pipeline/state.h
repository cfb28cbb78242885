/* Inside a pipeline: what the frame loop and its picture share. */
#ifndef RLF_PIPELINE_STATE_H
#define RLF_PIPELINE_STATE_H

#include "relief/pipeline.h"

#include "pipeline/far_side.h"
#include "pipeline/hands.h"
#include "pipeline/known.h"
#include "pipeline/room_view.h"

#define OVERLAY_LINES_MAX 32
#define OVERLAY_LINE_SIZE 128
#define PLOT_FRAMES 120
#define PLOT_STAGES 4
#define PLOT_LINE_MS 33.3f /* a camera's frame */

struct rlf_pipeline {
    rlf_pipeline_def def;
    rlf_scene scene; /* copy; hulls stay the caller's */
    rlf_reconstruct *reconstruct;
    rlf_world *world;
    known_models known;
    rlf_compositor *compositor;
    rlf_compositor_def compositor_def;
    float *ray_x, *ray_y; /* rays of the grid, for the compositor */
    rlf_grid_region *regions;
    int32_t region_capacity;
    far_side far;
    hand_stage hands;
    room_view room;

    rlf_view views[RLF_PIPELINE_VIEWS];
    int32_t view_count;
    rlf_image_rgba8 sheet; /* several views side by side */
    rlf_orbit orbit;
    bool shows_plot, shows_legend;
    float plot_values[PLOT_FRAMES * PLOT_STAGES]; /* ms, the oldest first */
    int32_t plot_count;                           /* frames */
    char overlay[OVERLAY_LINES_MAX][OVERLAY_LINE_SIZE];
    const char *overlay_lines[OVERLAY_LINES_MAX];
    int32_t overlay_count;

    int32_t gravity_frames; /* that are still asked which way is up */
    bool has_moved;         /* the camera, and that was told */
    int64_t frame_index;    /* of the next frame */
    int64_t first_time_ns, last_time_ns;
    rlf_pipeline_output last;
};

/* picture.c: takes over what the frame's prediction of the room says, before a view needs another.
 * Once a frame, when its pose is known. */
rlf_result pipeline_see_room(rlf_pipeline *p);
/* picture.c: p->last.render from the rest of p->last; nothing when the pipeline draws nothing. */
rlf_result pipeline_draw(rlf_pipeline *p);
/* One more frame in the plot, from p->last.times. */
void pipeline_note_times(rlf_pipeline *p);

#endif
