/* Pixels that return nothing: what a thing hides, what is in the sensor's shadow, the rim; and what
 * the shadow hid when the background was learnt. */

#include "painted.h"
#include "test.h"

enum { WIDTH = 160, HEIGHT = 120, LEARNT = 8, RIM = 10 };

static const float WALL = 3.0f, NEAR_Z = 0.7f;

/* A wall, nothing else, before anything is learnt. */
static void begin(void)
{
    const rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    start_seeing(&def);
    paint_all(WALL);
}

/* A print on a shirt returns nothing; beside the elbow the wall is seen. */
TEST_CASE(a_hole_in_a_thing_is_its_own)
{
    const area thing = {50, 110, 30, 100}, print = {70, 90, 40, 56}, gap = {60, 80, 70, 90};
    begin();
    see_often(LEARNT);
    paint(thing, NEAR_Z);
    paint(print, 0.0f);
    paint(gap, WALL);
    const rlf_surface *s = see();
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
}

/* Hair above a face, before a wall that always returns something; and before a window, which never
 * does: there nothing tells. */
TEST_CASE(what_hides_the_wall_is_the_thing)
{
    const area face = {70, 100, 50, 100}, hair = {70, 100, 34, 50};
    for (int window = 0; window < 2; window++) {
        begin();
        paint((area){40, 130, 10, 60}, window ? 0.0f : WALL);
        see_often(LEARNT);
        paint(face, NEAR_Z);
        paint(hair, 0.0f);
        const rlf_surface *s = see_often(4); /* its edges tell that there is no shadow */
        int front = count_front(s, hair);
        assert_true(window ? front < size_of(hair) / 4 : front > size_of(hair) * 8 / 10);
        assert_true(count_front(s, (area){0, 60, 0, HEIGHT}) == 0);
    }
}

/* A sensor with a baseline of 7 cm: beside all near things there is a strip on their left. Where
 * nothing returns on the right of a thing, it is a sleeve. */
TEST_CASE(the_shadow_is_not_the_thing)
{
    const int wide = (int)(0.714 * WIDTH * 0.07 * (1.0 / NEAR_Z - 1.0 / WALL) + 0.5) + 2;
    const area post = {20, 30, 0, HEIGHT}, thing = {80, 110, 30, 100};
    const area sleeve = {110, 122, 50, 70};
    begin();
    paint(post, NEAR_Z);
    paint((area){post.x0 - wide, post.x0, 0, HEIGHT}, 0.0f);
    see_often(LEARNT);
    const area shadow = {thing.x0 - wide, thing.x0, thing.y0, thing.y1};
    paint(thing, NEAR_Z);
    paint(shadow, 0.0f);
    paint(sleeve, 0.0f);
    const rlf_surface *s = see();
    assert_true(count_front(s, shadow) < 3 * (shadow.y1 - shadow.y0));
    assert_true(count_front(s, sleeve) > size_of(sleeve) * 6 / 10);
}

/* The sensor sees nothing in the last columns: what they cut goes on to the border. */
TEST_CASE(things_go_on_into_the_rim)
{
    const area rim = {WIDTH - RIM, WIDTH, 0, HEIGHT}, thing = {120, WIDTH, 40, 80};
    begin();
    paint(rim, 0.0f);
    see_often(LEARNT);
    paint(thing, NEAR_Z);
    paint(rim, 0.0f);
    const rlf_surface *s = see();
    assert_int_equal(count_front(s, (area){rim.x0, WIDTH, 42, 78}), RIM * 36);
    assert_int_equal(count_front(s, (area){rim.x0, WIDTH, 0, 38}), 0);
    assert_int_equal(count_front(s, (area){rim.x0, WIDTH, 82, HEIGHT}), 0);
}

/* A board stood in front of the wall in the first frames, with its shadow beside it. It leaves. */
TEST_CASE(the_wall_in_a_shadow_is_no_phantom)
{
    const area board = {70, 110, 30, 100}, shadow = {50, 70, 30, 100};
    begin();
    paint(board, NEAR_Z);
    paint(shadow, 0.0f);
    see_often(LEARNT);
    paint_all(WALL);
    assert_int_equal(see_often(12)->foreground_count, 0);
}

/* Something comes before what returned nothing when the background was learnt. */
TEST_CASE(what_comes_before_a_window_is_foreground)
{
    const area window = {40, 120, 20, 90}, thing = {60, 90, 30, 80};
    begin();
    paint(window, 0.0f);
    see_often(LEARNT);
    for (int t = LEARNT; t < LEARNT + 20; t++) {
        paint(thing, NEAR_Z);
        const rlf_surface *s = see();
        assert_true(count_front(s, thing) > size_of(thing) * 9 / 10);
    }
}

TEST_EACH(NULL, stop_seeing)
