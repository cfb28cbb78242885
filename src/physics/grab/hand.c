/* How hands were bent and where they went, in the last second: what a grasp is told by. */
#include "physics/grab/grab.h"

#define CURLED_M 0.006  /* or fingers' tips their roots */
#define CLOSED_FRAMES 3 /* frames that were so much wider */
#define OPENING_M 0.006 /* since the tightest of the last frames: it opens */
#define LAST_FRAMES 4
#define VELOCITY_S 0.15 /* over which a palm's is told: one fit trembles */

rlf_vec3 grab_tip(const rlf_grid_hand *h, int32_t digit)
{
    return h->cones[6 + 3 * digit + 2].b;
}

rlf_vec3 grab_core(const rlf_grid_hand *h)
{
    return rlf_scale(rlf_add(h->cones[1].a, h->cones[1].b), 0.5);
}

struct phys_grab_hand *grab_hand_of(const rlf_world *world, int32_t id)
{
    for (int32_t k = 0; k < RLF_GRID_HANDS_MAX && id > 0; k++) {
        if (world->grab_hands[k].id == id) {
            return &world->grab_hands[k];
        }
    }
    return NULL;
}

static struct phys_grab_hand *take_slot(rlf_world *world, int32_t id)
{
    struct phys_grab_hand *slot = grab_hand_of(world, id), *oldest = &world->grab_hands[0];
    for (int32_t k = 0; k < RLF_GRID_HANDS_MAX && slot == NULL; k++) {
        struct phys_grab_hand *h = &world->grab_hands[k];
        oldest = h->id == 0 || h->seen < oldest->seen ? h : oldest;
    }
    if (slot == NULL) {
        slot = oldest;
        *slot = (struct phys_grab_hand){.id = id, .sure = -1e9};
    }
    return slot;
}

static grab_moment moment_of(const rlf_grid_hand *h, double time)
{
    grab_moment m = {.time = time};
    for (int32_t digit = 1; digit < 5; digit++) {
        const rlf_round_cone *root = &h->cones[6 + 3 * digit];
        m.curl += 0.25 * rlf_length(rlf_sub(grab_tip(h, digit), root->a));
        if (digit < 3) {
            m.aperture += 0.5 * rlf_length(rlf_sub(grab_tip(h, digit), grab_tip(h, 0)));
        }
    }
    m.aperture -= h->cones[8].radius_b + h->cones[11].radius_b;
    return m;
}

static void note_velocity(struct phys_grab_hand *h)
{
    const grab_moment *now = &h->past[0], *then = now;
    for (int32_t k = 1; k < h->past_count && now->time - h->past[k].time < VELOCITY_S; k++) {
        then = &h->past[k];
    }
    const double dt = now->time - then->time;
    h->velocity = rlf_scale(rlf_sub(now->palm, then->palm), dt > 0.0 ? 1.0 / dt : 0.0);
}

void grab_note_hands(rlf_world *world, const grid_query *query)
{
    const rlf_grid *grid = query->grid;
    const double now = world->time;
    for (int32_t k = 0; k < grid->hand_count; k++) {
        const rlf_grid_hand *h = &grid->hands[k];
        struct phys_grab_hand *hand = take_slot(world, h->id);
        hand->seen = now;
        hand->palm = rlf_transform(&grid->T_world_grid, h->palm);
        hand->core = rlf_transform(&grid->T_world_grid, grab_core(h));
        hand->facing = rlf_rotate(grid->T_world_grid.q, h->facing);
        hand->sure = h->is_sure ? now : hand->sure;
        for (int32_t i = GRAB_MOMENTS - 1; i > 0; i--) {
            hand->past[i] = hand->past[i - 1];
        }
        hand->past[0] = moment_of(h, now);
        hand->past[0].palm = hand->palm;
        hand->past[0].is_sure = h->is_sure;
        hand->past_count += hand->past_count < GRAB_MOMENTS;
        note_velocity(hand);
    }
}

/* Whether it has come from wider to here and does not open. */
bool grab_hand_closes(const struct phys_grab_hand *h)
{
    int32_t wider = 0;
    bool opens = false;
    const grab_moment *now = &h->past[0];
    for (int32_t k = 1; k < h->past_count; k++) {
        const grab_moment *m = &h->past[k];
        if (!m->is_sure) {
            continue;
        }
        if (now->time - m->time > GRAB_WINDOW_S) {
            break;
        }
        wider += m->aperture > now->aperture + GRAB_CLOSED_M || m->curl > now->curl + CURLED_M;
        opens = opens || (k < LAST_FRAMES && (m->aperture < now->aperture - OPENING_M ||
                                              m->curl < now->curl - OPENING_M));
    }
    return wider >= CLOSED_FRAMES && !opens;
}
