/* A prediction of the room, pixel by pixel of the depth camera's grid. */
#ifndef RELIEF_PIPELINE_ROOM_PLANES_H
#define RELIEF_PIPELINE_ROOM_PLANES_H

#include "relief/prediction.h"
#include "relief/surface.h"

typedef struct room_planes {
    float *depth, *normal[3]; /* a pixel of the grid each; 0 = unknown */
    /* Also of each: the first of the four predicted pixels about it, and the nearest. */
    int32_t *first, *nearest;
    struct room_plane *planes; /* of the predicted pixels; behind the last one: none */
} room_planes;

/* `lens` is the camera of the grid, `predicted` that of all predictions. Close what was opened,
 * also after an error. */
rlf_result room_planes_open(room_planes *r, const rlf_camera *lens, const rlf_camera *predicted);
/* Where `p`, predicted for the camera that saw `s`, has a step, a pixel gets the nearer side: what
 * is beside an edge of the room does not stand in front of it. */
void room_planes_take(const room_planes *r, const rlf_prediction *p, const rlf_surface *s,
                      rlf_pool *pool);
void room_planes_close(room_planes *r);

#endif
