/* Normals of clean depth in the exact inverse-depth form.
 *
 * On a plane n.P = d the inverse depth w = (n.m) / d is linear in the ray m, whatever the lens. For
 * two pixels of the plane, t = w0 dm - m0 dw is a tangent (n.t = 0), exactly and for any step: one
 * tangent along the row and one along the column give the normal. Which neighbour each tangent uses
 * is chosen as in essentially non-oscillatory schemes (Harten et al. 1987): the two sides where
 * they agree, otherwise the side whose own second difference of w is smaller, so that the
 * stencil never straddles a depth edge or a crease when one side is smooth. */
#include "kernel/kernel.h"

#include <math.h>

RLF_KERNEL void rlf_kernel_inverse_row(const float *restrict depth, int32_t count,
                                       float *restrict inverse)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i];
        inverse[i] = z > 0.0f ? 1.0f / (z > 0.0f ? z : 1.0f) : 0.0f;
    }
}

typedef struct difference {
    float w, x, y; /* of inverse depth and of the ray */
    float ok;      /* 0 when neither side has a usable neighbour */
} difference;

/* w[0..4]: two before, one before, centre, one after, two after; x, y: before, centre, after. */
RLF_KERNEL_PART difference choose_side(const float w[5], const float x[3], const float y[3])
{
    const float far_off = 1e9f;
    const float jump = 0.08f; /* of inverse depth: no surface is this steep per pixel */
    float before = w[2] - w[1];
    float after = w[3] - w[2];
    float has_before = w[1] > 0.0f ? 1.0f : 0.0f;
    float has_after = w[3] > 0.0f ? 1.0f : 0.0f;
    float curve_before = w[0] > 0.0f ? rlf_kernel_abs(before - (w[1] - w[0])) : w[2];
    float curve_after = w[4] > 0.0f ? rlf_kernel_abs((w[4] - w[3]) - after) : w[2];
    curve_before = rlf_kernel_abs(before) > jump * w[2] ? curve_before + w[2] : curve_before;
    curve_after = rlf_kernel_abs(after) > jump * w[2] ? curve_after + w[2] : curve_after;
    curve_before = w[1] > 0.0f ? curve_before : far_off;
    curve_after = w[3] > 0.0f ? curve_after : far_off;
    float least = curve_before < curve_after ? curve_before : curve_after;
    float curve_both = rlf_kernel_abs(after - before);
    /* Where the outer pixels are missing, both sides count as smooth when they agree. */
    float agree = 4.0f * least > 0.0f ? 4.0f * least : 0.0f;
    bool both = curve_both <= agree + 1e-7f * w[2] && has_before * has_after > 0.0f;
    bool first = both || curve_before <= curve_after;
    bool last = both || curve_before > curve_after;
    float p = first ? 1.0f : 0.0f;
    float q = last ? 1.0f : 0.0f;
    difference d;
    d.w = p * before + q * after;
    d.x = p * (x[1] - x[0]) + q * (x[2] - x[1]);
    d.y = p * (y[1] - y[0]) + q * (y[2] - y[1]);
    d.ok = has_before + has_after > 0.0f ? 1.0f : 0.0f;
    return d;
}

typedef struct normal {
    float x, y, z;
} normal;

/* Unit normal towards the camera; without both tangents the surface is taken to face the camera. */
RLF_KERNEL_PART normal normal_of(difference u, difference v, float w, float x, float y)
{
    float ux = w * u.x - x * u.w, uy = w * u.y - y * u.w, uz = -u.w;
    float vx = w * v.x - x * v.w, vy = w * v.y - y * v.w, vz = -v.w;
    float nx = vy * uz - vz * uy;
    float ny = vz * ux - vx * uz;
    float nz = vx * uy - vy * ux;
    float square = nx * nx + ny * ny + nz * nz;
    float usable = u.ok * v.ok * (square > 1e-30f ? 1.0f : 0.0f);
    nx = usable > 0.0f ? nx : -x;
    ny = usable > 0.0f ? ny : -y;
    nz = usable > 0.0f ? nz : -1.0f;
    square = usable > 0.0f ? square : x * x + y * y + 1.0f;
    float facing = nx * x + ny * y + nz;
    float scale = (facing > 0.0f ? -1.0f : 1.0f) / sqrtf(square);
    scale = w > 0.0f ? scale : 0.0f;
    normal n = {nx * scale, ny * scale, nz * scale};
    return n;
}

RLF_KERNEL void rlf_kernel_slope_row(const rlf_kernel_slope_in *in, float *restrict out_x,
                                     float *restrict out_y, float *restrict out_z)
{
    const float *restrict w0 = in->inverse[0];
    const float *restrict w1 = in->inverse[1];
    const float *restrict w2 = in->inverse[2];
    const float *restrict w3 = in->inverse[3];
    const float *restrict w4 = in->inverse[4];
    const float *restrict x0 = in->ray_x[0];
    const float *restrict x1 = in->ray_x[1];
    const float *restrict x2 = in->ray_x[2];
    const float *restrict y0 = in->ray_y[0];
    const float *restrict y1 = in->ray_y[1];
    const float *restrict y2 = in->ray_y[2];
    int32_t count = in->count;
    for (int32_t i = 0; i < count; i++) {
        const float wu[5] = {w2[i - 2], w2[i - 1], w2[i], w2[i + 1], w2[i + 2]};
        const float xu[3] = {x1[i - 1], x1[i], x1[i + 1]};
        const float yu[3] = {y1[i - 1], y1[i], y1[i + 1]};
        const float wv[5] = {w0[i], w1[i], w2[i], w3[i], w4[i]};
        const float xv[3] = {x0[i], x1[i], x2[i]};
        const float yv[3] = {y0[i], y1[i], y2[i]};
        difference u = choose_side(wu, xu, yu);
        difference v = choose_side(wv, xv, yv);
        normal n = normal_of(u, v, w2[i], x1[i], y1[i]);
        out_x[i] = n.x;
        out_y[i] = n.y;
        out_z[i] = n.z;
    }
}
