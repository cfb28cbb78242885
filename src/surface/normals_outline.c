/* Normals of filled pixels at the outlines of things.
 *
 * Where a smooth surface turns out of sight its normal is perpendicular to the ray and, in the
 * image, points across the outline (Koenderink 1984). The sensor drops just these pixels, and the
 * windows that fit next to them know only the part that faces the camera. Along the way out, the
 * outward component of a circle's or a ball's unit normal grows linearly with the position in the
 * image, up to 1 at the outline. So a filled pixel's normal lies between the mean of those that are
 * known further in and the outline's, if these already turn outwards.
 *
 * Things with faces turn at a crease. What is left of a narrow last face is a pixel here and there:
 * the outermost known normal stands for it. */
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/kernel.h"

#include <math.h>

enum { REACH = 2, STEPS = 5 };

static const float MOST_APART = 0.05f; /* share of the depth, of samples of one surface */
static const float LEAST_JUMP = 0.04f; /* the same, of what is behind the outline */
static const float LEAST_TURN = 0.12f; /* share of the rounded surface's turn that must be seen */
static const float MOST_BEND = 0.1f;   /* RMS of the samples about a steady turn: a crease bends */
static const float MOST_ASIDE = 0.98f; /* sine of the steepest normal that is given */
static const float CREASE = 0.95f;     /* cosine between two faces */

typedef struct outline_job {
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const float *known; /* depth that was not filled: pixels whose normals are read, not written */
    const uint8_t *reason;
    float *const *normal;
} outline_job;

/* Where the outline is, seen from a pixel in front of it. */
typedef struct outline {
    float x, y;     /* unit, outwards */
    float distance; /* pixels */
} outline;

/* Something is behind the pixel, two pixels away along the row or the column. */
static bool is_beside_outline(const outline_job *job, int32_t x, int32_t y)
{
    const float *at = job->depth + (ptrdiff_t)y * job->width + x;
    float behind = at[0] * (1.0f + LEAST_JUMP);
    ptrdiff_t row = (ptrdiff_t)REACH * job->width;
    return (x >= REACH && at[-REACH] > behind) || (y >= REACH && at[-row] > behind) ||
           (x + REACH < job->width && at[REACH] > behind) ||
           (y + REACH < job->height && at[row] > behind);
}

/* Offsets of what is behind a pixel and of what is not, within two pixels, summed. */
typedef struct sides {
    int32_t far_x, far_y, far_n, near_x, near_y, near_n;
    int32_t nearest; /* squared distance of what is behind */
} sides;

static inline sides sum_sides(const float *at, ptrdiff_t width, rlf_window b)
{
    float behind = at[0] * (1.0f + LEAST_JUMP), before = at[0] * (1.0f - LEAST_JUMP);
    sides s = {.nearest = 99};
    for (int32_t dy = b.y0; dy <= b.y1; dy++) {
        int32_t row_far = 0, row_near = 0;
        for (int32_t dx = b.x0; dx <= b.x1; dx++) {
            float z = at[dy * width + dx];
            int32_t is_far = z > behind, is_near = (z > before) & !is_far;
            int32_t square = dx * dx + dy * dy;
            row_far += is_far;
            row_near += is_near;
            s.far_x += is_far * dx;
            s.near_x += is_near * dx;
            s.nearest = is_far & (square < s.nearest) ? square : s.nearest;
        }
        s.far_n += row_far;
        s.far_y += row_far * dy;
        s.near_n += row_near;
        s.near_y += row_near * dy;
    }
    return s;
}

/* False when nothing is behind the pixel. */
static bool find_outline(const outline_job *job, int32_t x, int32_t y, outline *out)
{
    const float *at = job->depth + (ptrdiff_t)y * job->width + x;
    const rlf_window whole = {-REACH, REACH, -REACH, REACH}; /* known to the compiler: unrolled */
    rlf_window cut = rlf_window_at(job->width, job->height, x, y, REACH);
    bool inside = rlf_window_is_whole(cut, REACH);
    sides s = inside ? sum_sides(at, job->width, whole) : sum_sides(at, job->width, cut);
    if (s.far_n < 2) {
        return false;
    }
    float gx = (float)s.far_x / (float)s.far_n - (float)s.near_x / (float)s.near_n;
    float gy = (float)s.far_y / (float)s.far_n - (float)s.near_y / (float)s.near_n;
    float length = sqrtf(gx * gx + gy * gy);
    if (length < 0.5f) {
        return false;
    }
    *out = (outline){gx / length, gy / length, sqrtf((float)s.nearest) - 0.5f};
    return true;
}

typedef struct vector {
    float x, y, z;
} vector;

static float dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector scaled(vector a, float s)
{
    return (vector){a.x * s, a.y * s, a.z * s};
}

static vector add(vector a, vector b)
{
    return (vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static vector unit(vector a)
{
    return scaled(a, 1.0f / sqrtf(dot(a, a)));
}

/* 0 where there is none. */
static vector known_normal(const outline_job *job, ptrdiff_t i)
{
    float known = job->known[i] > 0.0f ? 1.0f : 0.0f;
    return (vector){known * job->normal[0][i], known * job->normal[1][i],
                    known * job->normal[2][i]};
}

static void set_normal(const outline_job *job, ptrdiff_t i, vector n)
{
    job->normal[0][i] = n.x;
    job->normal[1][i] = n.y;
    job->normal[2][i] = n.z;
}

/* Axes at a pixel: along its ray, outwards across the outline, and along it. */
typedef struct axes {
    vector ray, out, along;
} axes;

static axes make_axes(const outline_job *job, ptrdiff_t i, const outline *o)
{
    axes a;
    a.ray = unit((vector){job->ray_x[i], job->ray_y[i], 1.0f});
    vector out = {o->x, o->y, 0.0f};
    a.out = unit(add(out, scaled(a.ray, -dot(out, a.ray))));
    a.along = (vector){a.ray.y * a.out.z - a.ray.z * a.out.y, a.ray.z * a.out.x - a.ray.x * a.out.z,
                       a.ray.x * a.out.y - a.ray.y * a.out.x};
    return a;
}

/* Sums over seen samples on the way in; s = pixels from the outline, out = outward component. */
typedef struct way_in {
    float n, s, ss, out, oo, s_out, along;
} way_in;

static way_in walk_in(const outline_job *job, int32_t x, int32_t y, const outline *o, const axes *a)
{
    way_in sum = {0};
    float z = job->depth[(ptrdiff_t)y * job->width + x];
    for (int32_t k = 1; k <= STEPS; k++) {
        int32_t sx = (int32_t)((float)x - (float)k * o->x + 0.5f);
        int32_t sy = (int32_t)((float)y - (float)k * o->y + 0.5f);
        if (sx < 0 || sy < 0 || sx >= job->width || sy >= job->height) {
            break;
        }
        ptrdiff_t i = (ptrdiff_t)sy * job->width + sx;
        if (!(rlf_kernel_abs(job->depth[i] - z) <= MOST_APART * z)) {
            break;
        }
        vector n = known_normal(job, i);
        float has = dot(n, n) > 0.0f ? 1.0f : 0.0f;
        float s = o->distance + (float)(x - sx) * o->x + (float)(y - sy) * o->y;
        float out = dot(n, a->out);
        sum.n += has;
        sum.s += has * s;
        sum.ss += has * s * s;
        sum.out += has * out;
        sum.oo += has * out * out;
        sum.s_out += has * s * out;
        sum.along += has * dot(n, a->along);
    }
    return sum;
}

/* Whether the samples turn steadily outwards, as those of something rounded do. */
static bool is_rounded(const way_in *in, const outline *o)
{
    if (in->n < 1.5f) {
        return false;
    }
    float s = in->s / in->n, out = in->out / in->n;
    float spread = in->ss - in->s * s, turn = in->out * s - in->s_out;
    float bend = (in->oo - in->out * out) * spread - turn * turn;
    bool steady = bend <= in->n * MOST_BEND * MOST_BEND * spread;
    bool turns = turn * s > LEAST_TURN * spread * (1.0f - out);
    return steady && turns && s > o->distance && out >= 0.0f;
}

static vector rounded_normal(const way_in *in, const outline *o, const axes *a)
{
    float t = o->distance * in->n / in->s; /* 0 at the outline, 1 at the samples' mean */
    float out = 1.0f - t * (1.0f - in->out / in->n), along = t * in->along / in->n;
    float aside = sqrtf(out * out + along * along);
    float scale = aside > MOST_ASIDE ? MOST_ASIDE / aside : 1.0f;
    aside *= scale;
    vector n = add(scaled(a->out, out * scale), scaled(a->along, along * scale));
    return add(n, scaled(a->ray, -sqrtf(1.0f - aside * aside)));
}

/* Where the known normals within two pixels are those of several faces and the outermost of them
 * is turned outwards: that one. */
static void take_outermost(const outline_job *job, int32_t x, int32_t y, const outline *o,
                           const axes *a)
{
    ptrdiff_t i = (ptrdiff_t)y * job->width + x;
    float z = job->depth[i], best = -1e9f;
    vector mean = {0.0f, 0.0f, 0.0f}, last = mean;
    rlf_window b = rlf_window_at(job->width, job->height, x, y, REACH);
    for (int32_t dy = b.y0; dy <= b.y1; dy++) {
        for (int32_t dx = b.x0; dx <= b.x1; dx++) {
            ptrdiff_t k = i + (ptrdiff_t)dy * job->width + dx;
            vector n = known_normal(job, k);
            if (!(rlf_kernel_abs(job->depth[k] - z) < LEAST_JUMP * z) || !(dot(n, n) > 0.0f)) {
                continue;
            }
            mean = add(mean, scaled(n, 1.0f / (float)(dx * dx + dy * dy)));
            float out = o->x * (float)dx + o->y * (float)dy;
            float along = rlf_kernel_abs(o->x * (float)dy - o->y * (float)dx);
            bool better = out - 0.2f * along > best;
            best = better ? out - 0.2f * along : best;
            last = better ? n : last;
        }
    }
    float length = sqrtf(dot(mean, mean));
    bool creased = dot(last, mean) < CREASE * length;
    if (creased && dot(last, a->out) * length > dot(mean, a->out)) {
        set_normal(job, i, last);
    }
}

static void turn_pixel(const outline_job *job, int32_t x, int32_t y)
{
    outline o;
    if (!is_beside_outline(job, x, y) || !find_outline(job, x, y, &o)) {
        return;
    }
    ptrdiff_t i = (ptrdiff_t)y * job->width + x;
    axes a = make_axes(job, i, &o);
    way_in in = walk_in(job, x, y, &o, &a);
    if (is_rounded(&in, &o)) {
        set_normal(job, i, rounded_normal(&in, &o, &a));
    } else {
        take_outermost(job, x, y, &o, &a);
    }
}

static void outline_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const outline_job *job = context;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * job->width;
        const uint8_t *reason = job->reason + row; /* 0 = OK */
        for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, job->width)) < job->width; x++) {
            if (reason[x] == RLF_REASON_FILLED && !(job->known[row + x] > 0.0f)) {
                turn_pixel(job, x, y);
            }
        }
    }
}

void rlf_normals_outline(const rlf_reconstruct *stage, const float *known, rlf_slot *slot)
{
    const rlf_grid *grid = &stage->grid;
    outline_job job = {grid->width, grid->height, grid->ray_x,  grid->ray_y,
                       slot->depth, known,        slot->reason, slot->normal};
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, outline_rows, &job);
}
