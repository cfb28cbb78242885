/* Bodies held between sensed fingers: grasped, lifted, carried, let go, thrown; and not grabbed by
 * what only pushes, passes or rests beside. */
#include "grid_hand.h"
#include "grid_shared.h"
#include "small_world.h"
#include "test.h"

#define FRAME (1.0 / 30)
#define TABLE 0.30 /* y of its top, metres: y is down */

typedef struct grasp {
    const char *name;
    rlf_vec3 along;  /* fingers point this way, unit */
    rlf_vec3 across; /* from one finger to the other, unit */
    rlf_shape shape;
    double width; /* between the fingers when they touch */
    double noise; /* m of depth */
    bool is_fit;  /* the hand is known: what opens along the view is seen by its fit alone */
} grasp;

/* A table, and something on it. */
static rlf_world *make_world(const rlf_shape *shape, rlf_vec3 at)
{
    const grid_plane room[2] = {grid_floor(TABLE), grid_wall(2)};
    grid_fixture_set_room(fixture, room, 2);
    rlf_world_def def = small_world_def();
    def.body_capacity = 8;
    def.enable_grab = true;
    rlf_world *world = world_of(&def);
    rlf_body_def body = rlf_body_def_default();
    body.shape = *shape;
    body.position = at;
    body.restitution = 0.1;
    add_body(world, &body);
    return world;
}

/* Its fit: thumb and index, and the other fingers beside the index. */
static rlf_grid_hand fitted_hand(const grid_hand *seen)
{
    const rlf_vec3 beside = rlf_cross(seen->along, seen->across);
    rlf_grid_hand hand = {.id = 1, .is_sure = true, .facing = seen->along};
    hand.palm = rlf_mad(seen->place, seen->along, -0.09);
    for (int32_t k = 0; k < RLF_GRID_HAND_CONES; k++) {
        const int32_t digit = (k - 6) / 3, bone = (k - 6) % 3;
        const double side = digit == 0 ? -0.5 : 0.5, deep = digit > 1 ? 0.02 * (digit - 1) : 0.0;
        const rlf_vec3 aside =
            rlf_add(rlf_scale(seen->across, side * (seen->gap + 0.018)), rlf_scale(beside, deep));
        hand.cones[k] = (rlf_round_cone){hand.palm, hand.palm, 0.015, 0.015};
        if (k >= 6) {
            const rlf_vec3 root = rlf_mad(rlf_add(hand.palm, aside), seen->along, 0.03 * bone);
            hand.cones[k] = (rlf_round_cone){root, rlf_mad(root, seen->along, 0.03), 0.009, 0.009};
        }
    }
    return hand;
}

static double ramp(double t, double begin, double end)
{
    return rlf_clamp((t - begin) / (end - begin), 0.0, 1.0);
}

/* Where the hand is off its start at time t, and how far open, 0..1. */
static rlf_vec3 way_at(double t, double *open)
{
    *open = 1.0 - ramp(t, 0.3, 0.6) + ramp(t, 4.0, 4.2);
    return rlf_vec3_make(0.5 * ramp(t, 1.6, 2.9), -0.2 * ramp(t, 0.8, 1.5), 0.0);
}

/* Grasps, lifts by 0.2 m, carries by 0.5 m, stays a second, opens. */
static void run_grasp(const grasp *g)
{
    rlf_vec3 start = {-0.25, TABLE - 0.5 * g->shape.size.y, 1.0};
    rlf_world *world = make_world(&g->shape, start);
    double slip = 0, drop = 0;
    rlf_vec3 off = {0, 0, 0}, last = {0, 0, 0};
    int held = 0, first = -1;
    for (int frame = 0; frame < 150; frame++) {
        double open, open_before;
        rlf_vec3 way = way_at(frame * FRAME, &open);
        rlf_vec3 before = way_at((frame - 1) * FRAME, &open_before);
        grid_hand hand = {.place = rlf_add(start, way), .along = g->along, .across = g->across};
        hand.velocity = rlf_scale(rlf_sub(way, before), 1.0 / FRAME);
        hand.gap = g->width - 0.002 + 0.06 * open;
        hand.closing = 0.06 * (open - open_before) / FRAME;
        hand.noise = g->noise;
        const rlf_grid_hand fitted = fitted_hand(&hand);
        grid_hand_see(fixture, &hand, frame);
        fixture->grid.hands = &fitted;
        fixture->grid.hand_count = g->is_fit ? 1 : 0;
        rlf_world_advance(world, &fixture->grid, FRAME);
        const rlf_body_state *body = body_at(world, 0);
        rlf_vec3 now = rlf_sub(body->T_world_body.p, hand.place);
        held += body->is_grabbed;
        first = first < 0 && body->is_grabbed ? frame : first;
        if (frame == 22) {
            off = now;
        }
        if (frame > 22 && frame <= 119) {
            slip = rlf_max(slip, rlf_length(rlf_sub(now, off)));
        }
        last = now;
    }
    drop = last.y;
    assert_less(slip, 0.005);
    assert_true(!body_at(world, 0)->is_grabbed);
    assert_true(drop > 0.15); /* let go where the hand opened */
    rlf_world_destroy(&world);
}

TEST_CASE(hands_lift_carry_and_let_go)
{
    const rlf_shape cube = {.type = RLF_SHAPE_BOX, .size = {0.06, 0.06, 0.06}};
    const rlf_shape large = {.type = RLF_SHAPE_BOX, .size = {0.12, 0.12, 0.12}};
    const rlf_vec3 down = {0, 1, 0}, right = {1, 0, 0}, away = {0, 0, 1};
    const grasp all[] = {
        {"from above, noisy", down, right, cube, 0.06, 0.0015, false},
        {"from above, noisy, fitted", down, right, cube, 0.06, 0.0015, true},
        {"from above, thumb before it", down, away, cube, 0.06, 0.0015, true},
        {"large, from above", down, right, large, 0.12, 0.0015, false},
    };
    for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); i++) {
        run_grasp(&all[i]);
    }
}

/* One finger that pushes a cube across the table holds nothing. */
TEST_CASE(what_pushes_does_not_hold)
{
    const rlf_shape cube = {.type = RLF_SHAPE_BOX, .size = {0.06, 0.06, 0.06}};
    rlf_vec3 start = {-0.1, TABLE - 0.03, 1.0};
    rlf_world *world = make_world(&cube, start);
    grid_hand hand = {.along = {0, 1, 0}, .across = {1, 0, 0}, .gap = 0.1, .is_one = true};
    for (int frame = 0; frame < 45; frame++) {
        hand.place = rlf_add(start, rlf_vec3_make(0.3 * frame * FRAME, 0, 0));
        hand.velocity = rlf_vec3_make(0.3, 0, 0);
        grid_hand_see(fixture, &hand, frame);
        rlf_world_advance(world, &fixture->grid, FRAME);
        assert_true(!body_at(world, 0)->is_grabbed);
    }
    assert_true(body_at(world, 0)->T_world_body.p.x > start.x + 0.2); /* it was pushed */
    rlf_world_destroy(&world);
}

/* One finger alone is seen; the fit knows the thumb. */
static int32_t frames_held(bool closes, bool *is_let_go)
{
    const rlf_shape cube = {.type = RLF_SHAPE_BOX, .size = {0.05, 0.05, 0.05}};
    rlf_vec3 start = {-0.1, TABLE - 0.025, 1.0};
    rlf_world *world = make_world(&cube, start);
    int32_t held = 0;
    for (int frame = 0; frame < 100; frame++) {
        const double t = frame * FRAME;
        const bool is_up = t > 0.9 && t<1.5, is_aside = t> 1.6 && t < 2.0;
        const double open = 1.0 - ramp(t, 0.3, 0.6) + ramp(t, 2.2, 2.4);
        const rlf_vec3 way = {0.1 * ramp(t, 1.6, 2.0), -0.15 * ramp(t, 0.9, 1.5), 0};
        grid_hand hand = {.place = rlf_add(start, way), .along = {0, 1, 0}, .across = {1, 0, 0}};
        hand.is_one = true;
        hand.velocity = rlf_vec3_make(is_aside ? 0.25 : 0.0, is_up ? -0.25 : 0.0, 0);
        hand.gap = 0.048 + (closes ? 0.06 * open : 0.0);
        hand.place = closes || t > 0.5 ? hand.place : rlf_mad(hand.place, hand.across, t - 0.5);
        const rlf_grid_hand fitted = fitted_hand(&hand);
        grid_hand_see(fixture, &hand, frame);
        fixture->grid.hands = &fitted;
        fixture->grid.hand_count = 1;
        rlf_world_advance(world, &fixture->grid, FRAME);
        held += body_at(world, 0)->is_grabbed;
    }
    *is_let_go = !body_at(world, 0)->is_grabbed;
    rlf_world_destroy(&world);
    return held;
}

TEST_CASE(a_fitted_hand_holds_where_it_closes)
{
    bool is_let_go = false;
    const int32_t held = frames_held(true, &is_let_go);
    assert_true(held > 45 && held < 65); /* from 0.6 to 2.3 s */
    assert_true(is_let_go);
    assert_int_equal(frames_held(false, &is_let_go), 0); /* closed before: it only pushes */
}

TEST_EACH(set_up, tear_down)
