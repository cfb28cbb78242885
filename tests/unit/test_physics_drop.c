/* Bodies that fall without restitution stop where they land: a blow turns neither depth nor what is
 * above the ground into speed. */
#include "grid_room.h"
#include "test.h"

#include <math.h>

enum { SHAPES = 7, SIZES = 5, SPEEDS = 7, PLACES = 4, DROPS = SPEEDS * PLACES };

static const double sizes[SIZES] = {0.005, 0.01, 0.02, 0.03, 0.1};

/* Of full size 2: pyramids without a top, wide end up and down, and a wedge on its edge's side. */
static const int32_t block_faces[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                        1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
static const int32_t wedge_faces[24] = {0, 2, 1, 0, 3, 2, 0, 1, 5, 0, 5, 4,
                                        1, 2, 5, 2, 3, 4, 2, 4, 5, 3, 0, 4};
static const rlf_vec3 wedge[6] = {{-1, 0.5, -1}, {1, 0.5, -1}, {1, 0.5, 1},
                                  {-1, 0.5, 1},  {-1, -1, 0},  {1, -1, 0}};

typedef struct drop_hulls {
    rlf_vec3 points[3][8];
    rlf_hull hulls[3];
} drop_hulls;

static drop_hulls hulls[SIZES];

static void make_hulls(int size)
{
    double half = 0.5 * sizes[size];
    drop_hulls *h = &hulls[size];
    for (int i = 0; i < 8; i++) {
        double x = i % 4 == 1 || i % 4 == 2 ? 1 : -1, y = i < 4 ? 0.4 : -0.4,
               z = i % 4 >= 2 ? 1 : -1;
        double wide = i < 4 ? 0.6 : 1.0;
        h->points[0][i] = rlf_scale(rlf_vec3_make(wide * x, y, wide * z), half);
        h->points[1][i] = rlf_scale(rlf_vec3_make((1.6 - wide) * x, y, (1.6 - wide) * z), half);
        h->points[2][i] = rlf_scale(wedge[i % 6], half);
    }
    h->hulls[0] = (rlf_hull){h->points[0], 8, block_faces, 12};
    h->hulls[1] = (rlf_hull){h->points[1], 8, block_faces, 12};
    h->hulls[2] = (rlf_hull){h->points[2], 6, wedge_faces, 8};
}

static int set_up(void **state)
{
    (void)state;
    grid_room_create();
    for (int size = 0; size < SIZES; size++) {
        make_hulls(size);
    }
    return 0;
}

static rlf_shape shape_of(int k, int size)
{
    double s = sizes[size];
    const rlf_shape shapes[4] = {{.type = RLF_SHAPE_BOX, .size = {s, s, s}},
                                 {.type = RLF_SHAPE_SPHERE, .radius = 0.5 * s},
                                 {.type = RLF_SHAPE_CAPSULE, .radius = 0.5 * s, .height = 0.6 * s},
                                 {.type = RLF_SHAPE_CYLINDER, .radius = 0.5 * s, .height = s}};
    rlf_shape hull = {.type = RLF_SHAPE_HULL, .hull = &hulls[size].hulls[k < 4 ? 0 : k - 4]};
    return k < 4 ? shapes[k] : hull;
}

/* How far the lowest point of what lies flat is under the centre, in sizes. */
static const double below[SHAPES] = {0.5, 0.5, 0.5, 0.5, 0.2, 0.2, 0.25};

/* A world of bodies of one shape and size that fall at 1 to 10 m/s; the last place is where pixels
 * are farther apart than a small body is wide. */
static rlf_world *drop_all(int shape, int size, bool is_flat)
{
    const rlf_vec3 places[PLACES] = {{0.3, 0, 3.0}, {-0.4, 0, 2.5}, {0.9, 0, 2.0}, {0.0, 0, 3.7}};
    rlf_world_def world_def = small_world_def();
    world_def.body_capacity = DROPS;
    rlf_world *world = world_of(&world_def);
    for (int i = 0; i < DROPS; i++) {
        int speed = i / PLACES;
        rlf_body_def def = rlf_body_def_default();
        def.shape = shape_of(shape, size);
        def.mass = 0.05;
        def.restitution = 0.0;
        def.collides_with_bodies = false;
        def.position = places[i % PLACES];
        def.position.y = GRID_ROOM_FLOOR - below[shape] * sizes[size] - 0.15 - 0.0037 * speed;
        def.velocity = rlf_vec3_make(0, 1.0 + 1.5 * speed, 0);
        if (!is_flat) {
            def.orientation = rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(1, 2, 3)), 1.0);
        } else if (shape == 2) {
            def.orientation = rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), RLF_PI / 2);
        }
        add_body(world, &def);
    }
    return world;
}

static const rlf_snapshot *advance(rlf_world *world)
{
    grid_room->grid.time_ns++;
    rlf_world_advance(world, &grid_room->grid, GRID_ROOM_FRAME);
    return rlf_world_get_snapshot(world);
}

static void drop_flat(int shape, int size)
{
    rlf_world *world = drop_all(shape, size, true);
    rlf_vec3 starts[DROPS];
    for (int i = 0; i < DROPS; i++) {
        starts[i] = rlf_world_get_snapshot(world)->bodies[i].T_world_body.p;
    }
    for (int frame = 1; frame <= 15; frame++) {
        const rlf_snapshot *s = advance(world);
        for (int32_t i = 0; i < s->body_count; i++) {
            const rlf_body_state *b = &s->bodies[i];
            rlf_vec3 off = rlf_sub(b->T_world_body.p, starts[i]);
            double high = GRID_ROOM_FLOOR - b->T_world_body.p.y - below[shape] * sizes[size];
            double spin = rlf_length(b->angular_velocity);
            bool has_landed = frame > 5;
            if (has_landed && (hypot(off.x, off.z) > 0.01 || high > 0.002 || high < -0.002 ||
                               (frame == 15 && spin * sizes[size] > 0.002))) {
                fail_msg(
                    "shape %d of %g m, at %g m/s, place %d: %.4f m aside, %.4f m high, spin %.2f",
                    shape, sizes[size], 1.0 + 1.5 * (i / PLACES), i % PLACES, hypot(off.x, off.z),
                    high, spin);
            }
        }
    }
    rlf_world_destroy(&world);
}

TEST_CASE(what_falls_flat_stops_where_it_lands)
{
    for (int k = 0; k < SHAPES * SIZES; k++) {
        drop_flat(k % SHAPES, k / SHAPES);
    }
}

/* Of motion, and above the floor. */
static double energy_of(const rlf_body_state *b)
{
    rlf_mat3 inertia = rlf_shape_inertia(&b->shape, b->mass);
    rlf_vec3 w = rlf_rotate(rlf_quat_conjugate(b->T_world_body.q), b->angular_velocity);
    return 0.5 * b->mass * rlf_dot(b->velocity, b->velocity) +
           0.5 * rlf_dot(w, rlf_mat3_mul_vec(&inertia, w)) +
           9.81 * b->mass * (GRID_ROOM_FLOOR - b->T_world_body.p.y);
}

/* On a corner or an edge; what is round goes on rolling, no faster. */
static void drop_turned(int shape, int size)
{
    const double RISE = 0.001; /* m that a body is pushed out by */
    rlf_world *world = drop_all(shape, size, false);
    double least[DROPS], first[DROPS];
    for (int frame = 0; frame < 45; frame++) {
        const rlf_snapshot *s = advance(world);
        for (int32_t i = 0; i < s->body_count; i++) {
            double energy = energy_of(&s->bodies[i]);
            first[i] = frame == 0 ? energy : first[i];
            if (frame > 0 && energy > least[i] + 1e-3 * first[i] + RISE * 9.81 * 0.05) {
                fail_msg("shape %d of %g m, at %g m/s, place %d: %g J grew to %g J", shape,
                         sizes[size], 1.0 + 1.5 * (i / PLACES), i % PLACES, least[i], energy);
            }
            least[i] = frame == 0 ? energy : rlf_min(least[i], energy);
        }
    }
    rlf_world_destroy(&world);
}

TEST_CASE(no_drop_gains_energy)
{
    for (int k = 0; k < SHAPES * SIZES; k++) {
        drop_turned(k % SHAPES, k / SHAPES);
    }
}

TEST_GROUP(set_up, grid_room_destroy)
