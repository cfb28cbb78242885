/* Solids of people and the rays of a row: see surface/thickness/torso.h. Doubles, metres; every
 * clone gives the same bits. Axes are those of a torso: to the side, downwards, ahead. */
#ifndef RLF_KERNEL_SOLID_H
#define RLF_KERNEL_SOLID_H

#include "kernel/kernel.h"

/* Most rays of a row at once; and how many are cut together. */
enum { RLF_KERNEL_RAYS = 32, RLF_KERNEL_RAY_LANES = 8, RLF_KERNEL_SECTIONS = 3 };

/* At depth z each is at z times its way from the camera. The count is a multiple of
 * RLF_KERNEL_RAY_LANES: some may be there twice. */
typedef struct rlf_kernel_ray_lanes {
    int32_t count;
    double camera[3];
    double side[RLF_KERNEL_RAYS], down[RLF_KERNEL_RAYS], ahead[RLF_KERNEL_RAYS];
} rlf_kernel_ray_lanes;

/* Depths between which each ray is in a solid; enter > leave where it misses. */
typedef struct rlf_kernel_cuts {
    double enter[RLF_KERNEL_RAYS], leave[RLF_KERNEL_RAYS];
} rlf_kernel_cuts;

/* Level ellipses at some heights, and half an ellipsoid above the first and below the last. Heights
 * `at`, `first` and `last` are below the head's top, which is `above` over the axes' origin. */
typedef struct rlf_kernel_trunk {
    double at[RLF_KERNEL_SECTIONS], breadth[RLF_KERNEL_SECTIONS], depth[RLF_KERNEL_SECTIONS];
    double above, first, last; /* there is none above `first` and below `last` */
    double dome, fold;         /* heights of the half ellipsoids ... */
    double least;              /* ... which are never narrower than this share of their base */
    double lowest;             /* from the origin down: no cuts below */
    double ahead, lean;        /* of the axis at the origin, and per metre down */
    double middle;             /* depth at which the axis is, about */
} rlf_kernel_trunk;

/* A level capsule to both sides, at the height of the origin. */
typedef struct rlf_kernel_bar {
    double reach, ahead, radius;
} rlf_kernel_bar;

/* A capsule whose radius changes evenly along it. */
typedef struct rlf_kernel_limb {
    double off[2][3]; /* of its ends, from the camera */
    double along[3];  /* unit vector between them */
    double length, radius[2];
} rlf_kernel_limb;

/* The same, as places are near to it. */
typedef struct rlf_kernel_axis {
    double begin[3], along[3], square; /* along . along, a little more than 0 */
    double radius[2];
} rlf_kernel_axis;

/* The count is a multiple of RLF_KERNEL_RAY_LANES. */
typedef struct rlf_kernel_places {
    int32_t count;
    double side[RLF_KERNEL_RAYS], down[RLF_KERNEL_RAYS], ahead[RLF_KERNEL_RAYS];
} rlf_kernel_places;

/* Distance from a surface, less than 0 within, and of which axis that is. */
typedef struct rlf_kernel_nearest {
    double distance[RLF_KERNEL_RAYS], axis[RLF_KERNEL_RAYS];
} rlf_kernel_nearest;

/* A level section: its half axes, and how much of each of the given ones they are. */
typedef struct rlf_kernel_section {
    double share[RLF_KERNEL_SECTIONS], breadth, depth;
} rlf_kernel_section;

RLF_KERNEL_PART rlf_kernel_section rlf_kernel_section_at(const rlf_kernel_trunk t, double down)
{
    const double chest = t.at[0], waist = t.at[1], last = t.at[2];
    double below = down + t.above;
    bool is_above = chest > below, is_lower = below > waist;
    bool is_under = below > last;
    double from = is_lower ? waist : chest, span = is_lower ? last - waist : waist - chest;
    double way = below - from;
    way = is_under ? below - last : way;
    way = is_above ? chest - below : way;
    span = is_under ? t.fold : span;
    span = is_above ? t.dome : span;
    way /= span;
    double left = 1.0 - way * way; /* on the way to where the trunk would close */
    left = sqrt(left > 0.0 ? left : 0.0);
    left = left > t.least ? left : t.least;
    double first = is_lower ? 0.0 : 1.0 - way, second = is_lower ? 1.0 - way : way;
    double third = is_lower ? way : 0.0;
    rlf_kernel_section s;
    s.share[0] = is_above ? left : first;
    s.share[1] = is_above | is_under ? 0.0 : second;
    s.share[2] = is_under ? left : third;
    s.breadth = s.share[0] * t.breadth[0] + s.share[1] * t.breadth[1] + s.share[2] * t.breadth[2];
    s.depth = s.share[0] * t.depth[0] + s.share[1] * t.depth[1] + s.share[2] * t.depth[2];
    return s;
}

/* By the sections at the heights where the ray would enter and leave that of its middle. */
void rlf_kernel_cut_trunk(const rlf_kernel_trunk *trunk, const rlf_kernel_ray_lanes *rays,
                          rlf_kernel_cuts *restrict out);
void rlf_kernel_cut_bar(const rlf_kernel_bar *bar, const rlf_kernel_ray_lanes *rays,
                        rlf_kernel_cuts *restrict out);
/* A ball at each end, and between them the cylinder of the radius at which the ray is nearest; of
 * the rays begin <= i < end, which is a multiple of RLF_KERNEL_RAY_LANES from there. */
void rlf_kernel_cut_limb(const rlf_kernel_limb *limb, const rlf_kernel_ray_lanes *rays,
                         int32_t begin, int32_t end, rlf_kernel_cuts *restrict out);
/* The surface that is nearest to each place; of several as near, the first. */
void rlf_kernel_find_nearest(const rlf_kernel_axis *axes, int32_t axis_count,
                             const rlf_kernel_places *places, rlf_kernel_nearest *restrict out);

#endif
