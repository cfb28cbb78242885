/* What the analytic parts of `relief-lab eval` share: random numbers, a Kinect v2, one profile's
 * surface stage on depth that the caller computes. */
#ifndef RELIEF_APP_EVAL_ANALYTIC_H
#define RELIEF_APP_EVAL_ANALYTIC_H

#include "relief/reconstruct.h"

typedef struct eval_random {
    uint64_t state;
} eval_random;

eval_random eval_random_start(uint64_t seed);
/* [0, 1). */
double eval_random_uniform(eval_random *r);
double eval_random_range(eval_random *r, double low, double high);
/* Mean 0, variance 1. */
double eval_random_normal(eval_random *r);
rlf_vec3 eval_random_in_box(eval_random *r, rlf_vec3 low, rlf_vec3 high);

/* 512 x 424 pixels without lens distortion, 0.5 to 4.5 m, noise after Fankhauser et al. 2015. */
rlf_rig eval_kinect_rig(void);

/* Depth along the ray (x, y, 1) of the plane n.p = d; 0 where the plane is not in front. */
double eval_plane_depth(rlf_vec3 n, double d, rlf_vec3 ray);

/* A surface stage with a depth image to fill. */
typedef struct eval_stage {
    rlf_rig rig;
    float *depth; /* metres, rig.depth's size */
    rlf_vec3 *rays;
    rlf_reconstruct *reconstruct;
    int64_t frame;
} eval_stage;

/* On failure everything is closed again. */
rlf_result eval_stage_open(rlf_profile profile, eval_stage *out);
void eval_stage_close(eval_stage *stage);
/* Surface of the depth image as the next frame, a thirtieth of a second after the last. */
rlf_result eval_stage_process(eval_stage *stage, const rlf_surface **out);
/* Forgets the frames so far. */
void eval_stage_restart(eval_stage *stage);

#endif
