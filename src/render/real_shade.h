/* What real things keep of the directed light from bodies. Per body a small map across the light,
 * made by following rays from the body's lit side to the light (light_path.h). Shared by both
 * renderers. */
#ifndef RLF_RENDER_REAL_SHADE_H
#define RLF_RENDER_REAL_SHADE_H

#include "base/inside.h"
#include "environment/light.h"
#include "environment/near_planes.h"
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

/* ---- obscurance.c: light around that real surfaces keep from bodies close to them: ambient
 * obscurance (Zhukov, Iones and Kronin 1998). Of the light around a point of a body, weighted by
 * the cosine to its normal, that is lost which comes from a real surface less than a reach away,
 * the less the further it is; the reach is as long as the body is wide, for beyond that the
 * surface is lit as if the body were not there. Per body the real surfaces are at most three
 * planes (near_planes.h). Shared by both renderers. */

#define OBSCURANCE_SHARE 0.8 /* of the light around that can be lost: a surface gives some back */
#define OBSCURANCE_HARDLY 0.005f /* less than this share lost is not seen */

typedef struct obscurance {
    int32_t count;
    float normal[NEAR_PLANES_MOST][3]; /* unit, towards the body; picture camera frame */
    float offset[NEAR_PLANES_MOST];    /* height of p above a plane: normal . p + offset, metres */
    float presence[NEAR_PLANES_MOST];  /* share of the plane that is there below the body, 0..1 */
    float per_reach;                   /* one over the reach, metres */
} obscurance;

/* The surfaces near a body; none without normals. A caster with near_m 0 is no body. */
void obscurance_find(const rlf_surface *surface, const rlf_pose *T_depth_picture,
                     const caster *body, obscurance *out) RLF_INSIDE(obscurance_find);

/* Share of the light around that an endless plane keeps from a point `height` reaches above it,
 * 0..1, when what is lost from distance d is 1 - d / reach. `facing` is the cosine between the
 * point's normal and the plane's. Exact for facing -1, where it is (1 - height)^2, and for height
 * 0, where it is (1 - facing) / 2; else within 0.015 of the integral over the hemisphere. */
RLF_KERNEL_PART float obscurance_lost(float facing, float height)
{
    float near_share = 1.0f - (height < 1.0f ? height : 1.0f);
    float square = near_share * near_share;
    float horizon = sqrtf(near_share * (2.0f - near_share)); /* of what is near: its sine */
    float seen = (horizon - facing) / (horizon + 1.0f);
    seen = seen > 0.0f ? seen : 0.0f;
    float bent = 1.0f - square * square * square;
    return square * seen * (1.0f - bent + bent * seen);
}

/* Unit normals of points. */
typedef struct obscurance_normals {
    const float *x, *y, *z;
} obscurance_normals;

/* False when less than OBSCURANCE_HARDLY is lost within `radius` of p (picture camera frame), by
 * points whose normals are at most `turn` (a length) from the given one. */
bool obscurance_may_take(const obscurance *o, const float p[3], float radius, const float normal[3],
                         float turn);
/* Multiplies `left` by what is left of the light around. */
void obscurance_take(const obscurance *o, const caster_points *points,
                     const obscurance_normals *normals, float *left);

#endif
