/* Moments of windows of pixels and the plane of one window: the arithmetic of plane_tile.c.
 *
 * On a plane w = 1/z = A + B x + C y in the ray (x, y, 1), whatever the lens, and the normal is
 * -(B, C, A): errata of eq. 4.3. Moments are of 2x2 pixel blocks; a window is the sum of some.
 * They are taken relative to a reference, which keeps single precision far below the noise. */
#ifndef RLF_KERNEL_PLANE_WINDOW_H
#define RLF_KERNEL_PLANE_WINDOW_H

#include "kernel/kernel.h"

#include <math.h>

typedef struct rlf_plane_moments { /* of inverse depth w and ray x, y */
    float n, x, y, xx, xy, yy, w, xw, yw, ww;
    float left; /* of noise: the sum of 1 / the frames that each pixel is the mean of */
} rlf_plane_moments;

typedef struct rlf_plane_reference {
    float x, y, w; /* what moments are relative to */
} rlf_plane_reference;

/* What a window may leave: so many sigmas of a frame's noise, or of what averaging has left of it.
 */
typedef struct rlf_plane_gate {
    float sigmas;
    bool is_averaged;
} rlf_plane_gate;

typedef struct rlf_plane {
    float a, b, c;   /* inverse depth is a + b x + c y */
    float weight;    /* 0 = no plane */
    float precision; /* 1 / the square of the largest error of a pixel on it */
} rlf_plane;

/* `frames`: of which depth z is the mean; one division serves two quotients. */
RLF_KERNEL_PART rlf_plane_moments rlf_plane_pixel(float z, float frames, float ray_x, float ray_y,
                                                  rlf_plane_reference ref)
{
    bool is_seen = z > 0.0f;
    float all = rlf_kernel_averaged_frames(frames);
    float inverse = 1.0f / (is_seen ? z * all : 1.0f);
    float n = is_seen ? 1.0f : 0.0f;
    float x = is_seen ? ray_x - ref.x : 0.0f;
    float y = is_seen ? ray_y - ref.y : 0.0f;
    float w = is_seen ? all * inverse - ref.w : 0.0f;
    float left = is_seen ? z * inverse : 0.0f;
    rlf_plane_moments s = {n, x, y, x * x, x * y, y * y, w, x * w, y * w, w * w, left};
    return s;
}

RLF_KERNEL_PART rlf_plane_moments rlf_plane_add(rlf_plane_moments s, rlf_plane_moments t)
{
    rlf_plane_moments sum = {s.n + t.n,   s.x + t.x,   s.y + t.y,      s.xx + t.xx,
                             s.xy + t.xy, s.yy + t.yy, s.w + t.w,      s.xw + t.xw,
                             s.yw + t.yw, s.ww + t.ww, s.left + t.left};
    return sum;
}

/* Plane of one window by least squares. The residual may be most_sigmas times the noise of a
 * surface of its slant. Its weight is how well the gradient is known, but falls with the square of
 * the variance, so that planes which straddle a crease hardly count: the variance is what was
 * measured, at least that of a frontal surface, and in a quarter of its powers at least that of the
 * slant, because planes laid across an edge are steep. Sums are scaled by n, and one division
 * serves two quotients. */
RLF_KERNEL_PART rlf_plane rlf_plane_fit(rlf_plane_moments s, rlf_plane_reference ref,
                                        rlf_kernel_noise noise, float lasting, rlf_plane_gate gate)
{
    float n = s.n > 1.0f ? s.n : 1.0f;
    float xx = n * s.xx - s.x * s.x;
    float xy = n * s.xy - s.x * s.y;
    float yy = n * s.yy - s.y * s.y;
    float xw = n * s.xw - s.x * s.w;
    float yw = n * s.yw - s.y * s.w;
    float ww = n * s.ww - s.w * s.w;
    float det = xx * yy - xy * xy;
    float least_det = 0.02f * xx * yy + 1e-30f;
    float usable = s.n > 5.5f ? 1.0f : 0.0f;
    usable = det > least_det ? usable : 0.0f;
    det = det > least_det ? det : 1.0f;
    float inv_both = 1.0f / (n * det);
    float inv = det * inv_both, inv_det = n * inv_both;
    float b = (xw * yy - yw * xy) * inv_det;
    float c = (yw * xx - xw * xy) * inv_det;
    float mx = ref.x + s.x * inv, my = ref.y + s.y * inv;
    float w = ref.w + s.w * inv;
    float a = w - b * mx - c * my;
    float residual = (ww - b * xw - c * yw) * inv;
    w = w > 1e-3f ? w : 1e-3f;
    float square = (a * a + b * b + c * c) * (mx * mx + my * my + 1.0f);
    float freedom = n > 4.0f ? n - 3.0f : 1.0f;
    float sigma = rlf_kernel_inverse_sigma(noise, w);
    float slant = rlf_kernel_slant(w, sqrtf(square));
    float one_frame = sigma * sigma * freedom;
    float frontal = rlf_kernel_left_variance(sigma, s.left / n, lasting) * freedom;
    frontal = frontal > 1e-16f ? frontal : 1e-16f;
    float slanted = frontal * (slant * slant);
    float most = gate.is_averaged ? slanted : one_frame * (slant * slant);
    usable = residual <= gate.sigmas * gate.sigmas * most ? usable : 0.0f;
    float measured = residual > frontal ? residual : frontal;
    float excused = residual > slanted ? residual : slanted;
    float inv_product = 1.0f / (measured * excused);
    float inv_variance = freedom * excused * inv_product; /* freedom / measured */
    float spread = (xx < yy ? xx : yy) * inv;
    float weight = spread * inv_variance * (freedom * sqrtf(inv_product));
    rlf_plane p = {a, b, c, usable * weight, (1.0f / 9.0f) * inv_variance};
    return p;
}

/* What the plane of a window leaves: variance of a pixel's inverse depth; the middle's. */
typedef struct rlf_plane_rest {
    float variance, w;
    float slant; /* how much noisier its slant makes it */
} rlf_plane_rest;

RLF_KERNEL_PART rlf_plane_rest rlf_plane_leave(rlf_plane_moments s, rlf_plane_reference ref)
{
    float n = s.n;
    float xx = n * s.xx - s.x * s.x, xy = n * s.xy - s.x * s.y, yy = n * s.yy - s.y * s.y;
    float xw = n * s.xw - s.x * s.w, yw = n * s.yw - s.y * s.w, ww = n * s.ww - s.w * s.w;
    float det = xx * yy - xy * xy;
    float b = (xw * yy - yw * xy) / det, c = (yw * xx - xw * xy) / det;
    float mx = ref.x + s.x / n, my = ref.y + s.y / n, w = ref.w + s.w / n;
    float a = w - b * mx - c * my;
    float square = (a * a + b * b + c * c) * (mx * mx + my * my + 1.0f);
    rlf_plane_rest rest = {(ww - b * xw - c * yw) / (n * (n - 3.0f)), w,
                           rlf_kernel_slant(w, sqrtf(square))};
    return rest;
}

/* ---- wide_row.c: rows of half the resolution, and what planes found there say to the whole
 * one. */

/* Mean depth of each two pixels of two rows of 2 count; 0 where one is missing, or they are too far
 * apart for the noise. */
void rlf_kernel_halve_row(rlf_kernel_noise noise, const float *restrict upper,
                          const float *restrict lower, int32_t count, float *restrict out);
/* The fewest frames of each two pixels of two rows, as of rlf_kernel_steady_row. */
void rlf_kernel_halve_frames(const float *restrict upper, const float *restrict lower,
                             int32_t count, float *restrict out);

/* Normals, 0 where there is none, as planes of inverse depth: 1 / depth is x u + y v + z along the
 * ray (u, v, 1); 0 stays 0. */
void rlf_kernel_invert_planes(const float *restrict depth, const float *restrict ray_x,
                              const float *restrict ray_y, int32_t count, float *restrict x,
                              float *restrict y, float *restrict z);

/* A row of 2 half_width pixels, and rows of planes of inverse depth at half the resolution: that
 * which covers it and the next one above or below, the same where there is none. */
typedef struct rlf_kernel_wide {
    const float *depth, *ray_x, *ray_y;
    int32_t half_width;
    const float *frames, *half_frames; /* that depth is the mean of, and that of the half */
    const float *plane[3], *beside[3], *half_ray_x, *half_ray_y;
    rlf_kernel_noise noise;
    float lasting; /* error of inverse depth that stays in any mean, 1/m */
    float tilt;    /* radians that a pixel's own plane is off, per share that its depth is */
} rlf_kernel_wide;

/* Takes the normals of the wide planes where they agree with the pixel's own and its depth on its
 * own plane, and their depth where they are nearly the same. */
void rlf_kernel_wide_row(const rlf_kernel_wide *in, float *const normal[3], float *restrict smooth);

#endif
