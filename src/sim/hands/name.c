/* Names of acts, as in a source's string. */
#include "relief/synthetic_hands.h"

#include <stddef.h>

static const char *const act_names[RLF_SYNTHETIC_ACT_COUNT] = {
    "pinch_above", "pinch_side", "fist_bar", "two_hands", "scoop", "under", "throw", "pass",
    "open",        "fist",       "pinch",    "point",     "flat",  "swipe", "wave"};

const char *rlf_synthetic_act_name(rlf_synthetic_act act)
{
    return (int)act >= 0 && act < RLF_SYNTHETIC_ACT_COUNT ? act_names[act] : NULL;
}
