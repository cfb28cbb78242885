/* Pixels look for the blocks near their surface. Where several of them see one block, only some
 * look, others in the next frames; where blocks are finer than a pixel, it looks at several places.
 */
#include "map/volume.h"

#include <string.h>

/* Blocks are made for what is this near to a surface, voxels: in front of it enough for the cells
 * of the surface, behind it the whole of the least truncation, so that bodies find their way out.
 */
static const float margins[] = {-2.0f, 1.0f, 4.0f};
enum { MARGINS = sizeof(margins) / sizeof(margins[0]) };

enum {
    SPACING = 6, /* most pixels between those that look; in 36 frames all do */
    FINEST = 8,  /* most places along each side of a pixel */
    BATCH = 64   /* places that memory has to answer in */
};

/* When the memory is full so large a share of the blocks leaves at a time, so that it is not looked
 * for at every frame: the farthest, by their distance in blocks. */
enum { EVICT_SHARE = 64, EVICT_BINS = 1024 };

typedef struct marker {
    rlf_map *map;
    rlf_vec3 eye;
    rlf_mat3 R_world_camera;
    double to_blocks; /* per metre */
    float size;       /* a block's side times the focal length, metre pixels */
    int32_t reach;    /* blocks: so far away and farther a full memory has no room */
    rlf_map_change *change;
    int32_t at[BATCH * MARGINS][3];
    int32_t count;
} marker;

static int32_t bin_of(const rlf_map *map, rlf_vec3 way)
{
    const double blocks = rlf_length(way) / (map->def.voxel_m * MAP_SIDE);
    return blocks < EVICT_BINS - 1 ? (int32_t)blocks : EVICT_BINS - 1;
}

/* The bin of a block that may leave, or -1. */
static int32_t bin_of_block(const marker *m, int32_t block)
{
    const map_volume *v = &m->map->volume;
    const bool may_leave = (v->flags[block] & MAP_LIVE) && v->marked[block] != m->map->tick;
    return may_leave ? bin_of(m->map, map_block_way(m->map, v->place[block], m->eye)) : -1;
}

/* Makes room for a block that is this many blocks away: some of those that are farther and that
 * this frame did not see are removed; returns how many. When there are none nothing farther has
 * room. */
static int32_t evict(marker *m, int32_t least)
{
    map_volume *v = &m->map->volume;
    int32_t count[EVICT_BINS] = {0}, bin = EVICT_BINS, sum = 0, evicted = 0;
    const int32_t wanted = v->count / EVICT_SHARE + 1;
    for (int32_t i = 0; i < v->high; i++) {
        const int32_t of = bin_of_block(m, i);
        count[of > 0 ? of : 0] += of >= 0;
    }
    while (bin > least + 1 && sum < wanted) {
        sum += count[--bin];
    }
    m->map->is_full = true;
    m->reach = sum > 0 ? m->reach : least;
    for (int32_t i = 0; i < v->high && sum > 0 && evicted < wanted; i++) {
        if (bin_of_block(m, i) >= bin) {
            map_journal_keep(m->map, i, false);
            map_volume_remove(v, i);
            evicted++;
        }
    }
    return evicted;
}

/* The block at a place, made when there is none; -1: there is no room for it. */
static int32_t take(marker *m, const int32_t at[3])
{
    rlf_map *map = m->map;
    map_volume *v = &map->volume;
    int32_t block = map_volume_find(v, at[0], at[1], at[2]);
    if (block >= 0) {
        return block;
    }
    const int16_t place[4] = {(int16_t)at[0], (int16_t)at[1], (int16_t)at[2]};
    const int32_t bin = bin_of(map, map_block_way(map, place, m->eye));
    if (v->count == v->capacity && bin >= m->reach) {
        return -1;
    }
    block = map_volume_add(v, at[0], at[1], at[2]);
    if (block < 0) {
        m->change->blocks_evicted += evict(m, bin);
        block = map_volume_add(v, at[0], at[1], at[2]);
    }
    if (block >= 0) {
        map_journal_keep(map, block, true);
        m->change->blocks_new++;
        v->flags[block] |= MAP_IS_NEW;
    }
    return block;
}

static void mark_batch(marker *m)
{
    rlf_map *map = m->map;
    for (int32_t i = 0; i < m->count; i++) {
        const int32_t block = take(m, m->at[i]);
        if (block >= 0 && map->volume.marked[block] != map->tick) {
            map->volume.marked[block] = map->tick;
            map->seen[map->seen_count++] = block;
        }
    }
    m->count = 0;
}

/* The blocks about the point of a ray at a depth. */
static void look(marker *m, rlf_vec3 ray, double depth)
{
    const rlf_mat3 *R = &m->R_world_camera;
    const double step = m->map->def.voxel_m / rlf_length(ray);
    if (m->count + MARGINS > BATCH * MARGINS) {
        mark_batch(m);
    }
    for (int32_t k = 0; k < MARGINS; k++) {
        const rlf_vec3 p = rlf_scale(ray, depth + (double)margins[k] * step);
        const rlf_vec3 world = rlf_add(rlf_mat3_mul_vec(R, p), m->eye);
        const double place[3] = {world.x * m->to_blocks, world.y * m->to_blocks,
                                 world.z * m->to_blocks};
        int32_t at[3];
        bool is_in = true;
        for (int32_t r = 0; r < 3; r++) {
            is_in = is_in && place[r] > -32000.0 && place[r] < 32000.0;
            at[r] = is_in ? map_floor(place[r]) : 0;
        }
        const int32_t before = m->count - MARGINS; /* the same of the place before */
        if (is_in && (before < 0 || memcmp(at, m->at[before], sizeof(at)) != 0)) {
            map_volume_soon(&m->map->volume, at[0], at[1], at[2]);
            memcpy(m->at[m->count++], at, sizeof(at));
        }
    }
}

/* A pixel's square on its plane, n x n places. */
static void look_about(marker *m, int32_t pixel, int32_t n)
{
    const rlf_map *map = m->map;
    const rlf_fuse_plane *plane = &map->planes[pixel];
    const double depth = (double)map->clean[pixel];
    const rlf_vec3 middle = {(double)map->ray_x[pixel], (double)map->ray_y[pixel], 1.0};
    for (int32_t k = 0; k < n * n; k++) {
        const double u = (k % n + 0.5) / n - 0.5, v = (k / n + 0.5) / n - 0.5;
        const rlf_vec3 ray = {middle.x + u / map->pinhole.fx, middle.y + v / map->pinhole.fy, 1.0};
        const double along = (double)plane->x * ray.x + (double)plane->y * ray.y + (double)plane->z;
        const double z = along < 0.0 ? (double)plane->offset / along : depth;
        look(m, ray, rlf_clamp(z, 0.5 * depth, 2.0 * depth));
    }
}

/* Blocks along a pixel's longer side on its surface, from the least to the most: so many pixels lie
 * on one block. */
static float pixels_on_block(const marker *m, int32_t pixel)
{
    const rlf_map *map = m->map;
    const float x = map->ray_x[pixel], y = map->ray_y[pixel], z = map->clean[pixel];
    return m->size * -map->planes[pixel].offset / (z * z * sqrtf(x * x + y * y + 1.0f));
}

/* Those pixels of a row that have their turn. */
static void mark_row(marker *m, int32_t y, int32_t phase)
{
    const rlf_map *map = m->map;
    const int32_t width = map->pinhole.width;
    for (int32_t x = 0; x < width; x++) {
        const int32_t pixel = y * width + x;
        if (!(map->planes[pixel].offset < 0.0f)) {
            continue;
        }
        const float pixels = pixels_on_block(m, pixel);
        const int32_t every = pixels < SPACING ? (pixels > 1.0f ? (int32_t)pixels : 1) : SPACING;
        if ((x - phase % SPACING) % every == 0 && (y - phase / SPACING) % every == 0) {
            const float places = pixels < 1.0f ? 1.0f / pixels + 1.0f : 1.0f;
            look_about(m, pixel, places < FINEST ? (int32_t)places : FINEST);
        }
    }
}

void map_mark(rlf_map *map, const rlf_pose *T_world_camera, rlf_map_change *change)
{
    const double side = map->def.voxel_m * MAP_SIDE;
    marker m = {.map = map,
                .eye = T_world_camera->p,
                .R_world_camera = rlf_quat_to_mat3(T_world_camera->q),
                .to_blocks = 1.0 / side,
                .size = (float)(side * rlf_min(map->pinhole.fx, map->pinhole.fy)),
                .reach = INT32_MAX,
                .change = change};
    /* The pixels that look move by one from frame to frame, in an order that skips about. */
    const int32_t phase = (int32_t)((map->frames * 7) % (SPACING * SPACING));
    map->seen_count = 0;
    for (int32_t y = 0; y < map->pinhole.height; y++) {
        mark_row(&m, y, phase);
    }
    mark_batch(&m);
}
