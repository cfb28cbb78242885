/* The room's shell: the large planes beyond which the camera sees nothing, its floor and walls.
 * They are solid where it does not look: out of view, and behind what hides them. */
#ifndef RLF_PHYSICS_GRID_UNSEEN_ROOM_PLANES_H
#define RLF_PHYSICS_GRID_UNSEEN_ROOM_PLANES_H

#include "relief/world.h"

#define ROOM_PLANES_MAX 8

/* Solid where normal.p < offset; grid frame. */
typedef struct room_plane {
    rlf_vec3 normal;
    double offset;
} room_plane;

typedef struct room_planes {
    room_plane planes[ROOM_PLANES_MAX]; /* where they are solid now ... */
    room_plane fitted[ROOM_PLANES_MAX]; /* ... and what the last search found they glide to */
    int32_t count;
    uint32_t turn; /* searches so far: each begins at other pixels */
} room_planes;

static inline double room_plane_height(const room_plane *plane, rlf_vec3 p)
{
    return rlf_dot(plane->normal, p) - plane->offset;
}

/* Searches the background for planes that hold a good part of its points and have next to none
 * beyond. Planes that are known stay until points are seen beyond them. */
void room_planes_update(room_planes *shell, const rlf_grid *grid);

/* Moves the planes on to what was found, `dt` s later: a fit that differs by a degree is
 * centimetres off where the camera does not look, and nothing that lies there may be thrown. False
 * when all are there. */
bool room_planes_glide(room_planes *shell, double dt);

/* The planes in the frame of a camera that moved from where they are told: T_before_now takes
 * points of its new frame to the old one. */
void room_planes_carry(room_planes *shell, const rlf_pose *T_before_now);

/* Whether the shell counts at q (grid frame): the camera does not see that place. */
bool room_is_hidden(const rlf_grid *grid, rlf_vec3 q);

/* ---- upright_face.c: what stands goes on downwards behind what hides it: a column behind a
 * table. */

/* The plane of the background's upright face under which q is: going up from q, the face is what
 * the camera sees first, past whatever hides it, within `reach` of q. `up` is a unit vector. Grid
 * frame. False when there is none. */
bool upright_face_find(const rlf_grid *grid, rlf_vec3 q, rlf_vec3 up, double reach,
                       room_plane *out);

#endif
