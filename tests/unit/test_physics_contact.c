/* A body on the grid: bounce heights, friction, rest, missing pixels. Live method. */
#include "relief/world.h"
#include "test.h"

#include "grid_shared.h"

#include <math.h>

/* Where nothing is seen there is nothing. */
static rlf_world *make_world(rlf_vec3 gravity)
{
    rlf_world_def def = rlf_world_def_default();
    def.border = RLF_BORDER_OPEN;
    def.gravity = gravity;
    def.body_capacity = 8;
    def.contact_capacity = 256;
    rlf_world *world = NULL;
    assert_int_equal(rlf_world_create(&def, &world), RLF_OK);
    return world;
}

static const rlf_body_state *first(const rlf_world *world)
{
    return &rlf_world_get_snapshot(world)->bodies[0];
}

static void set_floor(double height)
{
    grid_plane room[2] = {grid_floor(height), grid_wall(5)};
    grid_fixture_set_room(fixture, room, 2);
}

/* Height of the next peak of the lowest point over the floor at y = 1. */
static double bounce_height(rlf_shape_type type, double restitution)
{
    const double DROP = 0.8;
    rlf_world *world = make_world(rlf_vec3_make(0, 9.81, 0));
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = type;
    def.shape.radius = 0.05;
    def.shape.height = type == RLF_SHAPE_CAPSULE ? 0.08 : 0.1;
    double half = type == RLF_SHAPE_CAPSULE ? 0.09 : 0.05;
    def.restitution = restitution;
    def.position = rlf_vec3_make(0.05, 1 - half - DROP, 2.5);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    double peak = -1;
    bool is_up = false;
    for (int k = 0; k < 400; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 240);
        is_up = is_up || first(world)->velocity.y < 0;
        double height = 1 - half - first(world)->T_world_body.p.y;
        peak = is_up ? rlf_max(peak, height) : peak;
        if (is_up && first(world)->velocity.y > 0) {
            break;
        }
    }
    rlf_world_destroy(&world);
    return peak / DROP;
}

static void bounces_to_the_square_of_restitution(void **state)
{
    (void)state;
    set_floor(1);
    const double values[] = {1, 0.8, 0.5};
    for (int type = 0; type < 4; type++) {
        for (int i = 0; i < 3; i++) {
            double ratio = bounce_height((rlf_shape_type)type, values[i]);
            print_message("shape %d, e %.1f: height ratio %.4f of %.4f\n", type, values[i], ratio,
                          values[i] * values[i]);
            assert_true(fabs(ratio / (values[i] * values[i]) - 1) < 0.02);
        }
    }
}

/* A tilted gravity makes the level floor a slope. Returns the speed after one second. */
static double slide(double slope, double friction)
{
    rlf_world *world = make_world(rlf_vec3_make(9.81 * sin(slope), 9.81 * cos(slope), 0));
    rlf_body_def def = rlf_body_def_default();
    def.friction = friction;
    def.position = rlf_vec3_make(-1, 0.95, 2.5);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    for (int k = 0; k < 20; k++) {
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 0.02);
    }
    double v = first(world)->velocity.x;
    for (int k = 0; k < 20; k++) {
        rlf_world_advance(world, &fixture->grid, 0.02);
    }
    v = (first(world)->velocity.x - v) / 0.4;
    rlf_world_destroy(&world);
    return v;
}

/* A blow is told at the place where they met, not where the body is at the end of the frame. */
static void blows_are_told_where_they_were(void **state)
{
    (void)state;
    const double HEIGHT = 0.103, RADIUS = 0.05, FRAME = 1.0 / 30;
    int32_t blows = 0;
    set_floor(1);
    for (int type = 0; type < 2; type++) {
        rlf_world *world = make_world(rlf_vec3_make(0, 0, 0));
        rlf_body_def def = rlf_body_def_default();
        def.shape.type = type == 0 ? RLF_SHAPE_SPHERE : RLF_SHAPE_BOX;
        def.shape.radius = RADIUS;
        def.shape.size = rlf_vec3_make(2 * RADIUS, 2 * RADIUS, 2 * RADIUS);
        def.friction = 0.0;
        def.restitution = 1.0;
        def.position = rlf_vec3_make(-0.2, 1 - RADIUS - HEIGHT, 2.5);
        def.velocity = rlf_vec3_make(1.5, 2.0, 0.0);
        assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
        for (int k = 0; k < 6; k++) {
            rlf_world_advance(world, &fixture->grid, FRAME);
            const rlf_snapshot *s = rlf_world_get_snapshot(world);
            for (int32_t i = 0; i < s->contact_count; i++) {
                const rlf_contact *c = &s->contacts[i];
                double aside = c->point.x - (def.position.x + 0.75 * HEIGHT);
                assert_true(fabs(c->point.y - 1.0) < 2e-4);
                assert_true(fabs(aside) < (type == 0 ? 2e-4 : RADIUS + 2e-4));
                assert_true(fabs(c->approach_speed - 2.0) < 1e-2);
                blows++;
            }
        }
        rlf_world_destroy(&world);
    }
    assert_true(blows >= 2);
}

static void slope_sticks_and_slips(void **state)
{
    (void)state;
    set_floor(1);
    const double mu = 0.5, critical = atan(0.5), degree = RLF_PI / 180;
    assert_true(fabs(slide(critical - 0.05 * degree, mu)) < 1e-4);
    double sticky = slide(critical + 0.05 * degree, mu);
    assert_true(sticky > 1e-3);
    for (double angle = 30; angle < 41; angle += 5) {
        double expected = 9.81 * (sin(angle * degree) - mu * cos(angle * degree));
        double a = slide(angle * degree, mu);
        print_message("slope %.0f deg: acceleration %.5f of %.5f m/s^2\n", angle, a, expected);
        assert_true(fabs(a / expected - 1) < 0.01);
    }
}

static void sticking_cube_does_not_creep(void **state)
{
    (void)state;
    set_floor(1);
    double slope = 26 * RLF_PI / 180;
    rlf_world *world = make_world(rlf_vec3_make(9.81 * sin(slope), 9.81 * cos(slope), 0));
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_vec3_make(0, 0.95, 2.5);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    for (int k = 0; k < 300; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
    }
    double creep = fabs(first(world)->T_world_body.p.x);
    print_message("creep at 26 deg in 10 s: %.4f mm\n", 1e3 * creep);
    assert_true(creep < 1e-4);
    rlf_world_destroy(&world);
}

static void rests_without_drift_and_sleeps(void **state)
{
    (void)state;
    set_floor(1);
    rlf_world *world = make_world(rlf_vec3_make(0, 9.81, 0));
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_vec3_make(0.1, 0.9, 2.5);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    double deepest = 0;
    for (int k = 0; k < 300; k++) {
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        deepest = rlf_max(deepest, first(world)->T_world_body.p.y - 0.95);
    }
    rlf_vec3 p = first(world)->T_world_body.p;
    print_message("rest: drift %.2e m, deepest %.4f mm\n", hypot(p.x - 0.1, p.z - 2.5),
                  1e3 * deepest);
    assert_true(first(world)->is_asleep);
    assert_true(hypot(p.x - 0.1, p.z - 2.5) < 1e-4);
    assert_true(deepest < 1e-3);
    rlf_world_destroy(&world);
}

/* The floor vanishes under a sleeper: it falls within 4 frames. */
static void falls_when_support_goes(void **state)
{
    (void)state;
    set_floor(1);
    rlf_world *world = make_world(rlf_vec3_make(0, 9.81, 0));
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_vec3_make(0.1, 0.949, 2.5);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    for (int k = 0; k < 60; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
    }
    assert_true(first(world)->is_asleep);
    set_floor(1.4);
    fixture->grid.time_ns++;
    double before = first(world)->T_world_body.p.y;
    for (int k = 0; k < 4; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
    }
    assert_true(first(world)->T_world_body.p.y > before + 0.05);
    rlf_world_destroy(&world);
}

/* What stays has a number: a sleeper over the same one stays asleep where it is, and falls when a
 * new one has no floor under it. */
static void numbered_floor_goes(void **state)
{
    (void)state;
    set_floor(1);
    rlf_world *world = make_world(rlf_vec3_make(0, 9.81, 0));
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_vec3_make(0.1, 0.949, 2.5);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    rlf_vec3 slept = {0, 0, 0};
    for (int k = 0; k < 90; k++) {
        fixture->grid.background.version = 7;
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        slept = k == 60 ? first(world)->T_world_body.p : slept;
    }
    rlf_vec3 p = first(world)->T_world_body.p;
    assert_true(first(world)->is_asleep);
    assert_true(p.x == slept.x && p.y == slept.y && p.z == slept.z);
    set_floor(1.4);
    fixture->grid.background.version = 8;
    for (int k = 0; k < 4; k++) {
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
    }
    assert_true(first(world)->T_world_body.p.y > p.y + 0.05);
    fixture->grid.background.version = 0;
    rlf_world_destroy(&world);
}

/* Holes smaller than a body do not swallow or stop it; a missing region is free space. */
static void missing_pixels(void **state)
{
    (void)state;
    set_floor(1);
    uint32_t seed = 1;
    for (int i = 0; i < GRID_W * GRID_H; i++) {
        seed = seed * 1664525u + 1013904223u;
        if ((seed >> 16) % 10 < 3) {
            fixture->planes[2][i] = 0;
        }
    }
    rlf_world *world = make_world(rlf_vec3_make(0, 9.81, 0));
    rlf_body_def def = rlf_body_def_default();
    def.restitution = 0;
    def.friction = 0.1;
    def.position = rlf_vec3_make(-0.8, 0.949, 2.5);
    def.velocity = rlf_vec3_make(1.5, 0, 0);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    for (int k = 0; k < 30; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
    }
    rlf_vec3 p = first(world)->T_world_body.p;
    double slid = 1.5 - 0.5 * 0.981;
    print_message("30 %% of pixels missing: slid %.3f m of %.3f, height off by %.2f mm\n",
                  p.x + 0.8, slid, 1e3 * (p.y - 0.95));
    assert_true(fabs(p.y - 0.95) < 2e-3);
    assert_true(fabs(p.x + 0.8 - slid) < 0.05);
    memset(fixture->planes[2], 0, sizeof(float) * GRID_W * GRID_H);
    fixture->grid.time_ns++;
    for (int k = 0; k < 10; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
    }
    assert_true(first(world)->T_world_body.p.y > 1.3);
    rlf_world_destroy(&world);
}

/* Twelve uniform numbers: a fair normal one. */
static double gauss(uint64_t *seed)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) {
        *seed = *seed * 6364136223846793005u + 1442695040888963407u;
        sum += (double)(*seed >> 11) / 9007199254740992.0;
    }
    return sum;
}

/* Raw sensor noise, new in every frame: the cube hardly moves, falls asleep and stays so. */
static void rests_on_a_noisy_floor(void **state)
{
    (void)state;
    set_floor(1.2);
    rlf_world *world = make_world(rlf_vec3_make(0, 9.81, 0));
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_vec3_make(0.1, 1.14, 2.2);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    float *clean = malloc(sizeof(float) * GRID_W * GRID_H);
    memcpy(clean, fixture->planes[2], sizeof(float) * GRID_W * GRID_H);
    uint64_t seed = 11;
    double sum = 0, square = 0;
    int asleep_at = -1, wakes = 0;
    bool was_asleep = false;
    for (int k = 0; k < 300; k++) {
        for (int i = 350 * GRID_W; i < GRID_W * GRID_H; i++) {
            double z = clean[i];
            fixture->planes[2][i] = (float)(z + (0.0008 + 0.0003 * z * z) * gauss(&seed));
        }
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        bool is_asleep = first(world)->is_asleep;
        asleep_at = is_asleep && asleep_at < 0 ? k : asleep_at;
        wakes += was_asleep && !is_asleep;
        was_asleep = is_asleep;
        if (k >= 8) { /* it has landed; sleep comes later */
            double y = first(world)->T_world_body.p.y - 1.15;
            sum += y / 292;
            square += y * y / 292;
        }
    }
    double rms = sqrt(rlf_max(square - sum * sum, 0));
    print_message("noisy floor: jitter %.3f mm RMS, asleep at frame %d, woke %d times\n", 1e3 * rms,
                  asleep_at, wakes);
    assert_true(rms < 0.5e-3);
    assert_true(fabs(sum) < 2e-3);
    assert_true(asleep_at >= 0 && asleep_at < 90);
    assert_int_equal(wakes, 0);
    free(clean);
    rlf_world_destroy(&world);
}

/* A camera that is mounted askew: the grid's frame is not the world's. */
#define ROUND_SIDES 7
#define ROUND_RINGS 5

/* A toy with a round bottom that stands on seven vertices, none of them quite as low as another.
 * Convex: each ring's faces lean outwards. */
static const rlf_hull *round_bottom(void)
{
    static const double rings[ROUND_RINGS][2] = {
        {0.0404, 0.022}, {0.0374, 0.034}, {0.01, 0.045}, {-0.02, 0.04}, {-0.05, 0.015}};
    static rlf_vec3 vertices[ROUND_RINGS * ROUND_SIDES];
    static int32_t triangles[6 * ROUND_RINGS * ROUND_SIDES];
    static rlf_hull hull;
    int32_t n = 0;
    for (int r = 0; r < ROUND_RINGS; r++) {
        for (int s = 0; s < ROUND_SIDES; s++) {
            const int32_t a = r * ROUND_SIDES + s, b = r * ROUND_SIDES + (s + 1) % ROUND_SIDES;
            const int32_t side[6] = {a, b, a + ROUND_SIDES, b, b + ROUND_SIDES, a + ROUND_SIDES};
            const double turn = 2 * RLF_PI * s / ROUND_SIDES;
            const double low = r == 0 ? 0.0002 * (s * 3 % ROUND_SIDES - 3) : 0.0;
            vertices[a] =
                rlf_vec3_make(rings[r][1] * cos(turn), rings[r][0] + low, rings[r][1] * sin(turn));
            for (int k = 0; k < 6 && r + 1 < ROUND_RINGS; k++) {
                triangles[n++] = side[k];
            }
        }
    }
    for (int s = 1; s + 1 < ROUND_SIDES; s++) {
        const int32_t last = (ROUND_RINGS - 1) * ROUND_SIDES;
        const int32_t caps[6] = {0, s + 1, s, last, last + s, last + s + 1};
        for (int k = 0; k < 6; k++) {
            triangles[n++] = caps[k];
        }
    }
    hull = (rlf_hull){vertices, ROUND_RINGS * ROUND_SIDES, triangles, n / 3};
    return &hull;
}

/* A body whose bottom is round, on a floor that is rough but never changes, stops rocking. */
static void a_round_bottom_comes_to_rest(void **state)
{
    (void)state;
    set_floor(1.0);
    uint64_t seed = 5;
    for (int i = 250 * GRID_W; i < GRID_W * GRID_H; i++) {
        fixture->planes[2][i] += (float)(0.001 * gauss(&seed));
    }
    int awake = 0;
    for (int k = 0; k < 12; k++) {
        rlf_world *world = make_world(rlf_vec3_make(0, 9.81, 0));
        rlf_body_def def = rlf_body_def_default();
        def.shape.type = RLF_SHAPE_HULL;
        def.shape.hull = round_bottom();
        def.mass = 0.05;
        def.friction = 0.8;
        def.restitution = 0.1;
        def.position = rlf_vec3_make(0.05 * k - 0.3, 0.95, 1.9);
        def.orientation = rlf_quat_from_rotation_vector(rlf_vec3_make(0.1, 0.5 * k, 0.05));
        assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
        for (int frame = 0; frame < 120; frame++) {
            fixture->grid.time_ns++;
            rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        }
        awake += !first(world)->is_asleep;
        rlf_world_destroy(&world);
    }
    print_message("round bottoms on a rough floor: %d of 12 awake after 4 s\n", awake);
    assert_int_equal(awake, 0);
}

static void rests_under_a_tilted_camera(void **state)
{
    (void)state;
    set_floor(1);
    rlf_pose mount = {{0.5, -1, 0.3}, rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), 0.4)};
    fixture->grid.T_world_grid = mount;
    rlf_world *world = make_world(rlf_rotate(mount.q, rlf_vec3_make(0, 9.81, 0)));
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_transform(&mount, rlf_vec3_make(0.1, 0.8, 2.4));
    def.orientation = mount.q;
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    for (int k = 0; k < 90; k++) {
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
    }
    rlf_vec3 p = rlf_transform_inverse(&mount, first(world)->T_world_body.p);
    assert_true(fabs(p.y - 0.95) < 1e-3 && fabs(p.x - 0.1) < 1e-3 && fabs(p.z - 2.4) < 1e-3);
    assert_true(first(world)->is_asleep);
    fixture->grid.T_world_grid = rlf_pose_identity();
    rlf_world_destroy(&world);
}

/* Inside the wall at the start: comes out at bounded speed. */
static void comes_out_of_the_wall(void **state)
{
    (void)state;
    set_floor(1);
    rlf_world *world = make_world(rlf_vec3_make(0, 9.81, 0));
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_vec3_make(0.1, 0.9, 5.15);
    def.orientation = rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(1, 2, 3)), 1);
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    double fastest = 0;
    for (int k = 0; k < 90; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        fastest = rlf_max(fastest, rlf_length(first(world)->velocity));
    }
    assert_true(fastest < 4);
    assert_true(first(world)->T_world_body.p.z < 5);
    assert_true(first(world)->T_world_body.p.y < 1);
    rlf_world_destroy(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounces_to_the_square_of_restitution),
        cmocka_unit_test(blows_are_told_where_they_were),
        cmocka_unit_test(slope_sticks_and_slips),
        cmocka_unit_test(sticking_cube_does_not_creep),
        cmocka_unit_test(rests_without_drift_and_sleeps),
        cmocka_unit_test(falls_when_support_goes),
        cmocka_unit_test(numbered_floor_goes),
        cmocka_unit_test(missing_pixels),
        cmocka_unit_test(rests_on_a_noisy_floor),
        cmocka_unit_test(a_round_bottom_comes_to_rest),
        cmocka_unit_test(rests_under_a_tilted_camera),
        cmocka_unit_test(comes_out_of_the_wall),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
