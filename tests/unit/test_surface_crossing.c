/* Two people who walk past each other: each keeps his label, whoever is hidden meanwhile. */

#include "heavy.h"
#include "created.h"
#include "seen_view.h"
#include "test.h"

/* Both are inside the picture, apart; then one hides the other; then they are apart again. */
enum { FRAMES = 122, APART_FROM = 48, HIDDEN_FROM = 72, HIDDEN_TO = 86, LABELS = 256 };

/* Label of most of the foreground's pixels that truly show `person`. */
static int32_t label_of(const rlf_surface *s, const rlf_truth *truth, int32_t person)
{
    int32_t votes[LABELS] = {0}, best = 0;
    for (int32_t i = 0; i < s->width * s->height; i++) {
        if (truth->label[i] == person && s->foreground[i] && s->label[i] < LABELS) {
            votes[s->label[i]]++;
        }
    }
    for (int32_t k = 1; k < LABELS; k++) {
        best = votes[k] > votes[best] ? k : best;
    }
    return best;
}

static void check_seed(uint64_t seed)
{
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.scene = RLF_SYNTHETIC_CROSSING;
    synthetic.enable_color = false;
    synthetic.frame_count = FRAMES;
    synthetic.seed = seed;
    rlf_source *source = synthetic_of(&synthetic);
    rlf_reconstruct_def def =
        rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rlf_source_get_info(source)->rig);
    rlf_reconstruct *stage = stage_of(&def);
    int32_t near = 0, far = 0;
    rlf_frame frame;
    for (int t = 0; rlf_source_next(source, &frame) == RLF_OK; t++) {
        const rlf_surface *s = surface_of(stage, &frame);
        const rlf_truth *truth = rlf_source_get_truth(source);
        if (t == APART_FROM) {
            near = label_of(s, truth, RLF_SYNTHETIC_LABEL_PERSON);
            far = label_of(s, truth, RLF_SYNTHETIC_LABEL_SECOND_PERSON);
            assert_true(near > 0 && far > 0 && near != far);
        }
        if (t > APART_FROM) {
            assert_int_equal(label_of(s, truth, RLF_SYNTHETIC_LABEL_PERSON), near);
        }
        if (t > APART_FROM && (t < HIDDEN_FROM || t >= HIDDEN_TO)) {
            assert_int_equal(label_of(s, truth, RLF_SYNTHETIC_LABEL_SECOND_PERSON), far);
        }
    }
    rlf_reconstruct_destroy(&stage);
    rlf_source_destroy(&source);
}

TEST_CASE(each_keeps_his_label)
{
    heavy_needs_whole(); /* unit.surface_person runs the same code */
    for (uint64_t seed = 1; seed <= 2; seed++) {
        check_seed(seed);
    }
}
