/* Relief: the physics stage. Rigid bodies among real surfaces.
 *
 * Physics knows no camera: the real surface comes in as an rlf_grid, planes plus a projection, and
 * what no grid sees now as an rlf_map.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_WORLD_H
#define RELIEF_WORLD_H

#include "relief/snapshot.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rlf_map; /* map.h */

/* ---- the real surface as physics sees it
 * --------------------------------------------------------- */

/* What is where the camera sees nothing: beyond its view, and in the ring of missing pixels at the
 * border of its image. EXTEND, the default: the outermost planes go on, floor and walls, also
 * behind what hides them; and for 25 cm what the border cuts, or a ring that is no wider than an
 * eighth of the image. OPEN: nothing, bodies leave the room there. */
typedef enum rlf_border { RLF_BORDER_EXTEND = 0, RLF_BORDER_OPEN = 1 } rlf_border;

/* One sheet of the organised grid, in the grid's frame. Planes are width*height, row-major. */
typedef struct rlf_grid_sheet {
    const float *depth;                          /* z, metres; 0 = none. NULL = no such sheet */
    const float *normal_x, *normal_y, *normal_z; /* unit towards the camera, or 0 */
    const float *velocity_x, *velocity_y, *velocity_z; /* m/s; NULL = still */
    const float *thickness;   /* solid behind depth along z, metres; 0 or NULL = not known */
    double default_thickness; /* a guess where it is not known, metres square to the face; 0 =
                                 endlessly thick where `thickness` is NULL, a sheet elsewhere */
    const int32_t *label;     /* region label; may be NULL */
    const uint8_t *mask;      /* only pixels with mask != 0 belong to the sheet; NULL = all */
    rlf_border border;        /* of the background, beyond the view; default extend, unless the
                                 world's def says open */
    int64_t version; /* while it and `depth` stay the same, so do all planes; 0 = not known */
} rlf_grid_sheet;

/* A region with its points, for the thesis's broad and narrow phase. */
typedef struct rlf_grid_region {
    int32_t label;         /* > 0, as in the sheet's labels */
    bool is_foreground;    /* true: it moves; false: it stays */
    rlf_aabb box;          /* grid frame, metres */
    const int32_t *points; /* pixel indices; NULL when not kept */
    int32_t point_count;   /* of points; 0 when not kept */
} rlf_grid_region;

/* Most hands of one grid. */
#define RLF_GRID_HANDS_MAX 8
/* Cones of a hand: the palm's six, then three of each digit from its root on, the thumb first. */
#define RLF_GRID_HAND_CONES 21

/* A real hand, its hidden sides too: what may take hold of bodies. Grid frame. */
typedef struct rlf_grid_hand {
    int32_t id;                                /* > 0; the same as long as it is the same hand */
    bool is_sure;                              /* false: it is there, but its cones may be wrong */
    rlf_vec3 palm;                             /* its middle, on the seen skin, metres */
    rlf_vec3 facing;                           /* unit, out of the palm */
    rlf_round_cone cones[RLF_GRID_HAND_CONES]; /* in the order above */
} rlf_grid_hand;

/* Projects a point of the grid frame to grid pixel coordinates, (0, 0) being the centre of the
 * first pixel; false when not visible. Called from worker threads: changes nothing. */
typedef bool (*rlf_project_fn)(const void *context, rlf_vec3 p, double *out_u, double *out_v);

/* The real surface of one moment. All planes are borrowed for the advance; `rays` and `project`
 * must be there whenever a sheet has depth. */
typedef struct rlf_grid {
    int32_t width, height;          /* of all planes, pixels */
    const float *ray_x, *ray_y;     /* point = depth * (ray_x, ray_y, 1) */
    rlf_grid_sheet background;      /* what stays */
    rlf_grid_sheet foreground;      /* what moves in front of it: mask says where */
    const rlf_grid_region *regions; /* NULL = none are kept */
    int32_t region_count;           /* 0 when none are kept */
    rlf_project_fn project;         /* of a point to its pixel */
    const void *project_context;    /* given to project */
    double pixel_angle;             /* approximate radians per grid pixel, for footprint sizes */
    rlf_pose T_world_grid;          /* camera pose in the world */
    int64_t time_ns;                /* when it was seen */
    const rlf_grid_hand *hands;     /* that may grab, at time_ns; NULL = none are known */
    int32_t hand_count;             /* 0..RLF_GRID_HANDS_MAX */
    /* Live: what another camera sees of the same room, or NULL; and so on. Bodies collide with
     * what any of them sees, and with no guess about what another one sees to be free. */
    const struct rlf_grid *next;
    int32_t camera; /* which one this is: 0 for the first of the list, others below
                       rlf_world_def.camera_capacity, each once and the same in every advance */
} rlf_grid;

/* ---- world
 * ------------------------------------------------------------------------------------------ */

/* Which physics runs: ours, or the thesis's for comparison. */
typedef enum rlf_physics_method {
    RLF_PHYSICS_LIVE = 0, /* substeps, grid collider on both sheets with surface velocity */
    RLF_PHYSICS_THESIS =
        1 /* chapter 4.3: Euler, matrix orientation, region boxes, point impulses */
} rlf_physics_method;

/* Most cameras that see the room of one world. */
#define RLF_WORLD_CAMERAS_MAX 8

/* What a world is made of. From rlf_world_def_default; sizes are taken at create. */
typedef struct rlf_world_def {
    uint32_t cookie;           /* from rlf_world_def_default */
    rlf_physics_method method; /* default live */
    rlf_vec3 gravity;          /* m/s^2; default (0, 9.81, 0): y is down */
    int32_t body_capacity;     /* default 1024 */
    int32_t contact_capacity;  /* default 16384 */
    double step_hz;            /* live: fixed steps per second, default 240 */
    double contact_distance_m; /* thesis: tau of Algorithm 3; default 0 = derived from the grid */
    double max_speed;          /* m/s; bodies are clamped to it. default 50 */
    rlf_aabb bounds;           /* bodies whose centre leaves it are removed from the simulation
                                  (Algorithm 1: "while x(t) is within the scene"); default +-20 m */
    rlf_border border;         /* live: what the background is beyond the view; default extend */
    bool enable_grab; /* live: bodies on which the grid's hands close, or that its pixels hold
                         between two sides, are held until these open; default false */
    int32_t camera_capacity; /* live: cameras that see the room, 1 to RLF_WORLD_CAMERAS_MAX;
                                default 1 */
    rlf_pool *pool;          /* borrowed; NULL = one thread */
} rlf_world_def;

/* The defaults that the fields name. */
RLF_API rlf_world_def rlf_world_def_default(void);

/* A body to add; copied but for its hull and model, which are borrowed. */
typedef struct rlf_body_def {
    uint32_t cookie;           /* from rlf_body_def_default */
    char name[RLF_NAME_MAX];   /* default "" = "body-N" */
    rlf_shape shape;           /* default box 0.1 m; what it collides as */
    rlf_look look;             /* what it is drawn as; default its shape */
    double mass;               /* kg, > 0; default 0.1 */
    rlf_vec3 position;         /* world, metres; default (0, 0, 1) */
    rlf_quat orientation;      /* default identity */
    rlf_vec3 velocity;         /* m/s */
    rlf_vec3 angular_velocity; /* rad/s */
    double restitution;        /* 0..1, default 0.5 */
    double friction;           /* >= 0, default 0.5 */
    double gravity_scale;      /* default 1 */
    double release_time;       /* s; held still before. default 0 */
    bool collides_with_bodies; /* default true */
    double rolling_resistance; /* live: a rolling ball slows down by 5/7 of this times gravity, >=
                                  0; default 0 */
    double linear_damping;     /* live: velocity falls as exp(-damping t), 1/s, >= 0; default 0 */
    double angular_damping;    /* live: the same for the angular velocity */
    bool is_kinematic;         /* live: moves by its velocities alone (rlf_world_set_body changes
                                  them), pushes others, is pushed by nothing; default false */
    bool is_real;              /* live: a model of a real thing, kinematic: in rlf_snapshot.known in
                                  place of bodies; models do not collide with each other. default
                                  false */
    float color[3];            /* sRGB 0..1, default orange; multiplies a model's own colours */
} rlf_body_def;

/* The defaults that the fields name: an orange box of 0.1 m a metre before the camera. */
RLF_API rlf_body_def rlf_body_def_default(void);

/* Bodies and the solver. One thread at a time; the pool's workers are used within an advance
 * only. */
typedef struct rlf_world rlf_world;

/* Allocates everything. RLF_ERROR_INVALID names the def's field that is wrong. */
RLF_API rlf_result rlf_world_create(const rlf_world_def *def, rlf_world **out);
/* Frees it and nulls the pointer. NULL and a NULL world are allowed. */
RLF_API void rlf_world_destroy(rlf_world **world);

/* Adds a body (between advances). RLF_ERROR_INVALID names the field: non-finite numbers, mass <= 0,
 * a size <= 0 or > 100 m, restitution outside 0..1. RLF_ERROR_CAPACITY when the world is full.
 * out_id may be NULL. */
RLF_API rlf_result rlf_world_add_body(rlf_world *world, const rlf_body_def *def,
                                      rlf_body_id *out_id);
/* Removes a body; a stale or null id does nothing. */
RLF_API void rlf_world_remove_body(rlf_world *world, rlf_body_id id);
/* True when the id names a living body. */
RLF_API bool rlf_world_has_body(const rlf_world *world, rlf_body_id id);
/* What makes the body again as it is now, for rlf_world_add_body: the def that it was made from,
 * with its place and velocities of now; the hull and the model are borrowed as before. So a body
 * that is removed can come back. False, and *out as it was, for a stale id. */
RLF_API bool rlf_world_get_body_def(const rlf_world *world, rlf_body_id id, rlf_body_def *out);
/* Moves a body and sets its velocities. False for a stale id or non-finite values. */
RLF_API bool rlf_world_set_body(rlf_world *world, rlf_body_id id, const rlf_pose *T_world_body,
                                rlf_vec3 velocity, rlf_vec3 angular_velocity);
/* Applies an impulse (N s) at a world point: eq. 4.13 to 4.15. False for a stale id. */
RLF_API bool rlf_world_apply_impulse(rlf_world *world, rlf_body_id id, rlf_vec3 impulse,
                                     rlf_vec3 point);
/* Adds a force (N) at a world point that acts during the next advance: eq. 4.6 and 4.7. */
RLF_API bool rlf_world_apply_force(rlf_world *world, rlf_body_id id, rlf_vec3 force,
                                   rlf_vec3 point);

/* Gravity, m/s^2, from now on; bodies that sleep wake up. False when it is not finite. */
RLF_API bool rlf_world_set_gravity(rlf_world *world, rlf_vec3 gravity);

/* The static room. As far as it is known it is what bodies meet of all that stands, in view or not;
 * the grid answers for what moves and for what is not known. Borrowed until the next call or the
 * world's end; it may be fused into between advances, not during one. Same world frame as the poses
 * of the grids. NULL (at first): nothing is known, and all is as without. Live method only. Free:
 * call it when the room changes hands, not every frame. */
RLF_API void rlf_world_set_room(rlf_world *world, const struct rlf_map *room);

/* Advances time by dt seconds against the surface `grid`, which may be NULL for empty space and is
 * only read during the call. 0 < dt <= 1: anything else is the caller's mistake, is told as such
 * (rlf_set_assert) and does nothing. Allocates nothing. Results do not depend on the pool.
 * Thread-safety: one call at a time per world. */
RLF_API void rlf_world_advance(rlf_world *world, const rlf_grid *grid, double dt);

/* Where the time of the last advance went, milliseconds; the thesis's method sets only the last. */
typedef struct rlf_world_times {
    double wake_ms;    /* what a new surface means for those that sleep */
    double surface_ms; /* contacts with the surface */
    double pairs_ms;   /* contacts between bodies */
    double impacts_ms; /* bounces */
    double solve_ms;   /* resting contacts and friction */
    double move_ms;    /* integration */
    double sleep_ms;   /* islands */
    double publish_ms; /* events and snapshot */
} rlf_world_times;

/* Times of the last advance. Thread-safety: not during one. */
RLF_API rlf_world_times rlf_world_get_times(const rlf_world *world);

/* State after the last advance; valid until the next call that changes the world. */
RLF_API const rlf_snapshot *rlf_world_get_snapshot(const rlf_world *world);
/* Removes all bodies and sets the time to 0. */
RLF_API void rlf_world_reset(rlf_world *world);
/* 64-bit hash (FNV-1a over the bits of all poses and velocities, in id order). */
RLF_API uint64_t rlf_world_hash(const rlf_world *world);

/* Kinetic plus potential energy (gravity, zero at the origin), J: for tests. */
RLF_API double rlf_world_energy(const rlf_world *world);

/* Inertia tensor of a solid shape of the given mass about its origin, body frame (C.1 and its kin).
 */
RLF_API rlf_mat3 rlf_shape_inertia(const rlf_shape *shape, double mass);

#ifdef __cplusplus
}
#endif
#endif
