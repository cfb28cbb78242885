/* Relief: shapes, body states and contacts, the value that flows from physics to render and logs.
 *
 * A snapshot is complete when published and never changes afterwards. All coordinates are in the
 * world frame: the camera frame at start, unless a mount pose was given.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_SNAPSHOT_H
#define RELIEF_SNAPSHOT_H

#include "relief/math.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLF_NAME_MAX 64 /* bytes of a name, with its ending zero */

/* Handle of a body in a world: index + 1 and a generation, so a stale one is noticed; zero is null.
 * Means nothing in another world. Compare both fields. */
typedef struct rlf_body_id {
    uint32_t index1;     /* slot + 1; 0 = null */
    uint32_t generation; /* counts how often the slot was used before */
} rlf_body_id;

/* Solid shapes. All are convex but hulls, which count as convex where a comment says so; each is
 * centred on its origin, which is the body's centre of mass. */
typedef enum rlf_shape_type {
    RLF_SHAPE_BOX = 0,      /* by `size`, edges along its local axes */
    RLF_SHAPE_SPHERE = 1,   /* by `radius` */
    RLF_SHAPE_CAPSULE = 2,  /* by `radius` and `height`, along its local y axis */
    RLF_SHAPE_CYLINDER = 3, /* by `radius` and `height`, along its local y axis */
    RLF_SHAPE_HULL = 4      /* by `hull` */
} rlf_shape_type;

/* Triangle mesh in a body's frame, origin at the centre of mass; closed, without holes. Borrowed
 * for the body's life. rlf_hull_build of io.h makes one around points. */
typedef struct rlf_hull {
    const rlf_vec3 *vertices; /* metres */
    int32_t vertex_count;     /* at least 4 */
    const int32_t *triangles; /* 3 indices each, counter-clockwise seen from outside */
    int32_t triangle_count;   /* at least 4 */
} rlf_hull;

/* What a body collides as. Only the fields of its type count; lengths are > 0 and at most 100 m. */
typedef struct rlf_shape {
    rlf_shape_type type;  /* says which fields count */
    rlf_vec3 size;        /* box: full extents, metres */
    double radius;        /* sphere, capsule, cylinder, metres */
    double height;        /* cylinder: full height; capsule: between the two cap centres, metres */
    const rlf_hull *hull; /* hull only */
} rlf_shape;

/* How a body is drawn, if not as its shape: p_body = scale * p_model + offset. */
typedef struct rlf_look {
    const struct rlf_model *model; /* model.h; borrowed for the body's life. NULL = the shape */
    double scale;                  /* > 0 */
    rlf_vec3 offset;               /* body frame, metres */
} rlf_look;

/* Largest distance from the shape's origin to its surface, metres: of the sphere around it. 0 for
 * NULL and for a hull without vertices. */
RLF_API double rlf_shape_radius(const rlf_shape *shape);
/* Signed distance of p (the shape's frame, metres) to the shape's surface, negative inside, and the
 * unit direction in which it grows. A hull costs its triangles. */
RLF_API double rlf_shape_distance(const rlf_shape *shape, rlf_vec3 p, rlf_vec3 *out_gradient);
/* Where origin + t direction (the shape's frame; the direction need not be of unit length) enters
 * and leaves the shape, a hull being convex. False when the line misses it. *out_enter is negative
 * where the ray starts inside or beyond. */
RLF_API bool rlf_shape_cast(const rlf_shape *shape, rlf_vec3 origin, rlf_vec3 direction,
                            double *out_enter, double *out_leave);

/* A body as it is at the snapshot's time. A copy: it may be kept, but its hull and model are
 * borrowed. */
typedef struct rlf_body_state {
    rlf_body_id id;            /* for rlf_world_set_body and its kin */
    char name[RLF_NAME_MAX];   /* the def's, or "body-N"; ends with a zero */
    rlf_shape shape;           /* what it collides as */
    rlf_look look;             /* what it is drawn as */
    rlf_pose T_world_body;     /* of the centre of mass, metres */
    rlf_vec3 velocity;         /* m/s, of the centre of mass */
    rlf_vec3 angular_velocity; /* rad/s, world frame */
    double mass;               /* kg */
    float color[3];            /* linear-free sRGB 0..1; multiplies a model's own */
    bool is_held;              /* waiting for its release time */
    bool is_asleep;            /* at rest and not simulated until something touches it */
    bool is_grabbed; /* live: real fingers or hands hold it between them; it follows them */
} rlf_body_state;

/* What a body touched: another body, what stays of the real room, or what moves in it. */
typedef enum rlf_contact_other {
    RLF_CONTACT_BODY = 0,       /* another body, or a model of a real thing */
    RLF_CONTACT_BACKGROUND = 1, /* floor, walls, furniture */
    RLF_CONTACT_FOREGROUND = 2  /* people and what they carry: it moves, so it pushes */
} rlf_contact_other;

/* One point at which a body met something during the last advance. A body that lies on a face has
 * several. */
typedef struct rlf_contact {
    rlf_body_id body;        /* of two bodies the one with the lower index */
    rlf_contact_other other; /* what it met */
    rlf_body_id other_body;  /* null unless other is a body */
    int32_t region_label;    /* of the surface; 0 when other is a body or no region */
    rlf_vec3 point;        /* world, metres: where they met, or, of what rests, touch at the end */
    rlf_vec3 normal;       /* the same; unit, from the surface (or other body) to `body` */
    double separation;     /* metres, of the frame's last substep; negative when they overlap */
    double impulse;        /* N s along the normal during this frame, >= 0 */
    double surface_speed;  /* m/s of the surface along the normal as they met, to the body > 0 */
    double approach_speed; /* m/s at which they met; 0 of what rests */
} rlf_contact;

/* Two things began or stopped touching. A body that falls asleep goes on touching what it lies on.
 * What touches at several points has one event. */
typedef struct rlf_contact_event {
    bool is_begin;           /* false: it ended, or one of the two was removed */
    rlf_body_id body;        /* of two bodies the one with the lower index */
    rlf_contact_other other; /* what it met */
    rlf_body_id other_body;  /* null unless other is a body */
} rlf_contact_event;

/* All of a world after an advance. Arrays are the world's, in the order of the bodies' slots, which
 * does not change while they live; valid until the next call that changes the world. An array of
 * count 0 may be NULL. */
typedef struct rlf_snapshot {
    int64_t time_ns;                 /* world time, starts at 0 */
    uint64_t frame;                  /* rlf_world_advance calls so far */
    rlf_vec3 gravity;                /* m/s^2 */
    const rlf_body_state *bodies;    /* the virtual ones */
    int32_t body_count;              /* those that wait for their release time count, too */
    const rlf_body_state *known;     /* models of real things: not drawn, they hide and collide */
    int32_t known_count;             /* 0 = none */
    const rlf_contact *contacts;     /* of the last advance */
    int32_t contact_count;           /* 0 = nothing touches */
    const rlf_contact_event *events; /* of the last advance, by body; ends and begins mixed */
    int32_t event_count;             /* 0 = nothing changed */
} rlf_snapshot;

#ifdef __cplusplus
}
#endif
#endif
