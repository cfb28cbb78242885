/* Level faces that go on behind what stands on them: a table's top behind a carton. The camera
 * sees one at both sides of what hides it, so that it is there between them, too. */
#ifndef RLF_PHYSICS_GRID_LEVEL_H
#define RLF_PHYSICS_GRID_LEVEL_H

#include "physics/grid/shell.h"

#define LEVEL_RUNS_MAX 1024
#define LEVEL_FACES_MAX 8

/* Of a level face that something hides: pixels x0 <= x < x1 of row y. */
typedef struct level_run {
    int32_t y, x0, x1;
    int32_t face;
} level_run;

/* A level face, and the sums that its plane is fitted by. */
typedef struct level_face {
    shell_plane plane;
    rlf_vec3 normals, points;
    double count;
} level_face;

/* The hidden strips of level faces. */
typedef struct grid_levels {
    level_face faces[LEVEL_FACES_MAX];
    int32_t face_count;
    level_run runs[LEVEL_RUNS_MAX]; /* from the lowest row up */
    int32_t run_count;
    int64_t version; /* of the background that they were found in */
} grid_levels;

/* Finds the strips of the background's level faces that something hides, row by row of the image.
 * `up` is a unit vector, grid frame, or 0: then there are none. Planes of the shell go on anyway
 * and are left out. */
void grid_levels_update(grid_levels *levels, const grid_shell *shell, const rlf_grid *grid,
                        rlf_vec3 up);

/* The plane of a hidden strip of which q is less than `reach` above; grid frame. False when there
 * is none. */
bool grid_level_find(const grid_levels *levels, const rlf_grid *grid, rlf_vec3 q, double reach,
                     shell_plane *out);

/* Whether the strip counts at q (grid frame): the camera does not see that place, be it behind
 * what stands there or in it. */
bool grid_level_is_hidden(const rlf_grid *grid, rlf_vec3 q);

#endif
