/* Two rows of pixels as one of half the resolution, and what planes found there say to the whole
 * one: see surface/normals/wide.c. */
#include "kernel/plane_window.h"

#include <math.h>

enum { CHUNK = 64, HALF = CHUNK / 2 };

/* Depths of a block may differ by so many sigmas and this share of the depth: what differs by more
 * lies on two sides of an edge. */
static const float most_sigmas = 5.0f, most_share = 0.03f;

/* A wide plane speaks for a pixel whose own plane turns away by at most so many times the error
 * that noise makes in it, and lies so many sigmas before or behind; for its depth as well where it
 * turns away by less: beside a crease the wide plane is the one that is rounder. */
static const float most_turn = 5.0f, most_turn_depth = 3.0f, most_off = 1.5f;

/* Where wide planes turn by more times that error from block to block, the surface is round. */
static const float most_bend = 1.0f;

RLF_KERNEL void rlf_kernel_halve_row(rlf_kernel_noise noise, const float *restrict upper,
                                     const float *restrict lower, int32_t count,
                                     float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float a = upper[2 * i], b = upper[2 * i + 1], c = lower[2 * i], d = lower[2 * i + 1];
        float low_top = a < b ? a : b, low_end = c < d ? c : d;
        float high_top = a < b ? b : a, high_end = c < d ? d : c;
        float low = low_top < low_end ? low_top : low_end;
        float high = high_top < high_end ? high_end : high_top;
        float mean = 0.25f * ((a + b) + (c + d));
        float most = most_sigmas * rlf_kernel_sigma(noise, mean) + most_share * mean;
        out[i] = (low > 0.0f) & (high - low < most) ? mean : 0.0f;
    }
}

RLF_KERNEL void rlf_kernel_halve_frames(const float *restrict upper, const float *restrict lower,
                                        int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float a = rlf_kernel_abs(upper[2 * i]), b = rlf_kernel_abs(upper[2 * i + 1]);
        float c = rlf_kernel_abs(lower[2 * i]), d = rlf_kernel_abs(lower[2 * i + 1]);
        float top = a < b ? a : b, low = c < d ? c : d;
        out[i] = top < low ? top : low;
    }
}

RLF_KERNEL void rlf_kernel_invert_planes(const float *restrict depth, const float *restrict ray_x,
                                         const float *restrict ray_y, int32_t count,
                                         float *restrict x, float *restrict y, float *restrict z)
{
    for (int32_t i = 0; i < count; i++) {
        float through = depth[i] * (x[i] * ray_x[i] + y[i] * ray_y[i] + z[i]);
        float whole = through < 0.0f ? 1.0f / (through < 0.0f ? through : -1.0f) : 0.0f;
        x[i] *= whole;
        y[i] *= whole;
        z[i] *= whole;
    }
}

/* Sigma of inverse depth that is the mean of so many frames. */
RLF_KERNEL_PART float mean_sigma(rlf_kernel_noise noise, float w, float frames, float lasting)
{
    float left = 1.0f / rlf_kernel_averaged_frames(frames);
    return sqrtf(rlf_kernel_left_variance(rlf_kernel_inverse_sigma(noise, w), left, lasting));
}

RLF_KERNEL_PART float square_of(float x, float y, float z)
{
    return x * x + y * y + z * z;
}

typedef struct plane_run {
    float x[CHUNK], y[CHUNK], z[CHUNK];
} plane_run;

typedef struct plane_at {
    const float *x, *y, *z;
} plane_at;

RLF_KERNEL_PART plane_at step(plane_at p, int32_t by)
{
    return (plane_at){p.x + by, p.y + by, p.z + by};
}

/* Planes with a quarter of those beside them, which are nearer to the pixel than the next ones,
 * where both say nearly the same of the ray. None where these turn apart. */
RLF_KERNEL_PART void lean(const rlf_kernel_wide *in, plane_at own, plane_at beside, int32_t first,
                          int32_t count, plane_run *restrict out, int32_t to)
{
    const float *restrict ray_x = in->half_ray_x + first, *restrict ray_y = in->half_ray_y + first;
    const float *restrict x = own.x, *restrict y = own.y, *restrict z = own.z;
    const float *restrict u = beside.x, *restrict v = beside.y, *restrict w = beside.z;
    const float *restrict frames = in->half_frames + first;
    const rlf_kernel_noise noise = in->noise;
    const float tilt = in->tilt, lasting = in->lasting;
    for (int32_t i = 0; i < count; i++) {
        float mine = x[i] * ray_x[i] + y[i] * ray_y[i] + z[i];
        float off = u[i] * ray_x[i] + v[i] * ray_y[i] + w[i] - mine;
        float sigma = mean_sigma(noise, mine, frames[i], lasting);
        float turn = square_of(u[i] - x[i], v[i] - y[i], w[i] - z[i]);
        float error = most_bend * tilt * sigma; /* radians, times the inverse depth */
        float most = error * error * square_of(x[i], y[i], z[i]);
        int is_near = rlf_kernel_abs(off) < most_off * sigma ? 1 : 0;
        int is_bent = turn * (mine * mine) < most ? 0 : is_near;
        float share = is_near != 0 ? 0.25f : 0.0f;
        float kept = is_bent != 0 ? 0.0f : 1.0f;
        out->x[to + i] = kept * (x[i] + share * (u[i] - x[i]));
        out->y[to + i] = kept * (y[i] + share * (v[i] - y[i]));
        out->z[to + i] = kept * (z[i] + share * (w[i] - z[i]));
    }
}

RLF_KERNEL_PART void repeat(plane_run *run, int32_t from, int32_t to)
{
    run->x[to] = run->x[from];
    run->y[to] = run->y[from];
    run->z[to] = run->z[from];
}

RLF_KERNEL_PART void interleave(const float *restrict left, const float *restrict right,
                                int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[2 * i] = left[i];
        out[2 * i + 1] = right[i];
    }
}

/* Planes for the pixels of `count` columns of the half from `first` on. */
RLF_KERNEL_PART void expand(const rlf_kernel_wide *in, int32_t first, int32_t count,
                            plane_run *restrict out)
{
    plane_run row, left, right; /* row: from column first - 1 to first + count */
    int32_t begin = first > 0 ? first - 1 : 0;
    int32_t end = first + count < in->half_width ? first + count + 1 : in->half_width;
    int32_t skipped = begin - (first - 1);
    plane_at own = {in->plane[0], in->plane[1], in->plane[2]};
    plane_at beside = {in->beside[0], in->beside[1], in->beside[2]};
    lean(in, step(own, begin), step(beside, begin), begin, end - begin, &row, skipped);
    if (skipped > 0) {
        repeat(&row, 1, 0);
    }
    if (end == first + count) {
        repeat(&row, count, count + 1);
    }
    plane_at at = {row.x, row.y, row.z};
    lean(in, step(at, 1), at, first, count, &left, 0);
    lean(in, step(at, 1), step(at, 2), first, count, &right, 0);
    interleave(left.x, right.x, count, out->x);
    interleave(left.y, right.y, count, out->y);
    interleave(left.z, right.z, count, out->z);
}

typedef struct wide_says {
    float x[CHUNK], y[CHUNK], z[CHUNK], depth[CHUNK];
    int32_t is_said[CHUNK], is_flat[CHUNK]; /* the normal is taken; the depth */
} wide_says;

RLF_KERNEL_PART void judge(const rlf_kernel_wide *in, const plane_run *restrict wide, int32_t first,
                           int32_t count, const float *const normal[3],
                           const float *restrict smooth, wide_says *restrict out)
{
    const float *restrict depth = in->depth + first;
    const float *restrict ray_x = in->ray_x + first, *restrict ray_y = in->ray_y + first;
    const float *restrict nx = normal[0], *restrict ny = normal[1], *restrict nz = normal[2];
    const float *restrict frames = in->frames + first;
    const rlf_kernel_noise noise = in->noise;
    const float tilt = in->tilt, lasting = in->lasting;
    for (int32_t i = 0; i < count; i++) {
        float inverse = wide->x[i] * ray_x[i] + wide->y[i] * ray_y[i] + wide->z[i];
        float length = square_of(wide->x[i], wide->y[i], wide->z[i]);
        float scale = -1.0f / sqrtf(length > 1e-30f ? length : 1.0f);
        float x = wide->x[i] * scale, y = wide->y[i] * scale, z = wide->z[i] * scale;
        float there = 1.0f / (inverse > 1e-3f ? inverse : 1.0f);
        float deep = depth[i] > 0.0f ? depth[i] : 1.0f;
        float sigma = deep * deep * mean_sigma(noise, 1.0f / deep, frames[i], lasting);
        float error = tilt * sigma / deep;
        float square = error * error;
        float turn = square_of(x - nx[i], y - ny[i], z - nz[i]); /* of the chord, squared */
        int is_plane = (depth[i] > 0.0f ? 1 : 0) & (inverse > 1e-3f ? 1 : 0);
        int is_bare = square_of(nx[i], ny[i], nz[i]) < 0.5f ? 1 : 0;
        int is_like = turn < most_turn * most_turn * square ? 1 : 0;
        int is_same = turn < most_turn_depth * most_turn_depth * square ? 1 : 0;
        int is_near = rlf_kernel_abs(there - smooth[i]) < most_off * sigma ? 1 : 0;
        out->x[i] = x;
        out->y[i] = y;
        out->z[i] = z;
        out->depth[i] = there;
        out->is_said[i] = is_plane & is_near & (is_bare | is_like);
        out->is_flat[i] = is_plane & is_near & is_same;
    }
}

RLF_KERNEL_PART void take(const int32_t *restrict marks, const float *restrict from, int32_t count,
                          float *restrict to)
{
    for (int32_t i = 0; i < count; i++) {
        to[i] = marks[i] != 0 ? from[i] : to[i];
    }
}

RLF_KERNEL void rlf_kernel_wide_row(const rlf_kernel_wide *in, float *const normal[3],
                                    float *restrict smooth)
{
    plane_run wide;
    wide_says says;
    enum { MOST = HALF - 2 }; /* and one on each side */
    for (int32_t first = 0; first < in->half_width; first += MOST) {
        int32_t half = in->half_width - first < MOST ? in->half_width - first : MOST;
        int32_t at = 2 * first, count = 2 * half;
        float *const own[3] = {normal[0] + at, normal[1] + at, normal[2] + at};
        expand(in, first, half, &wide);
        judge(in, &wide, at, count, (const float *const *)own, smooth + at, &says);
        take(says.is_said, says.x, count, own[0]);
        take(says.is_said, says.y, count, own[1]);
        take(says.is_said, says.z, count, own[2]);
        take(says.is_flat, says.depth, count, smooth + at);
    }
}
