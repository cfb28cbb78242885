/* A slab: a thin flat thing that moves, a book in a hand, as a box that is followed.
 *
 * What it shows when its face is turned to the camera, its extent, is not to be seen when it is
 * held edge-on, and then it is what says where a ray leaves it. So a flat patch with an outline
 * (find.c) becomes a box, whose place, rotation and extents are fitted to every further frame
 * (fit.c): its seen faces to depth, its outline to where depth steps (Harris's RAPID tracker,
 * 1990). It is an extended Kalman filter that moves at a constant velocity (track.c). */
#ifndef RLF_SURFACE_THIN_SLAB_H
#define RLF_SURFACE_THIN_SLAB_H

#include "surface/thin/thin.h"

/* A box as the camera sees it. */
typedef struct slab_view {
    rlf_vec3 centre, axis[3]; /* camera frame */
    double half[3];
} slab_view;

/* A point as the box has it. */
typedef struct slab_point {
    double q[3];      /* in its own axes, metres */
    double beyond[3]; /* of its extents, metres */
    double facing[3]; /* cosines of the view's direction and the axes */
    double square;    /* of the distance to it */
} slab_point;

/* ---- box.c ---- */
slab_view slab_look(const slab *s);
/* Depths at which the ray (x, y, 1) enters and leaves it; false when it misses it. */
bool slab_cut_ray(const slab_view *view, double x, double y, double *enter, double *leave);
/* All but `facing`, which is 0. */
slab_point slab_local(const slab_view *view, rlf_vec3 p);
/* Whether p is in the box or less than so many metres from it. */
bool slab_is_near(const slab_view *view, rlf_vec3 p, double metres);
/* The pixels that it covers and `margin` around; none when part of it is beside or behind the
 * camera. */
rlf_rect slab_window(const image_grid *grid, const slab_view *view, int32_t margin);
/* Of at most so many of its pixels, those of every stride-th row and column are looked at. */
int32_t slab_stride(const rlf_rect *window, int32_t most);

/* ---- fit.c ---- */
typedef struct slab_fit {
    int32_t faces, outline; /* measurements that agree: pixels, and places along the outline */
    int32_t places;         /* of the outline that were looked at */
} slab_fit;

/* Improves the slab by a frame of depth as the sensor gave it. */
slab_fit slab_improve(const thin_in *in, slab *s);

/* ---- find.c ---- */
/* Finds flat things in the foreground of the frame before that are no slabs yet. */
void slab_find(const thin_in *in, thin *state);

#endif
