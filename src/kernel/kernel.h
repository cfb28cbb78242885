/* The hot loops over rows: plain C that is the specification.
 *
 * Every kernel is a pure function of its pointers; rows do not alias. Floats are IEEE single
 * without contraction, so each clone of a kernel gives the same bits. Depth is metres, 0 = missing.
 */
#ifndef RLF_KERNEL_KERNEL_H
#define RLF_KERNEL_KERNEL_H

#include "relief/frame.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) ||                         \
    __has_feature(memory_sanitizer)
#define RLF_KERNEL_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RLF_KERNEL_SANITIZED 1
#endif

/* An AVX-512 and an AVX2 clone beside the portable one, picked when the program is loaded. Neither
 * may fuse a product and a sum (-ffp-contract=off): the golden hashes are of all three. Sanitizers
 * cannot run the resolver, so their builds have the portable one only; so has Clang before 18,
 * which gives the clones another symbol than their callers use. */
#if defined(__clang__) && __clang_major__ < 18
#define RLF_KERNEL_PORTABLE 1
#endif
#if defined(__GNUC__) && defined(__x86_64__) && defined(__GLIBC__) &&                              \
    !defined(RLF_KERNEL_SANITIZED) && !defined(RLF_KERNEL_PORTABLE)
#define RLF_KERNEL_HAS_CLONES 1
#define RLF_KERNEL __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define RLF_KERNEL
#endif

/* Helpers must be part of each clone, or they would run with the portable instructions. */
#if defined(__GNUC__)
#define RLF_KERNEL_PART static inline __attribute__((always_inline))
#else
#define RLF_KERNEL_PART static inline
#endif

/* Before a loop of a fixed number of lanes: to be vectorised, and not first unrolled into single
 * values. */
#if defined(__GNUC__) && !defined(__clang__)
#define RLF_KERNEL_WHOLE _Pragma("GCC unroll 1")
#else
#define RLF_KERNEL_WHOLE
#endif

/* Before a loop within one over lanes: its sums then stay in registers. */
#if defined(__GNUC__) && !defined(__clang__)
#define RLF_KERNEL_PRAGMA(text) _Pragma(#text)
#define RLF_KERNEL_UNROLLED(times) RLF_KERNEL_PRAGMA(GCC unroll times)
#else
#define RLF_KERNEL_UNROLLED(times)
#endif

/* What is read, or written, soon: brought near while other work is done. A function that does
 * nothing else is an RLF_KERNEL_PART: compilers leave out calls that have no effect. */
#if defined(__GNUC__)
#define RLF_KERNEL_SOON(address) __builtin_prefetch(address)
#define RLF_KERNEL_SOON_WRITTEN(address) __builtin_prefetch(address, 1)
#else
#define RLF_KERNEL_SOON(address) ((void)(address))
#define RLF_KERNEL_SOON_WRITTEN(address) ((void)(address))
#endif

/* sigma(z) = max(c0 + c1 z + c2 z^2, 0.3 mm) in single precision. */
typedef struct rlf_kernel_noise {
    float c0, c1, c2;
} rlf_kernel_noise;

static inline rlf_kernel_noise rlf_kernel_noise_make(const rlf_depth_noise *noise)
{
    rlf_kernel_noise n = {(float)noise->c0, (float)noise->c1, (float)noise->c2};
    return n;
}
RLF_KERNEL_PART float rlf_kernel_sigma(rlf_kernel_noise n, float z)
{
    float sigma = n.c0 + z * (n.c1 + z * n.c2);
    return sigma > 0.0003f ? sigma : 0.0003f;
}
/* Sigma of inverse depth w: sigma(z) w^2 at z = 1/w. */
RLF_KERNEL_PART float rlf_kernel_inverse_sigma(rlf_kernel_noise n, float w)
{
    float sigma = n.c2 + w * (n.c1 + w * n.c0);
    float least = 0.0003f * (w * w);
    return sigma > least ? sigma : least;
}
/* The square of that in a mean over frames: 1 / their number is `left`, and an error that lasts
 * stays, but is no more than the noise of one frame. */
RLF_KERNEL_PART float rlf_kernel_left_variance(float sigma, float left, float lasting)
{
    float one = sigma * sigma;
    float mean = one * left + lasting * lasting;
    return mean < one ? mean : one;
}
/* How much noisier a slanted surface is: Fankhauser et al. 2015 add
 * 0.1 mm z^1.5 theta^2 / (pi/2 - theta)^2 to a Kinect v2's noise, which at 2 to 4.5 m is 0.17 to
 * 0.19 of the frontal noise, here 0.18 of any sensor's. `along` / `length` is the cosine. It ends
 * at 75 degrees: a plane laid across a depth edge is steeper, and must not be excused by its own
 * slant. */
RLF_KERNEL_PART float rlf_kernel_slant(float along, float length)
{
    const float most = 5.283185f; /* (pi/2) / 0.25 - 1 */
    float square = length * length;
    /* pi/2 - theta = asin(c), here c + 0.17 c^3; ratio = theta / (pi/2 - theta) */
    float rest = along * (square + 0.17f * (along * along));
    float ratio = 1.5707964f * (square * length) / rest - 1.0f;
    ratio = ratio < most ? ratio : most;
    return 1.0f + 0.18f * (ratio * ratio);
}
RLF_KERNEL_PART float rlf_kernel_abs(float x)
{
    return fabsf(x); /* a mask; a comparison and a choice are three times as dear */
}
/* Of how many frames a depth counts as the mean, from what rlf_kernel_steady_row keeps: a younger
 * mean may be of something that moves, and has the noise of one frame. */
RLF_KERNEL_PART float rlf_kernel_averaged_frames(float frames)
{
    float all = rlf_kernel_abs(frames);
    return all >= 4.0f ? all : 1.0f;
}

RLF_KERNEL_PART uint64_t rlf_kernel_eight(const uint8_t *bytes)
{
    uint64_t eight;
    memcpy(&eight, bytes, sizeof eight);
    return eight;
}

/* Of eight bytes that are not all 0, the place of the first one that is not. */
RLF_KERNEL_PART int32_t rlf_kernel_first_of_eight(const uint8_t *bytes)
{
#if defined(__GNUC__) && defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    return __builtin_ctzll(rlf_kernel_eight(bytes)) / 8;
#else
    int32_t first = 7;
    for (int32_t k = 6; k >= 0; k--) { /* without a branch: it is not to be foreseen */
        first = bytes[k] != 0 ? k : first;
    }
    return first;
#endif
}

/* The first index from `i` on at which a byte of the row is not 0, or `count`: marks are rare, or
 * side by side. */
RLF_KERNEL_PART int32_t rlf_kernel_next_mark(const uint8_t *row, int32_t i, int32_t count)
{
    while (i + 8 <= count) {
        if (rlf_kernel_eight(row + i) != 0) {
            return i + rlf_kernel_first_of_eight(row + i);
        }
        i += 8;
        while (i + 32 <= count &&
               (rlf_kernel_eight(row + i) | rlf_kernel_eight(row + i + 8) |
                rlf_kernel_eight(row + i + 16) | rlf_kernel_eight(row + i + 24)) == 0) {
            i += 32;
        }
    }
    while (i < count && row[i] == 0) {
        i++;
    }
    return i;
}

/* ---- depth_row.c: raw depth to metres and reason codes ------------------------------------------
 */

typedef struct rlf_kernel_range {
    float near_m, far_m;
    float metres_per_unit; /* of u16 samples */
} rlf_kernel_range;

/* Takes every step-th of the row's samples, `count` of them. */
void rlf_kernel_depth_row_u16(const uint16_t *restrict source, int32_t step, int32_t count,
                              rlf_kernel_range range, float *restrict depth,
                              uint8_t *restrict reason);
void rlf_kernel_depth_row_f32(const float *restrict source, int32_t step, int32_t count,
                              rlf_kernel_range range, float *restrict depth,
                              uint8_t *restrict reason);
/* Takes depth from pixels without a ray. */
void rlf_kernel_lens_row(const uint8_t *restrict has_ray, int32_t count, float *restrict depth,
                         uint8_t *restrict reason);

/* ---- flying_row.c: mixed pixels at depth edges
 * --------------------------------------------------- */

/* rows[0..2] are the rows above, at and below (a missing row repeats none: pass a row of zeros).
 * Writes the kept depth and RLF_REASON_FLYING for the rest. */
void rlf_kernel_flying_row(const float *const rows[3], int32_t count, float *restrict depth,
                           uint8_t *restrict reason);

/* ---- half_way_row.c: lines of mixed pixels between two levels
 * --------------------------------------------------- */

/* rows[0..4] are two rows above, the row itself and two below (a missing one: a row of zeros), as
 * seen. Takes depth from the pixels begin <= i < end that hang half way between their neighbours;
 * two pixels on both sides must be there. */
void rlf_kernel_half_way_row(const float *const rows[5], int32_t begin, int32_t end,
                             float *restrict depth, uint8_t *restrict reason);

/* ---- slope_row.c: exact normals of clean depth
 * --------------------------------------------------- */

/* Five rows centred on the current one and the three ray rows that are needed. inverse is read
 * from -2 to count + 2 and rays from -1 to count + 1; zero outside the image. */
typedef struct rlf_kernel_slope_in {
    const float *inverse[5];          /* 1 / depth, 0 = missing; rows y-2 .. y+2 */
    const float *ray_x[3], *ray_y[3]; /* rows y-1 .. y+1 */
    int32_t count;
} rlf_kernel_slope_in;

void rlf_kernel_inverse_row(const float *restrict depth, int32_t count, float *restrict inverse);
void rlf_kernel_slope_row(const rlf_kernel_slope_in *in, float *restrict out_x,
                          float *restrict out_y, float *restrict out_z);

/* ---- plane_tile.c: normals of noisy depth
 * -------------------------------------------------------- */

#define RLF_KERNEL_TILE_WIDTH 128 /* most pixels of a tile */
#define RLF_KERNEL_TILE_HEIGHT 64

typedef struct rlf_kernel_tile {
    int32_t width, height; /* of the image */
    int32_t x0, y0;        /* corner of the tile: even numbers */
    int32_t x1, y1;        /* end of the tile, <= width, height */
    const float *depth, *ray_x, *ray_y;
    const float *frames; /* plane: of how many frames depth is the mean, as of steady_row; NULL = 1
                          */
    float lasting; /* error of inverse depth that no mean takes away, 1/m; at most the noise */
    rlf_kernel_noise noise;
    float *out_x, *out_y, *out_z; /* planes of the image; written inside the tile only; 0 where
                                     no plane explains the pixel */
    float *out_depth;             /* as these: depth of the pixel's plane, or the pixel's own where
                                     there is none; NULL = not wanted */
} rlf_kernel_tile;

void rlf_kernel_plane_tile(const rlf_kernel_tile *tile);

/* ---- steady_row.c: gated mean over time
 * --------------------------------------------------------- */

typedef struct rlf_kernel_lag_in {
    const float *normal[3], *ray_x, *ray_y; /* missing normals are 0: not slanted */
    const float *depth, *mean, *frames;     /* as of rlf_kernel_steady_row */
} rlf_kernel_lag_in;

/* How far inverse depth is from its mean, in eighths of the noise's sigma, at most 32; 0 where
 * either is missing. */
void rlf_kernel_lag_row(rlf_kernel_noise noise, const rlf_kernel_lag_in *in, int32_t count,
                        int8_t *restrict lag);

typedef struct rlf_kernel_steady_in {
    const int8_t *lag[3];  /* of the row above, the row itself, the one below; outside: zeros */
    const uint8_t *reason; /* only pixels that are OK take part */
    float most;            /* frames that a mean may stand for */
    int32_t count;
} rlf_kernel_steady_in;

/* Takes a row's depth into its means and gives it the means. Where it has moved, the mean starts
 * anew. mean is in inverse depth; frames = 0 where there is none, negative where it may no longer
 * be true. */
void rlf_kernel_steady_row(const rlf_kernel_steady_in *in, float *restrict depth,
                           float *restrict mean, float *restrict frames);

/* ---- change_row.c: what became of what was seen
 * ------------------------------------------------- */

/* A pixel now, against the mean of what was seen there before. */
enum { RLF_CHANGE_UNSEEN = 0, RLF_CHANGE_STILL = 1, RLF_CHANGE_MOVED = 2 };

/* mean is in inverse depth; frames = 0 where there is none: that counts as still. */
void rlf_kernel_change_row(rlf_kernel_noise noise, const float *restrict depth,
                           const float *restrict mean, const float *restrict frames, int32_t count,
                           uint8_t *restrict change);

/* 1 where `from` has a depth and `to` is off it by more than that share of it and `least` metres.
 */
void rlf_kernel_moved_row(const float *restrict from, const float *restrict to, float share,
                          float least, int32_t count, uint8_t *restrict moved);

/* ---- bend_row.c: where normals turn
 * ------------------------------------------------------------- */

#define RLF_KERNEL_BEND_SPAN 2 /* pixels from the middle to the sides that are compared */

enum { RLF_BEND_ACROSS = 1, RLF_BEND_DOWN = 2 };

typedef struct rlf_kernel_bend_in {
    const float *normal[3], *depth;
} rlf_kernel_bend_in;

/* rows: from SPAN above to SPAN below the row; outside the image pass the row itself. Missing
 * normals are 0: where one of the two sides is, the pixels next to the middle are compared, and the
 * middle stands for one of those that is missing. Nothing but missing ones count as turned. */
void rlf_kernel_bend_row(const rlf_kernel_bend_in rows[1 + 2 * RLF_KERNEL_BEND_SPAN], int32_t count,
                         uint8_t *restrict bend);

/* ---- background_row.c
 * ---------------------------------------------------------------------------- */

typedef struct rlf_kernel_background {
    rlf_kernel_noise noise;
    float sigmas, min_m; /* threshold: max(sigmas * sigma(z), min_m) */
    bool learning;
} rlf_kernel_background;

/* What a pixel of the current frame is against the background model. */
enum {
    RLF_SEEN_BACKGROUND = 0,
    RLF_SEEN_FOREGROUND = 1,
    RLF_SEEN_UNKNOWN = 2, /* depth where the background has none */
    RLF_SEEN_MISSING = 3, /* no depth */
    RLF_SEEN_PAST = 4     /* depth behind the background's: that has gone */
};

/* Rows of the model; they do not overlap. */
typedef struct rlf_kernel_model {
    float *mean;      /* 0 = unknown */
    float *deviation; /* mean absolute difference of the samples from the mean */
    uint8_t *weight;  /* samples in the mean, at most 32 */
    uint8_t *beyond;  /* frames in a row that saw past the mean */
} rlf_kernel_model;

/* Classifies a row and updates its model. Returns how many pixels were replaced or learnt anew. */
int32_t rlf_kernel_background_row(const rlf_kernel_background *params, const float *restrict depth,
                                  int32_t count, const rlf_kernel_model *model,
                                  uint8_t *restrict seen);
/* What is FOREGROUND stays so where it is the 3x3 majority of the pixels that are not MISSING, from
 * the rows above, at and below (outside the image: a row of MISSING); out is BACKGROUND, FOREGROUND
 * or UNKNOWN. */
void rlf_kernel_majority_row(const uint8_t *const rows[3], int32_t count, uint8_t *restrict out);

/* ---- still_row.c: what stands before the background
 * ----------------------------------------------------------- */

#define RLF_STILL_WEIGHT 8 /* of the mean of what is still, frames */

/* Depth may be off the mean by `sigmas` of the noise, and by `least` metres. */
typedef struct rlf_kernel_still {
    rlf_depth_noise noise;
    double sigmas;
    float least;
    int32_t limit_ms, passed_ms; /* until it is due; since the last frame */
} rlf_kernel_still;

/* Follows the depth of the foreground's pixels: its mean, and for how long it has been still, 0
 * where something farther is seen. 1 in is_due where that is the limit. */
void rlf_kernel_still_row(const rlf_kernel_still *p, const uint8_t *restrict front,
                          const float *restrict depth, int32_t count, float *restrict still,
                          uint16_t *restrict still_ms, uint8_t *restrict is_due);

/* ---- segment_row.c: which neighbours belong together
 * ----------------------------------------------------------- */

/* Bits of a pixel: it is a member, and it belongs together with the neighbour on that side. */
enum { RLF_LINK_MEMBER = 1, RLF_LINK_LEFT = 2, RLF_LINK_UP = 4 };

/* Neighbours belong together when their depths differ by at most sigmas sigma(z) + slope z +
 * step_m. */
typedef struct rlf_kernel_links {
    rlf_kernel_noise noise;
    float sigmas, slope, step_m;
} rlf_kernel_links;

/* A row and the one above; above the image: rows of zeros. What is left of the first pixel and
 * right of the last is no member. */
typedef struct rlf_kernel_links_in {
    const float *depth, *above;
    const uint8_t *mask, *mask_above; /* members are not 0, and have depth */
    int32_t count;
} rlf_kernel_links_in;

void rlf_kernel_link_row(const rlf_kernel_links *params, const rlf_kernel_links_in *in,
                         uint8_t *restrict links);

/* Labels of a row: the background's where the front sheet shows it, else 0. Returns the number of
 * pixels with depth. */
int32_t rlf_kernel_label_row(const float *restrict depth, const uint8_t *restrict foreground,
                             const int32_t *restrict background, int32_t count,
                             int32_t *restrict label);

/* ---- region_row.c: points of a region's pixels, see surface/segment/region_stats.c
 * --------------------------------------------------- */

#define RLF_REGION_LANES 4 /* the k-th of four pixels goes into the k-th sum */

/* Sums of x, y, z and of xx, xy, xz, yy, yz, zz; least and most along three axes; metres. */
typedef struct rlf_region_lanes {
    double sum[3][RLF_REGION_LANES], square[6][RLF_REGION_LANES];
    double least[3][RLF_REGION_LANES], most[3][RLF_REGION_LANES];
} rlf_region_lanes;

/* Unit vectors, and the point from which is measured along them. */
typedef struct rlf_region_axes {
    double axis[3][3], origin[3];
} rlf_region_axes;

/* Adds `count` pixels with depth to the sums, and to the extents along x, y and z. */
void rlf_kernel_region_row(const float *restrict depth, const float *restrict ray_x,
                           const float *restrict ray_y, int32_t count,
                           rlf_region_lanes *restrict lanes);
/* Adds them to the extents along the axes. */
void rlf_kernel_extent_row(const rlf_region_axes *axes, const float *restrict depth,
                           const float *restrict ray_x, const float *restrict ray_y, int32_t count,
                           rlf_region_lanes *restrict lanes);

/* ---- register_row.c: depth seen from a colour camera --------------------------------------------
 */

#define RLF_KERNEL_NOTHING 1e30f /* a depth that never wins: no surface */
#define RLF_KERNEL_ROWS 32768    /* more than any image has; y0 and y1 share an integer */

/* Ray (x, y, 1) at depth z is colour pixel u = (z a + ta) / (z c + tc), v with b and tb, at depth
 * z c + tc. */
typedef struct rlf_kernel_pinhole {
    float ta, tb, tc;
    float half_x, half_y; /* half a depth pixel, in colour pixels, at z c + tc = z */
    float width, height;  /* of the colour image */
} rlf_kernel_pinhole;

typedef struct rlf_kernel_rays {
    const float *a, *b, *c;
} rlf_kernel_rays;

/* Colour pixels of a row of the grid. */
typedef struct rlf_kernel_points {
    float *u, *v;
    float *scale; /* of half a depth pixel */
    float *z;     /* RLF_KERNEL_NOTHING where nothing lands */
} rlf_kernel_points;

/* A row of rectangles in colour pixels, inclusive. One without pixels has y = -1, x0 = x1 = 0, and
 * its point's z is RLF_KERNEL_NOTHING. */
typedef struct rlf_kernel_splat {
    int32_t *x0, *x1;
    int32_t *y;  /* y0 * RLF_KERNEL_ROWS + y1 */
    int32_t *y0; /* work memory */
} rlf_kernel_splat;

/* Distortion as offsets from the pinhole pixel. */
typedef struct rlf_kernel_lens {
    float *du, *dv; /* [row][column]; RLF_KERNEL_NOTHING outside the lens model */
    int32_t columns, rows;
    float left, top;                /* pinhole pixel of knot (0, 0) */
    float per_pixel_x, per_pixel_y; /* knots per pixel */
} rlf_kernel_lens;

void rlf_kernel_project_row(const rlf_kernel_pinhole *params, const rlf_kernel_rays *rays,
                            const float *restrict depth, int32_t count,
                            const rlf_kernel_points *out);
/* Moves pinhole pixels to where the lens puts them; outside the table nothing lands. */
void rlf_kernel_distort_row(const rlf_kernel_lens *lens, int32_t count,
                            const rlf_kernel_points *points);
/* Rectangles' scale times their size. */
void rlf_kernel_stretch_row(const float *restrict size, int32_t count, float *restrict scale);
void rlf_kernel_splat_row(const rlf_kernel_pinhole *params, const rlf_kernel_points *points,
                          int32_t count, const rlf_kernel_splat *out);
/* First i of begin < i < count, else count, whose rectangle has pixels and other rows than that at
 * `begin`; into `out` the least x0 and largest x1 of those before it, without those that have no
 * pixels, and how wide the widest is, pixels. */
int32_t rlf_kernel_splat_run(const rlf_kernel_splat *splat, int32_t begin, int32_t count,
                             int32_t out[3]);
/* Fills with RLF_KERNEL_NOTHING. */
void rlf_kernel_clear_row(int32_t count, float *restrict out);
/* 1 where there is a depth, else 0. */
void rlf_kernel_seen_row(const float *restrict z, int32_t count, uint8_t *restrict out);
/* First i of begin <= i < count, else count, at which there is a depth (is_seen 1) or none (0). */
int32_t rlf_kernel_find_seen(const float *z, int32_t begin, int32_t count, int32_t is_seen);
/* Keeps the smaller value of each. */
void rlf_kernel_nearer_row(const float *restrict line, int32_t count, float *restrict out);

/* ---- knot_row.c: between pixels and knots, see surface/thickness/knots.c
 * --------------------------------------------------- */

/* Of a region's pixels: their depth, the inverse of what was sensed, 0 = nothing, and the label. */
void rlf_kernel_chord_front(const float *restrict raw, const float *restrict depth, int32_t label,
                            int32_t count, float *restrict front, float *restrict inverse,
                            int32_t *restrict labels);
/* Of every step-th pixel the front, or less than 0 where there is none: -depth. */
void rlf_kernel_knot_row(const float *restrict front, const float *restrict depth, int32_t step,
                         int32_t count, float *restrict knot);

/* Three rows of knots: depth (of the bodies' knots; of others it is negative, 0 = unknown), a value
 * and the row's weight. */
typedef struct rlf_kernel_knots {
    const float *depth[3], *value[3];
    float weight[3];
} rlf_kernel_knots;

/* Values at `count` knots and at the pixels to the right of them, whose depths are given: means of
 * 3x3 pixels between the knots around that differ in depth by less than `jump`. Squares are
 * averaged: the square of a conic's thickness is straight up to its ends, and 0 at the knots that
 * lie behind it. Reads a knot more on both sides. */
void rlf_kernel_spread_row(const rlf_kernel_knots *in, int32_t count, float jump,
                           const float *restrict at, const float *restrict right,
                           float *restrict out_at, float *restrict out_right);

/* Least and most, metres. */
typedef struct rlf_kernel_thickness {
    float least, most;
} rlf_kernel_thickness;

/* Keeps thickness within its limits, and before the background `behind`, 0 = unknown. */
void rlf_kernel_thickness_row(const rlf_kernel_thickness *limits, const float *restrict depth,
                              const float *restrict behind, int32_t count,
                              float *restrict thickness);

/* ---- chord_row.c: chords of the foreground, see surface/thickness/thickness.h
 * --------------------------------------------------- */

#define RLF_CHORD_RUN 64 /* most pixels at a time */

/* Ends in steps along its line. */
typedef struct rlf_kernel_chord {
    float begin, end;
} rlf_kernel_chord;

/* Variance of depth: of a sample, and by how far the ends are known; the depth z and its inverse
 * that samples are relative to. */
typedef struct rlf_kernel_chord_noise {
    float noise, blur[2];
    float metres, inverse, z;
} rlf_kernel_chord_noise;

/* Weighted sums of s (metres along the chord), h (its profile) and y (depth). */
typedef struct rlf_kernel_chord_sums {
    float n, s, h, y, ss, hh, sh, sy, hy, yy;
} rlf_kernel_chord_sums;

/* Adds the samples of the pixels first .. first + count - 1, at most RLF_CHORD_RUN of them, in
 * their order; `seen` is inverse depth, 0 = none. */
void rlf_kernel_chord_sum(const rlf_kernel_chord *chord, const rlf_kernel_chord_noise *noise,
                          const float *restrict seen, int32_t first, int32_t count,
                          rlf_kernel_chord_sums *restrict sums);

/* What a chord's shape says of a pixel's solid: middle + slope k +- half profile(k) in inverse
 * depth, with weights share / (l r), l and r being the steps to its ends. */
typedef struct rlf_kernel_chord_solid {
    float share, middle, slope, half;
} rlf_kernel_chord_solid;

/* Weights of `count` pixels, first and every step-th beyond, at most RLF_CHORD_RUN of them, and
 * weighted middles and halves. */
void rlf_kernel_chord_solid_run(const rlf_kernel_chord *chord, const rlf_kernel_chord_solid *solid,
                                int32_t first, int32_t step, int32_t count, float *restrict weight,
                                float *restrict middle, float *restrict half);

#endif
