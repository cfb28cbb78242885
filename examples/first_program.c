#include "relief/io.h"

#include <stdio.h>

int main(void)
{
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output frame;
    rlf_result result = rlf_open_source("synthetic:room", NULL, &source);
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        result = rlf_pipeline_create(&def, &pipeline);
    }
    if (result == RLF_OK) {
        rlf_body_def crate = rlf_body_def_default();
        result = rlf_world_add_body(rlf_pipeline_get_world(pipeline), &crate, NULL);
    }
    for (int i = 0; i < 15 && result == RLF_OK; i++) {
        result = rlf_pipeline_step(pipeline, &frame);
    }
    if (result == RLF_OK) {
        result = rlf_png_write_rgba("crate.png", &frame.render.image);
    }
    if (result != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    return result == RLF_OK ? 0 : 1;
}
