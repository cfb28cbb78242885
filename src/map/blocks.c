/* Blocks in memory, and the hash table of their places (linear probing, Knuth 6.4, with deletion by
 * moving back, so that the table has no graves). */
#include "map/volume.h"

#include <stdlib.h>
#include <string.h>

void map_slabs_take(map_slabs *slabs, rlf_arena *arena, int32_t blocks)
{
    slabs->slab_capacity = (blocks + MAP_SLAB - 1) / MAP_SLAB;
    slabs->slab = arena_take(arena, (size_t)slabs->slab_capacity, sizeof(map_block *));
}

bool map_slabs_reserve(map_slabs *slabs, int32_t count)
{
    while (slabs->slab_count * MAP_SLAB < count && slabs->slab_count < slabs->slab_capacity) {
        map_block *slab = rlf_alloc_array(MAP_SLAB, sizeof(map_block));
        if (slab == NULL) {
            return false;
        }
        slabs->slab[slabs->slab_count++] = slab;
    }
    return slabs->slab_count * MAP_SLAB >= count;
}

void map_slabs_free(map_slabs *slabs)
{
    for (int32_t i = 0; i < slabs->slab_count; i++) {
        rlf_free(slabs->slab[i]);
    }
}

static uint32_t home(const map_volume *v, uint64_t key)
{
    return (uint32_t)((key * 0x9e3779b97f4a7c15u) >> 32) & v->table_mask;
}

void map_volume_take(map_volume *v, rlf_arena *arena, int32_t capacity)
{
    size_t n = (size_t)capacity;
    uint32_t size = 64;
    while (size < 2 * (uint32_t)capacity) {
        size *= 2;
    }
    v->capacity = capacity;
    v->table_mask = size - 1;
    map_slabs_take(&v->slabs, arena, capacity);
    v->place = arena_take(arena, n, sizeof(v->place[0]));
    v->after = arena_take(arena, n, sizeof(v->after[0]));
    v->marked = arena_take(arena, n, sizeof(uint32_t));
    v->kept = arena_take(arena, n, sizeof(uint32_t));
    v->flags = arena_take(arena, n, 1);
    v->front = arena_take(arena, n, sizeof(v->front[0]));
    v->free_list = arena_take(arena, n, sizeof(int32_t));
    v->table = arena_take(arena, size, sizeof(map_entry));
}

void map_volume_clear(map_volume *v)
{
    for (uint32_t i = 0; i <= v->table_mask; i++) {
        v->table[i].block = -1;
    }
    memset(v->flags, 0, (size_t)v->high);
    v->count = 0;
    v->high = 0;
    v->free_count = 0;
}

/* Where a key is, or the empty place where it would be. */
static uint32_t slot_of(const map_volume *v, uint64_t key)
{
    uint32_t i = home(v, key);
    while (v->table[i].block >= 0 && v->table[i].key != key) {
        i = (i + 1) & v->table_mask;
    }
    return i;
}

int32_t map_volume_find(const map_volume *v, int32_t x, int32_t y, int32_t z)
{
    const int32_t most = INT16_MAX;
    if (x < -most || x > most || y < -most || y > most || z < -most || z > most) {
        return -1; /* keys have 16 bits for each */
    }
    return v->table[slot_of(v, map_key(x, y, z))].block;
}

void map_volume_soon(const map_volume *v, int32_t x, int32_t y, int32_t z)
{
    RLF_KERNEL_SOON(&v->table[home(v, map_key(x, y, z))]);
}

/* Tells a block's neighbours of it (`self` is its index) or that it is gone (-1). */
static void link_neighbours(map_volume *v, int32_t block, int32_t self)
{
    const int16_t *p = v->place[block];
    for (int32_t k = 0; k < 8; k++) {
        const int32_t dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
        v->after[block][k] = k == 0 ? self : map_volume_find(v, p[0] + dx, p[1] + dy, p[2] + dz);
        int32_t before = map_volume_find(v, p[0] - dx, p[1] - dy, p[2] - dz);
        if (k > 0 && before >= 0) {
            v->after[before][k] = self;
        }
    }
}

int32_t map_volume_add(map_volume *v, int32_t x, int32_t y, int32_t z)
{
    const int32_t most = INT16_MAX - 1;
    if (x < -most || x > most || y < -most || y > most || z < -most || z > most) {
        return -1;
    }
    int32_t block = v->high;
    if (v->free_count > 0) {
        block = v->free_list[--v->free_count];
    } else if (v->high < v->capacity && map_slabs_reserve(&v->slabs, v->high + 1)) {
        v->high++;
    } else {
        return -1;
    }
    v->count++;
    v->place[block][0] = (int16_t)x;
    v->place[block][1] = (int16_t)y;
    v->place[block][2] = (int16_t)z;
    v->flags[block] = MAP_LIVE;
    v->marked[block] = 0;
    v->kept[block] = 0;
    map_block *b = map_block_at(v, block);
    memset(b, 0, sizeof(*b));
    for (int32_t i = 0; i < MAP_VOXELS; i++) {
        b->distance[i] = RLF_FUSE_UNKNOWN;
    }
    memset(b->chroma, 128, sizeof(b->chroma));
    const uint64_t key = map_key(x, y, z);
    v->table[slot_of(v, key)] = (map_entry){.key = key, .block = block};
    link_neighbours(v, block, block);
    return block;
}

void map_volume_remove(map_volume *v, int32_t block)
{
    const int16_t *p = v->place[block];
    link_neighbours(v, block, -1);
    uint32_t hole = slot_of(v, map_key(p[0], p[1], p[2]));
    for (uint32_t i = (hole + 1) & v->table_mask; v->table[i].block >= 0;
         i = (i + 1) & v->table_mask) {
        /* What may also stand in the hole moves there: its home is not between hole and itself. */
        uint32_t from_home = (i - home(v, v->table[i].key)) & v->table_mask;
        if (from_home >= ((i - hole) & v->table_mask)) {
            v->table[hole] = v->table[i];
            hole = i;
        }
    }
    v->table[hole].block = -1;
    v->flags[block] = 0;
    v->free_list[v->free_count++] = block;
    v->count--;
}

void map_block_look(map_volume *v, int32_t block)
{
    /* A surface passes a cell only when a corner of it is within its diagonal. */
    const int32_t diagonal = (int32_t)(1.74f * RLF_FUSE_STEPS);
    rlf_fuse_summary s = rlf_kernel_fuse_summary(map_block_at(v, block));
    memcpy(v->front[block], s.front, sizeof(s.front));
    /* More than the margin in front of a surface, or blocks would come and go. */
    const int32_t free = (int32_t)(0.65f * (float)MAP_TRUNCATION_LEAST * RLF_FUSE_STEPS);
    v->flags[block] = (uint8_t)((v->flags[block] & MAP_IS_NEW) | MAP_LIVE |
                                (s.nearest <= diagonal ? MAP_HAS_SURFACE : 0) |
                                (s.lowest >= free ? MAP_IS_EMPTY : 0));
}

static int by_key(const void *a, const void *b)
{
    const map_entry *p = a, *q = b;
    return (p->key > q->key) - (p->key < q->key);
}

bool map_volume_sorted(const map_volume *v, int32_t *out)
{
    map_entry *entries = rlf_alloc_array((size_t)v->count + 1, sizeof(map_entry));
    if (entries == NULL) {
        return false;
    }
    int32_t count = 0;
    for (int32_t i = 0; i < v->high; i++) {
        const int16_t *p = v->place[i];
        if (v->flags[i] & MAP_LIVE) {
            entries[count++] = (map_entry){.key = map_key(p[0], p[1], p[2]), .block = i};
        }
    }
    qsort(entries, (size_t)count, sizeof(entries[0]), by_key);
    for (int32_t i = 0; i < count; i++) {
        out[i] = entries[i].block;
    }
    rlf_free(entries);
    return true;
}
