/* Thin flat things that move, a book in a hand: each a box that is followed from frame to frame.
 *
 * What a plate shows when its face is turned to the camera, its extent, is not to be seen when it
 * is held edge-on, and then it is what says where a ray leaves it. So a flat patch with an outline
 * (plate/find.c) becomes a box, whose place, rotation and extents are fitted to every further frame
 * (plate/fit.c): its seen faces to depth, its outline to where depth steps (Harris's RAPID tracker,
 * 1990). It is an extended Kalman filter that moves at a constant velocity. */
#ifndef RLF_SURFACE_PLATE_PLATE_H
#define RLF_SURFACE_PLATE_PLATE_H

#include "surface/stage.h"

enum { RLF_PLATE_UNKNOWNS = 9 };

/* A box as the camera sees it. */
typedef struct rlf_plate_view {
    rlf_vec3 centre, axis[3]; /* camera frame */
    double half[3];
} rlf_plate_view;

/* Where a ray goes through a box: depths, and the face where it enters it. */
typedef struct rlf_plate_cut {
    double enter, leave;
    int32_t face; /* axis */
    double sign;  /* of that axis */
} rlf_plate_cut;

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct rlf_plate_window {
    int32_t x0, y0, x1, y1;
} rlf_plate_window;

/* ---- plate/box.c ---- */
rlf_plate_view rlf_plate_look(const rlf_plate *plate);
/* False when the ray (x, y, 1) misses it. */
bool rlf_plate_cut_ray(const rlf_plate_view *view, double x, double y, rlf_plate_cut *out);
/* Where p is in the box's own axes. */
rlf_vec3 rlf_plate_local(const rlf_plate_view *view, rlf_vec3 p);
/* Whether p is in the box or less than so many metres from it. */
bool rlf_plate_is_near(const rlf_plate_view *view, rlf_vec3 p, double metres);
/* The pixels that it covers and `margin` around; none when part of it is beside or behind the
 * camera. */
rlf_plate_window rlf_plate_window_of(const rlf_grid *grid, const rlf_plate_view *view,
                                     int32_t margin);
/* Of at most so many of its pixels, those of every stride-th row and column are looked at. */
int32_t rlf_plate_stride(const rlf_plate_window *window, int32_t most);

/* ---- plate/fit.c ---- */
typedef struct rlf_plate_fit {
    int32_t faces, outline; /* measurements that agree: pixels, and places along the outline */
    int32_t places;         /* of the outline that were looked at */
} rlf_plate_fit;

/* Improves the plate by a frame of depth as the sensor gave it. */
rlf_plate_fit rlf_plate_improve(const rlf_reconstruct *stage, const float *depth, rlf_plate *plate);

/* ---- plate/plate.c ---- */
/* Follows the plates to the frame whose depth is given. */
void rlf_plates_follow(rlf_reconstruct *stage, const rlf_slot *slot, const float *depth);

/* ---- plate/find.c ---- */
/* Finds flat things in the foreground that are no plates yet. */
void rlf_plates_find(rlf_reconstruct *stage, const rlf_slot *slot);

/* ---- plate/write.c ---- */
/* Tells past.h where a plate must be though `depth` has nothing there. */
void rlf_plates_expect(rlf_reconstruct *stage, const float *depth);
/* Makes the pixels of the plates as thick as these are there and, edge-on, as fast. */
void rlf_plates_write(const rlf_reconstruct *stage, rlf_slot *slot);

#endif
