/* How blows are told: where two things met and which way, not where they are when it is told. */
#include "physics/grid/contact/contact.h"
#include "test.h"
#include "grid_room.h"

#include <math.h>

/* The hardest contact of the frame; of speed 0 where there is none. */
static rlf_contact hardest(const rlf_world *world)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    rlf_contact best = {.approach_speed = 0.0};
    for (int32_t i = 0; i < s->contact_count; i++) {
        if (s->contacts[i].approach_speed > best.approach_speed) {
            best = s->contacts[i];
        }
    }
    return best;
}

/* The blow of a box's side, which turns as it comes, on the edge of a box that stays. */
static rlf_contact blow_on_edge(double gap, double step)
{
    const double HALF_DIAGONAL = 0.1 * sqrt(2.0);
    rlf_world_def world_def = small_world_def();
    world_def.body_capacity = 2;
    world_def.gravity = rlf_vec3_make(0, 0, 0);
    rlf_world *world = world_of(&world_def);
    rlf_body_def edge = rlf_body_def_default();
    edge.is_kinematic = true;
    edge.shape.size = rlf_vec3_make(0.2, 0.2, 0.2);
    edge.position = rlf_vec3_make(0, 0, 2);
    edge.orientation = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), RLF_PI / 4);
    add_body(world, &edge);
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(0.2, 0.2, 0.1);
    def.restitution = 1.0;
    def.friction = 0.0;
    def.position = rlf_vec3_make(0.03, 0, 2 - HALF_DIAGONAL - 0.05 - gap);
    def.velocity = rlf_vec3_make(0, 0, 1);
    def.angular_velocity = rlf_vec3_make(0, 3, 0);
    add_body(world, &def);
    rlf_contact blow = {.approach_speed = 0.0};
    for (double t = 0.0; t < 0.3 && !(blow.approach_speed > 0.0); t += step) {
        rlf_world_advance(world, NULL, step);
        blow = hardest(world);
    }
    rlf_world_destroy(&world);
    return blow;
}

/* However many substeps an advance has left after it. */
TEST_CASE(a_normal_is_that_of_the_blow)
{
    double most = 0.0;
    for (int k = 0; k < 8; k++) {
        double gap = 0.004 + 0.004 * k;
        rlf_contact often = blow_on_edge(gap, 1.0 / 240), seldom = blow_on_edge(gap, 1.0 / 30);
        assert_true(often.approach_speed > 0.5 && seldom.approach_speed > 0.5);
        double turn = asin(rlf_length(rlf_cross(often.normal, seldom.normal))) * 180 / RLF_PI;
        most = rlf_max(most, turn);
    }
    assert_less(most, 0.1);
}

/* A body whose centre is stopped at the wall is back where it was; the blow was on its way. */
TEST_CASE(a_stopped_centre_met_the_wall)
{
    grid_query query = {.grid = &grid_room->grid, .T_grid_world = rlf_pose_identity()};
    query.step = 1.0 / 240;
    phys_contact contacts[PHYS_SURFACE_CONTACTS];
    phys_body body = {.restitution = 0.5, .inverse_mass = 1.0, .surface = contacts};
    body.shape.inner_radius = 0.02;
    body.v = rlf_vec3_make(3, 1, 30);
    const rlf_vec3 before = rlf_vec3_make(0, 0, GRID_ROOM_WALL - 0.1);
    body.x = rlf_mad(before, body.v, query.step);
    grid_guard_centre(&query, &body, 0, before);
    assert_int_equal(body.surface_count, 1);
    rlf_vec3 met = rlf_mad(before, rlf_vec3_make(3, 1, 30), 0.1 / 30);
    assert_less(fabs(phys_widen(body.surface[0].met).z - GRID_ROOM_WALL), 1e-6);
    assert_less(rlf_length(rlf_sub(phys_widen(body.surface[0].met), met)), GRID_ROOM_WALL / GRID_F);
    assert_less(body.surface[0].met_normal.z, -0.999);
}

TEST_GROUP(grid_room_start, grid_room_destroy)
