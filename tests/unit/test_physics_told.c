/* A tray moves before its motion is told: a body that rests on it is still where the tray was. From
 * the first frame that tells, it is taken along, and has the way that it was not told. */
#include "grid_shared.h"
#include "small_world.h"
#include "test.h"

#include <math.h>

#define TOP_Y 0.5
#define HALF 0.05
#define FRAME_S (1.0 / 30)

/* The body after the tray has risen by `way` metres untold, and on at `speed` for a while. */
typedef struct ride {
    double gap;     /* m between the tray and the body at the end; negative: sunk in */
    double highest; /* m, the largest gap on the way */
    double rising;  /* m/s, at the end */
} ride;

static void show_tray(double y, double thickness, double rising)
{
    const grid_plane top = {rlf_vec3_make(0, -1, 0), -y};
    grid_fixture_set_slab(fixture, top, rlf_vec3_make(0, y, 2), rlf_vec3_make(0.25, 0, 0.25),
                          thickness * 2.0 / y, rlf_vec3_make(0, -rising, 0));
    fixture->grid.time_ns++;
}

static ride ride_tray(rlf_shape_type type, double thickness, double way, double speed)
{
    const grid_plane floor = grid_floor(1.2);
    rlf_world_def world_def = small_world_def();
    rlf_body_def def = rlf_body_def_default();
    rlf_world *world = NULL;
    ride out = {0, 0, 0};
    def.shape = (rlf_shape){.type = type, .size = {0.1, 0.1, 0.1}, .radius = HALF};
    def.position = rlf_vec3_make(0.01, TOP_Y - HALF, 2.01);
    def.restitution = 0.2;
    grid_fixture_set_room(fixture, &floor, 1);
    world = world_of(&world_def);
    add_body(world, &def);
    for (int k = 0; k < 20; k++) {
        show_tray(TOP_Y, thickness, 0.0);
        rlf_world_advance(world, &fixture->grid, FRAME_S);
    }
    double y = TOP_Y - way;
    for (int k = 0; k < 10; k++, y -= speed * FRAME_S) {
        show_tray(y, thickness, speed);
        rlf_world_advance(world, &fixture->grid, FRAME_S);
        const rlf_body_state *body = &rlf_world_get_snapshot(world)->bodies[0];
        out.gap = y - HALF - body->T_world_body.p.y;
        out.highest = rlf_max(out.highest, out.gap);
        out.rising = -body->velocity.y;
    }
    rlf_world_destroy(&world);
    return out;
}

TEST_CASE(body_has_the_way_that_was_not_told)
{
    static const double ways[] = {0.005, 0.01, 0.02}, speeds[] = {0.1, 0.25, 0.5, 1.0};
    static const double thick[] = {0.01, 0.024, 0.05};
    for (int i = 0; i < 2 * 3 * 4 * 3; i++) {
        const rlf_shape_type type = i % 2 == 0 ? RLF_SHAPE_BOX : RLF_SHAPE_SPHERE;
        const double way = ways[i / 2 % 3], speed = speeds[i / 6 % 4], thickness = thick[i / 24];
        const ride r = ride_tray(type, thickness, way, speed);
        const bool is_on = r.gap > -0.002 && r.highest < 0.003 && fabs(r.rising - speed) < 0.01;
        if (!is_on) {
            fail_msg("%s, tray of %.0f mm, untold %.0f mm, %.2f m/s: gap %.2f mm, highest "
                     "%.2f mm, rises at %.3f m/s",
                     type == RLF_SHAPE_BOX ? "box" : "ball", 1e3 * thickness, 1e3 * way, speed,
                     1e3 * r.gap, 1e3 * r.highest, r.rising);
        }
    }
}

TEST_EACH(set_up, tear_down)
