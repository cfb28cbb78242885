/* Velocity of the front sheet from the change of depth along each ray.
 *
 * Along a fixed ray m a surface that moves with speed v along its normal changes depth by
 * dz/dt = v / (n.m), exactly for planes (range flow, Spies et al. 2002), so v = (n.m) dz/dt. Only
 * this normal component can be seen in one pixel. Neighbours on a curved body see others: v is the
 * least squares solution of n.v = (n.m) dz/dt over 9x9 pixels, and its part along the pixel's
 * normal is published. Over a whole region that moves as one rigid thing, n.(v + w x r) = (n.m)
 * dz/dt gives all six unknowns; where it explains what was seen, its full velocity is published.
 * What is not significant against the sensor's noise is exactly 0. */
#include "surface/steps.h"

#include "kernel/kernel.h"

enum {
    REACH = 4,
    STRIDE = 2,
    LEAST_SAMPLES = 6,
    PASSES = 4,
    LEAST_REGION_SAMPLES = 30,
    MOST_SAMPLES = 800
};

static const float fastest_m_per_s = 5.0f;
static const double longest_gap_s = 0.2;
static const float unknown_rest = 1e9f, rigid_rest = 2e9f;
static const float body_step_m = 0.05f; /* within a window: farther pixels are another limb */
/* Noise of neighbouring pixels is correlated by the drivers' 3x3 filters: 2 of every second pixel
 * count as one. */
static const float correlated_samples = 2.0f;
/* Squared sums of 3 and of 6 normal variables that chance exceeds once in 400 times. */
static const float significant_3 = 14.2f, significant_6 = 20.1f;
static const double prior_share = 0.01; /* ridge, of the mean diagonal */

typedef struct flow_job {
    const rlf_reconstruct *stage;
    const rlf_slot *before;
    rlf_slot *now;
    float dt;
    bool all;      /* there is no background: everything may move */
    float *speed;  /* along the normal, m/s */
    float *facing; /* n.m where the speed is known, else 0 */
    float *rest;   /* speed beyond the region's motion; unknown_rest where there is none,
                      rigid_rest where the region's motion is all */
    rlf_kernel_noise noise;
} flow_job;

/* The same region was seen in both frames, and it is one that may move. */
static inline bool is_followed(const flow_job *job, ptrdiff_t i)
{
    int32_t label = job->now->label[i];
    return label != 0 && label == job->before->label[i] && (job->now->foreground[i] || job->all);
}

/* Speed along the normal of the pixels that show the same region twice. */
static void speed_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const flow_job *job = context;
    const rlf_grid *grid = &job->stage->grid;
    const rlf_slot *now = job->now;
    ptrdiff_t last = (ptrdiff_t)end * grid->width;
    for (ptrdiff_t i = (ptrdiff_t)begin * grid->width; i < last; i++) {
        job->facing[i] = job->speed[i] = 0.0f;
        if (!is_followed(job, i)) {
            continue;
        }
        float change = now->depth[i] - job->before->depth[i];
        bool near = rlf_kernel_abs(change) <= fastest_m_per_s * job->dt;
        if (!near || (now->reason[i] | job->before->reason[i]) != RLF_REASON_OK) {
            continue;
        }
        job->facing[i] = now->normal[0][i] * grid->ray_x[i] + now->normal[1][i] * grid->ray_y[i] +
                         now->normal[2][i];
        job->speed[i] = job->facing[i] * change / job->dt;
    }
}

/* Sums of the least squares for one velocity. */
typedef struct patch {
    float xx, xy, xz, yy, yz, zz, bx, by, bz;
    float facing2, n;
} patch;

static void add_pixel(const flow_job *job, ptrdiff_t k, float speed, patch *p)
{
    float x = job->now->normal[0][k], y = job->now->normal[1][k], z = job->now->normal[2][k];
    p->xx += x * x;
    p->xy += x * y;
    p->xz += x * z;
    p->yy += y * y;
    p->yz += y * z;
    p->zz += z * z;
    p->bx += x * speed;
    p->by += y * speed;
    p->bz += z * speed;
    p->facing2 += job->facing[k] * job->facing[k];
    p->n += 1.0f;
}

/* Two sums over the pixels of the same limb: of the speeds, and of what is left of them when the
 * region's motion is taken off. */
static void gather(const flow_job *job, int32_t x, int32_t y, patch *whole, patch *rest)
{
    const rlf_grid *grid = &job->stage->grid;
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    float z = job->now->depth[i];
    int32_t label = job->now->label[i];
    *whole = *rest = (patch){0};
    for (int32_t v = y - REACH; v <= y + REACH; v += STRIDE) {
        for (int32_t u = x - REACH; u <= x + REACH; u += STRIDE) {
            if (v < 0 || v >= grid->height || u < 0 || u >= grid->width) {
                continue;
            }
            ptrdiff_t k = (ptrdiff_t)v * grid->width + u;
            if (job->now->label[k] != label ||
                rlf_kernel_abs(job->now->depth[k] - z) >= body_step_m) {
                continue;
            }
            if (job->facing[k] != 0.0f) {
                add_pixel(job, k, job->speed[k], whole);
            }
            if (job->rest[k] < unknown_rest) {
                add_pixel(job, k, job->rest[k], rest);
            }
        }
    }
}

/* (A + ridge) v = b by Cramer's rule. Returns the part of the squared speeds that v explains. */
static float solve_patch(const patch *p, float v[3])
{
    float ridge = (float)prior_share * p->n;
    float xx = p->xx + ridge, yy = p->yy + ridge, zz = p->zz + ridge;
    float cxx = yy * zz - p->yz * p->yz, cxy = p->xz * p->yz - p->xy * zz;
    float cxz = p->xy * p->yz - p->xz * yy, cyy = xx * zz - p->xz * p->xz;
    float cyz = p->xy * p->xz - xx * p->yz, czz = xx * yy - p->xy * p->xy;
    float inverse = 1.0f / (xx * cxx + p->xy * cxy + p->xz * cxz);
    v[0] = (cxx * p->bx + cxy * p->by + cxz * p->bz) * inverse;
    v[1] = (cxy * p->bx + cyy * p->by + cyz * p->bz) * inverse;
    v[2] = (cxz * p->bx + cyz * p->by + czz * p->bz) * inverse;
    return v[0] * p->bx + v[1] * p->by + v[2] * p->bz;
}

/* All of v, or only what was seen of it: its part along the normal. */
static void write_velocity(const flow_job *job, ptrdiff_t i, const float v[3], bool all)
{
    float *const *normal = job->now->normal;
    float along = normal[0][i] * v[0] + normal[1][i] * v[1] + normal[2][i] * v[2];
    float out[3];
    for (int k = 0; k < 3; k++) {
        out[k] = all ? v[k] : normal[k][i] * along;
    }
    float speed = sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    float scale = speed > fastest_m_per_s ? fastest_m_per_s / speed : 1.0f;
    for (int k = 0; k < 3; k++) {
        job->now->velocity[k][i] = scale * out[k];
    }
}

/* On entry the velocity planes hold the region's motion. */
static bool pixel_velocity(const flow_job *job, int32_t x, int32_t y, float v[3])
{
    ptrdiff_t i = (ptrdiff_t)y * job->stage->grid.width + x;
    const float region[3] = {job->now->velocity[0][i], job->now->velocity[1][i],
                             job->now->velocity[2][i]};
    bool moves = region[0] != 0.0f || region[1] != 0.0f || region[2] != 0.0f;
    patch whole, rest;
    gather(job, x, y, &whole, &rest);
    v[0] = v[1] = v[2] = 0.0f;
    bool is_seen = whole.n >= (float)LEAST_SAMPLES;
    if (is_seen) {
        float sigma = rlf_kernel_sigma(job->noise, job->now->depth[i]) / job->dt;
        float variance = 2.0f * sigma * sigma * correlated_samples * whole.facing2 / whole.n;
        if (solve_patch(&whole, v) <= significant_3 * variance) {
            v[0] = v[1] = v[2] = 0.0f;
            return false;
        }
    }
    bool whole_known = moves && (rest.n >= (float)LEAST_SAMPLES || !is_seen);
    if (whole_known) {
        float more[3] = {0.0f, 0.0f, 0.0f};
        if (rest.n >= (float)LEAST_SAMPLES) {
            solve_patch(&rest, more);
        }
        for (int k = 0; k < 3; k++) {
            v[k] = region[k] + more[k];
        }
    }
    return whole_known;
}

static void patch_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const flow_job *job = context;
    const rlf_grid *grid = &job->stage->grid;
    for (int32_t y = begin; y < end; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            float v[3] = {0.0f, 0.0f, 0.0f};
            if (job->rest[i] == rigid_rest) {
                continue;
            }
            bool all = is_followed(job, i) && pixel_velocity(job, x, y, v);
            write_velocity(job, i, v, all);
        }
    }
}

static void clear_velocity(const rlf_grid *grid, rlf_slot *slot)
{
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < grid->count; i++) {
            slot->velocity[k][i] = 0.0f;
        }
    }
}

/* A rigid motion about a centre; w in units of 1 / length, so that all six unknowns are speeds. */
typedef struct twist {
    rlf_vec3 centre;
    double length;
    double x[6];
    double explained, noise; /* squared speeds */
    int32_t stride;          /* every stride-th pixel of every stride-th row is looked at */
    int32_t samples, inliers;
} twist;

static rlf_vec3 point_at(const rlf_grid *grid, const float *depth, ptrdiff_t i)
{
    double z = depth[i];
    return rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
}

static rlf_vec3 normal_at(const rlf_slot *slot, ptrdiff_t i)
{
    return rlf_vec3_make(slot->normal[0][i], slot->normal[1][i], slot->normal[2][i]);
}

static rlf_vec3 twist_velocity(const twist *t, rlf_vec3 p)
{
    rlf_vec3 w = rlf_scale(rlf_vec3_make(t->x[3], t->x[4], t->x[5]), 1.0 / t->length);
    return rlf_add(rlf_vec3_make(t->x[0], t->x[1], t->x[2]), rlf_cross(w, rlf_sub(p, t->centre)));
}

/* Speed along the normal beyond v, from where v says that the point was; false when the region was
 * not seen there. */
static bool speed_beyond(const flow_job *job, ptrdiff_t i, rlf_vec3 v, double *out)
{
    const rlf_grid *grid = &job->stage->grid;
    rlf_vec3 n = normal_at(job->now, i);
    if (job->now->reason[i] != RLF_REASON_OK || (n.x == 0.0 && n.y == 0.0 && n.z == 0.0)) {
        return false;
    }
    rlf_vec3 q = rlf_mad(point_at(grid, job->now->depth, i), v, -(double)job->dt);
    double u, w;
    if (!rlf_camera_project(&grid->camera, q, &u, &w) || !(u > -0.5) || !(w > -0.5) ||
        !(u < grid->width - 0.5) || !(w < grid->height - 0.5)) {
        return false;
    }
    ptrdiff_t k = (ptrdiff_t)(int32_t)(w + 0.5) * grid->width + (int32_t)(u + 0.5);
    if (job->before->label[k] != job->now->label[i] || job->before->reason[k] != RLF_REASON_OK) {
        return false;
    }
    rlf_vec3 step = rlf_sub(q, point_at(grid, job->before->depth, k));
    *out = rlf_dot(n, step) / (double)job->dt;
    return rlf_dot(step, step) < 4.0 * (double)(body_step_m * body_step_m);
}

static void twist_row(const twist *t, rlf_vec3 p, rlf_vec3 n, double row[6])
{
    rlf_vec3 turn = rlf_cross(rlf_sub(p, t->centre), n);
    row[0] = n.x;
    row[1] = n.y;
    row[2] = n.z;
    row[3] = turn.x / t->length;
    row[4] = turn.y / t->length;
    row[5] = turn.z / t->length;
}

/* Symmetric positive definite: Cholesky's L L^T, in place. */
static void solve_six(double a[6][6], const double b[6], double x[6])
{
    for (int i = 0; i < 6; i++) {
        double sum = b[i];
        for (int j = 0; j <= i; j++) {
            double s = a[i][j];
            for (int k = 0; k < j; k++) {
                s -= a[i][k] * a[j][k];
            }
            a[i][j] = i == j ? sqrt(rlf_max(s, 1e-12)) : s / a[j][j];
        }
        for (int k = 0; k < i; k++) {
            sum -= a[i][k] * x[k];
        }
        x[i] = sum / a[i][i];
    }
    for (int i = 5; i >= 0; i--) {
        for (int k = i + 1; k < 6; k++) {
            x[i] -= a[k][i] * x[k];
        }
        x[i] /= a[i][i];
    }
}

/* What the sensor's noise makes of a speed, and the normal's error: 5 % of the motion. */
static double tolerated(const flow_job *job, ptrdiff_t i, double facing, double speed)
{
    double sigma = rlf_kernel_sigma(job->noise, job->now->depth[i]) / job->dt;
    return 3.0 * 1.41421356 * sigma * facing + 0.05 * speed;
}

/* One step of Gauss and Newton over the pixels that agree with the motion so far; `slack` widens
 * what agrees while it is still far off. */
static void fit_pass(const flow_job *job, const rlf_region *region, double slack, twist *t)
{
    double a[6][6] = {{0.0}}, b[6] = {0.0}, row[6], x[6];
    const rlf_grid *grid = &job->stage->grid;
    double speed = sqrt(t->x[0] * t->x[0] + t->x[1] * t->x[1] + t->x[2] * t->x[2]);
    t->samples = t->inliers = 0;
    t->noise = t->explained = 0.0;
    for (int32_t v = region->y0; v < region->y1; v += t->stride) {
        for (int32_t u = region->x0; u < region->x1; u += t->stride) {
            ptrdiff_t i = (ptrdiff_t)v * grid->width + u;
            if (job->now->label[i] != region->label || job->now->reason[i] != RLF_REASON_OK) {
                continue;
            }
            t->samples++;
            rlf_vec3 p = point_at(grid, job->now->depth, i), n = normal_at(job->now, i);
            double facing = -rlf_dot(n, p) / p.z, off;
            rlf_vec3 motion = twist_velocity(t, p);
            if (!speed_beyond(job, i, motion, &off)) {
                continue;
            }
            double bound = slack + tolerated(job, i, facing, speed);
            if (off > bound || off < -bound) {
                continue;
            }
            t->inliers++;
            double sigma = rlf_kernel_sigma(job->noise, job->now->depth[i]) / job->dt;
            double along = rlf_dot(n, motion);
            t->noise += 2.0 * sigma * sigma * facing * facing;
            t->explained += along * along;
            twist_row(t, p, n, row);
            for (int r = 0; r < 6; r++) {
                b[r] += row[r] * off;
                for (int c = 0; c <= r; c++) {
                    a[r][c] += row[r] * row[c];
                }
            }
        }
    }
    for (int k = 0; k < 6; k++) {
        a[k][k] += prior_share * (t->inliers + 1);
    }
    solve_six(a, b, x);
    for (int k = 0; k < 6; k++) {
        t->x[k] += x[k];
    }
}

static twist fit_from(const flow_job *job, const rlf_region *region, rlf_vec3 velocity)
{
    const double slack[PASSES] = {1.0, 0.3, 0.1, 0.0};
    rlf_vec3 size = rlf_sub(region->box.max, region->box.min);
    twist t = {.centre = region->centroid, .x = {velocity.x, velocity.y, velocity.z}};
    t.length = rlf_max(0.25 * rlf_length(size), 0.01);
    t.stride = STRIDE;
    while (region->point_count > MOST_SAMPLES * t.stride * t.stride) {
        t.stride++;
    }
    for (int pass = 0; pass < PASSES; pass++) {
        fit_pass(job, region, slack[pass], &t);
    }
    return t;
}

/* More than chance, and more than half of one pixel's noise: small errors that pixels share, from
 * limbs that move by themselves, do not average out. */
static bool is_significant(const twist *t)
{
    const double least = 0.25;
    return t->inliers >= LEAST_REGION_SAMPLES && t->explained > least * t->noise &&
           t->explained > significant_6 * t->noise / t->inliers * correlated_samples;
}

/* Takes the region's motion as what its pixels start from. */
static void spread_motion(const flow_job *job, const rlf_region *region, const twist *t, bool rigid)
{
    const rlf_grid *grid = &job->stage->grid;
    for (int32_t y = region->y0; y < region->y1; y++) {
        for (int32_t x = region->x0; x < region->x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            if (job->now->label[i] != region->label) {
                continue;
            }
            rlf_vec3 v = twist_velocity(t, point_at(grid, job->now->depth, i));
            double off, fast = rlf_length(v) / (double)fastest_m_per_s;
            v = fast > 1.0 ? rlf_scale(v, 1.0 / fast) : v;
            job->rest[i] = rigid ? rigid_rest : unknown_rest;
            if (!rigid && speed_beyond(job, i, v, &off)) {
                job->rest[i] = (float)off;
            }
            job->now->velocity[0][i] = (float)v.x;
            job->now->velocity[1][i] = (float)v.y;
            job->now->velocity[2][i] = (float)v.z;
        }
    }
}

/* The centroid moves when pieces join or leave a region, too: then its step says nothing. */
static bool is_same_shape(const rlf_region *a, const rlf_region *b)
{
    return 5 * a->point_count >= 4 * b->point_count && 5 * b->point_count >= 4 * a->point_count;
}

/* Velocity of the visible part's centroid. A silhouette that flickers moves the centroid a little,
 * so small steps do not count. */
static rlf_vec3 centroid_velocity(const flow_job *job, const rlf_region *region)
{
    const double least_step_m = 0.005;
    const rlf_slot *before = job->before;
    for (int32_t k = 0; k < before->foreground_region_count; k++) {
        const rlf_region *old = &before->regions[before->foreground_region_first + k];
        rlf_vec3 step = rlf_sub(region->centroid, old->centroid);
        bool same = old->label == region->label && is_same_shape(old, region);
        if (same && rlf_length(step) > least_step_m) {
            return rlf_scale(step, 1.0 / (double)job->dt);
        }
    }
    return rlf_vec3_make(0, 0, 0);
}

/* Tried from rest and from the centroid's motion; what more pixels agree with is right. Where four
 * of five do, the region is rigid. */
static void region_motion(const flow_job *job, rlf_region *region)
{
    rlf_vec3 seen = centroid_velocity(job, region);
    twist t = fit_from(job, region, rlf_vec3_make(0, 0, 0));
    if (rlf_length(seen) > 0.0) {
        twist other = fit_from(job, region, seen);
        t = other.inliers > t.inliers ? other : t;
    }
    if (!is_significant(&t) || 3 * t.inliers < t.samples) {
        region->linear_velocity = seen;
        return;
    }
    region->linear_velocity = rlf_vec3_make(t.x[0], t.x[1], t.x[2]);
    region->angular_velocity = rlf_scale(rlf_vec3_make(t.x[3], t.x[4], t.x[5]), 1.0 / t.length);
    spread_motion(job, region, &t, 5 * t.inliers >= 4 * t.samples);
}

void rlf_velocity_estimate(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_slot *before = stage->previous;
    double dt =
        before == NULL ? 0.0 : 1e-9 * (double)(slot->surface.time_ns - before->surface.time_ns);
    if (!(dt > 0.0) || dt > longest_gap_s || slot->foreground_region_count == 0) {
        clear_velocity(&stage->grid, slot);
        return;
    }
    flow_job job = {.stage = stage,
                    .before = before,
                    .now = slot,
                    .dt = (float)dt,
                    .all = stage->def.background_method == RLF_BACKGROUND_OFF,
                    .speed = stage->work.sum[0],
                    .facing = stage->work.sum[1],
                    .rest = stage->work.depth[0],
                    .noise = rlf_kernel_noise_make(&stage->def.rig.noise)};
    clear_velocity(&stage->grid, slot);
    for (int32_t i = 0; i < stage->grid.count; i++) {
        job.rest[i] = unknown_rest;
    }
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, speed_rows, &job);
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        region_motion(&job, &slot->regions[slot->foreground_region_first + r]);
    }
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, patch_rows, &job);
}
