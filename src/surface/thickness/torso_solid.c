/* The solid: a trunk whose level sections are ellipses, given at chest, waist and buttocks, closed
 * above the chest and below the buttocks by half an ellipsoid; and a level capsule through the
 * shoulders, from one upper arm's head to the other. */
#include "surface/thickness/torso.h"

#include <math.h>
#include <string.h>

enum { SECTIONS = RLF_KERNEL_SECTIONS };

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

static rlf_kernel_trunk trunk_of(const rlf_torso *torso)
{
    rlf_kernel_trunk t = {.above = shoulder_at,
                          .first = rlf_torso_first,
                          .last = rlf_torso_last,
                          .dome = dome_m,
                          .fold = fold_m,
                          .least = least_dome,
                          .lowest = rlf_torso_crotch,
                          .ahead = torso->unknown[RLF_TORSO_AHEAD],
                          .lean = torso->unknown[RLF_TORSO_LEAN],
                          .middle = torso->head.z};
    memcpy(t.at, section_at, sizeof t.at);
    memcpy(t.breadth, &torso->unknown[RLF_TORSO_BREADTH], sizeof t.breadth);
    memcpy(t.depth, &torso->unknown[RLF_TORSO_DEPTH], sizeof t.depth);
    return t;
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

static rlf_kernel_bar bar_of(const rlf_torso *torso)
{
    return (rlf_kernel_bar){torso->unknown[RLF_TORSO_SHOULDER], torso->unknown[RLF_TORSO_AHEAD],
                            shoulder_round};
}

void rlf_places_read(const rlf_vec3 *place, int32_t count, rlf_kernel_places *out)
{
    int32_t i = 0;
    for (; i < count || i % RLF_KERNEL_RAY_LANES != 0; i++) {
        const rlf_vec3 *at = &place[i < count ? i : count - 1];
        out->side[i] = at->x;
        out->down[i] = at->y;
        out->ahead[i] = at->z;
    }
    out->count = i;
}

static void find_places(const rlf_torso *torso, const rlf_vec3 *p, int32_t count,
                        rlf_kernel_places *out)
{
    rlf_vec3 place[RLF_KERNEL_RAYS];
    for (int32_t i = 0; i < count; i++) {
        place[i] = rlf_torso_place(torso, p[i]);
    }
    rlf_places_read(place, count, out);
}

void rlf_torso_touch(const rlf_torso *torso, const rlf_vec3 *p, int32_t count,
                     rlf_kernel_touches *out)
{
    const rlf_kernel_torso solid = {.trunk = trunk_of(torso),
                                    .bar = bar_of(torso),
                                    .bar_top = -shoulders_up_m,
                                    .bar_bottom = arms_down_m,
                                    .deepest = deepest_in_m};
    rlf_kernel_places places;
    find_places(torso, p, count, &places);
    rlf_kernel_touch_torso(&solid, &places, out);
}

void rlf_torso_touch_rim(const rlf_torso *torso, const rlf_vec3 *p, int32_t count,
                         rlf_kernel_touches *out, double moved_m[RLF_KERNEL_RAYS])
{
    const rlf_vec3 camera = rlf_torso_place(torso, rlf_vec3_make(0.0, 0.0, 0.0));
    const double from[3] = {camera.x, camera.y, camera.z};
    const rlf_kernel_torso solid = {.trunk = trunk_of(torso), /* and no bar */
                                    .bar = bar_of(torso),
                                    .bar_top = INFINITY,
                                    .bar_bottom = -INFINITY,
                                    .deepest = deepest_in_m};
    rlf_kernel_places places;
    bool is_below[RLF_KERNEL_RAYS];
    find_places(torso, p, count, &places);
    for (int32_t i = 0; i < count; i++) {
        double below = places.down[i] + shoulder_at;
        is_below[i] =
            !(places.down[i] < arms_down_m) && below > rlf_torso_first && below < rlf_torso_last;
    }
    rlf_kernel_trunk_beside(&solid.trunk, from, &places, moved_m);
    rlf_kernel_touch_torso(&solid, &places, out);
    for (int32_t i = 0; i < count; i++) {
        out->is_any[i] = is_below[i] ? out->is_any[i] : 0.0;
        moved_m[i] *= p[i].z;
    }
}

void rlf_torso_begin_rays(const rlf_torso *torso, rlf_kernel_ray_lanes *out)
{
    const rlf_vec3 origin = {0.0, 0.0, 0.0};
    own_place from = find_place(torso, origin);
    out->count = 0;
    out->camera[0] = from.side;
    out->camera[1] = from.down;
    out->camera[2] = from.ahead;
}

void rlf_torso_add_ray(const rlf_torso *torso, double x, double y, rlf_kernel_ray_lanes *rays)
{
    rays->side[rays->count] = x * torso->side_x + torso->side_z;
    rays->down[rays->count] = y;
    rays->ahead[rays->count++] = torso->side_x - x * torso->side_z;
}

void rlf_torso_close_rays(rlf_kernel_ray_lanes *rays)
{
    for (; rays->count % RLF_KERNEL_RAY_LANES != 0; rays->count++) {
        rays->side[rays->count] = rays->side[rays->count - 1];
        rays->down[rays->count] = rays->down[rays->count - 1];
        rays->ahead[rays->count] = rays->ahead[rays->count - 1];
    }
}

void rlf_torso_cut_rays(const rlf_torso *torso, const rlf_kernel_ray_lanes *rays,
                        rlf_kernel_cuts *out)
{
    const rlf_kernel_trunk trunk = trunk_of(torso);
    rlf_kernel_cut_trunk(&trunk, rays, out);
}

bool rlf_torso_cut_shoulders(const rlf_torso *torso, const rlf_kernel_ray_lanes *rays,
                             rlf_kernel_cuts *out)
{
    const rlf_kernel_bar bar = bar_of(torso);
    double far = torso->head.z + bar.reach + rlf_max(bar.ahead, -bar.ahead) + shoulder_round;
    double near = 2.0 * torso->head.z - far, top = 1e9, bottom = -1e9;
    for (int32_t i = 0; i < rays->count; i++) {
        top = rlf_min(top, rays->down[i] * (rays->down[i] > 0.0 ? near : far));
        bottom = rlf_max(bottom, rays->down[i] * (rays->down[i] > 0.0 ? far : near));
    }
    double apart = 2.0 * shoulder_round; /* more than enough: a ray does not end there */
    if (top + rays->camera[1] > apart || bottom + rays->camera[1] < -apart) {
        return false;
    }
    rlf_kernel_cut_bar(&bar, rays, out);
    return true;
}
