/* A hand that moves among bodies and grasps none: how often is one of them in the air? */
#include "eval/hands/hands.h"

#define AIR_M 0.03       /* over its place: it is held ... */
#define AIR_FRAMES 10    /* ... for so long */
#define GRABBED_FRAMES 3 /* or physics says so for so long */
#define FIRST_S 1.6      /* the hand begins to move */

rlf_result hands_pass_run(eval_table *table, int64_t seed)
{
    eval_random r = eval_random_start((uint64_t)(seed * 1000 + 700));
    rlf_synthetic_def def = hands_draw(RLF_SYNTHETIC_ACT_PASS, &r, (uint64_t)(seed * 100 + 70));
    int32_t in_air[RLF_SYNTHETIC_BODIES_MAX] = {0}, held[RLF_SYNTHETIC_BODIES_MAX] = {0}, grabs = 0;
    hands_run run;
    rlf_result result = hands_open(&def, &run);
    if (result != RLF_OK) {
        return result;
    }
    while (result == RLF_OK && run.frame.time_s < run.task.end) {
        result = hands_step_until(&run, run.frame.time_s + 0.02);
        const rlf_snapshot *s = run.frame.snapshot;
        for (int32_t i = 0; result == RLF_OK && i < s->body_count; i++) {
            rlf_vec3 way = rlf_sub(run.task.T_camera_body[i].p, s->bodies[i].T_world_body.p);
            bool is_up = rlf_dot(way, run.down) > AIR_M;
            in_air[i] = is_up ? in_air[i] + 1 : 0;
            held[i] = s->bodies[i].is_grabbed ? held[i] + 1 : 0;
            grabs += held[i] == GRABBED_FRAMES || (in_air[i] == AIR_FRAMES && held[i] == 0);
        }
    }
    eval_table_add(table, HANDS_SECTION, "false_per_minute",
                   "false grabs per minute of a hand among bodies", RLF_PROFILE_LIVE,
                   60.0 * grabs / (run.task.end - FIRST_S));
    hands_close(&run);
    return result;
}
