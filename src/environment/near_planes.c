/* The planes of real surfaces near a body, from the pixels about it. */
#include "environment/near_planes.h"

#include <math.h>

enum { FINE = 5, COARSE = 4, SAMPLES_MAX = 2 * FINE * FINE, FOOT = 3 };

#define SMALL_PX 10.0f  /* half width of a body's surroundings: COARSE samples a side will do */
#define AROUND 0.6f     /* of the reach: surroundings that are looked at */
#define ALIKE 0.94f     /* cosine between normals of one plane, */
#define UNLIKE 0.7f     /* and of none: between, in part */
#define APART 0.25f     /* of the reach: points so far off a plane are not on it */
#define FOOT_SHARE 0.7f /* of the body's radius: where a plane is looked for below it */
#define LEAST_Z 0.05f   /* metres */
#define FEW                                                                                        \
    0.1f /* share of where a plane is looked for: if it is seen there no more, it is none, */
#define MANY 0.8f /* and if so much, it is whole */

/* A sheet of the surface: the front or the background. */
typedef struct sheet {
    const float *depth, *normal_x, *normal_y, *normal_z;
} sheet;

typedef struct sample {
    float p[3], normal[3]; /* depth camera frame */
    float weight;
} sample;

/* What is near a body. */
typedef struct finder {
    const rlf_surface *surface;
    sheet sheets[2];
    const near_planes_body *body;
    float reach;
    sample samples[SAMPLES_MAX];
    int32_t count;
    near_planes *found;
} finder;

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static float ramp(float x, float from, float to)
{
    const float share = (x - from) / (to - from);
    return share < 0.0f ? 0.0f : (share > 1.0f ? 1.0f : share);
}

/* ---- samples -------------------------------------------------------------------------------- */

/* How far the body comes from its centre towards a plane. */
static float extent(const finder *f, const float normal[3])
{
    float sum = f->body->round;
    for (int k = 0; k < 3; k++) {
        const float along = dot3(f->body->axis[k], normal);
        sum += f->body->half[k] * (along < 0.0f ? -along : along);
    }
    return sum;
}

/* 1 where a surface touches the body, 0 where it is out of reach, or turned away. */
static float weigh(const finder *f, const sample *s)
{
    const float v[3] = {f->body->center[0] - s->p[0], f->body->center[1] - s->p[1],
                        f->body->center[2] - s->p[2]};
    const float height = dot3(v, s->normal);
    const float gap = height - extent(f, s->normal);
    const float aside = dot3(v, v) - height * height;
    const float most = f->body->reach + f->reach;
    return height > 0.0f ? (1.0f - ramp(gap, 0.0f, f->reach)) *
                               (1.0f - ramp(aside, 0.25f * most * most, most * most))
                         : 0.0f;
}

static bool read_point(const finder *f, const sheet *from, int32_t i, float out[3])
{
    const float z = from->depth != NULL ? from->depth[i] : 0.0f;
    out[0] = z * f->surface->ray_x[i];
    out[1] = z * f->surface->ray_y[i];
    out[2] = z;
    return z > 0.0f;
}

/* False when p is surely out of reach. */
static bool may_be_near(const finder *f, const float p[3])
{
    const float v[3] = {f->body->center[0] - p[0], f->body->center[1] - p[1],
                        f->body->center[2] - p[2]};
    const float most = f->body->reach + f->reach;
    return dot3(v, v) < 2.0f * most * most;
}

static void add_sample(finder *f, const sheet *from, int32_t i)
{
    sample *s = &f->samples[f->count];
    if (from->normal_z == NULL || !read_point(f, from, i, s->p) || !may_be_near(f, s->p)) {
        return;
    }
    s->normal[0] = from->normal_x[i];
    s->normal[1] = from->normal_y[i];
    s->normal[2] = from->normal_z[i];
    const bool is_known = dot3(s->normal, s->normal) > 0.5f;
    s->weight = is_known ? weigh(f, s) : 0.0f;
    f->count += s->weight > 0.0f ? 1 : 0;
}

/* Index of the pixel of the ray (x, y, 1); -1 outside the image. */
static int32_t pixel_at(const finder *f, float x, float y)
{
    const rlf_camera *k = &f->surface->camera;
    const float u = (float)k->fx * x + (float)k->cx + 0.5f;
    const float v = (float)k->fy * y + (float)k->cy + 0.5f;
    const bool is_in = u >= 0.0f && u < (float)k->width && v >= 0.0f && v < (float)k->height;
    return is_in ? (int32_t)v * k->width + (int32_t)u : -1;
}

/* Pixels, and the depths of both sheets there: 0 = none. */
typedef struct taps {
    int32_t count;
    int32_t pixel[FINE * FINE];
    float z[2][FINE * FINE];
} taps;

/* All at once: none waits for the last one's to come from memory. */
static void read_taps(const finder *f, taps *t)
{
    const float *front = f->sheets[0].depth;
    const float *back = f->sheets[1].depth;
    const uint8_t *foreground = back != NULL ? f->surface->foreground : NULL;
    for (int32_t i = 0; i < t->count; i++) {
        t->z[0][i] = front[t->pixel[i]];
    }
    for (int32_t i = 0; i < t->count; i++) {
        t->z[1][i] = foreground != NULL && foreground[t->pixel[i]] != 0 ? back[t->pixel[i]] : 0.0f;
    }
}

/* False when what has that depth is surely out of reach. */
static bool may_reach(const finder *f, float z)
{
    const float step = z - f->body->center[2];
    const float most = f->body->reach + f->reach;
    return z > 0.0f && step * step < 2.0f * most * most;
}

/* Evenly over the body and what is around it. */
static void gather(finder *f)
{
    const rlf_camera *k = &f->surface->camera;
    const float per_z = 1.0f / f->body->center[2];
    const float half = (f->body->reach + AROUND * f->reach) * per_z;
    const int32_t side = (float)k->fx * half > SMALL_PX ? FINE : COARSE;
    const float step = 2.0f * half / (float)side;
    const float left = f->body->center[0] * per_z - half + 0.5f * step;
    const float top = f->body->center[1] * per_z - half + 0.5f * step;
    taps t = {.count = 0};
    for (int32_t i = 0; i < side * side; i++) {
        const float x = left + step * (float)(i % side);
        const float y = top + step * (float)(i / side);
        t.pixel[t.count] = pixel_at(f, x, y);
        t.count += t.pixel[t.count] >= 0 ? 1 : 0;
    }
    read_taps(f, &t);
    for (int32_t i = 0; i < t.count; i++) {
        for (int n = 0; n < 2; n++) {
            if (may_reach(f, t.z[n][i])) {
                add_sample(f, &f->sheets[n], t.pixel[i]);
            }
        }
    }
}

/* ---- planes --------------------------------------------------------------------------------- */

/* The nearest surface that no plane yet is like; -1 = none. */
static int32_t choose_seed(const finder *f)
{
    int32_t best = -1;
    float most = 0.0f;
    for (int32_t i = 0; i < f->count; i++) {
        const sample *s = &f->samples[i];
        float weight = s->weight;
        for (int32_t k = 0; k < f->found->count; k++) {
            weight *= 1.0f - ramp(dot3(s->normal, f->found->plane[k].normal), 0.5f, ALIKE);
        }
        if (weight > most) {
            most = weight;
            best = i;
        }
    }
    return best;
}

/* The mean of what lies in the seed's plane. */
static void fit(const finder *f, const sample *seed, near_plane *out)
{
    float sum = 0.0f;
    *out = (near_plane){.presence = 0.0f};
    for (int32_t i = 0; i < f->count; i++) {
        const sample *s = &f->samples[i];
        const float step[3] = {s->p[0] - seed->p[0], s->p[1] - seed->p[1], s->p[2] - seed->p[2]};
        const float off = dot3(step, seed->normal) / (APART * f->reach);
        const float weight = s->weight * ramp(dot3(s->normal, seed->normal), UNLIKE, ALIKE) *
                             (1.0f - ramp(off * off, 0.25f, 1.0f));
        sum += weight;
        for (int k = 0; k < 3; k++) {
            out->p[k] += weight * s->p[k];
            out->normal[k] += weight * s->normal[k];
        }
    }
    const float length = sqrtf(dot3(out->normal, out->normal));
    for (int k = 0; k < 3; k++) {
        out->p[k] /= sum;
        out->normal[k] /= length;
    }
}

/* Is the plane there at p, which lies on it? 1 or 0, and between at the edge of what is on it; < 0
 * where it cannot be seen. */
static float look_at(const finder *f, const near_plane *at, const float p[3])
{
    const float per_z = p[2] > LEAST_Z ? 1.0f / p[2] : 0.0f;
    const int32_t i = per_z > 0.0f ? pixel_at(f, p[0] * per_z, p[1] * per_z) : -1;
    for (int k = 0; k < 2 && i >= 0; k++) {
        float seen[3];
        if (read_point(f, &f->sheets[k], i, seen)) {
            const float v[3] = {seen[0] - p[0], seen[1] - p[1], seen[2] - p[2]};
            const float off = dot3(v, at->normal) / (APART * f->reach);
            if (off < 1.0f) {
                return 1.0f - ramp(off * off, 0.25f, 1.0f);
            }
        }
    }
    return -1.0f;
}

/* Share of the plane that is there where the body is above it: of what is seen of it. */
static float find_presence(const finder *f, const near_plane *at)
{
    const float *n = at->normal;
    const float v[3] = {f->body->center[0] - at->p[0], f->body->center[1] - at->p[1],
                        f->body->center[2] - at->p[2]};
    const float height = dot3(v, n);
    const rlf_vec3 up = {(double)n[0], (double)n[1], (double)n[2]};
    const rlf_vec3 across = rlf_perpendicular(up);
    const rlf_vec3 along = rlf_cross(up, across);
    const float step = FOOT_SHARE * f->body->reach;
    const float x[3] = {step * (float)across.x, step * (float)across.y, step * (float)across.z};
    const float y[3] = {step * (float)along.x, step * (float)along.y, step * (float)along.z};
    float sum = 0.0f;
    float count = 0.0f;
    for (int32_t i = 0; i < FOOT * FOOT; i++) {
        const float a = (float)(i % FOOT - 1);
        const float b = (float)(i / FOOT - 1);
        float p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = f->body->center[k] - height * n[k] + a * x[k] + b * y[k];
        }
        const float here = look_at(f, at, p);
        sum += here > 0.0f ? here : 0.0f;
        count += here >= 0.0f ? 1.0f : 0.0f;
    }
    return count > 0.0f ? ramp(sum / count, FEW, MANY) : 1.0f;
}

static void find_planes(finder *f)
{
    for (int k = 0; k < NEAR_PLANES_MOST; k++) {
        const int32_t seed = choose_seed(f);
        if (seed < 0) {
            return;
        }
        near_plane *next = &f->found->plane[f->found->count];
        fit(f, &f->samples[seed], next);
        next->presence = find_presence(f, next);
        f->found->count++;
    }
}

/* ---- all of it ------------------------------------------------------------------------------ */

void near_planes_find(const rlf_surface *s, const near_planes_body *body, near_planes *out)
{
    finder f;
    out->count = 0;
    if (s->depth == NULL || s->normal_z == NULL) {
        return;
    }
    f.surface = s;
    f.body = body;
    f.found = out;
    f.count = 0;
    f.sheets[0] = (sheet){s->depth, s->normal_x, s->normal_y, s->normal_z};
    f.sheets[1] = (sheet){s->background_depth, s->background_normal_x, s->background_normal_y,
                          s->background_normal_z};
    f.reach = out->reach =
        2.0f * ((body->half[0] + body->half[1] + body->half[2]) * (1.0f / 3.0f) + body->round);
    if (body->center[2] > LEAST_Z) {
        gather(&f);
    }
    find_planes(&f);
}
