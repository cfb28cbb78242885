/* Blob shadows. The floor is level and so is the camera: a picture row is a line of constant z on
 * the floor, so the ellipses are drawn row by row. */
#include "sim/stamp.h"
#include "sim/material.h"
#include "kernel/kernel.h"

#define ROW_MAX 4096
#define PENUMBRA 0.06       /* metres of softness per metre between ball and floor */
#define CONTACT_HEIGHT 0.15 /* metres */

#define LEAST_RADIUS 0.035 /* metres; smaller solids of a random room, as fingers, throw none */

static rlf_vec3 to_level(const synth_shadow *shadow, rlf_vec3 p)
{
    return shadow->is_tilted ? rlf_rotate(shadow->q_level_camera, p) : p;
}

/* Shadow of the ball about c: projected from the lamp to the floor; softer and weaker with height.
 */
static void add_blob(synth_shadow *shadow, const synth_scene *scene, rlf_vec3 c, double radius)
{
    const rlf_vec3 lamp = to_level(shadow, scene->lamp);
    const double floor_y = scene->floor_y;
    rlf_vec3 ray = rlf_sub(c, lamp);
    if (!(ray.y > 0.1) || shadow->blob_count >= SYNTH_BLOB_MAX) {
        return;
    }
    double s = (floor_y - lamp.y) / ray.y;
    double height = rlf_max(0.0, floor_y - c.y);
    double sharp = 1.25 * radius * s;
    double soft = sharp + PENUMBRA * height + 0.02;
    double level = sqrt(ray.x * ray.x + ray.z * ray.z);
    double stretch = rlf_min(rlf_length(ray) / ray.y, 2.0);
    synth_blob *blob = &shadow->blobs[shadow->blob_count++];
    blob->x = (float)(lamp.x + ray.x * s);
    blob->z = (float)(lamp.z + ray.z * s);
    blob->along_x = (float)(level > 0.0 ? ray.x / level : 1.0);
    blob->along_z = (float)(level > 0.0 ? ray.z / level : 0.0);
    blob->short_radius = (float)soft;
    blob->long_radius = (float)(soft * stretch);
    blob->strength = (float)(0.95 * sharp / soft);
}

/* What stands on the floor or is just above it also hides the room's light from the floor. */
static void add_contact(synth_shadow *shadow, rlf_vec3 c, double radius, double floor_y)
{
    double gap = rlf_max(0.0, floor_y - c.y - radius);
    if (gap > CONTACT_HEIGHT || shadow->blob_count >= SYNTH_BLOB_MAX) {
        return;
    }
    float reach = (float)(1.7 * radius + 0.5 * gap);
    float strength = (float)(0.7 * (1.0 - gap / CONTACT_HEIGHT));
    shadow->blobs[shadow->blob_count++] = (synth_blob){.x = (float)c.x,
                                                       .z = (float)c.z,
                                                       .along_x = 1.0f,
                                                       .long_radius = reach,
                                                       .short_radius = reach,
                                                       .strength = strength};
}

static void add_part(synth_shadow *shadow, const synth_scene *scene, const synth_shape *shape)
{
    if (shape->type != SYNTH_CONE && shape->type != SYNTH_FRUSTUM) {
        double radius = 0.5 * (shape->size.x + rlf_min(shape->size.y, shape->size.z));
        add_blob(shadow, scene, to_level(shadow, shape->T_camera_shape.p), radius);
        return;
    }
    if (shadow->is_tilted && shape->radius_a < LEAST_RADIUS) {
        return;
    }
    const int count = !shadow->is_tilted ? 3 : (shape->length < 4.0 * shape->radius_a ? 1 : 2);
    for (int i = 0; i < count; i++) {
        double share = (i + 0.5) / count;
        rlf_vec3 p = to_level(shadow, rlf_transform(&shape->T_camera_shape,
                                                    rlf_vec3_make(0, share * shape->length, 0)));
        double radius = shape->radius_a + (shape->radius_b - shape->radius_a) * share;
        add_blob(shadow, scene, p, radius);
        add_contact(shadow, p, radius, scene->floor_y);
    }
}

static void widen_rect(synth_rect *rect, const synth_blob *blob, const synth_view *view,
                       double floor_y)
{
    const rlf_camera *c = &view->camera;
    double r = blob->long_radius;
    double near = rlf_max(0.3, blob->z - r - view->origin.z);
    double far = rlf_max(0.3, blob->z + r - view->origin.z);
    double height = floor_y - view->origin.y;
    double left = blob->x - r - view->origin.x;
    double right = blob->x + r - view->origin.x;
    double u0 = c->cx + c->fx * (left < 0.0 ? left / near : left / far);
    double u1 = c->cx + c->fx * (right < 0.0 ? right / far : right / near);
    double v0 = c->cy + c->fy * height / far;
    double v1 = c->cy + c->fy * height / near;
    synth_rect box = {(int32_t)rlf_clamp(u0, 0, c->width), (int32_t)rlf_clamp(v0, 0, c->height),
                      (int32_t)rlf_clamp(u1 + 2, 0, c->width),
                      (int32_t)rlf_clamp(v1 + 2, 0, c->height)};
    *rect = synth_rect_union(*rect, box);
}

void synth_shadow_place(synth_shadow *shadow, const synth_scene *scene, const synth_view *view)
{
    shadow->blob_count = 0;
    shadow->rect = (synth_rect){0, 0, 0, 0};
    shadow->is_tilted = scene->q_camera_level != NULL;
    if (shadow->is_tilted) {
        shadow->q_level_camera = rlf_quat_conjugate(*scene->q_camera_level);
    }
    for (int32_t i = 0; i < scene->mover_count; i++) {
        add_part(shadow, scene, &scene->movers[i].shape);
    }
    for (int32_t i = 0; i < shadow->blob_count; i++) {
        synth_blob *blob = &shadow->blobs[i];
        if (shadow->is_tilted) {
            blob->rect = synth_shadow_rect(shadow, blob, view, scene->floor_y);
            shadow->rect = synth_rect_union(shadow->rect, blob->rect);
        } else {
            widen_rect(&shadow->rect, blob, view, scene->floor_y);
        }
    }
}

/* Multiplies light[i], pixel i of a row at floor depth z, by what the blob lets through: 1 - k (1 -
 * d^2)^2 for the normalised distance d < 1. */
RLF_KERNEL static void dim_row(const synth_blob blob, float x0, float step, float z,
                               float *restrict light, int32_t count)
{
    float dz = z - blob.z;
    if (dz > blob.long_radius || dz < -blob.long_radius) {
        return;
    }
    float first = (blob.x - blob.long_radius - x0) / step;
    float last = (blob.x + blob.long_radius - x0) / step + 1.0f;
    int32_t begin = first > 0.0f ? (first < (float)count ? (int32_t)first : count) : 0;
    int32_t end = last < (float)count ? (last > 0.0f ? (int32_t)last : 0) : count;
    for (int32_t i = begin; i < end; i++) {
        float dx = x0 + step * (float)i - blob.x;
        float along = (dx * blob.along_x + dz * blob.along_z) / blob.long_radius;
        float aside = (dx * blob.along_z - dz * blob.along_x) / blob.short_radius;
        float rest = 1.0f - along * along - aside * aside;
        rest = rest > 0.0f ? rest : 0.0f;
        light[i] *= 1.0f - blob.strength * rest * rest;
    }
}

/* Turns light into what code values are multiplied by, which go about with its square root: 1 where
 * the lamp is not seen anyway, or hardly any of it is lost. */
RLF_KERNEL static void find_factors(const uint8_t *restrict lamp, int32_t count,
                                    float *restrict light)
{
    for (int32_t i = 0; i < count; i++) {
        float linear = 1.0f - (1.0f - light[i]) * (float)lamp[i] * (1.0f / 255.0f);
        float factor = sqrtf(linear);
        factor = lamp[i] == 0 ? 1.0f : factor;
        light[i] = light[i] >= 0.999f ? 1.0f : factor;
    }
}

/* Times 1 a code value is itself. */
RLF_KERNEL static void darken_row(const float *restrict factor, int32_t count,
                                  uint8_t *restrict rgba)
{
    for (int32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            uint8_t *code = &rgba[4 * (size_t)i + (size_t)c];
            *code = (uint8_t)((float)*code * factor[i] + 0.5f);
        }
    }
}

/* A level camera's row is a line on the floor; false where it looks over it. */
static bool dim_level(const synth_shadow *shadow, const synth_view *view, double floor_y, int32_t y,
                      float *light)
{
    const rlf_camera *camera = &view->camera;
    const int32_t count = shadow->rect.x1 - shadow->rect.x0;
    double slope = (y - camera->cy) / camera->fy;
    if (slope <= 0.01) {
        return false;
    }
    double z = (floor_y - view->origin.y) / slope;
    double x0 = view->origin.x + z * (shadow->rect.x0 - camera->cx) / camera->fx;
    for (int32_t k = 0; k < shadow->blob_count; k++) {
        dim_row(shadow->blobs[k], (float)x0, (float)(z / camera->fx), (float)z, light, count);
    }
    return true;
}

void synth_shadow_apply(const synth_shadow *shadow, const synth_view *view, double floor_y,
                        int32_t y, const uint8_t *lamp, uint8_t *rgba)
{
    const rlf_camera *camera = &view->camera;
    float light[ROW_MAX];
    int32_t count = shadow->rect.x1 - shadow->rect.x0;
    if (count <= 0 || count > ROW_MAX) {
        return;
    }
    for (int32_t i = 0; i < count; i++) {
        light[i] = 1.0f;
    }
    if (shadow->is_tilted) {
        synth_shadow_dim(shadow, view, floor_y, y, light);
    } else if (!dim_level(shadow, view, floor_y, y, light)) {
        return;
    }
    const size_t first = (size_t)y * (size_t)camera->width + (size_t)shadow->rect.x0;
    find_factors(lamp + first, count, light);
    darken_row(light, count, rgba + 4 * first);
}
