/* Planes by rays. */
#include "eval/physics/sheet.h"

#include <string.h>

#define WIDTH 512
#define HEIGHT 424
#define COUNT (WIDTH * HEIGHT)
#define FOCAL 365.5
#define FAR_M 12.0

/* Order of eval_sheet.planes. */
enum {
    RAY_X,
    RAY_Y,
    ROOM_DEPTH,
    ROOM_NORMAL,
    SLAB_DEPTH = 6,
    SLAB_NORMAL,
    SLAB_VELOCITY = 10,
    SLAB_THICKNESS = 13
};

static bool project(const void *context, rlf_vec3 p, double *out_u, double *out_v)
{
    (void)context;
    if (!(p.z > 1e-6)) {
        return false;
    }
    *out_u = FOCAL * p.x / p.z + 0.5 * (WIDTH - 1);
    *out_v = FOCAL * p.y / p.z + 0.5 * (HEIGHT - 1);
    return *out_u > -0.5 && *out_v > -0.5 && *out_u < WIDTH - 0.5 && *out_v < HEIGHT - 0.5;
}

bool eval_sheet_sees(rlf_vec3 p)
{
    double u, v;
    return project(NULL, p, &u, &v) && u > 5.0 && v > 5.0 && u < WIDTH - 6 && v < HEIGHT - 6;
}

static void link_grid(eval_sheet *s)
{
    float **p = s->planes;
    rlf_grid *g = &s->grid;
    g->width = WIDTH;
    g->height = HEIGHT;
    g->ray_x = p[RAY_X];
    g->ray_y = p[RAY_Y];
    g->project = project;
    g->pixel_angle = 1.0 / FOCAL;
    g->T_world_grid = rlf_pose_identity();
    g->time_ns = 1;
    g->background = (rlf_grid_sheet){.depth = p[ROOM_DEPTH],
                                     .normal_x = p[ROOM_NORMAL],
                                     .normal_y = p[ROOM_NORMAL + 1],
                                     .normal_z = p[ROOM_NORMAL + 2],
                                     .label = s->labels[0]};
    g->foreground = (rlf_grid_sheet){.depth = p[SLAB_DEPTH],
                                     .normal_x = p[SLAB_NORMAL],
                                     .normal_y = p[SLAB_NORMAL + 1],
                                     .normal_z = p[SLAB_NORMAL + 2],
                                     .velocity_x = p[SLAB_VELOCITY],
                                     .velocity_y = p[SLAB_VELOCITY + 1],
                                     .velocity_z = p[SLAB_VELOCITY + 2],
                                     .thickness = p[SLAB_THICKNESS],
                                     .label = s->labels[1],
                                     .mask = s->mask};
}

rlf_result eval_sheet_open(eval_sheet *out)
{
    memset(out, 0, sizeof(*out));
    bool is_complete = true;
    for (int k = 0; k < 14; k++) {
        out->planes[k] = rlf_alloc_array(COUNT, sizeof(float));
        is_complete = is_complete && out->planes[k] != NULL;
    }
    for (int k = 0; k < 2; k++) {
        out->labels[k] = rlf_alloc_array(COUNT, sizeof(int32_t));
        is_complete = is_complete && out->labels[k] != NULL;
    }
    out->mask = rlf_alloc(COUNT);
    if (!is_complete || out->mask == NULL) {
        eval_sheet_close(out);
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < COUNT; i++) {
        out->planes[RAY_X][i] = (float)((i % WIDTH - 0.5 * (WIDTH - 1)) / FOCAL);
        out->planes[RAY_Y][i] = (float)((i / WIDTH - 0.5 * (HEIGHT - 1)) / FOCAL);
    }
    link_grid(out);
    return RLF_OK;
}

void eval_sheet_close(eval_sheet *s)
{
    for (int k = 0; k < 14; k++) {
        rlf_free(s->planes[k]);
    }
    rlf_free(s->labels[0]);
    rlf_free(s->labels[1]);
    rlf_free(s->mask);
    memset(s, 0, sizeof(*s));
}

static rlf_vec3 ray_at(const eval_sheet *s, int32_t i)
{
    return rlf_vec3_make(s->planes[RAY_X][i], s->planes[RAY_Y][i], 1.0);
}

/* Where a ray meets a wall that faces it; FAR_M where it does not. */
static double hit(const eval_wall *wall, rlf_vec3 ray)
{
    double slope = rlf_dot(wall->n, ray);
    return slope < -1e-4 ? rlf_min(wall->d / slope, FAR_M) : FAR_M;
}

static void put(eval_sheet *s, int first, int32_t i, rlf_vec3 v)
{
    s->planes[first][i] = (float)v.x;
    s->planes[first + 1][i] = (float)v.y;
    s->planes[first + 2][i] = (float)v.z;
}

void eval_sheet_set_room(eval_sheet *s, const eval_wall *walls, int32_t count)
{
    for (int32_t i = 0; i < COUNT; i++) {
        double best = FAR_M;
        for (int32_t k = 0; k < count; k++) {
            double z = hit(&walls[k], ray_at(s, i));
            if (z < best) {
                best = z;
                put(s, ROOM_NORMAL, i, walls[k].n);
            }
        }
        s->planes[ROOM_DEPTH][i] = best < FAR_M ? (float)best : 0.0f;
        s->labels[0][i] = best < FAR_M;
    }
    eval_sheet_set_slab(s, NULL);
}

static bool is_within(double x, double half)
{
    return !(half > 0.0) || (x <= half && x >= -half);
}

void eval_sheet_set_slab(eval_sheet *s, const eval_slab *slab)
{
    s->grid.time_ns++;
    memset(s->mask, 0, COUNT);
    for (int32_t i = 0; i < COUNT && slab != NULL; i++) {
        rlf_vec3 ray = ray_at(s, i);
        double z = hit(&slab->wall, ray);
        rlf_vec3 d = rlf_sub(rlf_scale(ray, z), slab->centre);
        bool is_in = z > 0.1 && z < FAR_M && is_within(d.x, slab->half.x) &&
                     is_within(d.y, slab->half.y) && is_within(d.z, slab->half.z);
        s->mask[i] = is_in;
        s->planes[SLAB_DEPTH][i] = is_in ? (float)z : 0.0f;
        s->planes[SLAB_THICKNESS][i] = (float)slab->thickness;
        s->labels[1][i] = is_in ? 2 : 0;
        put(s, SLAB_NORMAL, i, slab->wall.n);
        put(s, SLAB_VELOCITY, i, slab->velocity);
    }
}
