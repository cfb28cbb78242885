/* Distance and depth of convex shapes against closed forms and against their definition; what they
 * make of bodies that cross, are fast, or lie in a heap. */
#include "count_assert.h"
#include "draws.h"
#include "hulls.h"
#include "physics/shape/convex.h"
#include "physics/shape/shape.h"
#include "relief/query.h"
#include "test.h"
#include "grid_room.h"

#include <math.h>
#include <string.h>

static uint64_t seed = 7;

static const rlf_vec3 TIPS[6] = {{0.1, 0, 0},  {-0.1, 0, 0}, {0, 0.1, 0},
                                 {0, -0.1, 0}, {0, 0, 0.1},  {0, 0, -0.1}};
static const rlf_hull OCTAHEDRON = {TIPS, 6, OCTAHEDRON_FACES, 8};

/* A roof along z whose ridge is at the top, y = -0.06. */
static const rlf_vec3 ROOF[6] = {{-0.05, 0.03, -0.2}, {0.05, 0.03, -0.2}, {0, -0.06, -0.2},
                                 {-0.05, 0.03, 0.2},  {0.05, 0.03, 0.2},  {0, -0.06, 0.2}};
static const int32_t ROOF_FACES[24] = {0, 1, 2, 3, 5, 4, 0, 4, 1, 0, 3, 4,
                                       1, 5, 2, 1, 4, 5, 2, 3, 0, 2, 5, 3};
static const rlf_hull PRISM = {ROOF, 6, ROOF_FACES, 8};

typedef enum kind { BOX, BALL, CAPSULE, CYLINDER, TIPPED, RIDGED, KINDS } kind;
static const char *const NAMES[KINDS] = {"box",      "ball",       "capsule",
                                         "cylinder", "octahedron", "prism"};

static rlf_shape shape_of(kind k, double scale)
{
    static rlf_vec3 vertices[2][6];
    static rlf_hull hulls[2];
    rlf_shape shape = {.type = (rlf_shape_type)(k < TIPPED ? (int)k : (int)RLF_SHAPE_HULL)};
    shape.size = rlf_vec3_make(0.12 * scale, 0.08 * scale, 0.1 * scale);
    shape.radius = 0.04 * scale;
    shape.height = 0.1 * scale;
    if (k >= TIPPED) {
        const rlf_hull *from = k == TIPPED ? &OCTAHEDRON : &PRISM;
        rlf_hull *hull = &hulls[k - TIPPED];
        for (int i = 0; i < 6; i++) {
            vertices[k - TIPPED][i] = rlf_scale(from->vertices[i], scale);
        }
        *hull = *from;
        hull->vertices = vertices[k - TIPPED];
        shape.hull = scale == 1.0 ? from : hull;
    }
    return shape;
}

static convex_core core_of(const rlf_shape *shape, rlf_vec3 at)
{
    convex_core core = {shape,
                        rlf_quat_to_mat3(rlf_quat_from_rotation_vector(draw_vector(&seed, 3))), at};
    return core;
}

/* A segment's nearest point to a shape, by trying many. */
static double nearest_of_many(const convex_core *segment, const convex_core *other)
{
    rlf_vec3 points[PHYS_POINTS_MAX], gradient;
    phys_shape prepared;
    assert_int_equal(phys_shape_init(&prepared, other->shape, points), RLF_OK);
    double best = 1e30;
    for (int i = 0; i <= 4000; i++) {
        rlf_vec3 p = rlf_vec3_make(0, segment->shape->height * (i / 4000.0 - 0.5), 0);
        p = rlf_add(segment->at, rlf_mat3_mul_vec(&segment->R, p));
        p = phys_to_frame(&other->R, rlf_sub(p, other->at));
        best = fmin(best, phys_shape_distance(&prepared, p, &gradient));
    }
    phys_shape_finish(&prepared);
    return best;
}

TEST_CASE(distance_is_that_of_the_nearest_points)
{
    const rlf_shape segment = shape_of(CAPSULE, 1);
    double worst = 0;
    int apart = 0;
    for (int i = 0; i < 600; i++) {
        const rlf_shape other = shape_of((kind)(i % KINDS), 1);
        if (other.type == RLF_SHAPE_SPHERE || other.type == RLF_SHAPE_CAPSULE) {
            continue; /* their distance holds the rounding */
        }
        convex_core a = core_of(&segment, rlf_vec3_make(0, 0, 0));
        convex_core b = core_of(&other, draw_vector(&seed, 0.25));
        convex_gap gap;
        convex_simplex simplex;
        double many = nearest_of_many(&a, &b);
        bool is_apart = convex_distance(&a, &b, 1e9, &gap, &simplex);
        if (many > 1e-3) {
            assert_true(is_apart);
            worst = fmax(worst, fabs(gap.distance - many));
            assert_less(fabs(rlf_length(rlf_sub(gap.on_a, gap.on_b)) - gap.distance), 1e-9);
            apart++;
        }
    }
    assert_true(apart > 150 && worst < 1e-5);
}

/* How far the difference goes along d: what a must be moved against it to come free. */
static double depth_along(const convex_core *a, const convex_core *b, rlf_vec3 d)
{
    return rlf_dot(convex_difference(a, b, d).p, d);
}

/* Moved by its depth a shape just touches, and there is no shorter way out. */
TEST_CASE(depth_is_the_shortest_way_out)
{
    double worst = 0;
    int deep = 0;
    for (int i = 0; i < 1200; i++) {
        const rlf_shape one = shape_of((kind)(i % KINDS), 1),
                        two = shape_of((kind)(i / 7 % 6), 1.01);
        if (one.type == RLF_SHAPE_SPHERE || one.type == RLF_SHAPE_CAPSULE) {
            continue; /* cores without volume */
        }
        convex_core a = core_of(&one, rlf_vec3_make(0, 0, 0)),
                    b = core_of(&two, draw_vector(&seed, 0.06));
        convex_gap gap;
        convex_simplex simplex;
        if (convex_distance(&a, &b, 1e9, &gap, &simplex)) {
            continue;
        }
        assert_true(convex_depth(&a, &b, &simplex, &gap));
        assert_true(gap.distance <= 0 && fabs(rlf_length(gap.normal) - 1) < 1e-12);
        double along = depth_along(&a, &b, rlf_neg(gap.normal));
        worst = fmax(worst, fabs(along + gap.distance));
        for (int k = 0; k < 60; k++) {
            rlf_vec3 d =
                rlf_normalize(rlf_add(rlf_neg(gap.normal), draw_vector(&seed, k < 30 ? 0.1 : 2)));
            assert_less(-gap.distance * 0.998 - 2e-7, depth_along(&a, &b, d));
        }
        double off = rlf_dot(gap.normal, rlf_sub(gap.on_a, gap.on_b)) - gap.distance;
        assert_less(fabs(off), 1e-9);
        deep++;
    }
    assert_true(deep > 300 && worst < 2e-4);
}

/* No shape, a hull without its mesh and nowhere to write to are told, and nothing is done. */
TEST_CASE(a_missing_shape_is_refused)
{
    const rlf_hull empty = {0};
    const rlf_shape no_mesh = {.type = RLF_SHAPE_HULL},
                    no_points = {RLF_SHAPE_HULL, .hull = &empty};
    const rlf_shape ball = {.type = RLF_SHAPE_SPHERE, .radius = 1.0};
    const rlf_shape *wrong[3] = {NULL, &no_mesh, &no_points};
    const rlf_vec3 p = {0, 0, 2}, way = {0, 0, -1};
    rlf_vec3 gradient;
    double enter, leave;
    int told = 0;
    rlf_set_assert(count_assert, &told);
    for (int k = 0; k < 3; k++) {
        assert_true(rlf_shape_distance(wrong[k], p, &gradient) == 0.0);
        assert_false(rlf_shape_cast(wrong[k], p, way, &enter, &leave));
        assert_true(rlf_shape_inertia(wrong[k], 1.0).m[0][0] == 0.0);
        assert_true(rlf_shape_radius(wrong[k]) == 0.0);
    }
    assert_int_equal(told, 10); /* a radius of 0 is right for no hull */
    assert_true(rlf_shape_distance(&ball, p, NULL) == 0.0);
    assert_false(rlf_shape_cast(&ball, p, way, NULL, &leave));
    assert_false(rlf_shape_cast(&ball, p, way, &enter, NULL));
    assert_int_equal(told, 13);
    rlf_set_assert(NULL, NULL);
}

/* Beyond a hull's tip and edge the nearest point is the tip, or on the edge. */
TEST_CASE(distance_to_a_hull_is_exact)
{
    const rlf_shape shape = shape_of(TIPPED, 1);
    rlf_vec3 gradient;
    double d = rlf_shape_distance(&shape, rlf_vec3_make(0.3, 0, 0), &gradient);
    assert_true(fabs(d - 0.2) < 1e-12 && fabs(gradient.x - 1) < 1e-12);
    d = rlf_shape_distance(&shape, rlf_vec3_make(0.25, 0.25, 0), &gradient);
    assert_true(fabs(d - 0.2 * sqrt(2)) < 1e-12 && fabs(gradient.x - sqrt(0.5)) < 1e-12);
    d = rlf_shape_distance(&shape, rlf_vec3_make(0.1, 0.1, 0.1), &gradient);
    assert_true(fabs(d - 0.2 / sqrt(3)) < 1e-12);
    d = rlf_shape_distance(&shape, rlf_vec3_make(0.01, 0.01, 0.01), &gradient);
    assert_true(fabs(d + 0.07 / sqrt(3)) < 1e-12);
}

static rlf_world *make_world(double gravity)
{
    rlf_world_def def = small_world_def();
    def.gravity = rlf_vec3_make(0, gravity, 0);
    def.body_capacity = 64;
    def.contact_capacity = 256;
    return world_of(&def);
}

static void add(rlf_world *world, const rlf_body_def *def)
{
    add_body(world, def);
}

static const rlf_body_state *body(const rlf_world *world, int i)
{
    return &rlf_world_get_snapshot(world)->bodies[i];
}

static rlf_body_def body_of(kind k)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = shape_of(k, 1);
    return def;
}

/* One lies across another that is fixed, edge over edge: neither's corners are near the other. */
static void across(kind below, rlf_vec3 turn_below, kind above, rlf_vec3 turn_above, double height)
{
    rlf_world *world = make_world(9.81);
    rlf_body_def def = body_of(below);
    def.is_kinematic = true;
    def.position = rlf_vec3_make(0, 0, 1);
    def.orientation = rlf_quat_from_rotation_vector(turn_below);
    def.shape.height = 0.4;
    add(world, &def);
    def = body_of(above);
    def.position = rlf_vec3_make(0, -height - 0.02, 1);
    def.orientation = rlf_quat_from_rotation_vector(turn_above);
    def.shape.height = 0.4;
    def.shape.size = rlf_vec3_make(0.3, 0.08, 0.08);
    def.restitution = 0;
    add(world, &def);
    advance_steps(world, NULL, 15, 1.0 / 30);
    double off = -body(world, 1)->T_world_body.p.y - height;
    assert_less(fabs(off), 1.5e-3);
    rlf_world_destroy(&world);
}

TEST_CASE(edges_meet_edges)
{
    const double QUARTER = 0.5 * RLF_PI;
    const rlf_vec3 none = {0, 0, 0}, along_z = {QUARTER, 0, 0}, along_x = {0, 0, QUARTER};
    rlf_vec3 over = {0, 0, RLF_PI}; /* the ridge looks down; a quarter turn about y crosses it */
    rlf_quat q = rlf_quat_mul(rlf_quat_from_rotation_vector(rlf_vec3_make(0, QUARTER, 0)),
                              rlf_quat_from_rotation_vector(over));
    double angle = 2 * rlf_acos(q.w), s = sqrt(1 - q.w * q.w);
    over = rlf_scale(rlf_vec3_make(q.x, q.y, q.z), angle / s);
    across(RIDGED, none, RIDGED, over, 0.12);
    across(CYLINDER, along_z, CYLINDER, along_x, 0.08);
    across(RIDGED, none, CYLINDER, along_x, 0.1);
    across(RIDGED, none, CAPSULE, along_x, 0.1);
    across(CYLINDER, along_z, CAPSULE, along_x, 0.08);
    across(RIDGED, none, BOX, rlf_vec3_make(QUARTER / 2, 0, 0), 0.06 + 0.08 / sqrt(2));
}

static bool has_blow(const rlf_world *world)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    for (int32_t i = 0; i < s->contact_count; i++) {
        if (s->contacts[i].impulse > 0) {
            return true;
        }
    }
    return false;
}

/* How many of 5 small ones thrown at a thin plate, a pole or a tip come out behind it; beside a
 * tip they may, but not without a blow. */
static int count_through(kind thrown, kind target, double speed)
{
    int through = 0;
    for (int i = 0; i < 5; i++) {
        rlf_world *world = make_world(0);
        rlf_body_def def = body_of(target);
        def.is_kinematic = true;
        def.position = rlf_vec3_make(0, 0, 1);
        def.shape.size = rlf_vec3_make(0.005, 1, 1);
        def.shape.height = 1;
        add(world, &def);
        def = body_of(thrown);
        def.shape = shape_of(thrown, 0.2);
        def.position = rlf_vec3_make(-0.8 - 0.041 * i, 0.0007 * i, 1 + 0.0005 * (i % 3));
        def.velocity = rlf_vec3_make(speed, 0, 0);
        add(world, &def);
        bool was_hit = false;
        for (int k = 0; k < (int)(48 / speed) + 2; k++) {
            rlf_world_advance(world, NULL, 1.0 / 30);
            was_hit = was_hit || has_blow(world);
        }
        bool is_past =
            rlf_world_get_snapshot(world)->body_count < 2 || body(world, 1)->T_world_body.p.x > 0;
        through += !was_hit || (is_past && target != TIPPED);
        rlf_world_destroy(&world);
    }
    return through;
}

TEST_CASE(nothing_passes_however_fast)
{
    const kind targets[3] = {BOX, CYLINDER, TIPPED};
    const double speeds[4] = {2, 10, 25, 50};
    for (int k = 0; k < KINDS; k++) {
        for (int t = 0; t < 3; t++) {
            for (int s = 0; s < 4; s++) {
                int through = count_through((kind)k, targets[t], speeds[s]);
                if (through > 0) {
                    print_message("%s at %s, %g m/s: %d of 5\n", NAMES[k], NAMES[targets[t]],
                                  speeds[s], through);
                }
                assert_int_equal(through, 0);
            }
        }
    }
}

static void add_walls(rlf_world *world)
{
    const double places[5][3] = {
        {0, 0.55, 1}, {-0.35, 0, 1}, {0.35, 0, 1}, {0, 0, 0.65}, {0, 0, 1.35}};
    for (int i = 0; i < 5; i++) {
        rlf_body_def def = body_of(BOX);
        def.is_kinematic = true;
        def.shape.size =
            rlf_vec3_make(i == 1 || i == 2 ? 0.1 : 1, i == 0 ? 0.1 : 2, i == 3 || i == 4 ? 0.1 : 1);
        def.position = rlf_vec3_make(places[i][0], places[i][1], places[i][2]);
        add(world, &def);
    }
}

/* Pairs of bodies that overlap even when both are made smaller. */
static int count_overlaps(const rlf_world *world, const int *kinds, int first, double scale)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    int overlaps = 0;
    for (int i = first; i < s->body_count; i++) {
        for (int k = i + 1; k < s->body_count; k++) {
            rlf_shape a = shape_of((kind)kinds[i], scale), b = shape_of((kind)kinds[k], scale);
            overlaps += rlf_shapes_overlap(&a, &s->bodies[i].T_world_body, &b,
                                           &s->bodies[k].T_world_body) == RLF_QUERY_HIT;
        }
    }
    return overlaps;
}

/* A heap of any shapes comes to rest, nothing in anything else. */
TEST_CASE(heaps_come_to_rest)
{
    for (int which = 0; which <= KINDS; which++) {
        rlf_world *world = make_world(9.81);
        int kinds[64] = {0};
        add_walls(world);
        for (int i = 0; i < 24; i++) {
            kind k = (kind)(which < KINDS ? which : i % KINDS);
            rlf_body_def def = body_of(k);
            def.position = rlf_vec3_make(0.2 * (i % 3 - 1) + draw(&seed, -0.01, 0.01),
                                         0.3 - 0.3 * (i / 6) + draw(&seed, -0.01, 0.01),
                                         0.9 + 0.2 * (i / 3 % 2) + draw(&seed, -0.01, 0.01));
            def.orientation = rlf_quat_from_rotation_vector(draw_vector(&seed, 2));
            def.restitution = 0.2;
            def.rolling_resistance = 0.05;
            kinds[5 + i] = k;
            add(world, &def);
        }
        int awake = 0;
        advance_steps(world, NULL, 240, 1.0 / 30);
        assert_int_equal(rlf_world_get_snapshot(world)->body_count, 29);
        for (int i = 5; i < 29; i++) {
            awake += !body(world, i)->is_asleep;
        }
        int overlaps = count_overlaps(world, kinds, 5, 0.97);
        print_message("heap of %s: %d overlap, %d awake\n", which < KINDS ? NAMES[which] : "all",
                      overlaps, awake);
        assert_int_equal(overlaps, 0);
        assert_int_equal(awake, 0);
        rlf_world_destroy(&world);
    }
}

#define RINGS 21
#define SEGMENTS 24

/* Of 504 corners 64 are sample points; it stands on the others, too. */
TEST_CASE(fine_hulls_rest_on_the_surface)
{
    static turned_hull ball; /* of 10 cm radius */
    turned_ring rings[RINGS];
    double worst = 0;
    for (int r = 0; r < RINGS; r++) {
        double polar = RLF_PI * (r + 0.02) / (RINGS - 0.96);
        rings[r] = (turned_ring){0.1 * cos(polar), 0.1 * sin(polar)};
    }
    turned_hull_make(&ball, rings, RINGS, SEGMENTS);
    grid_room_create();
    for (int i = 0; i < 4; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.shape = (rlf_shape){.type = RLF_SHAPE_HULL, .hull = &ball.hull};
        def.position = rlf_vec3_make(0, GRID_ROOM_FLOOR - 0.12, 2);
        def.orientation = rlf_quat_from_rotation_vector(draw_vector(&seed, 3));
        def.restitution = 0;
        def.rolling_resistance = 0.1;
        grid_room_way way = grid_room_run(RLF_BORDER_OPEN, &def, 60);
        assert_true(way.is_there);
        worst = fmax(worst, fabs(GRID_ROOM_FLOOR - way.p.y - 0.1));
    }
    assert_less(worst, 1.5e-3);
    grid_fixture_destroy(&grid_room);
}

#define RIM 16

/* A box of 20 x 10 x 20 cm whose upper and lower edges have three more corners each, in a line. */
static const rlf_hull *box_of_many_corners(void)
{
    static rlf_vec3 vertices[2 * RIM];
    static int32_t triangles[3 * 4 * RIM];
    static rlf_hull hull;
    int32_t n = 0;
    for (int i = 0; i < RIM; i++) {
        double along = 0.05 * (i % 4) - 0.1;
        double x = i / 4 == 0 ? along : i / 4 == 1 ? 0.1 : i / 4 == 2 ? -along : -0.1;
        double z = i / 4 == 0 ? -0.1 : i / 4 == 1 ? along : i / 4 == 2 ? 0.1 : -along;
        vertices[i] = rlf_vec3_make(x, -0.05, z);
        vertices[RIM + i] = rlf_vec3_make(x, 0.05, z);
        int32_t next_i = (i + 1) % RIM;
        const int32_t side[6] = {i, RIM + i, next_i, next_i, RIM + i, RIM + next_i};
        const int32_t caps[6] = {0, i, next_i, RIM, RIM + next_i, RIM + i};
        for (int k = 0; k < 6; k++) {
            triangles[n++] = side[k];
        }
        for (int k = 0; k < 6 && i > 0 && i + 1 < RIM; k++) {
            triangles[n++] = caps[k];
        }
    }
    hull = (rlf_hull){vertices, 2 * RIM, triangles, n / 3};
    return &hull;
}

/* Edge on edge in a line, where rounding decides which corners are cut away. */
TEST_CASE(corners_in_a_line_stand)
{
    for (int i = 0; i < 12; i++) {
        rlf_world *world = make_world(9.81);
        rlf_body_def def = rlf_body_def_default();
        def.shape = (rlf_shape){.type = RLF_SHAPE_HULL, .hull = box_of_many_corners()};
        def.orientation = rlf_quat_from_rotation_vector(rlf_vec3_make(0, 0.7 * i, 0));
        def.position = rlf_vec3_make(0.1 * i, 0, 1);
        def.is_kinematic = true;
        add(world, &def);
        def.is_kinematic = false;
        def.restitution = 0;
        def.position.y = -0.101;
        add(world, &def);
        advance_steps(world, NULL, 30, 1.0 / 30);
        assert_true(fabs(body(world, 1)->T_world_body.p.y + 0.1) < 1e-3);
        assert_true(fabs(body(world, 1)->T_world_body.p.x - 0.1 * i) < 1e-3);
        rlf_world_destroy(&world);
    }
}

TEST_CASE(open_hulls_are_refused)
{
    rlf_world *world = make_world(0);
    rlf_body_def def = body_of(TIPPED);
    const rlf_hull half = {TIPS, 6, OCTAHEDRON_FACES, 4};
    def.shape.hull = &half;
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "not closed"));
    rlf_world_destroy(&world);
}
