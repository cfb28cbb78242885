/* Models of real things: rays and distances of shapes, poses from points and on surfaces. */
#include "draws.h"
#include "hulls.h"
#include "known/mesh.h"
#include "known_boxes.h"
#include "relief/known.h"
#include "render_scene.h"
#include "small_world.h"
#include "test.h"

#include <math.h>
#include <string.h>

static const rlf_vec3 octahedron[6] = {{0.2, 0, 0},  {-0.2, 0, 0}, {0, 0.3, 0},
                                       {0, -0.3, 0}, {0, 0, 0.25}, {0, 0, -0.25}};
static const rlf_hull hull = {octahedron, 6, OCTAHEDRON_FACES, 8};

static const rlf_shape shapes[5] = {{.type = RLF_SHAPE_BOX, .size = {0.3, 0.4, 0.5}},
                                    {.type = RLF_SHAPE_SPHERE, .radius = 0.3},
                                    {.type = RLF_SHAPE_CAPSULE, .radius = 0.15, .height = 0.4},
                                    {.type = RLF_SHAPE_CYLINDER, .radius = 0.2, .height = 0.5},
                                    {.type = RLF_SHAPE_HULL, .hull = &hull}};

/* Where a ray enters and leaves the distance is 0, between it is negative; a ray that is said to
 * miss stays outside. */
TEST_CASE(rays_agree_with_distances)
{
    uint64_t random = 7;
    for (int s = 0; s < 5; s++) {
        int hits = 0;
        for (int i = 0; i < 2000; i++) {
            rlf_vec3 from = draw_vector(&random, 1.0);
            rlf_vec3 d = rlf_sub(draw_vector(&random, 0.4), from), gradient;
            double enter, leave;
            if (rlf_shape_cast(&shapes[s], from, d, &enter, &leave)) {
                hits++;
                rlf_vec3 p = rlf_mad(from, d, enter), q = rlf_mad(from, d, leave);
                assert_true(fabs(rlf_shape_distance(&shapes[s], p, &gradient)) < 1e-9);
                assert_true(fabs(rlf_shape_distance(&shapes[s], q, &gradient)) < 1e-9);
                rlf_vec3 middle = rlf_scale(rlf_add(p, q), 0.5);
                assert_true(rlf_shape_distance(&shapes[s], middle, &gradient) < 1e-9);
            } else {
                for (int k = 0; k <= 20; k++) {
                    rlf_vec3 p = rlf_mad(from, d, 0.1 * k);
                    assert_true(rlf_shape_distance(&shapes[s], p, &gradient) > -1e-9);
                }
            }
        }
        assert_true(hits > 200);
    }
}

static rlf_pose random_pose(uint64_t *random)
{
    rlf_pose T = {draw_vector(random, 2.0), {0, 0, 0, 1}};
    T.q = rlf_quat_from_rotation_vector(draw_vector(random, 1.8));
    return T;
}

TEST_CASE(points_give_the_pose_back)
{
    uint64_t random = 3;
    for (int i = 0; i < 500; i++) {
        int32_t count = 3 + i % 4;
        rlf_vec3 model[6], world[6];
        rlf_pose T = random_pose(&random), found;
        for (int32_t k = 0; k < count; k++) {
            model[k] = draw_vector(&random, 0.5);
            world[k] = rlf_transform(&T, model[k]);
        }
        double rms;
        rlf_result result = rlf_align_points(model, world, count, &found, &rms);
        if (result != RLF_OK) { /* three that happen to lie on a line */
            assert_true(count == 3);
            continue;
        }
        assert_true(rms < 1e-7);
        assert_true(rlf_length(rlf_sub(found.p, T.p)) < 1e-6);
        double cosine =
            found.q.x * T.q.x + found.q.y * T.q.y + found.q.z * T.q.z + found.q.w * T.q.w;
        assert_true(fabs(cosine) > 1.0 - 1e-9);
    }
}

/* No rotation nearby leaves less: the closed form is the least. */
TEST_CASE(noisy_points_give_the_least_squares)
{
    uint64_t random = 5;
    for (int i = 0; i < 50; i++) {
        rlf_vec3 model[5], world[5];
        rlf_pose T = random_pose(&random), found;
        for (int k = 0; k < 5; k++) {
            model[k] = draw_vector(&random, 0.5);
            world[k] = rlf_add(rlf_transform(&T, model[k]), draw_vector(&random, 0.02));
        }
        double rms;
        assert_int_equal(rlf_align_points(model, world, 5, &found, &rms), RLF_OK);
        for (int n = 0; n < 20; n++) {
            rlf_pose other = found;
            rlf_quat turn = rlf_quat_from_rotation_vector(draw_vector(&random, 0.01));
            other.q = rlf_quat_mul(turn, found.q);
            other.p = rlf_add(found.p, draw_vector(&random, 0.005));
            double sum = 0.0;
            for (int k = 0; k < 5; k++) {
                rlf_vec3 d = rlf_sub(rlf_transform(&other, model[k]), world[k]);
                sum += rlf_dot(d, d);
            }
            assert_true(sqrt(sum / 5) >= rms - 1e-12);
        }
    }
}

TEST_CASE(poor_points_are_refused)
{
    const rlf_vec3 line[3] = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}};
    const rlf_vec3 good[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const rlf_vec3 wild[3] = {{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}};
    rlf_pose T;
    assert_int_equal(rlf_align_points(good, good, 2, &T, NULL), RLF_ERROR_INVALID);
    assert_int_equal(rlf_align_points(line, good, 3, &T, NULL), RLF_ERROR_INVALID);
    assert_int_equal(rlf_align_points(good, line, 3, &T, NULL), RLF_ERROR_INVALID);
    assert_int_equal(rlf_align_points(good, wild, 3, &T, NULL), RLF_ERROR_INVALID);
    assert_int_equal(rlf_align_points(good, good, 3, &T, NULL), RLF_OK);
}

TEST_CASE(points_have_names)
{
    rlf_vec3 p;
    assert_true(rlf_known_name_point(&shapes[0], "ltn", &p));
    assert_true(p.x == -0.15 && p.y == -0.2 && p.z == -0.25);
    assert_true(rlf_known_name_point(&shapes[0], "ccf", &p));
    assert_true(p.x == 0 && p.y == 0 && p.z == 0.25);
    assert_true(rlf_known_name_point(&shapes[2], "ctc", &p));
    assert_true(fabs(p.y + 0.35) < 1e-12);
    assert_true(rlf_known_name_point(&shapes[4], "v5", &p));
    assert_true(p.z == -0.25);
    const char *const bad[5] = {"", "lt", "ltnn", "xtn", "v1"};
    for (int i = 0; i < 5; i++) {
        assert_false(rlf_known_name_point(&shapes[0], bad[i], &p));
    }
    assert_false(rlf_known_name_point(&shapes[4], "v6", &p));
    assert_false(rlf_known_name_point(&shapes[4], "ltn", &p));
}

/* ---- triangles ------------------------------------------------------------------------------ */

/* A ray meets the triangles of many boxes where it meets the first and the last of them. */
TEST_CASE(rays_meet_triangles)
{
    uint64_t random = 11;
    rlf_vec3 at[BOXES_MAX], size[BOXES_MAX];
    for (int i = 0; i < BOXES_MAX; i++) {
        at[i] = draw_vector(&random, 1.0);
        size[i] = rlf_vec3_make(draw(&random, 0.05, 0.4), draw(&random, 0.05, 0.4), 0.2);
    }
    rlf_model *model = model_of_boxes(at, size, BOXES_MAX);
    known_mesh *mesh = NULL;
    assert_int_equal(known_mesh_create(model, &mesh), RLF_OK);
    int32_t hits = 0;
    for (int k = 0; k < 4000; k++) {
        rlf_vec3 origin = rlf_add(draw_vector(&random, 1.0), rlf_vec3_make(0, 0, -3));
        rlf_vec3 direction = rlf_add(draw_vector(&random, 0.3), rlf_vec3_make(0, 0, 1));
        double first = 1e9, last = -1.0, enter, leave;
        for (int i = 0; i < BOXES_MAX; i++) {
            const rlf_shape box = {.type = RLF_SHAPE_BOX, .size = size[i]};
            if (rlf_shape_cast(&box, rlf_sub(origin, at[i]), direction, &enter, &leave)) {
                first = rlf_min(first, enter);
                last = rlf_max(last, leave);
            }
        }
        bool is_hit = known_mesh_cast(mesh, origin, direction, &enter, &leave);
        assert_true(is_hit == (last > 0.0));
        assert_true(!is_hit || (fabs(enter - first) < 1e-5 && fabs(leave - last) < 1e-5));
        hits += is_hit;
    }
    assert_true(hits > 1000 && hits < 4000);
    known_mesh_destroy(&mesh);
    rlf_model_destroy(&model);
}

/* ---- poses on what the sensor shows --------------------------------------------------------- */

static rlf_known_def crate(void)
{
    /* where the synthetic room's large box is */
    rlf_known_def def = rlf_known_def_default();
    strcpy(def.name, "crate");
    def.shape.size = rlf_vec3_make(0.34, 0.22, 0.26);
    def.T_world_model.p = rlf_vec3_make(1.34, 0.455, 2.40);
    def.T_world_model.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.35);
    return def;
}

static void pick(rlf_known_def *def, const rlf_rig *rig, const char *name, double du, double dv)
{
    rlf_known_point *point = &def->points[def->point_count++];
    point->has_pixel = true;
    assert_true(rlf_known_name_point(&def->shape, name, &point->model));
    rlf_vec3 p = rlf_transform(&def->T_world_model, point->model);
    assert_true(rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, p),
                                   &point->pixel[0], &point->pixel[1]));
    point->pixel[0] += du;
    point->pixel[1] += dv;
}

TEST_CASE(picks_on_the_room_give_the_crates_pose)
{
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.scene = RLF_SYNTHETIC_EMPTY;
    rlf_source *source = synthetic_of(&synthetic);
    rlf_pipeline_def pipeline_def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    pipeline_def.enable_render = false;
    rlf_pipeline *pipeline = pipeline_of(&pipeline_def);
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    rlf_known_def def = crate();
    const rlf_pose truth = def.T_world_model;
    pick(&def, rig, "ltn", 1.5, -1);
    pick(&def, rig, "rtn", -1, 1.5);
    pick(&def, rig, "rbn", 1, -1);
    pick(&def, rig, "lbn", -1, 1);
    rlf_known_fit fit;
    assert_int_equal(rlf_pipeline_set_known(pipeline, &def, &fit), RLF_NO_FRAME);
    rlf_pipeline_output frame;
    for (int i = 0; i < 8; i++) {
        assert_int_equal(rlf_pipeline_step(pipeline, &frame), RLF_OK);
    }
    assert_int_equal(rlf_pipeline_set_known(pipeline, &def, &fit), RLF_OK);
    assert_int_equal(fit.depth_count, 4);
    assert_true(fit.surface_count > 500 && fit.surface_rms < 0.003);
    assert_true(rlf_length(rlf_sub(fit.T_world_model.p, truth.p)) < 0.005);
    /* 6 cm too far away, where hardly any of the surface is near */
    fit.T_world_model.p = rlf_scale(truth.p, 1.0 + 0.06 / rlf_length(truth.p));
    fit.T_world_model.q = truth.q;
    const rlf_known_view view = {frame.surface, rig, rlf_pose_identity()};
    rlf_known_refine(&def.shape, &view, &fit);
    assert_true(fit.surface_count > 500);
    assert_true(rlf_length(rlf_sub(fit.T_world_model.p, truth.p)) < 0.005);
    assert_int_equal(rlf_pipeline_step(pipeline, &frame), RLF_OK);
    assert_int_equal(frame.snapshot->body_count, 0);
    assert_int_equal(frame.snapshot->known_count, 1);
    assert_string_equal(frame.snapshot->known[0].name, "crate");
    /* once more: moved, not added */
    assert_int_equal(rlf_pipeline_set_known(pipeline, &def, NULL), RLF_OK);
    int32_t count;
    assert_true(rlf_pipeline_get_known(pipeline, &count)[0].point_count == 0);
    assert_int_equal(count, 1);
    assert_int_equal(rlf_world_get_snapshot(rlf_pipeline_get_world(pipeline))->known_count, 1);
    def.points[2].pixel[0] = 5000; /* outside */
    assert_int_equal(rlf_pipeline_set_known(pipeline, &def, NULL), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "point 3"));
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

/* Picks where nothing is sensed: one line says how many have depth. */
TEST_CASE(picks_without_depth_are_refused)
{
    render_scene *s = scene_make(0.0);
    rlf_known_def def = crate();
    pick(&def, &s->rig, "ltn", 0, 0);
    pick(&def, &s->rig, "rtn", 0, 0);
    pick(&def, &s->rig, "rbn", 0, 0);
    const rlf_known_view view = {&s->surface, &s->rig, rlf_pose_identity()};
    rlf_known_fit fit;
    assert_int_equal(rlf_known_solve(&def, &view, &fit), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "crate"));
    assert_non_null(strstr(rlf_error_text(), "0 of 3"));
    def.point_count = 0;
    def.T_world_model.p.x = NAN;
    assert_int_equal(rlf_known_solve(&def, &view, &fit), RLF_ERROR_INVALID);
    scene_free(s);
}

/* ---- bodies --------------------------------------------------------------------------------- */

TEST_CASE(bodies_rest_on_a_model)
{
    rlf_world_def world_def = rlf_world_def_default();
    rlf_world *world = world_of(&world_def);
    rlf_body_def def = rlf_body_def_default();
    rlf_body_id id;
    def.is_real = true;
    def.shape.size = rlf_vec3_make(1, 0.2, 1);
    def.position = rlf_vec3_make(0, 1, 2);
    def.restitution = 0;
    id = add_body(world, &def);
    def = rlf_body_def_default();
    def.position = rlf_vec3_make(0, 0.6, 2);
    def.restitution = 0.1;
    add_body(world, &def);
    const rlf_snapshot *snapshot = rlf_world_get_snapshot(world);
    assert_int_equal(snapshot->body_count, 1);
    assert_int_equal(snapshot->known_count, 1);
    advance_steps(world, NULL, 120, 1.0 / 60);
    assert_true(fabs(snapshot->bodies[0].T_world_body.p.y - 0.85) < 0.003);
    assert_true(snapshot->known[0].T_world_body.p.y == 1.0);
    rlf_world_remove_body(world, id); /* taken away: the body falls */
    assert_int_equal(snapshot->known_count, 0);
    advance_steps(world, NULL, 30, 1.0 / 60);
    assert_true(snapshot->bodies[0].T_world_body.p.y > 1.5);
    rlf_world_destroy(&world);
    world_def.method = RLF_PHYSICS_THESIS;
    world = world_of(&world_def);
    def.is_real = true;
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_ERROR_INVALID);
    rlf_world_destroy(&world);
}
