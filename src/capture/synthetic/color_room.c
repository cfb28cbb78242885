/* The colour camera's picture of the static room: four rays per pixel, lit once. */
#include "capture/synthetic/color.h"
#include "capture/synthetic/light.h"

#define SAMPLES 4

typedef struct job {
    synth_color *color;
    const synth_scene *scene;
    synth_color_planes *planes;
    int32_t static_count;
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
    double lamp = synth_lamp_share(j->scene, j->static_count, site);
    double sky = synth_sky_share(j->scene, j->static_count, site);
    lit result = {synth_light(j->scene->lamp, site, lamp, sky), 0.0};
    result.lamp_share = 1.0 - synth_light(j->scene->lamp, site, 0.0, sky).y / result.light.y;
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

/* Depth and floor light come from the pixel's middle; the colour is the mean of four samples. Where
 * all see the same part they share the light of the middle. */
static void cast_pixel(const job *j, const synth_candidates *candidates, int32_t x, int32_t y)
{
    synth_ray middle = synth_view_ray(&j->color->view, x, y);
    synth_hit hit = synth_cast(j->scene, candidates, &middle);
    size_t i = (size_t)y * (size_t)j->color->view.camera.width + (size_t)x;
    if (hit.part < 0) {
        j->planes->rgba[4 * i + 3] = 255;
        return;
    }
    const synth_part *part = &j->scene->statics[hit.part];
    synth_site site = site_of(part, &middle, hit.t);
    lit middle_lit = light_at(j, &site);
    rlf_vec3 sum = rlf_vec3_make(0, 0, 0);
    for (int k = 0; k < SAMPLES; k++) {
        synth_ray ray = synth_view_ray(&j->color->view, x + ((k & 1) != 0 ? 0.25 : -0.25),
                                       y + ((k & 2) != 0 ? 0.25 : -0.25));
        synth_hit sample = synth_cast(j->scene, candidates, &ray);
        if (sample.part < 0) {
            continue;
        }
        const synth_part *seen = &j->scene->statics[sample.part];
        rlf_vec3 light = middle_lit.light;
        if (sample.part != hit.part) {
            synth_site edge = site_of(seen, &ray, sample.t);
            light = light_at(j, &edge).light;
        }
        sum = rlf_add(sum, multiply(light, albedo_at(seen, &ray, sample.t)));
    }
    sum = rlf_scale(sum, 1.0 / SAMPLES);
    synth_encode(j->color->gamma, (float)sum.x, (float)sum.y, (float)sum.z,
                 &j->planes->rgba[4 * i]);
    j->planes->z[i] = (float)hit.t;
    j->planes->lamp[i] =
        part->label == RLF_SYNTHETIC_LABEL_FLOOR ? (uint8_t)(255.0 * middle_lit.lamp_share) : 0;
}

static void cast_tiles(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const job *j = context;
    const rlf_camera *camera = &j->color->view.camera;
    (void)worker;
    for (int32_t tile_y = begin; tile_y < end; tile_y++) {
        for (int32_t x0 = 0; x0 < camera->width; x0 += SYNTH_TILE) {
            int32_t y0 = tile_y * SYNTH_TILE;
            synth_rect tile = {x0, y0, x0 + SYNTH_TILE, y0 + SYNTH_TILE};
            tile = synth_rect_grow(tile, 0, camera);
            synth_candidates candidates;
            synth_tile_candidates(j->scene, j->static_count, &j->color->view, tile, &candidates);
            for (int32_t y = tile.y0; y < tile.y1; y++) {
                for (int32_t x = tile.x0; x < tile.x1; x++) {
                    cast_pixel(j, &candidates, x, y);
                }
            }
        }
    }
}

static rlf_result create_room(synth_color *color, const synth_scene *scene, int32_t state)
{
    const rlf_camera *camera = &color->view.camera;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    synth_color_planes *planes = &color->room[state];
    planes->rgba = rlf_alloc_array(pixels, 4);
    planes->z = rlf_alloc_array(pixels, sizeof(float));
    planes->lamp = rlf_alloc(pixels);
    if (planes->rgba == NULL || planes->z == NULL || planes->lamp == NULL) {
        return RLF_ERROR_MEMORY;
    }
    job j = {color, scene, planes, scene->static_count - (state == 1 ? scene->removed_count : 0)};
    int32_t tile_rows = (camera->height + SYNTH_TILE - 1) / SYNTH_TILE;
    rlf_parallel_for(color->pool, tile_rows, 1, cast_tiles, &j);
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
    int32_t states = scene->removed_count > 0 ? 2 : 1;
    for (int32_t k = 0; k < states && result == RLF_OK; k++) {
        result = create_room(color, scene, k);
    }
    return result;
}

void synth_color_destroy(synth_color *color)
{
    for (int k = 0; k < 2; k++) {
        rlf_free(color->room[k].rgba);
        rlf_free(color->room[k].z);
        rlf_free(color->room[k].lamp);
    }
    rlf_free(color->paint);
    rlf_free(color->out);
    synth_canvas_destroy(&color->canvas);
    *color = (synth_color){.scene = NULL};
}
