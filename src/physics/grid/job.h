/* One body's search for contacts with one layer of the grid: what it is given, what it finds. */
#ifndef RLF_PHYSICS_GRID_JOB_H
#define RLF_PHYSICS_GRID_JOB_H

#include "physics/grid/cast.h"
#include "physics/grid/contact/contact.h"

#define GRID_HITS_MAX 128
#define GRID_NORMALS_MAX 4
#define GRID_BUMPS_MAX 8
#define GRID_FLATS_MAX 16
#define GRID_TOUCHES_MAX 8
#define GRID_SOLIDS_MAX 256

typedef enum grid_face { GRID_TOUCH_FRONT = 0, GRID_TOUCH_BACK, GRID_TOUCH_SIDE } grid_face;

/* A place that a ball comes to before the next search; see ball/ball.h. */
typedef struct grid_touch {
    grid_face face;
    int32_t x, y;       /* pixel */
    double time;        /* s from now; below 0: the overlap, metres */
    rlf_vec3 direction; /* from there to the ball's centre, at that time */
    rlf_vec3 point;     /* of a side wall: now */
} grid_touch;

/* A contact in the making, grid frame, at the time of the search. */
typedef struct grid_hit {
    rlf_vec3 point, normal, velocity;
    rlf_vec3 facing; /* of a bump: normal of the surface itself */
    rlf_vec3 anchor; /* body frame */
    double rounding; /* the touching point is this far from the anchor along -normal */
    double separation;
    int32_t label;
} grid_hit;

/* The body in the grid's frame. */
typedef struct grid_motion {
    rlf_vec3 centre, v, w;
    double speed, spin; /* lengths of v and w */
    rlf_mat3 R_grid_body, R_body_grid;
} grid_motion;

/* How long and how far the search looks ahead. */
typedef struct grid_window {
    double asked_before; /* time of the search before this one, s */
    double horizon;      /* s until the next search */
    double reach;        /* m from the centre within which anything can matter until then */
} grid_window;

/* What the pixels under the body's footprint say. */
typedef struct grid_scan {
    int32_t stride;  /* pixels between those of the footprint that are read */
    double nearest2; /* square of the least distance of what is within reach to the centre, m^2 */
    bool is_near;    /* some of the layer's solid is within reach */
    bool is_flat;    /* ... and all of that is in the tiles `flats` */
    bool is_listed;  /* all of it is in `flats` and `solids` */
    const grid_tile *flats[GRID_FLATS_MAX];
    int32_t flat_count;
    float solids[GRID_SOLIDS_MAX][6]; /* boxes about what else is within reach: low x, y, z, high */
    int32_t solid_count;
    rlf_vec3 surface_velocity;          /* mean under the footprint */
    rlf_vec3 normals[GRID_NORMALS_MAX]; /* distinct directions of the surface near the body */
    int32_t normal_count;
    grid_hit bumps[GRID_BUMPS_MAX]; /* surface points that poke into the body */
    int32_t bump_count;
} grid_scan;

typedef struct grid_job {
    const grid_query *query;
    const phys_body *body;
    grid_motion motion;
    grid_window window;
    const rlf_grid_sheet *sheet; /* the layer */
    const grid_tiles *tiles;     /* ... and its tiles */
    field_side side;             /* its centre as the layer sees it */
    grid_scan scan;
    bool is_ball; /* touches are noted in place of normals and bumps */
    grid_touch touches[GRID_TOUCHES_MAX];
    int32_t touch_count;
    grid_hit hits[GRID_HITS_MAX]; /* the outcome */
    int32_t hit_count;
} grid_job;

/* The point p of the grid's frame in the body's. */
static inline rlf_vec3 grid_to_body(const grid_job *job, rlf_vec3 p)
{
    return rlf_mat3_mul_vec(&job->motion.R_body_grid, rlf_sub(p, job->motion.centre));
}

/* Speed at which a surface of this velocity and the body approach at p along the normal, m/s. */
static inline double grid_approach_at(const grid_job *job, rlf_vec3 p, rlf_vec3 normal,
                                      rlf_vec3 velocity)
{
    rlf_vec3 r = rlf_sub(p, job->motion.centre);
    rlf_vec3 v = rlf_add(job->motion.v, rlf_cross(job->motion.w, r));
    return rlf_dot(normal, rlf_sub(velocity, v));
}

/* The touching point, `arm` from the body's centre, of a round body follows the plane that was
 * found, whichever way it was named for; a cylinder's rim only where that is about this plane. */
static inline void grid_follow_plane(const grid_job *job, grid_hit *hit, rlf_vec3 arm,
                                     rlf_vec3 named_for)
{
    bool is_followed =
        phys_shape_is_round(&job->body->shape) || rlf_dot(hit->normal, named_for) > ONE_PLANE_COS;
    if (hit->rounding > 0.0 && is_followed) {
        rlf_vec3 core = rlf_mad(rlf_add(job->motion.centre, arm), named_for, hit->rounding);
        hit->separation = rlf_dot(hit->normal, rlf_sub(core, hit->point)) - hit->rounding;
    } else if (hit->rounding > 0.0) {
        hit->anchor = rlf_mat3_mul_vec(&job->motion.R_body_grid, arm);
        hit->rounding = 0.0;
    }
}

static inline void grid_add_hit(grid_job *job, const grid_hit *hit)
{
    if (job->hit_count < GRID_HITS_MAX) {
        job->hits[job->hit_count++] = *hit;
    }
}

#endif
