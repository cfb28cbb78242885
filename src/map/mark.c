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
 * for at every frame: the farthest, by bins of their squared distance. */
enum { EVICT_SHARE = 64, EVICT_BINS = 256 };

typedef struct marker {
    rlf_map *map;
    rlf_vec3 eye;
    rlf_mat3 R_world_camera;
    double to_blocks; /* per metre */
    float reach;      /* a block's side times the focal length, metre pixels */
    double reach2;    /* squared distance beyond which there is no room in a full memory, m^2 */
    rlf_map_change *change;
    int32_t at[BATCH * MARGINS][3];
    int32_t count;
} marker;

static bool may_leave(const rlf_map *map, int32_t block)
{
    return (map->volume.flags[block] & MAP_LIVE) && map->volume.marked[block] != map->tick;
}

static double distance2_of(const rlf_map *map, int32_t block, rlf_vec3 eye)
{
    const rlf_vec3 way = map_block_way(map, map->volume.place[block], eye);
    return rlf_dot(way, way);
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
            count[bin_of(distance2_of(map, i, eye), most)]++;
        }
    }
    int32_t bin = EVICT_BINS, sum = 0;
    while (bin > least + 1 && sum < wanted) {
        sum += count[--bin];
    }
    return bin;
}

/* Makes room for a block at the squared distance `distance2` from the eye, m^2: some of those that
 * are farther and that this frame did not see are removed; returns how many. When there are none
 * `reach2` is where the farthest of the others is: nothing beyond has room. */
static int32_t evict(rlf_map *map, rlf_vec3 eye, double distance2, double *reach2)
{
    map_volume *v = &map->volume;
    double most = 0.0;
    for (int32_t i = 0; i < v->high; i++) {
        if (may_leave(map, i)) {
            most = rlf_max(most, distance2_of(map, i, eye));
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
        if (may_leave(map, i) && bin_of(distance2_of(map, i, eye), most) >= bin) {
            map_journal_keep(map, i, false);
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
    const rlf_vec3 way = map_block_way(map, place, m->eye);
    const double distance2 = rlf_dot(way, way);
    if (v->count == v->capacity && distance2 >= m->reach2) {
        return -1;
    }
    block = map_volume_add(v, at[0], at[1], at[2]);
    if (block < 0) {
        m->change->blocks_evicted += evict(map, m->eye, distance2, &m->reach2);
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
    return m->reach * -map->planes[pixel].offset / (z * z * sqrtf(x * x + y * y + 1.0f));
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
                .reach = (float)(side * rlf_min(map->pinhole.fx, map->pinhole.fy)),
                .reach2 = 1e300,
                .change = change};
    /* The pixels that look move by one from frame to frame, in an order that skips about. */
    const int32_t phase = (int32_t)((map->frames * 7) % (SPACING * SPACING));
    map->seen_count = 0;
    for (int32_t y = 0; y < map->pinhole.height; y++) {
        mark_row(&m, y, phase);
    }
    mark_batch(&m);
}
