/* Legs of furniture that the camera does not see, out of view or hidden: where three posts stand at
 * corners of a rectangle below something level, a fourth stands at its last corner. */
#ifndef RLF_PHYSICS_GRID_POST_H
#define RLF_PHYSICS_GRID_POST_H

#include "relief/world.h"

#define POSTS_MAX 8
#define POSTS_SEEN_MAX 32

/* An upright round bar, grid frame. */
typedef struct grid_post {
    rlf_vec3 foot; /* of its axis */
    double height, radius;
} grid_post;

/* Posts that are seen, in the making: sums over the rows that show one. */
typedef struct post_seen {
    rlf_vec3 points; /* of the axis */
    double widths, count;
    double low, high; /* along the vertical, metres */
    rlf_vec3 axis;    /* mean */
} post_seen;

/* The posts of the background that are not seen. */
typedef struct grid_posts {
    grid_post posts[POSTS_MAX];
    int32_t count;
    post_seen seen[POSTS_SEEN_MAX];
    int32_t seen_count;
    int64_t version; /* of the background that they were found in */
} grid_posts;

/* Finds them. `up` is a unit vector, grid frame, or 0: then there are none. */
void grid_posts_update(grid_posts *posts, const rlf_grid *grid, rlf_vec3 up);

/* Distance of q (grid frame) from the post's surface, metres; below 0 inside. */
double grid_post_distance(const grid_post *post, rlf_vec3 up, rlf_vec3 q);

#endif
