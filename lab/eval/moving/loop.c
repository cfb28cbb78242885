/* A moving camera in the frame loop of a synthetic room. */
#include "eval/moving/loop.h"

#include "command.h"
#include "eval/measures/foreground.h"
#include "relief/io.h"
#include "relief/pipeline.h"
#include "timing.h"

#include <string.h>

typedef struct loop_run {
    rlf_pool *pool;
    rlf_source *source;
    rlf_scene scene;
    rlf_pipeline *pipeline;
    eval_foreground foreground;
    timing_series ms;
} loop_run;

static rlf_result open_run(loop_run *run, const char *source)
{
    memset(run, 0, sizeof(*run));
    rlf_result result = rlf_pool_create(2, &run->pool);
    if (result == RLF_OK) {
        result = rlf_open_source(source, run->pool, &run->source);
    }
    if (result == RLF_OK) {
        result = rlf_scene_create_two_cubes(&run->scene);
    }
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, run->source, run->pool);
        def.scene = &run->scene;
        def.camera = RLF_CAMERA_MOVING;
        result = rlf_pipeline_create(&def, &run->pipeline);
    }
    return result;
}

static void close_run(loop_run *run)
{
    rlf_pipeline_destroy(&run->pipeline);
    rlf_scene_destroy(&run->scene);
    rlf_source_destroy(&run->source);
    rlf_pool_destroy(&run->pool);
}

static void add_frame(loop_run *run, const rlf_pipeline_output *out)
{
    const rlf_truth *truth = rlf_source_get_truth(run->source);
    if (truth != NULL) {
        eval_foreground_add(&run->foreground, out->surface, truth,
                            &rlf_source_get_info(run->source)->rig);
    }
    timing_add(&run->ms, out->times.surface_ms + out->times.physics_ms + out->times.render_ms);
}

rlf_result loop_measure(const char *source, int64_t from, loop_figures *out)
{
    static loop_run run;
    rlf_result result = open_run(&run, source);
    rlf_pipeline_output frame;
    while (result == RLF_OK && !command_interrupted) {
        result = rlf_pipeline_step(run.pipeline, &frame);
        if (result == RLF_OK && frame.frame_index >= from) {
            add_frame(&run, &frame);
        }
    }
    *out = (loop_figures){.f = eval_f_measure(&run.foreground.all),
                          .f_valid = eval_f_measure(&run.foreground.valid),
                          .precision = eval_precision(&run.foreground.valid),
                          .recall = eval_recall(&run.foreground.valid),
                          .loop_ms = timing_percentile(&run.ms, 50.0)};
    close_run(&run);
    return result == RLF_END ? RLF_OK : result;
}
