/* The thesis's rigid bodies, eq. 4.5 to 4.15, C.1 and Algorithms 1 to 3, against closed forms. */
#include "physics/thesis/thesis.h"
#include "small_world.h"
#include "test.h"
#include "grid_fixture.h"

#include <math.h>

static void near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance)) {
        fail_msg("%.15g is not %.15g", a, b);
    }
}

static rlf_world *world;

static int start(void **state)
{
    (void)state;
    rlf_world_def def = small_world_def();
    def.method = RLF_PHYSICS_THESIS;
    def.gravity = rlf_vec3_make(0, 0, 0);
    def.contact_capacity = 4096;
    world = world_of(&def);
    return 0;
}

static int stop(void **state)
{
    (void)state;
    rlf_world_destroy(&world);
    return 0;
}

TEST_CASE(orientation_stays_orthogonal)
{
    rlf_mat3 R = rlf_mat3_diagonal(1, 1, 1);
    for (int i = 0; i < 1000; i++) {
        thesis_rotate(&R, rlf_vec3_make(3, -2, 5), 1.0 / 30);
    }
    rlf_mat3 Rt = rlf_mat3_transpose(&R);
    rlf_mat3 one = rlf_mat3_mul(&Rt, &R);
    for (int i = 0; i < 9; i++) {
        near(one.m[i / 3][i % 3], i / 3 == i % 3 ? 1 : 0, 1e-14);
    }
    rlf_vec3 c0 = rlf_vec3_make(R.m[0][0], R.m[1][0], R.m[2][0]);
    rlf_vec3 c1 = rlf_vec3_make(R.m[0][1], R.m[1][1], R.m[2][1]);
    rlf_vec3 c2 = rlf_vec3_make(R.m[0][2], R.m[1][2], R.m[2][2]);
    near(rlf_dot(rlf_cross(c0, c1), c2), 1, 1e-14); /* a rotation, no mirror */
}

/* One Euler step about z turns by atan(w dt). */
TEST_CASE(orientation_step_is_eq_4_5)
{
    rlf_mat3 R = rlf_mat3_diagonal(1, 1, 1);
    thesis_rotate(&R, rlf_vec3_make(0, 0, 2), 0.1);
    near(atan2(R.m[1][0], R.m[0][0]), atan(0.2), 1e-15);
    near(R.m[2][2], 1, 1e-15);
}

TEST_CASE(cube_inertia_is_C_1)
{
    rlf_shape shape = {.type = RLF_SHAPE_BOX, .size = {1, 2, 3}};
    rlf_mat3 I = rlf_shape_inertia(&shape, 12);
    near(I.m[0][0], 4 + 9, 1e-12);
    near(I.m[1][1], 1 + 9, 1e-12);
    near(I.m[2][2], 4 + 1, 1e-12);
}

static void expect_diagonal(const rlf_mat3 *I, double x, double y, double z)
{
    const double expected[3] = {x, y, z};
    for (int i = 0; i < 9; i++) {
        near(I->m[i / 3][i % 3], i / 3 == i % 3 ? expected[i / 3] : 0, 1e-12);
    }
}

/* Solids of 3 kg whose axis is y, as textbooks have them. */
TEST_CASE(round_inertia_is_closed_form)
{
    const double m = 3, r = 0.5, h = 2;
    rlf_shape sphere = {.type = RLF_SHAPE_SPHERE, .radius = r};
    rlf_mat3 I = rlf_shape_inertia(&sphere, m);
    expect_diagonal(&I, 0.4 * m * r * r, 0.4 * m * r * r, 0.4 * m * r * r);

    rlf_shape cylinder = {.type = RLF_SHAPE_CYLINDER, .radius = r, .height = h};
    I = rlf_shape_inertia(&cylinder, m);
    double across = m * (3 * r * r + h * h) / 12;
    expect_diagonal(&I, across, 0.5 * m * r * r, across);

    /* A cylinder and two half balls, whose own centres are 3/8 r above their faces. */
    rlf_shape capsule = {.type = RLF_SHAPE_CAPSULE, .radius = r, .height = h};
    I = rlf_shape_inertia(&capsule, m);
    double ball = 4.0 / 3 * r * r * r, tube = r * r * h; /* volumes / pi */
    double mb = m * ball / (ball + tube), mt = m * tube / (ball + tube);
    across = mt * (3 * r * r + h * h) / 12 +
             mb * (0.4 * r * r + h * h / 4 + 2 * (h / 2) * (3.0 / 8 * r));
    expect_diagonal(&I, across, 0.5 * mt * r * r + 0.4 * mb * r * r, across);
    capsule.height = 1e-12; /* nothing but a ball is left */
    I = rlf_shape_inertia(&capsule, m);
    expect_diagonal(&I, 0.4 * m * r * r, 0.4 * m * r * r, 0.4 * m * r * r);
}

/* A hull in a box's shape has the box's tensor. */
TEST_CASE(hull_inertia_is_exact)
{
    rlf_vec3 v[8];
    for (int i = 0; i < 8; i++) {
        v[i] = rlf_vec3_make(i & 1 ? 0.5 : -0.5, i & 2 ? 1 : -1, i & 4 ? 1.5 : -1.5);
    }
    const int32_t t[36] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                           2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    rlf_hull hull = {v, 8, t, 12};
    rlf_shape shape = {.type = RLF_SHAPE_HULL, .hull = &hull};
    rlf_mat3 I = rlf_shape_inertia(&shape, 12);
    near(I.m[0][0], 13, 1e-12);
    near(I.m[1][1], 10, 1e-12);
    near(I.m[2][2], 5, 1e-12);
    near(I.m[0][1], 0, 1e-12);
}

TEST_CASE(forces_and_torques)
{
    rlf_body_def def = rlf_body_def_default();
    def.mass = 2;
    def.shape.size = rlf_vec3_make(1, 1, 1);
    rlf_body_id id = add_body(world, &def);
    rlf_vec3 at = rlf_add(def.position, rlf_vec3_make(0, 0.5, 0));
    assert_true(rlf_world_apply_force(world, id, rlf_vec3_make(4, 0, 0), at));
    rlf_world_advance(world, NULL, 0.1);
    near(body_at(world, 0)->velocity.x, 0.2, 1e-15);                        /* 4.8 */
    near(body_at(world, 0)->T_world_body.p.x, 0.02, 1e-15);                 /* Algorithm 1 */
    near(body_at(world, 0)->angular_velocity.z, -0.5 * 4 * 0.1 * 3, 1e-14); /* 4.9, I = 1/3 */
}

static phys_body bare_body(double mass, rlf_vec3 x)
{
    phys_body b = {.mass = mass, .inverse_mass = 1 / mass, .x = x, .q = {0, 0, 0, 1}};
    rlf_shape shape = {.type = RLF_SHAPE_BOX, .size = {1, 1, 1}};
    b.inertia = rlf_shape_inertia(&shape, mass);
    assert_true(rlf_mat3_invert(&b.inertia, &b.inverse_inertia));
    phys_body_orient(&b);
    return b;
}

/* m = 6, I = 1; r = (0.5, 0, -1): t1 = 1/6, t3 = 0.25; v_rel = -3; e = 0.5:
 * j = 1.5 * 3 / (1/6 + 1/4) = 10.8. */
TEST_CASE(impulse_formula)
{
    phys_body a = bare_body(6, rlf_vec3_make(0, 0, 1));
    a.v = rlf_vec3_make(0.7, 0, -3);
    rlf_vec3 n = {0, 0, 1};
    rlf_vec3 p = {0.5, 0, 0};
    near(thesis_impulse(&a, NULL, p, n, 0.5), 10.8, 1e-12);
    near(a.v.x, 0.7, 1e-15);
    near(a.v.z, -3 + 10.8 / 6, 1e-12);
    near(a.w.y, -0.5 * 10.8, 1e-12); /* r x J = (0.5,0,-1) x (0,0,10.8) */
    rlf_vec3 after = phys_body_velocity_at(&a, rlf_sub(p, a.x));
    near(rlf_dot(n, after), 1.5, 1e-12);                 /* e |v_rel| */
    near(thesis_impulse(&a, NULL, p, n, 0.5), 0.0, 0.0); /* moving apart: errata 6 */
}

/* Both masses: m_a = 2, m_b = 6, head on, e = 1: j = 2 * 4 / (1/2 + 1/6) = 12. */
TEST_CASE(impulse_between_bodies)
{
    phys_body a = bare_body(2, rlf_vec3_make(1, 0, 0)), b = bare_body(6, rlf_vec3_make(0, 0, 0));
    a.v = rlf_vec3_make(-4, 0, 0);
    near(thesis_impulse(&a, &b, rlf_vec3_make(0.5, 0, 0), rlf_vec3_make(1, 0, 0), 1), 12, 1e-12);
    near(a.v.x, 2, 1e-12);
    near(b.v.x, -2, 1e-12);
}

TEST_CASE(broad_phase_uses_the_radius)
{
    rlf_aabb box = {{-1, -1, 2}, {1, 1, 3}};
    assert_true(thesis_broad_phase(&box, rlf_vec3_make(0, 0, 2.5), 0.1));
    assert_true(thesis_broad_phase(&box, rlf_vec3_make(0, 0, 1.95), 0.1));
    assert_false(thesis_broad_phase(&box, rlf_vec3_make(0, 0, 1.85), 0.1));
    assert_false(thesis_broad_phase(&box, rlf_vec3_make(1.08, 1.08, 2.5), 0.1));
}

TEST_CASE(bodies_conserve_momentum)
{
    rlf_body_def def = rlf_body_def_default();
    def.mass = 0.3;
    def.position = rlf_vec3_make(-0.2, 0.02, 1.01);
    def.velocity = rlf_vec3_make(1, 0, 0);
    def.angular_velocity = rlf_vec3_make(1, 2, 3);
    add_body(world, &def);
    def.mass = 0.1;
    def.position = rlf_vec3_make(0, 0, 1);
    def.velocity = rlf_vec3_make(0, 0, 0);
    def.angular_velocity = rlf_vec3_make(0, 0, 0);
    add_body(world, &def);
    int contacts = 0;
    for (int k = 0; k < 30; k++) {
        rlf_world_advance(world, NULL, 1.0 / 60);
        contacts += rlf_world_get_snapshot(world)->contact_count;
    }
    assert_true(contacts > 0);
    rlf_vec3 p = rlf_add(rlf_scale(body_at(world, 0)->velocity, 0.3),
                         rlf_scale(body_at(world, 1)->velocity, 0.1));
    near(p.x, 0.3, 1e-12);
    near(p.y, 0, 1e-12);
    near(p.z, 0, 1e-12);
    assert_true(body_at(world, 1)->velocity.x > 0.2);
}

/* A plane through the whole chain: grid, region box, points, impulse. In a mounted camera's frame,
 * to see that the boxes are tested in the grid's frame. */
TEST_CASE(bounces_off_a_plane)
{
    grid_fixture *f = grid_fixture_create();
    grid_plane wall = grid_wall(2);
    grid_fixture_set_room(f, &wall, 1);
    f->grid.T_world_grid.p = rlf_vec3_make(0.3, -0.2, 0.5);
    f->grid.T_world_grid.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.5);
    rlf_vec3 forward = rlf_rotate(f->grid.T_world_grid.q, rlf_vec3_make(0, 0, 1));
    rlf_body_def def = rlf_body_def_default();
    def.restitution = 0.8;
    def.position = rlf_transform(&f->grid.T_world_grid, rlf_vec3_make(0, 0, 1.2));
    def.orientation = f->grid.T_world_grid.q;
    def.velocity = rlf_scale(forward, 2);
    add_body(world, &def);
    double deepest = 0, approach = 0;
    for (int k = 0; k < 40; k++) {
        rlf_world_advance(world, &f->grid, 1.0 / 60);
        const rlf_snapshot *s = rlf_world_get_snapshot(world);
        rlf_vec3 p = rlf_transform_inverse(&f->grid.T_world_grid, s->bodies[0].T_world_body.p);
        deepest = rlf_max(deepest, p.z + 0.05 - 2);
        for (int i = 0; i < s->contact_count; i++) {
            assert_int_equal(s->contacts[i].other, RLF_CONTACT_BACKGROUND);
            assert_int_equal(s->contacts[i].region_label, 1);
            assert_true(s->contacts[i].impulse > 0);
            approach = rlf_max(approach, s->contacts[i].approach_speed);
        }
    }
    near(approach, 2, 0.05);
    assert_true(deepest < 2.0 / 60 + 0.01); /* no more than one frame's way */
    assert_true(rlf_dot(forward, body_at(world, 0)->velocity) < -0.5);
    grid_fixture_destroy(&f);
}

TEST_EACH(start, stop)
