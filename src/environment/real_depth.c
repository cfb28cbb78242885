/* Chooses the depth that hides bodies and registers it. */
#include "environment/real_depth.h"

#include "kernel/kernel.h"

#include <string.h>

/* Rays of every pixel of the depth camera, for frames that are registered themselves. */
static rlf_result make_frame_rays(real_depth *real, const rlf_camera *camera)
{
    size_t count = (size_t)camera->width * (size_t)camera->height;
    real->ray_x = rlf_alloc_array(count, sizeof(float));
    real->ray_y = rlf_alloc_array(count, sizeof(float));
    real->is_in_lens = rlf_alloc_array(count, 1);
    if (real->ray_x == NULL || real->ray_y == NULL || real->is_in_lens == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        double u = (double)(i % (size_t)camera->width);
        double v = (double)(i / (size_t)camera->width);
        rlf_vec3 ray;
        real->is_in_lens[i] = rlf_camera_unproject(camera, u, v, &ray);
        real->ray_x[i] = (float)ray.x;
        real->ray_y[i] = (float)ray.y;
    }
    return RLF_OK;
}

static rlf_result allocate(real_depth *real, const rlf_camera *picture)
{
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    real->input = rlf_alloc_array((size_t)real->width * (size_t)real->height, sizeof(float));
    /* Readers may look at several pixels at once, beyond the last. */
    real->z.data = rlf_alloc_array(pixels + 16, sizeof(float));
    if (real->input == NULL || real->z.data == NULL) {
        return RLF_ERROR_MEMORY;
    }
    real->z.width = picture->width;
    real->z.height = picture->height;
    real->z.stride = picture->width * (ptrdiff_t)sizeof(float);
    return RLF_OK;
}

rlf_result real_depth_create(const real_depth_def *def, real_depth *out)
{
    memset(out, 0, sizeof(*out));
    out->uses_frame = def->grid.width < def->rig->depth.width;
    const rlf_camera *camera = &def->picture;
    const rlf_camera *depth = out->uses_frame ? &def->rig->depth : &def->grid;
    out->pool = def->pool;
    out->width = depth->width;
    out->height = depth->height;
    rlf_result result = allocate(out, camera);
    if (result == RLF_OK && out->uses_frame) {
        result = make_frame_rays(out, depth);
    }
    if (result == RLF_OK) {
        out->T_picture_depth = def->T_picture_depth;
        result = rlf_registration_create(depth, out->uses_frame ? out->ray_x : def->ray_x,
                                         out->uses_frame ? out->ray_y : def->ray_y, camera,
                                         &def->T_picture_depth, &out->registration);
    }
    if (result == RLF_OK && !out->uses_frame) {
        result = lost_depth_create(out->registration, depth, &out->T_picture_depth, out->pool,
                                   &out->lost);
    }
    if (result == RLF_OK) {
        result = depth_tiles_create(def->grid.width, def->grid.height, &out->seen);
    }
    if (result == RLF_OK) {
        result = known_layer_create(camera, depth, &def->rig->noise, &out->known);
    }
    if (result == RLF_OK) {
        result = known_layer_create(depth, depth, &def->rig->noise, &out->sensed);
    }
    if (result != RLF_OK) {
        real_depth_destroy(out);
    }
    return result;
}

void real_depth_destroy(real_depth *real)
{
    rlf_registration_destroy(&real->registration);
    lost_depth_destroy(&real->lost);
    depth_tiles_destroy(&real->seen);
    known_layer_destroy(&real->known);
    known_layer_destroy(&real->sensed);
    void *parts[5] = {real->input, real->z.data, real->ray_x, real->ray_y, real->is_in_lens};
    for (int i = 0; i < 5; i++) {
        rlf_free(parts[i]);
    }
    memset(real, 0, sizeof(*real));
}

static void read_frame(real_depth *real, const rlf_frame *frame)
{
    double metres = frame->depth_units_per_metre > 0.0 ? 1.0 / frame->depth_units_per_metre : 0.0;
    for (int32_t y = 0; y < real->height; y++) {
        ptrdiff_t row = y * frame->depth_stride;
        float *out = real->input + (size_t)y * (size_t)real->width;
        const uint8_t *is_in_lens = real->is_in_lens + (size_t)y * (size_t)real->width;
        if (frame->depth_u16 != NULL) {
            const uint16_t *in =
                (const uint16_t *)(const void *)((const char *)frame->depth_u16 + row);
            for (int32_t x = 0; x < real->width; x++) {
                out[x] = is_in_lens[x] ? (float)(in[x] * metres) : 0.0f;
            }
        } else if (frame->depth_f32 != NULL) {
            const float *in = (const float *)(const void *)((const char *)frame->depth_f32 + row);
            for (int32_t x = 0; x < real->width; x++) {
                bool is_known = is_in_lens[x] && in[x] > 0.0f && in[x] < 1e6f;
                out[x] = is_known ? in[x] : 0.0f;
            }
        }
    }
}

void real_depth_read(real_depth *real, const observation *now)
{
    const rlf_surface *surface = now->surface;
    real->nearest = 0.0f;
    if (real->uses_frame) {
        read_frame(real, now->frame);
    }
    if (surface->depth != NULL) {
        depth_tiles_update(&real->seen, surface, real->pool, real->uses_frame ? NULL : real->input);
        real->nearest = real->uses_frame ? 0.0f : real->seen.least;
    }
}

const known_layer *real_depth_known(const real_depth *real)
{
    return real->known.count > 0 ? &real->known : NULL;
}

/* Colours that the room had elsewhere in the picture say nothing. */
static void follow_camera(real_depth *real, const rlf_pose *T_world_camera)
{
    const double nearest = real->seen.least > 0.0f ? (double)real->seen.least : 1.0;
    real->has_moved =
        sight_change_update(&real->sight, T_world_camera, &real->registration->color, nearest);
    if (real->has_moved && !real->uses_frame) {
        background_color_forget(&real->lost.background);
    }
}

rlf_result real_depth_update(real_depth *real, const observation *now, const edge_matte *bodies,
                             const real_windows *needed)
{
    real_windows windows = *needed;
    if (bodies != NULL) {
        follow_camera(real, &now->T_world_camera);
    }
    if (!real->uses_frame && bodies != NULL) {
        real->nearest = lost_depth_update(&real->lost, real->registration, now->frame, now->surface,
                                          bodies, needed, real->input, real->nearest);
    }
    rlf_pose T_camera_world = rlf_pose_invert(&now->T_world_camera);
    rlf_pose T_picture_world = rlf_pose_mul(&real->T_picture_depth, &T_camera_world);
    rlf_result result = known_layer_place(&real->sensed, now->snapshot, &T_camera_world);
    known_layer_fill(&real->sensed, real->input);
    if (real->sensed.count > 0) { /* models may be anywhere, and looked at anywhere */
        real->nearest = 0.0f;
        windows = (real_windows){{{0, 0, real->z.width, real->z.height}}, 1};
    }
    const rlf_plane_u8 no_state = {NULL, real->z.width, real->z.height, real->z.width};
    real_windows_join(&windows, real->registration, (double)real->nearest);
    for (int32_t i = 0; i < windows.count; i++) {
        registration_apply_window(real->registration, real->input, &windows.window[i],
                                  (double)real->nearest, &real->z, &no_state);
    }
    if (result == RLF_OK) {
        result = known_layer_place(&real->known, now->snapshot, &T_picture_world);
    }
    known_layer_cover(&real->known, real->z.data);
    return result;
}
