/* What real things keep of the directed light from a body, as a map. */
#include "render/real_shade.h"

#include <string.h>

#define STEPS_TO_BODY 8
#define NEAR_BODY 0.1f /* of its radius: light that comes so close meets the body */
#define MIDDLE (0.5f * (REAL_SHADE_SIDE - 1))

#define LARGE_PX 40.0 /* radius: a body to be looked at closely, */
#define SMALL_PX 12.0 /* and one of which less will do */

enum {
    COARSE = 4,
    UNKNOWN = -1,
    ENOUGH = 4 /* cells that agree, for the whole body */
};

/* The body and the light in the depth camera's frame. */
typedef struct shade_job {
    const rlf_surface *surface;
    const caster *body;
    float center[3], axis[3][3], to_light[3], across[3], down[3];
    float spacing; /* of cells, metres */
} shade_job;

/* Distance from points, from the centre, to the body. */
RLF_KERNEL_PART void distances_to(const shade_job *j, const float *restrict x,
                                  const float *restrict y, const float *restrict z,
                                  float *restrict out)
{
    const shade_job job = *j;
    const caster body = *j->body;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LIGHT_PATH_RAYS; i++) {
        float sum = 0.0f;
        for (int k = 0; k < 3; k++) {
            const float *axis = job.axis[k];
            float q = axis[0] * x[i] + axis[1] * y[i] + axis[2] * z[i];
            float beyond = (q < 0.0f ? -q : q) - body.half[k];
            sum += beyond > 0.0f ? beyond * beyond : 0.0f;
        }
        out[i] = sqrtf(sum) - body.round;
    }
}

RLF_KERNEL_PART void step_back(const float *restrict gap, float along, float *restrict v)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LIGHT_PATH_RAYS; i++) {
        v[i] = gap[i] > 0.0f ? v[i] - gap[i] * along : v[i];
    }
}

/* Where the light of cells first meets the body, into `out`; those that it passes by are none. */
RLF_KERNEL static void find_lit(const shade_job *j, const float *restrict x,
                                const float *restrict y, light_path_points *out)
{
    const float radius = j->body->radius;
    float gap[LIGHT_PATH_RAYS];
    for (int k = 0; k < 3; k++) {
        const float from = radius * j->to_light[k];
        float *restrict v = out->p[k];
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LIGHT_PATH_RAYS; i++) {
            v[i] = x[i] * j->across[k] + y[i] * j->down[k] + from;
        }
    }
    distances_to(j, out->p[0], out->p[1], out->p[2], gap);
    for (int n = 0; n < STEPS_TO_BODY; n++) {
        for (int k = 0; k < 3; k++) {
            step_back(gap, j->to_light[k], out->p[k]);
        }
        distances_to(j, out->p[0], out->p[1], out->p[2], gap);
    }
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LIGHT_PATH_RAYS; i++) {
        bool is_met =
            (x[i] * x[i] + y[i] * y[i] <= radius * radius) & (gap[i] < NEAR_BODY * radius);
        out->is_some[i] = is_met ? 1 : 0;
        for (int k = 0; k < 3; k++) {
            out->p[k][i] += j->center[k];
        }
    }
}

/* Cells whose light is to be followed. */
typedef struct cell_list {
    int32_t cell[REAL_SHADE_CELLS];
    int32_t count;
} cell_list;

static void follow(const shade_job *j, const cell_list *list, real_shade *out)
{
    for (int32_t first = 0; first < list->count; first += LIGHT_PATH_RAYS) {
        float x[LIGHT_PATH_RAYS];
        float y[LIGHT_PATH_RAYS];
        float lost[LIGHT_PATH_RAYS];
        light_path_points points;
        const int32_t left = list->count - first;
        const int32_t count = left < LIGHT_PATH_RAYS ? left : LIGHT_PATH_RAYS;
        for (int32_t i = 0; i < LIGHT_PATH_RAYS; i++) {
            const int32_t cell = list->cell[first + (i < count ? i : 0)];
            x[i] = ((float)(cell % REAL_SHADE_SIDE) - MIDDLE) * j->spacing;
            y[i] = ((float)(cell / REAL_SHADE_SIDE) - MIDDLE) * j->spacing;
        }
        find_lit(j, x, y, &points);
        light_path_lost(j->surface, &points, j->to_light, count, lost);
        for (int32_t i = 0; i < count; i++) {
            out->left[list->cell[first + i]] = points.is_some[i] != 0 ? 1.0f - lost[i] : UNKNOWN;
        }
    }
}

/* Cell (x, y), between those 2 * step apart, a power of two: what these agree about. False when
 * they do not. */
static bool is_agreed(int32_t x, int32_t y, int32_t step, real_shade *out)
{
    const int32_t in_x = x & step;
    const int32_t in_y = y & step;
    const float *first = out->left + (y - in_y) * REAL_SHADE_SIDE + (x - in_x);
    const float *second = first + 2 * in_y * REAL_SHADE_SIDE;
    const float a = first[0];
    const float b = first[2 * in_x];
    const float c = second[0];
    const float d = second[2 * in_x];
    out->left[y * REAL_SHADE_SIDE + x] = a;
    return a >= 0.0f && a == b && b == c && c == d;
}

/* Cells `step` apart between those twice as far apart: what these agree about, or followed. */
static void refine(const shade_job *j, int32_t step, real_shade *out)
{
    cell_list list = {.count = 0};
    for (int32_t y = 0; y < REAL_SHADE_SIDE; y += step) {
        const bool is_between = (y & step) != 0;
        for (int32_t x = is_between ? 0 : step; x < REAL_SHADE_SIDE;
             x += is_between ? step : 2 * step) {
            if (!is_agreed(x, y, step, out)) {
                list.cell[list.count++] = y * REAL_SHADE_SIDE + x;
            }
        }
    }
    follow(j, &list, out);
}

/* Cells between those `step` apart, a power of two. */
static void spread(int32_t step, real_shade *out)
{
    const float per_step = 1.0f / (float)step; /* exact */
    for (int32_t y = 0; y < REAL_SHADE_SIDE; y++) {
        const int32_t in_y = y & (step - 1);
        const int32_t below = in_y != 0 ? step * REAL_SHADE_SIDE : 0;
        for (int32_t x = 0; x < REAL_SHADE_SIDE; x++) {
            const int32_t in_x = x & (step - 1);
            const int32_t right = in_x != 0 ? step : 0;
            const float *at = out->left + (y - in_y) * REAL_SHADE_SIDE + (x - in_x);
            const float u = (float)in_x * per_step;
            const float v = (float)in_y * per_step;
            const float top = at[0] + (at[right] - at[0]) * u;
            const float bottom = at[below] + (at[below + right] - at[below]) * u;
            out->left[y * REAL_SHADE_SIDE + x] = top + (bottom - top) * v;
        }
    }
}

/* Mean of the light of a cell's neighbours `step` away; UNKNOWN when none is known. */
static float mean_around(const real_shade *shade, int32_t x, int32_t y, int32_t step)
{
    float sum = 0.0f;
    float count = 0.0f;
    for (int32_t k = 0; k < 9; k++) {
        int32_t u = x + (k % 3 - 1) * step;
        int32_t v = y + (k / 3 - 1) * step;
        bool is_in = u >= 0 && u < REAL_SHADE_SIDE && v >= 0 && v < REAL_SHADE_SIDE;
        float value = is_in ? shade->left[v * REAL_SHADE_SIDE + u] : UNKNOWN;
        sum += value >= 0.0f ? value : 0.0f;
        count += value >= 0.0f ? 1.0f : 0.0f;
    }
    return count > 0.0f ? sum / count : UNKNOWN;
}

/* Cells `step` apart that pass by the body take the mean of their neighbours' light, ring by ring;
 * 1 where there is none. */
static void fill_outside(int32_t step, real_shade *out)
{
    cell_list list = {.count = 1};
    float mean[REAL_SHADE_CELLS];
    for (int32_t ring = 0; list.count > 0 && ring < REAL_SHADE_SIDE / step; ring++) {
        list.count = 0;
        for (int32_t y = 0; y < REAL_SHADE_SIDE; y += step) {
            for (int32_t x = 0; x < REAL_SHADE_SIDE; x += step) {
                const int32_t i = y * REAL_SHADE_SIDE + x;
                if (out->left[i] < 0.0f) {
                    mean[list.count] = mean_around(out, x, y, step);
                    list.cell[list.count++] = i;
                }
            }
        }
        for (int32_t i = 0; i < list.count; i++) {
            out->left[list.cell[i]] = mean[i];
        }
    }
    for (int32_t i = 0; i < list.count; i++) {
        out->left[list.cell[i]] = mean[i] >= 0.0f ? mean[i] : 1.0f;
    }
}

/* True when the cells `step` apart that meet the body all have the same light, *out. */
static bool agree(const real_shade *shade, int32_t step, float *out)
{
    int32_t count = 0;
    *out = 1.0f;
    for (int32_t y = 0; y < REAL_SHADE_SIDE; y += step) {
        for (int32_t x = 0; x < REAL_SHADE_SIDE; x += step) {
            const float left = shade->left[y * REAL_SHADE_SIDE + x];
            if (left >= 0.0f && count > 0 && left != *out) {
                return false;
            }
            *out = left >= 0.0f ? left : *out;
            count += left >= 0.0f ? 1 : 0;
        }
    }
    return count >= ENOUGH;
}

/* Two directions across the light, any will do. */
static void place_map(const real_shade_world *world, const caster *body, shade_job *j,
                      real_shade *out)
{
    rlf_vec3 l = world->to_light;
    rlf_vec3 across = rlf_perpendicular(l);
    rlf_vec3 down = rlf_cross(l, across);
    rlf_quat q = world->T_depth_picture.q;
    *j = (shade_job){.surface = world->surface, .body = body};
    j->spacing = body->radius / MIDDLE;
    caster_to_floats(rlf_transform(&world->T_depth_picture, caster_from_floats(body->center)),
                     j->center);
    for (int i = 0; i < 3; i++) {
        caster_to_floats(rlf_rotate(q, caster_from_floats(body->axis[i])), j->axis[i]);
        out->center[i] = body->center[i];
    }
    caster_to_floats(rlf_rotate(q, l), j->to_light);
    caster_to_floats(rlf_rotate(q, across), j->across);
    caster_to_floats(rlf_rotate(q, down), j->down);
    const double per_cell = 1.0 / (double)j->spacing;
    caster_to_floats(rlf_scale(across, per_cell), out->across);
    caster_to_floats(rlf_scale(down, per_cell), out->down);
}

void real_shade_make(const real_shade_world *world, const caster *body, real_shade *out)
{
    out->takes = false;
    if (!(body->near_m > 0.0f) || world->surface->depth == NULL) {
        return;
    }
    shade_job job;
    place_map(world, body, &job, out);
    const light_path_ball ball = {{job.center[0], job.center[1], job.center[2]},
                                  body->reach + NEAR_BODY * body->radius};
    if (world->tiles != NULL &&
        !light_path_may_lose(world->surface, world->tiles, &ball, job.to_light)) {
        return;
    }
    double radius_px = world->focal_px * (double)body->radius / (double)body->center[2];
    const int32_t finest = radius_px > LARGE_PX ? 1 : (radius_px > SMALL_PX ? 2 : COARSE);
    const int32_t sure = radius_px > LARGE_PX ? COARSE / 2 : COARSE;
    cell_list list = {.count = 0};
    for (int32_t y = 0; y < REAL_SHADE_SIDE; y += COARSE) {
        for (int32_t x = 0; x < REAL_SHADE_SIDE; x += COARSE) {
            list.cell[list.count++] = y * REAL_SHADE_SIDE + x;
        }
    }
    follow(&job, &list, out);
    float same = 1.0f;
    int32_t step = COARSE;
    while (step > finest && !(step <= sure && agree(out, step, &same))) {
        step /= 2;
        refine(&job, step, out);
    }
    if (step <= sure && agree(out, step, &same) && same == 1.0f) {
        return;
    }
    fill_outside(step, out);
    spread(step, out);
    out->takes = true;
}

/* ---- light ---------------------------------------------------------------------------------- */

RLF_KERNEL_PART float limit(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* Bilinear. */
RLF_KERNEL_PART void take(const real_shade *shade, const float *restrict ray_x,
                          const float *restrict ray_y, const float *restrict z, int32_t count,
                          float share, float *restrict left)
{
    const float *restrict map = shade->left;
    const float *across = shade->across;
    const float *down = shade->down;
    const float last = REAL_SHADE_SIDE - 1.001f;
    for (int32_t i = 0; i < count; i++) {
        float px = ray_x[i] * z[i] - shade->center[0];
        float py = ray_y[i] * z[i] - shade->center[1];
        float pz = z[i] - shade->center[2];
        float x = limit(across[0] * px + across[1] * py + across[2] * pz + MIDDLE, 0.0f, last);
        float y = limit(down[0] * px + down[1] * py + down[2] * pz + MIDDLE, 0.0f, last);
        int32_t column = (int32_t)x;
        int32_t row = (int32_t)y;
        float u = x - (float)column;
        float v = y - (float)row;
        int32_t at = row * REAL_SHADE_SIDE + column;
        float top = map[at] + (map[at + 1] - map[at]) * u;
        float below = map[at + REAL_SHADE_SIDE];
        float bottom = below + (map[at + REAL_SHADE_SIDE + 1] - below) * u;
        left[i] *= 1.0f - share * (1.0f - (top + (bottom - top) * v));
    }
}

RLF_KERNEL void real_shade_take(const real_shade *shade, const caster_points *p, float share,
                                float *left)
{
    take(shade, p->x, p->y, p->z, p->count, share, left);
}
