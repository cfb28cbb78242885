/* Maps as bytes. Layout, little endian (docs/moving-camera.md):
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

/* Bytes on their way to a file or from it, and the checksum of those that passed. */
typedef struct stream {
    rlf_map_write_fn write; /* one of these is NULL */
    rlf_map_read_fn read;
    void *context;
    uint64_t sum;
} stream;

static bool pass(stream *s, uint8_t *data, size_t size)
{
    const bool is_done =
        s->write != NULL ? s->write(s->context, data, size) : s->read(s->context, data, size);
    for (size_t i = 0; i < size && is_done; i++) {
        s->sum = (s->sum ^ data[i]) * 0x100000001b3u;
    }
    return is_done;
}

static stream stream_begin(rlf_map_write_fn write, rlf_map_read_fn read, void *context)
{
    return (stream){write, read, context, 0xcbf29ce484222325u};
}

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

/* A viewpoint's numbers are a pose's, in its order. */
static void pack_viewpoint(const rlf_pose *T, uint8_t out[VIEWPOINT_SIZE])
{
    double values[7];
    memcpy(values, T, sizeof(values));
    for (int32_t i = 0; i < 7; i++) {
        put_double(out + 8 * i, values[i]);
    }
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

static bool write_all(const rlf_map *map, const int32_t *order, stream *s)
{
    uint8_t head[HEAD_SIZE], viewpoint[VIEWPOINT_SIZE], block[BLOCK_SIZE], tail[8];
    memcpy(head, magic, sizeof(magic));
    put(head + 8, FILE_VERSION, 4);
    put_double(head + 12, map->def.voxel_m);
    put(head + 20, (uint32_t)map->volume.count, 4);
    put(head + 24, (uint32_t)map->viewpoint_count, 4);
    bool is_written = pass(s, head, sizeof(head));
    for (int32_t i = 0; is_written && i < map->viewpoint_count; i++) {
        pack_viewpoint(&map->viewpoint[i], viewpoint);
        is_written = pass(s, viewpoint, sizeof(viewpoint));
    }
    for (int32_t i = 0; is_written && i < map->volume.count; i++) {
        pack(map->volume.place[order[i]], map_block_at(&map->volume, order[i]), block);
        is_written = pass(s, block, sizeof(block));
    }
    put(tail, s->sum, 8);
    return is_written && pass(s, tail, sizeof(tail));
}

rlf_result rlf_map_save(const rlf_map *map, rlf_map_write_fn write, void *context)
{
    if (!RLF_ASSERT(map != NULL && write != NULL)) {
        return RLF_ERROR_INVALID;
    }
    stream s = stream_begin(write, NULL, context);
    int32_t *order = rlf_alloc_array((size_t)map->volume.count + 1, sizeof(int32_t));
    rlf_result result = RLF_ERROR_MEMORY;
    if (order != NULL && map_volume_sorted(&map->volume, order)) {
        result = write_all(map, order, &s)
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
    double values[7];
    for (int32_t i = 0; i < 7; i++) {
        values[i] = get_double(data + 8 * i);
    }
    rlf_pose *T = &map->viewpoint[map->viewpoint_count++];
    memcpy(T, values, sizeof(values));
    return math_pose_is_sound(T) ? RLF_OK : damaged("a viewpoint is no pose");
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

static rlf_result read_all(rlf_map *map, stream *s)
{
    static const char cut[] = "it is cut short";
    uint8_t head[HEAD_SIZE] = {0}, viewpoint[VIEWPOINT_SIZE] = {0}, block[BLOCK_SIZE] = {0},
            tail[8] = {0};
    uint32_t count = 0, viewpoints = 0;
    uint64_t last_key = 0;
    if (!pass(s, head, sizeof(head))) {
        return damaged(cut);
    }
    rlf_result result = read_head(map, head, &count, &viewpoints);
    for (uint32_t i = 0; result == RLF_OK && i < viewpoints; i++) {
        const bool is_read = pass(s, viewpoint, sizeof(viewpoint));
        result = is_read ? read_viewpoint(map, viewpoint) : damaged(cut);
    }
    for (uint32_t i = 0; result == RLF_OK && i < count; i++) {
        const bool is_read = pass(s, block, sizeof(block));
        result = is_read ? read_block(map, block, &last_key) : damaged(cut);
    }
    const uint64_t sum = s->sum;
    if (result == RLF_OK && (!pass(s, tail, sizeof(tail)) || get(tail, 8) != sum)) {
        result = damaged("it is cut short or damaged (its checksum is another)");
    }
    return result;
}

rlf_result rlf_map_load(rlf_map *map, rlf_map_read_fn read, void *context)
{
    if (!RLF_ASSERT(map != NULL && read != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const double voxel_m = map->def.voxel_m;
    rlf_map_clear(map);
    stream s = stream_begin(NULL, read, context);
    const rlf_result result = read_all(map, &s);
    if (result != RLF_OK) {
        rlf_map_clear(map);
        map->def.voxel_m = voxel_m;
        return result;
    }
    rlf_map_fence(map);
    return RLF_OK;
}
