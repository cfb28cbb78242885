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
 */
typedef struct rlf_body_id {
    uint32_t index1;
    uint32_t generation;
} rlf_body_id;

typedef enum rlf_shape_type {
    RLF_SHAPE_BOX = 0,
    RLF_SHAPE_SPHERE = 1,
    RLF_SHAPE_CAPSULE = 2,  /* along its local y axis */
    RLF_SHAPE_CYLINDER = 3, /* along its local y axis */
    RLF_SHAPE_HULL = 4
} rlf_shape_type;

/* Triangle mesh in a body's frame, origin at the centre of mass. Borrowed for the body's life. */
typedef struct rlf_hull {
    const rlf_vec3 *vertices; /* metres */
    int32_t vertex_count;
    const int32_t *triangles; /* 3 indices each, counter-clockwise seen from outside */
    int32_t triangle_count;
} rlf_hull;

typedef struct rlf_shape {
    rlf_shape_type type;
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

/* Largest distance from the shape's origin to its surface, metres. */
RLF_API double rlf_shape_radius(const rlf_shape *shape);
/* Signed distance of p (the shape's frame, metres) to the shape's surface, negative inside, and the
 * unit direction in which it grows. A hull costs its triangles. */
RLF_API double rlf_shape_distance(const rlf_shape *shape, rlf_vec3 p, rlf_vec3 *out_gradient);
/* Where origin + t direction (the shape's frame; the direction need not be of unit length) enters
 * and leaves the shape, a hull being convex. False when the line misses it. *out_enter is negative
 * where the ray starts inside or beyond. */
RLF_API bool rlf_shape_cast(const rlf_shape *shape, rlf_vec3 origin, rlf_vec3 direction,
                            double *out_enter, double *out_leave);

typedef struct rlf_body_state {
    rlf_body_id id;
    char name[RLF_NAME_MAX];
    rlf_shape shape;
    rlf_look look;
    rlf_pose T_world_body;
    rlf_vec3 velocity;         /* m/s, of the centre of mass */
    rlf_vec3 angular_velocity; /* rad/s, world frame */
    double mass;               /* kg */
    float color[3];            /* linear-free sRGB 0..1; multiplies a model's own */
    bool is_held;              /* waiting for its release time */
    bool is_asleep;
} rlf_body_state;

/* What a body touched. */
typedef enum rlf_contact_other {
    RLF_CONTACT_BODY = 0,
    RLF_CONTACT_BACKGROUND = 1,
    RLF_CONTACT_FOREGROUND = 2
} rlf_contact_other;

typedef struct rlf_contact {
    rlf_body_id body;
    rlf_contact_other other;
    rlf_body_id other_body; /* null unless other is a body */
    int32_t region_label;   /* of the surface; 0 when other is a body or no region */
    rlf_vec3 point;         /* world, metres: where they met, or, of what rests, touch at the end */
    rlf_vec3 normal;        /* the same; unit, from the surface (or other body) to `body` */
    double separation;      /* metres, of the frame's last substep; negative when they overlap */
    double impulse;         /* N s along the normal during this frame, >= 0 */
    double surface_speed;   /* m/s of the surface along the normal as they met, to the body > 0 */
    double approach_speed;  /* m/s at which they met; 0 of what rests */
} rlf_contact;

/* Two things began or stopped touching. A body that falls asleep goes on touching what it lies on.
 */
typedef struct rlf_contact_event {
    bool is_begin;    /* false: it ended, or one of the two was removed */
    rlf_body_id body; /* of two bodies the one with the lower index */
    rlf_contact_other other;
    rlf_body_id other_body; /* null unless other is a body */
} rlf_contact_event;

typedef struct rlf_snapshot {
    int64_t time_ns;              /* world time, starts at 0 */
    uint64_t frame;               /* rlf_world_advance calls so far */
    rlf_vec3 gravity;             /* m/s^2 */
    const rlf_body_state *bodies; /* the virtual ones */
    int32_t body_count;
    const rlf_body_state *known; /* models of real things: not drawn, they hide and collide */
    int32_t known_count;
    const rlf_contact *contacts; /* of the last advance */
    int32_t contact_count;
    const rlf_contact_event *events; /* of the last advance, by body; ends and begins mixed */
    int32_t event_count;
} rlf_snapshot;

#ifdef __cplusplus
}
#endif
#endif
