/* The tracker and the map together, where the camera sees nothing, jumps, or looks at what is not
 * the room. The room: walls and three boxes with patches of grey. */

#include "pipeline/moving/moving.h"
#include "analytic.h"
#include "created.h"
#include "pinhole.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 256, HEIGHT = 212, PIXELS = WIDTH * HEIGHT, LEARNED = 16 };

#define FRAME_NS 33333333
#define FOUND_M 0.1 /* the map of so few frames is itself some centimetres off */

static const rlf_aabb room = {{-1.4, -1.0, -1.0}, {1.5, 0.9, 2.6}};
static const rlf_aabb boxes[] = {{{-1.1, 0.2, 1.6}, {-0.4, 0.9, 2.2}},
                                 {{0.2, 0.4, 1.2}, {0.8, 0.9, 1.6}},
                                 {{0.8, -0.5, 1.9}, {1.4, 0.9, 2.5}}};

typedef struct fixture {
    rlf_rig rig;
    rlf_map *map;
    camera_pose camera;
    rlf_surface surface;
    float depth[PIXELS], normal[3][PIXELS], ray_x[PIXELS], ray_y[PIXELS];
    uint8_t grey[PIXELS], rgba[4 * PIXELS];
    int64_t time_ns;
    double walker; /* z of a plate before a window, which has no depth; 0 = there is no window */
} fixture;

static fixture f;

static double axis(rlf_vec3 v, int k)
{
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

static uint8_t patch(rlf_vec3 p)
{
    const int32_t x = (int32_t)floor(p.x / 0.3), y = (int32_t)floor(p.y / 0.3),
                  z = (int32_t)floor(p.z / 0.3);
    const uint32_t hash =
        (uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u ^ (uint32_t)z * 83492791u;
    return (uint8_t)(60 + (hash >> 3) % 140);
}

/* The normal of a box at a point on it, towards the camera. */
static rlf_vec3 normal_at(const rlf_aabb *b, rlf_vec3 p, rlf_vec3 way)
{
    double least = 1e9;
    rlf_vec3 n = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        const double d =
            rlf_min(fabs(axis(p, k) - axis(b->min, k)), fabs(axis(p, k) - axis(b->max, k)));
        if (d < least) {
            const double sign = axis(way, k) > 0.0 ? -1.0 : 1.0;
            least = d;
            n = rlf_vec3_make(k == 0 ? sign : 0.0, k == 1 ? sign : 0.0, k == 2 ? sign : 0.0);
        }
    }
    return n;
}

/* The window is in the wall ahead; the plate fills its middle. */
static void add_walker(int32_t i, rlf_vec3 from, rlf_vec3 way, rlf_vec3 seen)
{
    const rlf_vec3 p = rlf_mad(from, way, (f.walker - from.z) / way.z);
    if (f.walker > 0.0 && fabs(seen.x) < 0.4 && seen.z > room.max.z - 0.01) {
        f.depth[i] = fabs(p.x) < 0.2 && p.y > -0.5 && p.y < 0.3 ? (float)f.walker : 0.0f;
        f.normal[0][i] = f.normal[1][i] = 0.0f;
        f.normal[2][i] = -1.0f;
    }
}

static void look(const rlf_pose *T)
{
    for (int32_t i = 0; i < PIXELS; i++) {
        const rlf_vec3 ray = {(double)f.ray_x[i], (double)f.ray_y[i], 1.0};
        const rlf_vec3 way = rlf_rotate(T->q, ray);
        const rlf_aabb *nearest = &room;
        double in, leave, z;
        (void)box_ray(&room, T->p, way, &in, &z);
        for (size_t k = 0; k < sizeof(boxes) / sizeof(boxes[0]); k++) {
            if (box_ray(&boxes[k], T->p, way, &in, &leave) && in > 0.0 && in < z) {
                nearest = &boxes[k];
                z = in;
            }
        }
        const rlf_vec3 p = rlf_mad(T->p, way, z);
        const rlf_vec3 n = rlf_rotate(rlf_quat_conjugate(T->q), normal_at(nearest, p, way));
        f.depth[i] = (float)z;
        f.normal[0][i] = (float)n.x;
        f.normal[1][i] = (float)n.y;
        f.normal[2][i] = (float)n.z;
        f.grey[i] = patch(rlf_mad(p, way, -1e-6));
        add_walker(i, T->p, way, p);
        memset(&f.rgba[4 * (ptrdiff_t)i], f.grey[i], 3);
        f.rgba[4 * (ptrdiff_t)i + 3] = 255;
    }
}

/* The frame at hand into tracker and map, as the pipeline does it. */
static rlf_track_health feed(void)
{
    f.time_ns += FRAME_NS;
    f.surface.time_ns = f.time_ns;
    assert_int_equal(camera_pose_find(&f.camera, f.map, &f.surface, f.grey, f.time_ns), RLF_OK);
    if (f.camera.may_fuse) {
        static uint8_t is_static[PIXELS];
        camera_pose_mark_static(&f.camera, &f.surface, is_static);
        const rlf_map_view view = {.depth = f.depth,
                                   .normal_x = f.normal[0],
                                   .normal_y = f.normal[1],
                                   .normal_z = f.normal[2],
                                   .is_static = is_static,
                                   .rgba = f.rgba};
        assert_int_equal(rlf_map_integrate(f.map, &view, &f.camera.last.T_world_camera, NULL),
                         RLF_OK);
    }
    return f.camera.last.health;
}

static rlf_pose turned(double yaw)
{
    return (rlf_pose){{0.1 * rlf_sin(yaw), 0.0, 0.0},
                      rlf_quat_from_rotation_vector(rlf_vec3_make(0.0, yaw, 0.0))};
}

static void open_room(void)
{
    memset(&f, 0, sizeof(f));
    f.rig.depth = pinhole(WIDTH, HEIGHT, 183.0);
    f.rig.depth_min_m = 0.3;
    f.rig.depth_max_m = 8.0;
    f.rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    for (int32_t i = 0; i < PIXELS; i++) {
        f.ray_x[i] = (float)((i % WIDTH - f.rig.depth.cx) / f.rig.depth.fx);
        f.ray_y[i] = (float)((i / WIDTH - f.rig.depth.cy) / f.rig.depth.fy);
    }
    f.surface = (rlf_surface){.width = WIDTH,
                              .height = HEIGHT,
                              .depth = f.depth,
                              .ray_x = f.ray_x,
                              .ray_y = f.ray_y,
                              .camera = f.rig.depth};
    rlf_map_def def = rlf_map_def_default();
    def.rig = f.rig;
    def.voxel_m = 0.02;
    def.memory_mb = 64;
    f.map = map_of(&def);
    assert_int_equal(camera_pose_open(&f.camera, &f.rig, NULL), RLF_OK);
}

/* A map of what a slow turn to the right shows, and the camera at its end. */
static void begin(void)
{
    open_room();
    for (int i = 0; i < LEARNED; i++) {
        const rlf_pose T = turned(0.02 * i);
        look(&T);
        assert_int_equal(feed(), RLF_TRACK_GOOD);
    }
}

static int end(void **state)
{
    (void)state;
    camera_pose_close(&f.camera);
    rlf_map_destroy(&f.map);
    return 0;
}

static double off(const rlf_pose *T)
{
    return rlf_length(rlf_sub(f.camera.last.T_world_camera.p, T->p));
}

/* Blind for a second, and turned to another side when it sees again. */
TEST_CASE(test_a_camera_that_was_blind_is_found_again)
{
    begin();
    for (int k = 0; k < 4; k++) {
        memset(f.depth, 0, sizeof(f.depth));
        memset(f.grey, 0, sizeof(f.grey));
        assert_int_equal(feed(), RLF_TRACK_LOST);
        f.time_ns += 1000000000;
        rlf_pose T = turned(0.05 + 0.07 * k);
        T.p.y -= 0.04;
        T.q = rlf_quat_mul(T.q, rlf_quat_from_rotation_vector(rlf_vec3_make(0.08, -0.12, 0.0)));
        look(&T);
        int frames = 1;
        while (feed() != RLF_TRACK_GOOD && frames < 10) {
            frames++;
        }
        assert_int_equal(f.camera.last.health, RLF_TRACK_GOOD);
        assert_true(off(&T) < FOUND_M);
    }
}

/* What the map says of places on the walls. */
static double told(void)
{
    double sum = 0.0;
    for (int32_t i = 0; i < 400; i++) {
        const rlf_vec3 p = {-1.3 + 0.006 * i, -0.8 + 0.003 * i, 2.59};
        sum += rlf_map_sample(f.map, p).distance;
    }
    return sum;
}

/* A wall that is no part of the room, no depth, and depth that is no depth: nothing is fused, and
 * when the room is seen again, it is as it was. */
TEST_CASE(test_what_is_not_the_room_leaves_the_map_alone)
{
    begin();
    memset(f.depth, 0, sizeof(f.depth));
    (void)feed();
    const double before = told();
    for (int k = 0; k < 12; k++) {
        for (int32_t i = 0; i < PIXELS; i++) {
            f.depth[i] = k % 3 == 0 ? 1.0f : k % 3 == 1 ? NAN : 0.6f + 0.002f * (float)(i % WIDTH);
            f.grey[i] = 128;
        }
        (void)feed();
        assert_false(f.camera.may_fuse);
    }
    assert_true(told() == before);
    const rlf_pose T = turned(0.2);
    look(&T);
    f.time_ns -= 5000000000; /* a jump back in time */
    for (int k = 0; k < 10; k++) {
        (void)feed();
    }
    assert_true(f.camera.may_fuse && off(&T) < FOUND_M);
}

/* The last frames before the track is lost may have been wrong: they are taken back. */
TEST_CASE(test_what_was_fused_before_the_loss_is_taken_back)
{
    begin();
    rlf_map_fence(f.map);
    f.camera.since_fence = 0;
    const double before = told();
    const rlf_pose T = turned(0.02 * (LEARNED - 1));
    for (int k = 0; k < 3; k++) {
        look(&T);
        for (int32_t i = 0; i < PIXELS; i++) {
            f.depth[i] *= 1.004f; /* as a pose would that slips */
        }
        (void)feed();
    }
    assert_true(told() != before);
    memset(f.depth, 0, sizeof(f.depth));
    assert_int_equal(feed(), RLF_TRACK_LOST);
    assert_true(told() == before);
}

/* The same frame again and again: hard edges of brightness and what is fused meanwhile do not move
 * the camera. */
TEST_CASE(test_a_camera_at_rest_keeps_its_pose)
{
    const rlf_pose T = rlf_pose_identity();
    open_room();
    look(&T);
    for (int k = 0; k < 100; k++) {
        assert_int_equal(feed(), RLF_TRACK_GOOD);
        assert_true(off(&T) < 1e-4);
    }
}

/* Who walks away before a window leaves nothing behind him. */
TEST_CASE(test_who_walks_is_not_fused)
{
    const rlf_pose T = rlf_pose_identity();
    open_room();
    int32_t fused = 0;
    for (int k = 0; k < 60; k++) {
        f.walker = 0.9 + 0.025 * k;
        look(&T);
        assert_int_equal(feed(), RLF_TRACK_GOOD);
    }
    for (double z = 1.0; z < 2.4; z += 0.01) {
        const rlf_vec3 p = {0.0, 0.0, z};
        fused += rlf_map_sample(f.map, p).state == RLF_MAP_INSIDE;
    }
    assert_true(fused == 0);
}

TEST_EACH(NULL, end)
