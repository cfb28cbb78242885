/* scene.json's "on": what events of hands do. */
#include "io/scene/reader.h"

#include <string.h>

static const char *const action_names[RLF_HAND_ACTION_COUNT] = {"none", "spawn", "throw", "remove",
                                                                "reset"};

static rlf_result read_action(const io_json_object *on, const char *key, rlf_scene *scene)
{
    const io_json_field field = {key, "none, spawn, throw, remove or reset", 0, 0, true};
    rlf_hand_event_kind kind;
    if (!rlf_hand_event_parse(key, &kind)) {
        return io_json_fail(on, key,
                            "is not an event of a hand: use pinch, pinch_end, open, fist, point, "
                            "point_end, push, swipe_left, swipe_right or wave");
    }
    const char *name = NULL;
    rlf_result result = io_json_get_text(on, &field, &name);
    if (result != RLF_OK) {
        return result;
    }
    for (int k = 0; k < RLF_HAND_ACTION_COUNT; k++) {
        if (strcmp(name, action_names[k]) == 0) {
            scene->on[kind] = (rlf_hand_action)k;
            return RLF_OK;
        }
    }
    return io_json_fail(on, key, "is \"%.60s\": it must be %s", name, field.meaning);
}

rlf_result io_on_read(const io_json_object *top, rlf_scene *scene)
{
    static const io_json_field field = {"on", "an object of events and actions", 0, 0, false};
    io_json_object on;
    rlf_result result = io_json_get_object(top, &field, &on);
    if (result != RLF_OK || on.value == NULL) {
        return result;
    }
    const char *key;
    json_t *value;
    json_object_foreach(on.value, key, value)
    {
        result = result == RLF_OK ? read_action(&on, key, scene) : result;
    }
    return result;
}
