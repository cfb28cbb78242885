/* Settings of the synthetic source. */
#include "sim/sensor.h"

#include "base/checks.h"

#define COLOR_SIZE_MAX 4096
#define FPS_MAX 1000.0
#define SPEED_MAX 10.0
#define LAMP_MAX 20.0 /* metres from the camera */

static const char *const scene_names[] = {"room", "empty", "thesis", "chair",    "book",   "hand",
                                          "lift", "swipe", "carry",  "crossing", "random", "hands"};
static const char *const path_names[] = {"none", "orbit",   "walk", "handheld", "look_away",
                                         "fast", "carried", "bump", "opposite"};
#define PATH_COUNT ((int)(sizeof(path_names) / sizeof(path_names[0])))
#define SCENE_COUNT ((int)(sizeof(scene_names) / sizeof(scene_names[0])))

const char *synth_scene_name(rlf_synthetic_scene scene)
{
    return (int)scene >= 0 && (int)scene < SCENE_COUNT ? scene_names[scene] : NULL;
}

const char *synth_path_name(rlf_synthetic_path path)
{
    return (int)path >= 0 && (int)path < PATH_COUNT ? path_names[path] : NULL;
}

static rlf_result check_path(const rlf_synthetic_def *def)
{
    if (synth_path_name(def->path) == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: path is %d; use an rlf_synthetic_path",
                        (int)def->path);
    }
    if (def->path != RLF_SYNTHETIC_PATH_NONE && def->push != RLF_SYNTHETIC_PUSH_NONE) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: path and push do not go together");
    }
    return RLF_OK;
}

rlf_synthetic_def rlf_synthetic_def_default(void)
{
    rlf_synthetic_def def = {.cookie = RLF_DEF_COOKIE,
                             .scene = RLF_SYNTHETIC_ROOM,
                             .seed = 1,
                             .person = 1,
                             .frames_per_second = 30.0,
                             .frame_count = 300,
                             .speed = 0.5,
                             .lamp = {-0.70, -1.85, 1.5},
                             .enable_noise = true,
                             .enable_edge_filter = true,
                             .enable_color = true,
                             .enable_truth = true,
                             .color_width = 960,
                             .color_height = 540,
                             .hands = {.distance = 0.9, .hold = 0.5}};
    return def;
}

static rlf_result check_hands(const rlf_synthetic_hands_def *hands)
{
    if (rlf_synthetic_act_name(hands->act) == NULL || (int)hands->view < 0 ||
        hands->view > RLF_SYNTHETIC_VIEW_SIDE || (int)hands->body < 0 ||
        hands->body > RLF_SYNTHETIC_BODY_CAN) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "synthetic: hands.act, view and body are %d, %d and %d; use their enums",
                        (int)hands->act, (int)hands->view, (int)hands->body);
    }
    if (!(hands->distance >= 0.6 && hands->distance <= 3.0)) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: hands.distance is %g m; use 0.6 to 3",
                        hands->distance);
    }
    if (!(hands->size == 0.0 || (hands->size >= 0.03 && hands->size <= 0.2))) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: hands.size is %g m; use 0 or 0.03 to 0.2",
                        hands->size);
    }
    if (!(hands->hold >= 0.0 && hands->hold <= 60.0)) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: hands.hold is %g s; use 0 to 60",
                        hands->hold);
    }
    return RLF_OK;
}

rlf_result synth_def_check(const rlf_synthetic_def *def)
{
    if (synth_scene_name(def->scene) == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: scene is %d; use an rlf_synthetic_scene",
                        (int)def->scene);
    }
    if (!(def->frames_per_second > 0.0 && def->frames_per_second <= FPS_MAX)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "synthetic: frames_per_second is %g; use a number above 0, at most %g",
                        def->frames_per_second, FPS_MAX);
    }
    if (def->frame_count < -1 || def->frame_count > SYNTH_FRAME_COUNT_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "synthetic: frame_count is %lld; use -1 (endless) or 0 to %lld",
                        (long long)def->frame_count, (long long)SYNTH_FRAME_COUNT_MAX);
    }
    if (!(def->speed > 0.0 && def->speed <= SPEED_MAX)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "synthetic: speed is %g; use a number above 0, at most %g", def->speed,
                        SPEED_MAX);
    }
    if (!rlf_vec3_is_finite(def->lamp) || rlf_length(def->lamp) > LAMP_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: lamp is not a point within %g m", LAMP_MAX);
    }
    bool is_size = def->color_width >= 1 && def->color_width <= COLOR_SIZE_MAX &&
                   def->color_height >= 1 && def->color_height <= COLOR_SIZE_MAX;
    if (def->enable_color && !is_size) {
        return rlf_fail(
            RLF_ERROR_INVALID,
            "synthetic: color size, color_width x color_height, is %d x %d; use 1 to %d each",
            (int)def->color_width, (int)def->color_height, COLOR_SIZE_MAX);
    }
    if ((int)def->push < 0 || def->push > RLF_SYNTHETIC_PUSH_CARRY) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: push is %d; use an rlf_synthetic_push",
                        (int)def->push);
    }
    if (def->push != RLF_SYNTHETIC_PUSH_NONE && def->scene != RLF_SYNTHETIC_RANDOM) {
        return rlf_fail(RLF_ERROR_INVALID, "synthetic: push is for scene random only");
    }
    rlf_result result = check_path(def);
    return result == RLF_OK ? check_hands(&def->hands) : result;
}
