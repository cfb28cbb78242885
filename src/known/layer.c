/* Which pixels a model covers, and what they are worth. */
#include "known/layer.h"

#include <string.h>

/* What is sensed within this of a model, and three standard deviations of the sensor, is the model:
 * as much as a pose found from picks may be off. */
#define TOLERANCE_M 0.02
#define TOLERANCE_SIGMAS 3.0
#define NEAREST_Z 0.02 /* metres */
/* Depth jumps by more than this between a thing and what is behind its rim, metres. */
#define RIM_JUMP 0.05f
#define SLACK_M                                                                                    \
    0.2 /* a grazing ray meets what is near a model so far from where it meets the model */

rlf_result known_layer_create(const rlf_camera *camera, const rlf_camera *depth,
                              const rlf_depth_noise *noise, known_layer *out)
{
    memset(out, 0, sizeof(*out));
    out->camera = *camera;
    out->noise = *noise;
    /* Sensors mix or widen by up to two depth pixels at an edge. */
    out->reach = (int32_t)(2.0 * rlf_max(camera->fx / depth->fx, camera->fy / depth->fy) + 1.0);
    out->mask = rlf_alloc_array((size_t)camera->width, (size_t)camera->height);
    out->shown = rlf_alloc_array((size_t)camera->width, (size_t)camera->height);
    return out->mask != NULL && out->shown != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void known_layer_destroy(known_layer *layer)
{
    rlf_free(layer->pixels);
    rlf_free(layer->rims);
    rlf_free(layer->mask);
    rlf_free(layer->shown);
    rlf_free(layer->made);
    memset(layer, 0, sizeof(*layer));
}

/* ---- making --------------------------------------------------------------------------------- */

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct rect {
    int32_t x0, y0, x1, y1;
} rect;

/* The array with room for `more` further entries: it may move. NULL when there is no memory; the
 * old one is then still there. */
static void *reserve(void *array, int32_t count, int32_t more, int32_t *capacity, size_t size)
{
    if (count + more <= *capacity && array != NULL) {
        return array;
    }
    int32_t grown = 2 * (count + more);
    void *fresh = rlf_alloc_array((size_t)grown, size);
    if (fresh != NULL) {
        if (count > 0) {
            memcpy(fresh, array, (size_t)count * size);
        }
        rlf_free(array);
        *capacity = grown;
    }
    return fresh;
}

static bool reserve_pixels(known_layer *l, int32_t more)
{
    void *fresh = reserve(l->pixels, l->count, more, &l->capacity, sizeof(*l->pixels));
    l->pixels = fresh != NULL ? fresh : l->pixels;
    return fresh != NULL;
}

static bool reserve_rims(known_layer *l, int32_t more)
{
    void *fresh = reserve(l->rims, l->rim_count, more, &l->rim_capacity, sizeof(*l->rims));
    l->rims = fresh != NULL ? fresh : l->rims;
    return fresh != NULL;
}

static bool reserve_models(known_layer *l, int32_t count)
{
    void *fresh = reserve(l->made, 0, count, &l->made_capacity, sizeof(*l->made));
    l->made = fresh != NULL ? fresh : l->made;
    return fresh != NULL;
}

/* Where a ball about `center` may be; a lens bends by less than the margin, and what reaches behind
 * the camera may be anywhere. */
static rect bound(const rlf_camera *camera, rlf_vec3 center, double radius)
{
    const double margin = 0.1;
    rect all = {0, 0, camera->width, camera->height};
    double z = center.z - radius;
    if (!(z > NEAREST_Z)) {
        return all;
    }
    double x[2] = {(center.x - radius) / (center.x < radius ? z : center.z + radius),
                   (center.x + radius) / (center.x > -radius ? z : center.z + radius)};
    double y[2] = {(center.y - radius) / (center.y < radius ? z : center.z + radius),
                   (center.y + radius) / (center.y > -radius ? z : center.z + radius)};
    for (int i = 0; i < 2; i++) {
        double sign = i == 0 ? -1.0 : 1.0;
        double lens = camera->distortion_model == RLF_DISTORTION_NONE ? 0.0 : margin;
        x[i] = camera->cx + camera->fx * (x[i] + sign * lens) + 2.0 * sign;
        y[i] = camera->cy + camera->fy * (y[i] + sign * lens) + 2.0 * sign;
        x[i] = rlf_clamp(x[i], 0, camera->width);
        y[i] = rlf_clamp(y[i], 0, camera->height);
    }
    return (rect){(int32_t)x[0], (int32_t)y[0], (int32_t)x[1], (int32_t)y[1]};
}

static double tolerance_at(const known_layer *layer, double z)
{
    return TOLERANCE_M + TOLERANCE_SIGMAS * rlf_depth_noise_sigma(&layer->noise, z);
}

/* One model's pixels, also into the mask. */
static bool add_pixels(known_layer *layer, const rlf_shape *shape, const rlf_pose *T_camera_shape,
                       rect r)
{
    rlf_quat to_shape = rlf_quat_conjugate(T_camera_shape->q);
    rlf_vec3 origin = rlf_transform_inverse(T_camera_shape, rlf_vec3_make(0, 0, 0));
    for (int32_t y = r.y0; y < r.y1; y++) {
        if (!reserve_pixels(layer, r.x1 - r.x0 + 1)) {
            return false;
        }
        for (int32_t x = r.x0; x < r.x1; x++) {
            rlf_vec3 ray;
            double enter, leave;
            if (rlf_camera_unproject(&layer->camera, x, y, &ray) &&
                rlf_shape_cast(shape, origin, rlf_rotate(to_shape, ray), &enter, &leave) &&
                enter > NEAREST_Z) {
                int32_t index = y * layer->camera.width + x;
                double front = enter - tolerance_at(layer, enter);
                layer->pixels[layer->count++] =
                    (known_pixel){index,        layer->made_count, (float)ray.x, (float)ray.y,
                                  (float)enter, (float)leave,      (float)front, index};
                layer->mask[index] = 1;
            }
        }
    }
    return true;
}

/* Nearest covered pixel within reach; false when there is none. */
static bool nearest_covered(const known_layer *layer, int32_t x, int32_t y, int32_t out[2])
{
    int32_t best = layer->reach * layer->reach + 1;
    int32_t w = layer->camera.width, h = layer->camera.height;
    for (int32_t dy = -layer->reach; dy <= layer->reach; dy++) {
        for (int32_t dx = -layer->reach; dx <= layer->reach; dx++) {
            int32_t d2 = dx * dx + dy * dy;
            if (d2 < best && x + dx >= 0 && y + dy >= 0 && x + dx < w && y + dy < h &&
                layer->mask[(y + dy) * w + x + dx] != 0) {
                best = d2;
                out[0] = dx;
                out[1] = dy;
            }
        }
    }
    return best <= layer->reach * layer->reach;
}

/* The pixels around the mask, each with the depths of the covered pixel next to it, and the pixel
 * as far outside as `reach` and two more. `first`: the model's first covered pixel. */
static bool add_rims(known_layer *layer, rect r, const known_pixel *first)
{
    int32_t w = layer->camera.width, h = layer->camera.height, reach = layer->reach;
    const known_pixel *end = layer->pixels + layer->count;
    for (int32_t y = r.y0 > reach ? r.y0 - reach : 0; y < r.y1 + reach && y < h; y++) {
        if (!reserve_rims(layer, w)) {
            return false;
        }
        for (int32_t x = r.x0 > reach ? r.x0 - reach : 0; x < r.x1 + reach && x < w; x++) {
            int32_t d[2] = {0, 0};
            if (layer->mask[y * w + x] != 0 || !nearest_covered(layer, x, y, d)) {
                continue;
            }
            double scale = (reach + 2) / sqrt((double)(d[0] * d[0] + d[1] * d[1]));
            double bx = rlf_clamp(x + d[0] - d[0] * scale + 0.5, 0, w - 1);
            double by = rlf_clamp(y + d[1] - d[1] * scale + 0.5, 0, h - 1);
            int32_t covered = (y + d[1]) * w + x + d[0];
            const known_pixel *p = first; /* sorted by index: halve */
            for (ptrdiff_t count = end - first; count > 1;) {
                ptrdiff_t half = count / 2;
                p = p[half].index <= covered ? p + half : p;
                count -= half;
            }
            known_pixel *rim = &layer->rims[layer->rim_count];
            rlf_vec3 ray;
            if (rlf_camera_unproject(&layer->camera, x, y, &ray)) {
                *rim = *p;
                rim->index = y * w + x;
                rim->ray_x = (float)ray.x;
                rim->ray_y = (float)ray.y;
                rim->beyond = (int32_t)by * w + (int32_t)bx;
                layer->rim_count++;
            }
        }
    }
    return true;
}

static bool add_model(known_layer *layer, const rlf_body_state *model,
                      const rlf_pose *T_camera_world)
{
    rlf_pose T = rlf_pose_mul(T_camera_world, &model->T_world_body);
    double radius = rlf_shape_radius(&model->shape);
    if (T.p.z + radius <= NEAREST_Z || !rlf_vec3_is_finite(T.p)) {
        return true;
    }
    int32_t first = layer->count;
    rect r = bound(&layer->camera, T.p, radius);
    bool is_done = add_pixels(layer, &model->shape, &T, r) &&
                   (layer->count == first || add_rims(layer, r, layer->pixels + first));
    for (int32_t i = first; i < layer->count; i++) {
        layer->mask[layer->pixels[i].index] = 0;
    }
    return is_done;
}

static bool is_same_model(const rlf_body_state *a, const rlf_body_state *b)
{
    return memcmp(&a->T_world_body, &b->T_world_body, sizeof(rlf_pose)) == 0 &&
           memcmp(&a->shape.size, &b->shape.size, sizeof(rlf_vec3)) == 0 &&
           a->shape.type == b->shape.type && a->shape.radius == b->shape.radius &&
           a->shape.height == b->shape.height && a->shape.hull == b->shape.hull;
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

rlf_result known_layer_place(known_layer *layer, const rlf_snapshot *snapshot,
                             const rlf_pose *T_camera_world)
{
    if (is_up_to_date(layer, snapshot, T_camera_world)) {
        return RLF_OK;
    }
    int32_t count = snapshot != NULL ? snapshot->known_count : 0;
    layer->count = layer->rim_count = layer->made_count = 0;
    memset(layer->shown, 0, (size_t)layer->camera.width * (size_t)layer->camera.height);
    if (count > 0 && !reserve_models(layer, count)) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < count; i++) {
        if (!add_model(layer, &snapshot->known[i], T_camera_world)) {
            layer->count = layer->rim_count = layer->made_count = 0;
            return RLF_ERROR_MEMORY;
        }
        layer->made[layer->made_count++] = snapshot->known[i];
    }
    layer->made_T = *T_camera_world;
    return RLF_OK;
}

/* ---- use ------------------------------------------------------------------------------------ */

/* The sensor shows the model beside its silhouette, before something farther. */
static bool is_widened(const known_pixel *rim, const float *z)
{
    float at = z[rim->index], beyond = z[rim->beyond];
    float off = at > rim->near ? at - rim->near : rim->near - at;
    return at > 0.0f && off < rim->near - rim->front && beyond > at + RIM_JUMP;
}

void known_layer_cover(known_layer *layer, float *z)
{
    for (int32_t i = 0; i < layer->rim_count; i++) {
        const known_pixel *rim = &layer->rims[i];
        z[rim->index] = is_widened(rim, z) ? z[rim->beyond] : z[rim->index];
    }
    for (int32_t i = 0; i < layer->count; i++) {
        const known_pixel *p = &layer->pixels[i];
        float seen = z[p->index];
        bool is_before = seen > 0.0f && seen < p->front;
        z[p->index] = is_before ? seen : p->near;
        layer->shown[p->index] = is_before ? 0 : 1;
    }
}

static double absolute(double x)
{
    return x < 0.0 ? -x : x;
}

/* How far a shape reaches along the unit direction n from its centre. */
static double reach_along(const rlf_shape *s, rlf_vec3 n)
{
    double most = 0.0;
    switch (s->type) {
    case RLF_SHAPE_BOX:
        return 0.5 *
               (s->size.x * absolute(n.x) + s->size.y * absolute(n.y) + s->size.z * absolute(n.z));
    case RLF_SHAPE_SPHERE: return s->radius;
    case RLF_SHAPE_CAPSULE: return s->radius + 0.5 * s->height * absolute(n.y);
    case RLF_SHAPE_CYLINDER:
        return s->radius * sqrt(n.x * n.x + n.z * n.z) + 0.5 * s->height * absolute(n.y);
    case RLF_SHAPE_HULL: break;
    }
    for (int32_t i = 0; i < s->hull->vertex_count; i++) {
        most = rlf_max(most, rlf_dot(s->hull->vertices[i], n));
    }
    return most;
}

/* A sensed point near the model, of a face as far out as the model reaches that way. On a slant
 * depth is off along the ray, but mixed pixels are off across it, and have any of its normals; the
 * floor beside it faces up, far below its top. */
static bool is_beside(const known_layer *layer, const known_pixel *p, const known_seen *seen)
{
    const rlf_body_state *model = &layer->made[p->model];
    double z = seen->depth[p->index], tolerance = p->near - p->front;
    if (!(z > p->near - SLACK_M && z < p->far + SLACK_M) || seen->normal_x == NULL) {
        return false;
    }
    rlf_pose T = rlf_pose_mul(&layer->made_T, &model->T_world_body);
    rlf_vec3 point = rlf_vec3_make(z * p->ray_x, z * p->ray_y, z), gradient;
    rlf_vec3 local = rlf_transform_inverse(&T, point);
    rlf_vec3 normal =
        rlf_vec3_make(seen->normal_x[p->index], seen->normal_y[p->index], seen->normal_z[p->index]);
    normal = rlf_rotate(rlf_quat_conjugate(T.q), normal);
    return rlf_shape_distance(&model->shape, local, &gradient) < tolerance &&
           rlf_dot(normal, local) > reach_along(&model->shape, normal) - tolerance;
}

void known_layer_clear(const known_layer *layer, const known_seen *seen, float *depth,
                       uint8_t *mask)
{
    for (int32_t i = 0; i < layer->count + layer->rim_count; i++) {
        bool is_rim = i >= layer->count;
        const known_pixel *p = is_rim ? &layer->rims[i - layer->count] : &layer->pixels[i];
        float z = seen->depth[p->index];
        bool is_on = is_rim ? is_widened(p, seen->depth)
                            : z >= p->front && z <= p->far + (p->near - p->front);
        if (!is_on && !is_beside(layer, p, seen)) {
            continue;
        }
        if (mask != NULL) {
            mask[p->index] = 0;
        }
        if (depth != NULL) {
            depth[p->index] = 0.0f;
        }
    }
}
