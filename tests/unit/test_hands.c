/* Hands found in drawn surfaces: palms, tips, gestures, ids, and what is no hand. */
#include "hand_scene.h"
#include "test.h"

#include <stdio.h>

#define FRAME_NS INT64_C(33333333)

typedef struct bench {
    hand_scene *scene;
    rlf_hand_tracker *tracker;
    int64_t time_ns;
    double wall; /* behind the hands, metres */
} bench;

static bench bench_create(void)
{
    bench b = {.scene = scene_create(), .time_ns = 1000, .wall = 3.5};
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

/* One frame with these hands before the wall. */
static const rlf_hands *show(bench *b, scene_hand *hands, int count, bool is_noisy)
{
    b->time_ns += FRAME_NS;
    scene_clear(b->scene, b->wall, b->time_ns);
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

TEST_CASE(test_open_hand)
{
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
        check_tips(seen, &h, 0.016);
        assert_int_equal(seen->gesture, RLF_GESTURE_OPEN);
        assert_int_equal(seen->detail, RLF_HAND_TIPS);
        bench_destroy(&b);
    }
}

TEST_CASE(test_gestures)
{
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
        const rlf_hands *out = show_for(&b, &h, 1, 8);
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

/* Stands at `x` and looks at the camera: arms to the sides and forward, head and legs. */
static void draw_person(hand_scene *s, double x, double z, scene_hand *hands)
{
    const rlf_vec3 hip = {x, 0.15, z}, chest = {x, -0.25, z};
    scene_rod(s, hip, chest, 0.14, 0.16);
    scene_rod(s, chest, rlf_vec3_make(x, -0.50, z), 0.06, 0.06);
    scene_ball(s, rlf_vec3_make(x, -0.60, z), 0.085);
    for (int side = -1; side <= 1; side += 2) {
        const rlf_vec3 knee = {x + side * 0.12, 0.55, z}, foot = {x + side * 0.14, 0.95, z};
        scene_rod(s, rlf_vec3_make(x + side * 0.09, 0.15, z), knee, 0.09, 0.075);
        scene_rod(s, knee, foot, 0.075, 0.055);
        scene_rod(s, foot, rlf_vec3_make(foot.x + side * 0.05, 0.98, z - 0.18), 0.045, 0.04);
        scene_hand *h = &hands[(side + 1) / 2];
        *h = (scene_hand){.palm = {x + side * 0.48, -0.35, z - 0.15},
                          .turn = side * 0.6,
                          .fingers = FINGERS_ALL,
                          .arm = 0.15};
        scene_draw_hand(s, h);
        const rlf_vec3 elbow = scene_hand_point(h, 0.0, -0.26);
        scene_rod(s, elbow, rlf_vec3_make(x + side * 0.17, -0.36, z - 0.02), 0.045, 0.055);
    }
}

/* Two people at 2.4 m have four hands; heads and feet are none. */
TEST_CASE(test_people)
{
    bench b = bench_create();
    scene_hand hands[4];
    const rlf_hands *out = NULL;
    for (int k = 0; k < 6; k++) {
        b.time_ns += FRAME_NS;
        scene_clear(b.scene, 4.0, b.time_ns);
        draw_person(b.scene, -0.75, 2.4, hands);
        draw_person(b.scene, 0.75, 2.4, hands + 2);
        scene_noise(b.scene);
        out = rlf_hand_tracker_update(b.tracker, &b.scene->surface);
        check_finite(out);
    }
    for (int i = 0; i < out->count; i++) {
        const rlf_hand *h = &out->hand[i];
        print_message("at %.2f %.2f %.2f radius %.0f mm: %.2f side %d %s\n", h->palm.x, h->palm.y,
                      h->palm.z, 1000.0 * h->palm_radius, h->confidence, (int)h->side,
                      rlf_gesture_name(h->gesture));
    }
    assert_int_equal(count_sure(out), 4);
    for (int k = 0; k < 4; k++) {
        const rlf_hand *seen = near_point(out, hands[k].palm);
        assert_non_null(seen);
        print_message("palm off %.1f mm\n", 1000.0 * off(seen->palm, hands[k].palm));
        assert_true(off(seen->palm, hands[k].palm) < 0.012);
        assert_int_equal(seen->detail, RLF_HAND_PALM_ONLY);
        assert_int_equal(seen->gesture, RLF_GESTURE_OPEN);
        assert_int_equal(seen->side, k % 2 == 0 ? RLF_HAND_RIGHT : RLF_HAND_LEFT);
    }
    bench_destroy(&b);
}

/* As one who stands with the thighs together: the body ends at the knees, and shins and feet look
 * like forearms and hands. */
static void draw_upright(hand_scene *s, double z, scene_hand *hands)
{
    draw_person(s, 0.0, z, hands);
    scene_rod(s, rlf_vec3_make(0.0, 0.15, z), rlf_vec3_make(0.0, 0.62, z), 0.2, 0.15);
    for (int side = -1; side <= 1; side += 2) {
        const double x = side * 0.11;
        scene_rod(s, rlf_vec3_make(x, 0.6, z), rlf_vec3_make(x, 1.0, z), 0.045, 0.03);
        scene_ball(s, rlf_vec3_make(x, 1.05, z), 0.042);
    }
}

static int count_low(const rlf_hands *out, double least_y)
{
    int count = 0;
    for (int i = 0; i < out->count; i++) {
        count += out->hand[i].confidence >= RLF_HAND_SURE && out->hand[i].palm.y > least_y;
    }
    return count;
}

/* Who stands has two hands and no more. Where down is not known, a foot is taken for one. */
TEST_CASE(test_feet)
{
    const rlf_vec3 downs[2] = {{0, 2.5, 0}, {0, 0, 0}};
    for (int n = 0; n < 2; n++) {
        bench b = bench_create();
        scene_hand hands[2];
        const rlf_hands *out = NULL;
        rlf_hand_tracker_set_down(b.tracker, downs[n]);
        for (int k = 0; k < 12; k++) {
            b.time_ns += FRAME_NS;
            scene_clear(b.scene, 4.0, b.time_ns);
            draw_upright(b.scene, 2.4, hands);
            scene_noise(b.scene);
            out = rlf_hand_tracker_update(b.tracker, &b.scene->surface);
            check_finite(out);
        }
        for (int i = 0; i < out->count; i++) {
            print_message("down %d: at %.2f %.2f %.2f: %.2f\n", n, out->hand[i].palm.x,
                          out->hand[i].palm.y, out->hand[i].palm.z, out->hand[i].confidence);
        }
        assert_int_equal(count_low(out, 0.5), n);
        assert_int_equal(count_sure(out) - count_low(out, 0.5), 2);
        bench_destroy(&b);
    }
}

/* An arm that points at the camera hides its shoulder: it hangs in front of the body. */
TEST_CASE(test_arm_forward)
{
    bench b = bench_create();
    const rlf_hands *out = NULL;
    rlf_vec3 palm = {0.1, -0.2, 1.3};
    for (int k = 0; k < 12; k++) {
        b.time_ns += FRAME_NS;
        scene_clear(b.scene, 4.0, b.time_ns);
        scene_rod(b.scene, rlf_vec3_make(0, 0.15, 2.0), rlf_vec3_make(0, -0.25, 2.0), 0.14, 0.16);
        palm.y += 0.01; /* hands move */
        const rlf_vec3 elbow = {0.32, palm.y + 0.22, 1.75}, wrist = {0.1, palm.y + 0.1, 1.36};
        scene_rod(b.scene, rlf_vec3_make(0.2, -0.2, 1.95), elbow, 0.055, 0.05);
        scene_rod(b.scene, elbow, wrist, 0.048, 0.028);
        scene_hand h = {.palm = palm, .fingers = 0, .arm = 0.0};
        scene_draw_hand(b.scene, &h);
        scene_noise(b.scene);
        out = rlf_hand_tracker_update(b.tracker, &b.scene->surface);
        check_finite(out);
    }
    assert_int_equal(count_sure(out), 1);
    const rlf_hand *seen = near_point(out, palm);
    assert_non_null(seen);
    assert_true(off(seen->palm, palm) < 0.015);
    bench_destroy(&b);
}

/* A sensor mixes the depths of both sides of an edge: every pixel of it, here 55 mm behind. */
static void mix_edges(hand_scene *s)
{
    for (int i = 1; i < SCENE_N - 1; i++) {
        const bool is_edge = s->foreground[i - 1] == 0 || s->foreground[i + 1] == 0;
        s->depth[i] += s->foreground[i] != 0 && is_edge ? 0.055f : 0.0f;
    }
}

TEST_CASE(test_fist_with_mixed_edges)
{
    bench b = bench_create();
    scene_hand h = {.palm = {0.0, 0.75, 2.4}, .turn = 0.1, .arm = 0.8};
    const rlf_hands *out = NULL;
    for (int k = 0; k < 8; k++) {
        b.time_ns += FRAME_NS;
        scene_clear(b.scene, 4.0, b.time_ns);
        h.palm.x += 0.01; /* hands move */
        scene_draw_hand(b.scene, &h);
        mix_edges(b.scene);
        scene_noise(b.scene);
        out = rlf_hand_tracker_update(b.tracker, &b.scene->surface);
        check_finite(out);
    }
    const rlf_hand *seen = near_point(out, h.palm);
    assert_non_null(seen);
    assert_int_equal(seen->gesture, RLF_GESTURE_FIST);
    bench_destroy(&b);
}

/* A pinch is told by its fingers: what is 70 mm behind it does not matter. */
TEST_CASE(test_pinch_before_a_wall)
{
    bench b = bench_create();
    b.wall = 0.87;
    scene_hand h = {.palm = {0.0, 0.0, 0.8}, .turn = 0.3, .fingers = FINGERS_RING, .arm = 0.7};
    const rlf_hands *out = show_for(&b, &h, 1, 8);
    assert_int_equal(out->count, 1);
    assert_int_equal(out->hand[0].gesture, RLF_GESTURE_PINCH);
    bench_destroy(&b);
}

/* A leg from below with its shoe, a head from above, a chair's back and leg, a ball in the air. */
TEST_CASE(test_no_hands)
{
    for (int k = 0; k < 4; k++) {
        bench b = bench_create();
        const rlf_hands *out = NULL;
        for (int frame = 0; frame < 4; frame++) {
            hand_scene *s = b.scene;
            b.time_ns += FRAME_NS;
            scene_clear(s, 3.0, b.time_ns);
            if (k == 0) {
                scene_rod(s, rlf_vec3_make(0, 1.2, 1.5), rlf_vec3_make(0, 0.6, 1.5), 0.09, 0.085);
                scene_rod(s, rlf_vec3_make(0, 0.6, 1.5), rlf_vec3_make(0.1, 0.0, 1.5), 0.08, 0.06);
                scene_rod(s, rlf_vec3_make(0.1, 0.0, 1.5), rlf_vec3_make(0.3, -0.02, 1.5), 0.05,
                          0.05);
            } else if (k == 1) {
                scene_rod(s, rlf_vec3_make(0, 0.9, 1.2), rlf_vec3_make(0, 0.1, 1.2), 0.06, 0.06);
                scene_ball(s, rlf_vec3_make(0, 0.0, 1.2), 0.095);
            } else if (k == 2) {
                for (double x = -0.2; x <= 0.2; x += 0.02) {
                    scene_rod(s, rlf_vec3_make(x, 0.9, 1.2), rlf_vec3_make(x, 0.0, 1.2), 0.015,
                              0.015);
                }
                scene_rod(s, rlf_vec3_make(-0.5, 0.9, 1.2), rlf_vec3_make(-0.5, 0.0, 1.2), 0.011,
                          0.011);
            } else {
                scene_ball(s, rlf_vec3_make(0, 0, 1.0), 0.04);
                scene_rod(s, rlf_vec3_make(0.2, 0, 1.0), rlf_vec3_make(0.5, 0, 1.0), 0.03, 0.03);
            }
            scene_noise(s);
            out = rlf_hand_tracker_update(b.tracker, &s->surface);
            check_finite(out);
        }
        for (int i = 0; i < out->count; i++) {
            print_message("case %d at %.2f %.2f %.2f radius %.0f mm: %.2f\n", k,
                          out->hand[i].palm.x, out->hand[i].palm.y, out->hand[i].palm.z,
                          1000.0 * out->hand[i].palm_radius, out->hand[i].confidence);
        }
        assert_int_equal(count_sure(out), 0);
        bench_destroy(&b);
    }
}

/* Six hands that leave by all borders, held together, with rods in them: nothing but finite
 * numbers.
 */
TEST_CASE(test_many_and_leaving)
{
    bench b = bench_create();
    for (int k = 0; k < 24; k++) {
        b.time_ns += FRAME_NS;
        scene_clear(b.scene, 2.5, b.time_ns);
        for (int n = 0; n < 6; n++) {
            const double turn = n * RLF_PI / 3.0, far = 0.02 * k + 0.04;
            scene_hand h = {.palm = {far * rlf_sin(turn), -far * rlf_cos(turn), 0.5 + 0.05 * n},
                            .turn = turn + 0.1 * k,
                            .fingers = n * 7 % 32,
                            .arm = 0.1 * n};
            scene_draw_hand(b.scene, &h);
            scene_rod(b.scene, h.palm, scene_hand_point(&h, 0.3, 0.1), 0.01, 0.02);
        }
        scene_noise(b.scene);
        const rlf_hands *out = rlf_hand_tracker_update(b.tracker, &b.scene->surface);
        check_finite(out);
        assert_true(out->count <= RLF_HANDS_MAX);
    }
    bench_destroy(&b);
}

/* Two arms from below; they cross the picture, keep their ids, and nothing is allocated. */
TEST_CASE(test_follows)
{
    bench b = bench_create();
    scene_hand h[2] = {{.palm = {-0.25, 0.1, 0.9}, .turn = 0.2, .fingers = FINGERS_ALL, .arm = 0.8},
                       {.palm = {0.25, 0.1, 1.0}, .turn = -0.2, .fingers = 0, .arm = 0.8}};
    const rlf_hands *out = show_for(&b, h, 2, 8);
    assert_int_equal(count_sure(out), 2);
    const int32_t left = near_point(out, h[0].palm)->id, right = near_point(out, h[1].palm)->id;
    const uint64_t allocated = rlf_alloc_count();
    double most = 0.0;
    for (int k = 0; k < 30; k++) {
        h[0].palm.y -= 0.6 / 30.0;
        h[1].palm.x += 0.3 / 30.0;
        h[0].palm.y += k < 15 ? 0.0 : 1.2 / 30.0;
        out = show(&b, h, 2, true);
        const rlf_hand *a = near_point(out, h[0].palm), *c = near_point(out, h[1].palm);
        assert_true(a != NULL && c != NULL && a->id == left && c->id == right);
        most = rlf_max(most, off(a->palm, h[0].palm));
        most = rlf_max(most, off(c->palm, h[1].palm));
        if (k == 12) {
            assert_true(rlf_length(rlf_sub(a->velocity, rlf_vec3_make(0, -0.6, 0))) < 0.12);
        }
    }
    print_message("at 0.6 m/s palms are off %.1f mm at most\n", 1000.0 * most);
    assert_true(most < 0.014);
    assert_true(rlf_alloc_count() == allocated);
    assert_int_equal(near_point(out, h[0].palm)->side, RLF_HAND_LEFT);
    assert_int_equal(near_point(out, h[1].palm)->side, RLF_HAND_RIGHT);
    scene_hand none[1];
    out = show(&b, none, 0, true);
    assert_int_equal(out->count, 0);
    out = show_for(&b, h, 2, 3); /* a gap of one frame */
    assert_int_equal(near_point(out, h[0].palm)->id, left);
    show_for(&b, none, 0, 12); /* 0.4 s: a new hand */
    out = show_for(&b, h, 2, 3);
    assert_true(near_point(out, h[0].palm)->id > right);
    bench_destroy(&b);
}

static int count_events(const rlf_hands *hands, rlf_hand_event_kind kind)
{
    int count = 0;
    for (int i = 0; i < hands->event_count; i++) {
        count += hands->event[i].kind == kind;
    }
    return count;
}

/* How often each kind of event comes while the hand goes `way` and back, `times` times. */
static void move_hand(rlf_vec3 way, int times, int frames, int counts[RLF_HAND_EVENT_COUNT])
{
    bench b = bench_create();
    scene_hand h = {.palm = {0.0, 0.1, 1.0}, .fingers = FINGERS_ALL, .arm = 0.8};
    memset(counts, 0, RLF_HAND_EVENT_COUNT * sizeof(counts[0]));
    const rlf_vec3 start = rlf_mad(h.palm, way, -0.5);
    for (int k = -8; k < times * frames + 8; k++) {
        const int stroke = k < 0 ? 0 : (k >= times * frames ? times - 1 : k / frames);
        const double t = rlf_clamp((double)(k - stroke * frames) / frames, 0.0, 1.0);
        h.palm = rlf_mad(start, way, stroke % 2 == 0 ? t : 1.0 - t);
        const rlf_hands *out = show(&b, &h, 1, true);
        for (int kind = 0; kind < RLF_HAND_EVENT_COUNT; kind++) {
            counts[kind] += count_events(out, (rlf_hand_event_kind)kind);
        }
    }
    bench_destroy(&b);
}

TEST_CASE(test_motions)
{
    int n[RLF_HAND_EVENT_COUNT];
    move_hand(rlf_vec3_make(0.4, 0, 0), 1, 10, n);
    assert_int_equal(n[RLF_HAND_EVENT_SWIPE_RIGHT], 1);
    assert_int_equal(n[RLF_HAND_EVENT_SWIPE_LEFT] + n[RLF_HAND_EVENT_WAVE], 0);
    assert_int_equal(n[RLF_HAND_EVENT_OPEN], 1);
    move_hand(rlf_vec3_make(-0.4, 0, 0), 1, 10, n);
    assert_int_equal(n[RLF_HAND_EVENT_SWIPE_LEFT], 1);
    move_hand(rlf_vec3_make(0.12, 0, 0), 8, 7, n);
    assert_int_equal(n[RLF_HAND_EVENT_WAVE], 1);
    assert_int_equal(n[RLF_HAND_EVENT_SWIPE_LEFT] + n[RLF_HAND_EVENT_SWIPE_RIGHT], 0);
    move_hand(rlf_vec3_make(0, -0.25, 0), 1, 9, n);
    assert_int_equal(n[RLF_HAND_EVENT_PUSH], 1);
    move_hand(rlf_vec3_make(0.1, -0.05, 0), 1, 30, n);
    for (int kind = RLF_HAND_EVENT_PUSH; kind < RLF_HAND_EVENT_COUNT; kind++) {
        assert_int_equal(n[kind], 0);
    }
}

/* The same frames give the same bits; a tracker that was reset is as a new one. */
TEST_CASE(test_same_bits)
{
    bench a = bench_create(), b = bench_create();
    scene_hand h = {.palm = {0.1, 0.0, 0.8}, .turn = 0.5, .fingers = FINGERS_ALL, .arm = 0.8};
    show_for(&b, &h, 1, 3);
    rlf_hand_tracker_reset(b.tracker);
    b.time_ns = a.time_ns;
    b.scene->noise = a.scene->noise;
    for (int k = 0; k < 5; k++) {
        h.palm.x += 0.01;
        const rlf_hands *x = show(&a, &h, 1, true), *y = show(&b, &h, 1, true);
        assert_int_equal(x->count, y->count);
        assert_memory_equal(x->hand, y->hand, (size_t)x->count * sizeof(x->hand[0]));
        assert_memory_equal(x->owner, y->owner, SCENE_N);
    }
    bench_destroy(&a);
    bench_destroy(&b);
}

TEST_CASE(test_empty_and_odd)
{
    bench b = bench_create();
    scene_clear(b.scene, 0.0, 5); /* no depth at all */
    assert_int_equal(rlf_hand_tracker_update(b.tracker, &b.scene->surface)->count, 0);
    memset(b.scene->foreground, 1, sizeof(b.scene->foreground)); /* but all of it foreground */
    assert_int_equal(rlf_hand_tracker_update(b.tracker, &b.scene->surface)->count, 0);
    for (int i = 0; i < SCENE_N; i++) { /* speckle */
        b.scene->noise = b.scene->noise * 1664525u + 1013904223u;
        b.scene->depth[i] = (float)(0.5 + (double)(b.scene->noise >> 8) / 8388608.0);
        b.scene->foreground[i] = (b.scene->noise >> 30) == 0;
    }
    const rlf_hands *out = rlf_hand_tracker_update(b.tracker, &b.scene->surface);
    check_finite(out);
    assert_int_equal(count_sure(out), 0);
    bench_destroy(&b);
    rlf_hand_tracker_def def = rlf_hand_tracker_def_default(0, 4);
    rlf_hand_tracker *tracker = NULL;
    assert_int_equal(rlf_hand_tracker_create(&def, &tracker), RLF_ERROR_INVALID);
    def = rlf_hand_tracker_def_default(3, 2);
    def.smooth_hz = 0.0;
    assert_int_equal(rlf_hand_tracker_create(&def, &tracker), RLF_ERROR_INVALID);
    assert_null(tracker);
}

TEST_CASE(test_names)
{
    for (int k = 0; k < RLF_HAND_EVENT_COUNT; k++) {
        rlf_hand_event_kind kind = RLF_HAND_EVENT_COUNT;
        assert_true(rlf_hand_event_parse(rlf_hand_event_name((rlf_hand_event_kind)k), &kind));
        assert_int_equal(kind, k);
    }
    rlf_hand_event_kind kind = RLF_HAND_EVENT_WAVE;
    assert_false(rlf_hand_event_parse("clap", &kind));
    assert_int_equal(kind, RLF_HAND_EVENT_WAVE);
    assert_string_equal(rlf_gesture_name(RLF_GESTURE_FIST), "fist");
    assert_null(rlf_gesture_name((rlf_gesture)9));
}
