/* Inside of a tracker: a frame as points, what they say of a small motion, and its memory. */
#ifndef RLF_TRACK_TRACKER_H
#define RLF_TRACK_TRACKER_H

#include "base/arena.h"
#include "relief/track.h"

/* A frame as points: means of 2 x 2 depth pixels that lie on one surface, at every fourth pixel.
 * Planes of width x height points; z = 0 where there is none. */
typedef struct track_points {
    int32_t width, height;
    float *x, *y, *z; /* metres, the frame's camera */
    float *sigma;     /* of z, metres: of the mean */
    uint8_t *grey;    /* 0 = none */
} track_points;

#define TRACK_KEYFRAMES 256 /* at most */
#define TRACK_THUMB_WIDTH 32
#define TRACK_THUMB_HEIGHT 24
#define TRACK_THUMB (TRACK_THUMB_WIDTH * TRACK_THUMB_HEIGHT)

/* A view in little: means of blocks; 0 = none. */
typedef struct track_thumbnail {
    float depth[TRACK_THUMB]; /* metres */
    float grey[TRACK_THUMB];
} track_thumbnail;

typedef struct track_keyframe {
    track_thumbnail view;
    rlf_pose T_world_camera;
} track_keyframe;

struct rlf_tracker {
    rlf_tracker_def def;
    rlf_arena arena;
    float *ray_x, *ray_y;
    track_points points;
    float *plane_error; /* of the prediction: a pixel each, at most as many as the rig's */
    track_keyframe *keyframes;
    int32_t keyframe_count;
    /* The last two poses that were not lost. */
    rlf_pose pose, before;
    int64_t time_ns, before_ns;
    int32_t pose_count; /* 0, 1 or 2 of them are known */
};

/* ---- normal_equations.c */
/* Residuals over their expected deviation are counted in bins of 1 / TRACK_BINS_PER_SIGMA. */
#define TRACK_BINS 128
#define TRACK_BINS_PER_SIGMA 8

/* What a kind of measurement says of rotation vector, then translation, in the prediction's frame:
 * lower triangle by rows; right side. */
typedef struct track_equations {
    double a[21], b[6];
} track_equations;

static inline double track_entry(const double a[21], int row, int column)
{
    return row > column ? a[row * (row + 1) / 2 + column] : a[column * (column + 1) / 2 + row];
}

/* Sums over points, of which those in double precision are summed as one array. */
typedef struct track_sums {
    track_equations depth, grey;
    double information;                /* sum of the weights */
    double squared;                    /* of weighted residuals over their deviation */
    double weight;                     /* sum of the robust weights */
    double grey_residual, grey_weight; /* sums: the pictures' mean difference, levels */
    int32_t tried;   /* points of the frame that fall on a known part of the prediction, or
                        into its picture where nothing is known */
    int32_t matched; /* points within the gate */
    int32_t bins[TRACK_BINS];
} track_sums;

/* How points count. */
typedef struct track_gate {
    double metres;  /* farther ones do not count */
    double cut;     /* Tukey's limit, in expected deviations */
    double grey;    /* levels by which the prediction is brighter than the frame */
    bool asks_grey; /* whether brightness is summed */
} track_gate;

/* How far a prediction may be off its plane where a point is compared with it, metres: half of what
 * its neighbours in a row and in a column are off, the nearer ones, since the point is at most half
 * a pixel away; at most half a pixel's width. An outline has the normal of a rim that is not there,
 * and would tell the camera's way along a wall from that. */
void track_find_plane_error(const rlf_prediction *prediction, float *error);

/* Of every `stride`-th point of every `stride`-th row. T: the frame's camera to the prediction's.
 */
track_sums track_sums_of(const track_points *points, int32_t stride,
                         const rlf_prediction *prediction, const float *plane_error,
                         const rlf_pose *T, const track_gate *gate);

/* ---- keyframes.c */
/* Of planes of width x height; grey may be NULL. */
void track_thumbnail_make(int32_t width, int32_t height, const float *plane, const uint8_t *luma,
                          track_thumbnail *out);
/* How unlike two thumbnails are where b, moved by (dx, dy) cells, lies on a: 0 = alike; 1 where
 * they have nothing in common. */
double track_thumbnail_difference(const track_thumbnail *a, const track_thumbnail *b, int32_t dx,
                                  int32_t dy);

#endif
