/* The colour camera's picture of the static room: four rays per pixel, lit once. One that is to
 * open soon is coarse at first, and a row of tiles becomes right with every frame. */
#include "sim/color.h"
#include "sim/material.h"

#include <string.h>

enum { COARSE = 4 }; /* pixels of a coarse picture's squares; divides a tile */

typedef struct job {
    synth_color *color;
    const synth_scene *scene;
    synth_color_planes *planes;
    int32_t static_count;
    int32_t first_row; /* of tiles */
    bool is_coarse;
} job;

static synth_site site_of(const synth_part *part, const synth_ray *ray, double t)
{
    synth_site site;
    site.p = synth_ray_at(ray, t);
    site.normal = synth_shape_normal(&part->shape, site.p);
    return site;
}

/* Light on a site, and the lamp's share of it. */
typedef struct lit {
    rlf_vec3 light;
    double lamp_share;
} lit;

static lit light_at(const job *j, const synth_site *site)
{
    if (j->scene->is_moving) { /* cast anew in each frame: shadows and nearness are left out */
        return (lit){synth_light(j->scene->lamp, j->scene->down, site, 1.0, 1.0), 0.0};
    }
    double lamp = synth_lamp_share(j->scene, j->static_count, site);
    double sky = synth_sky_share(j->scene, j->static_count, site);
    lit result = {synth_light(j->scene->lamp, j->scene->down, site, lamp, sky), 0.0};
    const double dark = synth_light(j->scene->lamp, j->scene->down, site, 0.0, sky).y;
    result.lamp_share = 1.0 - dark / result.light.y;
    return result;
}

static rlf_vec3 albedo_at(const synth_part *part, const synth_ray *ray, double t)
{
    rlf_vec3 p = synth_ray_at(ray, t);
    return synth_albedo(part, rlf_transform_inverse(&part->shape.T_camera_shape, p));
}

static rlf_vec3 multiply(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(a.x * b.x, a.y * b.y, a.z * b.z);
}

static void encode(const job *j, rlf_vec3 sum, int32_t count, uint8_t out[4])
{
    sum = rlf_scale(sum, 1.0 / count);
    synth_encode(j->color->gamma, (float)sum.x, (float)sum.y, (float)sum.z, out);
}

/* What a pixel's middle sees, and how its samples add up. */
typedef struct pixel {
    synth_hit hit;
    lit light;
    rlf_vec3 sum, own; /* of all samples; of the middle's part alone, the middle too */
    int32_t own_count;
    synth_hit other; /* the last part that was not the middle's, */
    rlf_vec3 other_light;
} pixel;

static void add_sample(const job *j, synth_candidates *candidates, const synth_ray *ray, pixel *p)
{
    const synth_hit sample = synth_cast(j->scene, candidates, ray);
    if (sample.part < 0) {
        return;
    }
    const synth_part *seen = &j->scene->statics[sample.part];
    const bool is_own = sample.part == p->hit.part;
    if (!is_own && sample.part != p->other.part) {
        const synth_site edge = site_of(seen, ray, sample.t);
        p->other = sample;
        p->other_light = light_at(j, &edge).light;
    }
    const rlf_vec3 light = is_own ? p->light.light : p->other_light;
    const rlf_vec3 here = multiply(light, albedo_at(seen, ray, sample.t));
    p->sum = rlf_add(p->sum, here);
    p->own = is_own ? rlf_add(p->own, here) : p->own;
    p->own_count += is_own;
}

/* The parts that the corners of a tile's pixels show: four pixels share a corner. */
typedef struct corners {
    int32_t part[SYNTH_TILE + 1][SYNTH_TILE + 1];
} corners;

static void cast_corners(const job *j, synth_candidates *candidates, synth_rect tile, corners *out)
{
    for (int32_t y = 0; y <= tile.y1 - tile.y0; y++) {
        for (int32_t x = 0; x <= tile.x1 - tile.x0; x++) {
            const synth_ray ray =
                synth_view_ray(&j->color->view, tile.x0 + x - 0.5, tile.y0 + y - 0.5);
            out->part[y][x] = synth_cast(j->scene, candidates, &ray).part;
        }
    }
}

/* Do all corners of pixel x, y of the tile show the part? Of a coarse picture nobody asks. */
static bool is_whole(const corners *c, int32_t x, int32_t y, int32_t part)
{
    return c == NULL || (c->part[y][x] == part && c->part[y][x + 1] == part &&
                         c->part[y + 1][x] == part && c->part[y + 1][x + 1] == part);
}

/* Depth and floor light come from the pixel's middle; the colour is the mean of 2 x 2 samples, and
 * of 16 in different rows and columns where an edge runs through. What sees the same part shares
 * its light. */
static void cast_pixel(const job *j, synth_candidates *candidates, const corners *c,
                       synth_rect tile, int32_t x, int32_t y)
{
    synth_ray middle = synth_view_ray(&j->color->view, x, y);
    pixel p = {.hit = synth_cast(j->scene, candidates, &middle), .own_count = 1, .other = {-1, 0}};
    size_t i = (size_t)y * (size_t)j->color->view.camera.width + (size_t)x;
    if (p.hit.part < 0) {
        j->planes->rgba[4 * i + 3] = j->planes->front[4 * i + 3] = 255;
        return;
    }
    const synth_part *part = &j->scene->statics[p.hit.part];
    synth_site site = site_of(part, &middle, p.hit.t);
    p.light = light_at(j, &site);
    p.own = multiply(p.light.light, albedo_at(part, &middle, p.hit.t));
    const int32_t side = is_whole(c, x - tile.x0, y - tile.y0, p.hit.part) ? 2 : 4;
    for (int32_t k = 0; k < side * side; k++) {
        const double u = (k % side + 0.5) / side - 0.5;
        const double v = (k / side + 0.5) / side - 0.5;
        const double turn = side == 4 ? 0.25 : 0.0; /* of the grid, to get 16 rows and columns */
        synth_ray ray = synth_view_ray(&j->color->view, x + u + turn * v, y + v + turn * u);
        add_sample(j, candidates, &ray, &p);
    }
    encode(j, p.sum, side * side, &j->planes->rgba[4 * i]);
    encode(j, p.own, p.own_count, &j->planes->front[4 * i]);
    j->planes->z[i] = (float)p.hit.t;
    j->planes->lamp[i] =
        part->label == RLF_SYNTHETIC_LABEL_FLOOR ? (uint8_t)(255.0 * p.light.lamp_share) : 0;
}

static void cast_pixels(const job *j, synth_candidates *candidates, synth_rect tile)
{
    corners shown;
    cast_corners(j, candidates, tile, &shown);
    for (int32_t y = tile.y0; y < tile.y1; y++) {
        for (int32_t x = tile.x0; x < tile.x1; x++) {
            cast_pixel(j, candidates, &shown, tile, x, y);
        }
    }
}

/* All of a square is as one pixel of it. */
static void spread(const job *j, synth_rect square, int32_t x, int32_t y)
{
    const size_t width = (size_t)j->color->view.camera.width;
    const size_t from = (size_t)y * width + (size_t)x;
    synth_color_planes *p = j->planes;
    for (int32_t to_y = square.y0; to_y < square.y1; to_y++) {
        for (int32_t to_x = square.x0; to_x < square.x1; to_x++) {
            const size_t to = (size_t)to_y * width + (size_t)to_x;
            memmove(&p->rgba[4 * to], &p->rgba[4 * from], 4);
            memmove(&p->front[4 * to], &p->front[4 * from], 4);
            p->z[to] = p->z[from];
            p->lamp[to] = p->lamp[from];
        }
    }
}

static void cast_squares(const job *j, synth_candidates *candidates, synth_rect tile)
{
    for (int32_t y = tile.y0; y < tile.y1; y += COARSE) {
        for (int32_t x = tile.x0; x < tile.x1; x += COARSE) {
            const synth_rect square = {x, y, x + COARSE < tile.x1 ? x + COARSE : tile.x1,
                                       y + COARSE < tile.y1 ? y + COARSE : tile.y1};
            const int32_t middle_x = (square.x0 + square.x1) / 2;
            const int32_t middle_y = (square.y0 + square.y1) / 2;
            cast_pixel(j, candidates, NULL, tile, middle_x, middle_y);
            spread(j, square, middle_x, middle_y);
        }
    }
}

static void cast_tiles(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const job *j = context;
    const rlf_camera *camera = &j->color->view.camera;
    (void)worker;
    for (int32_t tile_y = j->first_row + begin; tile_y < j->first_row + end; tile_y++) {
        for (int32_t x0 = 0; x0 < camera->width; x0 += SYNTH_TILE) {
            int32_t y0 = tile_y * SYNTH_TILE;
            synth_rect tile = {x0, y0, x0 + SYNTH_TILE, y0 + SYNTH_TILE};
            tile = synth_rect_grow(tile, 0, camera);
            synth_candidates candidates;
            synth_tile_candidates(j->scene, j->static_count, &j->color->view, tile, &candidates);
            (j->is_coarse ? cast_squares : cast_pixels)(j, &candidates, tile);
        }
    }
}

static int32_t tile_rows(const synth_color *color)
{
    return (color->view.camera.height + SYNTH_TILE - 1) / SYNTH_TILE;
}

/* Rows of tiles from first on. */
static void cast_room(synth_color *color, const synth_scene *scene, int32_t state, int32_t first,
                      int32_t count)
{
    job j = {.color = color,
             .scene = scene,
             .planes = &color->room[state],
             .static_count = scene->static_count - (state == 1 ? scene->removed_count : 0),
             .first_row = first,
             .is_coarse = color->is_coarse};
    rlf_parallel_for(color->pool, count, 1, cast_tiles, &j);
}

static int32_t room_states(const synth_scene *scene)
{
    return scene->removed_count > 0 ? 2 : 1;
}

void synth_color_sharpen(synth_color *color)
{
    if (color->right_rows >= tile_rows(color)) {
        return;
    }
    color->is_coarse = false;
    for (int32_t k = 0; k < room_states(color->scene); k++) {
        cast_room(color, color->scene, k, color->right_rows, 1);
    }
    color->right_rows++;
    color->room_index = -1; /* nothing of the last frame holds */
}

void synth_color_cast_room(synth_color *color, int32_t state)
{
    const rlf_camera *camera = &color->view.camera;
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    synth_color_planes *planes = &color->room[state];
    memset(planes->rgba, 0, 4 * pixels);
    memset(planes->front, 0, 4 * pixels);
    memset(planes->z, 0, pixels * sizeof(float));
    memset(planes->lamp, 0, pixels);
    cast_room(color, color->scene, state, 0, tile_rows(color));
    color->room_index = -1;
}

static rlf_result create_room(synth_color *color, const synth_scene *scene, int32_t state)
{
    const rlf_camera *camera = &color->view.camera;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    synth_color_planes *planes = &color->room[state];
    planes->rgba = rlf_alloc_array(pixels, 4);
    planes->front = rlf_alloc_array(pixels, 4);
    planes->z = rlf_alloc_array(pixels, sizeof(float));
    planes->lamp = rlf_alloc(pixels);
    if (planes->rgba == NULL || planes->front == NULL || planes->z == NULL ||
        planes->lamp == NULL) {
        return RLF_ERROR_MEMORY;
    }
    cast_room(color, scene, state, 0, tile_rows(color));
    return RLF_OK;
}

rlf_result synth_color_create(synth_color *color, const synth_scene *scene)
{
    const rlf_camera *camera = &color->view.camera;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    color->scene = scene;
    color->room_index = -1;
    synth_gamma_table(color->gamma);
    color->paint = rlf_alloc_array(pixels, 4);
    color->out = rlf_alloc_array(pixels, 4);
    if (color->paint == NULL || color->out == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = synth_canvas_create(&color->canvas, &color->view);
    color->right_rows = color->is_coarse ? 0 : tile_rows(color);
    for (int32_t k = 0; k < room_states(scene) && result == RLF_OK; k++) {
        result = create_room(color, scene, k);
    }
    return result;
}

void synth_color_destroy(synth_color *color)
{
    for (int k = 0; k < 2; k++) {
        rlf_free(color->room[k].rgba);
        rlf_free(color->room[k].front);
        rlf_free(color->room[k].z);
        rlf_free(color->room[k].lamp);
    }
    rlf_free(color->paint);
    rlf_free(color->out);
    synth_canvas_destroy(&color->canvas);
    *color = (synth_color){.scene = NULL};
}
