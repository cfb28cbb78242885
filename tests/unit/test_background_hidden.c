/* Pixels that return nothing: what a thing hides, what is in the sensor's shadow, the rim; and what
 * the shadow hid when the background was learnt. */

#include "seen_view.h"
#include "test.h"

enum { WIDTH = 160, HEIGHT = 120, COUNT = WIDTH * HEIGHT, LEARNT = 8, RIM = 10 };

static const float WALL = 3.0f, NEAR_Z = 0.7f;

static float depth[COUNT];

static rlf_reconstruct *make_stage(void)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    return seen_view_stage(&def);
}

static const rlf_surface *process(rlf_reconstruct *stage, int32_t number)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    return seen_depth_process(&rig, depth, stage, number);
}

typedef struct area {
    int x0, x1, y0, y1;
} area;

static void put(area a, float z)
{
    for (int y = a.y0; y < a.y1; y++) {
        for (int x = a.x0; x < a.x1; x++) {
            depth[y * WIDTH + x] = z;
        }
    }
}

static const area ALL = {0, WIDTH, 0, HEIGHT};

static int count_front(const rlf_surface *s, area a)
{
    int count = 0;
    for (int y = a.y0; y < a.y1; y++) {
        for (int x = a.x0; x < a.x1; x++) {
            count += s->foreground[y * WIDTH + x];
        }
    }
    return count;
}

static int size_of(area a)
{
    return (a.x1 - a.x0) * (a.y1 - a.y0);
}

static rlf_reconstruct *learn(void)
{
    rlf_reconstruct *stage = make_stage();
    for (int t = 0; t < LEARNT; t++) {
        process(stage, t);
    }
    return stage;
}

/* A print on a shirt returns nothing; beside the elbow the wall is seen. */
static void a_hole_in_a_thing_is_its_own(void **state)
{
    (void)state;
    const area thing = {50, 110, 30, 100}, print = {70, 90, 40, 56}, gap = {60, 80, 70, 90};
    put(ALL, WALL);
    rlf_reconstruct *stage = learn();
    put(thing, NEAR_Z);
    put(print, 0.0f);
    put(gap, WALL);
    const rlf_surface *s = process(stage, LEARNT);
    assert_int_equal(count_front(s, print), size_of(print));
    assert_int_equal(count_front(s, (area){61, 79, 71, 89}), 0);
    for (int y = print.y0; y < print.y1; y++) {
        for (int x = print.x0; x < print.x1; x++) {
            int i = y * WIDTH + x;
            assert_float_equal(s->depth[i], NEAR_Z, 0.02);
            assert_int_equal(s->reason[i], RLF_REASON_FILLED);
            assert_true(s->normal_z[i] < -0.9f && s->thickness[i] > 0.0f && s->label[i] > 0);
        }
    }
    rlf_reconstruct_destroy(&stage);
}

/* Hair above a face, before a wall that always returns something; and before a window, which never
 * does: there nothing tells. */
static void what_hides_the_wall_is_the_thing(void **state)
{
    (void)state;
    const area face = {70, 100, 50, 100}, hair = {70, 100, 34, 50};
    for (int window = 0; window < 2; window++) {
        put(ALL, WALL);
        put((area){40, 130, 10, 60}, window ? 0.0f : WALL);
        rlf_reconstruct *stage = learn();
        put(face, NEAR_Z);
        put(hair, 0.0f);
        const rlf_surface *s = NULL;
        for (int t = LEARNT; t < LEARNT + 4; t++) { /* its edges tell that there is no shadow */
            s = process(stage, t);
        }
        int front = count_front(s, hair);
        assert_true(window ? front < size_of(hair) / 4 : front > size_of(hair) * 8 / 10);
        assert_true(count_front(s, (area){0, 60, 0, HEIGHT}) == 0);
        rlf_reconstruct_destroy(&stage);
    }
}

/* A sensor with a baseline of 7 cm: beside all near things there is a strip on their left. Where
 * nothing returns on the right of a thing, it is a sleeve. */
static void the_shadow_is_not_the_thing(void **state)
{
    (void)state;
    const int wide = (int)(0.714 * WIDTH * 0.07 * (1.0 / NEAR_Z - 1.0 / WALL) + 0.5) + 2;
    const area post = {20, 30, 0, HEIGHT}, thing = {80, 110, 30, 100};
    const area sleeve = {110, 122, 50, 70};
    put(ALL, WALL);
    put(post, NEAR_Z);
    put((area){post.x0 - wide, post.x0, 0, HEIGHT}, 0.0f);
    rlf_reconstruct *stage = learn();
    const area shadow = {thing.x0 - wide, thing.x0, thing.y0, thing.y1};
    put(thing, NEAR_Z);
    put(shadow, 0.0f);
    put(sleeve, 0.0f);
    const rlf_surface *s = process(stage, LEARNT);
    assert_true(count_front(s, shadow) < 3 * (shadow.y1 - shadow.y0));
    assert_true(count_front(s, sleeve) > size_of(sleeve) * 6 / 10);
    rlf_reconstruct_destroy(&stage);
}

/* The sensor sees nothing in the last columns: what they cut goes on to the border. */
static void things_go_on_into_the_rim(void **state)
{
    (void)state;
    const area rim = {WIDTH - RIM, WIDTH, 0, HEIGHT}, thing = {120, WIDTH, 40, 80};
    put(ALL, WALL);
    put(rim, 0.0f);
    rlf_reconstruct *stage = learn();
    put(thing, NEAR_Z);
    put(rim, 0.0f);
    const rlf_surface *s = process(stage, LEARNT);
    assert_int_equal(count_front(s, (area){rim.x0, WIDTH, 42, 78}), RIM * 36);
    assert_int_equal(count_front(s, (area){rim.x0, WIDTH, 0, 38}), 0);
    assert_int_equal(count_front(s, (area){rim.x0, WIDTH, 82, HEIGHT}), 0);
    rlf_reconstruct_destroy(&stage);
}

/* A board stood in front of the wall in the first frames, with its shadow beside it. It leaves. */
static void the_wall_in_a_shadow_is_no_phantom(void **state)
{
    (void)state;
    const area board = {70, 110, 30, 100}, shadow = {50, 70, 30, 100};
    put(ALL, WALL);
    put(board, NEAR_Z);
    put(shadow, 0.0f);
    rlf_reconstruct *stage = learn();
    put(ALL, WALL);
    const rlf_surface *s = NULL;
    for (int t = LEARNT; t < LEARNT + 12; t++) {
        s = process(stage, t);
    }
    assert_int_equal(s->foreground_count, 0);
    rlf_reconstruct_destroy(&stage);
}

/* Something comes before what returned nothing when the background was learnt. */
static void what_comes_before_a_window_is_foreground(void **state)
{
    (void)state;
    const area window = {40, 120, 20, 90}, thing = {60, 90, 30, 80};
    put(ALL, WALL);
    put(window, 0.0f);
    rlf_reconstruct *stage = learn();
    for (int t = LEARNT; t < LEARNT + 20; t++) {
        put(thing, NEAR_Z);
        const rlf_surface *s = process(stage, t);
        assert_true(count_front(s, thing) > size_of(thing) * 9 / 10);
    }
    rlf_reconstruct_destroy(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hole_in_a_thing_is_its_own),
        cmocka_unit_test(what_hides_the_wall_is_the_thing),
        cmocka_unit_test(the_shadow_is_not_the_thing),
        cmocka_unit_test(things_go_on_into_the_rim),
        cmocka_unit_test(the_wall_in_a_shadow_is_no_phantom),
        cmocka_unit_test(what_comes_before_a_window_is_foreground),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
