/* The depth camera's view of the static room, cast once. */
#include "sim/depth.h"
#include "sim/material.h"

#include <string.h>

#define PIXELS ((size_t)SYNTH_DEPTH_WIDTH * SYNTH_DEPTH_HEIGHT)

/* One state of the room being cast. */
typedef struct job {
    synth_depth *depth;
    const synth_scene *scene;
    synth_depth_planes *planes;
    int32_t static_count;
} job;

static void store(const job *j, const synth_candidates *candidates, const synth_ray *ray,
                  synth_hit hit, size_t i)
{
    const synth_part *part = &j->scene->statics[hit.part];
    synth_depth_planes *planes = j->planes;
    rlf_vec3 normal = synth_shape_normal(&part->shape, synth_ray_at(ray, hit.t));
    double cosine = -rlf_dot(normal, ray->direction) / rlf_length(ray->direction);
    float z = (float)hit.t;
    planes->z[i] = z;
    planes->sigma[i] = synth_noise_sigma(&j->depth->noise, z, (float)cosine);
    planes->margin[i] =
        synth_noise_margin((float)synth_infrared(part), z, (float)cosine, j->depth->vignette[i]);
    if (synth_depth_is_stereo(j->depth)) {
        rlf_vec3 local =
            rlf_transform_inverse(&part->shape.T_camera_shape, synth_ray_at(ray, hit.t));
        planes->margin[i] = synth_noise_match(synth_look_texture(part, local));
    }
    if (planes->label == NULL) {
        return;
    }
    planes->normal[0][i] = (float)normal.x;
    planes->normal[1][i] = (float)normal.y;
    planes->normal[2][i] = (float)normal.z;
    planes->label[i] = part->label;
    planes->thickness[i] =
        synth_is_shell(part->label)
            ? 0.0f
            : (float)(synth_exit(j->scene->statics, candidates, part->label, ray, hit.t) - hit.t);
}

/* Rows of tiles; a pixel that sees nothing keeps the zeros it was allocated with. */
static void cast_tiles(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const job *j = context;
    const synth_view *view = &j->depth->view;
    (void)worker;
    for (int32_t tile_y = begin; tile_y < end; tile_y++) {
        for (int32_t x0 = 0; x0 < SYNTH_DEPTH_WIDTH; x0 += SYNTH_TILE) {
            int32_t y0 = tile_y * SYNTH_TILE;
            synth_rect tile = {x0, y0, x0 + SYNTH_TILE, y0 + SYNTH_TILE};
            tile = synth_rect_grow(tile, 0, &view->camera);
            synth_candidates candidates;
            synth_tile_candidates(j->scene, j->static_count, view, tile, &candidates);
            for (int32_t y = tile.y0; y < tile.y1; y++) {
                for (int32_t x = tile.x0; x < tile.x1; x++) {
                    synth_ray ray = synth_view_ray(view, x, y);
                    synth_hit hit = synth_cast(j->scene, &candidates, &ray);
                    if (hit.part >= 0) {
                        store(j, &candidates, &ray, hit, (size_t)y * SYNTH_DEPTH_WIDTH + (size_t)x);
                    }
                }
            }
        }
    }
}

static void find_jumps(const synth_depth_planes *planes)
{
    for (size_t y = 1; y + 1 < SYNTH_DEPTH_HEIGHT; y++) {
        const size_t first = y * SYNTH_DEPTH_WIDTH + 1;
        synth_noise_find_jumps(planes->z + first, SYNTH_DEPTH_WIDTH - 2, planes->jump + first);
    }
}

static rlf_result create_planes(synth_depth_planes *planes, bool enable_truth)
{
    planes->z = rlf_alloc_array(PIXELS, sizeof(float));
    planes->sigma = rlf_alloc_array(PIXELS, sizeof(float));
    planes->margin = rlf_alloc_array(PIXELS, sizeof(float));
    planes->jump = rlf_alloc(PIXELS);
    bool is_complete = planes->z != NULL && planes->sigma != NULL && planes->margin != NULL &&
                       planes->jump != NULL;
    if (enable_truth) {
        planes->thickness = rlf_alloc_array(PIXELS, sizeof(float));
        planes->label = rlf_alloc_array(PIXELS, sizeof(int32_t));
        is_complete = is_complete && planes->thickness != NULL && planes->label != NULL;
        for (int k = 0; k < 3; k++) {
            planes->normal[k] = rlf_alloc_array(PIXELS, sizeof(float));
            is_complete = is_complete && planes->normal[k] != NULL;
        }
    }
    return is_complete ? RLF_OK : RLF_ERROR_MEMORY;
}

static void destroy_planes(synth_depth_planes *planes)
{
    rlf_free(planes->z);
    rlf_free(planes->sigma);
    rlf_free(planes->margin);
    rlf_free(planes->jump);
    rlf_free(planes->thickness);
    rlf_free(planes->label);
    for (int k = 0; k < 3; k++) {
        rlf_free(planes->normal[k]);
    }
    *planes = (synth_depth_planes){.z = NULL};
}

static rlf_result create_frame(synth_depth *depth, bool enable_truth)
{
    const synth_drawn_noise *drawn = depth->noise.drawn;
    depth->vignette = rlf_alloc_array(PIXELS, sizeof(float));
    depth->out = rlf_alloc_array(PIXELS, sizeof(uint16_t));
    if (depth->vignette == NULL || depth->out == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (enable_truth) {
        depth->foreground = rlf_alloc(PIXELS);
        bool is_complete = depth->foreground != NULL;
        for (int k = 0; k < 3; k++) {
            depth->velocity[k] = rlf_alloc_array(PIXELS, sizeof(float));
            is_complete = is_complete && depth->velocity[k] != NULL;
        }
        if (!is_complete) {
            return RLF_ERROR_MEMORY;
        }
    }
    for (size_t i = 0; i < PIXELS; i++) {
        const double u = (double)(i % SYNTH_DEPTH_WIDTH), v = (double)(i / SYNTH_DEPTH_WIDTH);
        const bool is_even = drawn != NULL && drawn->has_even_light;
        depth->vignette[i] = is_even ? 1.0f : (float)synth_noise_vignette(u, v);
    }
    rlf_result result = synth_canvas_create(&depth->canvas, &depth->view);
    return result == RLF_OK ? create_planes(&depth->now, enable_truth) : result;
}

static void cast_room(synth_depth *depth, int32_t state)
{
    const synth_scene *scene = depth->scene;
    job j = {depth, scene, &depth->room[state],
             scene->static_count - (state == 1 ? scene->removed_count : 0)};
    const int32_t tile_rows = (SYNTH_DEPTH_HEIGHT + SYNTH_TILE - 1) / SYNTH_TILE;
    rlf_parallel_for(depth->pool, tile_rows, 1, cast_tiles, &j);
    find_jumps(&depth->room[state]);
}

static void clear_planes(synth_depth_planes *planes)
{
    memset(planes->z, 0, PIXELS * sizeof(float));
    memset(planes->sigma, 0, PIXELS * sizeof(float));
    memset(planes->margin, 0, PIXELS * sizeof(float));
    if (planes->label == NULL) {
        return;
    }
    memset(planes->thickness, 0, PIXELS * sizeof(float));
    memset(planes->label, 0, PIXELS * sizeof(int32_t));
    for (int k = 0; k < 3; k++) {
        memset(planes->normal[k], 0, PIXELS * sizeof(float));
    }
}

void synth_depth_cast_room(synth_depth *depth, int32_t state)
{
    clear_planes(&depth->room[state]);
    cast_room(depth, state);
    depth->room_index = depth->truth_room_index = -1; /* nothing of the last frame holds */
}

rlf_result synth_depth_create(synth_depth *depth, const synth_scene *scene, bool enable_truth)
{
    depth->scene = scene;
    depth->room_index = depth->truth_room_index = -1;
    rlf_result result = create_frame(depth, enable_truth);
    int32_t states = scene->removed_count > 0 ? 2 : 1;
    for (int32_t k = 0; k < states && result == RLF_OK; k++) {
        result = create_planes(&depth->room[k], enable_truth);
        if (result == RLF_OK) {
            cast_room(depth, k);
        }
    }
    return result;
}

void synth_depth_destroy(synth_depth *depth)
{
    destroy_planes(&depth->room[0]);
    destroy_planes(&depth->room[1]);
    destroy_planes(&depth->now);
    synth_canvas_destroy(&depth->canvas);
    rlf_free(depth->vignette);
    rlf_free(depth->out);
    rlf_free(depth->foreground);
    for (int k = 0; k < 3; k++) {
        rlf_free(depth->velocity[k]);
    }
    *depth = (synth_depth){.scene = NULL};
}
