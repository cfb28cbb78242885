/* What real things keep of the directed light from bodies. Per body a small map across the light,
 * made by following rays from the body's lit side to the light through the depth image: each pixel
 * is solid from its depth to its estimated back, and so is the background behind it. Shared by both
 * renderers. */
#ifndef RLF_RENDER_REAL_SHADE_H
#define RLF_RENDER_REAL_SHADE_H

#include "base/inside.h"
#include "render/caster.h"

enum { REAL_SHADE_SIDE = 13, REAL_SHADE_CELLS = REAL_SHADE_SIDE * REAL_SHADE_SIDE };

typedef struct real_shade {
    float center[3];          /* of the body, picture camera frame */
    float across[3], down[3]; /* column of p = across . (p - center) + (REAL_SHADE_SIDE - 1) / 2 */
    float left[REAL_SHADE_CELLS]; /* of the directed light, 0..1 */
    bool takes;                   /* false: all is left */
} real_shade;

enum { REAL_SHADE_TILE = 8 }; /* pixels of the surface */

/* Nearest depth that is seen, or known behind, in each tile of a surface: with it bodies that
 * nothing is before on their way to the light are known at once. */
typedef struct real_shade_grid {
    float *nearest;
    float least; /* of all; 0 = nothing is seen */
    int32_t columns, rows;
} real_shade_grid;

rlf_result real_shade_grid_create(int32_t width, int32_t height, real_shade_grid *out);
void real_shade_grid_destroy(real_shade_grid *grid);
/* `front`, of the surface's size, takes what is seen, else what is known behind; NULL = not wanted.
 */
void real_shade_grid_update(real_shade_grid *grid, const rlf_surface *surface, rlf_pool *pool,
                            float *front);

/* What the maps of a picture are made from. */
typedef struct real_shade_world {
    const rlf_surface *surface;
    const real_shade_grid *grid; /* of the surface; NULL = every body is looked at */
    rlf_pose T_depth_picture;
    rlf_vec3 to_light; /* unit, picture camera frame */
    double focal_px;   /* of the picture's camera: small bodies get coarser maps */
} real_shade_world;

/* False when no ray from the ball to the light, both in the depth camera's frame, goes behind
 * anything: no light is lost. The world must have its grid. */
bool real_shade_may_lose(const real_shade_world *world, const float center[3], float radius,
                         const float to_light[3]);
void real_shade_make(const real_shade_world *world, const caster *body, real_shade *out)
    RLF_INSIDE(real_shade_make);
/* Multiplies `left` by what is left of the directed light, 1 - share * (lost part). */
void real_shade_take(const real_shade *shade, const caster_points *points, float share,
                     float *left);

#endif
