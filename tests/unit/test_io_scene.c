/* scene.json and the hulls it names. */
#define _POSIX_C_SOURCE 200809L

#include "io/model/hull.h"
#include "io/scene/reader.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

static rlf_result parse(const char *text, rlf_scene *scene)
{
    io_bytes file = {"scene.json", (const uint8_t *)text, strlen(text)};
    return io_scene_parse(&file, test_folder, scene);
}

TEST_CASE(empty_scene_has_default_gravity)
{
    rlf_scene scene;
    assert_int_equal(parse("{}", &scene), RLF_OK);
    assert_int_equal(scene.body_count, 0);
    assert_true(scene.gravity.y == rlf_world_def_default().gravity.y);
    assert_true(scene.border == RLF_BORDER_EXTEND);
    rlf_scene_destroy(&scene);
    assert_int_equal(parse("{\"border\":\"extend\"}", &scene), RLF_OK);
    assert_true(scene.border == RLF_BORDER_EXTEND);
    rlf_scene_destroy(&scene);
    assert_int_equal(parse("{\"border\":\"open\"}", &scene), RLF_OK);
    assert_true(scene.border == RLF_BORDER_OPEN);
    assert_false(scene.is_gravity_given || scene.finds_gravity);
    rlf_scene_destroy(&scene);
    assert_int_equal(parse("{\"gravity\":\"floor\"}", &scene), RLF_OK);
    assert_true(scene.is_gravity_given && scene.finds_gravity);
    assert_true(scene.gravity.y == rlf_world_def_default().gravity.y);
    rlf_scene_destroy(&scene);
}

TEST_CASE(events_of_hands_are_bound)
{
    rlf_scene scene;
    assert_int_equal(parse("{\"on\":{\"pinch\":\"spawn\",\"swipe_left\":\"reset\"}}", &scene),
                     RLF_OK);
    for (int k = 0; k < RLF_HAND_EVENT_COUNT; k++) {
        const rlf_hand_action wanted = k == RLF_HAND_EVENT_PINCH_BEGIN  ? RLF_HAND_ACTION_SPAWN
                                       : k == RLF_HAND_EVENT_SWIPE_LEFT ? RLF_HAND_ACTION_RESET
                                                                        : RLF_HAND_ACTION_NONE;
        assert_int_equal(scene.on[k], wanted);
    }
    rlf_scene_destroy(&scene);
    test_expect_error(parse("{\"on\":{\"clap\":\"spawn\"}}", &scene), RLF_ERROR_INVALID, "on.clap",
                      "not an event", "swipe_left");
    test_expect_error(parse("{\"on\":{\"fist\":\"eat\"}}", &scene), RLF_ERROR_INVALID, "on.fist",
                      "eat", "remove");
    test_expect_error(parse("{\"on\":[]}", &scene), RLF_ERROR_INVALID, "on", "must be", "object");
}

TEST_CASE(every_key_is_read)
{
    test_write_text(
        "scene.json",
        "{\"gravity\":[1,2,3],\"bodies\":["
        "{\"name\":\"crate, \\\"big\\\"\",\"shape\":\"box\",\"size\":[0.1,0.2,0.3],"
        "\"mass\":2,\"position\":[4,5,6],\"orientation\":[0,0,0.7071,0.7071],"
        "\"velocity\":[7,8,9],\"angular_velocity\":[10,11,12],\"restitution\":0.25,"
        "\"friction\":0.75,\"rolling_resistance\":0.02,\"gravity_scale\":-1,\"release_time\":1.5,"
        "\"collides_with_bodies\":false,\"kinematic\":true,\"linear_damping\":0.125,"
        "\"angular_damping\":3,\"color\":[0,0.5,1]},"
        "{\"shape\":\"sphere\",\"radius\":0.05},"
        "{\"shape\":\"capsule\",\"radius\":0.06,\"height\":0.3},"
        "{\"shape\":\"cylinder\",\"radius\":0.07,\"height\":0.4},{}]}");
    rlf_scene scene;
    assert_int_equal(rlf_scene_load(test_path("scene.json"), &scene), RLF_OK);
    assert_int_equal(scene.body_count, 5);
    assert_true(scene.gravity.x == 1 && scene.gravity.y == 2 && scene.gravity.z == 3);
    const rlf_body_def *b = scene.bodies;
    assert_string_equal(b[0].name, "crate, \"big\"");
    assert_int_equal(b[0].shape.type, RLF_SHAPE_BOX);
    assert_true(b[0].shape.size.x == 0.1 && b[0].shape.size.z == 0.3);
    assert_true(b[0].mass == 2 && b[0].position.y == 5 && b[0].velocity.z == 9);
    assert_true(b[0].angular_velocity.x == 10 && b[0].restitution == 0.25);
    assert_true(b[0].friction == 0.75 && b[0].gravity_scale == -1 && b[0].release_time == 1.5);
    assert_true(b[0].rolling_resistance == 0.02);
    assert_true(b[0].linear_damping == 0.125 && b[0].angular_damping == 3);
    assert_true(!b[0].collides_with_bodies && b[0].is_kinematic);
    assert_true(b[0].color[0] == 0.0F && b[0].color[1] == 0.5F && b[0].color[2] == 1.0F);
    double norm = b[0].orientation.z * b[0].orientation.z + b[0].orientation.w * b[0].orientation.w;
    assert_true(norm > 1 - 1e-12 && norm < 1 + 1e-12);
    assert_int_equal(b[1].shape.type, RLF_SHAPE_SPHERE);
    assert_true(b[1].shape.radius == 0.05);
    assert_int_equal(b[2].shape.type, RLF_SHAPE_CAPSULE);
    assert_true(b[2].shape.height == 0.3);
    assert_int_equal(b[3].shape.type, RLF_SHAPE_CYLINDER);
    assert_true(b[3].shape.radius == 0.07 && b[3].shape.height == 0.4);
    rlf_body_def standard = rlf_body_def_default();
    assert_int_equal(b[4].cookie, standard.cookie);
    assert_true(b[4].mass == standard.mass && b[4].shape.size.x == standard.shape.size.x);
    rlf_scene_destroy(&scene);
}

#define BODY(text) "{\"bodies\":[{}," text "]}"

static const struct {
    const char *text;
    rlf_result result;
    const char *part, *cure;
} broken_scenes[] = {
    {"", RLF_ERROR_FORMAT, "is empty", "docs/formats.md"},
    {"{\"gravity\":[0,9.81,0],}", RLF_ERROR_FORMAT, "scene.json:1:", "correct it"},
    {"{\"gravitiy\":[0,9.81,0]}", RLF_ERROR_INVALID, "gravitiy is not a known key", "gravity"},
    {"{\"gravity\":\"moon\"}", RLF_ERROR_INVALID, "gravity is a string", "or \"floor\""},
    {"{\"gravity\":9.81}", RLF_ERROR_INVALID, "gravity is a number", "three numbers"},
    {"{\"border\":\"closed\"}", RLF_ERROR_INVALID, "border is \"closed\"", "\"extend\""},
    {"{\"bodies\":[{\"mass\":1e-300}]}", RLF_ERROR_INVALID, "bodies[0].mass is 1e-300",
     "from 1e-6 to 1e6"},
    {"{\"bodies\":[{\"size\":[1e-300,1,1]}]}", RLF_ERROR_INVALID, "bodies[0].size is 1e-300",
     "from 1e-6 to 100"},
    {"{\"bodies\":{}}", RLF_ERROR_INVALID, "bodies must be an array", "array"},
    {"{\"bodies\":[7]}", RLF_ERROR_INVALID, "bodies[0]", "must be an object"},
    {BODY("{\"masss\":1}"), RLF_ERROR_INVALID, "bodies[1].masss is not a known key",
     "docs/formats.md"},
    {BODY("{\"mass\":0}"), RLF_ERROR_INVALID, "bodies[1].mass is 0", "from 1e-6"},
    {BODY("{\"mass\":-1}"), RLF_ERROR_INVALID, "bodies[1].mass is -1", "from 1e-6"},
    {BODY("{\"mass\":\"1\"}"), RLF_ERROR_INVALID, "bodies[1].mass is a string", "kg"},
    {BODY("{\"mass\":NaN}"), RLF_ERROR_FORMAT, "not valid JSON", "correct it"},
    {BODY("{\"mass\":1,\"mass\":2}"), RLF_ERROR_FORMAT, "duplicate", "correct it"},
    {BODY("{\"position\":[1,2]}"), RLF_ERROR_INVALID, "bodies[1].position has 2 numbers",
     "three numbers"},
    {BODY("{\"orientation\":[0,0,0,0]}"), RLF_ERROR_INVALID,
     "bodies[1].orientation has the length 0", "unit length"},
    {BODY("{\"restitution\":1.1}"), RLF_ERROR_INVALID, "bodies[1].restitution is 1.1", "0 to 1"},
    {BODY("{\"friction\":-0.1}"), RLF_ERROR_INVALID, "bodies[1].friction is -0.1", ">= 0"},
    {BODY("{\"rolling_resistance\":-1}"), RLF_ERROR_INVALID, "bodies[1].rolling_resistance is -1",
     ">= 0"},
    {BODY("{\"release_time\":-1}"), RLF_ERROR_INVALID, "bodies[1].release_time is -1", ">= 0"},
    {BODY("{\"linear_damping\":-1}"), RLF_ERROR_INVALID, "bodies[1].linear_damping is -1", ">= 0"},
    {BODY("{\"angular_damping\":1e4}"), RLF_ERROR_INVALID, "bodies[1].angular_damping is 10000",
     "at most 1000"},
    {BODY("{\"kinematic\":1}"), RLF_ERROR_INVALID, "bodies[1].kinematic is a number",
     "true or false"},
    {BODY("{\"color\":[0,0,255]}"), RLF_ERROR_INVALID, "bodies[1].color is 255", "0 to 1"},
    {BODY("{\"collides_with_bodies\":1}"), RLF_ERROR_INVALID,
     "bodies[1].collides_with_bodies is a number", "true or false"},
    {BODY("{\"shape\":\"cube\"}"), RLF_ERROR_INVALID, "bodies[1].shape is \"cube\"", "\"box\""},
    {BODY("{\"size\":[1,0,1]}"), RLF_ERROR_INVALID, "bodies[1].size is 0", "from 1e-6"},
    {BODY("{\"size\":[1,101,1]}"), RLF_ERROR_INVALID, "bodies[1].size is 101", "from 1e-6 to 100"},
    {BODY("{\"radius\":1}"), RLF_ERROR_INVALID, "bodies[1].radius does not belong", "take it out"},
    {BODY("{\"shape\":\"sphere\"}"), RLF_ERROR_INVALID, "bodies[1].radius is missing", "metres"},
    {BODY("{\"shape\":\"cylinder\",\"radius\":1}"), RLF_ERROR_INVALID,
     "bodies[1].height is missing", "metres"},
    {BODY("{\"shape\":\"hull\"}"), RLF_ERROR_INVALID, "bodies[1].model is missing", "OBJ"},
    {BODY("{\"shape\":\"hull\",\"model\":\"none.obj\"}"), RLF_ERROR_IO, "bodies[1].model",
     "none.obj"},
    {BODY("{\"name\":\"\"}"), RLF_ERROR_INVALID, "bodies[1].name has 0 bytes", "1 to 63"},
    {BODY("{\"name\":\"foreground\"}"), RLF_ERROR_INVALID, "bodies[1].name is \"foreground\"",
     "choose another"},
    {BODY("{\"name\":\"a\\nb\"}"), RLF_ERROR_INVALID, "bodies[1].name holds a control character",
     "printable"},
    {BODY("{\"name\":\"a\"},{\"name\":\"a\"}"), RLF_ERROR_INVALID, "bodies[2].name is \"a\"",
     "bodies[1]"},
};

TEST_CASE(broken_scenes_are_refused_with_one_clear_line)
{
    for (size_t i = 0; i < sizeof(broken_scenes) / sizeof(broken_scenes[0]); i++) {
        rlf_scene scene;
        test_expect_error(parse(broken_scenes[i].text, &scene), broken_scenes[i].result,
                          "scene.json", broken_scenes[i].part, broken_scenes[i].cure);
        assert_null(scene.bodies);
        assert_int_equal(scene.body_count, 0);
    }
    rlf_scene scene;
    test_expect_error(rlf_scene_load(test_path("none.json"), &scene), RLF_ERROR_IO, "none.json",
                      "No such file", "docs/formats.md");
}

/* A box of 2 x 4 x 6 about (1, 2, 3), as quads with texture indices, wound outwards. */
#define BOX_VERTICES "v 0 0 0\nv 2 0 0\nv 2 4 0\nv 0 4 0\nv 0 0 6\nv 2 0 6\nv 2 4 6\nv 0 4 6\n"
#define BOX_SIDES "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
#define BOX_ENDS "f 4/1 3/1 2/1 1/1\nf 5//2 6//2 7//2 8//2\n"

static void check_box_hull(const rlf_hull *hull)
{
    assert_int_equal(hull->vertex_count, 8);
    assert_int_equal(hull->triangle_count, 12);
    for (int i = 0; i < 8; i++) {
        rlf_vec3 v = hull->vertices[i];
        assert_true(v.x * v.x > 0.9999 && v.x * v.x < 1.0001);
        assert_true(v.y * v.y > 3.9999 && v.y * v.y < 4.0001);
        assert_true(v.z * v.z > 8.9999 && v.z * v.z < 9.0001);
    }
    for (int i = 0; i < 12; i++) {
        const int32_t *t = &hull->triangles[i * 3];
        rlf_vec3 a = hull->vertices[t[0]];
        rlf_vec3 n = rlf_cross(rlf_sub(hull->vertices[t[1]], a), rlf_sub(hull->vertices[t[2]], a));
        assert_true(rlf_dot(n, a) > 0.0); /* the origin is inside: outwards is away from it */
    }
}

TEST_CASE(hull_is_centred_and_faces_outwards)
{
    const char *const models[3] = {
        "# box\no box\n" BOX_VERTICES "vn 0 0 1\n" BOX_SIDES BOX_ENDS,
        BOX_VERTICES
        "v 9 9 9\r\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\nf 1 2 3 4\nf 8 7 6 5\n",
        BOX_VERTICES "f -8 -7 -3 -4\n"
                     "f 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n" BOX_ENDS};
    for (int i = 0; i < 3; i++) {
        test_write_text("box.obj", models[i]);
        rlf_scene scene;
        assert_int_equal(parse("{\"bodies\":[{\"shape\":\"hull\",\"model\":\"box.obj\"}]}", &scene),
                         RLF_OK);
        assert_int_equal(scene.bodies[0].shape.type, RLF_SHAPE_HULL);
        check_box_hull(scene.bodies[0].shape.hull);
        rlf_scene_destroy(&scene);
    }
}

TEST_CASE(broken_hulls_are_refused)
{
    const struct {
        const char *text, *part;
    } models[] = {
        {"", "not an OBJ text file"},
        {"v 0 0\n", "box.obj:1"},
        {"v 0 0 nan\n", "box.obj:1"},
        {"v 0 0 1000\n", "within 100"},
        {"v 0 0 0\nf 1 2 3\n", "box.obj:2"},
        {"v 0 0 0\nv 1 0 0\nf 1 2\n", "three corners"},
        {BOX_VERTICES, "0 triangles"},
        {BOX_VERTICES BOX_SIDES, "not closed"},
        {BOX_VERTICES BOX_SIDES "f 1 2 3 4\nf 5 6 7 8\n", "not wound the same way"},
        /* flat: both sides of a square */
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 4 3 2 1\n", "flat"},
        /* a box with a dent: corner 7 pushed in */
        {"v 0 0 0\nv 2 0 0\nv 2 4 0\nv 0 4 0\nv 0 0 6\nv 2 0 6\nv 0.3 0.5 1\nv 0 4 6\n" BOX_SIDES
             BOX_ENDS,
         "not convex"},
    };
    for (size_t i = 0; i < sizeof(models) / sizeof(models[0]); i++) {
        test_write_text("box.obj", models[i].text);
        rlf_hull *hull = NULL;
        test_expect_error(io_hull_load(test_path("box.obj"), &hull, NULL), RLF_ERROR_FORMAT,
                          "box.obj", models[i].part, NULL);
        assert_null(hull);
    }
}

TEST_GROUP(test_folder_make, test_folder_remove)
