/* Where the light comes from, by what the camera sees: neighbours of one colour but other normals
 * differ in brightness as the light falls on them. */
#ifndef RLF_ENVIRONMENT_LIGHT_DIRECTION_H
#define RLF_ENVIRONMENT_LIGHT_DIRECTION_H

#include "base/inside.h"
#include "relief/surface.h"

/* A point of the surface, and its colour. */
typedef struct light_point {
    float light, red, green; /* mean of the channels, linear, 0 = unknown; shares of red, green */
    float n[3], z;
} light_point;

typedef struct light_direction {
    rlf_vec3 given; /* from the light into the scene, unit */
    /* Light on a surface with normal n is 1 + bend . n, but for a factor. The sums of the normal
     * equations for it, of past frames and the last one; A is symmetric: xx xy xz yy yz zz. */
    double a[6], b[3];
    rlf_vec3 bend;
    light_point *points; /* of a frame, every few pixels; NULL = nothing is estimated */
    int32_t columns, rows;
    uint64_t sequence; /* of the last frame taken in */
    bool has_sums;
    bool is_known; /* the picture tells; else `now` is what was given */
    rlf_vec3 now;  /* from the light into the scene, unit, depth camera frame */
} light_direction;

/* `given` is shown while the picture does not tell, and for good unless `is_estimated`. `grid` is
 * the surface's camera. RLF_ERROR_MEMORY. */
rlf_result light_direction_create(rlf_vec3 given, bool is_estimated, const rlf_camera *grid,
                                  light_direction *out) RLF_INSIDE(light_direction_create);
void light_direction_destroy(light_direction *l) RLF_INSIDE(light_direction_destroy);
/* Takes a frame in, when it is another one and has colour, and sets now. */
void light_direction_update(light_direction *l, const rlf_rig *rig, const rlf_frame *frame,
                            const rlf_surface *surface) RLF_INSIDE(light_direction_update);

#endif
