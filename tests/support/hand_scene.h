/* Hands and people of balls and rods, drawn into a surface: what the tracker of hands gets, with
 * known palms and tips. */
#ifndef RLF_TEST_HAND_SCENE_H
#define RLF_TEST_HAND_SCENE_H

#include "relief/hands.h"

#include <stdlib.h>
#include <string.h>

enum { SCENE_W = 512, SCENE_H = 424, SCENE_N = SCENE_W * SCENE_H };
#define SCENE_F 365.0

typedef struct hand_scene {
    rlf_surface surface;
    float depth[SCENE_N], ray_x[SCENE_N], ray_y[SCENE_N], zero[SCENE_N];
    uint8_t foreground[SCENE_N];
    uint32_t noise; /* state of the generator */
} hand_scene;

static inline hand_scene *scene_create(void)
{
    hand_scene *s = calloc(1, sizeof(*s));
    for (int i = 0; i < SCENE_N; i++) {
        s->ray_x[i] = (float)((i % SCENE_W - 255.5) / SCENE_F);
        s->ray_y[i] = (float)((i / SCENE_W - 211.5) / SCENE_F);
    }
    rlf_surface *f = &s->surface;
    f->width = SCENE_W;
    f->height = SCENE_H;
    f->scale_factor = 1;
    f->camera.width = SCENE_W;
    f->camera.height = SCENE_H;
    f->camera.fx = f->camera.fy = SCENE_F;
    f->camera.cx = 255.5;
    f->camera.cy = 211.5;
    f->noise = (rlf_depth_noise){.c0 = 0.0, .c1 = 0.0, .c2 = 0.0015};
    f->depth = s->depth;
    f->foreground = s->foreground;
    f->ray_x = s->ray_x;
    f->ray_y = s->ray_y;
    f->normal_x = f->normal_y = f->normal_z = s->zero;
    s->noise = 1;
    return s;
}

/* A wall behind everything, and a new frame. */
static inline void scene_clear(hand_scene *s, double wall, int64_t time_ns)
{
    for (int i = 0; i < SCENE_N; i++) {
        s->depth[i] = (float)wall;
        s->foreground[i] = 0;
    }
    s->surface.time_ns = time_ns;
    s->surface.sequence++;
}

static inline void scene_ball(hand_scene *s, rlf_vec3 c, double r)
{
    const double px = SCENE_F * r / c.z;
    const double u = 255.5 + SCENE_F * c.x / c.z, v = 211.5 + SCENE_F * c.y / c.z;
    for (int y = (int)(v - px); y <= (int)(v + px) + 1; y++) {
        for (int x = (int)(u - px); x <= (int)(u + px) + 1; x++) {
            const double d2 = ((x - u) * (x - u) + (y - v) * (y - v)) / (px * px);
            if (x < 0 || y < 0 || x >= SCENE_W || y >= SCENE_H || d2 > 1.0) {
                continue;
            }
            const float z = (float)(c.z - r * sqrt(1.0 - d2));
            const int i = y * SCENE_W + x;
            if (z < s->depth[i]) {
                s->depth[i] = z;
                s->foreground[i] = 1;
            }
        }
    }
}

/* From a to b, as thick at both ends as said. */
static inline void scene_rod(hand_scene *s, rlf_vec3 a, rlf_vec3 b, double r_a, double r_b)
{
    const double length = rlf_length(rlf_sub(b, a));
    const int n = (int)(length / 0.003) + 1;
    for (int k = 0; k <= n; k++) {
        const double t = (double)k / n;
        scene_ball(s, rlf_add(rlf_scale(a, 1.0 - t), rlf_scale(b, t)), r_a + t * (r_b - r_a));
    }
}

/* Gaussian noise of the surface's sigma, from twelve uniform numbers. */
static inline void scene_noise(hand_scene *s)
{
    for (int i = 0; i < SCENE_N; i++) {
        double sum = -6.0;
        for (int k = 0; k < 12; k++) {
            s->noise = s->noise * 1664525u + 1013904223u;
            sum += (double)(s->noise >> 8) / 16777216.0;
        }
        const double z = (double)s->depth[i];
        s->depth[i] = (float)(z + sum * rlf_depth_noise_sigma(&s->surface.noise, z));
    }
}

enum { FINGERS_THUMB = 1, FINGERS_INDEX = 2, FINGERS_ALL = 31, FINGERS_RING = 32 };

/* A hand in the plane across the view, and what is true of it. */
typedef struct scene_hand {
    rlf_vec3 palm;   /* middle of its depth */
    double turn;     /* radians; 0: fingers up, arm from below; > 0: clockwise in the picture */
    int fingers;     /* bits, the thumb first */
    double arm;      /* its length, metres */
    rlf_vec3 tip[5]; /* out: ends of the fingers that are stretched */
    rlf_vec3 pinch;  /* out: where thumb and index meet */
} scene_hand;

/* `across` to the right of fingers that point up, `along` towards the tips. */
static inline rlf_vec3 scene_hand_point(const scene_hand *h, double across, double along)
{
    const double c = rlf_cos(h->turn), s = rlf_sin(h->turn);
    return rlf_add(h->palm, rlf_vec3_make(c * across + s * along, s * across - c * along, 0.0));
}

/* Thumb and index meet before the palm, which faces the camera. */
static inline void scene_hand_ring(hand_scene *s, scene_hand *h)
{
    static const double index[4][3] = {{-0.028, 0.040, 0.0},
                                       {-0.031, 0.072, 0.032},
                                       {-0.036, 0.064, 0.057},
                                       {-0.041, 0.050, 0.070}};
    static const double thumb[4][3] = {{-0.022, -0.030, 0.008},
                                       {-0.056, -0.004, 0.026},
                                       {-0.054, 0.024, 0.048},
                                       {-0.045, 0.038, 0.061}};
    rlf_vec3 at[2], next[2];
    for (int k = 0; k < 4; k++) {
        for (int digit = 0; digit < 2; digit++) {
            const double *p = digit == 0 ? thumb[k] : index[k];
            next[digit] = scene_hand_point(h, p[0], p[1]);
            next[digit].z -= p[2];
            if (k > 0) {
                scene_rod(s, at[digit], next[digit], 0.009, 0.008);
            }
            at[digit] = next[digit];
        }
    }
    h->pinch = rlf_scale(rlf_add(at[0], at[1]), 0.5);
}

/* A finger that is bent over the palm, which faces the camera; the thumb lies over the others. */
static inline void scene_fold(hand_scene *s, const scene_hand *h, int finger, rlf_vec3 root)
{
    static const double across[5][3] = {{-0.045, -0.030, -0.005},
                                        {-0.028, -0.027, -0.026},
                                        {-0.009, -0.008, -0.008},
                                        {0.010, 0.010, 0.010},
                                        {0.028, 0.027, 0.026}};
    static const double thumb[3][2] = {{0.002, 0.015}, {0.022, 0.038}, {0.022, 0.048}};
    static const double others[3][2] = {{0.045, 0.036}, {0.020, 0.036}, {0.012, 0.018}};
    for (int k = 0; k < 3; k++) {
        const double *at = finger == 0 ? thumb[k] : others[k];
        rlf_vec3 next = scene_hand_point(h, across[finger][k], at[0]);
        next.z -= at[1];
        scene_rod(s, root, next, 0.0095 - 0.0005 * k, 0.009 - 0.0005 * k);
        root = next;
    }
}

/* A palm of 84 mm, fingers 16 mm thick that end 92 to 129 mm from its centre. */
static inline void scene_draw_hand(hand_scene *s, scene_hand *h)
{
    static const double base[5] = {-0.030, -0.030, -0.010, 0.010, 0.030};
    static const double end[5][2] = {
        {-0.096, 0.036}, {-0.046, 0.118}, {-0.013, 0.128}, {0.020, 0.120}, {0.053, 0.098}};
    for (int k = 1; k < 5; k++) {
        scene_rod(s, scene_hand_point(h, 0.7 * base[k], -0.045),
                  scene_hand_point(h, base[k], 0.038), 0.013, 0.012);
    }
    for (int k = 0; k < 5; k++) {
        const rlf_vec3 from = scene_hand_point(h, base[k], k == 0 ? -0.020 : 0.038);
        const rlf_vec3 to = scene_hand_point(h, end[k][0], end[k][1]);
        h->tip[k] = to;
        if ((h->fingers & (1 << k)) != 0) {
            scene_rod(s, from, to, 0.0085, 0.008);
        } else if ((h->fingers & FINGERS_RING) == 0 || k > 1) {
            scene_fold(s, h, k, from);
        }
    }
    if ((h->fingers & FINGERS_RING) != 0) {
        scene_hand_ring(s, h);
    }
    scene_rod(s, scene_hand_point(h, 0.0, -0.055), scene_hand_point(h, 0.0, -0.085), 0.027, 0.026);
    scene_rod(s, scene_hand_point(h, 0.0, -0.085), scene_hand_point(h, 0.0, -0.085 - h->arm), 0.026,
              0.042);
}

#endif
