/* A body held by the mouse: a spring draws it to the ray through the cursor. */
#ifndef RLF_VIEWER_GRAB_H
#define RLF_VIEWER_GRAB_H

#include "viewer/throw.h"

#include "relief/query.h"

#define VIEWER_GRAB_REACH_M 20.0

typedef struct viewer_grab {
    bool is_on;
    rlf_body_id id;
    double distance; /* along the ray, metres, of the point that was picked */
    rlf_vec3 offset; /* from that point to the body's centre, world */
    viewer_ray ray;  /* through the cursor, now */
} viewer_grab;

/* The first body on the ray, in front of the real surface or behind it; false when there is none.
 */
bool viewer_grab_find(const rlf_world *world, const viewer_ray *ray, rlf_ray_hit *out);
/* Takes hold of what a ray met. */
void viewer_grab_begin(viewer_grab *grab, const rlf_world *world, const viewer_ray *ray,
                       const rlf_ray_hit *hit);
/* Nearer or further, by steps of the wheel, > 0: nearer. */
void viewer_grab_reach(viewer_grab *grab, double steps);
/* Forces for the next advance, of dt seconds. Lets go when the body is gone. Never more than 20 g,
 * so that what is between body and cursor stays in the way. */
void viewer_grab_pull(viewer_grab *grab, rlf_world *world, double dt);

#endif
