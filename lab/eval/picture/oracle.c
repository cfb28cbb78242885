/* A surface as the colour camera would sense it, without noise and without parallax. */
#include "eval/picture/oracle.h"

#include "eval/oracle.h"
#include "eval/picture/truth.h"

#include <string.h>

#define TILE 16
#define AROUND 4 /* tiles that a silhouette looks at beyond those with bodies, at most */

static rlf_result create_camera(picture_oracle *o)
{
    const rlf_rig *rig = &rlf_source_get_info(o->source)->rig;
    const rlf_camera *camera = &rig->color;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    o->depth = rlf_alloc_array(pixels, sizeof(float));
    o->ray_x = rlf_alloc_array(pixels, sizeof(float));
    o->ray_y = rlf_alloc_array(pixels, sizeof(float));
    o->wanted = rlf_alloc_array(pixels, 1);
    if (o->depth == NULL || o->ray_x == NULL || o->ray_y == NULL || o->wanted == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (size_t i = 0; i < pixels; i++) {
        o->ray_x[i] = (float)(((double)(i % (size_t)camera->width) - camera->cx) / camera->fx);
        o->ray_y[i] = (float)(((double)(i / (size_t)camera->width) - camera->cy) / camera->fy);
    }
    o->T_depth_color = rlf_pose_invert(&rig->T_color_depth);
    o->seen = (rlf_surface){.width = camera->width,
                            .height = camera->height,
                            .scale_factor = 1,
                            .camera = *camera,
                            .noise = rig->noise,
                            .ray_x = o->ray_x,
                            .ray_y = o->ray_y,
                            .depth = o->depth};
    return RLF_OK;
}

rlf_result picture_oracle_create(rlf_source *source, int32_t parts, picture_oracle *out)
{
    *out = (picture_oracle){.parts = parts, .source = source};
    rlf_result result = RLF_OK;
    if ((parts & EVAL_ORACLE_SURFACE) != 0) {
        result = eval_oracle_create(source, parts, &out->surface);
    }
    if (result == RLF_OK && (parts & EVAL_ORACLE_CAMERA) != 0) {
        result = create_camera(out);
    }
    return result;
}

void picture_oracle_destroy(picture_oracle *o)
{
    eval_oracle_destroy(&o->surface);
    rlf_free(o->depth);
    rlf_free(o->ray_x);
    rlf_free(o->ray_y);
    rlf_free(o->wanted);
    *o = (picture_oracle){.parts = 0};
}

void picture_oracle_change_def(const picture_oracle *o, rlf_compositor_def *def)
{
    if ((o->parts & EVAL_ORACLE_CAMERA) == 0) {
        return;
    }
    def->rig.depth = def->rig.color;
    def->rig.T_color_depth = rlf_pose_identity();
    def->grid = def->rig.color;
    def->ray_x = o->ray_x;
    def->ray_y = o->ray_y;
    def->enable_real_shade = false;
    def->estimates_light_direction = false;
}

/* Marks the tiles with bodies and those AROUND them. */
static void find_tiles(picture_oracle *o, const picture_truth *t)
{
    const int32_t columns = (t->camera.width + TILE - 1) / TILE;
    const int32_t rows = (t->camera.height + TILE - 1) / TILE;
    memset(o->wanted, 0, (size_t)columns * (size_t)rows);
    for (int32_t k = 0; k < t->count; k++) {
        const int32_t x = t->pixels[k] % t->camera.width / TILE;
        const int32_t y = t->pixels[k] / t->camera.width / TILE;
        const int32_t x0 = x > AROUND ? x - AROUND : 0;
        const int32_t x1 = x + AROUND < columns ? x + AROUND : columns - 1;
        for (int32_t row = y > AROUND ? y - AROUND : 0; row <= y + AROUND && row < rows; row++) {
            memset(o->wanted + row * columns + x0, 1, (size_t)(x1 - x0 + 1));
        }
    }
}

static rlf_result cast_tile(picture_oracle *o, const picture_truth *t, int32_t x0, int32_t y0)
{
    rlf_vec3 rays[TILE * TILE];
    int32_t pixels[TILE * TILE];
    float z[TILE * TILE];
    int32_t count = 0;
    for (int32_t y = y0; y < y0 + TILE && y < t->camera.height; y++) {
        for (int32_t x = x0; x < x0 + TILE && x < t->camera.width; x++) {
            pixels[count] = y * t->camera.width + x;
            rays[count] = rlf_vec3_make(o->ray_x[pixels[count]], o->ray_y[pixels[count]], 1.0);
            count++;
        }
    }
    rlf_result result = rlf_synthetic_cast(o->source, t->origin, rays, count, z, NULL);
    for (int32_t k = 0; k < count; k++) {
        o->depth[pixels[k]] = z[k];
    }
    return result;
}

rlf_result picture_oracle_change_input(picture_oracle *o, const picture_truth *t,
                                       rlf_render_input *input)
{
    if (o->surface != NULL) {
        input->surface = eval_oracle_replace(o->surface, input->surface);
    }
    if ((o->parts & EVAL_ORACLE_CAMERA) == 0) {
        return RLF_OK;
    }
    const int32_t columns = (t->camera.width + TILE - 1) / TILE;
    const int32_t rows = (t->camera.height + TILE - 1) / TILE;
    rlf_result result = RLF_OK;
    find_tiles(o, t);
    for (int32_t i = 0; i < columns * rows && result == RLF_OK; i++) {
        if (o->wanted[i] != 0) {
            result = cast_tile(o, t, i % columns * TILE, i / columns * TILE);
        }
    }
    input->surface = &o->seen;
    input->T_world_camera = rlf_pose_mul(&input->T_world_camera, &o->T_depth_color);
    return result;
}

void picture_oracle_change_alpha(const picture_oracle *o, const picture_truth *t, float *alpha)
{
    for (int32_t k = 0; (o->parts & EVAL_ORACLE_PIXELS) != 0 && k < t->count; k++) {
        alpha[t->pixels[k]] = t->gap[t->pixels[k]] < 0.0f ? 1.0f : 0.0f;
    }
}
