/* Bodies as what keeps light away: a box with round edges, which is a ball or a stick when the box
 * is a point or a line; of a hull, so much of that as its outline across the light leaves. Shared
 * by both renderers. */
#ifndef RLF_RENDER_CASTER_H
#define RLF_RENDER_CASTER_H

#include "base/inside.h"
#include "camera/pixel_rect.h"
#include "kernel/kernel.h"
#include "relief/compositor.h"

/* Shares of the light on a real surface that a body can take away. */
#define CASTER_AMBIENT_SHARE 0.5
#define CASTER_DIRECT_SHARE 0.35
/* Of a body's size: how far it darkens what is near, and how long its shadow is. */
#define CASTER_NEAR 1.2
#define CASTER_LENGTH 12.0
/* Width of the penumbra: so much of the least half extent, and so much per metre behind the body.
 */
#define CASTER_PENUMBRA 0.3
#define CASTER_SPREAD 0.12

enum {
    CASTER_BODIES = 3, /* most bodies that shade another one */
    CASTER_EDGES = 16, /* most of a hull's outline */
    CASTER_LANES = 16  /* points that are worked on at once */
};

typedef struct caster {
    float center[3];   /* picture camera frame, metres */
    float axis[3][3];  /* the body's axes in that frame */
    float half[3];     /* of the inner box */
    float round;       /* what the box is grown by */
    float crease;      /* 1 = the rounded box is the body; 0 = it is about a hull */
    float light[3];    /* to the light: unit, picture camera frame */
    float to_light[3]; /* the same in the body's frame */
    float penumbra;    /* metres, at the body */
    float near_m;      /* contact darkening ends here, metres from the surface */
    float length_m;    /* the shadow ends here, metres behind the body */
    float radius;      /* of the bounding sphere */
    float reach;       /* of a ball about the rounded box */
    /* Of a hull: beyond edge k by edge[k] . (p - center) - edge[k][3] metres. */
    float edge[CASTER_EDGES][4];
    int32_t edge_count;
} caster;

/* False (and near_m 0) when the body casts nothing: not finite, or around the camera. to_light:
 * unit, picture camera frame. */
bool caster_make(const rlf_body_state *body, const rlf_pose *T_picture_world, rlf_vec3 to_light,
                 caster *out) RLF_INSIDE(caster_make);
/* Where the light of surfaces can be changed. */
bool caster_reach(const caster *c, const rlf_camera *camera, rlf_vec3 to_light, pixel_rect *out)
    RLF_INSIDE(caster_reach);
enum { CASTER_TAKES_NOTHING = 0, CASTER_TAKES_AMBIENT = 1, CASTER_TAKES_DIRECT = 2 };
/* Sum of the above: what light may be taken within `radius` of p (picture camera frame). */
int32_t caster_may_take(const caster *c, const float p[3], float radius);
/* The same for balls: into `out`, for `count` of them in whole CASTER_LANES. */
typedef struct caster_balls {
    const float *x, *y, *z, *radius;
} caster_balls;
void caster_may_take_balls(const caster *c, const caster_balls *balls, int32_t count,
                           int32_t *restrict out);
/* Indices of the nearest bodies that may take light from body `index`, which is within `radius` of
 * its centre; returns how many. A caster with near_m 0 is none. */
int32_t caster_choose(const caster *casters, int32_t count, int32_t index,
                      int32_t out[CASTER_BODIES]) RLF_INSIDE(caster_choose);

/* The same for `bodies` many at once, of these indices, into out[i]. */
typedef struct caster_choice {
    int32_t count, chosen[CASTER_BODIES];
    float away2[CASTER_BODIES]; /* squared distances of their centres, rising */
} caster_choice;
void caster_choose_many(const caster *casters, int32_t count, const int32_t *index, int32_t bodies,
                        caster_choice *out);

/* Points z (x, y, 1) in the picture camera's frame; none where z <= 0. CASTER_LANES, or a multiple
 * of that. */
typedef struct caster_points {
    const float *x, *y, *z;
    int32_t count;
} caster_points;

/* Multiplies `left` by what is left of the light around, 1 - share * (lost part), or of the
 * directed light. */
void caster_take_ambient(const caster *c, const caster_points *points, float share, float *left);
void caster_take_direct(const caster *c, const caster_points *points, float share, float *left);

/* Between vectors and what shaders and kernels take. */
static inline void caster_to_floats(rlf_vec3 v, float out[3])
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

static inline rlf_vec3 caster_from_floats(const float v[3])
{
    return rlf_vec3_make((double)v[0], (double)v[1], (double)v[2]);
}

#endif
