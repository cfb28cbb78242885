/* Rays through the true room, and noise along them. */
#include "eval/map/view.h"

#include <string.h>

rlf_result map_camera_open(map_camera *c, const char *source, double time_s, int64_t seed)
{
    memset(c, 0, sizeof(*c));
    rlf_result result = rlf_open_source(source, NULL, &c->source);
    rlf_frame frame = {0};
    while (result == RLF_OK && (frame.rig == NULL || (double)frame.time_ns * 1e-9 < time_s)) {
        result = rlf_source_next(c->source, &frame);
    }
    if (result != RLF_OK) {
        return result;
    }
    c->rig = rlf_source_get_info(c->source)->rig;
    c->rig.has_color = false;
    c->noise = eval_random_start((uint64_t)seed);
    const size_t n = (size_t)c->rig.depth.width * (size_t)c->rig.depth.height;
    c->ways = rlf_alloc_array(n, sizeof(rlf_vec3));
    c->truth = rlf_alloc_array(n, sizeof(float));
    c->depth = rlf_alloc_array(n, sizeof(float));
    c->label = rlf_alloc_array(n, sizeof(int32_t));
    c->frame.rig = &c->rig;
    c->frame.depth_f32 = c->depth;
    c->frame.depth_stride = c->rig.depth.width * (ptrdiff_t)sizeof(float);
    bool is_whole = c->ways != NULL && c->truth != NULL && c->depth != NULL && c->label != NULL;
    return is_whole ? RLF_OK : RLF_ERROR_MEMORY;
}

void map_camera_close(map_camera *c)
{
    rlf_source_destroy(&c->source);
    rlf_free(c->ways);
    rlf_free(c->truth);
    rlf_free(c->depth);
    rlf_free(c->label);
    memset(c, 0, sizeof(*c));
}

static rlf_pose hand(int32_t i)
{
    const double t = 0.1 * i;
    const rlf_vec3 turn = {0.15 * rlf_sin(0.7 * t), 0.35 * rlf_sin(0.5 * t + 0.3),
                           0.06 * rlf_sin(0.9 * t)};
    rlf_pose T = {.p = rlf_vec3_make(0.3 * rlf_sin(0.6 * t), 0.12 * rlf_sin(0.8 * t),
                                     0.15 * rlf_sin(0.4 * t))};
    T.q = rlf_quat_from_rotation_vector(turn);
    return T;
}

rlf_result map_camera_look(map_camera *c, int32_t i)
{
    const rlf_camera *camera = &c->rig.depth;
    const int32_t n = camera->width * camera->height;
    c->T_world_camera = hand(i);
    for (int32_t k = 0; k < n; k++) {
        rlf_vec3 ray;
        (void)rlf_camera_unproject(camera, k % camera->width, k / camera->width, &ray);
        c->ways[k] = rlf_rotate(c->T_world_camera.q, ray);
    }
    rlf_result result =
        rlf_synthetic_cast(c->source, c->T_world_camera.p, c->ways, n, c->truth, c->label);
    for (int32_t k = 0; k < n; k++) {
        const double z = (double)c->truth[k];
        const double sigma = rlf_depth_noise_sigma(&c->rig.noise, z);
        const bool is_seen = z > c->rig.depth_min_m && z < c->rig.depth_max_m;
        c->depth[k] = is_seen ? (float)(z + sigma * eval_random_normal(&c->noise)) : 0.0f;
    }
    c->frame.sequence = (uint64_t)i;
    c->frame.time_ns = (int64_t)i * 33333333;
    return result;
}

bool map_camera_point(const map_camera *c, int32_t pixel, rlf_vec3 *out)
{
    *out = rlf_mad(c->T_world_camera.p, c->ways[pixel], (double)c->truth[pixel]);
    return c->depth[pixel] > 0.0f;
}
