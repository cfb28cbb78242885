/* A frame as points: means of 2 x 2 depth pixels that lie on one surface, at every fourth pixel. */
#ifndef RLF_TRACK_POINTS_H
#define RLF_TRACK_POINTS_H

#include "relief/track.h"

/* Planes of width x height points; z = 0 where there is none. */
typedef struct track_points {
    int32_t width, height;
    float *x, *y, *z; /* metres, the frame's camera */
    float *sigma;     /* of z, metres: of the mean */
    uint8_t *grey;    /* 0 = none */
} track_points;

/* Fills row `row` of the points from rows 4 row + 1 and 4 row + 2 of the view; ray_x, ray_y are the
 * depth camera's tables. */
void track_points_row(const track_points *points, const rlf_rig *rig, const float *ray_x,
                      const float *ray_y, const rlf_track_view *view, int32_t row);

#endif
