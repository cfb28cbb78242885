/* The solid: a trunk whose level sections are ellipses, given at chest, waist and buttocks, closed
 * above the chest and below the buttocks by half an ellipsoid; and a level capsule through the
 * shoulders, from one upper arm's head to the other. */
#include "surface/thickness/torso.h"

#include <math.h>
#include <string.h>

enum { SECTIONS = 3 };

/* Metres, of both sexes' means in ANSUR II (Gordon et al. 2014, Natick/TR-15/007) at their mean
 * stature, 1.69 m: chest, waist (omphalion) and buttocks below the head's top, ... */
static const double section_at[SECTIONS] = {0.461, 0.674, 0.832};
/* ... the shoulders' middle, between acromion and armpit, and half of what is between these (with
 * 5 mm of clothes, as all that follows), */
static const double shoulder_at = 0.356, shoulder_round = 0.057;
/* half the bideltoid breadth less that, */
static const double usual_shoulder = 0.188;
/* and half the breadths and depths of chest, waist, hip and buttocks. */
static const double usual_breadth[SECTIONS] = {0.145, 0.162, 0.18};
static const double usual_depth[SECTIONS] = {0.13, 0.118, 0.125};

/* Standard deviations of people about that, of both sexes together in that survey, ... */
enum { MEASURES = 2 + 2 * SECTIONS };
static const double spread[MEASURES] = {0.018, 0.022, 0.0105, 0.018, 0.013, 0.0135, 0.018, 0.013};
/* ... and how these go together: half the bideltoid breadth, the height of the shoulders below the
 * head's top, half the breadths of chest, waist and hip, half the depths of chest, waist and
 * buttocks. */
static const double alike[MEASURES][MEASURES] = {{1.00},
                                                 {0.49, 1.00},
                                                 {0.75, 0.43, 1.00},
                                                 {0.70, 0.30, 0.73, 1.00},
                                                 {0.36, 0.03, 0.44, 0.69, 1.00},
                                                 {0.58, 0.10, 0.60, 0.78, 0.64, 1.00},
                                                 {0.68, 0.22, 0.65, 0.87, 0.57, 0.78, 1.00},
                                                 {0.66, 0.19, 0.60, 0.80, 0.68, 0.75, 0.84, 1.00}};
static const double own_m2 = 0.01 * 0.01; /* of each by itself: clothes, and the solid's shape */
/* Of the way they carry their heads and backs. */
static const double ahead_spread = 0.03, lean_spread = 0.06, turn_spread = 0.3;

/* From the chest up to where the trunk would close, at the neck's root (cervicale); and from the
 * buttocks down, so that at the crotch, 47 mm below, it is as deep as a thigh is there (0.198 of
 * the buttocks' 0.239). */
static const double dome_m = 0.225, fold_m = 0.083;
static const double least_dome = 0.2;
static const double deepest_in_m = 0.04;                       /* within counts no more */
static const double shoulders_up_m = 0.12, arms_down_m = 0.03; /* where points may be theirs */

const double rlf_torso_first = 0.27, rlf_torso_last = 0.9;
const double rlf_torso_crotch = 0.878 - 0.356; /* of the same survey */

void rlf_torso_usual(double unknown[RLF_TORSO_UNKNOWNS],
                     double covariance[RLF_TORSO_UNKNOWNS][RLF_TORSO_UNKNOWNS])
{
    memset(unknown, 0, RLF_TORSO_UNKNOWNS * sizeof *unknown);
    memset(covariance, 0, RLF_TORSO_UNKNOWNS * sizeof *covariance);
    unknown[RLF_TORSO_SHOULDER] = usual_shoulder;
    for (int k = 0; k < SECTIONS; k++) {
        unknown[RLF_TORSO_BREADTH + k] = usual_breadth[k];
        unknown[RLF_TORSO_DEPTH + k] = usual_depth[k];
    }
    covariance[RLF_TORSO_AHEAD][RLF_TORSO_AHEAD] = ahead_spread * ahead_spread;
    covariance[RLF_TORSO_TURN][RLF_TORSO_TURN] = turn_spread * turn_spread;
    covariance[RLF_TORSO_LEAN][RLF_TORSO_LEAN] = lean_spread * lean_spread;
    for (int r = 0; r < MEASURES; r++) {
        for (int c = 0; c <= r; c++) {
            double both = alike[r][c] * spread[r] * spread[c] + (r == c ? own_m2 : 0.0);
            covariance[RLF_TORSO_SHOULDER + r][RLF_TORSO_SHOULDER + c] = both;
            covariance[RLF_TORSO_SHOULDER + c][RLF_TORSO_SHOULDER + r] = both;
        }
    }
}

/* A level section: its half axes, and how much of each of the three they are. */
typedef struct section {
    double share[SECTIONS], breadth, depth;
} section;

/* What is left of the last section on the way to where the trunk would close. */
static double dome_share(double way)
{
    return rlf_max(sqrt(rlf_max(1.0 - way * way, 0.0)), least_dome);
}

/* At a height below the shoulders' middle, downwards; false above and below the trunk. */
static bool find_section(const rlf_torso *torso, double down, section *out)
{
    double below = down + shoulder_at;
    if (!(below > rlf_torso_first && below < rlf_torso_last)) {
        return false;
    }
    *out = (section){.breadth = 0.0};
    if (below < section_at[0]) {
        out->share[0] = dome_share((section_at[0] - below) / dome_m);
    } else if (below > section_at[2]) {
        out->share[2] = dome_share((below - section_at[2]) / fold_m);
    } else {
        int k = below > section_at[1] ? 1 : 0;
        double q = (below - section_at[k]) / (section_at[k + 1] - section_at[k]);
        out->share[k] = 1.0 - q;
        out->share[k + 1] = q;
    }
    for (int k = 0; k < SECTIONS; k++) {
        out->breadth += out->share[k] * torso->unknown[RLF_TORSO_BREADTH + k];
        out->depth += out->share[k] * torso->unknown[RLF_TORSO_DEPTH + k];
    }
    return true;
}

/* A point in the torso's own axes: to the side and ahead of the head's middle, and downwards from
 * the shoulders' middle. */
typedef struct own_place {
    double side, ahead, down;
} own_place;

static double shoulder_height(const rlf_torso *torso)
{
    return torso->head.y + torso->unknown[RLF_TORSO_DROP] + shoulder_at;
}

static own_place find_place(const rlf_torso *torso, rlf_vec3 p)
{
    double x = p.x - torso->head.x, z = p.z - torso->head.z;
    return (own_place){x * torso->side_x + z * torso->side_z, z * torso->side_x - x * torso->side_z,
                       p.y - shoulder_height(torso)};
}

rlf_vec3 rlf_torso_place(const rlf_torso *torso, rlf_vec3 p)
{
    own_place at = find_place(torso, p);
    return rlf_vec3_make(at.side, at.down, at.ahead);
}

rlf_vec3 rlf_torso_point(const rlf_torso *torso, rlf_vec3 place)
{
    return rlf_vec3_make(torso->head.x + place.x * torso->side_x - place.z * torso->side_z,
                         place.y + shoulder_height(torso),
                         torso->head.z + place.x * torso->side_z + place.z * torso->side_x);
}

/* Sampson's distance from the section's ellipse. */
static bool touch_trunk(const rlf_torso *torso, const own_place *at, rlf_torso_touch *out)
{
    section s;
    if (!find_section(torso, at->down, &s)) {
        return false;
    }
    double u = at->side / s.breadth;
    double v =
        (at->ahead - torso->unknown[RLF_TORSO_AHEAD] - torso->unknown[RLF_TORSO_LEAN] * at->down) /
        s.depth;
    double gu = u / s.breadth, gv = v / s.depth, steep = sqrt(gu * gu + gv * gv) + 1e-9;
    gu /= steep;
    gv /= steep;
    *out = (rlf_torso_touch){.distance = (u * u + v * v - 1.0) / (2.0 * steep)};
    out->distance = rlf_max(out->distance, -deepest_in_m);
    out->slope[RLF_TORSO_AHEAD] = -gv;
    out->slope[RLF_TORSO_LEAN] = -gv * at->down;
    out->slope[RLF_TORSO_TURN] = gu * at->ahead - gv * at->side;
    for (int k = 0; k < SECTIONS; k++) {
        out->slope[RLF_TORSO_BREADTH + k] = -gu * u * s.share[k];
        out->slope[RLF_TORSO_DEPTH + k] = -gv * v * s.share[k];
    }
    return true;
}

static bool touch_shoulders(const rlf_torso *torso, const own_place *at, rlf_torso_touch *out)
{
    if (at->down > arms_down_m || at->down < -shoulders_up_m) {
        return false;
    }
    double reach = torso->unknown[RLF_TORSO_SHOULDER], end = rlf_clamp(at->side, -reach, reach);
    double u = at->side - end, v = at->ahead - torso->unknown[RLF_TORSO_AHEAD];
    double r = sqrt(u * u + v * v + at->down * at->down) + 1e-9;
    *out = (rlf_torso_touch){.distance = r - shoulder_round};
    out->slope[RLF_TORSO_AHEAD] = -v / r;
    out->slope[RLF_TORSO_TURN] = (u * at->ahead - v * at->side) / r;
    out->slope[RLF_TORSO_SHOULDER] = (u < 0.0 ? u : -u) / r;
    out->slope[RLF_TORSO_DROP] = -at->down / r;
    return true;
}

/* At the place on the ray that is nearest to the middle of the section, in axes in which that is a
 * circle. */
bool rlf_torso_touch_rim(const rlf_torso *torso, rlf_vec3 p, rlf_torso_touch *out, double *moved_m)
{
    const rlf_vec3 origin = {0.0, 0.0, 0.0};
    own_place at = find_place(torso, p), from = find_place(torso, origin);
    own_place way = {at.side - from.side, at.ahead - from.ahead, at.down - from.down};
    section s;
    if (at.down < arms_down_m || !find_section(torso, at.down, &s)) {
        return false;
    }
    double axis = torso->unknown[RLF_TORSO_AHEAD] + torso->unknown[RLF_TORSO_LEAN] * at.down;
    double u = at.side / s.breadth, v = (at.ahead - axis) / s.depth;
    double du = way.side / s.breadth, dv = way.ahead / s.depth;
    double by = -(u * du + v * dv) / (du * du + dv * dv);
    at = (own_place){at.side + by * way.side, at.ahead + by * way.ahead, at.down + by * way.down};
    *moved_m = by * p.z;
    return touch_trunk(torso, &at, out);
}

bool rlf_torso_touch_at(const rlf_torso *torso, rlf_vec3 p, rlf_torso_touch *out)
{
    own_place at = find_place(torso, p);
    rlf_torso_touch shoulders;
    bool has_trunk = touch_trunk(torso, &at, out);
    if (touch_shoulders(torso, &at, &shoulders) &&
        (!has_trunk || shoulders.distance < out->distance)) {
        *out = shoulders;
        return true;
    }
    return has_trunk;
}

/* Smaller and larger root of a z^2 - 2 b z + c = 0, as near and far; false when there is none. */
static bool find_roots(double a, double b, double c, rlf_torso_cut *out)
{
    double q = b * b - a * c;
    if (!(a > 1e-6 && q > 0.0)) {
        return false;
    }
    q = sqrt(q);
    *out = (rlf_torso_cut){(b - q) / a, (b + q) / a};
    return true;
}

/* The ray in the torso's own axes: at depth z it is at z times `way` from `from`. */
typedef struct own_ray {
    own_place way, from;
} own_ray;

/* Cuts the upright cylinder over the section at a height. */
static bool cut_section(const rlf_torso *torso, const own_ray *ray, double down, rlf_torso_cut *out)
{
    section s;
    if (down > rlf_torso_crotch || !find_section(torso, down, &s)) {
        return false;
    }
    double u1 = ray->way.side / s.breadth, u0 = -ray->from.side / s.breadth;
    double ahead = torso->unknown[RLF_TORSO_AHEAD] + torso->unknown[RLF_TORSO_LEAN] * down;
    double v1 = ray->way.ahead / s.depth, v0 = (ahead - ray->from.ahead) / s.depth;
    return find_roots(u1 * u1 + v1 * v1, u1 * u0 + v1 * v0, u0 * u0 + v0 * v0 - 1.0, out);
}

/* By the sections at the heights where the ray would enter and leave that of its middle. */
static void cut_trunk(const rlf_torso *torso, const own_ray *ray, rlf_torso_cut *out)
{
    rlf_torso_cut middle, end;
    *out = (rlf_torso_cut){1.0, 0.0};
    if (!cut_section(torso, ray, ray->from.down + ray->way.down * torso->head.z, &middle)) {
        return;
    }
    *out = middle;
    if (cut_section(torso, ray, ray->from.down + ray->way.down * middle.enter, &end)) {
        out->enter = end.enter;
    }
    if (cut_section(torso, ray, ray->from.down + ray->way.down * middle.leave, &end)) {
        out->leave = end.leave;
    }
}

/* Takes into `out` the ball at one end of the shoulders' axis. */
static void cut_end(const own_ray *ray, double side, double ahead, rlf_torso_cut *out)
{
    const own_place *w = &ray->way, *f = &ray->from;
    double s = side - f->side, a = ahead - f->ahead, d = -f->down;
    rlf_torso_cut cut;
    if (find_roots(w->side * w->side + w->ahead * w->ahead + w->down * w->down,
                   w->side * s + w->ahead * a + w->down * d,
                   s * s + a * a + d * d - shoulder_round * shoulder_round, &cut)) {
        out->enter = rlf_min(out->enter, cut.enter);
        out->leave = rlf_max(out->leave, cut.leave);
    }
}

static void cut_shoulders(const rlf_torso *torso, const own_ray *ray, rlf_torso_cut *out)
{
    const own_place *w = &ray->way, *f = &ray->from;
    double ahead = torso->unknown[RLF_TORSO_AHEAD], reach = torso->unknown[RLF_TORSO_SHOULDER];
    double a = ahead - f->ahead, d = -f->down;
    *out = (rlf_torso_cut){1e9, -1e9};
    cut_end(ray, reach, ahead, out);
    cut_end(ray, -reach, ahead, out);
    rlf_torso_cut tube;
    if (find_roots(w->ahead * w->ahead + w->down * w->down, w->ahead * a + w->down * d,
                   a * a + d * d - shoulder_round * shoulder_round, &tube)) {
        double enter = f->side + w->side * tube.enter, leave = f->side + w->side * tube.leave;
        if (enter >= -reach && enter <= reach) {
            out->enter = rlf_min(out->enter, tube.enter);
        }
        if (leave >= -reach && leave <= reach) {
            out->leave = rlf_max(out->leave, tube.leave);
        }
    }
}

void rlf_torso_cut_ray(const rlf_torso *torso, double x, double y, rlf_torso_cut out[2])
{
    const rlf_vec3 origin = {0.0, 0.0, 0.0};
    const own_ray ray = {{x * torso->side_x + torso->side_z, torso->side_x - x * torso->side_z, y},
                         find_place(torso, origin)};
    cut_trunk(torso, &ray, &out[0]);
    cut_shoulders(torso, &ray, &out[1]);
}
