/* Your own camera in Relief's window, with all keys and the panel: a function that gives frames is
 * all it takes. With a number as argument it closes after so many frames. */
#include "relief/window.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 320
#define HEIGHT 240

static uint16_t depth_mm[WIDTH * HEIGHT];
static uint8_t rgba[4 * WIDTH * HEIGHT];

/* Stands for your camera: a floor 2 m away. */
static rlf_result next(void *context, rlf_frame *out)
{
    int64_t *count = context;
    memset(out, 0, sizeof *out);
    out->time_ns = (*count)++ * 33333333;
    out->depth_u16 = depth_mm;
    out->depth_units_per_metre = 1000;
    out->depth_stride = WIDTH * (ptrdiff_t)sizeof(*depth_mm);
    out->color = (rlf_image_rgba8){rgba, WIDTH, HEIGHT, 4 * WIDTH};
    return RLF_OK;
}

int main(int argc, char **argv)
{
    int64_t count = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        depth_mm[i] = 2000;
        memset(rgba + 4 * i, 128, 4);
    }
    rlf_rig rig = rlf_rig_default();
    rig.depth = (rlf_camera){WIDTH, HEIGHT, .fx = 280, .fy = 280, .cx = 159.5, .cy = 119.5};
    rig.color = rig.depth;
    rig.has_color = true;
    const rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &rig, NULL);
    rlf_pipeline *pipeline = NULL;
    rlf_window_def window = rlf_window_def_default();
    window.title = "my camera";
    window.stage.frames_per_second = 30;
    window.next = next;
    window.context = &count;
    window.frame_count = argc > 1 ? atoi(argv[1]) : -1;
    rlf_result result = rlf_pipeline_create(&def, &pipeline);
    result = result == RLF_OK ? rlf_window_run(pipeline, &window) : result;
    if (result != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    rlf_pipeline_destroy(&pipeline);
    return result == RLF_OK ? 0 : 1;
}
