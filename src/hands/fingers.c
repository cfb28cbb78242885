/* Fingers as peaks of the outline's distance from the palm's centre, by direction. */
#include "hands/fingers.h"

#include <string.h>

#define DIRECTIONS 128
#define ARM_COS 0.5          /* directions this close to the arm's are the arm: 60 degrees */
#define FINGER_REACH 1.80    /* a finger ends beyond so many palm radii from its centre */
#define PROMINENCE_M 0.014   /* and sticks out of what is beside it by its own width */
#define FINGER_END_M 0.018   /* its last joint is so long */
#define FINGER_WIDTH_M 0.030 /* and not wider than this; two fingers side by side are */
#define HAND_REACH_M 0.145   /* no finger's end is further from the palm's centre */
#define TIP_M 0.006          /* of the end, that is averaged */

typedef struct outline {
    float far[DIRECTIONS]; /* of the furthest pixel in this direction, metres; 0 = none */
    int32_t pixel[DIRECTIONS];
} outline;

/* Direction as a number 0 .. DIRECTIONS - 1 that goes round once: by the diamond |x| + |y| = 1. */
static int32_t direction_of(double x, double y)
{
    const double sum = (x < 0 ? -x : x) + (y < 0 ? -y : y);
    const double t = sum > 0.0 ? y / sum : 0.0;
    const double turn = x >= 0.0 ? (y >= 0.0 ? t : 4.0 + t) : 2.0 - t;
    const int32_t k = (int32_t)(turn * (DIRECTIONS / 4.0));
    return k < DIRECTIONS ? k : DIRECTIONS - 1;
}

/* Pixel i is of the arm by its direction in the picture or, of an arm towards the camera that the
 * hand hides, in space. */
static bool is_of_arm(const hand_patch *p, const hand_palm *palm, int32_t i)
{
    const double pixel = (double)p->spacing * palm->z;
    const double x = i % p->width - palm->x, y = (double)(i / p->width) - palm->y;
    const double square = x * x + y * y, disc = palm->radius * palm->radius;
    const double forward = x * palm->arm_x + y * palm->arm_y;
    const bool is_behind = forward * forward > ARM_COS * ARM_COS * square ||
                           (double)p->along[i] > palm->along + palm->radius;
    const rlf_vec3 off = rlf_sub(hand_patch_point(p, i), palm->centre);
    const double ahead = rlf_dot(off, palm->arm), away = rlf_dot(off, off);
    return (forward < 0.0 && is_behind && square * pixel * pixel > disc) ||
           (ahead < 0.0 && ahead * ahead > ARM_COS * ARM_COS * away && away > disc);
}

/* Reads the outline; returns the hand's area in pixels. Distances are those in the picture: at an
 * edge the depth is a mix of both sides, and would make the longest finger of noise. */
static int32_t read_outline(outline *o, const hand_patch *p, const hand_palm *palm)
{
    const double pixel = (double)p->spacing * palm->z;
    int32_t area = 0;
    memset(o, 0, sizeof(*o));
    for (int32_t i = 0; i < p->width * p->height; i++) {
        if (p->disc[i] <= 0 || is_of_arm(p, palm, i)) {
            continue;
        }
        const double x = i % p->width - palm->x, y = (double)(i / p->width) - palm->y;
        const float far = (float)(sqrt(x * x + y * y) * pixel);
        if ((double)far > HAND_REACH_M) {
            continue;
        }
        area++;
        const int32_t k = direction_of(x, y);
        if (far > o->far[k]) {
            o->far[k] = far;
            o->pixel[k] = i;
        }
    }
    return area;
}

static int32_t turn(int32_t k, int32_t by)
{
    return (k + by + DIRECTIONS) % DIRECTIONS;
}

/* How many directions to one side of k are further than `level`; -1: something there is further
 * than k itself. */
static int32_t shoulder(const outline *o, int32_t k, int32_t by, float level)
{
    for (int32_t n = 1; n < DIRECTIONS / 2; n++) {
        const float far = o->far[turn(k, n * by)];
        if (far > o->far[k] || (far == o->far[k] && by < 0)) {
            return -1;
        }
        if (far < level) {
            return n - 1;
        }
    }
    return -1;
}

static double width_at(const outline *o, const hand_patch *p, int32_t k, float level)
{
    int32_t left = 0, right = 0;
    while (left < DIRECTIONS / 4 && o->far[turn(k, -left - 1)] > level) {
        left++;
    }
    while (right < DIRECTIONS / 4 && o->far[turn(k, right + 1)] > level) {
        right++;
    }
    const rlf_vec3 a = hand_patch_point(p, o->pixel[turn(k, -left)]);
    const rlf_vec3 b = hand_patch_point(p, o->pixel[turn(k, right)]);
    return rlf_length(rlf_sub(a, b));
}

/* Mean of the outline's points within TIP_M of the end. */
static rlf_vec3 end_of(const outline *o, const hand_patch *p, int32_t k)
{
    const float level = o->far[k] - (float)TIP_M;
    rlf_vec3 sum = hand_patch_point(p, o->pixel[k]);
    int32_t count = 1;
    for (int32_t by = -1; by <= 1; by += 2) {
        for (int32_t n = 1; n < 12 && o->far[turn(k, n * by)] > level; n++) {
            sum = rlf_add(sum, hand_patch_point(p, o->pixel[turn(k, n * by)]));
            count++;
        }
    }
    return rlf_scale(sum, 1.0 / count);
}

static void add_end(hand_fingers *f, const outline *o, const hand_patch *p, int32_t k)
{
    if (width_at(o, p, k, o->far[k] - (float)FINGER_END_M) > FINGER_WIDTH_M) {
        f->has_wide_end = true;
    } else if (f->tip_count < RLF_HAND_TIPS_MAX) {
        f->tip_reach[f->tip_count] = (double)o->far[k];
        f->tip[f->tip_count++] = end_of(o, p, k);
    }
}

void hand_fingers_find(hand_fingers *f, const hand_patch *p, const hand_palm *palm)
{
    outline o;
    memset(f, 0, sizeof(*f));
    const int32_t area = read_outline(&o, p, palm);
    const double pixel = (double)p->spacing * palm->z;
    f->area = area * pixel * pixel / (RLF_PI * palm->radius * palm->radius);
    rlf_vec3 sum = {0, 0, 0};
    for (int32_t k = 0; k < DIRECTIONS; k++) {
        const double reach = (double)o.far[k] / palm->radius;
        f->reach = rlf_max(f->reach, reach);
        if (reach > FINGER_REACH) {
            sum = rlf_add(sum, rlf_sub(hand_patch_point(p, o.pixel[k]), palm->centre));
        }
        const float level = o.far[k] - (float)PROMINENCE_M;
        if (reach > FINGER_REACH && shoulder(&o, k, -1, level) >= 0 &&
            shoulder(&o, k, 1, level) >= 0) {
            add_end(f, &o, p, k);
        }
    }
    f->direction = rlf_length(sum) > 1e-6 ? rlf_normalize(sum) : palm->arm;
}
