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

/* What is unknown of a leg: places of its joints, metres; how far the foot is turned from ahead,
 * radians; its radii at hip, knee and ankle, and how far the hip is ahead of the trunk's axis,
 * metres. */
enum {
    RLF_LEG_KNEE = 0,
    RLF_LEG_ANKLE = 3,
    RLF_LEG_TOES = 6,
    RLF_LEG_RADIUS = 7,
    RLF_LEG_HIP = 10
};

enum { RLF_THIGH, RLF_SHIN, RLF_FOOT, RLF_LEG_PARTS };

/* A capsule whose radius changes evenly along it. */
typedef struct rlf_leg_part {
    rlf_vec3 begin, end;
    double radius[2];
} rlf_leg_part;

typedef struct rlf_leg_shape {
    rlf_leg_part part[RLF_LEG_PARTS];
} rlf_leg_shape;

/* How far something is off, and how that changes with each unknown. */
typedef struct rlf_leg_touch {
    double distance, slope[RLF_LEG_UNKNOWNS];
} rlf_leg_touch;

/* ---- thickness/legs_solid.c ---- */
/* A leg that stands, side -1 or 1, and the variance of each unknown among people and their ways. */
void rlf_leg_usual(const rlf_torso *torso, double side, double unknown[RLF_LEG_UNKNOWNS],
                   double variance[RLF_LEG_UNKNOWNS]);
rlf_leg_shape rlf_leg_shape_of(const rlf_torso *torso, int leg);
/* From up to RLF_KERNEL_RAYS places to the nearest of the parts of both legs; out->axis counts
 * them: part, and RLF_LEG_PARTS more for the second leg's. */
void rlf_legs_nearest(const rlf_leg_shape shape[2], const rlf_vec3 *p, int32_t count,
                      rlf_kernel_nearest *out);
/* From a place to one part, metres, less than 0 within. */
rlf_leg_touch rlf_leg_touch_at(const rlf_leg_shape *shape, int part, rlf_vec3 p, rlf_vec3 camera);
/* The place on the camera's ray through p that is nearest to the part's axis; p where the camera
 * looks along that. */
rlf_vec3 rlf_leg_beside(const rlf_leg_part *part, rlf_vec3 p, rlf_vec3 camera);
/* How much longer thigh or shin is than usual, of the spread among people. */
rlf_leg_touch rlf_leg_stretch(const rlf_leg_shape *shape, int part);

/* The part, as rays from the camera cut it. */
rlf_kernel_limb rlf_leg_limb(const rlf_leg_part *part, rlf_vec3 camera);

/* ---- thickness/legs_fit.c ---- */
/* Follows both legs below a torso, dt s after the last frame, or looks for them. Points are places
 * of what is seen below the crotch. */
void rlf_legs_follow(rlf_torso *torso, const rlf_torso_points *points, double dt);

#endif
