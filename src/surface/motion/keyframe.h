/* A thing as it looked when it was last at rest, and how it has moved since.
 *
 * Comparing each frame with the one before finds no motion that is less than the noise of one
 * frame. Compared with a picture of rest the motion adds up: a thing that creeps is found as soon
 * as it is somewhere else (Korn and Pauli 2015; Co-Fusion, Ruenz and Agapito 2017). */
#ifndef RLF_SURFACE_MOTION_KEYFRAME_H
#define RLF_SURFACE_MOTION_KEYFRAME_H

#include "math/rigid.h"
#include "surface/stage.h"

enum {
    KEYFRAME_POINTS = 160, /* at most */
    KEYFRAME_RIMS = 96,    /* at most */
    KEYFRAME_RING = 12,    /* frames that a velocity comes from, at most */
    KEYFRAME_REST = 12     /* frames at rest before it tells motion */
};

/* Of the surface, from the keyframe's centre, and how far off it is seen at rest. */
typedef struct keyframe_point {
    float p[3], n[3];
    float bias; /* metres along the normal */
} keyframe_point;

/* Of the outline before something farther. */
typedef struct keyframe_rim {
    float p[3], n[3]; /* from the centre, of the pixel that is the window's middle */
    float out[3];     /* unit, out of the thing, square to the ray */
    float fill;       /* of a window about it at rest: pixels that show the thing, ... */
    int32_t between;  /* ... and that may */
} keyframe_rim;

typedef enum keyframe_state { KEYFRAME_NONE = 0, KEYFRAME_RESTS, KEYFRAME_MOVES } keyframe_state;

/* A frame's pose: shift of the centre, metres, and rotation vector times the length. */
typedef struct keyframe_pose {
    double time_s, x[6];
} keyframe_pose;

typedef struct rlf_keyframe {
    keyframe_state state;
    int32_t thing; /* of the background, while it rests there; 0 = none */
    int32_t label; /* of the region that shows it, while it moves; 0 = none */
    rlf_rect rect; /* of its pixels, as it was taken */
    int32_t size;  /* pixels, then */
    rlf_vec3 centre;
    rlf_quat
        turn; /* since it was taken, of the camera's making: points are told as they were then */
    double length; /* metres: of a turn about the centre it makes a shift */
    keyframe_point point[KEYFRAME_POINTS];
    keyframe_rim rim[KEYFRAME_RIMS];
    int32_t point_count, rim_count;
    int32_t rests;       /* frames in its means */
    uint8_t moved, past; /* told to be elsewhere, seen past: a bit per frame, the newest lowest */
    double x[6];         /* pose now */
    double spread[6][6]; /* its covariance */
    double scatter[6];   /* of poses at rest: mean squares */
    keyframe_pose ring[KEYFRAME_RING];
    int32_t ring_count; /* the newest last */
    double velocity[6]; /* of the pose, per second; 0 = not significant */
    bool is_whole;      /* it is of one piece ... */
    bool has_stood;     /* ... for it stood in the background */
} rlf_keyframe;

/* What a keyframe is taken of: where `thing`, or if that is NULL `label`, is `number`. */
typedef struct keyframe_view {
    const image_grid *grid;
    const uint8_t *thing;
    const int32_t *label;
    int32_t number;
    const float *depth;
    const float *seen; /* depth of which the outline's windows are measured */
    const float *const *normal;
    rlf_kernel_noise noise;
} keyframe_view;

/* ---- keyframe.c ---- */
/* False when too little of it is seen, or of its outline. */
bool keyframe_take(const keyframe_view *view, const rlf_rect *rect, int32_t size,
                   rlf_keyframe *out);

/* ---- register.c ---- */
/* How a keyframe fits a frame. */
typedef struct keyframe_fit {
    double x[6]; /* the pose */
    math_rigid_sums sums;
    double cost;               /* squares of all rows, each no more than what is hidden costs */
    int32_t points, rims;      /* seen: neither hidden nor without depth */
    int32_t agree, rims_agree; /* of them */
} keyframe_fit;

typedef struct keyframe_frame {
    const image_grid *grid;
    const float *depth; /* as the sensor gave it */
    rlf_kernel_noise noise;
} keyframe_frame;

/* Rows at the pose fit->x; with slack metres to spare. */
void keyframe_look(const keyframe_frame *frame, const rlf_keyframe *key, double slack,
                   keyframe_fit *fit);
/* Enough of it is seen, and most of that agrees. */
bool keyframe_agrees(const rlf_keyframe *key, const keyframe_fit *fit);
/* The pose that fits best, from fit->x on. */
void keyframe_register(const keyframe_frame *frame, const rlf_keyframe *key, keyframe_fit *fit);
/* How far pose x of a fit is from rest: squares in units of its variance, 6 unknowns. `out`: the
 * covariance of poses. */
double keyframe_off(const keyframe_frame *frame, const rlf_keyframe *key, const keyframe_fit *fit,
                    const double x[6], double out[6][6]);
/* Pixel that sees a point of the keyframe in its pose; < 0 out of view. */
ptrdiff_t keyframe_pixel(const image_grid *grid, const rlf_keyframe *key, const float p[3]);
/* What a frame at rest shows goes into the means. */
void keyframe_learn(const keyframe_frame *frame, rlf_keyframe *key);

/* ---- line.c ---- */
/* The pose x is the newest. */
void keyframe_push(rlf_keyframe *key, double time_s, const double x[6]);
void keyframe_measure_velocity(rlf_keyframe *key);

/* ---- watch.c ---- */
/* Keyframes of the background's things, which have just been found anew. */
void keyframes_take_things(rlf_reconstruct *stage);
/* Those that rest in the background. `departed`, RLF_PIECES + 1: 1 of its things that move from now
 * on. */
void keyframes_watch(rlf_reconstruct *stage, const rlf_slot *slot, uint8_t *departed);

/* ---- follow.c ---- */
void keyframes_reset(velocity_planes *state);
/* One that is of nothing; NULL: there is none. */
rlf_keyframe *keyframe_find_free(velocity_planes *state);
keyframe_frame keyframe_frame_of(const rlf_reconstruct *stage);
/* The camera has moved: what follows is seen by this frame's. */
void keyframes_carry(velocity_planes *state, const rlf_pose *T_now_before);
/* Those of the foreground's regions. `is_gap`: nothing can be followed from the frame before. */
void keyframes_follow(rlf_reconstruct *stage, const rlf_slot *slot, bool is_gap);
/* The region's motion by its keyframe; NULL: it has none. */
const rlf_keyframe *keyframe_of_region(const rlf_reconstruct *stage, int32_t label);

/* ---- keyframe.c: how much of a small window a thing fills that ends in it before something
 * farther; from that its outline is known to a part of a pixel. What continues the thing's plane is
 * of it.
 */
enum { RIM_RADIUS = 3, RIM_SIDE = 2 * RIM_RADIUS + 1 }; /* of a window, pixels */

/* Metres beyond a thing that what is behind it is at least. */
#define RIM_GAP_M 0.05
/* Half the pull of a straight outline through the window's middle: less is a corner. */
#define RIM_LEAST_PULL (0.5f * (float)(RIM_SIDE * RIM_SIDE * (RIM_RADIUS + 1)) / 4.0f)

typedef struct rim_window {
    float fill;      /* pixels */
    float x, y;      /* sums of their steps from the middle */
    int32_t between; /* pixels that may be the thing, or mixed, or something close behind it */
} rim_window;

/* Of the window about pixel (x, y), for a thing with normal n at p. False out of view, or where
 * something nearer is in it. */
bool rim_look(const image_grid *grid, const float *depth, const rlf_kernel_noise *noise, rlf_vec3 p,
              rlf_vec3 n, int32_t x, int32_t y, rim_window *out);

#endif
