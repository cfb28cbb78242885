/* Rays and distances against the solids: known answers, and each against the other. */

#include "sim/shape.h"
#include "test.h"

#include <math.h>

static synth_shape at(synth_shape_type type, rlf_vec3 p)
{
    synth_shape shape = {.type = type, .T_camera_shape = {p, {0, 0, 0, 1}}};
    return shape;
}

static synth_ray along_z(double x, double y)
{
    synth_ray ray = {{x, y, 0}, {0, 0, 1}};
    return ray;
}

static void assert_interval(const synth_shape *shape, synth_ray ray, double near, double far)
{
    synth_interval hit;
    assert_true(synth_shape_intersect(shape, &ray, &hit));
    assert_float_equal(hit.near, near, 1e-12);
    assert_float_equal(hit.far, far, 1e-12);
}

static void assert_miss(const synth_shape *shape, synth_ray ray)
{
    synth_interval hit;
    assert_false(synth_shape_intersect(shape, &ray, &hit));
}

TEST_CASE(rays_meet_a_plane_at_the_known_depth)
{
    synth_shape floor = at(SYNTH_HALF_SPACE, rlf_vec3_make(0, 1.2, 0));
    synth_ray ray = {{0, 0, 0}, {0.1, 0.5, 1}};
    synth_interval hit;
    assert_true(synth_shape_intersect(&floor, &ray, &hit));
    assert_float_equal(hit.near, 2.4, 1e-12);
    assert_true(hit.far > 1e6);
    assert_miss(&floor, along_z(0, 0));
    ray.direction.y = -0.5;
    assert_true(synth_shape_intersect(&floor, &ray, &hit));
    assert_true(hit.near < -1e6 && hit.far < 0.0);
}

TEST_CASE(rays_meet_a_sphere_and_an_ellipsoid)
{
    synth_shape ball = at(SYNTH_ELLIPSOID, rlf_vec3_make(0, 0, 3));
    ball.size = rlf_vec3_make(0.5, 0.5, 0.5);
    assert_interval(&ball, along_z(0, 0), 2.5, 3.5);
    assert_interval(&ball, along_z(0.3, 0), 2.6, 3.4);
    assert_miss(&ball, along_z(0.51, 0));
    ball.size = rlf_vec3_make(0.5, 0.2, 1.0);
    assert_interval(&ball, along_z(0, 0), 2.0, 4.0);
    assert_interval(&ball, along_z(0.3, 0), 2.2, 3.8);
    assert_miss(&ball, along_z(0, 0.21));
}

TEST_CASE(rays_meet_a_box_also_when_parallel)
{
    synth_shape box = at(SYNTH_BOX, rlf_vec3_make(0, 0, 3));
    box.size = rlf_vec3_make(0.3, 0.2, 0.1);
    assert_interval(&box, along_z(0.29, 0.19), 2.9, 3.1);
    assert_miss(&box, along_z(0.31, 0));
    box.T_camera_shape.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.25 * RLF_PI);
    double reach = 0.1 * sqrt(2.0);
    assert_interval(&box, along_z(0, 0), 3.0 - reach, 3.0 + reach);
}

TEST_CASE(rays_meet_a_capsule_and_a_round_cone)
{
    synth_shape capsule = at(SYNTH_CONE, rlf_vec3_make(0, 0, 3));
    capsule.length = 1.0;
    capsule.radius_a = 0.2;
    capsule.radius_b = 0.2;
    assert_interval(&capsule, along_z(0, 0.5), 2.8, 3.2);
    assert_interval(&capsule, along_z(0.12, 0.5), 2.84, 3.16);
    assert_interval(&capsule, along_z(0, 1.12), 2.84, 3.16);
    assert_miss(&capsule, along_z(0, 1.21));
    assert_miss(&capsule, along_z(0.21, 0.5));
    capsule.radius_b = 0.1; /* sin(alpha) = 0.1: rho = (0.2 - 0.1 y) / cos(alpha) */
    double rho = (0.2 - 0.1 * 0.5) / sqrt(0.99);
    assert_interval(&capsule, along_z(0, 0.5), 3.0 - rho, 3.0 + rho);
    synth_ray down = {{0, -2, 3}, {0, 1, 0}};
    assert_interval(&capsule, down, 1.8, 3.1);
}

/* A small generator for test points; good enough and the same everywhere. */
static double next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 8388608.0 - 1.0;
}

static rlf_vec3 random_vector(uint32_t *seed, double size)
{
    double x = next_random(seed);
    double y = next_random(seed);
    return rlf_vec3_make(size * x, size * y, size * next_random(seed));
}

static synth_shape random_shape(uint32_t *seed, int type)
{
    synth_shape shape = at((synth_shape_type)type, rlf_vec3_make(0.3, -0.2, 3.0));
    shape.T_camera_shape.q = rlf_quat_from_rotation_vector(random_vector(seed, 2.0));
    shape.size = rlf_vec3_make(0.30, 0.15, 0.22);
    shape.length = 0.5;
    shape.radius_a = 0.2;
    shape.radius_b = 0.2 + 0.1 * next_random(seed);
    return shape;
}

/* Entry and exit of any ray are at distance 0, the normal of the distance is that of the surface,
 * and between them the distance is negative. */
TEST_CASE(ray_and_distance_agree)
{
    uint32_t seed = 1;
    int hits = 0;
    for (int i = 0; i < 20000; i++) {
        synth_shape shape = random_shape(&seed, 1 + i % 3);
        synth_ray ray = {{0, 0, 0}, {0, 0, 1}};
        ray.direction = rlf_add(shape.T_camera_shape.p, random_vector(&seed, 0.3));
        synth_interval hit;
        if (!synth_shape_intersect(&shape, &ray, &hit) || hit.far - hit.near < 1e-4) {
            continue;
        }
        hits++;
        rlf_vec3 normal;
        rlf_vec3 p = rlf_scale(ray.direction, hit.near);
        assert_float_equal(synth_shape_distance(&shape, p, &normal), 0.0, 1e-8);
        assert_float_equal(rlf_length(normal), 1.0, 1e-12);
        rlf_vec3 surface = synth_shape_normal(&shape, p);
        assert_true(rlf_dot(surface, ray.direction) < 0.0);
        double off = synth_shape_distance(&shape, rlf_mad(p, surface, 0.01), &normal);
        assert_float_equal(off, 0.01, 1e-7);
        assert_true(rlf_dot(normal, surface) > 1.0 - 1e-9);
        p = rlf_scale(ray.direction, hit.far);
        assert_float_equal(synth_shape_distance(&shape, p, &normal), 0.0, 1e-8);
        p = rlf_scale(ray.direction, 0.5 * (hit.near + hit.far));
        assert_true(synth_shape_distance(&shape, p, &normal) < 0.0);
    }
    assert_true(hits > 5000);
}

/* The distance is 1-Lipschitz, and going back along the normal by it ends on the surface. */
TEST_CASE(distance_leads_to_the_surface)
{
    uint32_t seed = 2;
    for (int i = 0; i < 20000; i++) {
        synth_shape shape = random_shape(&seed, i % 4);
        rlf_vec3 p = rlf_add(shape.T_camera_shape.p, random_vector(&seed, 0.8));
        rlf_vec3 q = rlf_add(p, random_vector(&seed, 0.1));
        rlf_vec3 normal;
        rlf_vec3 ignored;
        double d = synth_shape_distance(&shape, p, &normal);
        double e = synth_shape_distance(&shape, q, &ignored);
        assert_true(fabs(d - e) <= rlf_length(rlf_sub(p, q)) + 1e-8);
        rlf_vec3 foot = rlf_mad(p, normal, -d);
        assert_float_equal(synth_shape_distance(&shape, foot, &ignored), 0.0, 1e-7);
    }
}

TEST_CASE(distance_has_known_values)
{
    rlf_vec3 n;
    synth_shape box = at(SYNTH_BOX, rlf_vec3_make(0, 0, 0));
    box.size = rlf_vec3_make(1, 2, 3);
    assert_float_equal(synth_shape_distance(&box, rlf_vec3_make(4, 6, 3), &n), 5.0, 1e-12);
    assert_float_equal(n.x, 0.6, 1e-12);
    assert_float_equal(synth_shape_distance(&box, rlf_vec3_make(0.9, 0, 0), &n), -0.1, 1e-12);
    assert_float_equal(n.x, 1.0, 0.0);
    synth_shape egg = at(SYNTH_ELLIPSOID, rlf_vec3_make(0, 0, 0));
    egg.size = rlf_vec3_make(1, 2, 3);
    assert_float_equal(synth_shape_distance(&egg, rlf_vec3_make(0, 0, 5), &n), 2.0, 1e-7);
    assert_float_equal(n.z, 1.0, 1e-7);
    assert_float_equal(synth_shape_distance(&egg, rlf_vec3_make(0, 0, 0), &n), -1.0, 1e-7);
}
