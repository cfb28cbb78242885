/* A camera that calls its program back: each frame is pushed through the whole pipeline, and a ball
 * falls onto the floor that the camera sees.
 *
 * The "camera" here looks down on a floor 2 m away. A real one calls `on_frame` from its driver. */
#include "relief/pipeline.h"

#include <stdio.h>

#define WIDTH 320
#define HEIGHT 240

typedef struct my_app {
    rlf_pipeline *pipeline;
    rlf_pipeline_output output;
} my_app;

static rlf_result on_frame(my_app *app, const uint16_t *depth_mm, const uint8_t *rgba,
                           int64_t time_ns)
{
    rlf_frame frame = {.time_ns = time_ns, .depth_u16 = depth_mm, .depth_units_per_metre = 1000};
    frame.depth_stride = WIDTH * (ptrdiff_t)sizeof(*depth_mm);
    frame.color = (rlf_image_rgba8){(uint8_t *)(uintptr_t)rgba, WIDTH, HEIGHT, 4 * WIDTH};
    return rlf_pipeline_push(app->pipeline, &frame, &app->output);
}

static rlf_result open_pipeline(my_app *app)
{
    rlf_rig rig = rlf_rig_default();
    rig.depth = (rlf_camera){WIDTH, HEIGHT, .fx = 280, .fy = 280, .cx = 159.5, .cy = 119.5};
    rig.color = rig.depth;
    rig.has_color = true;
    rlf_body_def ball = rlf_body_def_default();
    ball.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.1};
    const rlf_scene scene = {.gravity = {0, 0, 9.81}, .bodies = &ball, .body_count = 1};
    rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &rig, NULL);
    def.scene = &scene; /* copied */
    return rlf_pipeline_create(&def, &app->pipeline);
}

int main(void)
{
    static uint16_t depth_mm[WIDTH * HEIGHT];
    static uint8_t rgba[4 * WIDTH * HEIGHT];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        depth_mm[i] = 2000;
    }
    my_app app = {0};
    rlf_result result = open_pipeline(&app);
    for (int64_t i = 0; i < 90 && result == RLF_OK; i++) {
        result = on_frame(&app, depth_mm, rgba, i * 33333333);
    }
    if (result != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
        rlf_pipeline_destroy(&app.pipeline);
        return 1;
    }
    const double z = app.output.snapshot->bodies[0].T_world_body.p.z;
    printf("after 3 s the ball's centre is %.3f m away, on the floor at 2 m\n", z);
    rlf_pipeline_destroy(&app.pipeline);
    return z > 1.88 && z < 1.92 ? 0 : 1;
}
