/* Which pixels a model covers, and what they are worth. */
#include "known/layer.h"

#include <string.h>

/* What is sensed within this of a model, and three standard deviations of the sensor, is the model:
 * as much as a pose found from picks may be off. */
#define TOLERANCE_M 0.02
#define TOLERANCE_SIGMAS 3.0

rlf_result known_layer_create(const rlf_camera *camera, const rlf_camera *depth,
                              const rlf_depth_noise *noise, known_layer *out)
{
    memset(out, 0, sizeof(*out));
    out->camera = *camera;
    out->noise = *noise;
    /* Sensors mix or widen by up to two depth pixels at an edge. */
    out->reach = (int32_t)(2.0 * rlf_max(camera->fx / depth->fx, camera->fy / depth->fy) + 1.0);
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    out->at = rlf_alloc_array(pixels, sizeof(*out->at));
    out->nearest = rlf_alloc_array(pixels, sizeof(*out->nearest));
    out->shown = rlf_alloc(pixels);
    bool has_all = out->at != NULL && out->nearest != NULL && out->shown != NULL;
    return has_all ? RLF_OK : RLF_ERROR_MEMORY;
}

void known_layer_destroy(known_layer *layer)
{
    rlf_free(layer->pixels);
    rlf_free(layer->rims);
    rlf_free(layer->edges);
    rlf_free(layer->at);
    rlf_free(layer->nearest);
    rlf_free(layer->shown);
    rlf_free(layer->made);
    for (int32_t i = 0; i < layer->mesh_count; i++) {
        known_mesh_destroy(&layer->meshes[i]);
    }
    rlf_free(layer->meshes);
    memset(layer, 0, sizeof(*layer));
}

/* ---- making --------------------------------------------------------------------------------- */

static bool reserve_pixels(known_layer *l, int32_t more)
{
    void *fresh = known_reserve(l->pixels, l->count, more, &l->capacity, sizeof(*l->pixels));
    l->pixels = fresh != NULL ? fresh : l->pixels;
    return fresh != NULL;
}

static bool reserve_models(known_layer *l, int32_t count)
{
    void *fresh = known_reserve(l->made, 0, count, &l->made_capacity, sizeof(*l->made));
    l->made = fresh != NULL ? fresh : l->made;
    return fresh != NULL;
}

static double tolerance_at(const known_layer *layer, double z)
{
    return TOLERANCE_M + TOLERANCE_SIGMAS * rlf_depth_noise_sigma(&layer->noise, z);
}

/* One model's pixels, also into `at`. */
static bool add_pixels(known_layer *layer, const known_form *form, pixel_rect r)
{
    for (int32_t y = r.y0; y < r.y1; y++) {
        if (!reserve_pixels(layer, r.x1 - r.x0 + 1)) {
            return false;
        }
        for (int32_t x = r.x0; x < r.x1; x++) {
            rlf_vec3 ray;
            double z[2];
            if (known_form_cast(form, &layer->camera, x, y, &ray, z)) {
                int32_t index = y * layer->camera.width + x;
                layer->pixels[layer->count++] = (known_pixel){.index = index,
                                                              .model = layer->made_count,
                                                              .ray_x = (float)ray.x,
                                                              .ray_y = (float)ray.y,
                                                              .near = (float)z[0],
                                                              .far = (float)z[1],
                                                              .front = (float)z[0]};
                layer->at[index] = layer->count;
                float *nearest = &layer->nearest[index];
                *nearest = *nearest > 0.0f && *nearest < (float)z[0] ? *nearest : (float)z[0];
            }
        }
    }
    return true;
}

/* How much nearer a model gets within `reach` pixels of one, along a line of covered pixels. */
static float drop_along(const known_layer *layer, const known_pixel *p, int32_t step, int32_t reach)
{
    float least = p->near;
    for (int32_t side = -1; side <= 1; side += 2) {
        int32_t column = p->index % layer->camera.width;
        int32_t row = p->index / layer->camera.width;
        for (int32_t k = 1; k <= reach; k++) {
            column += step == 1 ? side : 0;
            row += step == 1 ? 0 : side;
            bool is_inside = column >= 0 && row >= 0 && column < layer->camera.width &&
                             row < layer->camera.height;
            int32_t at = is_inside ? layer->at[p->index + side * step * k] : 0;
            if (at == 0) {
                break;
            }
            least = layer->pixels[at - 1].near < least ? layer->pixels[at - 1].near : least;
        }
    }
    return p->near - least;
}

/* A sensor's pixel shows what is up to its own width aside: on a slant that is nearer. */
static void set_fronts(known_layer *layer, int32_t first)
{
    const int32_t reach = (layer->reach + 1) / 2;
    for (int32_t i = first; i < layer->count; i++) {
        known_pixel *p = &layer->pixels[i];
        float drop =
            drop_along(layer, p, 1, reach) + drop_along(layer, p, layer->camera.width, reach);
        p->tolerance = (float)tolerance_at(layer, p->near);
        p->front = p->near - drop - p->tolerance;
    }
}

/* The tree of a body's model, made when it is new; NULL without a model. */
static rlf_result find_mesh(known_layer *layer, const rlf_model *model, const known_mesh **out)
{
    *out = NULL;
    for (int32_t i = 0; model != NULL && i < layer->mesh_count; i++) {
        *out = known_mesh_id(layer->meshes[i]) == model->id ? layer->meshes[i] : *out;
    }
    if (model == NULL || *out != NULL) {
        return RLF_OK;
    }
    void *fresh = known_reserve(layer->meshes, layer->mesh_count, 1, &layer->mesh_capacity,
                                sizeof(known_mesh *));
    if (fresh == NULL) {
        return RLF_ERROR_MEMORY;
    }
    layer->meshes = fresh;
    rlf_result result = known_mesh_create(model, &layer->meshes[layer->mesh_count]);
    if (result == RLF_OK) {
        *out = layer->meshes[layer->mesh_count++];
    }
    return result;
}

static bool add_model(known_layer *layer, const rlf_body_state *model,
                      const rlf_pose *T_camera_world)
{
    rlf_pose T = rlf_pose_mul(T_camera_world, &model->T_world_body);
    double radius = known_form_radius(model);
    const known_mesh *mesh;
    if (find_mesh(layer, model->look.model, &mesh) != RLF_OK) {
        return false;
    }
    if (T.p.z + radius <= KNOWN_NEAREST_Z || !rlf_vec3_is_finite(T.p)) {
        return true;
    }
    int32_t first = layer->count;
    const known_form form = known_form_make(model, mesh, &T);
    pixel_rect r;
    (void)pixel_rect_of_ball(&layer->camera, T.p, radius, &r);
    bool is_done = add_pixels(layer, &form, r);
    if (is_done && layer->count > first) {
        set_fronts(layer, first);
        is_done = known_add_rims(layer, r) && known_add_edges(layer, &form, r);
    }
    for (int32_t i = first; i < layer->count; i++) {
        layer->at[layer->pixels[i].index] = 0;
    }
    return is_done;
}

static bool is_same_model(const rlf_body_state *a, const rlf_body_state *b)
{
    return memcmp(&a->T_world_body, &b->T_world_body, sizeof(rlf_pose)) == 0 &&
           memcmp(&a->shape.size, &b->shape.size, sizeof(rlf_vec3)) == 0 &&
           a->shape.type == b->shape.type && a->shape.radius == b->shape.radius &&
           a->shape.height == b->shape.height && a->shape.hull == b->shape.hull &&
           a->look.model == b->look.model && a->look.scale == b->look.scale &&
           memcmp(&a->look.offset, &b->look.offset, sizeof(rlf_vec3)) == 0;
}

static bool is_up_to_date(const known_layer *layer, const rlf_snapshot *snapshot,
                          const rlf_pose *T_camera_world)
{
    int32_t count = snapshot != NULL ? snapshot->known_count : 0;
    if (count != layer->made_count) {
        return false;
    }
    bool is_same = count == 0 || memcmp(T_camera_world, &layer->made_T, sizeof(rlf_pose)) == 0;
    for (int32_t i = 0; i < count && is_same; i++) {
        is_same = is_same_model(&snapshot->known[i], &layer->made[i]);
    }
    return is_same;
}

static void clear(known_layer *layer)
{
    layer->count = layer->rim_count = layer->edge_count = layer->made_count = 0;
}

rlf_result known_layer_place(known_layer *layer, const rlf_snapshot *snapshot,
                             const rlf_pose *T_camera_world)
{
    if (is_up_to_date(layer, snapshot, T_camera_world)) {
        return RLF_OK;
    }
    int32_t count = snapshot != NULL ? snapshot->known_count : 0;
    size_t pixels = (size_t)layer->camera.width * (size_t)layer->camera.height;
    clear(layer);
    layer->version++;
    memset(layer->shown, 0, pixels);
    memset(layer->nearest, 0, pixels * sizeof(*layer->nearest));
    if (count > 0 && !reserve_models(layer, count)) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < count; i++) {
        if (!add_model(layer, &snapshot->known[i], T_camera_world)) {
            clear(layer);
            return RLF_ERROR_MEMORY;
        }
        layer->made[layer->made_count++] = snapshot->known[i];
    }
    layer->made_T = *T_camera_world;
    return RLF_OK;
}
