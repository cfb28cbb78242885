/* Model files as bodies to throw: a hull around each. */
#include "run_window.h"

#include <stdio.h>
#include <string.h>

#define HULL_VERTICES 64

static double longest_side(const rlf_model *model)
{
    const rlf_vec3 size = rlf_sub(model->box.max, model->box.min);
    return rlf_max(size.x, rlf_max(size.y, size.z));
}

static rlf_result wrap(body_model *out)
{
    const rlf_model *model = out->model;
    const double longest = longest_side(model);
    if (!(longest > 0.0)) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: all its vertices are in one place: export it again",
                        out->path);
    }
    const double scale = out->size_m / longest;
    rlf_vec3 *points = rlf_alloc_array((size_t)model->vertex_count, sizeof(*points));
    if (points == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < model->vertex_count; i++) {
        const float *p = model->vertices[i].position;
        points[i] = rlf_scale(rlf_vec3_make(p[0], p[1], p[2]), scale);
    }
    rlf_vec3 centre;
    const rlf_result result =
        rlf_hull_create(points, model->vertex_count, HULL_VERTICES, &out->hull, &centre);
    rlf_free(points);
    out->look = (rlf_look){model, scale, rlf_neg(centre)};
    return result;
}

static const body_model *find(const body_models *models, const char *path, double size_m)
{
    for (int32_t i = 0; i < models->count; i++) {
        const body_model *m = &models->list[i];
        if (strcmp(m->path, path) == 0 && (!(size_m > 0.0) || m->size_m == size_m)) {
            return m;
        }
    }
    return NULL;
}

static rlf_result load(body_models *models, const char *path, double size_m, const body_model **out)
{
    body_model *m = &models->list[models->count];
    const body_model *same = find(models, path, 0.0);
    if (models->count == BODY_MODELS_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY, "more than %d models and sizes: start again",
                        BODY_MODELS_MAX);
    }
    *m = (body_model){.size_m = size_m, .owns_model = same == NULL};
    (void)snprintf(m->path, sizeof m->path, "%s", path);
    m->model = same != NULL ? same->model : NULL;
    rlf_result result = same != NULL ? RLF_OK : rlf_model_load(path, &m->model);
    if (result == RLF_OK) {
        result = wrap(m);
    }
    if (result != RLF_OK && m->owns_model) {
        rlf_model_destroy(&m->model);
    }
    models->count += result == RLF_OK ? 1 : 0;
    *out = m;
    return result;
}

rlf_result body_models_load(body_models *models, const char *path, double size_m,
                            rlf_shape *out_shape, rlf_look *out_look)
{
    const body_model *m = find(models, path, size_m);
    const rlf_result result = m != NULL ? RLF_OK : load(models, path, size_m, &m);
    if (result == RLF_OK) {
        *out_shape = (rlf_shape){.type = RLF_SHAPE_HULL, .hull = m->hull};
        *out_look = m->look;
    }
    return result;
}

void body_models_destroy(body_models *models)
{
    for (int32_t i = 0; i < models->count; i++) {
        rlf_free(models->list[i].hull);
        if (models->list[i].owns_model) {
            rlf_model_destroy(&models->list[i].model);
        }
    }
    models->count = 0;
}
