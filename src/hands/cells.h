/* The foreground in cells of about a centimetre, and the way along it from where limbs come in. */
#ifndef RLF_HANDS_CELLS_H
#define RLF_HANDS_CELLS_H

#include "relief/surface.h"

#define CELL_FAR 1e9f /* no way leads there */
#define BRIDGES_MAX 16
#define CHAMFER 5 /* units of hand_cells.disc in one cell */

/* What a limb hangs on. */
typedef enum hand_root {
    HAND_ROOT_NONE = 0,
    HAND_ROOT_BORDER = 1, /* comes in at the picture's border */
    HAND_ROOT_BODY = 2,   /* a part too thick for any limb */
    HAND_ROOT_FRONT = 3,  /* a piece in front of one that has a root: an arm towards the camera */
    HAND_ROOT_ALONE = 4   /* none of these: it hangs in the air, or on what is no foreground */
} hand_root;

/* Planes have room for one cell per pixel; `width` x `height` cells are in use, row by row. */
typedef struct hand_cells {
    const rlf_surface *surface; /* that they were read from */
    int32_t step;               /* pixels of the surface along a cell's side */
    int32_t width, height, count;
    float spacing;   /* metres between neighbours at 1 m */
    float *z;        /* nearest foreground in the cell, metres; 0 = none */
    float *noise_of; /* NOISE_SIGMAS of the sensor at z, metres */
    float *reach;    /* along the foreground from the root, metres; CELL_FAR = none */
    uint8_t *root;   /* hand_root of a cell that is one; see hand_cells_root */
    int32_t *source; /* the root's cell that it is reached from */
    int32_t *disc;   /* to the nearest edge, in cells / CHAMFER */
    int32_t *queue;  /* of cells, count + 1 */
    uint8_t *queued;
    int32_t *touched; /* cells that hand_cells_spread gave a distance, in that order */
    int32_t touched_count;
    rlf_depth_noise noise;
    int32_t bridge[BRIDGES_MAX][2]; /* cells at both sides of a depth step within one limb */
    int32_t bridge_count;
} hand_cells;

/* Reads the surface's foreground and fills all planes. False when there is none. */
bool hand_cells_read(hand_cells *c, const rlf_surface *s);

/* What cell i, which is reached, hangs on. */
static inline hand_root hand_cells_root(const hand_cells *c, int32_t i)
{
    return (hand_root)c->root[c->source[i]];
}

/* Metres from cell a to b, `cells` apart in a straight or diagonal line; < 0 when a depth step lies
 * between. */
float hand_cells_way(const hand_cells *c, int32_t a, int32_t b, float cells);

/* Shortest ways: grows `distance` from the cells in the queue, which have theirs, as far as `limit`
 * metres. Cells that are not reached keep what they have, CELL_FAR at the start;
 * those that had it and are reached are added to `touched`. */
void hand_cells_spread(hand_cells *c, float *distance, int32_t queued, float limit);

/* Distance to the nearest 0 of a plane in cells / CHAMFER, in place: others come in as INT32_MAX/2.
 * Beyond the plane there is nothing, and no edge. */
void hand_chamfer(int32_t *plane, int32_t width, int32_t height);

#endif
