/* People who were in view when the background was learnt and go; what they hid is room at once. */

#include "painted.h"
#include "test.h"

enum { WIDTH = 160, HEIGHT = 120, LEARNT = 8 };

#define WALL 3.6f
#define TABLE 2.8f
#define STEP 0.05f /* 1.5 m/s */

static void begin(void)
{
    const rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    start_seeing(&def);
    paint_all(WALL);
}

/* Half a metre wide and 0.8 m high, about the picture's middle. */
static area person_at(float z)
{
    const int half = (int)(0.25 * rig.depth.fx / (double)z);
    const int up = (int)(0.4 * rig.depth.fy / (double)z);
    return (area){WIDTH / 2 - half, WIDTH / 2 + half, HEIGHT / 2 - up, HEIGHT / 2 + up};
}

/* His picture shrinks within the one that he had when the room was learnt: all of it is farther
 * than what was known there. */
TEST_CASE(who_goes_away_from_the_camera_is_no_room)
{
    begin();
    float z = 1.6f;
    paint(person_at(z), z);
    see_often(LEARNT);
    for (int t = LEARNT; z < 2.6f; t++) {
        z += STEP;
        paint_all(WALL);
        const area person = person_at(z);
        paint(person, z);
        const rlf_surface *s = see();
        const int front = count_front(s, person);
        const int size = size_of(person);
        assert_true(front > size * 8 / 10);
        assert_true(s->foreground_count < front + size / 10);
    }
}

/* And who has stopped there stays a person. */
TEST_CASE(who_went_away_and_stands_is_no_room)
{
    begin();
    float z = 1.6f;
    const rlf_surface *s = NULL;
    for (int t = 0; t < LEARNT + 40; t++) {
        z += t >= LEARNT && t < LEARNT + 10 ? STEP : 0.0f;
        paint_all(WALL);
        paint(person_at(z), z);
        s = see();
    }
    const area person = person_at(z);
    assert_true(count_front(s, person) > size_of(person) / 2);
    paint_all(WALL);
    s = see_often(4);
    assert_int_equal(s->foreground_count, 0);
    assert_float_equal(s->background_depth[HEIGHT / 2 * WIDTH + WIDTH / 2], WALL, 0.02);
}

/* He stood before a table, and hid a part of the wall from the sensor beside him, too. */
TEST_CASE(what_he_hid_is_room_at_once)
{
    begin();
    const area table = {50, 110, 60, 100}, person = {60, 90, 20, 110}, shadow = {40, 60, 20, 110};
    paint(table, TABLE);
    paint(shadow, 0.0f);
    paint(person, 1.6f);
    see_often(LEARNT);
    for (int t = LEARNT; t < LEARNT + 12; t++) {
        paint_all(WALL);
        paint(table, TABLE);
        assert_int_equal(see()->foreground_count, 0);
    }
}

/* A niche that returned nothing while the room was learnt. */
TEST_CASE(what_is_seen_late_behind_the_room_is_room)
{
    begin();
    const area niche = {50, 110, 30, 90};
    paint(niche, 0.0f);
    see_often(LEARNT);
    paint(niche, WALL + 0.7f);
    for (int t = LEARNT; t < LEARNT + 12; t++) {
        assert_int_equal(see()->foreground_count, 0);
    }
}

TEST_EACH(NULL, stop_seeing)
