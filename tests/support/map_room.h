/* A wall with a ball in front of it, seen by a small camera: what tests of the map look at. */
#ifndef RLF_TEST_MAP_ROOM_H
#define RLF_TEST_MAP_ROOM_H

#include "relief/map.h"

#include <math.h>
#include <string.h>

enum { ROOM_WIDTH = 160, ROOM_HEIGHT = 120, ROOM_PIXELS = ROOM_WIDTH * ROOM_HEIGHT };

/* The wall is the plane z = 1.6 of the world. */
#define ROOM_WALL_Z 1.6
#define ROOM_BALL_RADIUS 0.25

typedef struct map_room {
    rlf_rig rig;
    bool has_ball;
    rlf_vec3 ball;
    float depth[ROOM_PIXELS];
    uint8_t rgba[4 * ROOM_PIXELS];
} map_room;

static inline void map_room_init(map_room *room)
{
    memset(room, 0, sizeof(*room));
    room->rig.depth = (rlf_camera){.width = ROOM_WIDTH,
                                   .height = ROOM_HEIGHT,
                                   .fx = 140.0,
                                   .fy = 141.0,
                                   .cx = 79.5,
                                   .cy = 59.0};
    room->rig.depth_min_m = 0.3;
    room->rig.depth_max_m = 5.0;
    room->rig.noise = (rlf_depth_noise){0.0005, 0.0, 0.0005};
    room->has_ball = true;
    room->ball = rlf_vec3_make(0.05, -0.02, 1.2);
}

/* A lens that bends by some pixels. */
static inline void map_room_bend(map_room *room)
{
    room->rig.depth.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    room->rig.depth.distortion[0] = 0.12;
    room->rig.depth.distortion[1] = -0.2;
}

/* Distance of a world point from the room, > 0 in free space. */
static inline double map_room_distance(const map_room *room, rlf_vec3 p)
{
    const double wall = ROOM_WALL_Z - p.z;
    const double ball = rlf_length(rlf_sub(p, room->ball)) - ROOM_BALL_RADIUS;
    return room->has_ball && ball < wall ? ball : wall;
}

/* Where a ray meets the room: t of eye + t way; 0 = nowhere. */
static inline double map_room_cast(const map_room *room, rlf_vec3 eye, rlf_vec3 way, bool *on_ball)
{
    double t = way.z > 1e-9 ? (ROOM_WALL_Z - eye.z) / way.z : 0.0;
    const rlf_vec3 to = rlf_sub(eye, room->ball);
    const double a = rlf_dot(way, way), b = rlf_dot(to, way);
    const double c = rlf_dot(to, to) - ROOM_BALL_RADIUS * ROOM_BALL_RADIUS, d = b * b - a * c;
    *on_ball = false;
    if (room->has_ball && d > 0.0) {
        const double near = (-b - sqrt(d)) / a;
        if (near > 0.0 && (t <= 0.0 || near < t)) {
            t = near;
            *on_ball = true;
        }
    }
    return t > 0.0 ? t : 0.0;
}

/* Fills depth and colour as seen from a pose: the ball is red, the wall grey. */
static inline rlf_map_view map_room_look(map_room *room, const rlf_pose *T_world_camera)
{
    for (int32_t i = 0; i < ROOM_PIXELS; i++) {
        rlf_vec3 ray;
        const bool has_ray =
            rlf_camera_unproject(&room->rig.depth, i % ROOM_WIDTH, i / ROOM_WIDTH, &ray);
        bool on_ball = false;
        const rlf_vec3 way = rlf_rotate(T_world_camera->q, ray);
        room->depth[i] =
            has_ray ? (float)map_room_cast(room, T_world_camera->p, way, &on_ball) : 0.0f;
        const uint8_t red[4] = {200, 60, 40, 255}, grey[4] = {120, 120, 120, 255};
        memcpy(&room->rgba[4 * i], on_ball ? red : grey, 4);
    }
    const rlf_map_view view = {.depth = room->depth, .rgba = room->rgba};
    return view;
}

/* The i-th of some poses that look at the ball from about the origin. */
static inline rlf_pose map_room_pose(int32_t i)
{
    const double turn = 0.03 * (i % 5 - 2), side = 0.04 * (i % 7 - 3);
    rlf_pose T = {.p = rlf_vec3_make(side, 0.02 * (i % 3 - 1), 0.01 * (i % 4))};
    T.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.4 * turn, turn - side * 0.8, 0.1 * turn));
    return T;
}

/* A map with that camera: 10 mm voxels, 64 MiB. */
static inline rlf_map_def map_room_def(const map_room *room)
{
    rlf_map_def def = rlf_map_def_default();
    def.rig = room->rig;
    def.voxel_m = 0.01;
    def.memory_mb = 64;
    return def;
}

/* Fuses `count` views. */
static inline void map_room_fuse(map_room *room, rlf_map *map, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        const rlf_pose T = map_room_pose(i);
        const rlf_map_view view = map_room_look(room, &T);
        (void)rlf_map_integrate(map, &view, &T, NULL);
    }
}

/* A file in memory. */
typedef struct map_bytes {
    uint8_t *data;
    size_t size, capacity, read;
} map_bytes;

static inline bool map_bytes_write(void *context, const void *data, size_t size)
{
    map_bytes *bytes = context;
    if (bytes->size + size > bytes->capacity) {
        return false;
    }
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
    return true;
}

static inline bool map_bytes_read(void *context, void *data, size_t size)
{
    map_bytes *bytes = context;
    if (size > bytes->size - bytes->read) {
        return false;
    }
    memcpy(data, bytes->data + bytes->read, size);
    bytes->read += size;
    return true;
}

/* The map as a file; free data with rlf_free. */
static inline map_bytes map_bytes_of(const rlf_map *map)
{
    map_bytes bytes = {.capacity = (size_t)rlf_map_get_status(map).block_count * 2200 + 64};
    bytes.data = rlf_alloc(bytes.capacity);
    if (bytes.data == NULL || rlf_map_save(map, map_bytes_write, &bytes) != RLF_OK) {
        bytes.size = 0;
    }
    return bytes;
}

static inline bool map_bytes_equal(const map_bytes *a, const map_bytes *b)
{
    return a->size == b->size && a->size > 0 && memcmp(a->data, b->data, a->size) == 0;
}

#endif
