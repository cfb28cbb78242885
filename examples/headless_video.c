/* A video without a window: two seconds of the synthetic room with two cubes in it, into video.y4m
 * (or .mp4, in a build that has it). usage: headless_video [FILE] */
#include "relief/io.h"

#include <stdio.h>

#define FRAMES 60

static rlf_result film(rlf_pipeline *pipeline, double rate, const char *path)
{
    rlf_video *video = NULL;
    rlf_result result = RLF_OK;
    for (int i = 0; i < FRAMES && result == RLF_OK; i++) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(pipeline, &frame);
        if (result == RLF_OK && video == NULL) {
            const rlf_image_rgba8 *image = &frame.render.image;
            result = rlf_video_open(path, image->width, image->height, rate, &video);
        }
        if (result == RLF_OK) {
            result = rlf_video_write(video, &frame.render.image);
        }
    }
    const rlf_result closed = rlf_video_close(&video);
    return result == RLF_OK ? closed : result;
}

int main(int argc, char **argv)
{
    const char *path = argc > 1 ? argv[1] : "video.y4m";
    rlf_pool *pool = NULL;
    rlf_source *source = NULL;
    rlf_scene scene = {0};
    rlf_pipeline *pipeline = NULL;
    rlf_result result = rlf_pool_create(0, &pool);
    if (result == RLF_OK) {
        result = rlf_open_source("synthetic:room", pool, &source);
    }
    if (result == RLF_OK) {
        result = rlf_scene_create_two_cubes(&scene);
    }
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, pool);
        def.scene = &scene;
        result = rlf_pipeline_create(&def, &pipeline);
    }
    if (result == RLF_OK) {
        result = film(pipeline, rlf_source_get_info(source)->frames_per_second, path);
    }
    if (result == RLF_OK) {
        printf("%s: %d frames\n", path, FRAMES);
    } else {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_scene_destroy(&scene);
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
    return result == RLF_OK ? 0 : 1;
}
