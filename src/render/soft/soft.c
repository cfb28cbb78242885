/* The CPU renderer: creation, and the order in which a picture is drawn. */
#include "render/soft/soft.h"

#include "base/cookie.h"

#include <string.h>

#define TRIANGLES_AT_START 16384
#define BODIES_AT_START 1024

static void destroy(void *self)
{
    soft *s = self;
    real_depth_destroy(&s->real);
    silhouette_destroy(&s->silhouette);
    for (int32_t i = 0; s->bands != NULL && i < s->band_count; i++) {
        rlf_free(s->bands[i].inverse_z);
        rlf_free(s->bands[i].triangle);
        rlf_free(s->bands[i].layer);
    }
    void *parts[9] = {s->bands,           s->image.data,    s->matte.data,
                      s->scene.triangles, s->scene.bodies,  s->corners,
                      s->column_left,     s->column_weight, s->grid_image.data};
    for (int i = 0; i < 9; i++) {
        rlf_free(parts[i]);
    }
    rlf_free(s);
}

static rlf_result allocate_image(rlf_image_rgba8 *image, int32_t width, int32_t height)
{
    image->width = width;
    image->height = height;
    image->stride = 4 * (ptrdiff_t)width;
    image->data = rlf_alloc_array((size_t)width * (size_t)height, 4);
    return image->data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

static rlf_result allocate_bands(soft *s)
{
    s->band_count = rlf_pool_worker_count(s->def.pool);
    s->bands = rlf_alloc_array((size_t)s->band_count, sizeof(*s->bands));
    if (s->bands == NULL) {
        return RLF_ERROR_MEMORY;
    }
    size_t pixels = (size_t)s->camera.width * SOFT_BAND_ROWS;
    size_t samples = pixels * SOFT_SAMPLES;
    bool has_layers = s->def.occlusion == RLF_OCCLUSION_THESIS;
    for (int32_t i = 0; i < s->band_count; i++) {
        s->bands[i].inverse_z = rlf_alloc_array(samples, sizeof(float));
        s->bands[i].triangle = rlf_alloc_array(samples, sizeof(int32_t));
        s->bands[i].layer = has_layers ? rlf_alloc_array(pixels, 4 * sizeof(float)) : NULL;
        if (s->bands[i].inverse_z == NULL || s->bands[i].triangle == NULL ||
            (has_layers && s->bands[i].layer == NULL)) {
            return RLF_ERROR_MEMORY;
        }
    }
    return RLF_OK;
}

static rlf_result allocate(soft *s)
{
    int32_t width = s->camera.width;
    int32_t height = s->camera.height;
    rlf_result result = allocate_image(&s->image, width, height);
    if (result == RLF_OK) {
        result = allocate_image(&s->grid_image, s->def.grid.width, s->def.grid.height);
    }
    if (result == RLF_OK) {
        result = allocate_bands(s);
    }
    if (result == RLF_OK) {
        result = soft_scene_reserve(&s->scene, TRIANGLES_AT_START);
    }
    s->matte = (rlf_plane_u8){rlf_alloc_array((size_t)width, (size_t)height), width, height, width};
    s->scene.body_capacity = BODIES_AT_START;
    s->scene.bodies = rlf_alloc_array(BODIES_AT_START, sizeof(*s->scene.bodies));
    s->corners = rlf_alloc_array(SHAPE_MESH_VERTEX_MAX, sizeof(*s->corners));
    s->column_left = rlf_alloc_array((size_t)width, sizeof(*s->column_left));
    s->column_weight = rlf_alloc_array((size_t)width, sizeof(*s->column_weight));
    if (result != RLF_OK || s->matte.data == NULL || s->scene.bodies == NULL ||
        s->corners == NULL || s->column_left == NULL || s->column_weight == NULL) {
        return RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

static rlf_result check_def(const rlf_compositor_def *def)
{
    rlf_result result = rlf_camera_check(&def->rig.depth, "compositor: depth camera");
    if (result == RLF_OK && def->rig.has_color) {
        result = rlf_camera_check(&def->rig.color, "compositor: colour camera");
    }
    if (result == RLF_OK) {
        result = rlf_camera_check(&def->grid, "compositor: grid");
    }
    if (result != RLF_OK) {
        return result;
    }
    if (def->width < 0 || def->width > RLF_IMAGE_SIZE_MAX || def->height < 0 ||
        def->height > RLF_IMAGE_SIZE_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "compositor: picture of %d x %d; use 1 to %d, or 0 for the camera's size",
                        (int)def->width, (int)def->height, RLF_IMAGE_SIZE_MAX);
    }
    double length = rlf_length(def->light_direction);
    if (!(length > 0.5) || !(length < 2.0)) {
        return rlf_fail(RLF_ERROR_INVALID, "compositor: light_direction is no unit vector");
    }
    if ((int)def->occlusion < 0 || def->occlusion > RLF_OCCLUSION_SOFT) {
        return rlf_fail(RLF_ERROR_INVALID, "compositor: unknown occlusion %d", (int)def->occlusion);
    }
    return RLF_OK;
}

/* ---- one picture ---------------------------------------------------------------------------- */

static void clear_matte(soft *s)
{
    memset(s->matte.data, 0, (size_t)s->matte.width * (size_t)s->matte.height);
}

/* What the real world is like where the bodies are. */
static void update_silhouette(soft *s, const rlf_render_input *input)
{
    rlf_pose T_camera_world = rlf_pose_invert(&input->T_world_camera);
    rlf_pose T_picture_world = rlf_pose_mul(&s->T_picture_depth, &T_camera_world);
    silhouette_place(&s->silhouette, &s->camera, &T_picture_world, input->snapshot);
    silhouette_update(&s->silhouette, &s->real.z, input->frame);
}

static rlf_result draw_camera(soft *s, const rlf_render_input *input)
{
    rlf_result result = soft_scene_build(s, input);
    if (result != RLF_OK) {
        return result;
    }
    bool has_color = input->frame->color.data != NULL;
    if (!has_color || s->scene.body_count > 0) {
        real_depth_update(&s->real, input->frame, input->surface);
    }
    soft_draw_background(s, input);
    if (s->scene.body_count > 0 && s->def.occlusion == RLF_OCCLUSION_SOFT) {
        update_silhouette(s, input);
    }
    if (s->scene.body_count > 0) {
        soft_draw_bodies(s);
    }
    return RLF_OK;
}

static void draw_mesh(soft *s, const rlf_render_input *input)
{
    if (input->frame->color.data == NULL) {
        real_depth_update(&s->real, input->frame, input->surface);
    }
    soft_draw_background(s, input);
    soft_draw_mesh(s, input->surface);
}

static rlf_result render(void *self, const rlf_render_input *input, rlf_render_output *out)
{
    soft *s = self;
    if (input->surface->width != s->def.grid.width ||
        input->surface->height != s->def.grid.height) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "compositor: the surface is %d x %d, made for a grid of %d x %d",
                        (int)input->surface->width, (int)input->surface->height,
                        (int)s->def.grid.width, (int)s->def.grid.height);
    }
    clear_matte(s);
    rlf_result result = RLF_OK;
    if (input->view == RLF_VIEW_CAMERA) {
        result = draw_camera(s, input);
    } else if (input->view == RLF_VIEW_MESH) {
        draw_mesh(s, input);
    } else {
        soft_draw_view(s, input);
    }
    if (result != RLF_OK) {
        return result;
    }
    if (s->def.enable_overlay) {
        soft_draw_overlay(s, input);
    }
    out->image = s->image;
    out->matte = s->matte;
    return RLF_OK;
}

static rlf_result prepare(soft *s)
{
    s->camera = real_depth_picture_camera(&s->def);
    s->T_picture_depth = real_depth_picture_pose(&s->def);
    s->def.light_direction = rlf_normalize(s->def.light_direction);
    shape_mesh_set_build(&s->meshes);
    for (int kind = 0; kind < BODY_TEXTURE_KINDS; kind++) {
        body_texture_fill((body_texture_kind)kind, s->textures[kind]);
    }
    rlf_result result = allocate(s);
    if (result == RLF_OK) {
        result = real_depth_create(&s->def, &s->camera, &s->real);
    }
    if (result == RLF_OK && s->def.occlusion == RLF_OCCLUSION_SOFT) {
        result = silhouette_create(&s->camera, &s->def.rig.depth, s->def.pool, &s->silhouette);
    }
    return result;
}

rlf_result rlf_compositor_create_soft(const rlf_compositor_def *def, rlf_compositor **out)
{
    static const rlf_compositor_methods methods = {render, destroy, "soft"};
    if (!RLF_ASSERT(def != NULL && out != NULL) || !RLF_ASSERT(def->cookie == RLF_DEF_COOKIE) ||
        !RLF_ASSERT(def->ray_x != NULL && def->ray_y != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = check_def(def);
    if (result != RLF_OK) {
        return result;
    }
    soft *s = rlf_alloc(sizeof(*s));
    if (s == NULL) {
        return RLF_ERROR_MEMORY;
    }
    s->def = *def;
    result = prepare(s);
    if (result == RLF_OK) {
        result = rlf_compositor_create_custom(&methods, s, out);
    }
    if (result != RLF_OK) {
        destroy(s);
    }
    return result;
}
