/* A ball in the true synthetic scene: what a thrown ball would have done. */
#ifndef RELIEF_APP_EVAL_BALL_H
#define RELIEF_APP_EVAL_BALL_H

#include "relief/synthetic.h"

#define EVAL_HARD_SPEED 0.3 /* m/s along the normal; slower ones tell no direction */

typedef struct eval_ball {
    rlf_vec3 x, v, w;
    double radius, restitution, friction;
    int32_t bounces;
    int32_t hard_bounces;    /* of them, faster than EVAL_HARD_SPEED */
    rlf_synthetic_hit first; /* what it met first */
    rlf_vec3 first_point;    /* of the scene, then */
    double first_approach;   /* m/s along its normal */
} eval_ball;

/* Flies from `begin` to `end` (s of the scene) under gravity and bounces off the true scene: a
 * rigid sphere's impulse with Coulomb friction at the exact time of each impact. Ends early, at
 * rest, where bounces pile up. */
void eval_ball_fly(rlf_source *source, eval_ball *ball, rlf_vec3 gravity, double begin, double end);

/* Degrees between two directions. */
double eval_angle_between(rlf_vec3 a, rlf_vec3 b);

#endif
