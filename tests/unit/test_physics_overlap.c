/* Overlap of two shapes against distances in closed form. */
#include "draws.h"
#include "hulls.h"
#include "physics/shape/shape.h"
#include "relief/query.h"
#include "test.h"

#include <math.h>

static uint64_t seed = 5;

static const rlf_vec3 OCTAHEDRON[6] = {{0.2, 0, 0},  {-0.2, 0, 0}, {0, 0.2, 0},
                                       {0, -0.2, 0}, {0, 0, 0.2},  {0, 0, -0.2}};
static const rlf_hull HULL = {OCTAHEDRON, 6, OCTAHEDRON_FACES, 8};

static rlf_shape shape_of(int type)
{
    rlf_shape shape = {.type = (rlf_shape_type)type, .size = {0.3, 0.2, 0.1}, .radius = 0.1};
    shape.height = 0.25;
    shape.hull = &HULL;
    return shape;
}

static rlf_pose next_pose(double size)
{
    rlf_pose pose = {draw_vector(&seed, size), {0, 0, 0, 1}};
    pose.q = rlf_quat_from_rotation_vector(draw_vector(&seed, 3));
    return pose;
}

static bool overlap(const rlf_shape *a, const rlf_pose *Ta, const rlf_shape *b, const rlf_pose *Tb)
{
    rlf_query_reason one = rlf_shapes_overlap(a, Ta, b, Tb);
    assert_int_equal(one, rlf_shapes_overlap(b, Tb, a, Ta));
    assert_true(one == RLF_QUERY_HIT || one == RLF_QUERY_MISS);
    return one == RLF_QUERY_HIT;
}

/* A ball overlaps what is nearer than its radius to its centre. */
TEST_CASE(balls_against_all)
{
    for (int type = 0; type < 4; type++) {
        rlf_shape shape = shape_of(type);
        rlf_vec3 points[PHYS_POINTS_MAX];
        phys_shape prepared;
        assert_int_equal(phys_shape_init(&prepared, &shape, points), RLF_OK);
        int hits = 0;
        for (int i = 0; i < 2000; i++) {
            rlf_shape ball = {.type = RLF_SHAPE_SPHERE, .radius = draw(&seed, 0.01, 0.3)};
            rlf_pose Ta = next_pose(0.3), Tb = next_pose(0.3);
            rlf_vec3 gradient;
            rlf_vec3 local = rlf_transform_inverse(&Ta, Tb.p);
            double gap = phys_shape_distance(&prepared, local, &gradient) - ball.radius;
            if (fabs(gap) > 1e-5) {
                assert_int_equal(overlap(&shape, &Ta, &ball, &Tb), gap < 0);
                hits += gap < 0;
            }
        }
        assert_true(hits > 200 && hits < 1800);
    }
}

/* Any two shapes side by side, axes aligned: they touch where their widths say. */
TEST_CASE(widths_add_up)
{
    const double half[5] = {0.15, 0.1, 0.1, 0.1, 0.2};
    for (int a = 0; a < 5; a++) {
        for (int b = 0; b < 5; b++) {
            rlf_shape one = shape_of(a), two = shape_of(b);
            rlf_pose Ta = rlf_pose_identity(), Tb = rlf_pose_identity();
            Tb.p.x = half[a] + half[b] - 1e-5;
            assert_true(overlap(&one, &Ta, &two, &Tb));
            Tb.p.x += 2e-5;
            assert_false(overlap(&one, &Ta, &two, &Tb));
        }
    }
}

/* A plane between two shapes that none of their points crosses means a gap; moving one into the
 * other's middle means none. */
TEST_CASE(any_two_in_any_pose)
{
    for (int i = 0; i < 2000; i++) {
        rlf_shape one = shape_of(i % 5), two = shape_of(i / 5 % 5);
        rlf_pose Ta = next_pose(0.2), Tb = next_pose(0.2);
        rlf_vec3 way = rlf_normalize(draw_vector(&seed, 1));
        double apart = rlf_shape_radius(&one) + rlf_shape_radius(&two) + 0.001;
        Tb.p = rlf_mad(Ta.p, way, apart);
        assert_false(overlap(&one, &Ta, &two, &Tb));
        Tb.p = rlf_mad(Ta.p, way, 0.09); /* each holds a ball of 5 cm */
        assert_true(overlap(&one, &Ta, &two, &Tb));
    }
}

TEST_CASE(bad_shapes_are_invalid)
{
    rlf_shape box = shape_of(0), bad = shape_of(1);
    rlf_pose T = rlf_pose_identity(), nowhere = T;
    bad.radius = -1;
    nowhere.p.x = NAN;
    assert_int_equal(rlf_shapes_overlap(&box, &T, &bad, &T), RLF_QUERY_INVALID);
    assert_int_equal(rlf_shapes_overlap(&box, &T, &box, &nowhere), RLF_QUERY_INVALID);
    assert_int_equal(rlf_shapes_overlap(&box, &T, &box, &T), RLF_QUERY_HIT);
}
