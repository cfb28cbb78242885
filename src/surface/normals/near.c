/* Normals of pixels that no plane explains, or that were filled, from those about them: their mean,
 * weighted by nearness. Where they are of two faces a mean of both is neither, and the planes of
 * the faces decide which of them the pixel's ray meets, as at a crease that is seen; where they do
 * not meet there, the one at the pixel's depth. */
#include "surface/normals/face.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

enum { REACH = 2, SIDE = 1 + 2 * REACH, LANES = 8 /* of which SIDE count */ };

static const double AGREED = 0.84;     /* length of a mean of normals of one face */
static const float TURNED = 0.85f;     /* cosine between the normals of two faces */
static const float ONE_DEPTH = 0.02f;  /* share of the depth: pixels of one surface */
static const float MOST_APART = 0.03f; /* share of the depth, of what is about the pixel */

/* Inverse fourth power of the distance: beside a crease the nearest pixels are most likely of the
 * same face. 0 beyond the window, and for the pixel itself. */
static const float nearness[SIDE][LANES] = {{0.015625f, 0.04f, 0.0625f, 0.04f, 0.015625f},
                                            {0.04f, 0.25f, 1.0f, 0.25f, 0.04f},
                                            {0.0625f, 1.0f, 0.0f, 1.0f, 0.0625f},
                                            {0.04f, 0.25f, 1.0f, 0.25f, 0.04f},
                                            {0.015625f, 0.04f, 0.0625f, 0.04f, 0.015625f}};

/* The pixels about one from the corner of their window, LANES of each row, where they lie. */
typedef struct near_rows {
    const float *depth, *normal[3];
    ptrdiff_t stride;
} near_rows;

/* The same of a pixel at the image's border, 0 outside. */
typedef struct near_copy {
    float depth[SIDE][LANES], normal[3][SIDE][LANES];
} near_copy;

/* What of the window about a pixel is in the image. */
static rlf_rect window_at(const rlf_normals_job *job, int32_t x, int32_t y)
{
    return (rlf_rect){x > REACH ? x - REACH : 0, y > REACH ? y - REACH : 0,
                      rlf_least(x + REACH + 1, job->width), rlf_least(y + REACH + 1, job->height)};
}

static void copy_near(const rlf_normals_job *job, int32_t x, int32_t y, near_copy *out)
{
    const rlf_rect w = window_at(job, x, y);
    memset(out, 0, sizeof *out);
    for (int32_t row = w.y0; row < w.y1; row++) {
        for (int32_t column = w.x0; column < w.x1; column++) {
            ptrdiff_t i = (ptrdiff_t)row * job->width + column;
            int32_t v = row - y + REACH, u = column - x + REACH;
            out->depth[v][u] = job->filled[i];
            for (int k = 0; k < 3; k++) {
                out->normal[k][v][u] = job->out[k][i];
            }
        }
    }
}

/* LANES pixels of each row are in the planes: at a row's end those of the next one. */
static bool is_inside(const rlf_normals_job *job, int32_t x, int32_t y)
{
    bool has_lanes = x - REACH + LANES <= job->width || y + REACH + 1 < job->height;
    return x >= REACH && y >= REACH && x + REACH < job->width && y + REACH < job->height &&
           has_lanes;
}

/* Of the normals within two pixels at the same depth: x, y, z and how many, weighted. */
RLF_KERNEL static void sum_rows(const near_rows *restrict about, float *restrict sum)
{
    float lanes[4][LANES];
    const float *restrict depth = about->depth, *restrict normal_x = about->normal[0];
    const float *restrict normal_y = about->normal[1], *restrict normal_z = about->normal[2];
    ptrdiff_t stride = about->stride;
    float middle = depth[REACH * stride + REACH], most = ONE_DEPTH * middle;
    for (int32_t c = 0; c < LANES; c++) {
        float x = 0.0f, y = 0.0f, z = 0.0f, w = 0.0f;
        for (int32_t r = 0; r < SIDE; r++) {
            ptrdiff_t i = r * stride + c;
            float nx = normal_x[i], ny = normal_y[i], nz = normal_z[i];
            float apart = rlf_kernel_abs(depth[i] - middle);
            float weight = apart <= most ? nearness[r][c] : 0.0f;
            x += weight * nx;
            y += weight * ny;
            z += weight * nz;
            w += weight * (nx * nx + ny * ny + nz * nz);
        }
        lanes[0][c] = x;
        lanes[1][c] = y;
        lanes[2][c] = z;
        lanes[3][c] = w;
    }
    for (int32_t k = 0; k < 4; k++) {
        const float *of = lanes[k];
        sum[k] = ((of[0] + of[4]) + (of[1] + of[3])) + of[2];
    }
}

static void sum_near(const rlf_normals_job *job, int32_t x, int32_t y, float sum[4])
{
    ptrdiff_t at = (ptrdiff_t)(y - REACH) * job->width + x - REACH;
    if (is_inside(job, x, y)) {
        const near_rows rows = {
            job->filled + at, {job->out[0] + at, job->out[1] + at, job->out[2] + at}, job->width};
        sum_rows(&rows, sum);
    } else {
        near_copy copy;
        copy_near(job, x, y, &copy);
        const near_rows rows = {
            copy.depth[0], {copy.normal[0][0], copy.normal[1][0], copy.normal[2][0]}, LANES};
        sum_rows(&rows, sum);
    }
}

static float cosine(const rlf_normals_job *job, ptrdiff_t a, ptrdiff_t b)
{
    return job->out[0][a] * job->out[0][b] + job->out[1][a] * job->out[1][b] +
           job->out[2][a] * job->out[2][b];
}

/* The nearest pixel with a normal; of those that turn away from pixel `other`, unless that is < 0.
 * -1 = none. */
static ptrdiff_t nearest_face(const rlf_normals_job *job, int32_t x, int32_t y, ptrdiff_t other)
{
    ptrdiff_t i = (ptrdiff_t)y * job->width + x, best = -1;
    int32_t least = 1 + 2 * REACH * REACH;
    const rlf_rect w = window_at(job, x, y);
    for (int32_t row = w.y0; row < w.y1; row++) {
        for (int32_t column = w.x0; column < w.x1; column++) {
            ptrdiff_t k = (ptrdiff_t)row * job->width + column;
            int32_t dx = column - x, dy = row - y, square = dx * dx + dy * dy;
            float apart = rlf_kernel_abs(job->filled[k] - job->filled[i]);
            bool near = square > 0 && square < least && apart < MOST_APART * job->filled[i];
            if (near && cosine(job, k, k) > 0.5f && (other < 0 || cosine(job, k, other) < TURNED)) {
                least = square;
                best = k;
            }
        }
    }
    return best;
}

/* The pixel whose face pixel (x, y) is on, when two faces meet about it; -1 when none do. */
static ptrdiff_t find_face(const rlf_normals_job *job, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * job->width + x;
    ptrdiff_t a = nearest_face(job, x, y, -1), b = a < 0 ? -1 : nearest_face(job, x, y, a);
    if (b < 0) {
        return -1;
    }
    const rlf_faces faces = {job->ray_x, job->ray_y, job->filled, job->out};
    float a_at_b = rlf_face_depth(&faces, a, b), b_at_a = rlf_face_depth(&faces, b, a);
    float za = rlf_face_depth(&faces, a, i), zb = rlf_face_depth(&faces, b, i);
    rlf_meeting meeting = rlf_faces_meet(job->filled[a], b_at_a, job->filled[b], a_at_b);
    if (meeting == RLF_FACES_APART || !(za > 0.0f) || !(zb > 0.0f)) {
        float z = job->filled[i];
        return rlf_kernel_abs(za - z) <= rlf_kernel_abs(zb - z) ? a : b;
    }
    return (meeting == RLF_FACES_CONVEX ? za > zb : za < zb) ? a : b;
}

bool rlf_normals_near_pixel(const rlf_normals_job *job, int32_t x, int32_t y, float out[3])
{
    ptrdiff_t i = (ptrdiff_t)y * job->width + x;
    float sum[4];
    sum_near(job, x, y, sum);
    rlf_vec3 whole = rlf_vec3_make(sum[0], sum[1], sum[2]), mean = rlf_normalize(whole);
    rlf_vec3 ray = {job->ray_x[i], job->ray_y[i], 1.0};
    if (!(rlf_dot(mean, ray) < 0.0)) {
        return false;
    }
    bool agreed = rlf_length(whole) >= AGREED * (double)sum[3];
    ptrdiff_t face = agreed ? -1 : find_face(job, x, y);
    out[0] = face < 0 ? (float)mean.x : job->out[0][face];
    out[1] = face < 0 ? (float)mean.y : job->out[1][face];
    out[2] = face < 0 ? (float)mean.z : job->out[2][face];
    return true;
}
