/* Bodies that a hand holds. What faces each other across a body and touches it on both sides holds
 * it by friction (Nguyen 1988: the line between the contacts lies in both friction cones). A depth
 * camera sees little of fingers and loses it now and then, so a critically damped joint to the
 * hand's motion carries the body until the fingers are seen to be open. No hand is recognised. */
#ifndef RLF_PHYSICS_GRAB_GRAB_H
#define RLF_PHYSICS_GRAB_GRAB_H

#include "physics/grid/contact/search.h"
#include "physics/world_state.h"

#define GRAB_POINTS_MAX 192 /* of the hand's surface */
#define GRAB_RIMS_MAX 128   /* of its outline */
#define GRAB_PAST 4         /* frames whose velocity a throw remembers: 0.1 s and a bit */
#define GRAB_PATCHES_MAX 24

struct grid_query;

/* A place of the hand's outline, where its row or column of pixels leaves the hand. */
typedef struct grab_rim {
    rlf_vec3 point;    /* hand frame */
    double along[2];   /* unit normal of the outline in the picture, u and v */
    int32_t step;      /* the next pixel that is no hand: +-1 along the row or column */
    bool is_of_column; /* the outline is crossed along its column */
} grab_rim;

/* A held body. The hand's frame is where the body's was when it was grabbed. */
struct phys_grab {
    bool is_used;
    int32_t body;
    rlf_pose T_world_hand; /* when the newest grid was seen */
    rlf_vec3 v, w;         /* of the hand then, world */
    rlf_vec3 ends[2];      /* where the two sides touched last, hand frame */
    rlf_vec3 axis;         /* unit, from the first to the second, hand frame */
    rlf_vec3 past_v[GRAB_PAST], past_w[GRAB_PAST]; /* the newest first */
    int32_t past_count;
    rlf_vec3 seat;       /* where the body sits between the sides, hand frame */
    double weight;       /* pixels that touch while it is closed, smoothed */
    int32_t open_frames; /* in a row in which little of the hand touched */
    int32_t lost_frames; /* ... in which the hand was not found */
    int32_t point_count, rim_count;
    rlf_vec3 points[GRAB_POINTS_MAX]; /* hand frame */
    grab_rim rims[GRAB_RIMS_MAX];
};

/* Surface of the foreground that touches the body about one place; sums over `weight` pixels. Body
 * frame. */
typedef struct grab_patch {
    rlf_vec3 point, normal, velocity; /* normal: the body's, outward */
    double off;                       /* m from the body, of the pixel that is nearest */
    double weight;
} grab_patch;

typedef struct grab_touches {
    grab_patch patches[GRAB_PATCHES_MAX];
    int32_t count;
    double weight; /* pixels that touch */
    double deep;   /* ... and that lie deep in the body: it is passed through */
} grab_touches;

/* Two sides that face each other, body frame. */
typedef struct grab_grip {
    grab_patch sides[2]; /* means */
    rlf_vec3 axis;       /* unit, from the first to the second */
} grab_grip;

/* Pixels' worth of noise and footprint at the body, metres: what is nearer touches. */
double grab_tolerance(const struct grid_query *query, rlf_vec3 x);

/* Collects what touches the body at that pose, the surface being tau seconds older than seen. */
void grab_look(const struct grid_query *query, const phys_body *body, const rlf_pose *T_world_body,
               double tau, double tolerance, grab_touches *out);

/* The two sides with the most pixels that hold by friction; false when there are none. */
bool grab_find_grip(const grab_touches *touches, grab_grip *out);

/* The sum of the patches on one side of a known axis. */
grab_patch grab_side(const grab_touches *touches, rlf_vec3 axis, double sign);

/* Remembers the hand's surface and outline near the body. */
void grab_learn_hand(const struct grid_query *query, const phys_body *body, phys_grab *grab);

/* Moves the hand's frame to where the grid shows the hand dt seconds later. False when it is not
 * found. */
bool grab_follow_hand(const struct grid_query *query, phys_grab *grab, double dt);

/* Whether the camera sees beyond this place of the hand's frame, so that nothing is there. */
bool grab_is_seen_through(const struct grid_query *query, const phys_grab *grab, rlf_vec3 place,
                          double tolerance);

/* A new grid: bodies are grabbed, follow their hands and are let go. */
void phys_grab_update(rlf_world *world, const struct grid_query *query, double dt);

/* Lets go of the body, which flies on as the hand moved. */
void phys_grab_release(phys_body *body);

/* Nothing is seen any more. */
void phys_grab_release_all(rlf_world *world);

/* The joint's acceleration of a held body in place of gravity's. */
void phys_grab_pull(const rlf_world *world, phys_body *body);

/* Bodies that are gone or were moved by the caller are held no more. */
void phys_grab_forget(phys_body *body);

/* ---- What follow.c and learn.c share: where a hand ends in the picture. */

/* A step in depth beyond which the next pixel is another thing, metres. */
#define GRAB_STEP_M (2.0 * GRID_NOISE_M)

/* Whether the foreground is at pixel (x, y) and the next one, dx and dy away, is none of it or far
 * behind: the outline of what is nearer. */
static inline bool grab_is_rim(const rlf_grid *grid, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    const rlf_grid_sheet *sheet = &grid->foreground;
    int32_t nx = x + dx, ny = y + dy;
    if (x < 0 || y < 0 || x >= grid->width || y >= grid->height || nx < 0 || ny < 0 ||
        nx >= grid->width || ny >= grid->height) {
        return false;
    }
    int32_t i = y * grid->width + x, k = ny * grid->width + nx;
    bool is_here = (sheet->mask == NULL || sheet->mask[i] != 0) && sheet->depth[i] > 0.0f;
    bool is_next = (sheet->mask == NULL || sheet->mask[k] != 0) && sheet->depth[k] > 0.0f;
    return is_here && (!is_next || (double)sheet->depth[k] > (double)sheet->depth[i] + GRAB_STEP_M);
}

#endif
