/* What light the room has, and what real things keep of it. */
#ifndef RLF_ENVIRONMENT_LIGHT_H
#define RLF_ENVIRONMENT_LIGHT_H

#include "base/inside.h"
#include "environment/depth_tiles.h"
#include "relief/frame.h"
#include "relief/surface.h"

/* ---- room_light.c: how bright the bodies are beside the camera's picture. */

typedef struct room_light {
    float level[3];    /* mean of the picture over that of a well lit room, per channel; smoothed */
    uint64_t sequence; /* of the last frame taken in */
    bool is_known;
    float color[3]; /* of the bodies: the one that is given, and the level when it is estimated */
} room_light;

/* Takes a frame in, and sets color. Frames without colour, and one that was taken in already,
 * change no level. */
void room_light_update(room_light *l, const float given[3], bool is_estimated,
                       const rlf_frame *frame) RLF_INSIDE(room_light_update);

/* ---- light_direction.c: where the light comes from, by what the camera sees: neighbours of one
 * colour but other normals differ in brightness as the light falls on them. */

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

/* ---- light_path.c: what real things keep of the directed light on its path to a point: rays
 * from there to the light are followed through the depth image. Each pixel is solid from its
 * depth to its estimated back, and so is the background behind it. */

#define LIGHT_PATH_REACH_M 2.5 /* beyond this nothing casts a shadow: lamps are wide */

enum { LIGHT_PATH_RAYS = 16 }; /* at once */

/* Points in the depth camera's frame, metres. */
typedef struct light_path_points {
    float p[3][LIGHT_PATH_RAYS];
    int32_t is_some[LIGHT_PATH_RAYS]; /* 0 = none: p is of no use */
} light_path_points;

/* Shares of the light that are lost between the first `count` points and the light; 0 where there
 * is none. `to_light` is a unit vector. */
void light_path_lost(const rlf_surface *surface, const light_path_points *points,
                     const float to_light[3], int32_t count, float *out);

/* In the depth camera's frame, metres. */
typedef struct light_path_ball {
    float center[3], radius;
} light_path_ball;

/* light_path_ball.c: false when no ray from the ball to the light goes behind anything: no light is
 * lost. `tiles` are the surface's. */
bool light_path_may_lose(const rlf_surface *surface, const depth_tiles *tiles,
                         const light_path_ball *ball, const float to_light[3]);

#endif
