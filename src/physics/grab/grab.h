/* Bodies that a hand holds: what the cones of a fitted hand touch, and how the hand closes, say
 * when a body is taken; the value at that moment, not contacts that vanish, says when it is let go.
 * A critically damped joint to the hand's own look carries it. Where no hand is sure, pixels on two
 * facing sides stand in (Nguyen 1988: the line between the contacts lies in both friction cones).
 */
#ifndef RLF_PHYSICS_GRAB_GRAB_H
#define RLF_PHYSICS_GRAB_GRAB_H

#include "physics/grid/contact/search.h"
#include "physics/world_state.h"

#define GRAB_POINTS_MAX 192 /* of the hand's surface */
#define GRAB_RIMS_MAX 128   /* of its outline */
#define GRAB_PAST 4         /* frames whose velocity a throw remembers: 0.1 s and a bit */
#define GRAB_BINS 27        /* of normals: each coordinate below, about or above 0 */
#define GRAB_TOUCHES_MAX 64
#define GRAB_MOMENTS 24 /* frames that a hand's bends are remembered: 0.8 s */

struct grid_query;

/* A place of the hand's outline, where its row or column of pixels leaves the hand. */
typedef struct grab_rim {
    rlf_vec3 point;    /* hand frame */
    double along[2];   /* unit normal of the outline in the picture, u and v */
    int32_t step;      /* the next pixel that is no hand: +-1 along the row or column */
    bool is_of_column; /* the outline is crossed along its column */
} grab_rim;

/* What holds a body. */
typedef enum grab_kind {
    GRAB_NONE = 0,
    GRAB_OPPOSE = 1,  /* thumb or palm against a finger */
    GRAB_BETWEEN = 2, /* two hands */
    GRAB_CARRY = 3,   /* it lies on a hand */
    GRAB_PIXELS = 4   /* two sides are seen, no hand is known */
} grab_kind;

/* How a hand was bent, metres. */
typedef struct grab_moment {
    bool is_sure;    /* its bends count */
    double time;     /* s of the world */
    double aperture; /* thumb to index and middle, skin to skin */
    double curl;     /* fingers' tips from their roots, mean */
    rlf_vec3 palm;   /* world */
} grab_moment;

/* What is remembered of a hand. */
struct phys_grab_hand {
    int32_t id;                     /* 0 = free */
    double seen, sure;              /* s of the world, when it was last */
    grab_moment past[GRAB_MOMENTS]; /* in sure frames, the newest first */
    int32_t past_count;
    rlf_vec3 palm, core;       /* of the palm, seen and fitted; world */
    rlf_vec3 facing, velocity; /* world */
};

/* A held body. The hand's frame is where the body's was when it was grabbed. */
struct phys_grab {
    bool is_used;
    int32_t body;
    grab_kind kind;
    int32_t hands[2];      /* ids; 0 = none */
    double aperture, curl; /* least so far, metres */
    double apart[2];       /* of two palms at the grab, seen and fitted, metres */
    uint32_t open_votes;   /* bit k: k sure frames ago it was open */
    rlf_vec3 up;           /* hand frame: against gravity at the grab */
    rlf_pose T_world_hand; /* when the newest grid was seen */
    rlf_vec3 v, w;         /* of the hand then, world */
    rlf_vec3 past_v[GRAB_PAST], past_w[GRAB_PAST]; /* the newest first */
    int32_t past_count;
    double alike, usual; /* 0..1: how much of the hand looks as it did; the same, smoothed */
    bool has_changed;    /* ... and now it does not */
    double weight;       /* of pixels: how many touch while it is closed, smoothed */
    int32_t open_frames; /* in a row in which it looked another way, or little of it touched */
    int32_t lost_frames; /* ... in which it was not found */
    int32_t point_count, rim_count;
    rlf_vec3 points[GRAB_POINTS_MAX]; /* hand frame */
    grab_rim rims[GRAB_RIMS_MAX];
};

/* Sums over the pixels that touch a body where its normals are alike; body frame. */
typedef struct grab_bin {
    rlf_vec3 point, normal, velocity; /* normal: the body's, outward */
    double off;                       /* m from the body, of the pixel that is nearest */
    double weight;
} grab_bin;

/* The front of what touches a body. */
typedef struct grab_front {
    grab_bin bins[GRAB_BINS];
    double weight; /* pixels that touch */
    double deep;   /* ... and that lie deep in the body: it is passed through */
} grab_front;

/* Two sides of it that face each other, body frame. */
typedef struct grab_grip {
    grab_bin sides[2]; /* means */
    rlf_vec3 axis;     /* unit, from the first to the second */
} grab_grip;

/* One cone that touches the body; body frame. */
typedef struct grab_touch {
    rlf_vec3 point, normal; /* on the body; its own, outward */
    int32_t hand;           /* index in the grid */
    int32_t group;          /* 0 the thumb .. 4 the little finger, 5 the palm */
} grab_touch;

#define GRAB_PALM 5
#define GRAB_CLOSED_M 0.008 /* by which thumb and fingers, or two palms, came nearer ... */
#define GRAB_WINDOW_S 0.8   /* ... within this */

typedef struct grab_touches {
    grab_touch touch[GRAB_TOUCHES_MAX];
    int32_t count;
    bool is_judged;                           /* a sure hand is at it: pixels do not count */
    bool is_in[RLF_GRID_HANDS_MAX];           /* the body is where that hand grasps */
    double palm_off[RLF_GRID_HANDS_MAX];      /* of any hand's palm from the body, metres, */
    rlf_vec3 palm_normal[RLF_GRID_HANDS_MAX]; /* and the body's normal there */
} grab_touches;

/* Why a body is taken. */
typedef struct grab_reason {
    grab_kind kind;
    int32_t hands[2]; /* indices in the grid, -1 = none */
    bool is_closing;  /* on it: the hand does not push it meanwhile */
} grab_reason;

/* Pixels' worth of noise and footprint at the body, metres: what is nearer touches. */
double grab_tolerance(const struct grid_query *query, rlf_vec3 x);

/* Middle of the round end of a digit, grid frame. */
rlf_vec3 grab_tip(const rlf_grid_hand *hand, int32_t digit);
/* Middle of the fitted palm, grid frame. */
rlf_vec3 grab_core(const rlf_grid_hand *hand);

/* Collects the cones of sure hands that touch the body at that pose, moved on by tau seconds. */
void grab_touch_hands(const rlf_world *world, const struct grid_query *query, const phys_body *body,
                      const rlf_pose *T_world_body, double tau, grab_touches *out);

/* Collects the pixels that touch the body at that pose, the surface being tau seconds older than
 * seen. */
void grab_look(const struct grid_query *query, const phys_body *body, const rlf_pose *T_world_body,
               double tau, double tolerance, grab_front *out);

/* The two sides with the most pixels that hold by friction; false when there are none. */
bool grab_find_grip(const grab_front *front, grab_grip *out);

/* Notes how the grid's hands are bent. */
void grab_note_hands(rlf_world *world, const struct grid_query *query);
/* NULL when it is not remembered. */
struct phys_grab_hand *grab_hand_of(const rlf_world *world, int32_t id);
/* Whether it has come from wider to here and does not open. */
bool grab_hand_closes(const struct phys_grab_hand *hand);
/* Whether what touches takes the body. */
grab_reason grab_decide(const rlf_world *world, const struct grid_query *query,
                        const phys_body *body, const grab_touches *touches);
/* Notes the bends with which the body was taken. */
void grab_begin_hold(const rlf_world *world, phys_grab *grab);
/* Whether the hands are seen to let go. */
bool grab_has_opened(const rlf_world *world, phys_grab *grab);

/* Remembers the hand's surface and outline near the body. */
void grab_learn_hand(const struct grid_query *query, const phys_body *body, phys_grab *grab);

/* Moves the hand's frame to where the grid shows the hand dt seconds later. False when it is not
 * found. */
bool grab_follow_hand(const struct grid_query *query, phys_grab *grab, double dt);

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
