/* Contact events: the touches of this advance against those of the last one. */
#include "physics/world_state.h"

#include <string.h>

static int32_t index_of(rlf_body_id id)
{
    return (int32_t)id.index1 - 1;
}

static phys_touch touch_of(const rlf_contact *contact)
{
    phys_touch touch = {0, contact->body, contact->other_body};
    uint64_t other = contact->other == RLF_CONTACT_BACKGROUND ? 1 : 2;
    if (contact->other == RLF_CONTACT_BODY) {
        if (index_of(contact->other_body) < index_of(contact->body)) {
            touch.body = contact->other_body;
            touch.other_body = contact->body;
        }
        other = 2 + (uint64_t)touch.other_body.index1;
    }
    touch.key = (uint64_t)touch.body.index1 << 32 | other;
    return touch;
}

static bool is_same(const phys_touch *a, const phys_touch *b)
{
    return a->key == b->key && a->body.generation == b->body.generation &&
           a->other_body.generation == b->other_body.generation;
}

/* A sleeper logs no contacts, yet lies where it lay. */
static bool goes_on_asleep(const rlf_world *world, const phys_touch *touch)
{
    if (!rlf_world_has_body(world, touch->body)) {
        return false;
    }
    const phys_body *a = &world->bodies[index_of(touch->body)];
    if (touch->other_body.index1 == 0) {
        return a->is_asleep;
    }
    if (!rlf_world_has_body(world, touch->other_body)) {
        return false;
    }
    const phys_body *b = &world->bodies[index_of(touch->other_body)];
    return phys_body_is_idle(a) && phys_body_is_idle(b);
}

static int32_t touch_capacity(const rlf_world *world)
{
    return world->def.contact_capacity + world->def.body_capacity;
}

static void add_touch(rlf_world *world, phys_touch touch)
{
    if (world->touch_count < touch_capacity(world)) {
        world->unsorted_touches[world->touch_count++] = touch;
    }
}

/* Puts those of each body into its own range: touch_begin[i + 1] is then the end of body i's. */
static void sort_by_body(rlf_world *world)
{
    int32_t *begin = world->touch_begin;
    const phys_touch *from = world->unsorted_touches;
    memset(begin, 0, ((size_t)world->body_top + 2) * sizeof(*begin));
    for (int32_t i = 0; i < world->touch_count; i++) {
        begin[from[i].body.index1 + 1]++;
    }
    for (int32_t i = 1; i <= world->body_top + 1; i++) {
        begin[i] += begin[i - 1];
    }
    for (int32_t i = 0; i < world->touch_count; i++) {
        world->touches[begin[from[i].body.index1]++] = from[i];
    }
}

/* By key: by counting for the body, by insertion for the few others of each; a key that is there
 * more than once is kept once. */
static void sort_touches(rlf_world *world)
{
    phys_touch *touches = world->touches;
    int32_t kept = 0;
    sort_by_body(world);
    for (int32_t i = 0; i < world->touch_count; i++) {
        phys_touch touch = touches[i];
        int32_t at = kept;
        while (at > 0 && touches[at - 1].key > touch.key) {
            at--;
        }
        if (at > 0 && touches[at - 1].key == touch.key) {
            continue;
        }
        memmove(&touches[at + 1], &touches[at], (size_t)(kept - at) * sizeof(touch));
        touches[at] = touch;
        kept++;
    }
    world->touch_count = kept;
}

static void add_event(rlf_world *world, const phys_touch *touch, bool is_begin)
{
    uint32_t other = (uint32_t)touch->key;
    rlf_contact_event *event = &world->events[world->event_count++];
    event->is_begin = is_begin;
    event->body = touch->body;
    event->other_body = touch->other_body;
    event->other = other == 1   ? RLF_CONTACT_BACKGROUND
                   : other == 2 ? RLF_CONTACT_FOREGROUND
                                : RLF_CONTACT_BODY;
}

void phys_find_events(rlf_world *world)
{
    phys_touch *swap = world->old_touches;
    world->old_touches = world->touches;
    world->touches = swap;
    world->old_touch_count = world->touch_count;
    world->touch_count = world->event_count = 0;
    for (int32_t i = 0; i < world->log_count; i++) {
        const rlf_contact *contact = &world->log[i];
        if (contact->impulse > 0.0 && rlf_world_has_body(world, contact->body)) {
            add_touch(world, touch_of(contact));
        }
    }
    for (int32_t i = 0; i < world->old_touch_count; i++) {
        if (goes_on_asleep(world, &world->old_touches[i])) {
            add_touch(world, world->old_touches[i]);
        }
    }
    sort_touches(world);
    int32_t now = 0, before = 0;
    while (now < world->touch_count || before < world->old_touch_count) {
        const phys_touch *a = &world->touches[now], *b = &world->old_touches[before];
        if (now < world->touch_count && before < world->old_touch_count && is_same(a, b)) {
            now++;
            before++;
        } else if (before == world->old_touch_count ||
                   (now < world->touch_count && a->key < b->key)) {
            add_event(world, a, true);
            now++;
        } else {
            add_event(world, b, false);
            before++;
        }
    }
}
