/* Settings, life and state of a map. */
#include "map/volume.h"

#include "base/checks.h"
#include "camera/checks.h"
#include "camera/pixels.h"

#include <string.h>

/* Bytes that a block costs beside its voxels: tables, and its share of the journal. */
#define TABLE_BYTES 168
/* A pose this near to a viewpoint in both is no new one. */
#define APART_M 0.25
#define APART_COSINE 0.9914 /* of half the angle, 15 degrees */

rlf_map_def rlf_map_def_default(void)
{
    rlf_map_def def;
    memset(&def, 0, sizeof(def));
    def.cookie = RLF_DEF_COOKIE;
    def.voxel_m = 0.006;
    def.memory_mb = 288;
    def.blocks_per_frame = 768;
    return def;
}

static rlf_result out_of_range(const char *field, const char *range)
{
    return rlf_fail(RLF_ERROR_INVALID, "rlf_map_def.%s: must be %s", field, range);
}

static rlf_result check(const rlf_map_def *def)
{
    rlf_result result = rig_check(&def->rig, "rlf_map_def");
    if (result != RLF_OK) {
        return result;
    }
    if (!(def->voxel_m >= 0.002 && def->voxel_m <= 0.05)) {
        return out_of_range("voxel_m", "0.002..0.05 metres");
    }
    if (def->memory_mb < 8 || def->memory_mb > RLF_MAP_MEMORY_MOST_MB) {
        return out_of_range("memory_mb", "8..16384 MiB");
    }
    if (def->blocks_per_frame < 0) {
        return out_of_range("blocks_per_frame", "0 (all) or more");
    }
    return RLF_OK;
}

/* Which of the rig's pixels a pinhole's pixel shows. */
static void fill_sources(rlf_map *map)
{
    const rlf_camera *c = &map->pinhole;
    for (int32_t i = 0; i < c->width * c->height && map->source_of != NULL; i++) {
        const double x = i % c->width, y = i / c->width;
        const rlf_vec3 ray = {(x - c->cx) / c->fx, (y - c->cy) / c->fy, 1.0};
        map->source_of[i] = camera_pixel_of(&map->def.rig.depth, ray);
    }
}

static void take_all(void *context)
{
    rlf_map *map = context;
    rlf_arena *a = &map->arena;
    map_view_planes *out = &map->out;
    const double bytes = (double)map->def.memory_mb * 1048576.0;
    const double each = 1.125 * (double)sizeof(map_block) + TABLE_BYTES;
    const int32_t capacity = (int32_t)(bytes / each);
    const rlf_camera *c = &map->pinhole;
    const size_t n = (size_t)c->width * (size_t)c->height, blocks = (size_t)capacity;
    const size_t tiles = ((size_t)c->width / 8 + 1) * ((size_t)c->height / 8 + 1);
    const size_t workers = (size_t)rlf_pool_worker_count(map->def.pool);
    const bool is_bent = map->def.rig.depth.distortion_model != RLF_DISTORTION_NONE;
    map_volume_take(&map->volume, a, capacity);
    map_journal_take(&map->journal, a, capacity / 8, capacity);
    map->source_of = is_bent ? arena_take(a, n, sizeof(int32_t)) : NULL;
    map->ray_x = arena_take(a, n, sizeof(float));
    map->ray_y = arena_take(a, n, sizeof(float));
    map->planes = arena_take(a, n, sizeof(rlf_fuse_plane));
    map->clean = arena_take(a, n, sizeof(float));
    map->scratch = arena_take(a, workers, 3 * (size_t)c->width * sizeof(float));
    map->row_least = arena_take(a, n, sizeof(float));
    map->least = arena_take(a, n, sizeof(float));
    map->seen = arena_take(a, blocks, sizeof(int32_t));
    map->chosen = arena_take(a, blocks, sizeof(int32_t));
    out->depth = arena_take(a, n, sizeof(float));
    for (int32_t k = 0; k < 3; k++) {
        out->normal[k] = arena_take(a, n, sizeof(float));
    }
    out->grey = arena_take(a, n, 1);
    out->rgba = arena_take(a, n, 4);
    out->start = arena_take(a, n, sizeof(int32_t));
    out->tile_far = arena_take(a, tiles, sizeof(float));
}

rlf_result rlf_map_create(const rlf_map_def *def, rlf_map **out)
{
    if (!RLF_ASSERT(def != NULL && out != NULL) || !RLF_ASSERT(def->cookie == RLF_DEF_COOKIE)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = check(def);
    if (result != RLF_OK) {
        return result;
    }
    rlf_map *map = rlf_alloc(sizeof(*map));
    if (map == NULL) {
        return RLF_ERROR_MEMORY;
    }
    map->def = *def;
    map->pinhole = camera_pinhole(&def->rig.depth);
    if (!arena_create(&map->arena, take_all, map)) {
        rlf_free(map);
        return RLF_ERROR_MEMORY;
    }
    camera_fill_rays(&def->rig.depth, map->ray_x, map->ray_y);
    fill_sources(map);
    rlf_map_clear(map);
    *out = map;
    return RLF_OK;
}

void rlf_map_destroy(rlf_map **pointer)
{
    if (pointer == NULL || *pointer == NULL) {
        return;
    }
    rlf_map *map = *pointer;
    map_slabs_free(&map->volume.slabs);
    map_slabs_free(&map->journal.slabs);
    arena_destroy(&map->arena);
    rlf_free(map);
    *pointer = NULL;
}

void rlf_map_clear(rlf_map *map)
{
    if (!RLF_ASSERT(map != NULL)) {
        return;
    }
    map_volume_clear(&map->volume);
    map->frames = 0;
    map->viewpoint_count = 0;
    map->is_full = false;
    map->carve_cursor = 0;
    memset(&map->out.last, 0, sizeof(map->out.last));
    rlf_map_fence(map);
}

double rlf_map_truncation(const rlf_map *map)
{
    return RLF_ASSERT(map != NULL) ? MAP_TRUNCATION_LEAST * map->def.voxel_m : 0.0;
}

rlf_map_status rlf_map_get_status(const rlf_map *map)
{
    rlf_map_status s;
    memset(&s, 0, sizeof(s));
    s.box = rlf_aabb_empty();
    if (!RLF_ASSERT(map != NULL)) {
        return s;
    }
    const map_volume *v = &map->volume;
    const double side = map->def.voxel_m * MAP_SIDE;
    const size_t pixels = (size_t)map->pinhole.width * (size_t)map->pinhole.height;
    s.voxel_m = map->def.voxel_m;
    s.block_count = v->count;
    s.block_capacity = v->capacity;
    s.frames = map->frames;
    s.is_full = map->is_full;
    s.bytes = (size_t)(v->slabs.slab_count + map->journal.slabs.slab_count) * MAP_SLAB *
                  sizeof(map_block) +
              (size_t)v->capacity * TABLE_BYTES +
              pixels * (sizeof(rlf_fuse_plane) + 8 * sizeof(float) + 9);
    for (int32_t i = 0; i < v->high; i++) {
        if (v->flags[i] & MAP_LIVE) {
            const int16_t *p = v->place[i];
            rlf_aabb_extend(&s.box, rlf_vec3_make(p[0] * side, p[1] * side, p[2] * side));
            rlf_aabb_extend(&s.box,
                            rlf_vec3_make((p[0] + 1) * side, (p[1] + 1) * side, (p[2] + 1) * side));
        }
    }
    return s;
}

static bool is_alike(const rlf_pose *a, const rlf_pose *b)
{
    const double cosine = a->q.x * b->q.x + a->q.y * b->q.y + a->q.z * b->q.z + a->q.w * b->q.w;
    return rlf_length(rlf_sub(a->p, b->p)) < APART_M &&
           (cosine > APART_COSINE || cosine < -APART_COSINE);
}

void map_viewpoints_add(rlf_map *map, const rlf_pose *T_world_camera)
{
    for (int32_t i = 0; i < map->viewpoint_count; i++) {
        if (is_alike(&map->viewpoint[i], T_world_camera)) {
            return;
        }
    }
    if (map->viewpoint_count < MAP_VIEWPOINTS) {
        map->viewpoint[map->viewpoint_count++] = *T_world_camera;
    }
}

const rlf_pose *rlf_map_get_viewpoints(const rlf_map *map, int32_t *out_count)
{
    if (!RLF_ASSERT(map != NULL && out_count != NULL)) {
        return NULL;
    }
    *out_count = map->viewpoint_count;
    return map->viewpoint;
}
