/* The room that other views have seen: who answers where, and contacts with its distance field.
 *
 * Each touching place is answered once. Where the grid sees it, the grid answers: it is live. Out
 * of the picture, and behind what the picture shows, the map does, as far as it knows. What neither
 * knows is left to the rules for the unseen; see unseen/unseen.h. */
#ifndef RLF_PHYSICS_GRID_MAPPED_MAPPED_H
#define RLF_PHYSICS_GRID_MAPPED_MAPPED_H

#include "physics/grid/job.h"

/* A place of the map that a point comes to; world. */
typedef struct mapped_touch {
    rlf_vec3 point, normal;
    double separation; /* of the point, where it starts */
} mapped_touch;

/* Whether the grid sees q (grid frame): it is in the picture, and not behind what that shows. */
bool mapped_is_seen(const rlf_grid *grid, rlf_vec3 q);

/* Whether the map answers at q (grid frame): nobody sees it, and the map knows what is there. */
bool mapped_answers(const grid_query *query, rlf_vec3 q);

/* Drops the hits, guesses of the grid, about places at which the map answers. */
void mapped_drop_guesses(grid_job *job);

/* Adds contacts with the map where the grid does not see, and brings scan.nearest2 down. */
void mapped_collide(grid_job *job);

/* The first place that the grid does not see where a point that goes from q by `path` (world) is
 * within `margin` of the map's surface, or enters it. */
bool mapped_cast(const grid_query *query, rlf_vec3 q, rlf_vec3 path, double margin,
                 mapped_touch *out);

#endif
