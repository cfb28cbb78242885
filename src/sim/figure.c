/* Draws people's figures.
 *
 * Means and spreads are those of ANSUR II (Gordon et al. 2014, 2012 Anthropometric Survey of U.S.
 * Army Personnel, Natick/TR-15/007; 4082 men, 1986 women), each breadth, depth and girth as a share
 * of stature. They go together (men's and women's breadths, depths and girths of trunk and limbs
 * correlate by 0.5 to 0.85): one build for the whole body, and a part of its own. Walking speeds
 * are spread as in Bohannon 1997 (Age and Ageing 26), 10 to 15 % at any age. */
#include "sim/figure.h"
#include "sim/bones.h"

#include "sim/hash.h"

#define STANDARD_STATURE 1.75
#define SHORTEST 1.50
#define TALLEST 1.95
#define SPREAD_MAX 2.0    /* standard deviations: nobody is beyond */
#define BUILD 0.8         /* share of a spread that the build explains; the rest is 0.6 */
#define CLOTHES_MAX 0.012 /* metres, around what is dressed */
#define LEG_LENGTH 0.925  /* of an adult of 1.75 m, floor to hip */
#define NECK_LENGTH 0.58  /* hip to neck */
#define ACROMION 0.8198   /* heights of the shoulder's top and the armpit, as shares of stature */
#define AXILLA 0.7607
#define SHOULDER_ROUND 0.03 /* metres that the shoulder's round end lies inside the joint */

/* As a share of stature: mean, and standard deviation as a share of that mean. */
typedef struct share {
    double mean, spread;
} share;

typedef struct population {
    double stature, stature_spread; /* metres */
    share breadth[3], depth[3];     /* of pelvis, belly, chest */
} population;

static const population women = {
    1.629,
    0.064,
    {{0.2174, 0.070}, {0.1842, 0.106}, {0.1655, 0.067}},  /* hip, waist, chest breadth */
    {{0.1431, 0.103}, {0.1309, 0.146}, {0.1520, 0.109}}}; /* buttock, waist, chest depth */
static const population men = {1.756,
                               0.069,
                               {{0.1970, 0.066}, {0.1860, 0.104}, {0.1649, 0.062}},
                               {{0.1401, 0.106}, {0.1355, 0.145}, {0.1446, 0.102}}};

/* Spreads of what is alike in women and men: girths at a given stature, and lengths. */
static const double thigh_spread = 0.089, knee_spread = 0.080, calf_spread = 0.074,
                    upper_arm_spread = 0.098, forearm_spread = 0.069, head_spread = 0.045,
                    leg_spread = 0.028, arm_spread = 0.03, shoulder_spread = 0.043,
                    pace_spread = 0.12, step_spread = 0.07;

typedef struct draw {
    uint32_t key, count;
    double build; /* standard deviations */
} draw;

static double uniform(draw *d)
{
    return synth_uniform(synth_hash2(d->key, d->count++));
}

static double normal(draw *d)
{
    double n = synth_normal(synth_hash2(d->key, d->count++));
    return rlf_clamp(n, -SPREAD_MAX, SPREAD_MAX);
}

/* A factor about 1 that follows the build. */
static double girth(draw *d, double spread)
{
    return 1.0 + spread * (BUILD * d->build + 0.6 * normal(d));
}

/* A factor about 1 that does not. */
static double length(draw *d, double spread)
{
    return 1.0 + spread * normal(d);
}

static void set_limb(synth_figure *figure, int bone, double upper, double lower, double ease)
{
    for (int32_t i = 0; i < SYNTH_PERSON_FLESH; i++) {
        synth_flesh *f = &figure->flesh[i];
        if (f->bone == bone || f->bone == bone + 1) {
            f->radius_a = f->radius_a * upper + ease;
            f->radius_b = f->radius_b * lower + ease;
        }
    }
}

static void set_trunk(synth_figure *figure, const population *p, draw *d, double stature,
                      double ease)
{
    for (int i = 0; i < 3; i++) { /* pelvis, belly, chest */
        synth_flesh *f = &figure->flesh[i];
        f->size.x = 0.5 * stature * p->breadth[i].mean * girth(d, p->breadth[i].spread) + ease;
        f->size.z = 0.5 * stature * p->depth[i].mean * girth(d, p->depth[i].spread) + ease;
        f->size.y *= figure->trunk;
        f->offset.y *= figure->trunk;
    }
    synth_flesh *shoulders = &figure->flesh[3];
    shoulders->offset.x = SHOULDER_ROUND - figure->shoulder;
    shoulders->length = -2.0 * shoulders->offset.x;
    shoulders->offset.y = -figure->shoulder_height;
    shoulders->radius_a = 0.5 * (ACROMION - AXILLA) * stature + ease;
    shoulders->radius_b = shoulders->radius_a;
    figure->clear = rlf_max(0.0, figure->flesh[0].size.x - 0.162 - (figure->shoulder - 0.185));
}

/* Scales what hangs on bones first..last as a whole. */
static void scale_flesh(synth_figure *figure, int first, int last, rlf_vec3 by)
{
    for (int32_t i = 0; i < SYNTH_PERSON_FLESH; i++) {
        synth_flesh *f = &figure->flesh[i];
        if (f->bone >= first && f->bone <= last) {
            f->offset = rlf_vec3_make(f->offset.x * by.x, f->offset.y * by.y, f->offset.z * by.z);
            f->size = rlf_vec3_make(f->size.x * by.x, f->size.y * by.y, f->size.z * by.z);
            f->length *= f->axis == 'y' ? by.y : (f->axis == 'x' ? by.x : by.z);
        }
    }
}

static void set_limbs(synth_figure *figure, draw *d, double ease)
{
    double leg = figure->leg, arm = figure->arm;
    scale_flesh(figure, SYNTH_UPPER_ARM, SYNTH_FOREARM + 1, rlf_vec3_make(arm, arm, arm));
    scale_flesh(figure, SYNTH_PALM, SYNTH_PALM + 1, rlf_vec3_make(arm, arm, arm));
    scale_flesh(figure, SYNTH_THIGH, SYNTH_FOOT + 1, rlf_vec3_make(leg, leg, leg));
    double knee = leg * girth(d, knee_spread);
    double elbow = arm * girth(d, forearm_spread), wrist = 0.5 * (arm + elbow);
    set_limb(figure, SYNTH_THIGH, leg * girth(d, thigh_spread), knee, ease);
    set_limb(figure, SYNTH_SHIN, knee, leg * girth(d, calf_spread), ease);
    set_limb(figure, SYNTH_UPPER_ARM, arm * girth(d, upper_arm_spread), elbow, ease);
    set_limb(figure, SYNTH_FOREARM, elbow, wrist, 0.0);
    set_limb(figure, SYNTH_PALM, arm, arm, 0.0);
    set_limb(figure, SYNTH_FOOT, leg, leg, 0.0);
}

/* Heads differ less than bodies do. */
static void set_head(synth_figure *figure, draw *d, double scale)
{
    double size = 0.5 + 0.5 * scale;
    rlf_vec3 by;
    by.x = size * length(d, head_spread);
    by.y = size * length(d, head_spread);
    by.z = size * length(d, head_spread);
    scale_flesh(figure, SYNTH_HEAD, SYNTH_HEAD, by);
    figure->flesh[4].radius_a *= by.x;
    figure->flesh[4].radius_b *= by.x;
}

static void draw_figure(synth_figure *figure, draw *d)
{
    const population *p = uniform(d) < 0.5 ? &women : &men;
    double stature = p->stature + p->stature_spread * normal(d);
    stature = rlf_clamp(stature, SHORTEST, TALLEST);
    double scale = stature / STANDARD_STATURE, ease = CLOTHES_MAX * uniform(d);
    d->build = normal(d);
    figure->leg = scale * length(d, leg_spread);
    figure->trunk = scale - (figure->leg - scale) * LEG_LENGTH / NECK_LENGTH;
    figure->arm = scale * length(d, arm_spread);
    figure->shoulder *= scale * length(d, shoulder_spread);
    figure->hip *= scale;
    figure->shoulder_height = 0.5 * (ACROMION + AXILLA) * stature - figure->leg * LEG_LENGTH;
    figure->pace = length(d, pace_spread);
    figure->step *= figure->leg * length(d, step_spread);
    set_trunk(figure, p, d, stature, ease);
    set_head(figure, d, scale);
    set_limbs(figure, d, ease);
}

void synth_figure_make(synth_figure *figure, uint64_t seed, bool second)
{
    *figure = (synth_figure){
        .trunk = 1.0,
        .leg = 1.0,
        .arm = 1.0,
        .shoulder = 0.185,
        .hip = 0.085,
        .shoulder_height = 0.505,
        .pace = 1.0,
        .step = 0.60,
    };
    for (int32_t i = 0; i < SYNTH_PERSON_FLESH; i++) {
        figure->flesh[i] = synth_person_flesh[i];
    }
    if (seed != 1) {
        uint32_t key = synth_hash2((uint32_t)seed, (uint32_t)(seed >> 32));
        draw d = {.key = synth_hash2(key, second ? 2u : 1u)};
        draw_figure(figure, &d);
    }
}
