/* Foreground mask against truth. */
#include "eval/measures/foreground.h"

static void add(eval_confusion *c, bool found, bool is_true)
{
    c->true_positive += found && is_true;
    c->false_positive += found && !is_true;
    c->false_negative += !found && is_true;
    c->true_negative += !found && !is_true;
}

void eval_foreground_add(eval_foreground *e, const rlf_surface *s, const rlf_truth *truth,
                         const rlf_rig *rig)
{
    if (s->background_state != RLF_BACKGROUND_READY) {
        return;
    }
    for (int32_t y = 0; y < s->height; y++) {
        for (int32_t x = 0; x < s->width; x++) {
            int32_t i = y * s->width + x;
            int32_t t = y * s->scale_factor * rig->depth.width + x * s->scale_factor;
            bool found = s->foreground[i] != 0;
            bool is_true = truth->foreground[t] != 0;
            add(&e->all, found, is_true);
            if (s->reason[i] == RLF_REASON_OK) {
                add(&e->valid, found, is_true);
            }
        }
    }
}

static double share(int64_t part, int64_t rest)
{
    return part + rest > 0 ? (double)part / (double)(part + rest) : 1.0;
}

double eval_precision(const eval_confusion *c)
{
    return share(c->true_positive, c->false_positive);
}
double eval_recall(const eval_confusion *c)
{
    return share(c->true_positive, c->false_negative);
}

double eval_f_measure(const eval_confusion *c)
{
    return share(2 * c->true_positive, c->false_positive + c->false_negative);
}
