/* A room like a box with things in it, as depth pictures, as a map and as the grid of a camera that
 * turns. World: the room's middle, y down. */
#ifndef RLF_TEST_MAPPED_ROOM_H
#define RLF_TEST_MAPPED_ROOM_H

#include "relief/map.h"
#include "relief/world.h"
#include "pinhole.h"

#include <string.h>

enum { MAPPED_W = 160, MAPPED_H = 120, MAPPED_PIXELS = MAPPED_W * MAPPED_H };

#define MAPPED_F 110.0 /* 72 x 57 degrees */
#define MAPPED_FLOOR 1.0
#define MAPPED_WALL 2.0 /* in all four ways */
#define MAPPED_CEILING (-1.2)

typedef struct mapped_room {
    rlf_aabb solids[4]; /* what stands in the room */
    int32_t solid_count;
    rlf_rig rig;
    float ray_x[MAPPED_PIXELS], ray_y[MAPPED_PIXELS];
    float depth[MAPPED_PIXELS], normal[3][MAPPED_PIXELS]; /* as last seen */
    rlf_grid grid;
} mapped_room;

static inline bool mapped_room_project(const void *context, rlf_vec3 p, double *u, double *v)
{
    (void)context;
    *u = MAPPED_F * p.x / p.z + 0.5 * (MAPPED_W - 1);
    *v = MAPPED_F * p.y / p.z + 0.5 * (MAPPED_H - 1);
    return p.z > 1e-6 && *u > -0.5 && *v > -0.5 && *u < MAPPED_W - 0.5 && *v < MAPPED_H - 0.5;
}

static inline void mapped_room_init(mapped_room *room)
{
    memset(room, 0, sizeof(*room));
    room->rig.depth = pinhole(MAPPED_W, MAPPED_H, MAPPED_F);
    room->rig.depth_min_m = 0.2;
    room->rig.depth_max_m = 8.0;
    room->rig.noise = (rlf_depth_noise){0.001, 0.0, 0.0};
    for (int32_t i = 0; i < MAPPED_PIXELS; i++) {
        room->ray_x[i] = (float)((i % MAPPED_W - 0.5 * (MAPPED_W - 1)) / MAPPED_F);
        room->ray_y[i] = (float)((i / MAPPED_W - 0.5 * (MAPPED_H - 1)) / MAPPED_F);
    }
    rlf_grid *grid = &room->grid;
    grid->width = MAPPED_W;
    grid->height = MAPPED_H;
    grid->ray_x = room->ray_x;
    grid->ray_y = room->ray_y;
    grid->project = mapped_room_project;
    grid->pixel_angle = 1.0 / MAPPED_F;
    grid->background = (rlf_grid_sheet){.depth = room->depth,
                                        .normal_x = room->normal[0],
                                        .normal_y = room->normal[1],
                                        .normal_z = room->normal[2],
                                        .default_thickness = 0.3};
}

/* Where a way comes into a box, or leaves it from within: t, and the face's normal towards where it
 * comes from. */
static inline double mapped_room_meet(const rlf_aabb *box, bool is_within, rlf_vec3 eye,
                                      rlf_vec3 way, rlf_vec3 *normal)
{
    const double low[3] = {box->min.x, box->min.y, box->min.z}, e[3] = {eye.x, eye.y, eye.z};
    const double high[3] = {box->max.x, box->max.y, box->max.z}, w[3] = {way.x, way.y, way.z};
    double in = -1e9, out = 1e9;
    int32_t axis_in = 0, axis_out = 0;
    for (int32_t k = 0; k < 3; k++) {
        double step = w[k] < 1e-12 && w[k] > -1e-12 ? 1e-12 : w[k];
        double a = (low[k] - e[k]) / step, b = (high[k] - e[k]) / step;
        double near = rlf_min(a, b), far = rlf_max(a, b);
        axis_in = near > in ? k : axis_in;
        axis_out = far < out ? k : axis_out;
        in = rlf_max(in, near);
        out = rlf_min(out, far);
    }
    int32_t axis = is_within ? axis_out : axis_in;
    double n[3] = {0, 0, 0};
    n[axis] = w[axis] > 0.0 ? -1.0 : 1.0;
    *normal = rlf_vec3_make(n[0], n[1], n[2]);
    return is_within ? out : (in > 0.0 && in < out ? in : 1e9);
}

/* Depth, normals and pose as seen from T. */
static inline void mapped_room_look(mapped_room *room, const rlf_pose *T_world_camera)
{
    const rlf_aabb shell = {{-MAPPED_WALL, MAPPED_CEILING, -MAPPED_WALL},
                            {MAPPED_WALL, MAPPED_FLOOR, MAPPED_WALL}};
    const rlf_quat to_camera = rlf_quat_conjugate(T_world_camera->q);
    for (int32_t i = 0; i < MAPPED_PIXELS; i++) {
        rlf_vec3 ray = rlf_vec3_make((double)room->ray_x[i], (double)room->ray_y[i], 1.0), normal;
        rlf_vec3 way = rlf_rotate(T_world_camera->q, ray);
        double t = mapped_room_meet(&shell, true, T_world_camera->p, way, &normal);
        for (int32_t k = 0; k < room->solid_count; k++) {
            rlf_vec3 face;
            double near = mapped_room_meet(&room->solids[k], false, T_world_camera->p, way, &face);
            normal = near < t ? face : normal;
            t = rlf_min(t, near);
        }
        normal = rlf_rotate(to_camera, normal);
        room->depth[i] = (float)t;
        room->normal[0][i] = (float)normal.x;
        room->normal[1][i] = (float)normal.y;
        room->normal[2][i] = (float)normal.z;
    }
    room->grid.T_world_grid = *T_world_camera;
    room->grid.time_ns += 33333333;
}

/* At `eye`, turned to the right by `yaw` and down by `pitch`, radians. */
static inline rlf_pose mapped_room_pose(rlf_vec3 eye, double yaw, double pitch)
{
    rlf_quat turn = rlf_quat_from_rotation_vector(rlf_vec3_make(0, yaw, 0));
    rlf_quat nod = rlf_quat_from_rotation_vector(rlf_vec3_make(-pitch, 0, 0));
    return (rlf_pose){eye, rlf_quat_mul(turn, nod)};
}

/* Looks about from `eye` and fuses what is seen. */
static inline void mapped_room_fuse(mapped_room *room, rlf_map *map, rlf_vec3 eye)
{
    const double pitches[3] = {0.1, 0.7, 1.4};
    for (int32_t i = 0; i < 18; i++) {
        rlf_pose T = mapped_room_pose(eye, (i % 8) * (RLF_PI / 4.0), pitches[i / 8]);
        mapped_room_look(room, &T);
        const rlf_map_view view = {
            room->depth, room->normal[0], room->normal[1], room->normal[2], NULL, NULL};
        (void)rlf_map_integrate(map, &view, &T, NULL);
    }
}

/* A map of voxels of 2 cm, seen from two places. */
static inline rlf_map *mapped_room_map(mapped_room *room)
{
    rlf_map_def def = rlf_map_def_default();
    rlf_map *map = NULL;
    def.rig = room->rig;
    def.voxel_m = 0.02;
    def.memory_mb = 128;
    def.blocks_per_frame = 0;
    if (rlf_map_create(&def, &map) == RLF_OK) {
        mapped_room_fuse(room, map, rlf_vec3_make(0.2, 0.0, -0.9));
        mapped_room_fuse(room, map, rlf_vec3_make(-0.2, 0.0, 1.7));
    }
    return map;
}

#endif
