/* scene.json's known objects: read, refused, and written back with poses. */
#define _POSIX_C_SOURCE 200809L

#include "io/scene/pattern.h"
#include "io/scene/reader.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

static rlf_result parse(const char *text, rlf_scene *scene)
{
    io_bytes file = {"scene.json", (const uint8_t *)text, strlen(text)};
    return io_scene_parse(&file, test_folder, scene);
}

static const char *const whole =
    "{\"known_objects\":["
    "{\"name\":\"posed\",\"shape\":\"box\",\"size\":[0.1,0.2,0.3],\"position\":[1,2,3],"
    "\"orientation\":[0,0,0.7071,0.7071],\"friction\":0.7,\"restitution\":0.2,\"collides\":false},"
    "{\"name\":\"picked\",\"shape\":\"cylinder\",\"radius\":0.1,\"height\":0.4,\"refine\":false,"
    "\"points\":[{\"model\":\"ctc\",\"pixel\":[10,20.5]},{\"model\":[0.1,0,0],\"world\":[4,5,6]},"
    "{\"model\":\"cbc\",\"pixel\":[1,2]}]},"
    "{\"name\":\"waiting\"}]}";

TEST_CASE(every_way_to_place_is_read)
{
    rlf_scene scene;
    assert_int_equal(parse(whole, &scene), RLF_OK);
    assert_int_equal(scene.known_count, 3);
    const rlf_known_def *k = scene.known;
    assert_string_equal(k[0].name, "posed");
    assert_true(k[0].has_pose && k[0].point_count == 0 && k[0].T_world_model.p.z == 3);
    assert_true(k[0].friction == 0.7 && k[0].restitution == 0.2 && k[0].shape.size.z == 0.3);
    assert_true(!k[0].collides && k[1].collides && k[0].look.model == NULL);
    assert_true(!k[1].has_pose && k[1].point_count == 3 && !k[1].refine);
    assert_true(k[1].points[0].has_pixel && k[1].points[0].pixel[1] == 20.5);
    assert_true(k[1].points[0].model.y == -0.2 && k[1].points[2].model.y == 0.2);
    assert_true(!k[1].points[1].has_pixel && k[1].points[1].world.y == 5);
    assert_true(!k[2].has_pose && k[2].point_count == 0 && k[2].refine);
    rlf_scene_destroy(&scene);
}

TEST_CASE(bad_known_objects_are_named)
{
    static const struct {
        const char *text, *expected;
    } cases[] = {
        {"{\"known_objects\":{}}", "known_objects"},
        {"{\"known_objects\":[1]}", "known_objects[0]"},
        {"{\"known_objects\":[{}]}", "name"},
        {"{\"known_objects\":[{\"name\":\"a\",\"mass\":1}]}", "mass"},
        {"{\"known_objects\":[{\"name\":\"a\"},{\"name\":\"a\"}]}", "known_objects[1].name"},
        {"{\"bodies\":[{\"name\":\"a\"}],\"known_objects\":[{\"name\":\"a\"}]}", "name"},
        {"{\"known_objects\":[{\"name\":\"a\",\"orientation\":[0,0,0,1]}]}", "orientation"},
        {"{\"known_objects\":[{\"name\":\"a\",\"position\":[0,0,1],\"points\":[]}]}", "points"},
        {"{\"known_objects\":[{\"name\":\"a\",\"points\":[{\"model\":\"ltn\",\"pixel\":[1,2]}]}]}",
         "3 to 6"},
        {"{\"known_objects\":[{\"name\":\"a\",\"points\":[1,2,3]}]}", "points[0]"},
        {"{\"known_objects\":[{\"name\":\"a\",\"points\":[{\"model\":\"xyz\",\"pixel\":[1,2]},{},{}"
         "]}]}",
         "ltn"},
        {"{\"known_objects\":[{\"name\":\"a\",\"points\":[{\"model\":\"ltn\",\"pixel\":[1,2],"
         "\"world\":[1,2,3]},{},{}]}]}",
         "either"},
        {"{\"known_objects\":[{\"name\":\"a\",\"points\":[{\"model\":\"ltn\",\"pixl\":[1,2]},{},{}]"
         "}]}",
         "pixl"},
        {"{\"known_objects\":[{\"name\":\"a\",\"shape\":\"hull\",\"model\":\"none.obj\"}]}",
         "none.obj"},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        rlf_scene scene;
        assert_true(parse(cases[i].text, &scene) < RLF_OK);
        if (strstr(rlf_error_text(), cases[i].expected) == NULL) {
            fail_msg("case %zu: %s", i, rlf_error_text());
        }
    }
    test_write_text("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"); /* no triangle */
    rlf_scene scene;
    assert_true(parse("{\"known_objects\":[{\"name\":\"a\",\"shape\":\"hull\",\"model\":"
                      "\"flat.obj\"}]}",
                      &scene) < RLF_OK);
    assert_non_null(strstr(rlf_error_text(), "flat.obj"));
}

/* A chair of nine boxes, in the box that it is scaled into. */
TEST_CASE(models_are_read)
{
    rlf_scene scene;
    assert_int_equal(rlf_scene_load(RLF_TEST_ROOT "/scenes/known_chair.json", &scene), RLF_OK);
    const rlf_known_def *chair = &scene.known[0];
    assert_string_equal(chair->name, "chair");
    assert_true(chair->look.model != NULL && !chair->collides);
    assert_int_equal(chair->look.model->triangle_count, 9 * 12);
    assert_true(chair->look.scale > 0.999 && chair->look.scale < 1.001);
    assert_true(scene.known[1].look.model == NULL && scene.known[1].collides);
    rlf_scene_destroy(&scene);
}

TEST_CASE(poses_are_saved_in_a_copy)
{
    char in[512], out[512];
    test_write_text("known.json", whole);
    snprintf(in, sizeof(in), "%s", test_path("known.json"));
    snprintf(out, sizeof(out), "%s", test_path("placed.json"));
    rlf_known_def def = rlf_known_def_default();
    strcpy(def.name, "picked");
    def.T_world_model.p = rlf_vec3_make(0.125, -0.25, 2);
    assert_int_equal(rlf_scene_save_known(in, &def, 1, out), RLF_OK);
    rlf_scene scene;
    assert_int_equal(rlf_scene_load(out, &scene), RLF_OK);
    assert_int_equal(scene.known_count, 3);
    assert_true(scene.known[1].has_pose && scene.known[1].point_count == 0);
    assert_true(scene.known[1].T_world_model.p.x == 0.125);
    assert_true(scene.known[0].T_world_model.p.z == 3 && !scene.known[2].has_pose);
    rlf_scene_destroy(&scene);
    strcpy(def.name, "nobody");
    assert_int_equal(rlf_scene_save_known(in, &def, 1, out), RLF_ERROR_INVALID);
}

/* In another folder: models of bodies and of patterns are found from there, too. */
TEST_CASE(a_copy_elsewhere_finds_its_models)
{
    char in[512];
    assert_int_equal(mkdir(test_path("scenes"), 0700), 0);
    test_write_text("scenes/gem.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                      "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    test_write_text("scenes/gems.json",
                    "{\"bodies\":[{\"shape\":\"hull\",\"model\":\"gem.obj\"}],\"spawn\":[{\"body\":"
                    "{\"shape\":\"hull\",\"model\":\"gem.obj\",\"size\":[1,1,1]},\"pattern\":"
                    "\"stack\",\"count\":2,\"spacing\":1}]}");
    snprintf(in, sizeof(in), "%s", test_path("scenes/gems.json"));
    assert_int_equal(rlf_scene_save_known(in, NULL, 0, test_path("copy.json")), RLF_OK);
    rlf_scene scene;
    assert_int_equal(rlf_scene_load(test_path("copy.json"), &scene), RLF_OK);
    assert_int_equal(scene.body_count, 3);
    rlf_scene_destroy(&scene);
}

TEST_GROUP(test_folder_make, test_folder_remove)
