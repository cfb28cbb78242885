/* Inside a pipeline: what the frame loop and its picture share. */
#ifndef RLF_PIPELINE_STATE_H
#define RLF_PIPELINE_STATE_H

#include "relief/pipeline.h"
#include "relief/source.h"

#include "pipeline/far_side.h"
#include "pipeline/hands.h"
#include "pipeline/known.h"
#include "pipeline/moving/moving.h"
#include "pipeline/moving/room_view.h"

/* Where the camera is: it stands, or it moves. */
typedef struct camera {
    rlf_pose T_world; /* of the newest frame */
    rlf_pose T_stood; /* where it stands, or stood last */
    bool has_stood;   /* the standing camera's stage remembers what it saw from there */
    moving moving;
    bool may_change;       /* it may begin to move, and stand again */
    float *still;          /* AUTO: two planes, the background of a standing camera; else NULL */
    float *room;           /* AUTO: a plane, what a camera that stands again begins with */
    int64_t still_ns[2];   /* when each was kept */
    int32_t still_count;   /* so often one was; they take turns */
    rlf_pose T_source;     /* what the source said when the camera began to stand, */
    bool has_source;       /* if it said anything */
    bool is_prepared;      /* `moving` has seen the first frame, in case that it moves */
    bool has_told;         /* that it moves, though it is to stand */
    bool was_placed;       /* at any time */
    bool rests;            /* while it moves: its view is as it was, since then: */
    int64_t rest_ns;       /* the time, and */
    rlf_pose T_rest;       /* where that was */
    int32_t before_frames; /* in a row that show what it saw where it stood last */
    int32_t taught_frames; /* of the room, to the standing camera's stage */
} camera;

/* Frames that are pushed: a source with room for one frame. */
typedef struct pushed_frame {
    rlf_source *source; /* gives `frame` once; NULL = the pipeline has a source of the caller's */
    rlf_frame frame;
    bool is_full;
} pushed_frame;

/* `slot` stays where it is until pushed_frame_close. */
rlf_result pushed_frame_open(pushed_frame *slot, const rlf_rig *rig);
/* The next frame; NULL = none. */
void pushed_frame_put(pushed_frame *slot, const rlf_frame *frame);
void pushed_frame_close(pushed_frame *slot);

#define OVERLAY_LINES_MAX 32
#define OVERLAY_LINE_SIZE 128
#define PLOT_FRAMES 120
#define PLOT_STAGES 4
#define PLOT_LINE_MS 33.3f /* a camera's frame */

struct rlf_pipeline {
    rlf_pipeline_def def;
    pushed_frame pushed;
    rlf_scene scene;              /* copy; hulls stay the caller's */
    rlf_reconstruct *reconstruct; /* of a camera that stands */
    camera camera;
    rlf_world *world; /* of `joined` when this one joined another */
    struct rlf_pipeline *joined, *others[RLF_WORLD_CAMERAS_MAX]; /* that joined this one, by camera;
                                                                    [0] is not used */
    rlf_grid grid; /* of its newest surface; of one that joined while has_grid */
    bool has_grid;
    double asked_s; /* when it was asked for a frame last, in the first one's time */
    int32_t index;  /* of its camera in the world */
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

    bool has_room;          /* a frame has shown depth */
    bool is_blind;          /* the newest frame has not, ... */
    bool has_told_blind;    /* ... which is told, */
    int64_t blind_since_ns; /* since then */
    int32_t gravity_frames; /* that are still asked which way is up */
    int64_t frame_index;    /* of the next frame */
    int64_t first_time_ns, last_time_ns;
    rlf_pipeline_output last;
};

/* picture.c: p->last.render from the rest of p->last; nothing when the pipeline draws nothing. */
rlf_result pipeline_draw(rlf_pipeline *p);
/* create.c: the scene's bodies, into a world without any. */
rlf_result pipeline_add_bodies(rlf_pipeline *p);
/* camera.c: as at the first frame; the camera stands or moves, as the def says. */
rlf_result camera_start(rlf_pipeline *p);
/* The surface of p->last.frame, and from where it was seen: p->camera.T_world and p->last. */
rlf_result camera_see(rlf_pipeline *p, const rlf_surface **out);
void camera_stop(rlf_pipeline *p);
/* stand_again.c: after a frame of a moving camera, whose surface is *s. From the next frame on it
 * stands when it has rested for 2 s, or when it is not sure where it is and sees what it saw before
 * it moved. */
rlf_result camera_stand_again(rlf_pipeline *p, const rlf_surface *s);
/* Nobody knows where it is; when its view rests that is waited for less than a second. */
bool camera_is_waited_for(const camera *c, int64_t now_ns);
/* One more frame in the plot, from p->last.times. */
void pipeline_note_times(rlf_pipeline *p);

#endif
