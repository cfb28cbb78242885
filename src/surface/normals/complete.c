/* Normals of the few pixels that have none yet: from their neighbours, and where these have none
 * either from their own differences.
 *
 * What a neighbour has was seen; what it was given here is a guess. A guess that is handed on from
 * pixel to pixel in the order of the rows makes faces grow to the right and downwards. So what is
 * found in a band is kept aside until the band is done; only pixels about which nothing was seen
 * take others' guesses.
 *
 * From neighbours: their mean, weighted by nearness. Where they are of two faces a mean of both is
 * neither, and the planes of the faces decide which of them the pixel's ray meets, as at a crease
 * that is seen; where they do not meet there, the one at the pixel's depth. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

/* ---- one pixel ---- */

enum { REACH = RLF_WINDOW_ABOUT, SIDE = 1 + 2 * REACH, LANES = 8 /* of which SIDE count */ };

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

/* The normal that those about a pixel have for it; false, and nothing is written, when none. */
static bool find_near(const rlf_normals_job *job, int32_t x, int32_t y, float out[3])
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

/* ---- all of them ---- */

enum {
    BAND_ROWS = RLF_ROW_GRAIN,
    MOST_ASIDE = 2048 /* pixels of a band; of what is beyond, the next ones know */
};

typedef struct found {
    ptrdiff_t i;
    float normal[3];
} found;

/* Normals of a band that are not in the image yet. */
typedef struct aside {
    found pixel[MOST_ASIDE];
    int32_t count;
} aside;

static bool is_without(const rlf_normals_job *job, ptrdiff_t i)
{
    return job->out[0][i] == 0.0f && job->out[1][i] == 0.0f && job->out[2][i] == 0.0f;
}

static void write_normal(const rlf_normals_job *job, ptrdiff_t i, const float normal[3])
{
    for (int k = 0; k < 3; k++) {
        job->out[k][i] = normal[k];
    }
}

/* False when nothing was seen about the pixel. */
static bool complete_pixel(const rlf_normals_job *job, int32_t x, int32_t y, aside *to)
{
    found f = {.i = (ptrdiff_t)y * job->width + x};
    if (!find_near(job, x, y, f.normal)) {
        return false;
    }
    if (to->count < MOST_ASIDE) {
        to->pixel[to->count++] = f;
    } else {
        write_normal(job, f.i, f.normal);
    }
    return true;
}

/* Takes guesses as well. */
static void complete_rest(const rlf_normals_job *job, int32_t x, int32_t y)
{
    float normal[3];
    if (find_near(job, x, y, normal)) {
        write_normal(job, (ptrdiff_t)y * job->width + x, normal);
    } else {
        rlf_normals_slope_pixel(job, x, y);
    }
}

/* 1 where there is a depth and no normal, else 0. */
RLF_KERNEL static void find_bare(const float *restrict depth, const float *restrict normal_z,
                                 int32_t count, uint8_t *restrict bare)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i], n = normal_z[i];
        bool is_bare = (z > 0.0f) & (n == 0.0f);
        bare[i] = is_bare ? 1 : 0;
    }
}

/* How many pixels still have none. `to` is NULL when these are to be completed by all means. */
static int32_t complete_row(const rlf_normals_job *job, int32_t y, aside *to)
{
    ptrdiff_t row = (ptrdiff_t)y * job->width;
    int32_t left = 0;
    for (int32_t begin = 0; begin < job->width; begin += RLF_PART) {
        uint8_t bare[RLF_PART];
        int32_t count = begin + RLF_PART < job->width ? RLF_PART : job->width - begin;
        find_bare(job->filled + row + begin, job->out[2] + row + begin, count, bare);
        for (int32_t k = 0; (k = rlf_kernel_next_mark(bare, k, count)) < count; k++) {
            int32_t x = begin + k;
            if (!is_without(job, row + x)) {
                continue;
            }
            if (to == NULL) {
                complete_rest(job, x, y);
            } else if (!complete_pixel(job, x, y, to)) {
                left++;
            }
        }
    }
    return left;
}

/* Completes every second band of rows. The bands between them rest meanwhile, so no two threads
 * meet and the order is the same for any number of them. */
typedef struct completion {
    const rlf_normals_job *job;
    int32_t parity;
} completion;

static void complete_band(const rlf_normals_job *job, int32_t y0, int32_t y1)
{
    aside kept;
    kept.count = 0;
    int32_t left = 0;
    for (int32_t y = y0; y < y1; y++) {
        left += complete_row(job, y, &kept);
    }
    for (int32_t k = 0; k < kept.count; k++) {
        write_normal(job, kept.pixel[k].i, kept.pixel[k].normal);
    }
    for (int32_t y = y0; y < y1 && left > 0; y++) {
        complete_row(job, y, NULL);
    }
}

static void complete_bands(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const completion *c = context;
    for (int32_t pair = begin; pair < end; pair++) {
        int32_t y0 = (2 * pair + c->parity) * BAND_ROWS;
        int32_t y1 = y0 + BAND_ROWS < c->job->height ? y0 + BAND_ROWS : c->job->height;
        complete_band(c->job, y0, y1);
    }
}

void rlf_normals_plane_complete(const rlf_normals_job *job)
{
    rlf_normals_job copy = *job;
    copy.filled = job->filled != NULL ? job->filled : job->depth;
    copy.depth = copy.filled;
    int32_t pairs = (job->height + 2 * BAND_ROWS - 1) / (2 * BAND_ROWS);
    for (int32_t parity = 0; parity < 2; parity++) {
        completion c = {&copy, parity};
        rlf_parallel_for(job->pool, pairs, 1, complete_bands, &c);
    }
}
