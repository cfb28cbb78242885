/* Blob shadows as a tilted camera sees them: each pixel finds its own place on the floor. */
#include "sim/stamp.h"
#include "kernel/kernel.h"

#define NEAREST 0.1     /* metres before the camera */
#define LEAST_DOWN 0.02 /* of a ray: what is flatter does not reach the floor of a room */

/* What some points project to. */
typedef struct extent {
    double low[2], high[2];
} extent;

static void add_point(extent *e, const rlf_camera *camera, rlf_vec3 p)
{
    const double at[2] = {camera->cx + camera->fx * p.x / p.z, camera->cy + camera->fy * p.y / p.z};
    for (int k = 0; k < 2; k++) {
        e->low[k] = rlf_min(e->low[k], at[k]);
        e->high[k] = rlf_max(e->high[k], at[k]);
    }
}

/* Of the square about the ellipse what lies before the camera: its corners, and where its sides
 * cross the plane z = NEAREST. */
synth_rect synth_shadow_rect(const synth_shadow *shadow, const synth_blob *blob,
                             const synth_view *view, double floor_y)
{
    static const double side_x[5] = {-1, 1, 1, -1, -1}, side_z[5] = {-1, -1, 1, 1, -1};
    const rlf_camera *camera = &view->camera;
    const rlf_quat q_camera_level = rlf_quat_conjugate(shadow->q_level_camera);
    const double reach = (double)blob->long_radius;
    extent e = {{1e9, 1e9}, {-1e9, -1e9}};
    rlf_vec3 last = {0, 0, 0};
    for (int32_t i = 0; i < 5; i++) {
        const rlf_vec3 corner = {blob->x + side_x[i] * reach, floor_y, blob->z + side_z[i] * reach};
        const rlf_vec3 p = rlf_sub(rlf_rotate(q_camera_level, corner), view->origin);
        if (i > 0 && (p.z < NEAREST) != (last.z < NEAREST)) {
            const double share = (NEAREST - last.z) / (p.z - last.z);
            add_point(&e, camera, rlf_mad(last, rlf_sub(p, last), share));
        }
        if (p.z >= NEAREST) {
            add_point(&e, camera, p);
        }
        last = p;
    }
    synth_rect rect = {(int32_t)rlf_clamp(e.low[0], 0, camera->width),
                       (int32_t)rlf_clamp(e.low[1], 0, camera->height),
                       (int32_t)rlf_clamp(e.high[0] + 2, 0, camera->width),
                       (int32_t)rlf_clamp(e.high[1] + 2, 0, camera->height)};
    return rect;
}

/* A row of rays in the level frame: the first pixel's direction, and the step to the next. */
typedef struct rays {
    float d[3], step[3];
    float height; /* of the camera */
    float x, z;   /* of the camera */
} rays;

/* Multiplies the light of pixels begin..end of the row by what one blob lets through. */
RLF_KERNEL static void dim_pixels(const synth_blob blob, const rays r, int32_t begin, int32_t end,
                                  float *restrict light)
{
    for (int32_t i = begin; i < end; i++) {
        const float down = r.d[1] + (float)i * r.step[1];
        const float t = r.height / (down > (float)LEAST_DOWN ? down : (float)LEAST_DOWN);
        const float dx = r.x + t * (r.d[0] + (float)i * r.step[0]) - blob.x;
        const float dz = r.z + t * (r.d[2] + (float)i * r.step[2]) - blob.z;
        const float along = (dx * blob.along_x + dz * blob.along_z) / blob.long_radius;
        const float aside = (dx * blob.along_z - dz * blob.along_x) / blob.short_radius;
        float rest = 1.0f - along * along - aside * aside;
        rest = rest > 0.0f ? rest : 0.0f;
        light[i] *= 1.0f - blob.strength * rest * rest;
    }
}

void synth_shadow_dim(const synth_shadow *shadow, const synth_view *view, double floor_y, int32_t y,
                      float *light)
{
    const int32_t x0 = shadow->rect.x0;
    const rlf_vec3 first =
        rlf_rotate(shadow->q_level_camera, synth_view_ray(view, x0, y).direction);
    const rlf_vec3 step =
        rlf_rotate(shadow->q_level_camera, rlf_vec3_make(1.0 / view->camera.fx, 0, 0));
    const rlf_vec3 origin = rlf_rotate(shadow->q_level_camera, view->origin);
    const rays r = {{(float)first.x, (float)first.y, (float)first.z},
                    {(float)step.x, (float)step.y, (float)step.z},
                    (float)(floor_y - origin.y),
                    (float)origin.x,
                    (float)origin.z};
    for (int32_t k = 0; k < shadow->blob_count; k++) {
        const synth_rect *rect = &shadow->blobs[k].rect;
        if (synth_rect_has_row(*rect, y)) {
            dim_pixels(shadow->blobs[k], r, rect->x0 - x0, rect->x1 - x0, light);
        }
    }
}
