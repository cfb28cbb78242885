/* Places that were free, or hidden by what has left, are not fused yet. */
#include "pipeline/moving/moving.h"

#include "camera/pixels.h"

#include <string.h>

#define APART_NS 500000000 /* between two looks */
#define OFF_M 0.05         /* what is off by more than this, */
#define OFF_SIGMAS 6.0     /* and by more than this, is elsewhere */

enum { CELL = 4 }; /* pixels */

rlf_result settled_open(settled *t, const rlf_camera *camera, const rlf_depth_noise *noise)
{
    *t = (settled){.camera = *camera, .noise = *noise};
    for (int k = 0; k < 2; k++) {
        t->look[k].depth =
            rlf_alloc_array((size_t)camera->width * (size_t)camera->height, sizeof(float));
        if (t->look[k].depth == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    return RLF_OK;
}

void settled_close(settled *t)
{
    rlf_free(t->look[0].depth);
    rlf_free(t->look[1].depth);
    *t = (settled){.count = 0};
}

/* The frame becomes the newer look; the nearest of what falls on a pixel counts. */
static void take_look(settled *t, const rlf_surface *s, const rlf_pose *T_world_camera)
{
    const settled_look oldest = t->look[0];
    if (t->count == 2) {
        t->look[0] = t->look[1];
        t->look[1] = oldest;
    }
    settled_look *look = &t->look[t->count == 2 ? 1 : t->count++];
    look->T_world_camera = *T_world_camera;
    look->time_ns = s->time_ns;
    memset(look->depth, 0,
           (size_t)t->camera.width * (size_t)t->camera.height * sizeof(*look->depth));
    for (int32_t i = 0; i < s->width * s->height; i++) {
        const int32_t k =
            s->depth[i] > 0.0f ? camera_pixel_of(&t->camera, rlf_surface_point(s, i)) : -1;
        if (k >= 0) {
            float *z = &look->depth[k];
            *z = *z > 0.0f && *z < s->depth[i] ? *z : s->depth[i];
        }
    }
}

typedef struct comparison {
    const settled *t;
    const settled_look *look;
    const rlf_surface *now;
    rlf_pose T_look_now, T_now_look;
} comparison;

static double margin_at(const settled *t, double z)
{
    return rlf_max(OFF_M, OFF_SIGMAS * rlf_depth_noise_sigma(&t->noise, z));
}

/* Least and most depth of 3 x 3 pixels of the look; false where there is none. */
static bool span_at(const comparison *c, int32_t pixel, double *least, double *most)
{
    const rlf_camera *camera = &c->t->camera;
    const int32_t x = pixel % camera->width, y = pixel / camera->width;
    *least = 1e9;
    *most = 0.0;
    for (int32_t k = 0; k < 9; k++) {
        const int32_t u = x + k % 3 - 1, v = y + k / 3 - 1;
        if (u >= 0 && v >= 0 && u < camera->width && v < camera->height) {
            const double z = (double)c->look->depth[v * camera->width + u];
            *least = z > 0.0 ? rlf_min(*least, z) : *least;
            *most = rlf_max(*most, z);
        }
    }
    return *most > 0.0;
}

/* Whether what stood at depth z of the look's pixel is no more. */
static bool has_left(const comparison *c, int32_t pixel, double z)
{
    const rlf_camera *k = &c->t->camera;
    const double x = pixel % k->width, y = pixel / k->width;
    const rlf_vec3 p = {(x - k->cx) / k->fx * z, (y - k->cy) / k->fy * z, z};
    const rlf_vec3 now = rlf_transform(&c->T_now_look, p);
    const int32_t at = camera_pixel_of(&c->now->camera, now);
    return at >= 0 && (double)c->now->depth[at] > now.z + margin_at(c->t, now.z);
}

static bool is_settled(const comparison *c, rlf_vec3 q)
{
    const rlf_vec3 p = rlf_transform(&c->T_look_now, q);
    const double margin = margin_at(c->t, p.z);
    const int32_t pixel = camera_pixel_of(&c->t->camera, p);
    double least, most;
    if (pixel < 0 || !span_at(c, pixel, &least, &most)) {
        return true; /* nobody looked there */
    }
    return p.z > most + margin ? !has_left(c, pixel, least) : p.z >= least - margin;
}

static bool is_on_room(const settled *t, const rlf_prediction *room, rlf_vec3 q)
{
    const int32_t pixel = room != NULL ? camera_pixel_of(&room->camera, q) : -1;
    const double off = pixel >= 0 ? q.z - (double)room->depth[pixel] : 1e9;
    const double margin = margin_at(t, q.z);
    return off < margin && off > -margin;
}

static void leave_out(uint8_t *is_static, const rlf_surface *s, int32_t x0, int32_t y0)
{
    for (int32_t y = y0; y < y0 + CELL && y < s->height; y++) {
        for (int32_t x = x0; x < x0 + CELL && x < s->width; x++) {
            is_static[y * s->width + x] = 0;
        }
    }
}

void settled_mark(settled *t, const rlf_prediction *room, const rlf_surface *s,
                  const rlf_pose *T_world_camera, uint8_t *is_static)
{
    const rlf_pose T_camera_world = rlf_pose_invert(T_world_camera);
    comparison looks[2];
    for (int32_t k = 0; k < t->count; k++) {
        const rlf_pose T_look_world = rlf_pose_invert(&t->look[k].T_world_camera);
        looks[k] =
            (comparison){.t = t,
                         .look = &t->look[k],
                         .now = s,
                         .T_look_now = rlf_pose_mul(&T_look_world, T_world_camera),
                         .T_now_look = rlf_pose_mul(&T_camera_world, &t->look[k].T_world_camera)};
    }
    for (int32_t y = CELL / 2; y < s->height; y += CELL) {
        for (int32_t x = CELL / 2; x < s->width; x += CELL) {
            const int32_t i = y * s->width + x;
            const rlf_vec3 q = rlf_surface_point(s, i);
            const bool is_sure = !(q.z > 0.0) || is_static[i] == 0 || is_on_room(t, room, q);
            bool agree = true;
            for (int32_t k = 0; k < t->count && !is_sure && agree; k++) {
                agree = is_settled(&looks[k], q);
            }
            if (!agree) {
                leave_out(is_static, s, x - CELL / 2, y - CELL / 2);
            }
        }
    }
    if (t->count == 0 || s->time_ns - t->look[t->count - 1].time_ns >= APART_NS ||
        s->time_ns < t->look[t->count - 1].time_ns) {
        take_look(t, s, T_world_camera);
    }
}
