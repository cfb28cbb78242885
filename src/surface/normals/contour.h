/* The parts of the contour step: see contour.c. */
#ifndef RLF_SURFACE_NORMALS_CONTOUR_H
#define RLF_SURFACE_NORMALS_CONTOUR_H

#include "kernel/batch.h"
#include "surface/depth_step.h"
#include "surface/steps.h"

/* Pixels: what is looked at about a pixel, and steps on the way in from its contour. */
enum {
    CONTOUR_REACH = 2 * RLF_WINDOW_ABOUT, /* of a window of every second pixel */
    CONTOUR_WAY = 6,
    CONTOUR_DROPPED = 3, /* at most, of a side that is seen */
    CONTOUR_BORDER = 8   /* pixels of the image without this step: all that it reads is inside */
};

/* Planes that the step reads. Normals are those of seen pixels only. */
typedef struct contour_planes {
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const uint8_t *known; /* 1 where depth was not filled */
    float *const *normal;
} contour_planes;

/* Sixteen pixels, the windows about them and where the contour is, seen from each of them. */
typedef struct contour_batch {
    int32_t count;
    int32_t x[RLF_BATCH], y[RLF_BATCH];
    float spacing[RLF_BATCH]; /* of the window's samples, pixels */
    rlf_windows depth;
    float out_x[RLF_BATCH], out_y[RLF_BATCH]; /* unit, in the image, outwards */
    float distance[RLF_BATCH];                /* pixels; 0 = nothing is behind the pixel */
} contour_batch;

/* Sixteen normals, 0 = none. */
typedef struct contour_normals {
    float x[RLF_BATCH], y[RLF_BATCH], z[RLF_BATCH];
} contour_normals;

/* What is known on the way in from the contour, step by step; the first is the pixel itself. */
typedef struct contour_way {
    float ray_x[RLF_BATCH], ray_y[RLF_BATCH]; /* of the pixels */
    float s[CONTOUR_WAY][RLF_BATCH];          /* pixels from the contour */
    contour_normals normal[CONTOUR_WAY];
    int32_t inner[RLF_BATCH];  /* the last pixel of the same surface */
    float moves[RLF_BATCH];    /* 1 where something moves, else 0 */
    float is_round[RLF_BATCH]; /* 1 where what is in front is not flat, else 0 */
} contour_way;

/* What lies farther is behind a surface at depth z which rises by so much towards the camera within
 * so many pixels: it may go on sloping as it does, and by 45 degrees more, but not steeper than any
 * surface. */
RLF_KERNEL_PART float contour_behind(const depth_step *s, float z, float rise, float pixels)
{
    float sloped = depth_step_most(s, z, 1.0f, pixels) + rise;
    float most = depth_step_most(s, z, DEPTH_STEP_STEEPEST, pixels);
    return z + (sloped < most ? sloped : most);
}

/* One of two samples on opposite sides, so many pixels off, is behind the one between them. */
RLF_KERNEL_PART bool contour_is_behind(const depth_step *s, float z, float one, float other,
                                       float pixels)
{
    float far = one > other ? one : other, near = one > other ? other : one;
    return far > contour_behind(s, z, z > near ? z - near : 0.0f, pixels);
}

/* ---- contour_kernel.c ---- */

/* Writes out_x, out_y and distance from the windows of depth. */
void contour_find(const depth_step *step, contour_batch *restrict batch);
/* Writes all but `moves` and `is_round`. */
void contour_walk_in(const contour_planes *planes, const depth_step *step,
                     const contour_batch *restrict batch, contour_way *restrict way);
/* Normals that lean out as the surfaces do. */
void contour_lean_out(const contour_batch *restrict batch, const contour_way *restrict way,
                      contour_normals *restrict out);
/* Marks (1, else 0) the seen pixels of a row from `begin` to `end`, CONTOUR_REACH inside of the
 * image, that have something behind them that many pixels aside and where something not flat
 * (`front`) was there or that many pixels aside. */
void contour_mark_row(const float *depth, const uint8_t *front, const uint8_t *known,
                      const depth_step *step, ptrdiff_t width, int32_t begin, int32_t end,
                      uint8_t *restrict mark);

/* ---- contour_side.c ---- */

typedef struct contour_sides {
    const rlf_reconstruct *stage;
    contour_planes planes;
    const float *mean,
        *frames; /* of inverse depth over time; NULL = not kept: there are no sides */
    depth_step step;
} contour_sides;

/* Whether filled pixel (x, y) is on a narrow face that ends there, in direction (out_x, out_y):
 * then its normal, and the last pixel inwards that has it, too, at most CONTOUR_DROPPED off. */
bool contour_side_find(const contour_sides *job, int32_t x, int32_t y, float out_x, float out_y,
                       float normal[3], ptrdiff_t *last);

#endif
