/* The map: a wall and a ball seen from some places give true distances, predictions and triangles;
 * what leaves is carved; wrong poses are refused or taken back; memory is bounded. */

#include "map_room.h"
#include "created.h"
#include "test.h"

static map_room room;
static rlf_map *map; /* gone after the test */

static void fuse(int32_t count)
{
    rlf_map_def def = map_room_def(&room);
    map = map_of(&def);
    map_room_fuse(&room, map, count);
}

static int set_up(void **state)
{
    (void)state;
    map_room_init(&room);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    rlf_map_destroy(&map);
    assert_null(map);
    return 0;
}

/* Points about the front of the ball and before the wall. */
static void check_distances(double most_mean_m)
{
    double sum = 0.0, angle = 0.0;
    int32_t count = 0;
    for (int32_t i = 0; i < 400; i++) {
        const double u = 0.04 * (i % 20 - 10), v = 0.04 * (i / 20 - 10);
        rlf_vec3 p = rlf_vec3_make(room.ball.x + u, room.ball.y + v, 0.0);
        bool on_ball;
        const rlf_vec3 ahead = rlf_vec3_make(0, 0, 1);
        p.z = map_room_cast(&room, p, ahead, &on_ball) + 0.004 * (i % 7 - 3);
        const double off2 = u * u + v * v;
        if (room.has_ball && off2 > 0.18 * 0.18 && off2 < 0.38 * 0.38) {
            continue; /* near its outline, where it is seen aslant, and in its shadow */
        }
        const rlf_map_point s = rlf_map_sample(map, p);
        const double truth = map_room_distance(&room, p);
        assert_int_not_equal(s.state, RLF_MAP_UNKNOWN);
        assert_true(fabs(s.distance - truth) < 0.004);
        sum += fabs(s.distance - truth);
        const rlf_vec3 out = rlf_normalize(rlf_sub(p, room.ball));
        angle += rlf_dot(s.gradient, on_ball ? out : rlf_vec3_make(0, 0, -1));
        count++;
    }
    assert_true(count > 120);
    assert_true(sum / count < most_mean_m);
    assert_true(angle / count > 0.99);
}

TEST_CASE(distances_and_gradients_are_those_of_the_room)
{
    fuse(12);
    check_distances(0.001);
    assert_int_equal(rlf_map_sample(map, rlf_vec3_make(0, 0, 3.0)).state, RLF_MAP_UNKNOWN);
    assert_int_equal(rlf_map_sample(map, rlf_vec3_make(1e300, 0, 0)).state, RLF_MAP_UNKNOWN);
    assert_int_equal(rlf_map_sample(map, rlf_vec3_make(NAN, 0, 0)).state, RLF_MAP_UNKNOWN);
}

TEST_CASE(a_bent_lens_gives_the_same_room)
{
    map_room_bend(&room);
    fuse(12);
    check_distances(0.001);
}

/* From a pose that was not fused. */
TEST_CASE(a_prediction_is_what_is_there)
{
    fuse(12);
    const rlf_pose T = {.p = rlf_vec3_make(0.03, 0.01, 0.06),
                        .q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.02, -0.03, 0.05))};
    rlf_prediction p;
    assert_int_equal(rlf_map_predict(map, &room.rig.depth, &T, &p), RLF_OK);
    (void)map_room_look(&room, &T);
    int32_t count = 0, wrong = 0, missing = 0, inner = 0, grey = 0;
    double sum = 0.0;
    for (int32_t y = 10; y < ROOM_HEIGHT - 10; y++) {
        for (int32_t x = 10; x < ROOM_WIDTH - 10; x++) {
            const int32_t i = y * ROOM_WIDTH + x;
            inner++;
            if (p.depth[i] == 0.0f) {
                missing++;
                continue;
            }
            const double off = fabs((double)p.depth[i] - (double)room.depth[i]);
            const double size =
                (double)(p.normal_x[i] * p.normal_x[i] + p.normal_y[i] * p.normal_y[i] +
                         p.normal_z[i] * p.normal_z[i]);
            assert_true(fabs(size - 1.0) < 1e-3);
            assert_true(p.normal_z[i] < 0.3f);
            grey += p.grey[i] > 0;
            wrong += off > 0.01;
            sum += off < 0.01 ? off : 0.0;
            count++;
        }
    }
    assert_true(missing < inner / 25 && grey > inner * 9 / 10);
    assert_true(wrong < inner / 25); /* the ball's outline */
    assert_true(sum / count < 0.0012);
    const uint8_t *rgba = rlf_map_predict_color(map);
    const int32_t middle = (ROOM_HEIGHT / 2) * ROOM_WIDTH + ROOM_WIDTH / 2;
    assert_true(rgba[4 * middle] > 150 && rgba[4 * middle + 2] < 100);
}

/* Share of the pixels of a smaller camera whose depth is predicted to 4 mm, of 100. */
static int32_t percent_predicted(const rlf_pose *T)
{
    rlf_prediction p;
    const rlf_camera small = rlf_camera_decimate(&room.rig.depth, 4);
    int32_t right = 0, all = 0;
    assert_int_equal(rlf_map_predict(map, &small, T, &p), RLF_OK);
    for (int32_t y = 1; y + 1 < small.height; y++) {
        for (int32_t x = 1; x + 1 < small.width; x++) {
            rlf_vec3 ray;
            bool on_ball;
            assert_true(rlf_camera_unproject(&small, x, y, &ray));
            const double z = map_room_cast(&room, T->p, rlf_rotate(T->q, ray), &on_ball);
            right += fabs((double)p.depth[y * small.width + x] - z) < 0.004;
            all++;
        }
    }
    return 100 * right / all;
}

/* The wall lies right on voxels of each of these sizes; a pixel is 11 mm and more. */
TEST_CASE(one_frame_is_enough_with_voxels_finer_than_pixels)
{
    const double voxels[] = {0.004, 0.01, 0.05};
    const double turns[] = {0.0, 0.6};
    room.has_ball = false;
    for (int32_t i = 0; i < 6; i++) {
        rlf_map_def def = map_room_def(&room);
        def.voxel_m = voxels[i % 3];
        map = map_of(&def);
        const rlf_pose T = {.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0, turns[i / 3], 0))};
        const rlf_map_view view = map_room_look(&room, &T);
        assert_int_equal(rlf_map_integrate(map, &view, &T, NULL), RLF_OK);
        const int32_t percent = percent_predicted(&T);
        if (percent < 90) {
            fail_msg("voxel %g, turned by %g: %d %% predicted", def.voxel_m, turns[i / 3],
                     (int)percent);
        }
        rlf_map_destroy(&map);
    }
}

TEST_CASE(the_mesh_is_the_surface_and_has_no_cracks)
{
    fuse(12);
    rlf_map_mesh mesh;
    assert_int_equal(rlf_map_mesh_create(map, 1, &mesh), RLF_OK);
    assert_true(mesh.triangle_count > 1000);
    double sum = 0.0;
    int32_t towards = 0;
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        const float *q = &mesh.position[3 * i], *n = &mesh.normal[3 * i];
        const rlf_vec3 p = {(double)q[0], (double)q[1], (double)q[2]};
        const double off = fabs(map_room_distance(&room, p));
        assert_true(off < 0.05);
        sum += off;
        towards += rlf_dot(p, rlf_vec3_make((double)n[0], (double)n[1], (double)n[2])) < 0.0;
    }
    assert_true(sum / (double)mesh.vertex_count < 0.002);
    assert_true(towards > (int32_t)(0.97 * (double)mesh.vertex_count));
    /* Each directed edge at most once: a manifold whose triangles agree about their side. */
    const size_t slots = 1u << 20;
    assert_true(3 * mesh.triangle_count < slots / 2);
    uint64_t *seen = rlf_alloc_array(slots, sizeof(uint64_t));
    for (size_t i = 0; i < 3 * mesh.triangle_count; i++) {
        const uint32_t a = mesh.index[i], b = mesh.index[i % 3 == 2 ? i - 2 : i + 1];
        assert_true(a < mesh.vertex_count && b < mesh.vertex_count && a != b);
        const uint64_t key = (uint64_t)a << 32 | (b + 1);
        size_t at = (size_t)(key * 0x9e3779b97f4a7c15u >> 44);
        for (; seen[at] != 0; at = (at + 1) % slots) {
            assert_true(seen[at] != key);
        }
        seen[at] = key;
    }
    rlf_free(seen);
    rlf_map_mesh_destroy(&mesh);
    assert_null(mesh.position);
}

static size_t ball_vertices(void)
{
    rlf_map_mesh mesh;
    size_t count = 0;
    assert_int_equal(rlf_map_mesh_create(map, 1, &mesh), RLF_OK);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        count += (double)mesh.position[3 * i + 2] < ROOM_WALL_Z - 0.06;
    }
    rlf_map_mesh_destroy(&mesh);
    return count;
}

TEST_CASE(what_leaves_is_carved)
{
    fuse(40);
    const size_t before = ball_vertices();
    assert_true(before > 500);
    room.has_ball = false;
    map_room_fuse(&room, map, 80);
    assert_int_equal(ball_vertices(), 0);
    const rlf_vec3 front = {room.ball.x, room.ball.y, room.ball.z - ROOM_BALL_RADIUS};
    assert_int_equal(rlf_map_sample(map, front).state, RLF_MAP_UNKNOWN); /* its blocks are back */
    check_distances(0.001); /* of the wall, also where the ball had hidden it */
}

TEST_CASE(what_is_masked_is_not_fused)
{
    rlf_map_def def = map_room_def(&room);
    map = map_of(&def);
    static uint8_t is_static[ROOM_PIXELS];
    for (int32_t i = 0; i < 8; i++) {
        const rlf_pose T = map_room_pose(i);
        rlf_map_view view = map_room_look(&room, &T);
        for (int32_t k = 0; k < ROOM_PIXELS; k++) {
            is_static[k] = room.rgba[4 * k] < 150;
        }
        view.is_static = is_static;
        assert_int_equal(rlf_map_integrate(map, &view, &T, NULL), RLF_OK);
    }
    assert_int_equal(ball_vertices(), 0);
    assert_true(rlf_map_get_status(map).block_count > 100);
}

TEST_CASE(a_bad_pose_is_refused_and_a_wrong_one_is_taken_back)
{
    fuse(10);
    rlf_map_fence(map);
    map_bytes before = map_bytes_of(map);
    rlf_pose T = map_room_pose(0);
    rlf_map_view view = map_room_look(&room, &T);
    const rlf_pose bad[4] = {{{0, NAN, 0}, {0, 0, 0, 1}},
                             {{0, 0, 0}, {0, 0, 0, 0}},
                             {{0, 0, 0}, {0, NAN, 0, 1}},
                             {{1e30, 0, 0}, {0, 0, 0, 1}}};
    rlf_prediction p;
    for (int32_t i = 0; i < 4; i++) {
        assert_int_equal(rlf_map_integrate(map, &view, &bad[i], NULL), RLF_ERROR_INVALID);
        assert_int_equal(rlf_map_predict(map, &room.rig.depth, &bad[i], &p), RLF_ERROR_INVALID);
    }
    map_bytes after = map_bytes_of(map);
    assert_true(map_bytes_equal(&before, &after));
    rlf_free(after.data);
    for (int32_t i = 0; i < 6; i++) {
        T.p.z += 0.1; /* wrong: the wall is smeared, the ball doubled */
        assert_int_equal(rlf_map_integrate(map, &view, &T, NULL), RLF_OK);
    }
    after = map_bytes_of(map);
    assert_false(map_bytes_equal(&before, &after));
    rlf_free(after.data);
    assert_true(rlf_map_take_back(map));
    after = map_bytes_of(map);
    assert_true(map_bytes_equal(&before, &after));
    assert_int_equal(rlf_map_get_status(map).frames, 10);
    rlf_free(after.data);
    rlf_free(before.data);
}

TEST_CASE(memory_is_bounded_and_the_farthest_leave)
{
    rlf_map_def def = map_room_def(&room);
    def.memory_mb = 8;
    def.voxel_m = 0.006;
    map = map_of(&def);
    rlf_map_change change;
    int32_t evicted = 0;
    for (int32_t i = 0; i < 24; i++) {
        rlf_pose T = map_room_pose(0);
        T.p.x = 0.15 * i;
        const rlf_map_view view = map_room_look(&room, &T);
        assert_int_equal(rlf_map_integrate(map, &view, &T, &change), RLF_OK);
        evicted += change.blocks_evicted;
    }
    const rlf_map_status s = rlf_map_get_status(map);
    assert_true(s.is_full && evicted > 0);
    assert_true(s.block_count <= s.block_capacity);
    assert_true(s.bytes < 12u << 20);
    assert_int_equal(rlf_map_sample(map, rlf_vec3_make(-0.3, 0, ROOM_WALL_Z)).state,
                     RLF_MAP_UNKNOWN);
    assert_int_not_equal(rlf_map_sample(map, rlf_vec3_make(3.4, 0, ROOM_WALL_Z)).state,
                         RLF_MAP_UNKNOWN);
}

/* What it leaves behind makes room for what the camera sees then. */
TEST_CASE(a_frame_that_alone_fills_the_memory_does_not_stay)
{
    rlf_map_def def = map_room_def(&room);
    def.memory_mb = 8;
    def.voxel_m = 0.003;
    map = map_of(&def);
    rlf_map_change change;
    for (int32_t i = 0; i < 3; i++) {
        rlf_pose T = map_room_pose(0);
        T.p.x = 5.0 * i;
        const rlf_map_view view = map_room_look(&room, &T);
        assert_int_equal(rlf_map_integrate(map, &view, &T, &change), RLF_OK);
        assert_true(rlf_map_get_status(map).block_count > 3000);
        assert_true(change.blocks_new > 3000);
        assert_true((change.blocks_evicted > 0) == (i > 0));
    }
}

TEST_CASE(the_number_of_threads_changes_nothing)
{
    map_bytes bytes[2];
    for (int32_t i = 0; i < 2; i++) {
        rlf_map_def def = map_room_def(&room);
        def.pool = pool_of(1 + 2 * i);
        map = map_of(&def);
        map_room_fuse(&room, map, 6);
        bytes[i] = map_bytes_of(map);
        rlf_map_destroy(&map);
        rlf_pool_destroy(&def.pool);
    }
    assert_true(map_bytes_equal(&bytes[0], &bytes[1]));
    rlf_free(bytes[0].data);
    rlf_free(bytes[1].data);
}

TEST_CASE(a_picture_without_depth_does_no_harm)
{
    fuse(6);
    map_bytes before = map_bytes_of(map);
    for (int32_t i = 0; i < ROOM_PIXELS; i++) {
        const float bad[4] = {0.0f, NAN, -1.0f, INFINITY};
        room.depth[i] = bad[i % 4];
    }
    const rlf_map_view view = {.depth = room.depth};
    const rlf_pose T = rlf_pose_identity();
    assert_int_equal(rlf_map_integrate(map, &view, &T, NULL), RLF_OK);
    map_bytes after = map_bytes_of(map);
    assert_true(map_bytes_equal(&before, &after));
    rlf_free(before.data);
    rlf_free(after.data);
}

TEST_EACH(set_up, tear_down)
