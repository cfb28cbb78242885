/* A published frame of rendered depth with its true normals: see public.c. */
#ifndef RELIEF_APP_EVAL_PUBLIC_FRAME_H
#define RELIEF_APP_EVAL_PUBLIC_FRAME_H

#include "relief/camera.h"

#define PUBLIC_WIDTH 640
#define PUBLIC_HEIGHT 480
#define PUBLIC_COUNT (PUBLIC_WIDTH * PUBLIC_HEIGHT)

typedef struct public_frame {
    rlf_camera camera;
    float *depth; /* 0 = nothing there */
    float *ray_x, *ray_y;
    float *found[3];
    uint16_t *truth; /* three a pixel */
} public_frame;

/* acos |n.n_true|, degrees: 0 to 90. */
double public_error_deg(const public_frame *f, int32_t pixel, rlf_vec3 normal);

#endif
