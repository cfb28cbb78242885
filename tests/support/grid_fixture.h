/* Grids for physics tests: a pinhole camera of 512 x 424 that sees analytic surfaces.
 *
 * The background is the nearest of some planes (a concave room), the foreground a rectangle. */
#ifndef RLF_TEST_GRID_FIXTURE_H
#define RLF_TEST_GRID_FIXTURE_H

#include "relief/world.h"

#include <stdlib.h>
#include <string.h>

#define GRID_W 512
#define GRID_H 424
#define GRID_F 365.5
#define GRID_CX 255.5
#define GRID_CY 211.5

/* Plane n.p = d with n towards the camera, so d < 0. */
typedef struct grid_plane {
    rlf_vec3 n;
    double d;
} grid_plane;

typedef struct grid_fixture {
    rlf_grid grid;
    float *planes[24]; /* memory of all float planes */
    int32_t *labels[2];
    uint8_t *mask;
    int32_t *points;
    rlf_grid_region region;
} grid_fixture;

static inline bool grid_fixture_project(const void *context, rlf_vec3 p, double *u, double *v)
{
    (void)context;
    if (!(p.z > 1e-6)) {
        return false;
    }
    *u = GRID_F * p.x / p.z + GRID_CX;
    *v = GRID_F * p.y / p.z + GRID_CY;
    return *u > -0.5 && *v > -0.5 && *u < GRID_W - 0.5 && *v < GRID_H - 0.5;
}

static inline grid_fixture *grid_fixture_create(void)
{
    grid_fixture *f = calloc(1, sizeof(*f));
    size_t count = (size_t)GRID_W * GRID_H;
    for (int32_t i = 0; i < 24; i++) {
        f->planes[i] = calloc(count, sizeof(float));
    }
    f->labels[0] = calloc(count, sizeof(int32_t));
    f->labels[1] = calloc(count, sizeof(int32_t));
    f->points = calloc(count, sizeof(int32_t));
    f->mask = calloc(count, 1);
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        f->planes[0][i] = (float)((i % GRID_W - GRID_CX) / GRID_F);
        f->planes[1][i] = (float)((i / GRID_W - GRID_CY) / GRID_F);
    }
    rlf_grid *g = &f->grid;
    g->width = GRID_W;
    g->height = GRID_H;
    g->ray_x = f->planes[0];
    g->ray_y = f->planes[1];
    g->project = grid_fixture_project;
    g->pixel_angle = 1.0 / GRID_F;
    g->T_world_grid = rlf_pose_identity();
    g->time_ns = 1;
    g->background = (rlf_grid_sheet){.depth = f->planes[2],
                                     .normal_x = f->planes[3],
                                     .normal_y = f->planes[4],
                                     .normal_z = f->planes[5],
                                     .label = f->labels[0]};
    g->foreground = (rlf_grid_sheet){.depth = f->planes[6],
                                     .normal_x = f->planes[7],
                                     .normal_y = f->planes[8],
                                     .normal_z = f->planes[9],
                                     .velocity_x = f->planes[10],
                                     .velocity_y = f->planes[11],
                                     .velocity_z = f->planes[12],
                                     .thickness = f->planes[13],
                                     .label = f->labels[1],
                                     .mask = f->mask};
    return f;
}

static inline void grid_fixture_destroy(grid_fixture **f)
{
    for (int32_t i = 0; i < 24; i++) {
        free((*f)->planes[i]);
    }
    free((*f)->labels[0]);
    free((*f)->labels[1]);
    free((*f)->points);
    free((*f)->mask);
    free(*f);
    *f = NULL;
}

/* Ray of pixel i: x and y at a depth of 1. */
static inline rlf_vec3 grid_fixture_ray(const grid_fixture *f, int32_t i)
{
    return rlf_vec3_make((double)f->planes[0][i], (double)f->planes[1][i], 1.0);
}

/* Pixel i shows a face at depth z with normal n, of the background or, as a layer's first plane is
 * its depth, of the foreground. */
enum { GRID_BACKGROUND = 2, GRID_FOREGROUND = 6, GRID_THICKNESS = 13 };
static inline void grid_fixture_paint(grid_fixture *f, int layer, int32_t i, double z, rlf_vec3 n)
{
    f->planes[layer][i] = (float)z;
    f->planes[layer + 1][i] = (float)n.x;
    f->planes[layer + 2][i] = (float)n.y;
    f->planes[layer + 3][i] = (float)n.z;
}

/* Background: the nearest of the planes along each ray, up to 12 m. Also the one region. */
static inline void grid_fixture_set_room(grid_fixture *f, const grid_plane *planes, int32_t count)
{
    f->region = (rlf_grid_region){.label = 1, .box = rlf_aabb_empty(), .points = f->points};
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        double best = 12.0;
        f->planes[2][i] = 0.0f;
        f->labels[0][i] = 0;
        rlf_vec3 ray = grid_fixture_ray(f, i);
        for (int32_t k = 0; k < count; k++) {
            double slope = rlf_dot(planes[k].n, ray);
            double z = slope < -1e-4 ? planes[k].d / slope : 1e9;
            if (z < best) {
                best = z;
                grid_fixture_paint(f, GRID_BACKGROUND, i, z, planes[k].n);
                f->labels[0][i] = 1;
            }
        }
        if (f->labels[0][i] != 0) {
            f->points[f->region.point_count++] = i;
            rlf_aabb_extend(&f->region.box, rlf_scale(ray, best));
        }
    }
    f->grid.regions = &f->region;
    f->grid.region_count = 1;
}

/* Foreground: the part of a plane with |p - centre| within half on the axes that `half` names (a
 * half of 0 or less does not limit), moving with `velocity`, `thickness` thick along z. */
static inline void grid_fixture_set_slab(grid_fixture *f, grid_plane plane, rlf_vec3 centre,
                                         rlf_vec3 half, double thickness, rlf_vec3 velocity)
{
    memset(f->mask, 0, (size_t)GRID_W * GRID_H);
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_fixture_ray(f, i);
        double slope = rlf_dot(plane.n, ray);
        double z = slope < -1e-4 ? plane.d / slope : 0.0;
        rlf_vec3 d = rlf_sub(rlf_scale(ray, z), centre);
        bool is_in = z > 0.1 && z < 12.0 && (half.x <= 0 || (d.x <= half.x && d.x >= -half.x)) &&
                     (half.y <= 0 || (d.y <= half.y && d.y >= -half.y)) &&
                     (half.z <= 0 || (d.z <= half.z && d.z >= -half.z));
        f->mask[i] = is_in;
        grid_fixture_paint(f, GRID_FOREGROUND, i, is_in ? z : 0.0, plane.n);
        f->planes[10][i] = (float)velocity.x;
        f->planes[11][i] = (float)velocity.y;
        f->planes[12][i] = (float)velocity.z;
        f->planes[13][i] = (float)thickness;
        f->labels[1][i] = is_in ? 2 : 0;
    }
}

/* A level floor `height` metres below the camera. */
static inline grid_plane grid_floor(double height)
{
    grid_plane plane = {{0, -1, 0}, -height};
    return plane;
}

/* A wall across the view at depth z. */
static inline grid_plane grid_wall(double z)
{
    grid_plane plane = {{0, 0, -1}, -z};
    return plane;
}

#endif
