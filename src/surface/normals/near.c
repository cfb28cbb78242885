/* Normals of pixels that no plane explains, or that were filled, from those about them: their mean,
 * weighted by nearness. Where they are of two faces a mean of both is neither, and the planes of
 * the faces decide which of them the pixel's ray meets, as at a crease that is seen; where they do
 * not meet there, the one at the pixel's depth. */
#include "surface/normals/face.h"
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

enum { REACH = 2 };

static const double AGREED = 0.84;     /* length of a mean of normals of one face */
static const float TURNED = 0.85f;     /* cosine between the normals of two faces */
static const float MOST_APART = 0.03f; /* share of the depth, of what is about the pixel */

/* The pixels about one at the image's border, 0 outside. */
typedef struct near_copy {
    float depth[5][RLF_NEAR_LANES], normal[3][5][RLF_NEAR_LANES];
} near_copy;

static void copy_near(const rlf_normals_job *job, int32_t x, int32_t y, near_copy *out)
{
    rlf_window w = rlf_window_at(job->width, job->height, x, y, REACH);
    memset(out, 0, sizeof *out);
    for (int32_t dy = w.y0; dy <= w.y1; dy++) {
        ptrdiff_t row = (ptrdiff_t)(y + dy) * job->width + x;
        for (int32_t dx = w.x0; dx <= w.x1; dx++) {
            int32_t v = dy + REACH, u = dx + REACH;
            out->depth[v][u] = job->filled[row + dx];
            out->normal[0][v][u] = job->out[0][row + dx];
            out->normal[1][v][u] = job->out[1][row + dx];
            out->normal[2][v][u] = job->out[2][row + dx];
        }
    }
}

/* The kernel reads RLF_NEAR_LANES pixels of each row: at its end those of the next one. */
static bool is_inside(const rlf_normals_job *job, int32_t x, int32_t y)
{
    rlf_window w = rlf_window_at(job->width, job->height, x, y, REACH);
    int32_t room = job->width - (x - REACH) - RLF_NEAR_LANES;
    return rlf_window_is_whole(w, REACH) && (room >= 0 || y + REACH + 1 < job->height);
}

/* Of the normals within two pixels at the same depth: x, y, z and how many, weighted. */
static void sum_near(const rlf_normals_job *job, int32_t x, int32_t y, float sum[4])
{
    ptrdiff_t corner = (ptrdiff_t)(y - 2) * job->width + x - 2;
    rlf_kernel_near about;
    near_copy copy;
    if (is_inside(job, x, y)) {
        about =
            (rlf_kernel_near){job->filled + corner,
                              {job->out[0] + corner, job->out[1] + corner, job->out[2] + corner},
                              job->width};
    } else {
        copy_near(job, x, y, &copy);
        about = (rlf_kernel_near){copy.depth[0],
                                  {copy.normal[0][0], copy.normal[1][0], copy.normal[2][0]},
                                  RLF_NEAR_LANES};
    }
    rlf_kernel_near_normal(&about, sum);
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
    rlf_window w = rlf_window_at(job->width, job->height, x, y, REACH);
    for (int32_t dy = w.y0; dy <= w.y1; dy++) {
        for (int32_t dx = w.x0; dx <= w.x1; dx++) {
            ptrdiff_t k = i + (ptrdiff_t)dy * job->width + dx;
            int32_t square = dx * dx + dy * dy;
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
