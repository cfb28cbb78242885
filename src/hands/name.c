/* Names of gestures and events. */
#include "relief/hands.h"

#include <string.h>

const char *rlf_gesture_name(rlf_gesture gesture)
{
    static const char *const names[] = {"none", "open", "fist", "pinch", "point"};
    const int32_t k = (int32_t)gesture;
    return k >= 0 && k <= RLF_GESTURE_POINT ? names[k] : NULL;
}

const char *rlf_hand_event_name(rlf_hand_event_kind kind)
{
    static const char *const names[RLF_HAND_EVENT_COUNT] = {
        "pinch",     "pinch_end", "open",       "fist",        "point",
        "point_end", "push",      "swipe_left", "swipe_right", "wave"};
    const int32_t k = (int32_t)kind;
    return k >= 0 && k < RLF_HAND_EVENT_COUNT ? names[k] : NULL;
}

bool rlf_hand_event_parse(const char *name, rlf_hand_event_kind *out)
{
    for (int32_t k = 0; k < RLF_HAND_EVENT_COUNT; k++) {
        if (strcmp(name, rlf_hand_event_name((rlf_hand_event_kind)k)) == 0) {
            *out = (rlf_hand_event_kind)k;
            return true;
        }
    }
    return false;
}
