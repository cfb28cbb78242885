/* Bodies across the picture's border lie on the plane that goes on as they lie within it. */
#include "grid_room.h"
#include "test.h"

#define LEVEL 0.99995 /* cosine of 0.01 */
#define OFF 0.002     /* m */

enum {
    THICKS = 4,
    WIDES = 4,
    OFFS = 5,
    TURNS = 2,
    TRAYS = THICKS * WIDES * OFFS * TURNS,
    SEAMS = 7
};

/* Half the angle of view, in metres per metre of distance. */
#define VIEW_X (GRID_CX / GRID_F)
#define VIEW_Y (GRID_CY / GRID_F)

/* A place where the picture's border crosses the ground, the way out of view, the ground's normal.
 */
typedef struct seam {
    rlf_vec3 place, out, normal;
} seam;

static const seam seams[SEAMS] = {
    {{0, GRID_ROOM_FLOOR, GRID_ROOM_FLOOR / VIEW_Y}, {0, 0, -1}, {0, -1, 0}},
    {{-2.4 * VIEW_X, GRID_ROOM_FLOOR, 2.4}, {-1, 0, 0}, {0, -1, 0}},
    {{2.4 * VIEW_X, GRID_ROOM_FLOOR, 2.4}, {1, 0, 0}, {0, -1, 0}},
    {{-GRID_ROOM_WALL * VIEW_X, -0.6, GRID_ROOM_WALL}, {-1, 0, 0}, {0, 0, -1}},
    {{GRID_ROOM_WALL * VIEW_X, -0.6, GRID_ROOM_WALL}, {1, 0, 0}, {0, 0, -1}},
    {{0.3, -GRID_ROOM_WALL *VIEW_Y, GRID_ROOM_WALL}, {0, -1, 0}, {0, 0, -1}},
    {{1.7, GRID_ROOM_FLOOR, 1.7 / VIEW_X}, {0.7, 0, -0.7}, {0, -1, 0}},
};

/* A tray lies along the ground: its size, and its thin axis. */
static rlf_body_def tray(const seam *g, int i)
{
    const double thicks[THICKS] = {0.005, 0.02, 0.04, 0.1};
    const double wides[WIDES] = {0.1, 0.15, 0.3, 0.5};
    double thick = thicks[i % THICKS], wide = wides[i / THICKS % WIDES];
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = g->normal.y < 0 ? rlf_vec3_make(wide, thick, 0.7 * wide)
                                     : rlf_vec3_make(wide, 0.7 * wide, thick);
    def.mass = 0.5;
    def.collides_with_bodies = false;
    def.position = rlf_mad(g->place, g->out, 0.06 * (i / (THICKS * WIDES) % OFFS - OFFS / 2));
    def.position = rlf_mad(def.position, g->normal, 0.5 * thick + 0.002);
    if (i / (THICKS * WIDES * OFFS) == 1) {
        def.orientation = rlf_quat_from_axis_angle(g->normal, 0.4);
    }
    return def;
}

static rlf_world *add_trays(const seam *g, double height, double slide)
{
    rlf_world_def world_def = small_world_def();
    world_def.body_capacity = TRAYS;
    world_def.gravity = rlf_scale(g->normal, -9.81);
    rlf_world *world = world_of(&world_def);
    for (int i = 0; i < TRAYS; i++) {
        rlf_body_def def = tray(g, i);
        def.position = rlf_mad(def.position, g->normal, height);
        def.position = rlf_mad(def.position, g->out, -0.2 * slide);
        def.velocity = rlf_scale(g->out, slide);
        def.angular_velocity = rlf_scale(g->normal, slide);
        add_body(world, &def);
    }
    return world;
}

static void check_tray(const seam *g, const rlf_body_state *b)
{
    bool is_floor = g->normal.y < 0;
    rlf_vec3 axis = is_floor ? rlf_vec3_make(0, -1, 0) : rlf_vec3_make(0, 0, -1);
    double level = rlf_dot(rlf_rotate(b->T_world_body.q, axis), g->normal);
    double thick = is_floor ? b->shape.size.y : b->shape.size.z;
    double high = rlf_dot(rlf_sub(b->T_world_body.p, g->place), g->normal) - 0.5 * thick;
    double speed = rlf_length(b->velocity) + 0.1 * rlf_length(b->angular_velocity);
    if (!(level > LEVEL) || high > OFF || high < -OFF || speed > 0.01) {
        fail_msg("seam %d, %.3f m thick, %.2f m wide: cosine %.5f, %.4f m high, %.3f m/s",
                 (int)(g - seams), thick, b->shape.size.x, level, high, speed);
    }
}

/* After so many frames all lie flat and still, and none was deep in the ground on the way. */
static void check_trays(const seam *g, rlf_world **world, int frames)
{
    double deepest = 0.0;
    for (int frame = 0; frame < frames; frame++) {
        grid_room->grid.time_ns++;
        rlf_world_advance(*world, &grid_room->grid, GRID_ROOM_FRAME);
        const rlf_snapshot *s = rlf_world_get_snapshot(*world);
        for (int32_t i = 0; i < s->contact_count; i++) {
            deepest = rlf_min(deepest, s->contacts[i].separation);
        }
    }
    const rlf_snapshot *s = rlf_world_get_snapshot(*world);
    assert_int_equal(s->body_count, TRAYS);
    for (int32_t i = 0; i < s->body_count; i++) {
        check_tray(g, &s->bodies[i]);
    }
    assert_true(deepest > -OFF);
    rlf_world_destroy(world);
}

TEST_CASE(tray_that_falls_on_the_border_lies_flat)
{
    for (int k = 0; k < SEAMS; k++) {
        rlf_world *world = add_trays(&seams[k], 0.06, 0.0);
        check_trays(&seams[k], &world, 36);
    }
}

TEST_CASE(tray_slides_across_the_border)
{
    for (int k = 0; k < SEAMS; k++) {
        rlf_world *world = add_trays(&seams[k], 0.0, 1.0);
        check_trays(&seams[k], &world, 30);
    }
}

TEST_GROUP(grid_room_start, grid_room_destroy)
