/* Which way is up: floors and tables lie across it, walls along it (Gupta, Arbelaez, Malik 2013:
 * Perceptual organization and recognition of indoor scenes from RGB-D images: the gravity
 * direction). In a room all three axes fit equally well, so several starts are followed, and the
 * least tilted answer with a floor under it, or else a ceiling over it, is taken. */
#include "relief/surface.h"

#include "math/eigen.h"

#define STEP 4 /* pixels between samples, both ways */

/* Rounds with each of two angles: 45 degrees, where each normal is one or the other, then 15. */
#define ROUNDS 5
static const double along_cos[2] = {0.70710678, 0.96592583};
static const double across_cos[2] = {0.70710678, 0.25881905};

/* Level; 30 and 60 degrees down; rolled by 35 degrees either way. */
#define STARTS 5
static const rlf_vec3 starts[STARTS] = {
    {0, -1, 0}, {0, -0.866, -0.5}, {0, -0.5, -0.866}, {0.574, -0.819, 0}, {-0.574, -0.819, 0}};

#define SURE_SHARE 0.03   /* the best direction must beat the next by this share of all normals */
#define FLOOR_SHARE 0.03  /* of the normals must look up, or down from a ceiling */
#define FIT_SHARE 0.85    /* of the best fit of all starts: less is no room's axis */
#define TILT_MAX 1.13     /* 65 degrees: beyond it a wall is as good a floor */
#define CEILING_TILT 0.45 /* 26 degrees: a camera tilted more sees no ceiling but a wall */
#define CEILING_COST 0.61 /* radians of tilt: a ceiling is rarer than a floor */

typedef struct up_sums {
    double a[4][4];                /* of n n^T of the normals across, minus of those along */
    int32_t up, down, across, all; /* normals */
} up_sums;

static void add_normal(up_sums *sums, rlf_vec3 n, double sign)
{
    const double v[3] = {n.x, n.y, n.z};
    for (int32_t k = 0; k < 9; k++) {
        sums->a[k / 3][k % 3] += sign * v[k / 3] * v[k % 3];
    }
}

static up_sums sum_normals(const rlf_surface *s, rlf_vec3 up, int32_t angle)
{
    up_sums sums = {{{0}}, 0, 0, 0, 0};
    for (int32_t y = 0; y < s->height; y += STEP) {
        for (int32_t x = 0; x < s->width; x += STEP) {
            int32_t i = y * s->width + x;
            rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
            if (n.x == 0.0 && n.y == 0.0 && n.z == 0.0) {
                continue;
            }
            double c = rlf_dot(n, up);
            bool is_up = c > along_cos[angle], is_down = -c > along_cos[angle];
            bool is_across = c < across_cos[angle] && -c < across_cos[angle];
            sums.all++;
            sums.up += is_up;
            sums.down += is_down;
            sums.across += is_across;
            if (is_up || is_down || is_across) {
                add_normal(&sums, n, is_across ? 1.0 : -1.0);
            }
        }
    }
    return sums;
}

/* Moves *up to the direction with the least sum of squares: of cosines to normals across it and
 * sines to those along it. False when another direction does nearly as well. */
static bool improve(up_sums *sums, double weight, rlf_vec3 *up)
{
    double values[4], vectors[4][4];
    math_eigen(sums->a, 3, values, vectors);
    int32_t best = values[1] < values[0] ? 1 : 0;
    best = values[2] < values[best] ? 2 : best;
    double next = rlf_min(values[(best + 1) % 3], values[(best + 2) % 3]);
    rlf_vec3 found = {vectors[0][best], vectors[1][best], vectors[2][best]};
    *up = rlf_dot(found, *up) < 0.0 ? rlf_neg(found) : found;
    return weight > 0.0 && next - values[best] > SURE_SHARE * weight;
}

typedef struct up_end {
    rlf_vec3 up;
    int32_t fit; /* normals along or across it; 0 = there is neither floor nor ceiling */
    double cost; /* tilt, radians, and more if there is more ceiling than floor */
} up_end;

/* Where a start leads. */
static up_end follow(const rlf_surface *surface, rlf_vec3 start)
{
    up_end end = {start, 0, 0.0};
    for (int32_t round = 0; round < 2 * ROUNDS; round++) {
        up_sums sums = sum_normals(surface, end.up, round / ROUNDS);
        if (!improve(&sums, sums.all, &end.up)) {
            return end;
        }
    }
    up_sums last = sum_normals(surface, end.up, 1);
    bool is_ceiling = last.down >= last.up;
    double tilt = rlf_acos(rlf_clamp(-end.up.y, -1.0, 1.0));
    end.cost = tilt + (is_ceiling ? CEILING_COST : 0.0);
    if ((is_ceiling ? last.down : last.up) > FLOOR_SHARE * last.all &&
        tilt < (is_ceiling ? CEILING_TILT : TILT_MAX)) {
        end.fit = last.up + last.down + last.across;
    }
    return end;
}

/* Or ceiling. */
static bool is_floor(const rlf_surface *s, int32_t i, rlf_vec3 up)
{
    rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
    double c = rlf_dot(n, up);
    return c > along_cos[1] || -c > along_cos[1];
}

/* Adds what lies between two floor pixels, weighed by how exact depth is there. */
static double add_chord(up_sums *sums, const rlf_surface *s, int32_t i, int32_t k, rlf_vec3 up,
                        double most_sin)
{
    rlf_vec3 d = rlf_sub(rlf_surface_point(s, k), rlf_surface_point(s, i));
    double rise = rlf_dot(d, up), z = rlf_max(s->depth[i], s->depth[k]);
    if (rise * rise < most_sin * most_sin * rlf_dot(d, d)) {
        double weight = 1.0 / (z * z * z * z);
        add_normal(sums, d, weight);
        return weight * rlf_dot(d, d);
    }
    return 0.0;
}

/* Chords of `length` pixels to the right and down from every floor pixel; returns their weight. */
static double add_chords(up_sums *sums, const rlf_surface *s, int32_t length, rlf_vec3 up,
                         double most_sin)
{
    double weight = 0.0;
    for (int32_t y = 0; y + length < s->height; y += STEP) {
        for (int32_t x = 0; x + length < s->width; x += STEP) {
            int32_t i = y * s->width + x, right = i + length, below = i + length * s->width;
            if (!is_floor(s, i, up)) {
                continue;
            }
            weight += is_floor(s, right, up) ? add_chord(sums, s, i, right, up, most_sin) : 0.0;
            weight += is_floor(s, below, up) ? add_chord(sums, s, i, below, up, most_sin) : 0.0;
        }
    }
    return weight;
}

/* What lies must not roll: `up` is made to stand on floors and tables, by chords between points of
 * one height, which noise turns less than normals the longer they are. */
static rlf_vec3 stand_on_floor(const rlf_surface *s, rlf_vec3 up)
{
    double most_sin = 0.14;
    for (int32_t round = 0; round < 3; round++, most_sin *= 0.6) {
        up_sums sums = {{{0}}, 0, 0, 0, 0};
        double weight = add_chords(&sums, s, s->width / 10, up, most_sin);
        weight += add_chords(&sums, s, s->width / 40, up, most_sin);
        rlf_vec3 next = up;
        if (!improve(&sums, weight, &next)) {
            break;
        }
        up = next;
    }
    return up;
}

bool rlf_surface_find_up(const rlf_surface *surface, rlf_vec3 *out_up)
{
    up_end ends[STARTS];
    int32_t best_fit = 0;
    for (int32_t k = 0; k < STARTS; k++) {
        ends[k] = follow(surface, starts[k]);
        best_fit = ends[k].fit > best_fit ? ends[k].fit : best_fit;
    }
    const up_end *best = NULL;
    for (int32_t k = 0; k < STARTS; k++) {
        bool is_axis = ends[k].fit > 0 && ends[k].fit >= FIT_SHARE * best_fit;
        if (is_axis && (best == NULL || ends[k].cost < best->cost)) {
            best = &ends[k];
        }
    }
    *out_up = best != NULL ? stand_on_floor(surface, best->up) : rlf_vec3_make(0, -1, 0);
    return best != NULL;
}
