/* The synthetic room from anywhere: what a moving camera would see, with the sensor's noise. */
#ifndef RELIEF_APP_EVAL_MAP_VIEW_H
#define RELIEF_APP_EVAL_MAP_VIEW_H

#include "eval/analytic.h"
#include "relief/io.h"

/* A camera that is carried through a synthetic room; the world is the room's own camera's frame. */
typedef struct map_camera {
    rlf_source *source;
    rlf_rig rig;
    rlf_pose T_world_camera;
    eval_random noise;
    rlf_vec3 *ways; /* of the pixels, world */
    float *truth, *depth;
    int32_t *label;
    rlf_frame frame; /* of the planes above */
} map_camera;

/* Opens a synthetic source and reads its frames up to `time_s`, when all is looked at. */
rlf_result map_camera_open(map_camera *c, const char *source, double time_s, int64_t seed);
void map_camera_close(map_camera *c);
/* Looks from the i-th place of a hand that moves 0.6 m about and turns by 40 degrees. */
rlf_result map_camera_look(map_camera *c, int32_t i);
/* The true point at a pixel, world; false when there is none. */
bool map_camera_point(const map_camera *c, int32_t pixel, rlf_vec3 *out);

#endif
