/* The planes of real surfaces near a body: at most three, found in the depth image. */
#ifndef RLF_ENVIRONMENT_NEAR_PLANES_H
#define RLF_ENVIRONMENT_NEAR_PLANES_H

#include "relief/surface.h"

enum { NEAR_PLANES_MOST = 3 };

/* A box with round edges in the depth camera's frame, metres. */
typedef struct near_planes_body {
    float center[3];
    float axis[3][3]; /* the box's axes, unit */
    float half[3];    /* of the inner box */
    float round;      /* what the box is grown by */
    float reach;      /* of a ball about it all */
} near_planes_body;

typedef struct near_plane {
    float p[3], normal[3]; /* a point of it; unit, towards the body. Depth camera's frame, metres */
    float presence;        /* share of the plane that is there below the body, 0..1 */
} near_plane;

typedef struct near_planes {
    float reach; /* metres from the body within which a surface is near: as long as it is wide */
    int32_t count;
    near_plane plane[NEAR_PLANES_MOST];
} near_planes;

/* None without normals. */
void near_planes_find(const rlf_surface *surface, const near_planes_body *body, near_planes *out);

#endif
