/* Bringing near what will be read soon: the bodies and contacts of a crowd do not fit in a
 * processor's second cache, and are read in the order of pairs and groups. */
#ifndef RLF_PHYSICS_FETCH_H
#define RLF_PHYSICS_FETCH_H

#include "kernel/kernel.h"
#include "physics/world_state.h"

#include <stddef.h>

#define PHYS_LINE 64 /* bytes that come from memory together */

RLF_KERNEL_PART void phys_fetch(const void *memory, size_t size)
{
    for (size_t at = 0; at < size; at += PHYS_LINE) {
        RLF_KERNEL_SOON((const char *)memory + at);
    }
}

/* From one field of a body to another. */
#define PHYS_FETCH_PART(body, first, end)                                                          \
    phys_fetch(&(body)->first, offsetof(phys_body, end) - offsetof(phys_body, first))

/* How a body moves in this substep. */
RLF_KERNEL_PART void phys_fetch_motion(const phys_body *body)
{
    PHYS_FETCH_PART(body, v, x);
}

/* Where it is, how it is turned and how fast it is: what a contact's gap is told from. */
RLF_KERNEL_PART void phys_fetch_place(const phys_body *body)
{
    RLF_KERNEL_SOON(&body->v);
    PHYS_FETCH_PART(body, x, force);
}

/* What pushes it. */
RLF_KERNEL_PART void phys_fetch_push(const phys_body *body)
{
    PHYS_FETCH_PART(body, force, inverse_inertia_world);
}

/* How heavy it is, and how large. */
RLF_KERNEL_PART void phys_fetch_weight(const phys_body *body)
{
    PHYS_FETCH_PART(body, inverse_inertia_world, shape.shape);
}

/* All of the above and what it touches with: what a search for its contacts reads. */
RLF_KERNEL_PART void phys_fetch_body(const phys_body *body)
{
    PHYS_FETCH_PART(body, v, release_time);
}

/* What every substep reads of contacts. */
RLF_KERNEL_PART void phys_fetch_near(const phys_contact *contacts, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        phys_fetch(&contacts[i], offsetof(phys_contact, surface_velocity));
    }
}

/* The contacts of a pair. */
RLF_KERNEL_PART void phys_fetch_contacts(const phys_pair *pair)
{
    phys_fetch(pair->contacts, (size_t)pair->contact_count * sizeof(phys_contact));
}

#endif
