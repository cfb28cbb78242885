/* A room drawn at random: what of it does not lie in the list of parts. */
#ifndef RLF_SIM_RANDOM_RANDOM_H
#define RLF_SIM_RANDOM_RANDOM_H

#include "sim/gait.h"
#include "sim/noise.h"
#include "sim/scene.h"

#define SYNTH_PEOPLE_MAX 4
#define SYNTH_ACTS_MAX 4
#define SYNTH_CLOTHES_MAX 16 /* beside the body's own solids */
#define SYNTH_THING_MAX 16   /* parts of the thing that is moved */
#define SYNTH_SWEEP_WAY 1.1  /* metres, of a board */
#define SYNTH_CIRCLE 0.25    /* metres, radius of a tray's way */

/* Level frame: the camera is its origin, y down, x and z along the walls. */
typedef struct synth_individual {
    synth_figure figure;
    synth_flesh flesh[SYNTH_PERSON_FLESH + SYNTH_CLOTHES_MAX];
    int32_t flesh_count;
    synth_look looks[SYNTH_MATERIAL_COUNT];
    synth_act acts[SYNTH_ACTS_MAX];
    synth_script script; /* its acts are those above */
    rlf_pose T_level_path;
    int32_t label;
} synth_individual;

/* A thing that stands from the first frame on and is moved from `start` on. */
typedef struct synth_moved {
    rlf_synthetic_push push;
    synth_part parts[SYNTH_THING_MAX]; /* at rest, camera frame */
    int32_t part_count;                /* 0 = nothing is moved */
    bool is_gone;                      /* taken away at once */
    double start;                      /* s */
    double speed;                      /* m/s */
    double rise;                       /* metres, of what is lifted */
    rlf_vec3 along, up, aside;         /* unit, camera frame */
} synth_moved;

typedef struct synth_random {
    rlf_quat q_camera_level;
    double focal;        /* of the depth camera, pixels */
    double min_m, max_m; /* its range */
    rlf_depth_noise sigma;
    synth_drawn_noise noise;
    synth_individual people[SYNTH_PEOPLE_MAX];
    int32_t people_count;
    synth_moved moved;
} synth_random;

/* Draws the room of def->seed into *scene (its other fields zero) and *random, which the scene
 * keeps a pointer to. */
void synth_random_build(synth_scene *scene, synth_random *random, const rlf_synthetic_def *def);

/* The movers at time t. */
void synth_random_move(synth_scene *scene, double t);

#endif
