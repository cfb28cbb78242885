/* The scenes that ship: every one loads, its bodies can live in a world, and two_cubes.json is the
 * scene that the command throws by default. */
#include "relief/io.h"
#include "test.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>

#define SCENES RLF_TEST_ROOT "/scenes/"

static void expect_lives(const char *path)
{
    rlf_scene scene;
    rlf_result loaded = rlf_scene_load(path, &scene);
#ifndef RLF_HAVE_QHULL
    if (loaded == RLF_ERROR_UNSUPPORTED) {
        print_message("left out: %s\n", rlf_error_text());
        return;
    }
#endif
    if (loaded != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    rlf_world_def def = rlf_world_def_default();
    def.gravity = scene.gravity;
    rlf_world *world = NULL;
    assert_int_equal(rlf_world_create(&def, &world), RLF_OK);
    for (int32_t i = 0; i < scene.body_count; i++) {
        rlf_body_id id;
        if (rlf_world_add_body(world, &scene.bodies[i], &id) != RLF_OK) {
            fail_msg("%s: %s", path, rlf_error_text());
        }
    }
    assert_int_equal(rlf_world_get_snapshot(world)->body_count, scene.body_count);
    rlf_world_destroy(&world);
    rlf_scene_destroy(&scene);
}

TEST_CASE(every_scene_loads_and_lives)
{
    DIR *folder = opendir(SCENES);
    assert_non_null(folder);
    int count = 0;
    struct dirent *entry;
    while ((entry = readdir(folder)) != NULL) {
        size_t length = strlen(entry->d_name);
        if (length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0) {
            char path[1024];
            snprintf(path, sizeof(path), "%s%s", SCENES, entry->d_name);
            expect_lives(path);
            count++;
        }
    }
    closedir(folder);
    assert_true(count >= 5);
}

static void assert_vec3_equal(rlf_vec3 a, rlf_vec3 b)
{
    assert_true(a.x == b.x && a.y == b.y && a.z == b.z);
}

TEST_CASE(two_cubes_is_the_default_scene)
{
    rlf_scene made;
    rlf_scene read;
    assert_int_equal(rlf_scene_create_two_cubes(&made), RLF_OK);
    assert_int_equal(rlf_scene_load(SCENES "two_cubes.json", &read), RLF_OK);
    assert_vec3_equal(made.gravity, read.gravity);
    assert_int_equal(made.body_count, read.body_count);
    for (int32_t i = 0; i < made.body_count; i++) {
        const rlf_body_def *a = &made.bodies[i];
        const rlf_body_def *b = &read.bodies[i];
        assert_string_equal(a->name, b->name);
        assert_int_equal(a->shape.type, b->shape.type);
        assert_vec3_equal(a->shape.size, b->shape.size);
        assert_vec3_equal(a->position, b->position);
        assert_vec3_equal(a->velocity, b->velocity);
        assert_vec3_equal(a->angular_velocity, b->angular_velocity);
        assert_true(a->mass == b->mass);
        assert_true(a->restitution == b->restitution);
        assert_true(a->friction == b->friction);
        assert_true(a->release_time == b->release_time);
        assert_memory_equal(a->color, b->color, sizeof(a->color));
    }
    rlf_scene_destroy(&made);
    rlf_scene_destroy(&read);
}
