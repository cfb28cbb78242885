/* A sheet in tiles of 16 x 16 pixels or more: how near it comes and where it is just a plane, so
 * that most of a body's footprint need not be read. A tile is made when a body first comes over it,
 * once per surface. */
#ifndef RLF_PHYSICS_GRID_TILES_H
#define RLF_PHYSICS_GRID_TILES_H

#include "relief/world.h"

#define TILES_MAX 4096
#define TILE_BLOCKS 4 /* a tile has so many blocks of pixels a side */

typedef enum tile_kind {
    TILE_EMPTY = 0, /* no surface */
    TILE_FLAT,      /* one plane, and no outline in it or next to it */
    TILE_ROUGH
} tile_kind;

/* Boxes about the solids behind a tile's blocks, row by row, grid frame, metres; a little wider
 * than they are, for floats are rounded. Empty ones are nowhere near. */
typedef struct grid_blocks {
    float low[3][TILE_BLOCKS * TILE_BLOCKS], high[3][TILE_BLOCKS * TILE_BLOCKS];
} grid_blocks;

typedef struct grid_tile {
    double near_z;   /* least depth of what its pixels show, metres */
    double speed;    /* no pixel is faster, m/s */
    rlf_aabb solid;  /* the box about its solid, unless ... */
    bool is_endless; /* ... that never ends */
    int32_t count;   /* its pixels that have a surface */
    int32_t narrow; /* pixels across what is narrowest in a rough one, as far as it is seen in it */
    double deepest; /* no solid of its pixels goes farther below its face, metres */
    grid_blocks blocks;
    rlf_aabb box;    /* about its points at the time when they were seen */
    rlf_vec3 normal; /* of a flat one: normal.p = offset */
    double offset;
    rlf_vec3 velocity; /* of a flat one: mean, m/s */
} grid_tile;

typedef struct grid_tiles {
    const rlf_grid_sheet *sheet;
    int32_t size, columns, rows; /* size in pixels */
    int32_t block_shift;         /* a block is 1 << block_shift pixels wide */
    uint64_t stamp;
    grid_tile *tiles; /* TILES_MAX */
    /* What is asked of most tiles, apart from them: it stays near. For which stamp a tile was made,
     * and in the last two bits its kind; TILES_MAX. */
    uint64_t *marks;
} grid_tiles;

static inline tile_kind grid_tiles_kind(const grid_tiles *tiles, int32_t index)
{
    return (tile_kind)(tiles->marks[index] & 3u);
}

/* Begins with a new surface, or goes on with the same one when `is_new` is false. */
void grid_tiles_start(grid_tiles *tiles, const rlf_grid *grid, const rlf_grid_sheet *sheet,
                      bool is_new);

/* Makes the tiles under the rectangle of pixels x0, y0, x1, y1 (ends excluded). Returns whether any
 * of them has a surface. */
bool grid_tiles_make(grid_tiles *tiles, const rlf_grid *grid, const int32_t rect[4]);

/* The blocks of a tile of which something may be within `reach` of p, as bits: row by row. */
uint32_t grid_tile_blocks_near(const grid_tile *tile, rlf_vec3 p, double reach);

#endif
