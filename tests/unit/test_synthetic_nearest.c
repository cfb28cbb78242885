/* The true scene at any time: distances, and the velocity that moves them. */
#include "created.h"
#include "test.h"

#include <math.h>

static rlf_source *open_scene(rlf_synthetic_scene scene, double speed)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.scene = scene;
    def.speed = speed;
    def.enable_color = false;
    return synthetic_of(&def);
}

static rlf_synthetic_hit nearest(rlf_source *source, double t, rlf_vec3 p)
{
    rlf_synthetic_hit hit;
    assert_int_equal(rlf_synthetic_nearest(source, t, p, &hit), RLF_OK);
    return hit;
}

/* d/dt of the distance from a fixed point is -n.v of the surface's nearest point. */
TEST_CASE(distance_changes_with_the_velocity)
{
    rlf_source *source = open_scene(RLF_SYNTHETIC_ROOM, 0.5);
    int moving = 0;
    for (int i = 0; i < 200; i++) {
        const double H = 1e-4;
        double t = 0.5 + 0.031 * i;
        rlf_vec3 p = rlf_vec3_make(2.2 - 0.013 * i, -0.4 + 0.008 * i, 2.7);
        rlf_synthetic_hit hit = nearest(source, t, p);
        rlf_synthetic_hit before = nearest(source, t - H, p), after = nearest(source, t + H, p);
        if (hit.label != RLF_SYNTHETIC_LABEL_PERSON || before.label != hit.label ||
            rlf_dot(before.normal, after.normal) < 0.99999) {
            continue;
        }
        double rate = (after.distance - before.distance) / (2.0 * H);
        assert_true(fabs(rate + rlf_dot(hit.normal, hit.velocity)) < 0.02);
        moving += fabs(rate) > 0.1;
    }
    assert_true(moving > 10);
    rlf_source_destroy(&source);
}

TEST_CASE(trays_move_at_the_given_speed)
{
    rlf_source *lift = open_scene(RLF_SYNTHETIC_LIFT, 2.0);
    rlf_synthetic_hit rest = nearest(lift, 2.0, rlf_vec3_make(0, 0.7, 1.5));
    assert_int_equal(rest.label, RLF_SYNTHETIC_LABEL_TRAY);
    assert_true(fabs(rest.distance - 0.038) < 1e-9 && fabs(rest.normal.y + 1.0) < 1e-9);
    rlf_synthetic_hit risen = nearest(lift, 3.1, rlf_vec3_make(0, 0.5, 1.5));
    assert_true(fabs(risen.distance - 0.038) < 1e-9 && fabs(risen.velocity.y + 2.0) < 1e-6);
    rlf_source_destroy(&lift);
    rlf_source *swipe = open_scene(RLF_SYNTHETIC_SWIPE, 1.0);
    rlf_synthetic_hit side = nearest(swipe, 3.6, rlf_vec3_make(0.1, 1.1, 2.8));
    assert_int_equal(side.label, RLF_SYNTHETIC_LABEL_TRAY);
    assert_true(side.normal.x > 0.9 && side.normal.z < -0.3);
    assert_true(fabs(side.velocity.x - 1.0) < 1e-6);
    rlf_source_destroy(&swipe);
    rlf_source *carry = open_scene(RLF_SYNTHETIC_CARRY, 0.5);
    rlf_synthetic_hit top = nearest(carry, 5.0, rlf_vec3_make(-0.3, 0.3, 1.6));
    assert_true(fabs(rlf_length(rlf_vec3_make(top.velocity.x, 0, top.velocity.z)) - 0.5) < 1e-3);
    rlf_source_destroy(&carry);
}

TEST_CASE(furniture_is_there_until_it_is_taken)
{
    rlf_source *chair = open_scene(RLF_SYNTHETIC_CHAIR, 0.5);
    rlf_vec3 seat = {-1.12, 0.83, 3.42};
    assert_int_equal(nearest(chair, 3.99, seat).label, RLF_SYNTHETIC_LABEL_CHAIR);
    assert_int_not_equal(nearest(chair, 4.01, seat).label, RLF_SYNTHETIC_LABEL_CHAIR);
    rlf_source_destroy(&chair);
}
