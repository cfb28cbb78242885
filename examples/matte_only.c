/* For a renderer that composes by itself: Relief gives the matte (which share of a pixel is virtual
 * after real things have hidden it) and the picture of the bodies. matte.png, 0 to 255. */
#include "relief/io.h"

#include <stdio.h>

static int64_t covered(const rlf_plane_u8 *matte)
{
    int64_t sum = 0;
    for (int32_t y = 0; y < matte->height; y++) {
        for (int32_t x = 0; x < matte->width; x++) {
            sum += matte->data[y * matte->stride + x];
        }
    }
    return sum / 255;
}

int main(void)
{
    rlf_source *source = NULL;
    rlf_scene scene = {0};
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output frame = {0};
    rlf_result result = rlf_open_source("synthetic:room", NULL, &source);
    if (result == RLF_OK) {
        result = rlf_scene_create_two_cubes(&scene);
    }
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        def.scene = &scene;
        result = rlf_pipeline_create(&def, &pipeline);
    }
    for (int i = 0; i < 20 && result == RLF_OK; i++) {
        result = rlf_pipeline_step(pipeline, &frame);
    }
    if (result == RLF_OK) {
        result = rlf_png_write_u8("matte.png", &frame.render.matte);
    }
    const int64_t pixels = result == RLF_OK ? covered(&frame.render.matte) : 0;
    if (result == RLF_OK) {
        printf("matte.png: %lld pixels are virtual\n", (long long)pixels);
    } else {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_scene_destroy(&scene);
    rlf_source_destroy(&source);
    return pixels > 0 ? 0 : 1;
}
