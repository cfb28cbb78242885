/* Two fingers and the hand that they belong to, as a depth camera sees them, into the foreground of
 * a grid fixture: capsules, with the fingers' own velocities. */
#ifndef RLF_TEST_GRID_HAND_H
#define RLF_TEST_GRID_HAND_H

#include "grid_fixture.h"

#define GRID_FINGER_R 0.009 /* a finger's radius, metres */

/* The fingers' tips end a little beyond `place`, `gap` apart along `across`. */
typedef struct grid_hand {
    rlf_vec3 place;         /* in the middle between the tips, metres */
    rlf_vec3 along, across; /* unit, square to each other */
    rlf_vec3 velocity;      /* m/s */
    double gap;             /* between the fingers, metres */
    double closing;         /* change of the gap, m/s */
    double noise;           /* of depth, metres */
    bool is_one;            /* only the first finger is there */
} grid_hand;

typedef struct grid_limb {
    rlf_shape shape;
    rlf_pose pose;
    rlf_vec3 velocity;
} grid_limb;

/* A capsule from a to b. */
static inline grid_limb grid_limb_make(rlf_vec3 a, rlf_vec3 b, double radius, rlf_vec3 velocity)
{
    rlf_vec3 d = rlf_sub(b, a), y = rlf_normalize(d), up = {0, 1, 0};
    rlf_vec3 axis = rlf_cross(up, y);
    double s = rlf_length(axis);
    axis = s > 1e-9 ? rlf_scale(axis, 1.0 / s) : rlf_vec3_make(1, 0, 0);
    grid_limb limb = {.velocity = velocity};
    limb.shape = (rlf_shape){.type = RLF_SHAPE_CAPSULE, .radius = radius, .height = rlf_length(d)};
    limb.pose.p = rlf_scale(rlf_add(a, b), 0.5);
    limb.pose.q = rlf_quat_from_axis_angle(axis, rlf_atan2(s, y.y));
    return limb;
}

/* Noise of unit variance, the same for a seed. */
static inline double grid_hand_noise(uint32_t *seed)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        *seed = *seed * 1664525u + 1013904223u;
        sum += (*seed >> 8) / 8388608.0 - 1.0;
    }
    return sum;
}

static inline void grid_limb_see(grid_fixture *f, const grid_limb *limb)
{
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_fixture_ray(f, i), gradient;
        double enter, leave, reach = 0.5 * limb->shape.height + limb->shape.radius;
        double closest = rlf_dot(ray, limb->pose.p) / rlf_dot(ray, ray);
        if (rlf_length(rlf_sub(rlf_scale(ray, closest), limb->pose.p)) > reach) {
            continue;
        }
        rlf_vec3 origin = rlf_transform_inverse(&limb->pose, rlf_vec3_make(0, 0, 0));
        rlf_vec3 way = rlf_rotate(rlf_quat_conjugate(limb->pose.q), ray);
        if (!rlf_shape_cast(&limb->shape, origin, way, &enter, &leave) ||
            (f->mask[i] != 0 && (double)f->planes[6][i] < enter)) {
            continue;
        }
        rlf_shape_distance(&limb->shape, rlf_mad(origin, way, enter), &gradient);
        rlf_vec3 n = rlf_rotate(limb->pose.q, gradient);
        f->mask[i] = 1;
        f->labels[1][i] = 2;
        grid_fixture_paint(f, GRID_FOREGROUND, i, enter, n);
        f->planes[10][i] = (float)limb->velocity.x;
        f->planes[11][i] = (float)limb->velocity.y;
        f->planes[12][i] = (float)limb->velocity.z;
        f->planes[13][i] = (float)rlf_max(leave - enter, 0.005);
    }
}

/* The foreground as seen in this frame. */
static inline void grid_hand_see(grid_fixture *f, const grid_hand *hand, int32_t frame)
{
    memset(f->mask, 0, (size_t)GRID_W * GRID_H);
    memset(f->planes[6], 0, sizeof(float) * GRID_W * GRID_H);
    f->grid.time_ns++;
    double half = 0.5 * hand->gap + GRID_FINGER_R;
    rlf_vec3 knuckle = rlf_mad(hand->place, hand->along, -0.09);
    for (int side = -1; side <= (hand->is_one ? -1 : 1); side += 2) {
        rlf_vec3 tip = rlf_mad(rlf_mad(hand->place, hand->along, 0.01), hand->across, side * half);
        rlf_vec3 root = rlf_mad(knuckle, hand->across, side * half);
        rlf_vec3 v = rlf_mad(hand->velocity, hand->across, 0.5 * side * hand->closing);
        grid_limb finger = grid_limb_make(tip, root, GRID_FINGER_R, v);
        grid_limb_see(f, &finger);
        rlf_vec3 palm = rlf_mad(knuckle, hand->along, -0.02);
        grid_limb bridge = grid_limb_make(root, palm, 0.015, hand->velocity);
        grid_limb_see(f, &bridge);
    }
    rlf_vec3 palm = rlf_mad(knuckle, hand->along, -0.03);
    grid_limb arm = grid_limb_make(palm, rlf_mad(palm, hand->along, -0.4), 0.03, hand->velocity);
    grid_limb_see(f, &arm);
    uint32_t seed = (uint32_t)frame + 1;
    for (int32_t i = 0; i < GRID_W * GRID_H && hand->noise > 0; i++) {
        f->planes[6][i] += f->mask[i] != 0 ? (float)(hand->noise * grid_hand_noise(&seed)) : 0.0f;
    }
}

#endif
