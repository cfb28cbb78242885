/* People who were in view when the background was learnt and go; what they hid is room at once. */

#include "seen_view.h"
#include "test.h"

enum { WIDTH = 160, HEIGHT = 120, COUNT = WIDTH * HEIGHT, LEARNT = 8 };

#define WALL 3.6f
#define TABLE 2.8f
#define STEP 0.05f /* 1.5 m/s */

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

static const area ALL = {0, WIDTH, 0, HEIGHT};

static void put(area a, float z)
{
    for (int y = a.y0; y < a.y1; y++) {
        for (int x = a.x0; x < a.x1; x++) {
            depth[y * WIDTH + x] = z;
        }
    }
}

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

/* Half a metre wide and 0.8 m high, about the picture's middle. */
static area person_at(float z)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    const int half = (int)(0.25 * rig.depth.fx / (double)z);
    const int up = (int)(0.4 * rig.depth.fy / (double)z);
    return (area){WIDTH / 2 - half, WIDTH / 2 + half, HEIGHT / 2 - up, HEIGHT / 2 + up};
}

/* His picture shrinks within the one that he had when the room was learnt: all of it is farther
 * than what was known there. */
static void who_goes_away_from_the_camera_is_no_room(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage();
    float z = 1.6f;
    put(ALL, WALL);
    put(person_at(z), z);
    for (int t = 0; t < LEARNT; t++) {
        process(stage, t);
    }
    for (int t = LEARNT; z < 2.6f; t++) {
        z += STEP;
        put(ALL, WALL);
        const area person = person_at(z);
        put(person, z);
        const rlf_surface *s = process(stage, t);
        const int front = count_front(s, person);
        const int size = (person.x1 - person.x0) * (person.y1 - person.y0);
        assert_true(front > size * 8 / 10);
        assert_true(s->foreground_count < front + size / 10);
    }
    rlf_reconstruct_destroy(&stage);
}

/* And who has stopped there stays a person. */
static void who_went_away_and_stands_is_no_room(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage();
    float z = 1.6f;
    const rlf_surface *s = NULL;
    for (int t = 0; t < LEARNT + 40; t++) {
        z += t >= LEARNT && t < LEARNT + 10 ? STEP : 0.0f;
        put(ALL, WALL);
        put(person_at(z), z);
        s = process(stage, t);
    }
    const area person = person_at(z);
    assert_true(count_front(s, person) > (person.x1 - person.x0) * (person.y1 - person.y0) / 2);
    put(ALL, WALL);
    for (int t = LEARNT + 40; t < LEARNT + 44; t++) {
        s = process(stage, t);
    }
    assert_int_equal(s->foreground_count, 0);
    assert_float_equal(s->background_depth[HEIGHT / 2 * WIDTH + WIDTH / 2], WALL, 0.02);
    rlf_reconstruct_destroy(&stage);
}

/* He stood before a table, and hid a part of the wall from the sensor beside him, too. */
static void what_he_hid_is_room_at_once(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage();
    const area table = {50, 110, 60, 100}, person = {60, 90, 20, 110}, shadow = {40, 60, 20, 110};
    put(ALL, WALL);
    put(table, TABLE);
    put(shadow, 0.0f);
    put(person, 1.6f);
    for (int t = 0; t < LEARNT; t++) {
        process(stage, t);
    }
    for (int t = LEARNT; t < LEARNT + 12; t++) {
        put(ALL, WALL);
        put(table, TABLE);
        assert_int_equal(process(stage, t)->foreground_count, 0);
    }
    rlf_reconstruct_destroy(&stage);
}

/* A niche that returned nothing while the room was learnt. */
static void what_is_seen_late_behind_the_room_is_room(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage();
    const area niche = {50, 110, 30, 90};
    put(ALL, WALL);
    put(niche, 0.0f);
    for (int t = 0; t < LEARNT; t++) {
        process(stage, t);
    }
    put(niche, WALL + 0.7f);
    for (int t = LEARNT; t < LEARNT + 12; t++) {
        assert_int_equal(process(stage, t)->foreground_count, 0);
    }
    rlf_reconstruct_destroy(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_goes_away_from_the_camera_is_no_room),
        cmocka_unit_test(who_went_away_and_stands_is_no_room),
        cmocka_unit_test(what_he_hid_is_room_at_once),
        cmocka_unit_test(what_is_seen_late_behind_the_room_is_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
