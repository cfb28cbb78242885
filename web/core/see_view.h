/* The matrices of a WebXR depth view as a camera. */
#ifndef RELIEF_WEB_SEE_VIEW_H
#define RELIEF_WEB_SEE_VIEW_H

#include "relief/camera.h"

enum { EVERY_MAX = 8 };

/* What the page writes beside the raw depth. Matrices are by columns, as WebXR has them. */
typedef struct see_numbers {
    double buffer_from_view[16]; /* normDepthBufferFromNormView */
    double projection[16];       /* of the depth view */
    double world_from_view[16];  /* pose of the depth view */
    double world_from_head[16];  /* pose of who looks: tells an old buffer from a room at rest */
    double raw_to_m;             /* rawValueToMeters */
    double near_m, far_m;        /* > 0: raw * raw_to_m is an OpenGL depth of such planes, 0..1; far
                                    may be infinite. 0: it is metres */
    double time_ms;
    double every; /* 1: all pixels; 2: every second of every second row, and so on */
} see_numbers;

/* A depth view as a camera. */
typedef struct see_view {
    rlf_camera whole;  /* of the buffer */
    rlf_camera camera; /* of the pixels that are taken */
    rlf_pose T_world_camera;
    bool is_mirrored; /* rows are read from the last one on */
} see_view;

/* RLF_OK, or RLF_ERROR_INVALID with a line that says what is wrong. */
rlf_result see_numbers_check(const see_numbers *n);
/* The camera of a buffer of that size, by numbers that were checked. RLF_ERROR_INVALID: a buffer
 * that would have to be resampled, or a pose that is none. */
rlf_result see_view_make(const see_numbers *n, int32_t width, int32_t height, see_view *out);

#endif
