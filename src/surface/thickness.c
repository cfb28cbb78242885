/* How thick the foreground is: the union of the largest spheres inscribed in each silhouette.
 *
 * On a lattice of every step-th pixel: the distance D to where the body ends (Euclidean distance
 * transform; a body that hides a part of another ends there, the hidden one does not), and for each
 * near-medial point c a disk of radius D(c) that stands for a sphere: at p its half thickness is
 * sqrt(D(c)^2 - |p - c|^2), times the ratio of depth to width that the front shows. Each pixel
 * takes the largest. What is flat up to noise is a thin plate. Nothing reaches into the background
 * behind it. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <math.h>

enum { LATTICE_POINTS = 12000, LATTICE_STEP_LEAST = 1 };

static const float far_off = 1e6f;
static const float body_jump_m = 0.04f; /* of depth between neighbours: one hides the other */
/* How far in front of and behind its sphere a point of an inclined body may lie. */
static const float before_sphere_m = 0.10f, behind_sphere_m = 0.15f;
static const float thinnest_m = 0.015f, thickest_m = 0.50f, plate_m = 0.02f;
static const float round_below_m = 0.08f, flat_above_m = 0.12f, flat_ratio = 0.65f;

/* The part of the image that has foreground, sampled. Its planes lie in work memory. */
typedef struct lattice {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    int32_t x0, y0, step;
    float jump; /* of depth between neighbours, at the end of a body */
    int32_t width, height;
    int32_t *label;
    float *depth;
    uint8_t *seen;   /* the sensor gave the depth */
    float *column;   /* distance within the column; later ratio per centre */
    float *radius2;  /* squared distance to the silhouette */
    float *best;     /* largest half thickness squared */
    int32_t *centre; /* of the sphere that gave it; -1 = none */
} lattice;

static bool find_bounds(lattice *l)
{
    const rlf_slot *slot = l->slot;
    int32_t x1 = 0, y1 = 0, total = 0;
    l->x0 = l->stage->grid.width;
    l->y0 = l->stage->grid.height;
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        const rlf_region *region = &slot->regions[slot->foreground_region_first + r];
        l->x0 = region->x0 < l->x0 ? region->x0 : l->x0;
        l->y0 = region->y0 < l->y0 ? region->y0 : l->y0;
        x1 = region->x1 > x1 ? region->x1 : x1;
        y1 = region->y1 > y1 ? region->y1 : y1;
        total += region->point_count;
    }
    if (total == 0) {
        return false;
    }
    l->step = LATTICE_STEP_LEAST;
    while (total / (l->step * l->step) > LATTICE_POINTS) {
        l->step++;
    }
    l->width = (x1 - l->x0 + l->step - 1) / l->step;
    l->height = (y1 - l->y0 + l->step - 1) / l->step;
    return true;
}

static void sample(lattice *l)
{
    for (int32_t y = 0; y < l->height; y++) {
        for (int32_t x = 0; x < l->width; x++) {
            int32_t k = y * l->width + x;
            ptrdiff_t i =
                (ptrdiff_t)(l->y0 + y * l->step) * l->stage->grid.width + l->x0 + x * l->step;
            bool front = l->slot->foreground[i] != 0;
            l->label[k] = front ? l->slot->label[i] : 0;
            l->depth[k] = l->slot->depth[i];
            l->seen[k] = l->slot->reason[i] == RLF_REASON_OK;
            l->best[k] = 0.0f;
            l->centre[k] = -1;
        }
    }
}

/* A lattice that ends at the image's border says nothing about the silhouette there; one that ends
 * within the image has background beyond. */
static bool is_open(const lattice *l, int32_t side)
{
    const rlf_grid *grid = &l->stage->grid;
    switch (side) {
    case 0: return l->x0 < l->step;
    case 1: return l->y0 < l->step;
    case 2: return l->x0 + l->width * l->step >= grid->width;
    default: return l->y0 + l->height * l->step >= grid->height;
    }
}

/* What a neighbour says about a point: more of the same body, its end, or another body in front of
 * it that hides where it ends. */
typedef enum beside { SAME, END, HIDDEN } beside;

static beside compare(const lattice *l, int32_t k, int32_t next)
{
    if (l->label[k] != l->label[next]) {
        return END;
    }
    float step = l->depth[next] - l->depth[k];
    return step > l->jump ? END : (step < -l->jump ? HIDDEN : SAME);
}

static float next_run(const lattice *l, int32_t k, int32_t before, float run)
{
    beside what = compare(l, k, before);
    return what == END ? 1.0f : (what == HIDDEN ? far_off : run + 1.0f);
}

/* Distance to the nearest end of the body in the column, in lattice steps. */
static void column_distances(lattice *l)
{
    for (int32_t x = 0; x < l->width; x++) {
        float run = is_open(l, 1) ? far_off : 0.0f;
        for (int32_t y = 0; y < l->height; y++) {
            int32_t k = y * l->width + x;
            run = y > 0 ? next_run(l, k, k - l->width, run) : run + 1.0f;
            l->column[k] = run;
        }
        run = is_open(l, 3) ? far_off : 0.0f;
        for (int32_t y = l->height - 1; y >= 0; y--) {
            int32_t k = y * l->width + x;
            run = y + 1 < l->height ? next_run(l, k, k + l->width, run) : run + 1.0f;
            l->column[k] = run < l->column[k] ? run : l->column[k];
        }
    }
}

/* Squared distance of one point, from the columns to one side of it. */
static float scan_row(const lattice *l, int32_t x, int32_t y, int32_t direction, float best)
{
    int32_t row = y * l->width;
    int32_t last = row + x;
    for (int32_t d = 1; (float)d * (float)d < best; d++) {
        int32_t k = x + direction * d;
        float across = (float)d * (float)d;
        if (k < 0 || k >= l->width) {
            return is_open(l, direction < 0 ? 0 : 2) ? best : across;
        }
        beside what = compare(l, last, row + k);
        if (what == END) {
            return across;
        }
        if (what == HIDDEN) {
            continue;
        }
        last = row + k;
        float sum = across + l->column[last] * l->column[last];
        best = sum < best ? sum : best;
    }
    return best;
}

static void squared_distances(lattice *l)
{
    for (int32_t y = 0; y < l->height; y++) {
        for (int32_t x = 0; x < l->width; x++) {
            int32_t k = y * l->width + x;
            l->radius2[k] = 0.0f;
            if (l->label[k] == 0) {
                continue;
            }
            float largest = (float)(l->width + l->height);
            float best = l->column[k] * l->column[k];
            best = best < largest * largest ? best : largest * largest;
            best = scan_row(l, x, y, -1, best);
            best = scan_row(l, x, y, 1, best);
            /* The nearest of many points outside lies close to the silhouette itself. */
            l->radius2[k] = best;
        }
    }
}

/* No neighbour lies much deeper inside: the point is near the medial axis. */
static bool is_near_medial(const lattice *l, int32_t x, int32_t y)
{
    int32_t k = y * l->width + x;
    float own = sqrtf(l->radius2[k]);
    for (int32_t dy = -1; dy <= 1; dy++) {
        for (int32_t dx = -1; dx <= 1; dx++) {
            int32_t nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= l->width || ny >= l->height) {
                continue;
            }
            float rise = sqrtf(l->radius2[ny * l->width + nx]) - own;
            if (rise > (dx != 0 && dy != 0 ? 0.9f : 0.65f)) {
                return false;
            }
        }
    }
    return true;
}

static void paint_sphere(lattice *l, int32_t cx, int32_t cy)
{
    int32_t c = cy * l->width + cx;
    float r2 = l->radius2[c];
    int32_t reach = (int32_t)sqrtf(r2);
    float scale = (float)l->step / (float)l->stage->grid.camera.fx * l->depth[c];
    int32_t y0 = cy - reach > 0 ? cy - reach : 0;
    int32_t y1 = cy + reach < l->height ? cy + reach : l->height - 1;
    int32_t x0 = cx - reach > 0 ? cx - reach : 0;
    int32_t x1 = cx + reach < l->width ? cx + reach : l->width - 1;
    for (int32_t y = y0; y <= y1; y++) {
        for (int32_t x = x0; x <= x1; x++) {
            int32_t k = y * l->width + x;
            float h2 = r2 - (float)((x - cx) * (x - cx) + (y - cy) * (y - cy));
            if (l->label[k] != l->label[c] || h2 <= l->best[k]) {
                continue;
            }
            float bulge = scale * (sqrtf(r2) - sqrtf(h2));
            float off = l->depth[k] - l->depth[c] - bulge;
            if (off > -before_sphere_m && off < behind_sphere_m) {
                l->best[k] = h2;
                l->centre[k] = c;
            }
        }
    }
}

static void paint_spheres(lattice *l)
{
    for (int32_t y = 0; y < l->height; y++) {
        for (int32_t x = 0; x < l->width; x++) {
            if (l->label[y * l->width + x] != 0 && is_near_medial(l, x, y)) {
                paint_sphere(l, x, y);
            }
        }
    }
}

/* Bodies are about as deep as wide up to 16 cm, and flatter above (forearm against torso). */
static float expected_ratio(float radius_m)
{
    float t = (radius_m - round_below_m) / (flat_above_m - round_below_m);
    t = t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t);
    return 1.0f + t * (flat_ratio - 1.0f);
}

/* A sphere's place, for measuring the front that it belongs to. */
typedef struct ball {
    int32_t c, x, y, reach;
    float z, scale, radius; /* metres; scale: metres per lattice step */
    float sigma;            /* of depth at z */
} ball;

static ball ball_at(const lattice *l, int32_t c)
{
    ball b = {.c = c, .x = c % l->width, .y = c / l->width, .z = l->depth[c]};
    b.scale = (float)l->step / (float)l->stage->grid.camera.fx * b.z;
    b.reach = (int32_t)sqrtf(l->radius2[c]);
    b.radius = sqrtf(l->radius2[c]) * b.scale;
    b.sigma = (float)rlf_depth_noise_sigma(&l->stage->def.rig.noise, b.z);
    return b;
}

/* Adds height and nearness of one point of the ball's front; false when it says nothing. */
static bool add_point(const lattice *l, const ball *b, int32_t dx, int32_t dy, float sum[2])
{
    int32_t x = b->x + dx, y = b->y + dy;
    if (x < 0 || x >= l->width || y < 0 || y >= l->height) {
        return false;
    }
    int32_t k = y * l->width + x;
    float off = l->depth[k] - b->z;
    bool same = l->seen[k] && l->label[k] == l->label[b->c];
    if (!same || off < -before_sphere_m || off > behind_sphere_m + b->radius) {
        return false;
    }
    sum[0] += 0.5f * b->scale * sqrtf(l->best[k]);
    sum[1] -= 0.5f * off;
    return true;
}

/* Sums over the pairs of points on opposite sides of a centre; h heights, z nearness, metres. */
typedef struct profile {
    float n, h, z, hh, hz;
    float level; /* pairs no nearer or farther than the centre, up to noise */
} profile;

static profile measure_profile(const lattice *l, const ball *b)
{
    profile p = {0};
    for (int32_t dy = 0; dy <= b->reach; dy++) {
        for (int32_t dx = dy == 0 ? 0 : -b->reach; dx <= b->reach; dx++) {
            float sum[2] = {0.0f, 0.0f};
            if (dx * dx + dy * dy > b->reach * b->reach || !add_point(l, b, dx, dy, sum) ||
                !add_point(l, b, -dx, -dy, sum)) {
                continue;
            }
            p.n += 1.0f;
            p.h += sum[0];
            p.z += sum[1];
            p.hh += sum[0] * sum[0];
            p.hz += sum[0] * sum[1];
            p.level += rlf_kernel_abs(sum[1]) < 1.5f * b->sigma ? 1.0f : 0.0f;
        }
    }
    return p;
}

/* Ratio of depth to width. A body that is the mirror image of its front shows it: its front lies
 * the deeper, the nearer to the silhouette, z = middle - ratio height. Least squares over the pairs
 * of opposite points (their means do not see how the body is inclined), drawn towards what is
 * expected. Where roundness would have been seen and was not, it is a plate: 0. */
static float measured_ratio(const lattice *l, int32_t c)
{
    const float level_share = 0.8f, trust = 0.3f;
    ball b = ball_at(l, c);
    profile p = measure_profile(l, &b);
    float expected = expected_ratio(b.radius);
    if (p.n < 6.0f) {
        return expected;
    }
    float hh = p.hh - p.h * p.h / p.n, hz = p.hz - p.h * p.z / p.n;
    bool would_show = hh * expected * expected > 2.0f * b.sigma * b.sigma * p.n;
    if (would_show && p.level > level_share * p.n) {
        return 0.0f;
    }
    float ridge = trust * p.n * b.radius * b.radius;
    float ratio = (hz + ridge * expected) / (hh + ridge);
    return ratio < 0.0f ? 0.0f : ratio;
}

static void measure_ratios(lattice *l)
{
    int32_t count = l->width * l->height;
    float *ratio = l->column;
    for (int32_t k = 0; k < count; k++) {
        ratio[k] = -1.0f;
    }
    for (int32_t k = 0; k < count; k++) {
        int32_t c = l->centre[k];
        if (c >= 0 && ratio[c] < 0.0f) {
            ratio[c] = measured_ratio(l, c);
        }
    }
}

static float sphere_thickness(const lattice *l, int32_t x, int32_t y)
{
    float fx = (float)(x - l->x0) / (float)l->step;
    float fy = (float)(y - l->y0) / (float)l->step;
    int32_t c = l->centre[(int32_t)fy * l->width + (int32_t)fx];
    if (c < 0) {
        return thinnest_m;
    }
    float dx = fx - (float)(c % l->width), dy = fy - (float)(c / l->width);
    float h2 = l->radius2[c] - dx * dx - dy * dy;
    float z = l->slot->depth[(ptrdiff_t)y * l->stage->grid.width + x];
    float scale = (float)l->step / (float)l->stage->grid.camera.fx;
    float ratio = l->column[c];
    if (ratio <= 0.0f) {
        return plate_m;
    }
    float thickness = h2 > 0.0f ? 2.0f * sqrtf(h2) * scale * ratio * z : 0.0f;
    thickness = thickness < thickest_m ? thickness : thickest_m;
    return thickness > thinnest_m ? thickness : thinnest_m;
}

static bool is_plate(const rlf_reconstruct *stage, const rlf_region *region)
{
    double sigma = rlf_depth_noise_sigma(&stage->def.rig.noise, region->centroid.z);
    return region->plane_residual >= 0.0 && region->plane_residual <= 2.0 * sigma;
}

static void write_region(const lattice *l, const rlf_region *region)
{
    const rlf_reconstruct *stage = l->stage;
    const rlf_slot *slot = l->slot;
    bool plate = is_plate(stage, region);
    for (int32_t y = region->y0; y < region->y1; y++) {
        for (int32_t x = region->x0; x < region->x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * stage->grid.width + x;
            if (slot->label[i] != region->label || !slot->foreground[i]) {
                continue;
            }
            float thickness = plate ? plate_m : sphere_thickness(l, x, y);
            float room = stage->background.mean[i] - slot->depth[i];
            bool known = stage->background.mean[i] > 0.0f;
            room = room > 0.0f ? room : 0.0f;
            slot->thickness[i] = known && thickness > room ? room : thickness;
        }
    }
}

void rlf_thickness_estimate(rlf_reconstruct *stage, rlf_slot *slot)
{
    for (int32_t i = 0; i < stage->grid.count; i++) {
        slot->thickness[i] = 0.0f;
    }
    lattice l = {.stage = stage, .slot = slot};
    if (!find_bounds(&l)) {
        return;
    }
    l.label = stage->work.map;
    l.jump = body_jump_m;
    l.centre = stage->work.component;
    l.depth = stage->work.depth[0];
    l.seen = stage->work.mask[0];
    l.column = stage->work.depth[1];
    l.radius2 = stage->work.sum[0];
    l.best = stage->work.sum[1];
    sample(&l);
    column_distances(&l);
    squared_distances(&l);
    paint_spheres(&l);
    measure_ratios(&l);
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        write_region(&l, &slot->regions[slot->foreground_region_first + r]);
    }
}
