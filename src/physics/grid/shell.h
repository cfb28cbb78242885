/* The room's shell: the large planes beyond which the camera sees nothing, its floor and walls.
 * They are solid where it does not look: out of view, and behind what hides them. */
#ifndef RLF_PHYSICS_GRID_SHELL_H
#define RLF_PHYSICS_GRID_SHELL_H

#include "relief/world.h"

#define SHELL_PLANES_MAX 8

/* Solid where normal.p < offset; grid frame. */
typedef struct shell_plane {
    rlf_vec3 normal;
    double offset;
} shell_plane;

typedef struct grid_shell {
    shell_plane planes[SHELL_PLANES_MAX]; /* where they are solid now ... */
    shell_plane fitted[SHELL_PLANES_MAX]; /* ... and what the last search found they glide to */
    int32_t count;
    uint32_t turn; /* searches so far: each begins at other pixels */
} grid_shell;

/* Searches the background for planes that hold a good part of its points and have next to none
 * beyond. Planes that are known stay until points are seen beyond them. */
void grid_shell_update(grid_shell *shell, const rlf_grid *grid);

/* Moves the planes on to what was found, `dt` s later: a fit that differs by a degree is
 * centimetres off where the camera does not look, and nothing that lies there may be thrown. False
 * when all are there. */
bool grid_shell_glide(grid_shell *shell, double dt);

/* Whether the shell counts at q (grid frame): the camera does not see that place. */
bool grid_shell_is_hidden(const rlf_grid *grid, rlf_vec3 q);

#endif
