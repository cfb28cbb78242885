/* What leaves the stage: the snapshot, the contact list, the hash and the energy. */
#include "physics/world_state.h"

#include <string.h>

static void write_state(const rlf_world *world, int32_t index, rlf_body_state *state)
{
    const phys_body *body = &world->bodies[index];
    state->id = phys_body_id(world, index);
    memcpy(state->name, body->name, sizeof(state->name));
    state->shape = body->shape.shape;
    state->look = body->look;
    state->T_world_body = phys_body_pose(body);
    state->velocity = body->v;
    state->angular_velocity = body->w;
    state->mass = body->mass;
    memcpy(state->color, body->color, sizeof(state->color));
    state->is_held = body->is_held;
    state->is_asleep = body->is_asleep;
    state->is_grabbed = body->grab != NULL;
}

void phys_world_publish_last(rlf_world *world)
{
    write_state(world, world->body_top - 1, &world->states[world->snapshot.body_count++]);
}

/* Writes the states of the virtual bodies, or of the models, from index `count` on; returns the
 * index after the last. */
static int32_t publish_kind(rlf_world *world, bool is_real, int32_t count)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        if (world->bodies[i].is_alive && world->bodies[i].is_real == is_real) {
            write_state(world, i, &world->states[count++]);
        }
    }
    return count;
}

void phys_world_publish(rlf_world *world)
{
    int32_t count = publish_kind(world, false, 0);
    int32_t total = publish_kind(world, true, count);
    world->snapshot.time_ns = (int64_t)(world->time * 1e9 + 0.5);
    world->snapshot.frame = world->frame;
    world->snapshot.gravity = world->def.gravity;
    world->snapshot.bodies = world->states;
    world->snapshot.body_count = count;
    world->snapshot.known = world->states + count;
    world->snapshot.known_count = total - count;
    world->snapshot.contacts = world->log;
    world->snapshot.contact_count = world->log_count;
    world->snapshot.events = world->events;
    world->snapshot.event_count = world->event_count;
}

const rlf_snapshot *rlf_world_get_snapshot(const rlf_world *world)
{
    return RLF_ASSERT(world != NULL) ? &world->snapshot : NULL;
}

void phys_log_impulse(rlf_world *world, phys_contact *contact)
{
    bool is_new = contact->log < world->log_begin;
    if (is_new) {
        if (world->log_count == world->def.contact_capacity) {
            return;
        }
        contact->log = world->log_begin + world->log_count++;
    }
    rlf_contact *entry = &world->log[contact->log - world->log_begin];
    if (is_new) {
        memset(entry, 0, sizeof(*entry));
    }
    entry->body = phys_body_id(world, contact->a);
    entry->other = contact->other;
    if (contact->b >= 0) {
        entry->other_body = phys_body_id(world, contact->b);
    }
    entry->region_label = contact->label;
    entry->separation = contact->separation;
    entry->impulse += contact->impulse_sum;
    if (is_new || contact->approach >= entry->approach_speed) {
        entry->point = phys_widen(contact->met);
        entry->normal = rlf_normalize(phys_widen(contact->met_normal));
        entry->surface_speed = rlf_dot(contact->surface_velocity, entry->normal);
        entry->approach_speed = contact->approach;
    }
}

void phys_log_contacts(rlf_world *world, phys_contact *contacts, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        phys_contact *contact = &contacts[i];
        if (contact->impulse_sum > 0.0) {
            if (!(contact->approach > 0.0)) { /* it rests: where it is now */
                const phys_body *body = &world->bodies[contact->a];
                contact->met = phys_narrow(rlf_add(body->x, phys_contact_arm(contact, body)));
                contact->met_normal = phys_narrow(contact->normal);
            }
            phys_log_impulse(world, contact);
            contact->impulse_sum = contact->approach = 0.0;
        }
    }
}

/* FNV-1a (Fowler, Noll, Vo 1991) over the bytes of a double, low byte first on any machine. */
static uint64_t hash_double(uint64_t hash, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof(bits));
    for (int32_t i = 0; i < 64; i += 8) {
        hash = (hash ^ ((bits >> i) & 0xffu)) * 0x100000001b3u;
    }
    return hash;
}

uint64_t rlf_world_hash(const rlf_world *world)
{
    if (!RLF_ASSERT(world != NULL)) {
        return 0;
    }
    uint64_t hash = 0xcbf29ce484222325u;
    for (int32_t i = 0; i < world->body_top; i++) {
        const phys_body *b = &world->bodies[i];
        if (!b->is_alive) {
            continue;
        }
        const double values[13] = {b->x.x, b->x.y, b->x.z, b->q.x, b->q.y, b->q.z, b->q.w,
                                   b->v.x, b->v.y, b->v.z, b->w.x, b->w.y, b->w.z};
        for (int32_t k = 0; k < 13; k++) {
            hash = hash_double(hash, values[k]);
        }
    }
    return hash;
}

double rlf_world_energy(const rlf_world *world)
{
    double energy = 0.0;
    if (!RLF_ASSERT(world != NULL)) {
        return energy;
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        const phys_body *b = &world->bodies[i];
        if (!b->is_alive || phys_body_is_fixed(b)) {
            continue;
        }
        rlf_mat3 Rt = rlf_mat3_transpose(&b->R);
        rlf_vec3 w = rlf_mat3_mul_vec(&Rt, b->w);
        energy += 0.5 * b->mass * rlf_dot(b->v, b->v) +
                  0.5 * rlf_dot(w, rlf_mat3_mul_vec(&b->inertia, w)) -
                  b->mass * b->gravity_scale * rlf_dot(world->def.gravity, b->x);
    }
    return energy;
}
