/* Hands found in drawn surfaces: palms, tips, gestures, ids, and what is no hand. */
#include "hand_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>

#define FRAME_NS INT64_C(33333333)

typedef struct bench {
    hand_scene *scene;
    rlf_hand_tracker *tracker;
    int64_t time_ns;
} bench;

static bench bench_create(void)
{
    bench b = {.scene = scene_create(), .time_ns = 1000};
    const rlf_hand_tracker_def def = rlf_hand_tracker_def_default(SCENE_W, SCENE_H);
    assert_int_equal(rlf_hand_tracker_create(&def, &b.tracker), RLF_OK);
    return b;
}

static void bench_destroy(bench *b)
{
    rlf_hand_tracker_destroy(&b->tracker);
    free(b->scene);
}

static void check_finite(const rlf_hands *hands)
{
    for (int i = 0; i < hands->count; i++) {
        const rlf_hand *h = &hands->hand[i];
        assert_true(rlf_vec3_is_finite(h->palm) && rlf_vec3_is_finite(h->velocity));
        assert_true(rlf_vec3_is_finite(h->normal) && rlf_vec3_is_finite(h->direction));
        assert_true(rlf_vec3_is_finite(h->arm_direction) && rlf_vec3_is_finite(h->pinch_point));
        assert_true(rlf_is_finite(h->confidence) && rlf_is_finite(h->palm_radius));
        assert_true(h->tip_count >= 0 && h->tip_count <= RLF_HAND_TIPS_MAX);
        for (int k = 0; k < h->tip_count; k++) {
            assert_true(rlf_vec3_is_finite(h->tip[k]));
        }
    }
}

/* One frame with these hands before a wall at 3.5 m. */
static const rlf_hands *show(bench *b, scene_hand *hands, int count, bool is_noisy)
{
    b->time_ns += FRAME_NS;
    scene_clear(b->scene, 3.5, b->time_ns);
    for (int i = 0; i < count; i++) {
        scene_draw_hand(b->scene, &hands[i]);
    }
    if (is_noisy) {
        scene_noise(b->scene);
    }
    const rlf_hands *out = rlf_hand_tracker_update(b->tracker, &b->scene->surface);
    assert_non_null(out);
    check_finite(out);
    return out;
}

static const rlf_hands *show_for(bench *b, scene_hand *hands, int count, int frames)
{
    const rlf_hands *out = NULL;
    for (int k = 0; k < frames; k++) {
        out = show(b, hands, count, true);
    }
    return out;
}

static int count_sure(const rlf_hands *hands)
{
    int count = 0;
    for (int i = 0; i < hands->count; i++) {
        count += hands->hand[i].confidence >= RLF_HAND_SURE;
    }
    return count;
}

/* The sure hand that is nearest in the picture. */
static const rlf_hand *near_point(const rlf_hands *hands, rlf_vec3 p)
{
    const rlf_hand *best = NULL;
    double least = 0.1;
    for (int i = 0; i < hands->count; i++) {
        const double d = rlf_length(rlf_sub(hands->hand[i].palm, p));
        if (hands->hand[i].confidence >= RLF_HAND_SURE && d < least) {
            best = &hands->hand[i];
            least = d;
        }
    }
    return best;
}

/* Across the view: the seen surface is in front of the bones. */
static double off(rlf_vec3 a, rlf_vec3 b)
{
    const double dx = a.x - b.x, dy = a.y - b.y;
    return sqrt(dx * dx + dy * dy);
}

static void check_tips(const rlf_hand *h, const scene_hand *truth, double tolerance)
{
    for (int k = 0; k < 5; k++) {
        double least = 1.0;
        for (int i = 0; i < h->tip_count; i++) {
            least = rlf_min(least, off(h->tip[i], truth->tip[k]));
        }
        if ((truth->fingers & (1 << k)) != 0 && least > tolerance) {
            fail_msg("finger %d: the nearest tip is %.1f mm away", k, 1000.0 * least);
        }
    }
}

static void test_open_hand(void **state)
{
    (void)state;
    for (int turn = 0; turn < 8; turn++) {
        bench b = bench_create();
        scene_hand h = {.palm = {0.02, -0.03, 0.9},
                        .turn = turn * RLF_PI / 4.0,
                        .fingers = FINGERS_ALL,
                        .arm = 0.8};
        const rlf_hands *out = show_for(&b, &h, 1, 4);
        assert_int_equal(count_sure(out), 1);
        const rlf_hand *seen = near_point(out, h.palm);
        assert_non_null(seen);
        print_message("turn %d: palm off %.1f mm, %d tips, %s, radius %.1f mm\n", turn,
                      1000.0 * off(seen->palm, h.palm), seen->tip_count,
                      rlf_gesture_name(seen->gesture), 1000.0 * seen->palm_radius);
        assert_true(off(seen->palm, h.palm) < 0.008);
        assert_int_equal(seen->tip_count, 5);
        check_tips(seen, &h, 0.010);
        assert_int_equal(seen->gesture, RLF_GESTURE_OPEN);
        assert_int_equal(seen->detail, RLF_HAND_TIPS);
        bench_destroy(&b);
    }
}

static void test_gestures(void **state)
{
    (void)state;
    static const struct {
        int fingers;
        rlf_gesture gesture;
    } cases[] = {{FINGERS_ALL, RLF_GESTURE_OPEN},
                 {30, RLF_GESTURE_OPEN},
                 {0, RLF_GESTURE_FIST},
                 {FINGERS_INDEX, RLF_GESTURE_POINT},
                 {FINGERS_INDEX | 4, RLF_GESTURE_NONE},
                 {FINGERS_RING, RLF_GESTURE_PINCH},
                 {FINGERS_RING | 28, RLF_GESTURE_PINCH}};
    for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
        bench b = bench_create();
        scene_hand h = {
            .palm = {0.0, 0.0, 0.8}, .turn = 0.3, .fingers = cases[k].fingers, .arm = 0.7};
        const rlf_hands *out = show_for(&b, &h, 1, 4);
        assert_int_equal(out->count, 1);
        const rlf_hand *seen = &out->hand[0];
        print_message("fingers %d: %s, %d tips, palm off %.1f mm, confidence %.2f\n",
                      cases[k].fingers, rlf_gesture_name(seen->gesture), seen->tip_count,
                      1000.0 * off(seen->palm, h.palm), seen->confidence);
        assert_int_equal(seen->gesture, cases[k].gesture);
        assert_true(seen->confidence >= RLF_HAND_SURE);
        if (cases[k].gesture == RLF_GESTURE_PINCH) {
            assert_true(off(seen->pinch_point, h.pinch) < 0.015);
            assert_true(seen->pinch_width == 0.0);
        } else if (cases[k].gesture == RLF_GESTURE_POINT) {
            assert_true(off(seen->tip[0], h.tip[1]) < 0.010);
        }
        bench_destroy(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_open_hand),
        cmocka_unit_test(test_gestures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
