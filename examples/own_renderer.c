/* Your own renderer: reads the bodies from the snapshot and the real surface's depth, and draws
 * what it likes. This one casts a ray through each pixel, shades a body by its slope, and lets the
 * real world hide it. own_renderer.png.
 *
 * A game engine does the same with its own meshes: poses from `bodies`, occlusion from `depth`. */
#include "relief/io.h"

#include <stdio.h>

/* Where the ray meets the nearest body: its z in the camera's frame, or 0; *out_shade is 0 to 1. */
static double cast(const rlf_snapshot *s, const rlf_pose *T_camera_world, rlf_vec3 ray,
                   double *out_shade)
{
    double nearest = 0.0;
    for (int32_t i = 0; i < s->body_count; i++) {
        const rlf_body_state *body = &s->bodies[i];
        const rlf_pose T_camera_body = rlf_pose_mul(T_camera_world, &body->T_world_body);
        const rlf_pose T_body_camera = rlf_pose_invert(&T_camera_body);
        const rlf_vec3 direction = rlf_rotate(T_body_camera.q, ray);
        double enter, leave;
        if (!rlf_shape_cast(&body->shape, T_body_camera.p, direction, &enter, &leave) ||
            enter <= 0.0 || (nearest > 0.0 && enter > nearest)) {
            continue;
        }
        rlf_vec3 normal;
        const rlf_vec3 p = rlf_mad(T_body_camera.p, direction, enter);
        (void)rlf_shape_distance(&body->shape, p, &normal);
        *out_shade = -rlf_dot(normal, rlf_normalize(direction));
        nearest = enter; /* the ray's z is 1 */
    }
    return nearest;
}

static int64_t draw(const rlf_pipeline_output *frame, const rlf_image_rgba8 *image)
{
    const rlf_surface *s = frame->surface;
    const rlf_pose T_camera_world = rlf_pose_invert(&frame->T_world_camera);
    int64_t drawn = 0;
    for (int32_t y = 0; y < s->height; y++) {
        for (int32_t x = 0; x < s->width; x++) {
            const int32_t i = y * s->width + x;
            uint8_t *pixel = image->data + y * image->stride + 4 * x;
            const double real = s->depth[i];
            double shade = 0.0;
            const rlf_vec3 ray = rlf_vec3_make(s->ray_x[i], s->ray_y[i], 1.0);
            const double z = cast(frame->snapshot, &T_camera_world, ray, &shade);
            const bool is_body = z > 0.0 && (real <= 0.0 || z < real);
            const uint8_t grey = (uint8_t)(real > 0.0 ? 255.0 * rlf_clamp(1.2 / real, 0, 1) : 0);
            pixel[0] = is_body ? (uint8_t)(255.0 * rlf_clamp(shade, 0, 1)) : grey;
            pixel[1] = is_body ? (uint8_t)(140.0 * rlf_clamp(shade, 0, 1)) : grey;
            pixel[2] = is_body ? 0 : grey;
            pixel[3] = 255;
            drawn += is_body ? 1 : 0;
        }
    }
    return drawn;
}

int main(void)
{
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = NULL;
    rlf_scene scene = {0};
    rlf_image_rgba8 image = {0};
    rlf_pipeline_output frame;
    int64_t drawn = 0;
    rlf_result result = rlf_open_source("synthetic:room", NULL, &source);
    result = result == RLF_OK ? rlf_scene_create_two_cubes(&scene) : result;
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        def.scene = &scene;
        def.enable_render = false;
        result = rlf_pipeline_create(&def, &pipeline);
    }
    for (int i = 0; i < 20 && result == RLF_OK; i++) {
        result = rlf_pipeline_step(pipeline, &frame);
    }
    if (result == RLF_OK) {
        const int32_t w = frame.surface->width, h = frame.surface->height;
        image = (rlf_image_rgba8){rlf_alloc_array((size_t)w * (size_t)h, 4), w, h, 4 * w};
        result = image.data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    if (result == RLF_OK) {
        drawn = draw(&frame, &image);
        result = rlf_png_write_rgba("own_renderer.png", &image);
    }
    if (result == RLF_OK) {
        printf("own_renderer.png: %lld pixels show a body\n", (long long)drawn);
    } else {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    rlf_free(image.data);
    rlf_pipeline_destroy(&pipeline);
    rlf_scene_destroy(&scene);
    rlf_source_destroy(&source);
    return drawn > 0 ? 0 : 1;
}
