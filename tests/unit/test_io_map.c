/* Files of `relief run`: the map itself, and its mesh as .ply, .obj and .glb. */

#include "map_room.h"
#include "relief/io.h"
#include "test.h"

#include <stdio.h>

static map_room room;

static rlf_map *made(void)
{
    map_room_init(&room);
    rlf_map_def def = map_room_def(&room);
    def.memory_mb = 16;
    rlf_map *map = NULL;
    assert_int_equal(rlf_map_create(&def, &map), RLF_OK);
    map_room_fuse(&room, map, 2);
    return map;
}

static long size_of(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const long size = ftell(file);
    assert_int_equal(fclose(file), 0);
    return size;
}

TEST_CASE(a_map_file_comes_back)
{
    rlf_map *map = made();
    map_bytes before = map_bytes_of(map);
    assert_int_equal(rlf_map_write_file(map, "test_io_map.map"), RLF_OK);
    rlf_map_clear(map);
    assert_int_equal(rlf_map_read_file(map, "test_io_map.map"), RLF_OK);
    map_bytes after = map_bytes_of(map);
    assert_true(map_bytes_equal(&before, &after));
    assert_int_equal(rlf_map_read_file(map, "no_such.map"), RLF_ERROR_IO);
    assert_int_equal(rlf_file_write("test_io_map.map", "RLFMAP\r\n no", 11), RLF_OK);
    assert_int_equal(rlf_map_read_file(map, "test_io_map.map"), RLF_ERROR_FORMAT);
    assert_non_null(strstr(rlf_error_text(), "test_io_map.map"));
    (void)remove("test_io_map.map");
    rlf_free(before.data);
    rlf_free(after.data);
    rlf_map_destroy(&map);
}

TEST_CASE(meshes_are_written_by_their_names)
{
    rlf_map *map = made();
    rlf_map_mesh mesh;
    assert_int_equal(rlf_map_mesh_create(map, 1, &mesh), RLF_OK);
    assert_int_equal(rlf_map_mesh_write("test_io_map.stl", &mesh), RLF_ERROR_INVALID);
    const char *const names[3] = {"test_io_map.ply", "test_io_map.obj", "test_io_map.glb"};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(rlf_map_mesh_write(names[i], &mesh), RLF_OK);
        assert_true(size_of(names[i]) > (long)(24 * mesh.vertex_count + 12 * mesh.triangle_count));
    }
    for (int i = 1; i < 3; i++) { /* another program's reader takes them */
        rlf_model *model = NULL;
        const rlf_result result = rlf_model_load(names[i], &model);
        if (result != RLF_ERROR_UNSUPPORTED) {
            assert_int_equal(result, RLF_OK);
            rlf_model_destroy(&model);
        }
    }
    for (int i = 0; i < 3; i++) {
        (void)remove(names[i]);
    }
    rlf_map_mesh_destroy(&mesh);
    rlf_map_destroy(&map);
}
