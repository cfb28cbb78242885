/* A world's memory: all of it is there from the start. */
#include "physics/grab/grab.h"

#include <string.h>

/* One array: where its pointer is kept, how many elements of which size. */
typedef struct memory_plan {
    void *place;
    size_t count, size;
} memory_plan;

/* Bodies that are held at once. */
#define GRABS_MAX 16

#define PLANS_MAX 96
#define PLAN(field, number)                                                                        \
    {                                                                                              \
        &w->field, (number), sizeof(*w->field)                                                     \
    }

static int32_t plan_memory(rlf_world *w, memory_plan plans[PLANS_MAX])
{
    size_t bodies = (size_t)w->def.body_capacity, pairs = (size_t)w->pair_capacity;
    size_t contacts = (size_t)w->def.contact_capacity;
    const memory_plan all[] = {
        PLAN(bodies, bodies),
        PLAN(points, bodies * PHYS_POINTS_MAX),
        PLAN(surface, bodies * PHYS_SURFACE_CONTACTS),
        PLAN(pairs, pairs),
        PLAN(old_pairs, pairs),
        PLAN(pair_contacts, pairs * PHYS_PAIR_CONTACTS),
        PLAN(old_pair_contacts, pairs * PHYS_PAIR_CONTACTS),
        PLAN(due_pairs, pairs),
        PLAN(due_bodies, bodies),
        PLAN(proxies, bodies),
        PLAN(bins, (size_t)w->bin_count + 1),
        PLAN(box_ends, 6 * (size_t)phys_box_stride(w)),
        PLAN(box_bodies, bodies),
        PLAN(box_found, bodies + 1),
        PLAN(near, pairs),
        PLAN(near_sorted, pairs),
        PLAN(near_begin, bodies + 1),
        PLAN(parent, bodies),
        PLAN(island_of, bodies),
        PLAN(islands, bodies),
        PLAN(island_bodies, bodies),
        PLAN(island_pairs, pairs),
        PLAN(groups, bodies + pairs),
        PLAN(near_points, bodies * PHYS_SURFACE_CONTACTS + pairs * PHYS_PAIR_CONTACTS),
        PLAN(batches, bodies + pairs),
        PLAN(batch_points, bodies * PHYS_SURFACE_CONTACTS + pairs * PHYS_PAIR_CONTACTS),
        PLAN(batch_contacts, bodies * PHYS_SURFACE_CONTACTS + pairs * PHYS_PAIR_CONTACTS),
        PLAN(batch_keys, bodies + pairs),
        PLAN(batch_order, bodies + pairs),
        PLAN(colours, bodies),
        PLAN(speeds, bodies),
        PLAN(old_speeds, bodies),
        PLAN(lightness, bodies),
        PLAN(busy_pass, bodies),
        PLAN(event_times, bodies + pairs),
        PLAN(event_counts, bodies + pairs),
        PLAN(pending, bodies + pairs),
        PLAN(first_link, bodies),
        PLAN(next_link, 2 * (bodies + pairs)),
        PLAN(grabs, (size_t)w->grab_count),
        PLAN(grab_hands, RLF_GRID_HANDS_MAX),
        PLAN(log, contacts),
        PLAN(states, bodies),
        PLAN(touches, contacts + bodies),
        PLAN(old_touches, contacts + bodies),
        PLAN(unsorted_touches, contacts + bodies),
        PLAN(touch_begin, bodies + 2),
        PLAN(events, 2 * (contacts + bodies)),
    };
    _Static_assert(sizeof(all) / sizeof(all[0]) + 4 * RLF_WORLD_CAMERAS_MAX <= PLANS_MAX,
                   "more plans than PLANS_MAX");
    memcpy(plans, all, sizeof(all));
    int32_t count = (int32_t)(sizeof(all) / sizeof(all[0]));
    for (int32_t k = 0; k < w->def.camera_capacity; k++) {
        const memory_plan tiles[4] = {
            PLAN(views[k].foreground.tiles, TILES_MAX), PLAN(views[k].background.tiles, TILES_MAX),
            PLAN(views[k].foreground.marks, TILES_MAX), PLAN(views[k].background.marks, TILES_MAX)};
        memcpy(plans + count, tiles, sizeof(tiles));
        count += 4;
    }
    return count;
}

/* Crowds have about three touching pairs per body; six leave room for those that are near. */
static void choose_sizes(rlf_world *world)
{
    int32_t listed = (world->def.contact_capacity - 1) / PHYS_PAIR_CONTACTS + 1;
    int32_t crowd = 6 * world->def.body_capacity;
    world->pair_capacity = listed > crowd ? listed : crowd;
    world->bin_count = world->def.body_capacity;
    world->grab_count = world->def.body_capacity < GRABS_MAX ? world->def.body_capacity : GRABS_MAX;
}

bool phys_world_allocate(rlf_world *world)
{
    memory_plan plans[PLANS_MAX];
    choose_sizes(world);
    int32_t count = plan_memory(world, plans);
    for (int32_t i = 0; i < count; i++) {
        void *memory = rlf_alloc_array(plans[i].count, plans[i].size);
        memcpy(plans[i].place, &memory, sizeof(memory));
        if (memory == NULL) {
            return false;
        }
    }
    world->free_count = world->pair_capacity;
    return true;
}

void phys_world_free(rlf_world *world)
{
    memory_plan plans[PLANS_MAX];
    int32_t count = plan_memory(world, plans);
    for (int32_t i = 0; i < count; i++) {
        void *memory;
        memcpy(&memory, plans[i].place, sizeof(memory));
        rlf_free(memory);
    }
}
