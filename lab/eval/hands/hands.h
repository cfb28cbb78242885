/* Section "hands": scripted hands of the simulator grasp, throw and gesture. */
#ifndef RELIEF_APP_EVAL_HANDS_HANDS_H
#define RELIEF_APP_EVAL_HANDS_HANDS_H

#include "eval/analytic.h"
#include "eval/table.h"
#include "relief/pipeline.h"
#include "relief/synthetic.h"

#define HANDS_SECTION "hands"
#define GESTURES_SECTION "gestures"
#define HANDS_SAMPLES_MAX 8192

/* A scripted hand, the pipeline that sees it, and the virtual bodies of its task. The world's frame
 * is the camera's. */
typedef struct hands_run {
    rlf_source *source;
    rlf_pipeline *pipeline;
    rlf_pipeline_output frame;
    rlf_synthetic_task task;
    rlf_vec3 down;
} hands_run;

/* On failure everything is closed again. */
rlf_result hands_open(const rlf_synthetic_def *def, hands_run *out);
void hands_close(hands_run *run);
/* Steps until that time; the bodies are put down on the way. */
rlf_result hands_step_until(hands_run *run, double time_s);
/* True middle of the hands at the frame's time: the only hand, or between both; and the frame of
 * the first. */
rlf_pose hands_held_frame(const hands_run *run);
/* The first body's place in that frame. */
rlf_vec3 hands_body_in_hand(const hands_run *run);

/* A def drawn for an act: distance, view, body, speed. */
rlf_synthetic_def hands_draw(rlf_synthetic_act act, eval_random *r, uint64_t seed);

/* grasp.c, pass.c, track.c: each adds its rows for one seed. */
rlf_result hands_grasp_run(eval_table *table, int64_t seed);
rlf_result hands_pass_run(eval_table *table, int64_t seed);
rlf_result hands_track_run(eval_table *table, int64_t seed);
/* judge.c: another's hand. */
rlf_result hands_judge_run(eval_table *table, int64_t seed);
/* others.c: its grasps. */
rlf_result hands_others_run(eval_table *table, int64_t seed);

#endif
