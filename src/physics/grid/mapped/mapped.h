/* The room that all views have seen: who answers where, and contacts with its distance field.
 *
 * What stands has one surface wherever the camera looks: that of the map, which is the mean of many
 * views. What a frame shows beside it, noise and all, would shake what lies there, and the
 * picture's border would be a seam. Where the map does not tell, the grid answers; what neither
 * knows is left to the rules for the unseen; see unseen/unseen.h. What moves is the grid's
 * foreground alone. */
#ifndef RLF_PHYSICS_GRID_MAPPED_MAPPED_H
#define RLF_PHYSICS_GRID_MAPPED_MAPPED_H

#include "physics/grid/job.h"
#include "relief/map.h"

/* A place of the map that a point comes to; world. */
typedef struct mapped_touch {
    rlf_vec3 point, normal;
    double separation; /* of the point, where it starts */
} mapped_touch;

/* Whether the grid sees q (grid frame): it is in the picture, and not behind what that shows. */
bool mapped_is_seen(const rlf_grid *grid, rlf_vec3 q);

/* How far the map's nearest surface is from q (grid frame), metres, below 0 inside. False where the
 * map does not tell. */
bool mapped_distance(const grid_query *query, rlf_vec3 q, double *out);

/* Whether nobody sees q, and the map knows that it is free. */
bool mapped_is_open(const grid_query *query, rlf_vec3 q);

/* Whether the map tells of q (grid frame) in one of these ways. */
bool mapped_answers(const grid_query *query, rlf_vec3 q);

/* What the map first knows on the way from a place to another (grid frame); UNKNOWN: nothing. */
rlf_map_state mapped_first_known(const grid_query *query, rlf_vec3 from, rlf_vec3 to);

/* Adds contacts with the map, drops those of which it knows better, and brings scan.nearest2 down.
 */
void mapped_collide(grid_job *job);

/* The first place where a point that goes from q by `path` (world) is within `margin` of the map's
 * surface, or enters it. */
bool mapped_cast(const grid_query *query, rlf_vec3 q, rlf_vec3 path, double margin,
                 mapped_touch *out);

#endif
