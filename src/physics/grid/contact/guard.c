/* A body whose centre would enter the surface unseen by its contacts bounces there. */
#include "physics/grid/cast.h"
#include "physics/grid/contact/contact.h"
#include "physics/grid/mapped/mapped.h"

/* What stands in the way, world. */
typedef struct guard_wall {
    rlf_vec3 normal, point;
    rlf_vec3 velocity; /* m/s */
    rlf_contact_other other;
    int32_t label;
} guard_wall;

/* Adds the blow to the body's contacts. */
static void note_blow(phys_body *body, int32_t body_index, const guard_wall *wall, double impulse,
                      double approach, double time)
{
    bool is_full = body->surface_count == PHYS_SURFACE_CONTACTS;
    phys_contact *c = &body->surface[is_full ? body->surface_count - 1 : body->surface_count];
    if (!is_full) {
        body->surface_count++;
        *c = (phys_contact){.a = body_index, .b = -1, .other = wall->other, .log = -1};
        c->label = wall->label;
        c->normal = wall->normal;
        c->rounding_a = body->shape.inner_radius;
        c->anchor_b = wall->point;
        c->surface_velocity = wall->velocity;
        c->surface_time = time;
    }
    c->impulse_sum += impulse;
    if (approach > c->approach) {
        c->approach = approach;
        c->met = phys_narrow(wall->point); /* the body is back where it was before */
        c->met_normal = phys_narrow(wall->normal);
    }
}

/* A blow at the centre, which turns nothing. */
static void bounce(const grid_query *query, phys_body *body, int32_t body_index,
                   const guard_wall *wall)
{
    rlf_vec3 slip = rlf_sub(body->v, wall->velocity);
    double approach = -rlf_dot(wall->normal, slip);
    double push = (1.0 + body->restitution) * approach;
    rlf_vec3 sliding = rlf_mad(slip, wall->normal, approach);
    double held = body->friction * push / rlf_max(rlf_length(sliding), 1e-9);
    body->v = rlf_mad(rlf_mad(body->v, wall->normal, push), sliding, -rlf_min(held, 1.0));
    note_blow(body, body_index, wall, push / body->inverse_mass, approach, query->time);
    body->surface_version = 0;
    phys_body_ask_surface(body);
}

/* Whether the way from `from` to `to` enters the sheet, which moves with `flow`; all in the grid's
 * frame. */
static bool enters(const grid_query *query, const rlf_grid_sheet *sheet, rlf_vec3 from, rlf_vec3 to,
                   rlf_vec3 flow, field_hit *hit)
{
    /* the way as the moving sheet sees it */
    rlf_vec3 start = rlf_mad(from, flow, -query->tau);
    rlf_vec3 path = rlf_mad(rlf_sub(to, from), flow, -query->step);
    const field_side outside = {FIELD_NONE, start, true};
    field_cell cell;
    return sheet->depth != NULL && sheet->normal_x != NULL &&
           grid_field_at(query->grid, sheet, start, &cell) != FIELD_INSIDE &&
           grid_cast(query->grid, sheet, start, path, 0.0, &outside, hit);
}

/* Bounces a body that moves into the wall, from where it was before. */
static bool hold_back(const grid_query *query, phys_body *body, int32_t body_index, rlf_vec3 before,
                      const guard_wall *wall)
{
    if (rlf_dot(wall->normal, rlf_sub(body->v, wall->velocity)) >= 0.0) {
        return false; /* it leaves through that face: held back it would hang there for ever */
    }
    body->x = rlf_mad(before, wall->velocity, query->step);
    bounce(query, body, body_index, wall);
    return true;
}

/* Whether the map answers where the way begins, or where it enters what the sheet guesses. */
static bool is_map_asked(const grid_query *query, rlf_vec3 from, const field_hit *hit)
{
    return mapped_answers(query, from) || mapped_answers(query, hit->point);
}

/* The same by the map. */
static void guard_by_map(const grid_query *query, phys_body *body, int32_t body_index,
                         rlf_vec3 before)
{
    mapped_touch touch;
    if (mapped_cast(query, before, rlf_sub(body->x, before), 0.0, &touch) &&
        touch.separation >= 0.0) {
        guard_wall wall = {.normal = touch.normal, .point = touch.point};
        wall.other = RLF_CONTACT_BACKGROUND;
        hold_back(query, body, body_index, before, &wall);
    }
}

/* True when a sheet of one camera holds the body back. */
static bool guard_by_sheets(const grid_query *query, phys_body *body, int32_t body_index,
                            rlf_vec3 before)
{
    const rlf_grid *grid = query->grid;
    const rlf_pose *T_world_grid = &grid->T_world_grid;
    const rlf_grid_sheet *sheets[2] = {&grid->foreground, &grid->background};
    const rlf_contact_other others[2] = {RLF_CONTACT_FOREGROUND, RLF_CONTACT_BACKGROUND};
    const rlf_vec3 still = {0, 0, 0};
    rlf_vec3 from = rlf_transform(&query->T_grid_world, before);
    rlf_vec3 to = rlf_transform(&query->T_grid_world, body->x);
    rlf_vec3 flow = query->is_moving && grid->camera == 0 ? body->surface_flow : still;
    for (int32_t i = 0; i < 2; i++, flow = still) {
        field_hit hit;
        if (i == 0 && (body->grab != NULL || query->time < body->soft_until)) {
            continue; /* fingers may close on it as far as they like */
        }
        if (!enters(query, sheets[i], from, to, flow, &hit) ||
            (i == 1 && is_map_asked(query, from, &hit))) {
            continue;
        }
        guard_wall wall = {.other = others[i], .label = hit.label};
        wall.normal = rlf_rotate(T_world_grid->q, hit.normal);
        wall.velocity = rlf_rotate(T_world_grid->q, flow);
        wall.point = rlf_transform(T_world_grid, rlf_mad(hit.point, flow, query->tau));
        if (!grid_is_seen_free(query, wall.point, wall.velocity) &&
            hold_back(query, body, body_index, before, &wall)) {
            return true;
        }
    }
    return false;
}

void grid_guard_centre(const grid_query *query, phys_body *body, int32_t body_index,
                       rlf_vec3 before)
{
    for (const grid_query *one = query; one != NULL; one = one->next) {
        if (guard_by_sheets(one, body, body_index, before)) {
            return;
        }
    }
    if (query->map != NULL) {
        guard_by_map(query, body, body_index, before);
    }
}
