/* A floor, a wall and a box that stands from the first frame on and then moves, seen from a height
 * and pitch of choice by one of three simulated sensors. */
#ifndef RELIEF_APP_EVAL_START_ROOM_H
#define RELIEF_APP_EVAL_START_ROOM_H

#include "eval/analytic.h"
#include "relief/source.h"

/* Time of flight: white noise and mixed pixels at edges. Steps: structured light. Smeared: noise
 * that neighbours share, and edges that are two pixels fat. */
typedef enum start_sensor { START_TOF = 0, START_STEPS, START_SMEARED, START_SENSORS } start_sensor;

/* Where the box is: world frame, which is level, y down, with the camera at its origin. */
typedef struct start_box {
    rlf_vec3 centre, half;
    double yaw; /* radians about y */
} start_box;

typedef struct start_def {
    start_sensor sensor;
    double height, pitch; /* of the camera: metres over the floor, radians downwards */
    start_box box;
    rlf_vec3 way;      /* unit: in which it moves ... */
    double speed, far; /* ... m/s and metres ... */
    double ramp_s;     /* ... reaching its speed in this time ... */
    double begin_s;    /* ... from then on */
    uint64_t seed;
} start_def;

typedef struct start_room {
    start_def def;
    rlf_source_info info;
    rlf_pose T_world_camera;
    rlf_vec3 *rays;        /* of each pixel, world frame */
    float *still, *depth;  /* without the box; of the frame */
    float *clean, *common; /* without noise; noise that every frame has */
    eval_random random;
    int64_t frame;
    rlf_source *source;
} start_room;

/* On failure everything is closed again. */
rlf_result start_room_open(const start_def *def, start_room *out);
void start_room_close(start_room *room);
/* The box at a time, and how fast it is along its way. */
start_box start_box_at(const start_def *def, double time_s, double *out_speed);
/* A point in the box's frame. */
rlf_vec3 start_box_local(const start_box *box, rlf_vec3 p);

#endif
