/* What is real as patches that send light. */
#include "render/probe.h"

#define NEAREST_COSINE 0.2 /* of a patch to its ray: more slanted ones are noise */

/* Where the colour of a point of the surface is; NULL outside the picture. */
static const uint8_t *color_at(const rlf_rig *rig, const rlf_image_rgba8 *image, rlf_vec3 p)
{
    double u, v;
    if (!rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, p), &u, &v)) {
        return NULL;
    }
    u = (u + 0.5) * image->width / rig->color.width;
    v = (v + 0.5) * image->height / rig->color.height;
    if (!(u >= 0.0) || !(v >= 0.0) || !(u < image->width) || !(v < image->height)) {
        return NULL;
    }
    return rlf_rgba8_row(image, (int32_t)v) + 4 * (ptrdiff_t)(int32_t)u;
}

/* Unit, to the camera where it is not known. */
static rlf_vec3 normal_at(const rlf_surface *s, int32_t i, rlf_vec3 to_camera)
{
    const bool has = s->normal_x != NULL;
    const rlf_vec3 n = {has ? (double)s->normal_x[i] : 0.0, has ? (double)s->normal_y[i] : 0.0,
                        has ? (double)s->normal_z[i] : 0.0};
    return rlf_dot(n, n) > 0.5 ? n : to_camera;
}

/* One patch, `px` pixels of the surface wide. */
static void add_patch(probe_room *room, const rlf_surface *s, int32_t i, const uint8_t *color,
                      double px, const rlf_pose *T)
{
    const int32_t k = room->count++;
    const rlf_vec3 p = rlf_surface_point(s, i);
    const rlf_vec3 to_camera = rlf_scale(p, -1.0 / rlf_length(p));
    const rlf_vec3 n = normal_at(s, i, to_camera);
    const rlf_vec3 at = rlf_transform(T, p);
    const rlf_vec3 turned = rlf_rotate(T->q, n);
    const double cosine = rlf_max(rlf_dot(n, to_camera), NEAREST_COSINE);
    const float place[3] = {(float)at.x, (float)at.y, (float)at.z};
    const float normal[3] = {(float)turned.x, (float)turned.y, (float)turned.z};
    for (int c = 0; c < 3; c++) {
        const float code = (float)color[c] * (1.0f / 255.0f);
        room->p[c][k] = place[c];
        room->n[c][k] = normal[c];
        room->light[c][k] = code * code;
    }
    room->area[k] = (float)(p.z * p.z * px * px / (s->camera.fx * s->camera.fy * cosine));
}

/* Mean radiance, and that of the lighter parts: light of one lamp on black and white makes the mean
 * darker, but not those. */
static void find_means(probe_room *room)
{
    float sum[3] = {0.0f, 0.0f, 0.0f};
    float square = 0.0f;
    float all = 0.0f;
    for (int32_t k = 0; k < room->count; k++) {
        float grey = 0.0f;
        for (int c = 0; c < 3; c++) {
            sum[c] += room->light[c][k];
            grey += room->light[c][k];
        }
        all += grey;
        square += grey * grey;
    }
    for (int c = 0; c < 3; c++) {
        room->mean[c] = room->count > 0 ? sum[c] / (float)room->count : 0.0f;
    }
    room->bright = all > 0.0f ? square / all : 0.0f;
}

void probe_room_read(probe_room *room, const rlf_rig *rig, const rlf_frame *frame,
                     const rlf_surface *surface, const rlf_pose *T_picture_depth)
{
    int32_t step = 1;
    room->count = 0;
    while ((surface->width / step + 1) * (surface->height / step + 1) > PROBE_PATCHES) {
        step++;
    }
    const bool has_all = frame->color.data != NULL && surface->depth != NULL && rig->has_color;
    for (int32_t y = step / 2; has_all && y < surface->height; y += step) {
        for (int32_t x = step / 2; x < surface->width; x += step) {
            const int32_t i = y * surface->width + x;
            const uint8_t *color = surface->depth[i] > 0.0f
                                       ? color_at(rig, &frame->color, rlf_surface_point(surface, i))
                                       : NULL;
            if (color != NULL) {
                add_patch(room, surface, i, color, step, T_picture_depth);
            }
        }
    }
    find_means(room);
}
