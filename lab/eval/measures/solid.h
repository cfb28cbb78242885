/* Measures of what is behind, in motion and gone: thickness, velocity, phantoms. */
#ifndef RELIEF_APP_EVAL_MEASURES_SOLID_H
#define RELIEF_APP_EVAL_MEASURES_SOLID_H

#include "relief/io.h"

#define EVAL_SHARE_BINS 4000 /* 0.1 % each */

/* Depth at which rays leave a thing: |found - true|. */
typedef struct eval_exit {
    int64_t count, close; /* close: within 5 cm */
    double sum_m;
} eval_exit;

/* Errors relative to the true speed, where that is above 0.2 m/s. */
typedef struct eval_speed {
    int64_t bins[EVAL_SHARE_BINS];
    double sum;
    int64_t count;
} eval_speed;

/* Background pixels that moved away: how many are still reported where the thing was. */
typedef struct eval_phantoms {
    float *background; /* true one of the frame before */
    int32_t *age;      /* frames since the pixel changed; 0 = it did not */
    int64_t capacity;
    bool has_background;
    int64_t seen_soon, left_soon; /* 3 frames after */
    int64_t seen_late, left_late; /* 30 frames after */
} eval_phantoms;

typedef struct eval_solid {
    eval_exit body, book;   /* people and hands; the held book */
    eval_exit unlike;       /* of the people: children, coats, skirts, backpacks */
    eval_exit standing;     /* furniture that stands */
    int64_t standing_known; /* of its pixels those whose thickness is no guess */
    eval_speed normal;      /* along the true normal */
    eval_speed full;        /* of the whole vector */
    eval_speed swift;       /* the same of what swings: limbs above 1.5 m/s */
    int64_t still, still_zero;
    eval_phantoms phantoms;
} eval_solid;

void eval_solid_finish(eval_solid *e);
/* Forgets the frame before; once per run. RLF_ERROR_MEMORY. */
rlf_result eval_solid_restart(eval_solid *e, const rlf_rig *rig);
void eval_solid_add(eval_solid *e, const rlf_surface *surface, const rlf_truth *truth,
                    const rlf_rig *rig);

/* NAN when there is no sample. */
double eval_exit_mean_cm(const eval_exit *e);
double eval_exit_close_percent(const eval_exit *e);
double eval_standing_known_percent(const eval_solid *e);
double eval_speed_median_percent(const eval_speed *e);
double eval_speed_mean_percent(const eval_speed *e);

#endif
