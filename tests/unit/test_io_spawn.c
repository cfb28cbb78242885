/* scene.json's spawn patterns: where their bodies are, what differs, what is refused. */
#define _POSIX_C_SOURCE 200809L

#include "io/scene/pattern.h"
#include "io/scene/reader.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>
#include <stdio.h>

static rlf_result parse(const char *text, rlf_scene *scene)
{
    io_bytes file = {"scene.json", (const uint8_t *)text, strlen(text)};
    return io_scene_parse(&file, test_folder, scene);
}

/* A scene whose only bodies are those of the entry `text`. */
static rlf_scene spawn(const char *text)
{
    char document[1024];
    rlf_scene scene;
    (void)snprintf(document, sizeof(document), "{\"spawn\":[{%s}]}", text);
    if (parse(document, &scene) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return scene;
}

static void expect_place(const rlf_scene *scene, int32_t index, double x, double y, double z)
{
    rlf_vec3 p = scene->bodies[index].position;
    if (rlf_length(rlf_sub(p, rlf_vec3_make(x, y, z))) > 1e-12) {
        fail_msg("body %d is at %.15g %.15g %.15g", (int)index, p.x, p.y, p.z);
    }
}

TEST_CASE(a_grid_is_centred_and_begins_below)
{
    rlf_scene scene =
        spawn("\"body\":{\"name\":\"cube\",\"position\":[1,2,3],\"mass\":7},\"pattern\":\"grid\","
              "\"count\":[3,2,2],\"spacing\":[0.1,0.2,0.4]");
    assert_int_equal(scene.body_count, 12);
    expect_place(&scene, 0, 0.9, 2.1, 2.8);
    expect_place(&scene, 1, 1.0, 2.1, 2.8);
    expect_place(&scene, 3, 0.9, 2.1, 3.2);
    expect_place(&scene, 6, 0.9, 1.9, 2.8); /* y points down */
    expect_place(&scene, 11, 1.1, 1.9, 3.2);
    assert_string_equal(scene.bodies[0].name, "cube_0001");
    assert_string_equal(scene.bodies[11].name, "cube_0012");
    for (int32_t i = 0; i < 12; i++) {
        assert_true(scene.bodies[i].mass == 7 && scene.bodies[i].release_time == 0);
    }
    rlf_scene_destroy(&scene);
}

/* Upwards is against the scene's gravity, whatever the camera's mount. */
TEST_CASE(a_stack_rises_and_a_ring_is_level)
{
    const struct {
        const char *gravity;
        rlf_vec3 up;
    } cases[] = {{"\"floor\"", {0, -1, 0}},
                 {"[0,0,0]", {0, -1, 0}},
                 {"[0,6,8]", {0, -0.6, -0.8}},
                 {"[-3,0,0]", {1, 0, 0}}};
    for (size_t k = 0; k < 4; k++) {
        char text[512];
        rlf_scene scene;
        (void)snprintf(text, sizeof(text),
                       "{\"gravity\":%s,\"spawn\":[{\"body\":{\"position\":[0,0,2]},\"pattern\":"
                       "\"stack\",\"count\":4,\"spacing\":0.25},{\"body\":{\"position\":[1,0,2]},"
                       "\"pattern\":\"ring\",\"count\":12,\"radius\":0.5}]}",
                       cases[k].gravity);
        assert_int_equal(parse(text, &scene), RLF_OK);
        assert_int_equal(scene.body_count, 16);
        rlf_vec3 up = cases[k].up, sum = {0, 0, 0};
        for (int32_t i = 0; i < 4; i++) {
            expect_place(&scene, i, 0.25 * i * up.x, 0.25 * i * up.y, 2 + 0.25 * i * up.z);
        }
        for (int32_t i = 0; i < 12; i++) {
            const rlf_body_def *b = &scene.bodies[4 + i], *next = &scene.bodies[4 + (i + 1) % 12];
            rlf_vec3 r = rlf_sub(b->position, rlf_vec3_make(1, 0, 2));
            double gap = rlf_length(rlf_sub(next->position, b->position));
            assert_true(fabs(rlf_length(r) - 0.5) < 1e-12 && fabs(rlf_dot(r, up)) < 1e-12);
            assert_true(fabs(gap - 2 * 0.5 * sin(RLF_PI / 12)) < 1e-12);
            sum = rlf_add(sum, r);
        }
        assert_true(rlf_length(sum) < 1e-12);
        assert_string_equal(scene.bodies[4].name, ""); /* the world's body-N */
        rlf_scene_destroy(&scene);
    }
}

static const char *const RANDOM_PLACES =
    "\"body\":{\"shape\":\"sphere\",\"radius\":0.05,\"position\":[0,-1,2]},\"pattern\":\"random\","
    "\"count\":100,\"box\":[1.2,0.4,0.8]";

TEST_CASE(random_places_fill_the_box_and_keep_apart)
{
    rlf_scene scene = spawn(RANDOM_PLACES);
    const rlf_vec3 middle = {0, -1, 2};
    int32_t octants[8] = {0};
    for (int32_t i = 0; i < 100; i++) {
        rlf_vec3 r = rlf_sub(scene.bodies[i].position, middle);
        assert_true(fabs(r.x) <= 0.55 && fabs(r.y) <= 0.15 && fabs(r.z) <= 0.35);
        octants[(r.x > 0) + 2 * (r.y > 0) + 4 * (r.z > 0)]++;
        for (int32_t k = 0; k < i; k++) {
            rlf_vec3 way = rlf_sub(scene.bodies[i].position, scene.bodies[k].position);
            assert_true(rlf_length(way) >= 0.1 - 1e-9);
        }
    }
    for (int i = 0; i < 8; i++) {
        assert_in_range(octants[i], 5, 20);
    }
    rlf_scene_destroy(&scene);
    /* flat, and fuller than it can be: all the same in the box */
    scene = spawn("\"body\":{\"size\":[1,1,1]},\"pattern\":\"random\",\"count\":30,"
                  "\"box\":[2,0,0.5]");
    for (int32_t i = 0; i < 30; i++) {
        rlf_vec3 p = scene.bodies[i].position;
        assert_true(fabs(p.x) <= 1 && p.y == 0 && fabs(p.z - 1) <= 0.25);
    }
    rlf_scene_destroy(&scene);
}

static int32_t count_moved(const rlf_scene *a, const rlf_scene *b)
{
    int32_t count = 0;
    assert_int_equal(a->body_count, b->body_count);
    for (int32_t i = 0; i < a->body_count; i++) {
        rlf_vec3 way = rlf_sub(a->bodies[i].position, b->bodies[i].position);
        count += rlf_length(way) > 0.0;
    }
    return count;
}

TEST_CASE(a_seed_always_gives_the_same_and_a_key_changes_its_own_only)
{
    char text[512];
    rlf_scene first = spawn(RANDOM_PLACES), again = spawn(RANDOM_PLACES);
    assert_int_equal(count_moved(&first, &again), 0);
    rlf_scene_destroy(&again);
    (void)snprintf(text, sizeof(text), "%s,\"seed\":5", RANDOM_PLACES);
    rlf_scene other = spawn(text);
    assert_in_range(count_moved(&first, &other), 90, 100);
    (void)snprintf(text, sizeof(text), "%s,\"seed\":5,\"turned\":true,\"velocity_spread\":[1,0,2]",
                   RANDOM_PLACES);
    rlf_scene varied = spawn(text);
    assert_int_equal(count_moved(&other, &varied), 0);
    (void)snprintf(text, sizeof(text), "%s,\"seed\":5,\"velocity_spread\":[1,0,2]", RANDOM_PLACES);
    rlf_scene straight = spawn(text);
    for (int32_t i = 0; i < 100; i++) {
        const rlf_body_def *a = &varied.bodies[i], *b = &straight.bodies[i];
        assert_true(rlf_length(rlf_sub(a->velocity, b->velocity)) == 0.0);
        assert_true(fabs(a->velocity.x) <= 1 && a->velocity.y == 0 && fabs(a->velocity.z) <= 2);
        assert_true(b->orientation.w == 1.0 && a->orientation.w != 1.0);
    }
    rlf_scene_destroy(&first);
    rlf_scene_destroy(&other);
    rlf_scene_destroy(&varied);
    rlf_scene_destroy(&straight);
}

/* The same bits on every machine: a scene's run is compared by its hash. */
TEST_CASE(random_numbers_are_those_of_splitmix64)
{
    io_random r = {1234567};
    const uint64_t published[5] = {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                   4593380528125082431u, 16408922859458223821u};
    for (int i = 0; i < 5; i++) {
        assert_true(io_random_next(&r) == published[i]);
    }
}

/* A random rotation takes a vector anywhere with the same chance: mean 0, mean square 1/3. */
TEST_CASE(turns_have_no_preferred_direction)
{
    enum { COUNT = 20000 };
    rlf_vec3 sum = {0, 0, 0}, square = {0, 0, 0};
    for (int32_t i = 0; i < COUNT; i++) {
        io_random r = io_random_make(3, i);
        rlf_vec3 v = rlf_rotate(io_random_turn(&r), rlf_vec3_make(0.6, 0, 0.8));
        sum = rlf_add(sum, v);
        square = rlf_add(square, rlf_vec3_make(v.x * v.x, v.y * v.y, v.z * v.z));
    }
    const double deviation = 1.0 / sqrt(3.0 * COUNT), squares = sqrt(4.0 / 45.0 / COUNT);
    const double sums[3] = {sum.x, sum.y, sum.z}, all[3] = {square.x, square.y, square.z};
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(sums[i] / COUNT) < 4 * deviation);
        assert_true(fabs(all[i] / COUNT - 1.0 / 3.0) < 4 * squares);
    }
}

TEST_CASE(bodies_go_one_after_another_in_colours_in_turn)
{
    rlf_scene scene = spawn("\"body\":{\"release_time\":0.5,\"angular_velocity\":[0,9,0],"
                            "\"color\":[0,0,0]},\"pattern\":\"stack\",\"count\":5,\"spacing\":1,"
                            "\"interval\":0.25,\"angular_velocity_spread\":[0,2,0],"
                            "\"colors\":[[1,0,0],[0,1,0.5]]");
    for (int32_t i = 0; i < 5; i++) {
        const rlf_body_def *b = &scene.bodies[i];
        assert_true(fabs(b->release_time - (0.5 + 0.25 * i)) < 1e-12);
        assert_true(b->angular_velocity.x == 0 && fabs(b->angular_velocity.y - 9) <= 2);
        assert_true(b->color[0] == (i % 2 ? 0.0F : 1.0F) && b->color[2] == (i % 2 ? 0.5F : 0.0F));
    }
    rlf_scene_destroy(&scene);
}

TEST_CASE(bodies_of_a_pattern_share_one_hull)
{
    rlf_scene scene;
    const char *vertices = "\"vertices\":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]";
    char text[1024];
    (void)snprintf(text, sizeof(text),
                   "{\"spawn\":[{\"body\":{\"shape\":\"hull\",%s},\"pattern\":\"stack\","
                   "\"count\":3,\"spacing\":1},{\"body\":{\"shape\":\"hull\",%s},\"pattern\":"
                   "\"ring\",\"count\":3,\"radius\":1}]}",
                   vertices, vertices);
    rlf_result result = parse(text, &scene);
#if !defined(RLF_HAVE_QHULL)
    assert_int_equal(result, RLF_ERROR_UNSUPPORTED);
    skip();
#endif
    assert_int_equal(result, RLF_OK);
    for (int32_t i = 0; i < 6; i++) {
        assert_ptr_equal(scene.bodies[i].shape.hull, scene.bodies[i / 3 * 3].shape.hull);
    }
    assert_ptr_not_equal(scene.bodies[0].shape.hull, scene.bodies[3].shape.hull);
    rlf_scene_destroy(&scene); /* a sanitizer counts what is freed */
}

#define ENTRY(text) "{\"bodies\":[{\"name\":\"a_0002\"}],\"spawn\":[{" text "}]}"
#define STACK(text) ENTRY("\"body\":{},\"pattern\":\"stack\",\"spacing\":1," text)

static const struct {
    const char *text, *part, *cure;
} broken_entries[] = {
    {"{\"spawn\":{}}", "spawn must be an array", "objects"},
    {"{\"spawn\":[3]}", "spawn[0]", "must be an object"},
    {ENTRY("\"body\":{},\"patern\":\"ring\""), "spawn[0].patern is not a known key", "formats.md"},
    {ENTRY("\"body\":{}"), "spawn[0].pattern is missing", "\"grid\""},
    {ENTRY("\"body\":{},\"pattern\":\"pile\""), "spawn[0].pattern is \"pile\"", "\"stack\""},
    {ENTRY("\"pattern\":\"ring\",\"count\":2,\"radius\":1"), "spawn[0].body is missing", "bodies"},
    {ENTRY("\"body\":{\"masss\":1},\"pattern\":\"ring\",\"count\":2,\"radius\":1"),
     "spawn[0].body.masss is not a known key", "formats.md"},
    {ENTRY("\"body\":{\"mass\":0},\"pattern\":\"ring\",\"count\":2,\"radius\":1"),
     "spawn[0].body.mass is 0", "from 1e-6"},
    {ENTRY("\"body\":{\"name\":\"a\"},\"pattern\":\"ring\",\"count\":2,\"radius\":1"),
     "spawn[0].body.name is \"a_0002\" like that of bodies[0]", "choose another"},
    {ENTRY("\"body\":{\"name\":\"a123456789b123456789c123456789d123456789e123456789f12\"},"
           "\"pattern\":\"ring\",\"count\":2,\"radius\":1"),
     "spawn[0].body.name has 53 bytes", "at most 52"},
    {ENTRY("\"body\":{},\"pattern\":\"ring\",\"count\":2"), "spawn[0].radius is missing", "metres"},
    {ENTRY("\"body\":{},\"pattern\":\"ring\",\"count\":2,\"radius\":1,\"spacing\":1"),
     "spawn[0].spacing does not belong to the pattern \"ring\"", "take it out"},
    {ENTRY("\"body\":{},\"pattern\":\"grid\",\"count\":8,\"spacing\":[1,1,1]"),
     "spawn[0].count is a number", "three whole numbers"},
    {ENTRY("\"body\":{},\"pattern\":\"grid\",\"count\":[2,2,2],\"spacing\":[1,0,1]"),
     "spawn[0].spacing is 0", "> 0"},
    {ENTRY("\"body\":{},\"pattern\":\"grid\",\"count\":[256,256,1],\"spacing\":[1,1,1]"),
     "spawn[0].count makes 65537 bodies", "at most 65536"},
    {ENTRY("\"body\":{},\"pattern\":\"random\",\"count\":2,\"box\":[0,0,0]"),
     "spawn[0].box is a point", "room"},
    {ENTRY("\"body\":{},\"pattern\":\"random\",\"count\":2,\"box\":[1,-1,0]"), "spawn[0].box is -1",
     ">= 0"},
    {STACK("\"count\":0"), "spawn[0].count is 0", "1 to 65536"},
    {STACK("\"count\":1.5"), "spawn[0].count is 1.5", "whole number"},
    {STACK("\"count\":65536"), "spawn[0].count makes 65537 bodies", "at most 65536"},
    {STACK("\"count\":2,\"interval\":-1"), "spawn[0].interval is -1", ">= 0"},
    {STACK("\"count\":2,\"seed\":-1"), "spawn[0].seed is -1", "whole number"},
    {STACK("\"count\":2,\"turned\":1"), "spawn[0].turned is a number", "true or false"},
    {STACK("\"count\":2,\"velocity_spread\":[0,-1,0]"), "spawn[0].velocity_spread is -1", ">= 0"},
    {STACK("\"count\":2,\"angular_velocity_spread\":1"),
     "spawn[0].angular_velocity_spread is a number", "rad/s"},
    {STACK("\"count\":2,\"colors\":[]"), "spawn[0].colors must be an array", "1 to 64"},
    {STACK("\"count\":2,\"colors\":[[1,1,1],[0,0,2]]"), "spawn[0].colors [1]", "0 to 1"},
};

TEST_CASE(broken_patterns_are_refused_with_one_clear_line)
{
    for (size_t i = 0; i < sizeof(broken_entries) / sizeof(broken_entries[0]); i++) {
        rlf_scene scene;
        test_expect_error(parse(broken_entries[i].text, &scene), RLF_ERROR_INVALID, "scene.json",
                          broken_entries[i].part, broken_entries[i].cure);
        assert_null(scene.bodies);
        assert_int_equal(scene.body_count, 0);
    }
}

TEST_CASE(as_many_as_a_scene_may_have)
{
    rlf_scene scene = spawn("\"body\":{\"name\":\"n\"},\"pattern\":\"random\",\"count\":65536,"
                            "\"box\":[9,9,9]");
    assert_int_equal(scene.body_count, 65536);
    assert_string_equal(scene.bodies[65535].name, "n_65536");
    rlf_scene_destroy(&scene);
}

TEST_GROUP(test_folder_make, test_folder_remove)
