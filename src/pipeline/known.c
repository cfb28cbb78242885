/* Models of real things: poses, bodies, and the grid beside them. */
#include "pipeline/known.h"

#include <stdio.h>
#include <string.h>

rlf_result known_models_create(const rlf_scene *scene, known_models *out)
{
    memset(out, 0, sizeof(*out));
    int32_t count = scene != NULL ? scene->known_count : 0;
    if (count > RLF_KNOWN_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY, "scene: %d known objects, at most %d", (int)count,
                        RLF_KNOWN_MAX);
    }
    out->defs = rlf_alloc_array(RLF_KNOWN_MAX, sizeof(*out->defs));
    if (out->defs == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < count; i++) {
        out->defs[out->count++] = scene->known[i];
    }
    return RLF_OK;
}

void known_models_destroy(known_models *models)
{
    known_layer_destroy(&models->layer);
    rlf_free(models->defs);
    rlf_free(models->depth);
    rlf_free(models->mask);
    memset(models, 0, sizeof(*models));
}

/* ---- bodies --------------------------------------------------------------------------------- */

static bool is_ready(const rlf_known_def *def)
{
    return def->has_pose && def->point_count == 0;
}

static rlf_result add_body(known_models *models, int32_t index, rlf_world *world)
{
    const rlf_known_def *def = &models->defs[index];
    rlf_body_def body = rlf_body_def_default();
    memcpy(body.name, def->name, sizeof(body.name));
    if (body.name[0] == '\0') {
        (void)snprintf(body.name, sizeof(body.name), "known-%d", (int)index + 1);
    }
    body.is_real = true;
    body.shape = def->shape;
    body.look = def->look;
    body.position = def->T_world_model.p;
    body.orientation = def->T_world_model.q;
    body.collides_with_bodies = def->collides;
    body.restitution = def->restitution;
    body.friction = def->friction;
    rlf_result result = rlf_world_add_body(world, &body, &models->ids[index]);
    return result == RLF_OK
               ? result
               : rlf_fail(result, "known object \"%s\": %s", body.name, rlf_error_text());
}

rlf_result known_models_start(known_models *models, rlf_world *world)
{
    memset(models->ids, 0, sizeof(models->ids));
    for (int32_t i = 0; i < models->count; i++) {
        rlf_result result = is_ready(&models->defs[i]) ? add_body(models, i, world) : RLF_OK;
        if (result != RLF_OK) {
            return result;
        }
    }
    return RLF_OK;
}

rlf_result known_models_solve(known_models *models, const rlf_known_view *view, rlf_world *world)
{
    for (int32_t i = 0; i < models->count; i++) {
        rlf_known_def *def = &models->defs[i];
        rlf_known_fit fit;
        if (def->point_count == 0) {
            continue;
        }
        rlf_result result = rlf_known_solve(def, view, &fit);
        if (result == RLF_OK) {
            def->T_world_model = fit.T_world_model;
            def->has_pose = true;
            def->point_count = 0;
            result = add_body(models, i, world);
        }
        if (result != RLF_OK) {
            return result;
        }
    }
    return RLF_OK;
}

rlf_result known_models_put(known_models *models, const rlf_known_def *def, rlf_world *world)
{
    int32_t index = 0;
    while (index < models->count && strcmp(models->defs[index].name, def->name) != 0) {
        index++;
    }
    if (index == RLF_KNOWN_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY, "all %d known objects are in use", RLF_KNOWN_MAX);
    }
    rlf_known_def before = models->defs[index];
    rlf_body_id old = index < models->count ? models->ids[index] : (rlf_body_id){0, 0};
    models->defs[index] = *def;
    rlf_result result = add_body(models, index, world);
    if (result != RLF_OK) {
        models->defs[index] = before;
        return result;
    }
    rlf_world_remove_body(world, old);
    models->count += index == models->count ? 1 : 0;
    return RLF_OK;
}

/* ---- grid ----------------------------------------------------------------------------------- */

static rlf_result create_layer(known_models *models, const rlf_surface *surface)
{
    size_t count = (size_t)surface->width * (size_t)surface->height;
    models->depth = rlf_alloc_array(count, sizeof(float));
    models->mask = rlf_alloc_array(count, 1);
    if (models->depth == NULL || models->mask == NULL) {
        return RLF_ERROR_MEMORY;
    }
    models->has_layer = true;
    return known_layer_create(&surface->camera, &surface->camera, &surface->noise, &models->layer);
}

static known_seen seen_of(const rlf_grid_sheet *sheet)
{
    const known_seen seen = {sheet->depth, sheet->normal_x, sheet->normal_y, sheet->normal_z};
    return seen;
}

rlf_result known_models_clear_grid(known_models *models, const rlf_surface *surface,
                                   const rlf_snapshot *snapshot, rlf_grid *grid)
{
    if (snapshot->known_count == 0) {
        return RLF_OK;
    }
    rlf_pose T_grid_world = rlf_pose_invert(&grid->T_world_grid);
    rlf_result result = models->has_layer ? RLF_OK : create_layer(models, surface);
    const int64_t version = models->layer.version;
    if (result == RLF_OK) {
        result = known_layer_place(&models->layer, snapshot, &T_grid_world);
    }
    if (result != RLF_OK) {
        return result;
    }
    size_t count = (size_t)grid->width * (size_t)grid->height;
    memcpy(models->depth, grid->background.depth, count * sizeof(float));
    const known_seen back = seen_of(&grid->background), front = seen_of(&grid->foreground);
    known_layer_clear(&models->layer, &back, models->depth, NULL);
    grid->background.depth = models->depth;
    if (models->layer.version != version) {
        grid->background.version = 0; /* as surveyed, but not as cleared before */
    }
    if (grid->foreground.depth != NULL && grid->foreground.mask != NULL) {
        memcpy(models->mask, grid->foreground.mask, count);
        known_layer_clear(&models->layer, &front, NULL, models->mask);
        grid->foreground.mask = models->mask;
    }
    return RLF_OK;
}
