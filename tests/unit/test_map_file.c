/* Maps as bytes: what is saved comes back; what is cut short, changed or invented is refused. */

#include "map_room.h"
#include "created.h"
#include "test.h"

static map_room room;

static rlf_map *made(int32_t views)
{
    rlf_map_def def = map_room_def(&room);
    def.memory_mb = 16;
    rlf_map *map = map_of(&def);
    map_room_fuse(&room, map, views);
    return map;
}

static int set_up(void **state)
{
    (void)state;
    map_room_init(&room);
    return 0;
}

TEST_CASE(what_is_saved_comes_back)
{
    rlf_map *map = made(4), *other = made(0);
    map_bytes file = map_bytes_of(map);
    assert_true(file.size > 10000);
    assert_int_equal(rlf_map_load(other, map_bytes_read, &file), RLF_OK);
    map_bytes again = map_bytes_of(other);
    assert_true(map_bytes_equal(&file, &again));
    const rlf_vec3 p = {0.55, 0.35, ROOM_WALL_Z - 0.005};
    const rlf_map_point a = rlf_map_sample(map, p), b = rlf_map_sample(other, p);
    assert_int_equal(a.state, RLF_MAP_FREE);
    assert_true(a.distance == b.distance && a.gradient.z == b.gradient.z);
    int32_t seen_from, again_from;
    const rlf_pose *from = rlf_map_get_viewpoints(map, &seen_from);
    const rlf_pose *loaded = rlf_map_get_viewpoints(other, &again_from);
    assert_true(seen_from > 0 && seen_from == again_from);
    assert_memory_equal(from, loaded, (size_t)seen_from * sizeof(*from));
    map_room_fuse(&room, other, 1); /* and goes on */
    rlf_free(file.data);
    rlf_free(again.data);
    rlf_map_destroy(&map);
    rlf_map_destroy(&other);
}

TEST_CASE(a_full_disk_is_told)
{
    rlf_map *map = made(2);
    uint8_t small[1000];
    map_bytes file = {.data = small, .capacity = sizeof(small)};
    assert_int_equal(rlf_map_save(map, map_bytes_write, &file), RLF_ERROR_IO);
    rlf_map_destroy(&map);
}

/* Loads a file, which must fail, and leaves an empty map that works. */
static void check_refused(rlf_map *map, map_bytes file, rlf_result expected)
{
    file.read = 0;
    assert_int_equal(rlf_map_load(map, map_bytes_read, &file), expected);
    assert_int_equal(rlf_map_get_status(map).block_count, 0);
    assert_true(rlf_error_text()[0] != '\0');
}

TEST_CASE(a_cut_or_hostile_file_is_refused)
{
    rlf_map *map = made(2);
    map_bytes file = map_bytes_of(map);
    const size_t whole = file.size;
    for (size_t size = 0; size < whole; size += size < 64 ? 1 : whole / 19) {
        file.size = size;
        check_refused(map, file, RLF_ERROR_FORMAT);
    }
    file.size = whole;
    /* One bit anywhere: of the mark, version, voxel size, places, kinds, voxels, checksum. */
    const size_t places[] = {0, 9, 19, 24, 30, 31, 1000, whole - 1};
    for (size_t i = 0; i < sizeof(places) / sizeof(places[0]); i++) {
        file.data[places[i]] ^= 0x40;
        check_refused(map, file, RLF_ERROR_FORMAT);
        file.data[places[i]] ^= 0x40;
    }
    file.data[23] = 0x7f; /* two thousand million blocks */
    check_refused(map, file, RLF_ERROR_CAPACITY);
    file.data[23] = 0;
    file.data[27] = 0x7f; /* as many viewpoints */
    check_refused(map, file, RLF_ERROR_FORMAT);
    file.data[27] = 0;
    memset(file.data + 28, 0xff, 8); /* a viewpoint at NaN */
    check_refused(map, file, RLF_ERROR_FORMAT);
    memset(file.data + 12, 0xff, 8); /* NaN */
    check_refused(map, file, RLF_ERROR_FORMAT);
    map_room_fuse(&room, map, 2);
    assert_true(rlf_map_get_status(map).block_count > 100);
    rlf_free(file.data);
    rlf_map_destroy(&map);
}

TEST_EACH(set_up, NULL)
