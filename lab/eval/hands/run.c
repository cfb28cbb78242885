/* A scripted hand before the pipeline of profile live. */
#include "eval/hands/hands.h"

#include "command.h"

#include <string.h>

#define PUT_S 0.4 /* the bodies are put down when the empty room is known */

rlf_synthetic_def hands_draw(rlf_synthetic_act act, eval_random *r, uint64_t seed)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.scene = RLF_SYNTHETIC_HANDS;
    def.enable_color = false;
    def.enable_truth = false;
    def.seed = seed;
    def.frame_count = -1;
    def.hands.act = act;
    def.hands.distance = eval_random_range(r, 0.75, 1.2);
    def.hands.view = (rlf_synthetic_view)(int)eval_random_range(r, 0.0, 3.0);
    def.hands.body = (rlf_synthetic_body)(int)eval_random_range(r, 0.0, 3.0);
    def.speed = eval_random_range(r, 0.1, 0.6);
    return def;
}

static rlf_result open_pipeline(hands_run *run)
{
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, run->source, NULL);
    def.enable_render = false;
    def.world.enable_grab = true;
    def.world.gravity = rlf_scale(run->down, rlf_length(def.world.gravity));
    return rlf_pipeline_create(&def, &run->pipeline);
}

rlf_result hands_open(const rlf_synthetic_def *def, hands_run *out)
{
    memset(out, 0, sizeof(*out));
    rlf_result result = rlf_synthetic_create(def, &out->source);
    result = result == RLF_OK ? rlf_synthetic_get_task(out->source, &out->task) : result;
    result = result == RLF_OK ? rlf_synthetic_get_down(out->source, &out->down) : result;
    result = result == RLF_OK ? open_pipeline(out) : result;
    if (result != RLF_OK) {
        hands_close(out);
    }
    return result;
}

void hands_close(hands_run *run)
{
    rlf_pipeline_destroy(&run->pipeline);
    rlf_source_destroy(&run->source);
}

static rlf_result put_bodies(hands_run *run)
{
    const rlf_synthetic_task *task = &run->task;
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < task->body_count && result == RLF_OK; i++) {
        rlf_body_def def = rlf_body_def_default();
        static const rlf_shape_type types[3] = {RLF_SHAPE_BOX, RLF_SHAPE_SPHERE,
                                                RLF_SHAPE_CYLINDER};
        def.shape = (rlf_shape){.type = types[task->body], .size = task->size};
        def.shape.radius = 0.5 * task->size.x;
        def.shape.height = task->size.y;
        def.position = task->T_camera_body[i].p;
        def.orientation = task->T_camera_body[i].q;
        def.release_time = task->release;
        def.restitution = 0.2;
        def.rolling_resistance = 0.05;
        rlf_body_id id;
        result = rlf_world_add_body(rlf_pipeline_get_world(run->pipeline), &def, &id);
    }
    return result;
}

rlf_result hands_step_until(hands_run *run, double time_s)
{
    rlf_result result = RLF_OK;
    while (result == RLF_OK && (run->frame.surface == NULL || run->frame.time_s < time_s - 1e-6)) {
        result = command_interrupted ? RLF_END : rlf_pipeline_step(run->pipeline, &run->frame);
        if (result == RLF_OK && run->frame.snapshot->body_count == 0 && run->frame.time_s > PUT_S) {
            result = put_bodies(run);
        }
    }
    return result;
}

rlf_pose hands_held_frame(const hands_run *run)
{
    rlf_synthetic_hand hands[RLF_SYNTHETIC_HANDS_MAX];
    rlf_pose at = rlf_pose_identity();
    int32_t count = 0;
    if (rlf_synthetic_get_hands(run->source, run->frame.time_s, hands, &count) == RLF_OK) {
        at = hands[0].T_camera_hand;
        at.p = count == 2 ? rlf_scale(rlf_add(hands[0].palm, hands[1].palm), 0.5) : hands[0].palm;
    }
    return at;
}

rlf_vec3 hands_body_in_hand(const hands_run *run)
{
    const rlf_snapshot *s = run->frame.snapshot;
    rlf_pose at = hands_held_frame(run);
    return s->body_count > 0 ? rlf_transform_inverse(&at, s->bodies[0].T_world_body.p)
                             : rlf_vec3_make(1e3, 0, 0);
}
