/* Settings, life and state of a map. */
#include "map/volume.h"

#include "base/cookie.h"
#include "camera/checks.h"

#include <string.h>

/* Bytes that a block costs beside its voxels: tables, and its share of the journal. */
#define TABLE_BYTES 168

rlf_map_def rlf_map_def_default(void)
{
    rlf_map_def def;
    memset(&def, 0, sizeof(def));
    def.cookie = RLF_DEF_COOKIE;
    def.voxel_m = 0.006;
    def.memory_mb = 288;
    def.truncation_sigmas = 4.0;
    def.blocks_per_frame = 768;
    def.carve_after = 4;
    def.keep_color = true;
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
    if (!(def->truncation_sigmas >= 1.0 && def->truncation_sigmas <= 100.0)) {
        return out_of_range("truncation_sigmas", "1..100");
    }
    if (def->blocks_per_frame < 0) {
        return out_of_range("blocks_per_frame", "0 (all) or more");
    }
    if (def->carve_after < 1 || def->carve_after > 16) {
        return out_of_range("carve_after", "1..16");
    }
    return RLF_OK;
}

/* Rays of the rig's pixels, and which of them a pinhole's pixel shows. */
static void fill_rays(rlf_map *map)
{
    const rlf_camera *lens = &map->def.rig.depth;
    for (int32_t y = 0; y < lens->height; y++) {
        for (int32_t x = 0; x < lens->width; x++) {
            const size_t i = (size_t)y * (size_t)lens->width + (size_t)x;
            rlf_vec3 ray;
            bool has_ray = rlf_camera_unproject(lens, x, y, &ray);
            map->ray_x[i] = has_ray ? (float)ray.x : 0.0f;
            map->ray_y[i] = has_ray ? (float)ray.y : 0.0f;
            if (map->source_of == NULL) {
                continue;
            }
            const rlf_vec3 straight = {(x - lens->cx) / lens->fx, (y - lens->cy) / lens->fy, 1.0};
            double u, v;
            bool is_seen = rlf_camera_project(lens, straight, &u, &v) && u > -0.5 && v > -0.5 &&
                           u < lens->width - 0.5 && v < lens->height - 0.5;
            map->source_of[i] =
                is_seen ? (int32_t)(v + 0.5) * lens->width + (int32_t)(u + 0.5) : -1;
        }
    }
}

static bool take_planes(rlf_map *map)
{
    const rlf_camera *c = &map->pinhole;
    const size_t n = (size_t)c->width * (size_t)c->height;
    const size_t tiles = ((size_t)c->width / 8 + 1) * ((size_t)c->height / 8 + 1);
    const size_t blocks = (size_t)map->volume.capacity;
    const bool is_bent = map->def.rig.depth.distortion_model != RLF_DISTORTION_NONE;
    map->source_of = is_bent ? rlf_alloc_array(n, sizeof(int32_t)) : NULL;
    map->ray_x = rlf_alloc_array(n, sizeof(float));
    map->ray_y = rlf_alloc_array(n, sizeof(float));
    map->planes = rlf_alloc_array(n, sizeof(rlf_fuse_plane));
    map->clean = rlf_alloc_array(n, sizeof(float));
    map->scratch = rlf_alloc_array((size_t)rlf_pool_worker_count(map->def.pool),
                                   3 * (size_t)c->width * sizeof(float));
    map->row_least = rlf_alloc_array(n, sizeof(float));
    map->least = rlf_alloc_array(n, sizeof(float));
    map->seen = rlf_alloc_array(blocks, sizeof(int32_t));
    map->chosen = rlf_alloc_array(blocks, sizeof(int32_t));
    map_view_planes *out = &map->out;
    out->depth = rlf_alloc_array(n, sizeof(float));
    for (int32_t k = 0; k < 3; k++) {
        out->normal[k] = rlf_alloc_array(n, sizeof(float));
    }
    out->grey = rlf_alloc_array(n, 1);
    out->rgba = rlf_alloc_array(n, 4);
    out->start = rlf_alloc_array(n, sizeof(int32_t));
    out->tile_far = rlf_alloc_array(tiles, sizeof(float));
    return (map->source_of != NULL || !is_bent) && map->ray_x != NULL && map->ray_y != NULL &&
           map->planes != NULL && map->clean != NULL && map->scratch != NULL &&
           map->row_least != NULL && map->least != NULL && map->seen != NULL &&
           map->chosen != NULL && out->depth != NULL && out->normal[0] != NULL &&
           out->normal[1] != NULL && out->normal[2] != NULL && out->grey != NULL &&
           out->rgba != NULL && out->start != NULL && out->tile_far != NULL;
}

static bool take_memory(rlf_map *map)
{
    const double bytes = (double)map->def.memory_mb * 1048576.0;
    const double each = 1.125 * (double)sizeof(map_block) + TABLE_BYTES;
    const int32_t capacity = (int32_t)(bytes / each);
    return map_volume_create(&map->volume, capacity) &&
           map_journal_create(&map->journal, capacity / 8, capacity) && take_planes(map);
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
    map->pinhole = def->rig.depth;
    map->pinhole.distortion_model = RLF_DISTORTION_NONE;
    memset(map->pinhole.distortion, 0, sizeof(map->pinhole.distortion));
    if (!take_memory(map)) {
        rlf_map_destroy(&map);
        return RLF_ERROR_MEMORY;
    }
    fill_rays(map);
    *out = map;
    return RLF_OK;
}

void rlf_map_destroy(rlf_map **pointer)
{
    if (pointer == NULL || *pointer == NULL) {
        return;
    }
    rlf_map *map = *pointer;
    map_volume_destroy(&map->volume);
    map_journal_destroy(&map->journal);
    void *const all[] = {map->source_of,     map->ray_x,         map->ray_y,     map->planes,
                         map->clean,         map->scratch,       map->row_least, map->least,
                         map->seen,          map->chosen,        map->out.depth, map->out.normal[0],
                         map->out.normal[1], map->out.normal[2], map->out.grey,  map->out.rgba,
                         map->out.start,     map->out.tile_far};
    for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); i++) {
        rlf_free(all[i]);
    }
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

bool map_pose_is_sound(const rlf_pose *T)
{
    const rlf_quat q = T->q;
    const double length2 = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return rlf_dot(T->p, T->p) < 1e12 && length2 > 0.98 && length2 < 1.02;
}

double map_block_distance2(const rlf_map *map, int32_t block, rlf_vec3 p)
{
    const double side = map->def.voxel_m * MAP_SIDE;
    const int16_t *at = map->volume.place[block];
    const rlf_vec3 d = {(at[0] + 0.5) * side - p.x, (at[1] + 0.5) * side - p.y,
                        (at[2] + 0.5) * side - p.z};
    return rlf_dot(d, d);
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
