/* A sensed room of planes, and a slab in front of it, as physics sees them: no camera, no noise. */
#ifndef RELIEF_APP_EVAL_PHYSICS_SHEET_H
#define RELIEF_APP_EVAL_PHYSICS_SHEET_H

#include "relief/world.h"

/* Plane n.p = d with n towards the camera, so d < 0. */
typedef struct eval_wall {
    rlf_vec3 n;
    double d;
} eval_wall;

typedef struct eval_sheet {
    rlf_grid grid;
    float *planes[14];
    int32_t *labels[2];
    uint8_t *mask;
} eval_sheet;

/* A rectangle cut from a wall: |p - centre| within half on the axes whose half is > 0. */
typedef struct eval_slab {
    eval_wall wall;
    rlf_vec3 centre, half;
    double thickness;
    rlf_vec3 velocity;
} eval_slab;

/* 512 x 424 pixels of a Kinect v2; nothing is seen yet. */
rlf_result eval_sheet_open(eval_sheet *out);
void eval_sheet_close(eval_sheet *sheet);
/* The background: of each ray the nearest of the walls, up to 12 m. */
void eval_sheet_set_room(eval_sheet *sheet, const eval_wall *walls, int32_t count);
/* The foreground as the next frame shows it; NULL = nothing. */
void eval_sheet_set_slab(eval_sheet *sheet, const eval_slab *slab);
bool eval_sheet_sees(rlf_vec3 p);

#endif
