/* Contacts of one body with both layers of the grid: the door to this folder. */
#ifndef RLF_PHYSICS_GRID_CONTACT_CONTACT_H
#define RLF_PHYSICS_GRID_CONTACT_CONTACT_H

#include "physics/body.h"
#include "physics/grid/tiles.h"
#include "physics/grid/unseen/room_planes.h"

/* The real surface during one substep. */
typedef struct grid_query {
    const rlf_grid *grid;
    rlf_pose T_grid_world;
    double tau; /* seconds from when the grid was seen to now; the surface moves by velocity tau */
    double lag; /* seconds of the surface's way that no tau covered, as none is trusted so long */
    bool is_moving;       /* false beyond the time that extrapolation is trusted */
    double time;          /* world time now, s */
    double step;          /* s of a substep */
    int64_t rest_version; /* of what stays */
    grid_tiles *foreground, *background;
    const struct rlf_map *map; /* the room as far as it is known, NULL = it is not */
    const room_planes *room;   /* NULL: there is nothing where the camera does not look */
    rlf_vec3 up;               /* unit, against gravity, grid frame; 0 without gravity */
    const struct grid_query *first, *next; /* other cameras' views of the same moment, in a list;
                                              NULL: there are none */
} grid_query;

/* Whether a camera of the list sees past a place in the world where something moves with this
 * velocity: what is clearly behind it is all that it sees there. */
bool grid_is_seen_free(const grid_query *query, rlf_vec3 place, rlf_vec3 velocity);

/* Makes the tiles that grid_collide will read for this body. Returns whether any of them has
 * foreground. */
bool grid_collide_prepare(const grid_query *query, const phys_body *body);

/* Replaces body->surface by fresh contacts and sets how long they may be used; impulses of contacts
 * that live on are kept. */
void grid_collide(const grid_query *query, phys_body *body, int32_t body_index);

/* The last defence against tunnelling. If the centre's way from `before` enters a layer through a
 * face that the body moves into, it goes back, along with the layer, and bounces with its
 * restitution and friction. That blow is one of its contacts, which are to be searched again. */
void grid_guard_centre(const grid_query *query, phys_body *body, int32_t body_index,
                       rlf_vec3 before);

#endif
