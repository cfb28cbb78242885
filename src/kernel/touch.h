/* How far places are off solids of people, and the normal equations of that: see
 * surface/thickness/torso_fit.c and legs_fit.c. Doubles, metres; every clone gives the same bits.
 * Axes are those of a torso: to the side, downwards, ahead. */
#ifndef RLF_KERNEL_TOUCH_H
#define RLF_KERNEL_TOUCH_H

#include "kernel/solid.h"

/* What is unknown of a torso, metres and radians. `side` is the level unit vector from its axis to
 * a shoulder, `ahead` the one at a right angle to it. */
enum {
    RLF_TORSO_AHEAD,    /* of the head's middle: where the axis is at the shoulders */
    RLF_TORSO_TURN,     /* about the upright axis, from `side` */
    RLF_TORSO_LEAN,     /* ahead, per metre further down */
    RLF_TORSO_SHOULDER, /* from the axis to the middle of a shoulder's round end */
    RLF_TORSO_DROP,     /* how much lower than usual the trunk hangs below the head's top */
    RLF_TORSO_BREADTH,  /* half of it at chest, waist and buttocks */
    RLF_TORSO_DEPTH = RLF_TORSO_BREADTH + RLF_KERNEL_SECTIONS, /* the same */
    RLF_TORSO_UNKNOWNS = RLF_TORSO_DEPTH + RLF_KERNEL_SECTIONS
};

/* What is unknown of a leg: places of its joints, metres; how far the foot is turned from ahead,
 * radians; its radii at hip, knee and ankle, and how far the hip is ahead of the trunk's axis,
 * metres. */
enum {
    RLF_LEG_KNEE = 0,
    RLF_LEG_ANKLE = 3,
    RLF_LEG_TOES = 6,
    RLF_LEG_RADIUS = 7,
    RLF_LEG_HIP = 10,
    RLF_LEG_UNKNOWNS
};

/* The parts of a leg are axes that follow each other, in this order. */
enum { RLF_THIGH, RLF_SHIN, RLF_FOOT, RLF_LEG_PARTS };

/* As many unknowns as a torso or a leg has, and columns for whole lanes of them. */
enum { RLF_KERNEL_SLOPES = 11, RLF_KERNEL_SLOPE_COLUMNS = 16 };

/* How far each place is off a surface, less than 0 within, and how that changes with each unknown;
 * both 0 where it is at no height of the solid, and `is_any` then. */
typedef struct rlf_kernel_touches {
    double distance[RLF_KERNEL_RAYS], is_any[RLF_KERNEL_RAYS];
    double slope[RLF_KERNEL_SLOPES][RLF_KERNEL_RAYS];
} rlf_kernel_touches;

/* Of the correction x: J x = -distance. What is right of the diagonal is of no use. */
typedef struct rlf_kernel_equations {
    double a[RLF_KERNEL_SLOPES][RLF_KERNEL_SLOPE_COLUMNS], b[RLF_KERNEL_SLOPE_COLUMNS];
} rlf_kernel_equations;

/* A trunk and the bar of its shoulders. */
typedef struct rlf_kernel_torso {
    rlf_kernel_trunk trunk;
    rlf_kernel_bar bar;
    double bar_top, bar_bottom; /* downwards from the origin: where places may be the bar's */
    double deepest;             /* a place within the trunk is no farther off than that */
} rlf_kernel_torso;

/* The axes of both legs, of RLF_LEG_PARTS each. */
typedef struct rlf_kernel_legs {
    rlf_kernel_axis axis[2 * RLF_LEG_PARTS];
    double unit[2 * RLF_LEG_PARTS][3]; /* along them */
    double camera[3];
    double heel, length; /* of a foot's axis: behind the ankle; of all */
    double behind;       /* cosine beyond which a side is turned from the camera */
    double least_aslant; /* squared sine between an axis and a ray beside it */
} rlf_kernel_legs;

/* Sampson's distance from the trunk's level ellipses, or that from the bar where it is less. */
void rlf_kernel_touch_torso(const rlf_kernel_torso *torso, const rlf_kernel_places *places,
                            rlf_kernel_touches *restrict out);
/* Moves places along their rays from the camera to where these are nearest to the middle of the
 * trunk's section, in axes in which that is a circle; by `by` times their ways from there. */
void rlf_kernel_trunk_beside(const rlf_kernel_trunk *trunk, const double camera[3],
                             rlf_kernel_places *restrict places, double *restrict by);
/* From the axis that is told for each place. */
void rlf_kernel_touch_legs(const rlf_kernel_legs *legs, const rlf_kernel_places *places,
                           const double *restrict axis, rlf_kernel_touches *restrict out);
/* Moves places along their rays from the camera to where these are nearest to the axis that is told
 * for each, unless the camera looks along that. */
void rlf_kernel_legs_beside(const rlf_kernel_legs *legs, const double *restrict axis,
                            rlf_kernel_places *restrict places);
/* Adds the first `count` touches in their order, each so many times. */
void rlf_kernel_add_touches(const rlf_kernel_touches *touches, const double *restrict weight,
                            int32_t count, rlf_kernel_equations *restrict sum);

#endif
