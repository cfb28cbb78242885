/* What of known hands touches a body: round cones, their hidden sides too. */
#include "physics/grab/grab.h"

#define SAMPLES 5       /* along a cone */
#define SURE_M 0.008    /* a fit that is right is so far off */
#define CLOSING_M 0.015 /* and its hidden digits so far: of a hand that closes here */
#define REACH_M 0.22    /* of a hand, from its palm */
#define INSIDE_M 0.015  /* from the body: the place of a grasp is in it */
#define HOLLOW_M 0.035  /* a fist's middle before its palm */

/* The least distance of a cone to the shape. */
static double nearest(const phys_shape *shape, const rlf_round_cone *cone, rlf_vec3 *point,
                      rlf_vec3 *normal)
{
    double least = 1e9;
    for (int32_t k = 0; k < SAMPLES; k++) {
        const double share = (double)k / (SAMPLES - 1);
        const rlf_vec3 p = rlf_mad(cone->a, rlf_sub(cone->b, cone->a), share);
        const double radius = cone->radius_a + share * (cone->radius_b - cone->radius_a);
        rlf_vec3 gradient;
        const double core = phys_shape_distance(shape, p, &gradient);
        if (core - radius < least) {
            least = core - radius;
            *point = rlf_mad(p, gradient, -core);
            *normal = gradient;
        }
    }
    return least;
}

static bool is_inside(const phys_shape *shape, rlf_vec3 p)
{
    rlf_vec3 gradient;
    return phys_shape_distance(shape, p, &gradient) < INSIDE_M;
}

/* Between thumb and fingers, or in the hollow of the hand. */
static bool is_grasped_at(const phys_shape *shape, const rlf_grid_hand *h,
                          const rlf_pose *T_body_grid, rlf_vec3 shift)
{
    const rlf_vec3 fingers = rlf_scale(rlf_add(grab_tip(h, 1), grab_tip(h, 2)), 0.5);
    const rlf_vec3 between = rlf_scale(rlf_add(fingers, grab_tip(h, 0)), 0.5);
    const rlf_vec3 palm = rlf_scale(rlf_add(h->cones[1].a, h->cones[1].b), 0.5);
    const rlf_vec3 hollow =
        rlf_mad(rlf_scale(rlf_add(palm, h->cones[1].b), 0.5), h->facing, HOLLOW_M);
    return is_inside(shape, rlf_transform(T_body_grid, rlf_add(between, shift))) ||
           is_inside(shape, rlf_transform(T_body_grid, rlf_add(hollow, shift)));
}

static void add_cones(const grid_query *query, int32_t hand, const phys_shape *shape,
                      const rlf_pose *T_body_grid, rlf_vec3 shift, double tolerance,
                      grab_touches *out)
{
    const rlf_grid_hand *h = &query->grid->hands[hand];
    for (int32_t k = 0; k < RLF_GRID_HAND_CONES && out->count < GRAB_TOUCHES_MAX; k++) {
        rlf_round_cone cone = h->cones[k];
        grab_touch touch = {.hand = hand, .group = k < 6 ? GRAB_PALM : (k - 6) / 3};
        cone.a = rlf_transform(T_body_grid, rlf_add(cone.a, shift));
        cone.b = rlf_transform(T_body_grid, rlf_add(cone.b, shift));
        if (nearest(shape, &cone, &touch.point, &touch.normal) < tolerance) {
            out->touch[out->count++] = touch;
        }
    }
}

/* The nearer of the palm's middles, seen and fitted. */
static void note_palm(const phys_shape *shape, rlf_vec3 seen, rlf_vec3 fitted, int32_t hand,
                      grab_touches *out)
{
    rlf_vec3 normal;
    const double off = phys_shape_distance(shape, fitted, &normal);
    out->palm_off[hand] = phys_shape_distance(shape, seen, &out->palm_normal[hand]);
    if (off < out->palm_off[hand]) {
        out->palm_off[hand] = off;
        out->palm_normal[hand] = normal;
    }
}

void grab_touch_hands(const rlf_world *world, const grid_query *query, const phys_body *body,
                      const rlf_pose *T_world_body, double tau, grab_touches *out)
{
    const rlf_grid *grid = query->grid;
    const rlf_pose T_grid_body = rlf_pose_mul(&query->T_grid_world, T_world_body);
    const rlf_pose T_body_grid = rlf_pose_invert(&T_grid_body);
    out->count = 0;
    out->is_judged = false;
    for (int32_t k = 0; k < grid->hand_count; k++) {
        const rlf_grid_hand *h = &grid->hands[k];
        const struct phys_grab_hand *past = grab_hand_of(world, h->id);
        const rlf_vec3 v = past != NULL ? past->velocity : rlf_vec3_make(0, 0, 0);
        const rlf_vec3 shift = rlf_scale(rlf_rotate(query->T_grid_world.q, v), tau);
        const rlf_vec3 off = rlf_sub(rlf_add(h->cones[1].b, shift), T_grid_body.p);
        note_palm(&body->shape, rlf_transform(&T_body_grid, rlf_add(h->palm, shift)),
                  rlf_transform(&T_body_grid, rlf_add(grab_core(h), shift)), k, out);
        out->is_in[k] = false;
        if (rlf_length(off) > body->shape.radius + REACH_M || !h->is_sure) {
            continue;
        }
        out->is_in[k] = is_grasped_at(&body->shape, h, &T_body_grid, shift);
        const bool is_closing = past != NULL && out->is_in[k] && grab_hand_closes(past);
        add_cones(query, k, &body->shape, &T_body_grid, shift, is_closing ? CLOSING_M : SURE_M,
                  out);
        out->is_judged = out->is_judged || out->is_in[k] || out->count > 0;
    }
}
