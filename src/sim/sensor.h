/* The synthetic sensor: the context behind a source made by rlf_synthetic_create. */
#ifndef RLF_SIM_SENSOR_H
#define RLF_SIM_SENSOR_H

#include "sim/color.h"
#include "sim/depth.h"
#include "sim/path.h"
#include "sim/hands/hands.h"
#include "sim/random/plan.h"

typedef struct synth_sensor {
    rlf_synthetic_def def;
    synth_scene scene; /* in the frame of the camera as it stands now */
    synth_scene rest;  /* in the first camera's frame, when the camera moves */
    synth_path path;   /* likewise */
    rlf_pose T_world_camera;
    synth_random random; /* the scene's, if it is a random one */
    synth_hands hands;   /* the scene's, if it is "hands" */
    synth_depth depth;
    synth_color color;
    int64_t next_frame;
    double time; /* of the frame given last, seconds; 0 before the first */
    bool has_frame;
    synth_scene asked; /* the scene at the time that was asked for last; see nearest.c */
    double asked_time;
    rlf_truth truth;
    rlf_truth_pose poses[SYNTH_PART_MAX + SYNTH_THING_MAX];
} synth_sensor;

/* *scene = the true scene at time t in the frame of the camera at t. */
void synth_sensor_see(synth_sensor *sensor, double t, synth_scene *scene);

#define SYNTH_FRAME_COUNT_MAX 4294967295 /* the noise is keyed by a 32-bit frame number */

/* Whether the settings can be used; an error line when not. */
rlf_result synth_def_check(const rlf_synthetic_def *def);
/* Name of a scene as in "synthetic:NAME"; NULL outside the range. */
const char *synth_scene_name(rlf_synthetic_scene scene);

/* Name of a path as in path=NAME; NULL outside the range. */
const char *synth_path_name(rlf_synthetic_path path);

/* The sensor behind a source; NULL when the source is another kind. */
synth_sensor *synth_sensor_of(const rlf_source *source);

#endif
