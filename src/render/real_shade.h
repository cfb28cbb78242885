/* What real things keep of the directed light from bodies. Per body a small map across the light,
 * made by following rays from the body's lit side to the light (light_path.h). Shared by both
 * renderers. */
#ifndef RLF_RENDER_REAL_SHADE_H
#define RLF_RENDER_REAL_SHADE_H

#include "base/inside.h"
#include "environment/light_path.h"
#include "render/caster.h"

enum { REAL_SHADE_SIDE = 13, REAL_SHADE_CELLS = REAL_SHADE_SIDE * REAL_SHADE_SIDE };

typedef struct real_shade {
    float center[3];          /* of the body, picture camera frame */
    float across[3], down[3]; /* column of p = across . (p - center) + (REAL_SHADE_SIDE - 1) / 2 */
    float left[REAL_SHADE_CELLS]; /* of the directed light, 0..1 */
    bool takes;                   /* false: all is left */
} real_shade;

/* What the maps of a picture are made from. */
typedef struct real_shade_world {
    const rlf_surface *surface;
    const depth_tiles *tiles; /* of the surface; NULL = every body is looked at */
    rlf_pose T_depth_picture;
    rlf_vec3 to_light; /* unit, picture camera frame */
    double focal_px;   /* of the picture's camera: small bodies get coarser maps */
} real_shade_world;

void real_shade_make(const real_shade_world *world, const caster *body, real_shade *out)
    RLF_INSIDE(real_shade_make);
/* Multiplies `left` by what is left of the directed light, 1 - share * (lost part). */
void real_shade_take(const real_shade *shade, const caster_points *points, float share,
                     float *left);

#endif
