/* Support planes by region growing over patches (Poppinga et al. 2008): from the flattest patch to
 * those beside it, as far as the sensor's noise explains what is off the plane. */
#include "surface/objects/objects.h"

#include <math.h>

static const double FLAT_SIGMAS = 1.0;   /* RMS of a patch about its own plane */
static const double GROW_SIGMAS = 2.0;   /* of a patch's middle, off the plane */
static const double LEAST_COSINE = 0.94; /* 20 degrees, between a patch and the plane */
/* Sensors bend planes: a patch may be further off that goes on from the one beside it. */
static const double BENT_SIGMAS = 8.0, STEP_SIGMAS = 1.0, BENT_COSINE = 0.985;
static const double LEAST_SIDE_M = 0.45; /* a support plane shows at least a square of that */
static const double STAYS_M = 0.4;       /* and one that was known of that */
enum { REFITS = 3, MOST_TRIES = 48 };

void rlf_plane_sum_add(rlf_plane_sum *sum, const rlf_plane_sum *other)
{
    sum->count += other->count;
    sum->x += other->x;
    sum->y += other->y;
    sum->w += other->w;
    sum->xx += other->xx;
    sum->xy += other->xy;
    sum->yy += other->yy;
    sum->xw += other->xw;
    sum->yw += other->yw;
    sum->ww += other->ww;
}

bool rlf_plane_sum_fit(const rlf_plane_sum *sum, rlf_support_plane *out)
{
    double inv = sum->count > 0.0 ? 1.0 / sum->count : 0.0;
    double x = sum->x * inv, y = sum->y * inv, w = sum->w * inv;
    double xx = sum->xx * inv - x * x, xy = sum->xy * inv - x * y, yy = sum->yy * inv - y * y;
    double xw = sum->xw * inv - x * w, yw = sum->yw * inv - y * w, ww = sum->ww * inv - w * w;
    double determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-6 * (xx + yy) * (xx + yy))) {
        return false;
    }
    out->a = (xw * yy - yw * xy) / determinant;
    out->b = (yw * xx - xw * xy) / determinant;
    out->c = w - out->a * x - out->b * y;
    out->variance = rlf_max(ww - out->a * xw - out->b * yw, 0.0);
    return true;
}

double rlf_support_cosine(const rlf_support_plane *p, const rlf_support_plane *q)
{
    double pp = p->a * p->a + p->b * p->b + p->c * p->c;
    double qq = q->a * q->a + q->b * q->b + q->c * q->c;
    double pq = p->a * q->a + p->b * q->b + p->c * q->c;
    return pp > 0.0 && qq > 0.0 ? pq / sqrt(pp * qq) : 0.0;
}

/* Of every `stride`-th pixel both ways; *asked is how many these are. */
static rlf_plane_sum sum_patch(const image_grid *grid, const float *depth, rlf_rect r,
                               int32_t stride, int32_t *asked)
{
    rlf_plane_sum sum = {0};
    *asked = 0;
    for (int32_t y = r.y0; y < r.y1; y += stride) {
        for (int32_t x = r.x0; x < r.x1; x += stride, ++*asked) {
            int32_t i = y * grid->width + x;
            if (depth[i] > 0.0f) {
                double rx = grid->ray_x[i], ry = grid->ray_y[i], w = 1.0 / (double)depth[i];
                const rlf_plane_sum one = {1.0,     rx,      ry,     w,      rx * rx,
                                           rx * ry, ry * ry, rx * w, ry * w, w * w};
                rlf_plane_sum_add(&sum, &one);
            }
        }
    }
    return sum;
}

static void fit_patch(rlf_reconstruct *stage, const float *depth, int32_t k)
{
    const rlf_objects *o = stage->objects;
    const image_grid *grid = &stage->grid;
    rlf_patch *p = &o->patch[k];
    int32_t x = k % o->width * o->side, y = k / o->width * o->side, asked = 0;
    const rlf_rect r = {x, y, x + o->side < grid->width ? x + o->side : grid->width,
                        y + o->side < grid->height ? y + o->side : grid->height};
    *p = (rlf_patch){.sum = sum_patch(grid, depth, r, o->stride, &asked), .was = p->plane_id};
    p->is_used = true;
    if (2.0 * p->sum.count >= asked && rlf_plane_sum_fit(&p->sum, &p->plane)) {
        double z = p->sum.count / p->sum.w;
        p->sigma = rlf_depth_noise_sigma(&stage->def.rig.noise, z) / (z * z);
        p->is_flat = p->plane.variance <= FLAT_SIGMAS * FLAT_SIGMAS * p->sigma * p->sigma;
        p->is_used = !p->is_flat;
    }
}

typedef struct fit_job {
    rlf_reconstruct *stage;
    const float *depth;
} fit_job;

static void fit_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const fit_job *job = context;
    int32_t width = job->stage->objects->width;
    for (int32_t k = begin * width; k < end * width; k++) {
        fit_patch(job->stage, job->depth, k);
    }
}

/* The flattest patch that is not used yet; -1 = none. */
static int32_t find_seed(const rlf_objects *o)
{
    int32_t best = -1;
    double least = INFINITY;
    for (int32_t k = 0; k < o->width * o->height; k++) {
        const rlf_patch *p = &o->patch[k];
        double excess = p->is_used ? INFINITY : p->plane.variance / (p->sigma * p->sigma);
        best = excess < least ? k : best;
        least = rlf_min(excess, least);
    }
    return best;
}

static double off_plane(const rlf_patch *p, const rlf_support_plane *plane)
{
    double inv = 1.0 / p->sum.count;
    return p->sum.w * inv - plane->a * p->sum.x * inv - plane->b * p->sum.y * inv - plane->c;
}

/* Whether a patch is on a plane, or goes on from one that is `beside` off it. */
static bool is_on(const rlf_patch *p, const rlf_support_plane *plane, double beside)
{
    double off = off_plane(p, plane), inv = 1.0 / p->sigma;
    double cosine = rlf_support_cosine(&p->plane, plane);
    double sigmas = inv * off, step = inv * (off - beside);
    bool is_near = sigmas * sigmas <= GROW_SIGMAS * GROW_SIGMAS && cosine >= LEAST_COSINE;
    bool is_bent = sigmas * sigmas <= BENT_SIGMAS * BENT_SIGMAS &&
                   step * step <= STEP_SIGMAS * STEP_SIGMAS && cosine >= BENT_COSINE;
    return is_near || is_bent;
}

/* Grows a plane from the first `count` patches in the queue, which it has already; `refit`: it
 * follows what it has grown to. Returns how many it has then. */
static int32_t grow(rlf_objects *o, int32_t count, int32_t id, bool refit, rlf_support_plane *plane)
{
    int32_t next_fit = 4;
    rlf_plane_sum sum = {0};
    for (int32_t at = 0; at < count; at++) {
        int32_t k = o->queue[at], x = k % o->width, y = k / o->width;
        rlf_plane_sum_add(&sum, &o->patch[k].sum);
        if (refit && at + 1 == next_fit) {
            rlf_plane_sum_fit(&sum, plane);
            next_fit *= 2;
        }
        o->patch[k].off = off_plane(&o->patch[k], plane);
        const int32_t next[4] = {x > 0 ? k - 1 : -1, x + 1 < o->width ? k + 1 : -1,
                                 y > 0 ? k - o->width : -1, y + 1 < o->height ? k + o->width : -1};
        for (int n = 0; n < 4; n++) {
            rlf_patch *p = next[n] >= 0 ? &o->patch[next[n]] : NULL;
            if (p != NULL && !p->is_used && p->plane_id == 0 && is_on(p, plane, o->patch[k].off)) {
                p->plane_id = id;
                o->queue[count++] = next[n];
            }
        }
    }
    rlf_plane_sum_fit(&sum, plane);
    return count;
}

/* Takes the plane's id from patches of the queue, but for those that are on the plane: these begin
 * the queue of the next growth. Returns their number. */
static int32_t prune(rlf_objects *o, int32_t count, const rlf_support_plane *plane)
{
    int32_t kept = 0;
    for (int32_t at = 0; at < count; at++) {
        rlf_patch *p = &o->patch[o->queue[at]];
        if (is_on(p, plane, INFINITY)) {
            o->queue[kept++] = o->queue[at];
        } else {
            p->plane_id = 0;
        }
    }
    return kept;
}

/* Of what is seen of it, square metres. */
static double area_of(const rlf_reconstruct *stage, const rlf_objects *o, int32_t count,
                      const rlf_support_plane *plane)
{
    double size = sqrt(plane->a * plane->a + plane->b * plane->b + plane->c * plane->c);
    double area = 0.0;
    for (int32_t at = 0; at < count; at++) {
        const rlf_plane_sum *s = &o->patch[o->queue[at]].sum;
        double z = s->count / s->w;
        /* n . ray = distance / z, and 1 / size is the plane's distance. */
        area += s->count * z * z * z * size;
    }
    double pixels = (double)o->stride * o->stride; /* that each sample stands for */
    return pixels * area / (stage->grid.camera.fx * stage->grid.camera.fy);
}

/* Grows plane `id` until it stays as it is; it is kept when it shows `least_m` squared. */
static bool settle(rlf_reconstruct *stage, int32_t id, int32_t count, double least_m)
{
    rlf_objects *o = stage->objects;
    rlf_support_plane *plane = &o->plane[id - 1];
    for (int k = 0; k < REFITS; k++) {
        count = prune(o, count, plane);
        count = grow(o, count, id, false, plane);
    }
    bool is_support = area_of(stage, o, count, plane) >= least_m * least_m;
    for (int32_t at = 0; at < count; at++) {
        rlf_patch *p = &o->patch[o->queue[at]];
        p->is_used = true;
        p->plane_id = is_support ? id : 0;
    }
    return is_support;
}

/* The planes of the image before, as far as they are seen still. */
static void follow(rlf_reconstruct *stage)
{
    rlf_objects *o = stage->objects;
    for (int32_t id = 1; id <= o->count; id++) {
        int32_t count = 0;
        for (int32_t k = 0; k < o->width * o->height; k++) {
            if (o->patch[k].was == id && !o->patch[k].is_used) {
                o->patch[k].plane_id = id;
                o->queue[count++] = k;
            }
        }
        o->is_seen[id - 1] = count > 0 && settle(stage, id, count, STAYS_M);
        if (!o->is_seen[id - 1]) {
            for (int32_t k = 0; k < o->width * o->height; k++) {
                o->patch[k].is_used = !o->patch[k].is_flat || o->patch[k].plane_id > 0;
            }
        }
    }
}

/* The first id that no plane has; 0 = none. */
static int32_t free_id(const rlf_objects *o)
{
    for (int32_t k = 0; k < o->count; k++) {
        if (!o->is_seen[k]) {
            return k + 1;
        }
    }
    return o->count < RLF_SUPPORTS ? o->count + 1 : 0;
}

void rlf_supports_find(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    rlf_objects *o = stage->objects;
    fit_job job = {stage, in->depth};
    rlf_parallel_for(stage->def.pool, o->height, RLF_PATCH_GRAIN, fit_rows, &job);
    follow(stage);
    int32_t seed = find_seed(o), id = free_id(o);
    for (int32_t tries = 0; seed >= 0 && id > 0 && tries < MOST_TRIES; tries++) {
        o->plane[id - 1] = o->patch[seed].plane;
        o->patch[seed].plane_id = id;
        o->queue[0] = seed;
        int32_t count = grow(o, 1, id, true, &o->plane[id - 1]);
        if (settle(stage, id, count, LEAST_SIDE_M)) {
            o->is_seen[id - 1] = true;
            o->count = id > o->count ? id : o->count;
            id = free_id(o);
        }
        o->patch[seed].is_used = true;
        seed = find_seed(o);
    }
}
