/* Maps as bytes. Layout, little endian (docs/map.md):
 *
 *   8 bytes "RLFMAP\r\n", u32 version, f64 voxel_m, u32 blocks, u32 viewpoints,
 *   of each viewpoint 7 x f64 x y z qx qy qz qw, then each block by rising key:
 *   i16 x, y, z; u8 kind; kind 1: 512 x (i16 distance, u8 weight, u8 grey), 128 x u8 chroma
 *   u64 checksum of all before it (FNV-1a of 64 bits) */
#include "map/volume.h"

#include <string.h>

#define FILE_VERSION 2u
#define HEAD_SIZE 28
#define VIEWPOINT_SIZE (7 * 8)
#define BLOCK_SIZE (7 + 4 * MAP_VOXELS + 2 * RLF_FUSE_CHROMA)

static const uint8_t magic[8] = {'R', 'L', 'F', 'M', 'A', 'P', '\r', '\n'};

static uint64_t checksum(uint64_t sum, const uint8_t *data, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        sum = (sum ^ data[i]) * 0x100000001b3u;
    }
    return sum;
}

#define CHECKSUM_BEGIN 0xcbf29ce484222325u

static void put(uint8_t *out, uint64_t value, int32_t bytes)
{
    for (int32_t i = 0; i < bytes; i++) {
        out[i] = (uint8_t)(value >> (8 * i));
    }
}

static uint64_t get(const uint8_t *in, int32_t bytes)
{
    uint64_t value = 0;
    for (int32_t i = 0; i < bytes; i++) {
        value |= (uint64_t)in[i] << (8 * i);
    }
    return value;
}

static int16_t get_i16(const uint8_t *in)
{
    const int32_t value = (int32_t)get(in, 2);
    return (int16_t)(value > 32767 ? value - 65536 : value);
}

static void put_double(uint8_t *out, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof(bits));
    put(out, bits, 8);
}

static double get_double(const uint8_t *in)
{
    const uint64_t bits = get(in, 8);
    double value;
    memcpy(&value, &bits, sizeof(value));
    return value;
}

static void pack_viewpoint(const rlf_pose *T, uint8_t out[VIEWPOINT_SIZE])
{
    const double values[7] = {T->p.x, T->p.y, T->p.z, T->q.x, T->q.y, T->q.z, T->q.w};
    for (int32_t i = 0; i < 7; i++) {
        put_double(out + 8 * i, values[i]);
    }
}

static rlf_pose unpack_viewpoint(const uint8_t in[VIEWPOINT_SIZE])
{
    double v[7];
    for (int32_t i = 0; i < 7; i++) {
        v[i] = get_double(in + 8 * i);
    }
    return (rlf_pose){{v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]}};
}

static void pack(const int16_t place[4], const map_block *b, uint8_t out[BLOCK_SIZE])
{
    for (int32_t k = 0; k < 3; k++) {
        put(out + 2 * k, (uint16_t)place[k], 2);
    }
    out[6] = 1;
    uint8_t *at = out + 7;
    for (int32_t i = 0; i < MAP_VOXELS; i++, at += 4) {
        put(at, (uint16_t)b->distance[i], 2);
        at[2] = b->weight[i];
        at[3] = b->grey[i];
    }
    memcpy(at, b->chroma, sizeof(b->chroma));
}

static void unpack(const uint8_t in[BLOCK_SIZE], map_block *b)
{
    const uint8_t *at = in + 7;
    for (int32_t i = 0; i < MAP_VOXELS; i++, at += 4) {
        const int16_t distance = get_i16(at);
        b->weight[i] = at[2];
        b->distance[i] = at[2] == 0              ? RLF_FUSE_UNKNOWN
                         : distance < -INT16_MAX ? -INT16_MAX
                                                 : distance;
        b->grey[i] = at[3];
    }
    memcpy(b->chroma, at, sizeof(b->chroma));
}

static bool write_all(const rlf_map *map, const int32_t *order, rlf_map_write_fn write,
                      void *context)
{
    uint8_t head[HEAD_SIZE], viewpoint[VIEWPOINT_SIZE], block[BLOCK_SIZE], tail[8];
    memcpy(head, magic, sizeof(magic));
    put(head + 8, FILE_VERSION, 4);
    put_double(head + 12, map->def.voxel_m);
    put(head + 20, (uint32_t)map->volume.count, 4);
    put(head + 24, (uint32_t)map->viewpoint_count, 4);
    uint64_t sum = checksum(CHECKSUM_BEGIN, head, sizeof(head));
    bool is_written = write(context, head, sizeof(head));
    for (int32_t i = 0; is_written && i < map->viewpoint_count; i++) {
        pack_viewpoint(&map->viewpoint[i], viewpoint);
        sum = checksum(sum, viewpoint, sizeof(viewpoint));
        is_written = write(context, viewpoint, sizeof(viewpoint));
    }
    for (int32_t i = 0; is_written && i < map->volume.count; i++) {
        pack(map->volume.place[order[i]], map_block_at(&map->volume, order[i]), block);
        sum = checksum(sum, block, sizeof(block));
        is_written = write(context, block, sizeof(block));
    }
    put(tail, sum, 8);
    return is_written && write(context, tail, sizeof(tail));
}

rlf_result rlf_map_save(const rlf_map *map, rlf_map_write_fn write, void *context)
{
    if (!RLF_ASSERT(map != NULL && write != NULL)) {
        return RLF_ERROR_INVALID;
    }
    int32_t *order = rlf_alloc_array((size_t)map->volume.count + 1, sizeof(int32_t));
    rlf_result result = RLF_ERROR_MEMORY;
    if (order != NULL && map_volume_sorted(&map->volume, order)) {
        result = write_all(map, order, write, context)
                     ? RLF_OK
                     : rlf_fail(RLF_ERROR_IO, "map: could not be written whole");
    }
    rlf_free(order);
    return result;
}

static rlf_result damaged(const char *what)
{
    return rlf_fail(RLF_ERROR_FORMAT, "map: %s: make it again, or take a copy", what);
}

/* The head: the numbers of blocks and viewpoints, or an error. */
static rlf_result read_head(rlf_map *map, const uint8_t head[HEAD_SIZE], uint32_t *out_count,
                            uint32_t *out_viewpoints)
{
    if (memcmp(head, magic, sizeof(magic)) != 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "map: this is not a map (it does not begin with RLFMAP)");
    }
    const uint32_t version = (uint32_t)get(head + 8, 4);
    if (version != FILE_VERSION) {
        return rlf_fail(RLF_ERROR_FORMAT, "map: version %lu, this program reads version %u",
                        (unsigned long)version, FILE_VERSION);
    }
    const double voxel_m = get_double(head + 12);
    if (!(voxel_m >= 0.002 && voxel_m <= 0.05)) {
        return damaged("its voxel size is not within 2..50 mm");
    }
    *out_count = (uint32_t)get(head + 20, 4);
    if (*out_count > (uint32_t)map->volume.capacity) {
        return rlf_fail(RLF_ERROR_CAPACITY,
                        "map: has %lu blocks, %d MB hold %d: more memory (memory_mb), or a map of "
                        "the room with larger voxels",
                        (unsigned long)*out_count, (int)map->def.memory_mb,
                        (int)map->volume.capacity);
    }
    *out_viewpoints = (uint32_t)get(head + 24, 4);
    if (*out_viewpoints > MAP_VIEWPOINTS) {
        return damaged("it has too many viewpoints");
    }
    map->def.voxel_m = voxel_m;
    return RLF_OK;
}

static rlf_result read_viewpoint(rlf_map *map, const uint8_t data[VIEWPOINT_SIZE])
{
    const rlf_pose T = unpack_viewpoint(data);
    if (!map_pose_is_sound(&T)) {
        return damaged("a viewpoint is no pose");
    }
    map->viewpoint[map->viewpoint_count++] = T;
    return RLF_OK;
}

static rlf_result read_block(rlf_map *map, const uint8_t data[BLOCK_SIZE], uint64_t *last_key)
{
    int16_t place[3];
    for (int32_t k = 0; k < 3; k++) {
        place[k] = get_i16(data + 2 * k);
    }
    const uint64_t key = map_key(place[0], place[1], place[2]) + 1;
    if (data[6] != 1 || key <= *last_key) {
        return damaged("a block is of an unknown kind or out of order");
    }
    *last_key = key;
    const int32_t block = map_volume_add(&map->volume, place[0], place[1], place[2]);
    if (block < 0) {
        return map->volume.count < map->volume.capacity
                   ? damaged("a block is out of range, or memory is short")
                   : RLF_ERROR_CAPACITY;
    }
    unpack(data, map_block_at(&map->volume, block));
    map_block_look(&map->volume, block);
    return RLF_OK;
}

static rlf_result read_all(rlf_map *map, rlf_map_read_fn read, void *context)
{
    uint8_t head[HEAD_SIZE], viewpoint[VIEWPOINT_SIZE], block[BLOCK_SIZE], tail[8];
    uint32_t count = 0, viewpoints = 0;
    if (!read(context, head, sizeof(head))) {
        return damaged("it is cut short");
    }
    rlf_result result = read_head(map, head, &count, &viewpoints);
    uint64_t sum = checksum(CHECKSUM_BEGIN, head, sizeof(head)), last_key = 0;
    for (uint32_t i = 0; result == RLF_OK && i < viewpoints; i++) {
        if (!read(context, viewpoint, sizeof(viewpoint))) {
            return damaged("it is cut short");
        }
        sum = checksum(sum, viewpoint, sizeof(viewpoint));
        result = read_viewpoint(map, viewpoint);
    }
    for (uint32_t i = 0; result == RLF_OK && i < count; i++) {
        if (!read(context, block, sizeof(block))) {
            return damaged("it is cut short");
        }
        sum = checksum(sum, block, sizeof(block));
        result = read_block(map, block, &last_key);
    }
    if (result != RLF_OK) {
        return result;
    }
    if (!read(context, tail, sizeof(tail)) || get(tail, 8) != sum) {
        return damaged("it is cut short or damaged (its checksum is another)");
    }
    return RLF_OK;
}

rlf_result rlf_map_load(rlf_map *map, rlf_map_read_fn read, void *context)
{
    if (!RLF_ASSERT(map != NULL && read != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const double voxel_m = map->def.voxel_m;
    rlf_map_clear(map);
    rlf_result result = read_all(map, read, context);
    if (result != RLF_OK) {
        rlf_map_clear(map);
        map->def.voxel_m = voxel_m;
        return result;
    }
    rlf_map_fence(map);
    return RLF_OK;
}
