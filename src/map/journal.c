/* What the blocks were at the last fence: each is copied when it is first touched after it. */
#include "map/volume.h"

#include <string.h>

void map_journal_take(map_journal *j, rlf_arena *arena, int32_t slots, int32_t blocks)
{
    j->slot_capacity = slots;
    j->memo_capacity = slots + blocks;
    j->memo = arena_take(arena, (size_t)j->memo_capacity, sizeof(map_memo));
    map_slabs_take(&j->slabs, arena, slots);
}

static void begin_epoch(rlf_map *map)
{
    map->journal.epoch++;
    map->journal.memo_count = 0;
    map->journal.slot_count = 0;
    map->journal.frames = map->frames;
    map->journal.viewpoint_count = map->viewpoint_count;
}

void rlf_map_fence(rlf_map *map)
{
    if (!RLF_ASSERT(map != NULL)) {
        return;
    }
    begin_epoch(map);
    map->journal.has_moved = false;
}

void map_journal_expect(rlf_map *map, int32_t count)
{
    map_journal *j = &map->journal;
    if (j->slot_count + count > j->slot_capacity && j->memo_count > 0) {
        begin_epoch(map);
        j->has_moved = true;
    }
}

void map_journal_keep(rlf_map *map, int32_t block, bool is_new)
{
    map_journal *j = &map->journal;
    if (map->volume.kept[block] == j->epoch) {
        return;
    }
    const bool is_full = j->memo_count == j->memo_capacity || j->slot_count == j->slot_capacity;
    if (is_full || !map_slabs_reserve(&j->slabs, j->slot_count + 1)) {
        begin_epoch(map);
        j->has_moved = true;
    }
    map->volume.kept[block] = j->epoch;
    if (!is_new && !map_slabs_reserve(&j->slabs, j->slot_count + 1)) {
        return; /* no memory for a single slab: this block cannot be taken back */
    }
    map_memo *memo = &j->memo[j->memo_count++];
    memcpy(memo->place, map->volume.place[block], sizeof(memo->place));
    memo->slot = is_new ? -1 : j->slot_count++;
    if (!is_new) {
        *map_slabs_at(&j->slabs, memo->slot) = *map_block_at(&map->volume, block);
    }
}

/* New blocks go first, so that there is room for those that come back. A block that left and came
 * again is there twice: first as what it was, then as new. */
static void restore(rlf_map *map)
{
    map_journal *j = &map->journal;
    map_volume *v = &map->volume;
    for (int32_t i = 0; i < j->memo_count; i++) {
        const int16_t *p = j->memo[i].place;
        int32_t block = j->memo[i].slot < 0 ? map_volume_find(v, p[0], p[1], p[2]) : -1;
        if (block >= 0) {
            map_volume_remove(v, block);
        }
    }
    for (int32_t i = 0; i < j->memo_count; i++) {
        const map_memo *memo = &j->memo[i];
        const int16_t *p = memo->place;
        int32_t block = memo->slot >= 0 ? map_volume_find(v, p[0], p[1], p[2]) : -1;
        block = memo->slot >= 0 && block < 0 ? map_volume_add(v, p[0], p[1], p[2]) : block;
        if (block >= 0) {
            *map_block_at(v, block) = *map_slabs_at(&j->slabs, memo->slot);
            map_block_look(v, block);
        }
    }
}

bool rlf_map_take_back(rlf_map *map)
{
    if (!RLF_ASSERT(map != NULL)) {
        return false;
    }
    map_journal *j = &map->journal;
    const bool was_whole = !j->has_moved;
    if (!was_whole) {
        rlf_log(RLF_LOG_WARNING,
                "map: the camera was placed wrong for longer than can be taken back: only the last "
                "%d frames leave the map; if walls are doubled there, move the camera more slowly",
                (int)(map->frames - j->frames));
    }
    restore(map);
    map->frames = j->frames;
    map->viewpoint_count = j->viewpoint_count;
    begin_epoch(map);
    j->has_moved = false;
    return was_whole;
}
