/* The nearest depth that is seen, or known behind, in each tile of a surface: tells at once that
 * nothing is before something. */
#ifndef RLF_ENVIRONMENT_DEPTH_TILES_H
#define RLF_ENVIRONMENT_DEPTH_TILES_H

#include "relief/surface.h"

enum { DEPTH_TILE = 8 }; /* pixels of the surface */

typedef struct depth_tiles {
    float *nearest; /* metres; 1e9 where nothing is seen */
    float least;    /* of all; 0 = nothing is seen */
    int32_t columns, rows;
} depth_tiles;

/* Of a surface's size, pixels. RLF_ERROR_MEMORY. */
rlf_result depth_tiles_create(int32_t width, int32_t height, depth_tiles *out);
void depth_tiles_destroy(depth_tiles *tiles);
/* `front`, of the surface's size, takes what is seen, else what is known behind; NULL = not wanted.
 */
void depth_tiles_update(depth_tiles *tiles, const rlf_surface *surface, rlf_pool *pool,
                        float *front);

#endif
