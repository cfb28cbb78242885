/* The pixels under a body's footprint: outlines and bumps that its sample points may miss. */
#ifndef RLF_PHYSICS_GRID_SCAN_H
#define RLF_PHYSICS_GRID_SCAN_H

#include "physics/grid/cast.h"
#include "physics/grid/collide.h"

#define GRID_HITS_MAX 128
#define GRID_NORMALS_MAX 4
#define GRID_BUMPS_MAX 8
#define GRID_FLATS_MAX 16
#define GRID_MEETINGS_MAX 8
#define GRID_SOLIDS_MAX 256

typedef enum grid_face { GRID_TOUCH_FRONT = 0, GRID_TOUCH_BACK, GRID_TOUCH_SIDE } grid_face;

/* A place that a ball comes to before the next query; see ball.h. */
typedef struct grid_meeting {
    grid_face face;
    int32_t x, y;       /* pixel */
    double time;        /* s from now; below 0: the overlap, metres */
    rlf_vec3 direction; /* from there to the ball's centre, at that time */
    rlf_vec3 point;     /* of a side wall: now */
} grid_meeting;

/* A contact in the making, grid frame, at the time of the query. */
typedef struct grid_hit {
    rlf_vec3 point, normal, velocity;
    rlf_vec3 facing; /* of a bump: normal of the surface itself */
    rlf_vec3 anchor; /* body frame */
    double rounding; /* the touching point is this far from the anchor along -normal */
    double separation;
    int32_t label;
} grid_hit;

/* Body and sheet in the grid's frame, and what is found. */
typedef struct grid_job {
    const grid_query *query;
    const rlf_grid_sheet *sheet;
    const grid_tiles *tiles; /* of the sheet */
    const phys_body *body;
    field_home home;       /* its centre as the sheet sees it */
    rlf_vec3 centre, v, w; /* of the body */
    double speed, spin;    /* lengths of v and w */
    rlf_mat3 R_grid_body, R_body_grid;
    double asked_before; /* time of the query before this one, s */
    double horizon;      /* s until the next query */
    double reach;        /* m from the centre within which anything can matter until then */
    double nearest2; /* square of the least distance of what is within reach to the centre, m^2 */
    bool is_near;    /* some of the sheet's solid is within reach */
    bool is_flat;    /* ... and all of that is in the tiles `flats` */
    const grid_tile *flats[GRID_FLATS_MAX];
    int32_t flat_count;
    rlf_vec3 surface_velocity;          /* mean under the footprint */
    rlf_vec3 normals[GRID_NORMALS_MAX]; /* distinct directions of the surface near the body */
    int32_t normal_count;
    grid_hit bumps[GRID_BUMPS_MAX]; /* surface points that poke into the body */
    int32_t bump_count;
    float solids[GRID_SOLIDS_MAX][6]; /* boxes about what else is within reach: low x, y, z, high */
    int32_t solid_count;
    bool is_listed; /* all of it is in `flats` and `solids` */
    int32_t stride; /* pixels between those of the footprint that are looked at */
    bool is_ball;   /* touches are noted instead of normals and bumps */
    grid_meeting meetings[GRID_MEETINGS_MAX];
    int32_t meeting_count;
    grid_hit hits[GRID_HITS_MAX];
    int32_t hit_count;
} grid_job;

/* Distance kept ready for contacts that are not there yet, metres. */
#define GRID_MARGIN 0.004

/* Rectangle of pixels (ends excluded) under a sphere about `centre`, grid frame; false when it is
 * out of view. *stride thins it to a bounded number of samples. */
bool grid_footprint(const rlf_grid *grid, rlf_vec3 centre, double reach, int32_t rect[4],
                    int32_t *stride);

/* The point p of the grid's frame in the body's. */
static inline rlf_vec3 grid_to_body(const grid_job *job, rlf_vec3 p)
{
    return rlf_mat3_mul_vec(&job->R_body_grid, rlf_sub(p, job->centre));
}

/* Speed at which a surface of this velocity and the body approach at p along the normal, m/s. */
static inline double grid_approach_at(const grid_job *job, rlf_vec3 p, rlf_vec3 normal,
                                      rlf_vec3 velocity)
{
    rlf_vec3 v = rlf_add(job->v, rlf_cross(job->w, rlf_sub(p, job->centre)));
    return rlf_dot(normal, rlf_sub(velocity, v));
}

/* Fills nearest2, is_near, is_flat, flats, surface_velocity, normals, bumps, and hits with the
 * outline's points. */
void grid_scan_footprint(grid_job *job);

/* How far the sheet's solids are from the body's centre, by its tiles alone: no less than this, or
 * beyond `reach`. What is not beyond `least` need not be told apart. */
double grid_scan_distance(const grid_job *job, const grid_tiles *tiles, double reach, double least);

#endif
