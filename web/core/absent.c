/* Rooms that a page does without: those drawn at random, and the hands that follow a script. They
 * judge Relief in the laboratory, and would be a tenth of what a visitor loads. */
#include "page.h"

#include "sim/hands/hands.h"
#include "sim/random/plan.h"

rlf_result page_room_check(const rlf_synthetic_def *def)
{
    return def->scene != RLF_SYNTHETIC_RANDOM && def->scene != RLF_SYNTHETIC_HANDS
               ? RLF_OK
               : rlf_fail(RLF_ERROR_UNSUPPORTED,
                          "the rooms \"random\" and \"hands\" are not in the "
                          "browser's build: use the command");
}

/* In place of the library's, which then is not linked. */
void synth_random_build(synth_scene *scene, synth_random *random, const rlf_synthetic_def *def)
{
    (void)scene, (void)random, (void)def;
}

void synth_random_move(synth_scene *scene, double t)
{
    (void)scene, (void)t;
}

void synth_hands_build(synth_scene *scene, synth_hands *hands, const rlf_synthetic_def *def)
{
    (void)scene, (void)hands, (void)def;
}

void synth_hands_move(synth_scene *scene, double t)
{
    (void)scene, (void)t;
}
