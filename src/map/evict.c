/* When the memory is full, the blocks farthest from the camera leave. */
#include "map/evict.h"

#include <string.h>

/* This share of the blocks leaves at a time, so that it is not looked for at every frame. */
#define EVICT_SHARE 64
#define EVICT_BINS 256

static bool may_leave(const rlf_map *map, int32_t block)
{
    return (map->volume.flags[block] & MAP_LIVE) && map->volume.marked[block] != map->tick;
}

static int32_t bin_of(double distance2, double most)
{
    int32_t bin = (int32_t)(distance2 / most * EVICT_BINS);
    return bin < EVICT_BINS ? bin : EVICT_BINS - 1;
}

/* The nearest bin beyond `least` such that it and those farther hold at least `wanted` blocks. */
static int32_t nearest_bin(const rlf_map *map, rlf_vec3 eye, double most, int32_t least,
                           int32_t wanted)
{
    int32_t count[EVICT_BINS];
    memset(count, 0, sizeof(count));
    for (int32_t i = 0; i < map->volume.high; i++) {
        if (may_leave(map, i)) {
            count[bin_of(map_block_distance2(map, i, eye), most)]++;
        }
    }
    int32_t bin = EVICT_BINS, sum = 0;
    while (bin > least + 1 && sum < wanted) {
        sum += count[--bin];
    }
    return bin;
}

int32_t map_evict(rlf_map *map, rlf_vec3 eye, double distance2, double *reach2)
{
    map_volume *v = &map->volume;
    double most = 0.0;
    for (int32_t i = 0; i < v->high; i++) {
        if (may_leave(map, i)) {
            most = rlf_max(most, map_block_distance2(map, i, eye));
        }
    }
    map->is_full = true;
    const int32_t least = distance2 < most ? bin_of(distance2, most) : EVICT_BINS - 1;
    if (least == EVICT_BINS - 1) {
        *reach2 = most * least / EVICT_BINS;
        return 0;
    }
    const int32_t wanted = v->count / EVICT_SHARE + 1;
    const int32_t bin = nearest_bin(map, eye, most, least, wanted);
    int32_t evicted = 0;
    for (int32_t i = 0; i < v->high && evicted < wanted; i++) {
        if (may_leave(map, i) && bin_of(map_block_distance2(map, i, eye), most) >= bin) {
            map_journal_keep(map, i, false);
            map_volume_remove(v, i);
            evicted++;
        }
    }
    return evicted;
}
