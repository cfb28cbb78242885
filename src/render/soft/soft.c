/* The CPU renderer: creation, and the order in which a picture is drawn. */
#include "render/soft/soft.h"

#include "base/checks.h"
#include "camera/checks.h"
#include "render/render.h"
#include "render/soft/passes.h"
#include "render/soft/draw.h"
#include "render/soft/views.h"

#include <string.h>

#define FACES_AT_START 16384
#define BODIES_AT_START 1024

static void destroy(void *self)
{
    soft *s = self;
    real_depth_destroy(&s->real);
    light_direction_destroy(&s->direction);
    edge_matte_destroy(&s->edges);
    for (int32_t i = 0; s->workers != NULL && i < s->worker_count; i++) {
        soft_group *group = &s->workers[i];
        for (int k = 0; k < SOFT_GROUP_ROWS; k++) {
            rlf_free(group->rows[k].inverse_z);
            rlf_free(group->rows[k].face);
            rlf_free(group->rows[k].sum[0]);
            rlf_free(group->rows[k].touched);
        }
        rlf_free(group->list);
        rlf_free(group->ends);
        rlf_free(group->crowd);
        rlf_free(group->tiles);
    }
    for (int32_t i = 0; s->shade_tiles != NULL && i < s->worker_count; i++) {
        rlf_free(s->shade_tiles[i]);
    }
    if (s->probes != NULL) {
        probe_set_destroy(s->probes);
    }
    if (s->finish != NULL) {
        finish_destroy(s->finish);
    }
    void *parts[17] = {s->workers,
                       s->image.data,
                       s->matte.data,
                       s->scene.faces,
                       s->scene.bodies,
                       s->corners,
                       s->column_left,
                       s->column_weight,
                       s->grid_image.data,
                       s->shade_tiles,
                       s->scene.casters,
                       s->scene.reach,
                       s->scene.real_shades,
                       s->scene.obscurances,
                       s->scene.skins,
                       s->probes,
                       s->finish};
    for (int i = 0; i < 17; i++) {
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

static rlf_result allocate_row(soft_row *row, size_t stride)
{
    row->inverse_z = rlf_alloc_array(SOFT_SAMPLES * stride, sizeof(float));
    row->face = rlf_alloc_array(SOFT_SAMPLES * stride, sizeof(int32_t));
    float *sums = rlf_alloc_array((SOFT_SUMS + 4) * stride, sizeof(float));
    row->sum[0] = sums;
    row->part_count = ((int32_t)stride + SOFT_PART - 1) / SOFT_PART;
    row->touched = rlf_alloc((size_t)row->part_count);
    if (row->inverse_z == NULL || row->face == NULL || sums == NULL || row->touched == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (size_t k = 0; k < SOFT_SUMS; k++) {
        row->sum[k] = sums + k * stride;
    }
    for (size_t k = 0; k < 4; k++) {
        row->layer[k] = sums + (SOFT_SUMS + k) * stride;
    }
    return RLF_OK;
}

static rlf_result allocate_workers(soft *s)
{
    s->worker_count = rlf_pool_worker_count(s->def.pool);
    s->workers = rlf_alloc_array((size_t)s->worker_count, sizeof(*s->workers));
    if (s->workers == NULL) {
        return RLF_ERROR_MEMORY;
    }
    int32_t lanes = (s->camera.width + SOFT_LANES - 1) / SOFT_LANES + 1;
    size_t stride = (size_t)lanes * SOFT_LANES;
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < s->worker_count; i++) {
        soft_group *group = &s->workers[i];
        group->width = s->camera.width;
        group->stride = (ptrdiff_t)stride;
        group->tiles = rlf_alloc_array(stride / EDGE_MATTE_TILE, sizeof(*group->tiles));
        group->crowd = rlf_alloc(stride / SOFT_CROWD_PX);
        result = group->tiles != NULL && group->crowd != NULL ? result : RLF_ERROR_MEMORY;
        for (int k = 0; k < SOFT_GROUP_ROWS && result == RLF_OK; k++) {
            result = allocate_row(&group->rows[k], stride);
        }
    }
    return result;
}

static rlf_result allocate_shade_tiles(soft *s)
{
    size_t columns = ((size_t)s->camera.width + SOFT_SHADE_WIDTH - 1) / SOFT_SHADE_WIDTH;
    s->shade_tiles = rlf_alloc_array((size_t)s->worker_count, sizeof(*s->shade_tiles));
    for (int32_t i = 0; s->shade_tiles != NULL && i < s->worker_count; i++) {
        s->shade_tiles[i] = rlf_alloc_array(columns, sizeof(**s->shade_tiles));
        if (s->shade_tiles[i] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    return s->shade_tiles != NULL ? RLF_OK : RLF_ERROR_MEMORY;
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
        result = allocate_workers(s);
    }
    if (result == RLF_OK) {
        result = allocate_shade_tiles(s);
    }
    if (result == RLF_OK) {
        result = soft_scene_reserve(s, FACES_AT_START);
    }
    s->matte = (rlf_plane_u8){rlf_alloc_array((size_t)width, (size_t)height), width, height, width};
    s->scene.body_capacity = BODIES_AT_START;
    s->scene.bodies = rlf_alloc_array(BODIES_AT_START, sizeof(*s->scene.bodies));
    s->scene.casters = rlf_alloc_array(BODIES_AT_START, sizeof(*s->scene.casters));
    s->scene.reach = rlf_alloc_array(BODIES_AT_START, sizeof(*s->scene.reach));
    s->scene.real_shades = rlf_alloc_array(BODIES_AT_START, sizeof(*s->scene.real_shades));
    s->scene.obscurances = rlf_alloc_array(BODIES_AT_START, sizeof(*s->scene.obscurances));
    s->probes = rlf_alloc(sizeof(*s->probes));
    s->finish = rlf_alloc(sizeof(*s->finish));
    s->corners = rlf_alloc_array(SHAPE_MESH_VERTEX_MAX, sizeof(*s->corners));
    s->corner_capacity = SHAPE_MESH_VERTEX_MAX;
    s->column_left = rlf_alloc_array((size_t)width, sizeof(*s->column_left));
    s->column_weight = rlf_alloc_array((size_t)width, sizeof(*s->column_weight));
    if (result != RLF_OK || s->matte.data == NULL || s->scene.bodies == NULL ||
        s->scene.casters == NULL || s->scene.reach == NULL || s->scene.real_shades == NULL ||
        s->scene.obscurances == NULL || s->corners == NULL || s->probes == NULL ||
        s->finish == NULL || s->column_left == NULL || s->column_weight == NULL) {
        return RLF_ERROR_MEMORY;
    }
    probe_set_init(s->probes);
    return finish_create(width, height, s->finish);
}

static rlf_result check_def(const rlf_compositor_def *def)
{
    rlf_result result = rig_check(&def->rig, "compositor");
    if (result == RLF_OK) {
        result = rlf_camera_check(&def->grid, "compositor: grid");
    }
    if (result != RLF_OK) {
        return result;
    }
    if (def->width < 0 || def->width > RLF_IMAGE_SIZE_MAX || def->height < 0 ||
        def->height > RLF_IMAGE_SIZE_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "compositor: width x height is %d x %d; use 1 to %d, or 0 for the camera's "
                        "size",
                        (int)def->width, (int)def->height, RLF_IMAGE_SIZE_MAX);
    }
    double length = rlf_length(def->light_direction);
    if (!(length > 0.5) || !(length < 2.0)) {
        return rlf_fail(RLF_ERROR_INVALID, "compositor: light_direction is no unit vector");
    }
    for (int k = 0; k < 3; k++) {
        if (!(def->light_color[k] >= 0.0f && def->light_color[k] <= 1.0f)) {
            return rlf_fail(RLF_ERROR_INVALID, "compositor: light_color is not within 0 to 1");
        }
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

static void place_bodies(soft *s, const rlf_render_input *input)
{
    rlf_pose T_camera_world = rlf_pose_invert(&input->T_world_camera);
    rlf_pose T_picture_world = rlf_pose_mul(&s->T_picture_depth, &T_camera_world);
    const render_casters casters = {s->scene.casters, s->scene.caster_count, s->to_light};
    render_place_bodies(&s->edges, &s->camera, &T_picture_world, input->snapshot, &casters);
}

/* Over nothing the picture is as opaque as what was drawn. */
static void keep_matte(const soft *s)
{
    for (int32_t y = 0; y < s->image.height; y++) {
        const uint8_t *matte = rlf_u8_row(&s->matte, y);
        uint8_t *alpha = rlf_rgba8_row(&s->image, y) + 3;
        for (int32_t x = 0; x < s->image.width; x++) {
            alpha[4 * (ptrdiff_t)x] = matte[x];
        }
    }
}

static void draw_background_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    soft_draw_background(context, begin, end);
}

static rlf_result draw_camera(soft *s, const rlf_render_input *input)
{
    rlf_result result = soft_scene_build(s, input);
    if (result != RLF_OK) {
        return result;
    }
    bool has_bodies = s->scene.body_count > 0;
    bool has_edges = has_bodies && s->def.occlusion == RLF_OCCLUSION_SOFT;
    if (has_edges) {
        place_bodies(s, input);
    }
    if (has_bodies || (input->frame->color.data == NULL && !s->is_bare)) {
        const real_windows needed = soft_needed_depth(s, input);
        const observation now = render_observation(input);
        real_depth_read(&s->real, &now);
        soft_scene_light(s, input);
        result = real_depth_update(&s->real, &now, has_edges ? &s->edges : NULL, &needed);
    }
    if (result != RLF_OK) {
        return result;
    }
    soft_set_background(s, &input->frame->color);
    finish_look(s->finish, input->frame);
    if (has_edges && s->real.has_moved) {
        edge_matte_forget(&s->edges);
    }
    if (has_edges) {
        edge_matte_update(&s->edges, &s->real.z, real_depth_known(&s->real), input->frame);
    }
    if (has_bodies) {
        soft_draw_bodies(s, true);
    } else {
        rlf_parallel_for(s->def.pool, s->image.height, SOFT_BAND_ROWS, draw_background_rows, s);
    }
    if (s->is_bare) {
        keep_matte(s); /* and no camera's noise */
    } else if (has_bodies) {
        finish_picture(s->finish, s->def.pool, &s->image, &s->matte);
    }
    return RLF_OK;
}

/* All of the real depth, as the picture's camera sees it. */
static rlf_result see_real(soft *s, const rlf_render_input *input)
{
    const real_windows all = {{{0, 0, s->camera.width, s->camera.height}}, 1};
    const observation now = render_observation(input);
    real_depth_read(&s->real, &now);
    return real_depth_update(&s->real, &now, NULL, &all);
}

static rlf_result draw_mesh(soft *s, const rlf_render_input *input)
{
    rlf_result result = input->frame->color.data == NULL ? see_real(s, input) : RLF_OK;
    if (result != RLF_OK) {
        return result;
    }
    soft_set_background(s, &input->frame->color);
    rlf_parallel_for(s->def.pool, s->image.height, SOFT_BAND_ROWS, draw_background_rows, s);
    soft_draw_mesh(s, input->surface);
    return RLF_OK;
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
    room_light_update(&s->lamp, s->def.light_color, s->def.estimates_light, input->frame);
    light_direction_update(&s->direction, &s->def.rig, input->frame, input->surface);
    soft_set_viewpoint(s, &s->camera, &s->T_picture_depth);
    rlf_result result = soft_view_has_colors(input) ? see_real(s, input) : RLF_OK;
    if (result != RLF_OK) {
        return result;
    }
    s->is_bare = input->view == RLF_VIEW_BODIES;
    if (input->view == RLF_VIEW_CAMERA || s->is_bare) {
        result = draw_camera(s, input);
    } else if (input->view == RLF_VIEW_CONTACTS) {
        result = draw_camera(s, input);
        soft_draw_contacts(s, input);
    } else if (input->view == RLF_VIEW_KNOWN) {
        result = draw_camera(s, input);
        soft_draw_known(s, input);
    } else if (input->view == RLF_VIEW_HANDS) {
        result = draw_camera(s, input);
        soft_draw_marks(s, input);
    } else if (input->view == RLF_VIEW_POINTS) {
        clear_matte(s);
        result = soft_draw_points(s, input);
    } else if (input->view == RLF_VIEW_MAP) {
        clear_matte(s);
        result = soft_draw_map(s, input);
    } else if (input->view == RLF_VIEW_MESH) {
        result = draw_mesh(s, input);
    } else {
        clear_matte(s);
        soft_draw_view(s, input);
    }
    if (result != RLF_OK) {
        return result;
    }
    if (s->def.enable_overlay) {
        soft_draw_overlay(&s->image, input);
    }
    out->image = s->image;
    out->matte = s->matte;
    out->light_direction = s->direction.now;
    out->is_light_estimated = s->direction.is_known;
    return RLF_OK;
}

/* Texels with their neighbours, so that one load has all that bilinear filtering needs; edges
 * repeat. The patterns are grey: one channel says it all. */
static void pack_level(const uint8_t *level, int32_t size, uint32_t *out)
{
    for (int32_t y = 0; y < size; y++) {
        for (int32_t x = 0; x < size; x++) {
            const uint8_t *top = level + 4 * (ptrdiff_t)(y * size);
            const uint8_t *bottom = level + 4 * (ptrdiff_t)((y + 1) % size * size);
            ptrdiff_t left = 4 * (ptrdiff_t)x;
            ptrdiff_t right = 4 * (ptrdiff_t)((x + 1) % size);
            *out++ = (uint32_t)top[left] | (uint32_t)top[right] << 8 |
                     (uint32_t)bottom[left] << 16 | (uint32_t)bottom[right] << 24;
        }
    }
}

static rlf_result make_textures(soft *s)
{
    uint8_t *bytes = rlf_alloc(BODY_TEXTURE_BYTES);
    if (bytes == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int kind = 0; kind < BODY_TEXTURE_KINDS; kind++) {
        body_texture_fill((body_texture_kind)kind, bytes);
        for (int32_t level = 0; level < BODY_TEXTURE_LEVELS; level++) {
            size_t offset = body_texture_level_offset(level);
            pack_level(bytes + offset, BODY_TEXTURE_SIZE >> level, s->textures[kind] + offset / 4);
        }
    }
    rlf_free(bytes);
    return RLF_OK;
}

static rlf_result prepare(soft *s)
{
    rlf_result result = light_direction_create(
        s->def.light_direction, s->def.estimates_light_direction, &s->def.grid, &s->direction);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_camera camera = render_camera(&s->def);
    const rlf_pose T_picture_depth = render_pose(&s->def);
    soft_set_viewpoint(s, &camera, &T_picture_depth);
    shape_mesh_set_build(&s->meshes);
    shape_mesh_set_build_coarse(&s->coarse_meshes);
    result = make_textures(s);
    if (result == RLF_OK) {
        result = allocate(s);
    }
    if (result == RLF_OK) {
        const real_depth_def real = render_depth_def(&s->def);
        result = real_depth_create(&real, &s->real);
    }
    if (result == RLF_OK && s->def.occlusion == RLF_OCCLUSION_SOFT) {
        result = edge_matte_create(&s->camera, &s->def.rig.depth, s->def.pool, &s->edges);
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
