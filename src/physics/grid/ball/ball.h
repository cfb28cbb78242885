/* A ball against a layer: the door to this folder.
 *
 * Every pixel says when the moving ball would reach it; the earliest of each direction is a touch.
 * About a touch the pixels give the plane that the ball meets, or the end of its face. */
#ifndef RLF_PHYSICS_GRID_BALL_BALL_H
#define RLF_PHYSICS_GRID_BALL_BALL_H

#include "physics/grid/job.h"

/* ---- patch.c: the pixels about the place where a ball touches a sheet. */

#define PATCH_PX 6 /* a patch has at most 2 x 6 + 1 samples a side */
#define PATCH_SIDE (2 * PATCH_PX + 1)

/* A pixel of the patch: its point on the touched face when the ball is there, its distance. */
typedef struct patch_sample {
    field_cell cell;
    rlf_vec3 point;
    double distance; /* of the point to the ball's surface */
} patch_sample;

typedef struct grid_patch {
    const grid_job *job;
    grid_face face;
    int32_t x, y, step;
    double time;
    rlf_vec3 centre;                        /* the ball's, at that time */
    int32_t index[PATCH_SIDE * PATCH_SIDE]; /* row by row: sample + 1, 0 = none */
    patch_sample samples[PATCH_SIDE * PATCH_SIDE];
    int32_t count, nearest;
} grid_patch;

/* What the weighted pixels of a patch say. */
typedef struct patch_mean {
    rlf_vec3 point, normal, velocity;
} patch_mean;

/* Whether a pixel's normal is that of the face, up to noise and its curvature. */
static inline bool patch_is_of_face(rlf_vec3 normal, rlf_vec3 face)
{
    return rlf_dot(normal, face) > NOISY_FACE_COS;
}

/* Distance beyond the nearest pixel's at which a pixel's weight has fallen to 0: some sigma. */
double patch_band(double z);

/* The ball's centre, `time` from now; now, if that is below 0. */
rlf_vec3 patch_centre_at(const grid_job *job, double time);

/* How thick a background is was never seen: no thicker than wide (a table's leg). */
void patch_limit_thickness(const grid_job *job, field_cell *cell);

/* The back behind p, a point of the cell's front. */
rlf_vec3 patch_back_of(const field_cell *cell, rlf_vec3 p);

/* Fills centre, index, samples, count and nearest (-1: no sample) for the other members. */
void patch_read(grid_patch *p);

/* How much a sample of the patch counts: the less, the farther it is from the ball, and nothing
 * where it is of another face. */
double patch_weight(const grid_patch *p, const patch_sample *s);

/* Weighted means over the pixels near the ball. */
patch_mean patch_mean_of(const grid_patch *p);

/* Replaces the mean of a patch by the plane at the place that the ball touches, as far as the face
 * bends each way: a limb across itself, and hardly along it. */
void patch_correct_bulge(const grid_patch *p, patch_mean *mean);

/* The point of the face under the ball's centre. */
rlf_vec3 patch_foot(const grid_patch *p, const patch_mean *mean);

/* A plane in a patch's points: normals beside an edge are means over both of its faces. */
typedef struct patch_plane {
    rlf_vec3 normal, point;
    double support; /* samples on it */
} patch_plane;

/* The plane that passes q no farther off than `near` metres and holds most samples, of those that
 * bend away from all `count` normals of `others`. False when too few samples say. */
bool plane_find(const grid_patch *p, rlf_vec3 q, double near, const rlf_vec3 *others, int32_t count,
                patch_plane *out);

/* Whether the sample is on the plane, up to noise. */
bool plane_holds(const patch_plane *plane, const patch_sample *s);

/* ---- corner.c: where a face ends that a ball all but touches and another seen face begins: at
 * an edge or a corner. */

#define CORNER_FACES 3

/* The solid behind all of these planes. */
typedef struct patch_corner {
    patch_plane faces[CORNER_FACES];
    int32_t count;
} patch_corner;

/* The faces of a patch that bend away from its face, where the place of their solid that is nearest
 * to the ball is seen. False where there are none, or where that place is on no seen face. */
bool corner_find(const grid_patch *p, const patch_mean *face, patch_corner *out);

/* The place of the solid that is nearest to `centre`, which is outside. */
rlf_vec3 corner_nearest(const patch_corner *corner, rlf_vec3 centre);

/* ---- ball.c: the search. */

/* Cosine: a face is touched from its own side, up to noise. */
#define GRID_BALL_BEHIND (-0.2)

/* Seconds until the ball, `wider` than it is, reaches p, which moves with `velocity`; below 0 for a
 * point that is inside already, the deeper the less. False when that is not before the next query.
 */
bool grid_ball_time(const grid_job *job, rlf_vec3 p, rlf_vec3 velocity, double wider, double *out);

/* Whether the cell's back at p can push a ball in that direction: one that is a guess faces away
 * from the camera, for what faces it is seen. (Behind a side that is seen at a low angle the back
 * of the guess would stand in the solid's own front.) */
bool grid_ball_may_meet_back(const field_cell *cell, rlf_vec3 p, rlf_vec3 direction);

/* Notes the pixel, at p now, when the ball comes to its front or back before the next query. */
void grid_ball_look(grid_job *job, const field_cell *cell, rlf_vec3 p);

/* The same for the pixel of a flat tile that is nearest to the ball's way. */
void grid_ball_look_tile(grid_job *job, const grid_tile *tile);

/* The same for the side wall behind a contour's pixel, which goes inward by `deep`, metres of
 * thickness. */
void grid_ball_look_contour(grid_job *job, const field_cell *cell, rlf_vec3 shift, double deep);

/* Turns what was noted into hits. */
void grid_ball_add_hits(grid_job *job);

#endif
