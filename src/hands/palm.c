/* Where the palm is, how it lies and where its arm comes from. */
#include "hands/palm.h"

#define BIN_M 0.01            /* of the profile along the limb */
#define BINS 32               /* LIMB_PART_M */
#define PALM_FROM_M 0.02      /* a palm's centre is at least this far from the tip, */
#define PALM_TO_M 0.14        /* and at most this far: the longest hands */
#define NEARLY 0.92           /* discs of one palm are as large as this share of the largest */
#define WRIST_SHARE 0.88      /* of the palm, that a wrist is narrower than */
#define CUT_BINS 7            /* where the patch or the limb ends, discs are cut so far before */
#define WRIST_TO_PALM_BINS 13 /* most between them: half a hand and the narrow part */
#define PALM_BINS 4           /* from where it is nearly as wide to its middle */
#define WRIST_LEAST_M 0.018   /* half of a wrist seen edge-on; less is a neck of what is held */
#define RADIUS_LEAST_M 0.010  /* a hand seen edge-on is 25 mm thick */
#define FOREARM_BINS 9        /* behind the palm's centre the wrist is over, */
#define FOREARM_MOST 14       /* and so much of the forearm is compared */
#define ARM_FROM_M 0.055      /* behind the palm's centre there is the wrist, */
#define ARM_TO_M 0.17         /* and forearm up to here */

typedef struct profile {
    double radius[BINS]; /* of the largest disc this far along the limb */
    int32_t pixel[BINS];
} profile;

static bool is_limb(const hand_patch *p, int32_t i)
{
    return p->disc[i] > 0;
}

static void read_profile(profile *f, const hand_patch *p)
{
    *f = (profile){{0}, {0}};
    for (int32_t i = 0; i < p->width * p->height; i++) {
        const int32_t bin = is_limb(p, i) ? (int32_t)((double)p->along[i] / BIN_M) : BINS;
        if (bin < BINS) {
            const double r = hand_patch_radius(p, i);
            if (r > f->radius[bin]) {
                f->radius[bin] = r;
                f->pixel[bin] = i;
            }
        }
    }
}

static int32_t widest(const profile *f, int32_t begin, int32_t end)
{
    int32_t best = begin > 0 ? begin : 0;
    for (int32_t b = best; b < end && b < BINS; b++) {
        best = f->radius[b] > f->radius[best] ? b : best;
    }
    return best;
}

/* Bins cut discs: each takes the larger of its neighbours'. */
static profile widened(const profile *f)
{
    profile w;
    for (int32_t b = 0; b < BINS; b++) {
        const int32_t k = widest(f, b - 1, b + 2);
        w.radius[b] = f->radius[k];
        w.pixel[b] = f->pixel[k];
    }
    return w;
}

/* The first hump from the wrist towards the tip. */
static int32_t hump(const profile *f, int32_t wrist)
{
    const double wide = f->radius[wrist] / WRIST_SHARE;
    const int32_t end = wrist > WRIST_TO_PALM_BINS ? wrist - WRIST_TO_PALM_BINS : 0;
    int32_t peak = wrist;
    for (int32_t b = wrist - 1; b >= end; b--) {
        if (f->radius[b] > f->radius[peak]) {
            peak = b;
        } else if (f->radius[peak] > wide && f->radius[b] < NEARLY * f->radius[peak]) {
            break;
        }
    }
    const bool still_rises =
        f->radius[widest(f, end - 3, wrist)] > f->radius[peak] && peak <= end + 2;
    return f->radius[peak] > wide && !still_rises ? peak : -1;
}

/* From the arm towards the tip: the first narrow place that is as wide as a wrist, with a hump
 * beyond it. What the hand holds lies further on and may be wider. Returns the palm's bin, or -1
 * without a wrist. */
static int32_t beyond_wrist(const profile *f, double length)
{
    const int32_t end = (int32_t)rlf_min(length / BIN_M, BINS) - CUT_BINS;
    for (int32_t wrist = end; wrist > 4; wrist--) {
        const bool is_narrow =
            f->radius[wrist] > WRIST_LEAST_M && f->radius[wrist] <= f->radius[wrist + 1];
        const int32_t palm = is_narrow ? hump(f, wrist) : -1;
        if (palm >= 0) {
            return palm;
        }
    }
    return -1;
}

/* The middle of the discs that are nearly as large as the one at `seed`: it moves by less than a
 * pixel when the mask's edge flickers. */
static void centre_disc(hand_palm *palm, const hand_patch *p, int32_t seed)
{
    const double radius = hand_patch_radius(p, seed);
    const double pixel = (double)(p->spacing * p->z[seed]);
    const double seed_x = seed % p->width, seed_y = (double)(seed / p->width);
    double sum = 0.0, x = 0.0, y = 0.0;
    for (int32_t i = 0; i < p->width * p->height; i++) {
        const double r = is_limb(p, i) ? hand_patch_radius(p, i) : 0.0;
        if (r <= NEARLY * radius) {
            continue;
        }
        const double dx = i % p->width - seed_x, dy = (double)(i / p->width) - seed_y;
        if ((dx * dx + dy * dy) * pixel * pixel < 0.5 * radius * radius) {
            const double weight = r - NEARLY * radius;
            sum += weight;
            x += weight * dx;
            y += weight * dy;
        }
    }
    palm->x = seed_x + (sum > 0.0 ? x / sum : 0.0);
    palm->y = seed_y + (sum > 0.0 ? y / sum : 0.0);
    palm->radius = radius;
    palm->along = (double)p->along[seed];
}

/* Depth, normal and centre from the inner half of the disc, where all pixels are the palm's. */
static void fit_palm(hand_palm *palm, const hand_patch *p, int32_t seed)
{
    const rlf_surface *s = p->surface;
    const double pixel = (double)(p->spacing * p->z[seed]);
    const double reach = 0.6 * palm->radius / pixel;
    rlf_vec3 sum = {0, 0, 0}, normal = {0, 0, 0};
    int32_t count = 0;
    for (int32_t i = 0; i < p->width * p->height; i++) {
        if (p->mask[i] != 1) {
            continue;
        }
        const double dx = i % p->width - palm->x, dy = (double)(i / p->width) - palm->y;
        if (dx * dx + dy * dy <= reach * reach + 1.0) {
            const int32_t k = hand_patch_pixel(p, i);
            sum = rlf_add(sum, hand_patch_point(p, i));
            normal = rlf_add(normal, rlf_vec3_make((double)s->normal_x[k], (double)s->normal_y[k],
                                                   (double)s->normal_z[k]));
            count++;
        }
    }
    palm->centre = count > 0 ? rlf_scale(sum, 1.0 / count) : hand_patch_point(p, seed);
    palm->z = palm->centre.z;
    palm->normal = rlf_length(normal) > 0.1 * count ? rlf_normalize(normal)
                                                    : rlf_normalize(rlf_neg(palm->centre));
}

/* From the middle of the forearm; without one from the tip through the palm, backwards. */
static void find_arm(hand_palm *palm, const hand_patch *p)
{
    rlf_vec3 arm = {0, 0, 0}, end = {0, 0, 0};
    int32_t arms = 0, ends = 0;
    for (int32_t i = 0; i < p->width * p->height; i++) {
        const double behind = is_limb(p, i) ? (double)p->along[i] - palm->along : 0.0;
        if (behind > ARM_FROM_M && behind < ARM_TO_M) {
            arm = rlf_add(arm, hand_patch_point(p, i));
            arms++;
        } else if (is_limb(p, i) && behind < -0.5 * palm->along) {
            end = rlf_add(end, hand_patch_point(p, i));
            ends++;
        }
    }
    if (arms >= 8) {
        palm->arm = rlf_normalize(rlf_sub(palm->centre, rlf_scale(arm, 1.0 / arms)));
    } else if (ends > 0) {
        palm->arm = rlf_normalize(rlf_sub(rlf_scale(end, 1.0 / ends), palm->centre));
    }
    palm->arm = rlf_length(palm->arm) > 0.5 ? palm->arm : rlf_vec3_make(0, -1, 0);
}

/* The first disc from the tip that is nearly as large as the largest that a palm may be. */
static int32_t first_wide(const profile *f)
{
    const int32_t from = (int32_t)(PALM_FROM_M / BIN_M), to = (int32_t)(PALM_TO_M / BIN_M);
    const int32_t largest = widest(f, from, to);
    int32_t bin = from;
    while (bin < largest && f->radius[bin] < NEARLY * f->radius[largest]) {
        bin++;
    }
    return widest(f, bin, bin + PALM_BINS < to ? bin + PALM_BINS : to);
}

/* How wide the forearm is, and how far from a straight taper: what holds a hand up is a smooth
 * cone; a hand behind a thing, or a trunk with limbs of its own, is none. */
static void measure_forearm(hand_palm *palm, const profile *f, double length)
{
    const int32_t from = (int32_t)(palm->along / BIN_M) + FOREARM_BINS;
    const int32_t limit = (int32_t)rlf_min(length / BIN_M, BINS) - 1;
    const int32_t to = from + FOREARM_MOST < limit ? from + FOREARM_MOST : limit;
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (int32_t b = from; b < to; b++) {
        if (f->radius[b] <= 0.0) {
            continue;
        }
        n += 1.0;
        x += b;
        y += f->radius[b];
        xx += (double)b * b;
        xy += b * f->radius[b];
        yy += f->radius[b] * f->radius[b];
    }
    if (n < 3.0) {
        return;
    }
    const double sxx = xx - x * x / n, sxy = xy - x * y / n, syy = yy - y * y / n;
    palm->forearm = n * BIN_M;
    palm->forearm_half = y / n;
    palm->forearm_spread = sqrt(rlf_max(syy - sxy * sxy / sxx, 0.0) / n) / palm->forearm_half;
}

bool hand_palm_find(hand_palm *palm, const hand_patch *p)
{
    profile read;
    read_profile(&read, p);
    const profile f = widened(&read);
    *palm = (hand_palm){.x = 0};
    int32_t bin = beyond_wrist(&f, p->length);
    palm->has_wrist = bin >= 0;
    bin = bin >= 0 ? bin : first_wide(&f);
    if (f.radius[bin] < RADIUS_LEAST_M) {
        return false;
    }
    centre_disc(palm, p, f.pixel[bin]);
    fit_palm(palm, p, f.pixel[bin]);
    find_arm(palm, p);
    measure_forearm(palm, &f, p->length);
    return true;
}
