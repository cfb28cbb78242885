/* Gestures of another's hand: found, told, and tips, where the simulator's own are not asked. */
#include "eval/hands/another.h"
#include "eval/hands/hands.h"
#include "eval/measures/percent.h"

#define FRAME_S (1.0 / 30.0)
#define HOLD_FRAMES 22 /* a gesture is shown for 0.7 s ... */
#define LATE_FRAMES 6  /* ... may be told so late ... */
#define SHOWN 8        /* ... and so many are shown */
#define NEAR_M 0.12
#define TIP_M 0.03

typedef struct judge_sums {
    int64_t frames, found, judged, right, false_hands, tips, strays;
    int64_t of[5], right_of[5];
    double palm;
} judge_sums;

/* A raised hand whose palm or back is seen, bent at the wrist as people do. */
static void raise_hand(another_hand *h, eval_random *r)
{
    const double side = h->is_left ? 1.0 : -1.0, far = eval_random_range(r, 0.6, 1.3);
    const rlf_vec3 at = {side * eval_random_range(r, 0.05, 0.25) * far,
                         eval_random_range(r, -0.15, 0.1) * far, far};
    const double yaw = eval_random_range(r, -0.8, 0.8), pitch = eval_random_range(r, -0.7, 0.5);
    const double roll = eval_random_range(r, -0.5, 0.5);
    const bool shows_back = eval_random_range(r, 0.0, 1.0) < 0.4;
    /* y up in the picture, z to or from the camera. */
    rlf_quat q = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), RLF_PI);
    q = shows_back ? q : rlf_quat_mul(rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), RLF_PI), q);
    q = rlf_quat_mul(rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), yaw), q);
    q = rlf_quat_mul(rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), pitch), q);
    h->T_camera_hand =
        (rlf_pose){at, rlf_quat_mul(rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), roll), q)};
    h->shoulder = rlf_vec3_make(side * 0.22, -0.12, far + eval_random_range(r, 0.35, 0.5));
    h->chest = rlf_vec3_make(h->shoulder.x * 0.3, 0.15, h->shoulder.z);
    const rlf_vec3 y = rlf_rotate(h->T_camera_hand.q, rlf_vec3_make(0, 1, 0));
    const rlf_vec3 low = {side * 0.15, 0.9, 0.55};
    const rlf_vec3 fore = rlf_normalize(rlf_add(rlf_scale(y, -0.8), rlf_normalize(low)));
    h->elbow = rlf_mad(at, fore, 0.26);
}

static void add_frame(judge_sums *s, const rlf_hands *found, const another_hand *h, int32_t age)
{
    const rlf_hand *best = NULL;
    double least = NEAR_M;
    for (int32_t i = 0; i < found->count; i++) {
        const rlf_hand *f = &found->hand[i];
        const double far = rlf_length(rlf_sub(f->palm, h->palm));
        s->false_hands += f->confidence >= RLF_HAND_SURE && far >= 2.0 * NEAR_M;
        if (f->confidence >= RLF_HAND_SURE && far < least) {
            least = far;
            best = f;
        }
    }
    s->frames++;
    s->found += best != NULL;
    s->palm += best != NULL ? least : 0.0;
    if (h->grip.gesture != RLF_GESTURE_NONE && age >= LATE_FRAMES) {
        const bool is_right = best != NULL && best->gesture == h->grip.gesture;
        s->judged++;
        s->right += is_right;
        s->of[h->grip.gesture]++;
        s->right_of[h->grip.gesture] += is_right;
    }
    for (int32_t k = 0; best != NULL && k < best->tip_count; k++) {
        double off = 1e9;
        for (int32_t digit = 0; digit < 5; digit++) {
            off = rlf_min(off, rlf_length(rlf_sub(best->tip[k], h->tip[digit])));
        }
        s->tips += off < TIP_M;
        s->strays += off >= TIP_M;
    }
}

static rlf_result judge(judge_sums *s, eval_random *r)
{
    const rlf_hand_tracker_def def = rlf_hand_tracker_def_default(ANOTHER_WIDTH, ANOTHER_HEIGHT);
    rlf_hand_tracker *tracker = NULL;
    another_view *view = another_view_create();
    rlf_result result = view != NULL ? rlf_hand_tracker_create(&def, &tracker) : RLF_ERROR_MEMORY;
    another_hand h;
    another_hand_draw_lots(&h, r);
    raise_hand(&h, r);
    another_grip from = another_grip_draw_lots(&h, RLF_GESTURE_NONE, r);
    int64_t frame = 0;
    for (int32_t n = 0; n < SHOWN && result == RLF_OK; n++) {
        const rlf_gesture gesture = (rlf_gesture)(1 + n % 4);
        const another_grip to = another_grip_draw_lots(&h, gesture, r);
        const int32_t frames = (int32_t)eval_random_range(r, 8.0, 14.0);
        const rlf_vec3 start = h.T_camera_hand.p, way = {eval_random_range(r, -0.06, 0.06),
                                                         eval_random_range(r, -0.06, 0.06), 0.0};
        for (int32_t k = 1; k < frames + HOLD_FRAMES; k++) {
            const double t = rlf_clamp((double)k / frames, 0.0, 1.0);
            const double share = t * t * (3.0 - 2.0 * t);
            h.grip = another_grip_mix(&from, &to, share);
            h.T_camera_hand.p = rlf_mad(start, way, share);
            const rlf_surface *surface =
                another_view_show(view, &h, 1, r, 1000 + (int64_t)(1e9 * FRAME_S) * frame++);
            add_frame(s, rlf_hand_tracker_update(tracker, surface), &h, k - frames);
        }
        from = to;
    }
    rlf_hand_tracker_destroy(&tracker);
    another_view_destroy(view);
    return result;
}

static void add(eval_table *table, const char *key, const char *title, double value)
{
    eval_table_add(table, GESTURES_SECTION, key, title, RLF_PROFILE_LIVE, value);
}

rlf_result hands_judge_run(eval_table *table, int64_t seed)
{
    static const char *const keys[5] = {NULL, "another_open", "another_fist", "another_pinch",
                                        "another_point"};
    static const char *const titles[5] = {NULL, "    open, %", "    fist, %", "    pinch, %",
                                          "    point, %"};
    judge_sums s = {0};
    eval_random r = eval_random_start((uint64_t)(seed * 1000 + 900));
    rlf_result result = RLF_OK;
    for (int32_t n = 0; n < 3 && result == RLF_OK; n++) {
        result = judge(&s, &r);
    }
    if (result != RLF_OK) {
        return result;
    }
    add(table, "another_found", "another's hand, drawn, at 0.6 to 1.3 m: found, %",
        eval_percent(s.found, s.frames));
    add(table, "another_false", "  marks where no hand is, % of frames",
        eval_percent(s.false_hands, s.frames));
    add(table, "another_palm_mm", "  palm off by, mm",
        s.found > 0 ? 1e3 * s.palm / (double)s.found : NAN);
    add(table, "another_strays", "  tips that are none, %",
        eval_percent(s.strays, s.tips + s.strays));
    add(table, "another_gestures", "  gestures right after six frames, %",
        eval_percent(s.right, s.judged));
    for (int k = 1; k < 5; k++) {
        add(table, keys[k], titles[k], eval_percent(s.right_of[k], s.of[k]));
    }
    return RLF_OK;
}
