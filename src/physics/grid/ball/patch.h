/* The pixels about the place where a ball touches a sheet. */
#ifndef RLF_PHYSICS_GRID_BALL_PATCH_H
#define RLF_PHYSICS_GRID_BALL_PATCH_H

#include "physics/grid/job.h"

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

#endif
