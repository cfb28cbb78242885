/* Scripted hands: their truth lies in the hands that the sensor sees, and the fingers meet where
 * the virtual body stands. */
#include "relief/snapshot.h"
#include "relief/synthetic.h"
#include "test.h"

#include <math.h>
#include <string.h>

#define VIEWS 3

static rlf_synthetic_def def_of(rlf_synthetic_act act, uint64_t seed)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.scene = RLF_SYNTHETIC_HANDS;
    def.seed = seed;
    def.enable_color = false;
    def.enable_truth = false;
    def.hands.act = act;
    return def;
}

static rlf_source *open_def(const rlf_synthetic_def *def)
{
    rlf_source *source = NULL;
    assert_int_equal(rlf_synthetic_create(def, &source), RLF_OK);
    return source;
}

static rlf_synthetic_task task_of(rlf_source *source)
{
    rlf_synthetic_task task;
    assert_int_equal(rlf_synthetic_get_task(source, &task), RLF_OK);
    return task;
}

static int32_t hands_at(rlf_source *source, double t, rlf_synthetic_hand *out)
{
    int32_t count = 0;
    assert_int_equal(rlf_synthetic_get_hands(source, t, out, &count), RLF_OK);
    return count;
}

TEST_CASE(joints_lie_inside_the_hand)
{
    for (int act = 0; act < RLF_SYNTHETIC_ACT_COUNT; act++) {
        rlf_synthetic_def def = def_of((rlf_synthetic_act)act, (uint64_t)act);
        def.hands.view = (rlf_synthetic_view)(act % VIEWS);
        rlf_source *source = open_def(&def);
        double end = task_of(source).end;
        for (double t = 0.3; t < end; t += 0.67) {
            rlf_synthetic_hand hands[RLF_SYNTHETIC_HANDS_MAX];
            int32_t count = hands_at(source, t, hands);
            assert_int_equal(count, act == RLF_SYNTHETIC_ACT_TWO_HANDS ? 2 : 1);
            for (int32_t i = 0; i < count * 20; i++) {
                rlf_synthetic_hit hit;
                rlf_vec3 p = hands[i / 20].joints[i % 20 / 4][i % 4];
                assert_int_equal(rlf_synthetic_nearest(source, t, p, &hit), RLF_OK);
                assert_true(hit.distance < -0.004);
            }
        }
        rlf_source_destroy(&source);
    }
}

/* Rays at the tips of an open hand meet them: nothing but their own skin is before them. */
TEST_CASE(tips_are_seen_at_their_depth)
{
    for (uint64_t seed = 1; seed <= 3; seed++) {
        rlf_synthetic_def def = def_of(RLF_SYNTHETIC_ACT_OPEN, seed);
        rlf_source *source = open_def(&def);
        rlf_synthetic_hand hand[RLF_SYNTHETIC_HANDS_MAX];
        rlf_frame frame;
        for (int k = 0; k <= 99; k++) {
            assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        }
        double t = 99 / def.frames_per_second;
        (void)hands_at(source, t, hand);
        assert_int_equal(hand[0].gesture, RLF_SYNTHETIC_GESTURE_OPEN);
        for (int f = 0; f < 5; f++) {
            rlf_vec3 p = hand[0].joints[f][3], ray = rlf_scale(p, 1.0 / p.z);
            float z = 0.0f;
            int32_t label = 0;
            assert_int_equal(
                rlf_synthetic_cast(source, rlf_vec3_make(0, 0, 0), &ray, 1, &z, &label), RLF_OK);
            assert_int_equal(label, RLF_SYNTHETIC_LABEL_HAND);
            double before = p.z - (double)z;
            assert_true(before > 0.8 * hand[0].tip_radius[f] * 0.8);
            assert_true(before < 3.0 * hand[0].tip_radius[f]);
        }
        rlf_source_destroy(&source);
    }
}

TEST_CASE(hands_have_true_sizes)
{
    double least = 1.0, most = 0.0;
    for (uint64_t seed = 1; seed <= 16; seed++) {
        rlf_synthetic_def def = def_of(RLF_SYNTHETIC_ACT_FLAT, seed);
        rlf_source *source = open_def(&def);
        rlf_synthetic_hand hand[RLF_SYNTHETIC_HANDS_MAX];
        (void)hands_at(source, 3.0, hand);
        double length = hand[0].length;
        rlf_vec3 wrist = hand[0].T_camera_hand.p;
        double reach = rlf_length(rlf_sub(hand[0].joints[2][3], wrist)) + hand[0].tip_radius[2];
        double knuckles = rlf_length(rlf_sub(hand[0].joints[1][0], hand[0].joints[4][0]));
        assert_true(fabs(reach / length - 1.0) < 0.03);
        assert_true(knuckles > 0.30 * length && knuckles < 0.36 * length);
        least = rlf_min(least, length);
        most = rlf_max(most, length);
        rlf_source_destroy(&source);
    }
    assert_true(least >= 0.160 && least < 0.172);
    assert_true(most <= 0.205 && most > 0.19);
}

/* Signed distance of p to the task's body. */
static double body_distance(const rlf_synthetic_task *task, rlf_vec3 p)
{
    rlf_vec3 at = rlf_transform_inverse(&task->T_camera_body[0], p), gradient;
    static const rlf_shape_type types[3] = {RLF_SHAPE_BOX, RLF_SHAPE_SPHERE, RLF_SHAPE_CYLINDER};
    rlf_shape shape = {.type = types[task->body], .size = task->size};
    shape.radius = 0.5 * task->size.x;
    shape.height = task->size.y;
    return rlf_shape_distance(&shape, at, &gradient);
}

/* Between the body and the nearest of a finger's last two joints, skin to skin. */
static double finger_gap(const rlf_synthetic_task *task, const rlf_synthetic_hand *hand, int finger)
{
    double tip = body_distance(task, hand->joints[finger][3]);
    double joint = body_distance(task, hand->joints[finger][2]);
    return rlf_min(tip, joint) - hand->tip_radius[finger];
}

TEST_CASE(fingers_close_on_the_body)
{
    for (uint64_t seed = 1; seed <= 12; seed++) {
        rlf_synthetic_def def = def_of((rlf_synthetic_act)(seed % 2), seed);
        def.hands.body = (rlf_synthetic_body)(seed / 2 % 3);
        rlf_source *source = open_def(&def);
        rlf_synthetic_task task = task_of(source);
        rlf_synthetic_hand closed[RLF_SYNTHETIC_HANDS_MAX], open[RLF_SYNTHETIC_HANDS_MAX];
        (void)hands_at(source, task.closed, closed);
        (void)hands_at(source, task.closed - 0.3, open);
        double thumb = finger_gap(&task, &closed[0], 0);
        double finger = rlf_min(finger_gap(&task, &closed[0], 1), finger_gap(&task, &closed[0], 2));
        assert_true(thumb < 0.0 && thumb > -0.007);
        assert_true(finger < 0.003 && finger > -0.007);
        assert_true(finger_gap(&task, &open[0], 0) > 0.008);
        assert_true(finger_gap(&task, &open[0], 1) > 0.008);
        rlf_source_destroy(&source);
    }
}

TEST_CASE(bodies_stand_on_the_table_or_hang)
{
    for (int act = 0; act <= RLF_SYNTHETIC_ACT_PASS; act++) {
        rlf_synthetic_def def = def_of((rlf_synthetic_act)act, 7);
        rlf_source *source = open_def(&def);
        rlf_synthetic_task task = task_of(source);
        rlf_vec3 down;
        assert_int_equal(rlf_synthetic_get_down(source, &down), RLF_OK);
        for (int32_t i = 0; i < task.body_count; i++) {
            rlf_synthetic_hit hit;
            rlf_vec3 foot = rlf_mad(task.T_camera_body[i].p, down, 0.5 * task.size.y);
            assert_int_equal(rlf_synthetic_nearest(source, 0.1, foot, &hit), RLF_OK);
            bool is_standing = fabs(hit.distance) < 1e-6;
            assert_true(hit.distance > -1e-6);
            assert_true(is_standing == (task.release <= 0.0));
        }
        rlf_source_destroy(&source);
    }
}

TEST_CASE(the_hand_carries_at_the_given_speed)
{
    for (int act = 0; act < RLF_SYNTHETIC_ACT_THROW; act++) {
        rlf_synthetic_def def = def_of((rlf_synthetic_act)act, 3);
        def.speed = 0.1 + 0.1 * act;
        rlf_source *source = open_def(&def);
        rlf_synthetic_task task = task_of(source);
        rlf_synthetic_hand hand[RLF_SYNTHETIC_HANDS_MAX];
        (void)hands_at(source, 0.5 * (task.lifted + task.carried), hand);
        assert_true(fabs(rlf_length(hand[0].velocity) - def.speed) < 1e-6);
        rlf_vec3 before = hand[0].palm;
        (void)hands_at(source, task.carried, hand);
        rlf_vec3 after = hand[0].palm;
        assert_true(fabs(rlf_length(rlf_sub(after, before)) - 0.25) < 1e-6);
        rlf_source_destroy(&source);
    }
}

TEST_CASE(a_throw_opens_at_its_speed)
{
    rlf_synthetic_def def = def_of(RLF_SYNTHETIC_ACT_THROW, 11);
    rlf_source *source = open_def(&def);
    rlf_synthetic_task task = task_of(source);
    rlf_synthetic_hand hand[RLF_SYNTHETIC_HANDS_MAX];
    (void)hands_at(source, task.opened + 0.05, hand);
    assert_true(rlf_length(rlf_sub(hand[0].velocity, task.thrown)) < 1e-6);
    assert_true(rlf_length(task.thrown) >= 0.8);
    rlf_source_destroy(&source);
}

/* A thumb and an index that meet, and the widths of other gestures. */
TEST_CASE(gestures_are_what_they_are_called)
{
    const double least[4] = {0.05, 0.0, 0.0, 0.03};
    const double most[4] = {0.2, 0.09, 0.002, 0.2};
    for (int act = RLF_SYNTHETIC_ACT_OPEN; act <= RLF_SYNTHETIC_ACT_POINT; act++) {
        rlf_synthetic_def def = def_of((rlf_synthetic_act)act, 2);
        rlf_source *source = open_def(&def);
        rlf_synthetic_hand hand[RLF_SYNTHETIC_HANDS_MAX];
        int i = act - RLF_SYNTHETIC_ACT_OPEN;
        (void)hands_at(source, 3.2, hand);
        assert_int_equal((int)hand[0].gesture, i + 1);
        assert_true(hand[0].pinch_width >= least[i] && hand[0].pinch_width <= most[i]);
        rlf_source_destroy(&source);
    }
}

TEST_CASE(same_seed_same_bits)
{
    rlf_synthetic_def def = def_of(RLF_SYNTHETIC_ACT_TWO_HANDS, 5);
    rlf_source *a = open_def(&def), *b = open_def(&def);
    rlf_frame x, y;
    for (int k = 0; k < 30; k++) {
        assert_int_equal(rlf_source_next(a, &x), RLF_OK);
        assert_int_equal(rlf_source_next(b, &y), RLF_OK);
    }
    assert_memory_equal(x.depth_u16, y.depth_u16, (size_t)x.depth_stride * 424);
    rlf_source_destroy(&a);
    rlf_source_destroy(&b);
}

TEST_CASE(sources_are_named)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    assert_int_equal(rlf_synthetic_parse("synthetic:hands?grasp=two_hands&view=above&distance=1.5"
                                         "&body=ball&size=0.08&hold=10&speed=0.2",
                                         &def),
                     RLF_OK);
    assert_int_equal(def.scene, RLF_SYNTHETIC_HANDS);
    assert_int_equal(def.hands.act, RLF_SYNTHETIC_ACT_TWO_HANDS);
    assert_int_equal(def.hands.view, RLF_SYNTHETIC_VIEW_ABOVE);
    assert_int_equal(def.hands.body, RLF_SYNTHETIC_BODY_BALL);
    assert_true(def.hands.distance == 1.5 && def.hands.size == 0.08 && def.hands.hold == 10.0);
    assert_int_equal(rlf_synthetic_parse("synthetic:hands?gesture=wave", &def), RLF_OK);
    assert_int_equal(def.hands.act, RLF_SYNTHETIC_ACT_WAVE);
    assert_int_equal(rlf_synthetic_parse("synthetic:hands?gesture=scoop", &def), RLF_ERROR_INVALID);
    assert_int_equal(rlf_synthetic_parse("synthetic:hands?distance=5", &def), RLF_ERROR_INVALID);
    assert_int_equal(rlf_synthetic_parse("synthetic:hands?view=below", &def), RLF_ERROR_INVALID);
    assert_null(rlf_synthetic_act_name(RLF_SYNTHETIC_ACT_COUNT));
}

TEST_CASE(other_sources_have_no_hands)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.enable_color = false;
    rlf_source *source = open_def(&def);
    rlf_synthetic_hand hands[RLF_SYNTHETIC_HANDS_MAX];
    rlf_synthetic_task task;
    int32_t count = 0;
    assert_int_equal(rlf_synthetic_get_hands(source, 0.0, hands, &count), RLF_ERROR_INVALID);
    assert_int_equal(rlf_synthetic_get_task(source, &task), RLF_ERROR_INVALID);
    rlf_source_destroy(&source);
    def.scene = RLF_SYNTHETIC_HANDS;
    def.hands.distance = 0.2;
    assert_int_equal(rlf_synthetic_create(&def, &source), RLF_ERROR_INVALID);
}
