/* The legs of people, each a chain of solids that is followed from frame to frame.
 *
 * Of a person seen from the side the near leg hides the far one, and of one seen from the front
 * each foot hides its heel. But where a leg is now follows from where it was, how long its bones
 * are, and where the hips of the torso above are (thickness/torso.h). So a thigh, a shin and a foot
 * hang below each hip: capsules whose joints are fitted to every frame's points
 * (thickness/legs_fit.c), an extended Kalman filter for each leg. What hides a leg does not move
 * it: it goes on as it did, and is less and less sure.
 *
 * Places are in the torso's own axes (rlf_torso_place): x to the side, y down, z ahead. */
#ifndef RLF_SURFACE_THICKNESS_LEGS_H
#define RLF_SURFACE_THICKNESS_LEGS_H

#include "surface/thickness/torso.h"

/* A capsule whose radius changes evenly along it. */
typedef struct rlf_leg_part {
    rlf_vec3 begin, end;
    double radius[2];
} rlf_leg_part;

typedef struct rlf_leg_shape {
    rlf_leg_part part[RLF_LEG_PARTS];
} rlf_leg_shape;

/* ---- thickness/legs_solid.c ---- */
/* A leg that stands, side -1 or 1, and the variance of each unknown among people and their ways. */
void rlf_leg_usual(const rlf_torso *torso, double side, double unknown[RLF_LEG_UNKNOWNS],
                   double variance[RLF_LEG_UNKNOWNS]);
rlf_leg_shape rlf_leg_shape_of(const rlf_torso *torso, int leg);
/* Both legs' axes, and the camera in the torso's axes. */
rlf_kernel_legs rlf_legs_of(const rlf_leg_shape shape[2], rlf_vec3 camera);
/* How much longer thigh and shin are than usual, of the spread among people: two touches. */
void rlf_leg_stretch(const rlf_leg_shape *shape, rlf_kernel_touches *out);

/* The part, as rays from the camera cut it. */
rlf_kernel_limb rlf_leg_limb(const rlf_leg_part *part, rlf_vec3 camera);

/* ---- thickness/legs_fit.c ---- */
/* Follows both legs below a torso, dt s after the last frame, or looks for them. Points are places
 * of what is seen below the crotch. */
void rlf_legs_follow(rlf_torso *torso, const rlf_torso_points *points, double dt);

#endif
