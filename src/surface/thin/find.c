/* Flat patches of the foreground with an outline of their own: the face of a book in a hand.
 *
 * A patch grows over the pixels that a plane explains, refitted as it grows. What is round, a chest
 * or a limb, has flat patches too, but they end where it bends, not where depth steps; so most of
 * a slab's outline is a step, and on one side at most it ends at a narrow face beside it. */
#include "surface/thin/slab.h"

#include "math/eigen.h"

#include <string.h>

enum {
    SEED_PX = 4, /* seeds are so far apart */
    FRAMES = 4,  /* each row of them is looked at in one of so many */
    STEP_PX = 2, /* patches are grown over every second pixel of every second row */
    LEAST = 24,  /* pixels of a patch, of those */
    MOST = SLAB_PATCH,
    MOST_LOOKED_AT = 2048, /* of a frame; the next one begins where that was reached */
    A_PATCH = 64,          /* its planes cost as much as so many pixels */
    FIRST_FIT = 12,
    TURNS = 15,
    EDGE_PX = 3,     /* a step so near the patch is its own */
    ARM_PX = EDGE_PX /* and normals so far from a seed are */
};

static const double like_seed = 0.99; /* cosine */
static const double like_plane = 0.978;
static const double flat_m = 0.006, flat_rms_m = 0.0035;
static const double side_m = 0.045; /* a thin side is narrower */
static const double least_area_m2 = 0.015, least_full = 0.7;
static const double least_facing = 0.2; /* sine of the angle between the face and the ray */
static const double least_steps = 0.4, least_ends = 0.8;
static const double first_half_m = 0.01; /* half a slab's thickness, before it is seen */

/* To the neighbours. */
static const int32_t way[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};

/* A patch of one region. */
typedef struct patch {
    const image_grid *grid;
    const rlf_slot *slot;
    int32_t label, count, fitted;
    int32_t *pixel;
    rlf_vec3 centre, normal;
    double sum[3], square[3][3]; /* of points */
    double rms;
} patch;

static bool is_seed(const image_grid *grid, const rlf_slot *slot, int32_t label, int32_t x,
                    int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    if (x < ARM_PX || y < ARM_PX || x + ARM_PX >= grid->width || y + ARM_PX >= grid->height ||
        slot->label[i] != label || slot->reason[i] != RLF_REASON_OK) {
        return false;
    }
    rlf_vec3 n = image_grid_vector(slot->normal, i);
    for (int k = 0; k < 4; k++) {
        ptrdiff_t o = i + ARM_PX * (way[k][0] + (ptrdiff_t)way[k][1] * grid->width);
        if (slot->label[o] != label || rlf_dot(n, image_grid_vector(slot->normal, o)) < like_seed) {
            return false;
        }
    }
    return true;
}

static void add(patch *p, ptrdiff_t i)
{
    rlf_vec3 q = image_grid_point(p->grid, p->slot->depth, i);
    const double at[3] = {q.x, q.y, q.z};
    p->pixel[p->count++] = (int32_t)i;
    for (int r = 0; r < 3; r++) {
        p->sum[r] += at[r];
        for (int c = 0; c < 3; c++) {
            p->square[r][c] += at[r] * at[c];
        }
    }
}

/* Least squares plane of the pixels so far. */
static void fit(patch *p)
{
    double a[6][6] = {{0.0}}, values[6], vectors[6][6];
    double n = p->count;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            a[r][c] = p->square[r][c] / n - p->sum[r] / n * (p->sum[c] / n);
        }
    }
    math_eigen(a, 3, values, vectors);
    int k = values[0] < values[1] ? 0 : 1;
    k = values[2] < values[k] ? 2 : k;
    p->rms = sqrt(rlf_max(values[k], 0.0));
    p->centre = rlf_vec3_make(p->sum[0] / n, p->sum[1] / n, p->sum[2] / n);
    p->normal = rlf_vec3_make(vectors[0][k], vectors[1][k], vectors[2][k]);
    if (rlf_dot(p->normal, p->centre) > 0.0) {
        p->normal = rlf_neg(p->normal);
    }
    p->fitted = p->count;
}

/* What was filled has the normal of what was seen beside it. */
static bool is_on_plane(const patch *p, ptrdiff_t i)
{
    double off =
        rlf_dot(p->normal, rlf_sub(image_grid_point(p->grid, p->slot->depth, i), p->centre));
    bool is_like = p->slot->reason[i] != RLF_REASON_OK ||
                   rlf_dot(p->normal, image_grid_vector(p->slot->normal, i)) > like_plane;
    return off < flat_m && off > -flat_m && is_like;
}

static void grow(patch *p, uint8_t *visited, int32_t x, int32_t y)
{
    const image_grid *grid = p->grid;
    ptrdiff_t seed = (ptrdiff_t)y * grid->width + x;
    p->centre = image_grid_point(p->grid, p->slot->depth, seed);
    p->normal = image_grid_vector(p->slot->normal, seed);
    visited[seed] = 1;
    add(p, seed);
    for (int32_t next = 0; next < p->count && p->count + 4 <= MOST; next++) {
        int32_t i = p->pixel[next], u = i % grid->width, v = i / grid->width;
        for (int k = 0; k < 4; k++) {
            int32_t a = u + STEP_PX * way[k][0], b = v + STEP_PX * way[k][1];
            ptrdiff_t o = (ptrdiff_t)b * grid->width + a;
            if (a >= 0 && b >= 0 && a < grid->width && b < grid->height && visited[o] == 0 &&
                p->slot->label[o] == p->label && is_on_plane(p, o)) {
                visited[o] = 1;
                add(p, o);
            }
        }
        if (p->count >= FIRST_FIT && p->count >= 2 * p->fitted) {
            fit(p);
        }
    }
    if (p->count >= LEAST) {
        fit(p);
    }
}

static double depth_of_plane(const patch *p, ptrdiff_t i)
{
    const image_grid *grid = p->grid;
    double along = p->normal.x * grid->ray_x[i] + p->normal.y * grid->ray_y[i] + p->normal.z;
    return rlf_dot(p->normal, p->centre) / along;
}

/* How the patch ends from the pixel on along (dx, dy): at a step, behind a narrow side, or not. */
static void look_out(const patch *p, int32_t i, int32_t dx, int32_t dy, int32_t *steps,
                     int32_t *sides)
{
    const image_grid *grid = p->grid;
    int32_t x = i % grid->width, y = i / grid->width;
    double before = p->slot->depth[i], plane_before = depth_of_plane(p, i);
    int32_t reach = EDGE_PX + (int32_t)(side_m * grid->camera.fx / before);
    for (int32_t k = 1; k <= reach; k++) {
        int32_t u = x + k * dx, v = y + k * dy;
        if (u < 0 || v < 0 || u >= grid->width || v >= grid->height) {
            return;
        }
        ptrdiff_t o = (ptrdiff_t)v * grid->width + u;
        double seen = p->slot->depth[o], plane = depth_of_plane(p, o);
        double farther = seen - before - rlf_max(plane - plane_before, 0.0);
        if (p->slot->foreground[o] == 0 || farther > THIN_NEAR_M) {
            *steps += k <= EDGE_PX;
            *sides += k > EDGE_PX;
            return;
        }
        if (seen < before - THIN_NEAR_M) {
            return;
        }
        before = seen;
        plane_before = plane;
    }
}

static bool has_outline(const patch *p, const uint8_t *mine)
{
    const image_grid *grid = p->grid;
    int32_t ends = 0, steps = 0, sides = 0;
    for (int32_t n = 0; n < p->count; n++) {
        int32_t i = p->pixel[n], x = i % grid->width, y = i / grid->width;
        for (int k = 0; k < 4; k++) {
            int32_t u = x + STEP_PX * way[k][0], v = y + STEP_PX * way[k][1];
            bool is_inside = u >= 0 && v >= 0 && u < grid->width && v < grid->height;
            if (!is_inside || mine[(ptrdiff_t)v * grid->width + u] != 2) {
                ends++;
                look_out(p, i, way[k][0], way[k][1], &steps, &sides);
            }
        }
    }
    return steps >= least_steps * ends && steps + sides >= least_ends * ends;
}

typedef struct rectangle {
    rlf_vec3 axis[2];
    double low[2], high[2];
} rectangle;

static double area_of(const rectangle *r)
{
    return (r->high[0] - r->low[0]) * (r->high[1] - r->low[1]);
}

/* The smallest about the patch, of some. */
static rectangle surround(const patch *p)
{
    rlf_vec3 u = rlf_normalize(rlf_cross(rlf_vec3_make(0, 1, 0), p->normal));
    rlf_vec3 v = rlf_cross(p->normal, u);
    rectangle best = {.high = {1e9, 1e9}};
    for (int32_t turn = 0; turn < TURNS; turn++) {
        double angle = 0.5 * RLF_PI * turn / TURNS, c = rlf_cos(angle), s = rlf_sin(angle);
        rectangle r = {.low = {1e9, 1e9}, .high = {-1e9, -1e9}};
        r.axis[0] = rlf_add(rlf_scale(u, c), rlf_scale(v, s));
        r.axis[1] = rlf_sub(rlf_scale(v, c), rlf_scale(u, s));
        for (int32_t n = 0; n < p->count; n++) {
            rlf_vec3 d = rlf_sub(image_grid_point(p->grid, p->slot->depth, p->pixel[n]), p->centre);
            for (int k = 0; k < 2; k++) {
                double at = rlf_dot(d, r.axis[k]);
                r.low[k] = rlf_min(r.low[k], at);
                r.high[k] = rlf_max(r.high[k], at);
            }
        }
        best = area_of(&r) < area_of(&best) ? r : best;
    }
    return best;
}

static double patch_area(const patch *p)
{
    const image_grid *grid = p->grid;
    rlf_vec3 c = p->centre;
    double facing = -rlf_dot(p->normal, c) / rlf_length(c), cell = STEP_PX * c.z;
    return facing > least_facing
               ? p->count * cell * cell / (grid->camera.fx * grid->camera.fy * facing)
               : 0.0;
}

static slab make_slab(const patch *p, const rectangle *r)
{
    double pixel = p->centre.z / p->grid->camera.fx;
    double facing = -rlf_dot(p->normal, rlf_normalize(p->centre));
    slab s = {.half = {0.5 * (r->high[0] - r->low[0]) + 0.5 * pixel,
                       0.5 * (r->high[1] - r->low[1]) + 0.5 * pixel, first_half_m}};
    s.pose.p = rlf_mad(p->centre, p->normal, -first_half_m);
    for (int k = 0; k < 2; k++) {
        s.pose.p = rlf_mad(s.pose.p, r->axis[k], 0.5 * (r->low[k] + r->high[k]));
    }
    rlf_vec3 z = rlf_cross(r->axis[0], r->axis[1]);
    const rlf_mat3 m = {{{r->axis[0].x, r->axis[1].x, z.x},
                         {r->axis[0].y, r->axis[1].y, z.y},
                         {r->axis[0].z, r->axis[1].z, z.z}}};
    s.pose.q = rlf_quat_from_mat3(&m);
    double across = 1.5 * pixel / facing;
    const double sigma[9] = {
        across, across, across, 0.05, 0.05, 0.05, across, across, 0.5 * first_half_m};
    for (int k = 0; k < 9; k++) {
        s.doubt[k][k] = sigma[k] * sigma[k];
    }
    return s;
}

static void mark(const patch *p, uint8_t *visited, uint8_t as)
{
    for (int32_t n = 0; n < p->count; n++) {
        visited[p->pixel[n]] = as;
    }
}

static bool take(const patch *p, uint8_t *visited, slab *out)
{
    double area = patch_area(p);
    if (p->count < LEAST || area < least_area_m2 || p->rms > flat_rms_m) {
        return false;
    }
    const rectangle r = surround(p);
    if (area < least_full * area_of(&r) || r.high[0] - r.low[0] < 2.0 * THIN_STEP_M ||
        r.high[1] - r.low[1] < 2.0 * THIN_STEP_M) {
        return false;
    }
    mark(p, visited, 2);
    bool is_slab = has_outline(p, visited);
    mark(p, visited, 1);
    *out = make_slab(p, &r);
    return is_slab;
}

/* Mean over the patch. */
static rlf_vec3 speed_of(const patch *p)
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (int32_t n = 0; n < p->count; n++) {
        for (int k = 0; k < 3; k++) {
            sum[k] += p->slot->velocity[k][p->pixel[n]];
        }
    }
    return rlf_scale(rlf_vec3_make(sum[0], sum[1], sum[2]), 1.0 / p->count);
}

/* What the slabs explain is no seed. Patches lie on every second row. */
static void mark_known(const thin_in *in, thin *state)
{
    const image_grid *grid = in->grid;
    for (int32_t k = 0; k < state->count; k++) {
        const slab_view view = slab_look(&state->item[k]);
        const rlf_rect w = slab_window(grid, &view, EDGE_PX);
        for (int32_t y = w.y0 + w.y0 % STEP_PX; y < w.y1; y += STEP_PX) {
            for (int32_t x = w.x0; x < w.x1; x++) {
                ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
                bool is_near =
                    slab_is_near(&view, image_grid_point(grid, in->before->depth, i), side_m);
                state->visited[i] = is_near ? 1 : state->visited[i];
            }
        }
    }
}

/* Returns the pixels that it has looked at. */
static int32_t find_in(const thin_in *in, const rlf_region *region, thin *state)
{
    int32_t first = (region->y0 / SEED_PX + 1) * SEED_PX, looked_at = 0;
    for (int32_t y = first; y < region->y1; y += SEED_PX) {
        if ((y / SEED_PX + state->frame) % FRAMES != 0) {
            continue;
        }
        for (int32_t x = region->x0; x < region->x1; x += SEED_PX) {
            if (state->count == SLABS || state->visited[(ptrdiff_t)y * in->grid->width + x] != 0 ||
                !is_seed(in->grid, in->before, region->label, x, y)) {
                continue;
            }
            patch p = {.grid = in->grid,
                       .slot = in->before,
                       .label = region->label,
                       .pixel = state->patch};
            grow(&p, state->visited, x, y);
            looked_at += p.count + A_PATCH;
            slab *next = &state->item[state->count];
            if (take(&p, state->visited, next)) {
                next->speed = speed_of(&p);
                state->count++;
            }
        }
    }
    return looked_at;
}

void slab_find(const thin_in *in, thin *state)
{
    const rlf_slot *slot = in->before;
    state->frame = (state->frame + 1) % FRAMES;
    if (slot->foreground_region_count == 0 || state->count == SLABS) {
        return;
    }
    memset(state->visited, 0, (size_t)in->grid->count);
    mark_known(in, state);
    int32_t count = slot->foreground_region_count, begin = state->region % count;
    for (int32_t k = 0, looked_at = 0; k < count && looked_at < MOST_LOOKED_AT; k++) {
        int32_t r = (begin + k) % count;
        looked_at += find_in(in, &slot->regions[slot->foreground_region_first + r], state);
        state->region = (r + 1) % count;
    }
}
