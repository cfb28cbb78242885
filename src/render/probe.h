/* Light by place: what the camera's picture, put on the surfaces it shows, sends to each body.
 * Shared by both renderers.
 *
 * All light is linear, an sRGB code being taken as the square root of it. Frames are the picture
 * camera's. A body's pixel shows
 *
 *   colour * (1 - metallic) * (around(n) + direct * max(0, n . l)) + what its surface mirrors
 *
 * where around is nine spherical harmonics (Ramamoorthi and Hanrahan 2001) of a map of radiance by
 * direction about the body. A glossy surface mirrors that map, by the split sum in Karis's form
 * (2014), and the lamp by GGX (Walter et al. 2007). */
#ifndef RLF_RENDER_PROBE_H
#define RLF_RENDER_PROBE_H

#include "base/inside.h"
#include "relief/compositor.h"
#include "relief/model.h"

enum {
    PROBE_SIDE = 16,                     /* cells of an octahedral map (Cigolle et al. 2014) */
    PROBE_ROW = PROBE_SIDE + 2,          /* with those that it goes on with beyond its edges */
    PROBE_CELLS = PROBE_ROW * PROBE_ROW, /* cell (x, y) at (y + 1) * PROBE_ROW + x + 1 */
    PROBE_TERMS = 9,                     /* of 1 x y z xy yz zx zz xx-yy */
    PROBE_OWN = 8,                       /* bodies with a probe of their own: the nearest */
    PROBE_PATCHES = 2048
};

/* Of the light on a white surface in a well lit room: what comes from all around, and what a
 * surface that faces the lamp gets of it. */
#define PROBE_AMBIENT 0.3
#define PROBE_DIRECT 0.7

/* How a surface looks beside its colour. */
typedef struct probe_material {
    float metallic, roughness; /* 0..1 */
} probe_material;

#define PROBE_SMOOTH 0.45f /* a rougher surface mirrors no more than nine harmonics tell */
#define PROBE_SHEEN 0.04f  /* of what it gets a smooth surface without metal mirrors, head on */
#define PROBE_LAMP 0.06f   /* added to GGX's width: a lamp is no point */
#define PROBE_TURN 0.18f   /* most that normals turning within a pixel add to GGX's squared width */

/* Patches of what is real: places, normals, radiance and area. */
typedef struct probe_room {
    float p[3][PROBE_PATCHES], n[3][PROBE_PATCHES], light[3][PROBE_PATCHES];
    float area[PROBE_PATCHES]; /* square metres */
    int32_t count;
    float mean[3]; /* radiance of the picture */
    float bright;  /* of its lighter parts */
} probe_room;

/* probe_room.c: reads a frame; none without colour. T_picture_depth. */
void probe_room_read(probe_room *room, const rlf_rig *rig, const rlf_frame *frame,
                     const rlf_surface *surface, const rlf_pose *T_picture_depth);

typedef struct light_probe {
    float center[3];
    float around[PROBE_TERMS][3]; /* of a white surface, by its normal */
    float rough[PROBE_TERMS][3];  /* mirrored by a rough surface, by the mirrored direction */
    float map[PROBE_CELLS][3];    /* radiance by direction */
    float direct[3];              /* of a white surface that faces the lamp */
} light_probe;

/* The probes of a picture. */
typedef struct probe_set {
    light_probe probes[PROBE_OWN];
    int32_t count;
    uint8_t *of; /* each body's probe */
    int32_t capacity;
    probe_room room;
    float basis[PROBE_SIDE * PROBE_SIDE][PROBE_TERMS]; /* of each cell */
    float solid[PROBE_SIDE * PROBE_SIDE];              /* angle, together 4 pi */
} probe_set;

void probe_set_init(probe_set *set) RLF_INSIDE(probe_set_init);
void probe_set_destroy(probe_set *set) RLF_INSIDE(probe_set_destroy);

/* What a picture's probes are made of. */
typedef struct probe_def {
    const rlf_rig *rig;
    const float *lamp; /* sRGB, shares of the bodies' colours */
    rlf_pose T_picture_depth, T_picture_world;
    rlf_pool *pool;
    bool is_on; /* else the same light comes from everywhere */
} probe_def;

rlf_result probe_set_update(probe_set *set, const probe_def *def, const rlf_frame *frame,
                            const rlf_surface *surface, const rlf_snapshot *snapshot)
    RLF_INSIDE(probe_set_update);

#endif
