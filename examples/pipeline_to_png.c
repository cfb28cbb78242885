/* The whole pipeline in one screen: two cubes are thrown into the synthetic room, and the picture
 * after 45 frames goes to composite.png. usage: pipeline_to_png [SOURCE] */
#include "relief/io.h"

#include <stdio.h>

static rlf_result throw_cubes(rlf_source *source, rlf_pool *pool)
{
    rlf_scene scene;
    rlf_result result = rlf_scene_create_two_cubes(&scene);
    if (result != RLF_OK) {
        return result;
    }
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, pool);
    def.scene = &scene;
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output frame = {0};
    result = rlf_pipeline_create(&def, &pipeline);
    for (int i = 0; i < 45 && result == RLF_OK; i++) {
        result = rlf_pipeline_step(pipeline, &frame);
    }
    if (result == RLF_OK) {
        result = rlf_png_write_rgba("composite.png", &frame.render.image);
    }
    if (result == RLF_OK) {
        printf("composite.png: %d x %d, %d contacts in this frame\n", frame.render.image.width,
               frame.render.image.height, frame.snapshot->contact_count);
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_scene_destroy(&scene);
    return result;
}

int main(int argc, char **argv)
{
    rlf_pool *pool = NULL;
    rlf_source *source = NULL;
    rlf_result result = rlf_pool_create(0, &pool);
    if (result == RLF_OK) {
        result = rlf_open_source(argc > 1 ? argv[1] : "synthetic:room", pool, &source);
    }
    if (result == RLF_OK) {
        result = throw_cubes(source, pool);
    }
    if (result != RLF_OK) {
        fprintf(stderr, "%s\n", result == RLF_END ? "the source ended early" : rlf_error_text());
    }
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
    return result == RLF_OK ? 0 : 1;
}
