/* Hulls around points and models. */
#define _POSIX_C_SOURCE 200809L

#include "test.h"

#include <math.h>

#include "relief/io.h"
#include "io/scene/reader.h"
#include "io/scene/pattern.h"
#include "io_support.h"
#include "model_file.h"

#ifdef RLF_HAVE_QHULL

static double volume_of(const rlf_hull *hull)
{
    double volume = 0.0;
    for (int32_t i = 0; i < 3 * hull->triangle_count; i += 3) {
        const int32_t *t = &hull->triangles[i];
        volume +=
            rlf_dot(hull->vertices[t[0]], rlf_cross(hull->vertices[t[1]], hull->vertices[t[2]])) /
            6.0;
    }
    return volume;
}

static bool is_near(double a, double b, double by)
{
    return a - b < by && b - a < by;
}

/* Points of a 2 x 4 x 6 box about (1, 2, 3), inside and on its faces. */
TEST_CASE(inner_points_are_left_out)
{
    rlf_vec3 points[125];
    for (int i = 0; i < 125; i++) {
        points[i] = rlf_vec3_make(0.5 * (i % 5), 1.0 * (i / 5 % 5), 1.5 * (i / 25));
    }
    rlf_hull *hull = NULL;
    rlf_vec3 centre;
    assert_int_equal(rlf_hull_create(points, 125, 64, &hull, &centre), RLF_OK);
    assert_int_equal(hull->vertex_count, 8);
    assert_int_equal(hull->triangle_count, 12);
    assert_true(is_near(centre.x, 1, 1e-9) && is_near(centre.y, 2, 1e-9) &&
                is_near(centre.z, 3, 1e-9));
    assert_true(is_near(volume_of(hull), 48.0, 1e-9));
    rlf_shape shape = {.type = RLF_SHAPE_HULL, .hull = hull};
    rlf_mat3 inertia = rlf_shape_inertia(&shape, 12.0);
    assert_true(is_near(inertia.m[0][0], 16.0 + 36.0, 1e-9));
    assert_true(is_near(inertia.m[2][2], 4.0 + 16.0, 1e-9));
    rlf_free(hull);
}

/* A ball of 2000 points keeps most of its volume with few vertices, all of them its own. */
TEST_CASE(many_vertices_become_few)
{
    static rlf_vec3 points[2000];
    for (int i = 0; i < 2000; i++) {
        double y = 1.0 - (i + 0.5) / 1000.0;
        double angle = 2.39996322972865332 * i;
        double r = sqrt(1.0 - y * y);
        points[i] = rlf_vec3_make(r * rlf_cos(angle), y, r * rlf_sin(angle));
    }
    const struct {
        int32_t limit;
        double share; /* of the ball's volume at least */
    } cases[3] = {{16, 0.64}, {64, 0.89}, {256, 0.97}};
    for (int i = 0; i < 3; i++) {
        rlf_hull *hull = NULL;
        assert_int_equal(rlf_hull_create(points, 2000, cases[i].limit, &hull, NULL), RLF_OK);
        double share = volume_of(hull) / (4.0 / 3.0 * RLF_PI);
        print_message("%d vertices: %.3f of the volume\n", (int)hull->vertex_count, share);
        assert_true(hull->vertex_count <= cases[i].limit);
        assert_true(share > cases[i].share && share < 1.0);
        rlf_free(hull);
    }
}

TEST_CASE(bad_points_are_refused)
{
    rlf_vec3 points[16];
    rlf_hull *hull = NULL;
    for (int i = 0; i < 16; i++) {
        points[i] = rlf_vec3_make(i % 4, i / 4, 1);
    }
    test_expect_error(rlf_hull_create(points, 16, 64, &hull, NULL), RLF_ERROR_INVALID, "plane",
                      NULL, NULL);
    test_expect_error(rlf_hull_create(points, 3, 64, &hull, NULL), RLF_ERROR_INVALID, "at least 4",
                      NULL, NULL);
    for (int i = 0; i < 16; i++) {
        points[i] = rlf_vec3_make(2, 2, 2);
    }
    test_expect_error(rlf_hull_create(points, 16, 64, &hull, NULL), RLF_ERROR_INVALID, "plane",
                      NULL, NULL);
    points[7].y = (double)NAN;
    test_expect_error(rlf_hull_create(points, 16, 64, &hull, NULL), RLF_ERROR_INVALID, "point 7",
                      NULL, NULL);
    assert_null(hull);
}

static rlf_result parse(const char *json, rlf_scene *scene)
{
    io_bytes file = {"scene.json", (const uint8_t *)json, strlen(json)};
    return io_scene_parse(&file, test_folder, scene);
}

TEST_CASE(scenes_give_points)
{
    rlf_scene scene;
    assert_int_equal(parse("{\"bodies\":[{\"shape\":\"hull\",\"vertices\":[[0,0,0],[1,0,0],[0,1,0],"
                           "[0,0,1],[0.1,0.1,0.1]],\"size\":[0.5,1,1]}]}",
                           &scene),
                     RLF_OK);
    const rlf_hull *hull = scene.bodies[0].shape.hull;
    assert_int_equal(hull->vertex_count, 4);
    assert_true(is_near(volume_of(hull), 1.0 / 48.0, 1e-9));
    assert_null(scene.bodies[0].look.model);
    rlf_scene_destroy(&scene);
    test_expect_error(
        parse("{\"bodies\":[{\"shape\":\"hull\",\"vertices\":[[0,0,0],[1,0,0],[0,1,0],"
              "[0,1]]}]}",
              &scene),
        RLF_ERROR_INVALID, "vertices", "[3]", NULL);
    test_expect_error(parse("{\"bodies\":[{\"shape\":\"hull\",\"vertices\":[[0,0,0]]}]}", &scene),
                      RLF_ERROR_INVALID, "vertices", "4096", NULL);
    test_expect_error(
        parse("{\"bodies\":[{\"shape\":\"hull\",\"model\":\"a.obj\",\"vertices\":[]}]}", &scene),
        RLF_ERROR_INVALID, "beside", NULL, NULL);
    test_expect_error(parse("{\"bodies\":[{\"vertices\":[]}]}", &scene), RLF_ERROR_INVALID,
                      "vertices", "does not belong", NULL);
}

/* The hull's corners are the model's; the look puts the model where the hull is. */
TEST_CASE(a_model_gets_a_hull)
{
    static model_text text;
    model_write(&text, &model_plain);
    test_write("box.gltf", text.text, text.length);
    rlf_scene scene;
    assert_int_equal(parse("{\"bodies\":[{\"shape\":\"hull\",\"model\":\"box.gltf\"},"
                           "{\"shape\":\"hull\",\"model\":\"box.gltf\",\"size\":[1,1,1]},"
                           "{\"shape\":\"hull\",\"model\":\"box.gltf\",\"size\":[1,1,1]}]}",
                           &scene),
                     RLF_OK);
    assert_int_equal(scene.model_count, 1);
    const double volumes[3] = {6.0, 6.0 / 27.0, 6.0 / 27.0};
    for (int i = 0; i < 3; i++) {
        const rlf_body_def *b = &scene.bodies[i];
        const rlf_model *model = b->look.model;
        assert_true(is_near(volume_of(b->shape.hull), volumes[i], 1e-6));
        double high = -1e9;
        double model_high = b->look.offset.z + b->look.scale * model->box.max.z;
        for (int32_t k = 0; k < b->shape.hull->vertex_count; k++) {
            high = rlf_max(high, b->shape.hull->vertices[k].z);
        }
        assert_true(is_near(high, model_high, 1e-6));
    }
    assert_true(scene.bodies[1].shape.hull != scene.bodies[2].shape.hull);
    rlf_scene_destroy(&scene);
}

/* An OBJ that is not convex was an error before there were models. */
TEST_CASE(a_dented_obj_gets_a_hull)
{
    test_write_text("arrow.obj", "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nv 0 0 1\nv 2 0 1\n"
                                 "v 0.5 0.5 1\nv 0 2 1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\n"
                                 "f 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    rlf_scene scene;
    assert_int_equal(parse("{\"bodies\":[{\"shape\":\"hull\",\"model\":\"arrow.obj\"}]}", &scene),
                     RLF_OK);
    assert_int_equal(scene.bodies[0].shape.hull->vertex_count, 6);
    assert_true(is_near(volume_of(scene.bodies[0].shape.hull), 2.0, 1e-6));
    assert_non_null(scene.bodies[0].look.model);
    rlf_scene_destroy(&scene);
}

TEST_GROUP(test_folder_make, test_folder_remove)

#else

/* Without qhull it is one clear line. */
static void hulls_are_refused(void **state)
{
    (void)state;
    const rlf_vec3 points[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    rlf_hull *hull = NULL;
    test_expect_error(rlf_hull_create(points, 4, 64, &hull, NULL), RLF_ERROR_UNSUPPORTED,
                      "RELIEF_WITH_QHULL", NULL, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(hulls_are_refused)};
    return cmocka_run_group_tests(tests, test_folder_make, test_folder_remove);
}

#endif
