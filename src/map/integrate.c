/* A view into the volume: the blocks near what it sees, then those that it sees through. */
#include "camera/pixels.h"
#include "map/volume.h"

#include <stddef.h>
#include <string.h>

enum {
    CARVE_FRAMES = 8, /* in which every block is asked once whether it is seen through; who fuses
                         into all blocks asks all of them in each */
    GRAIN = 32        /* blocks */
};

/* Distances are true up to this many sigma(z) of a surface. */
#define TRUNCATION_SIGMAS 4.0f
/* Frames that must see through a voxel before what was there is gone. */
#define CARVE_AFTER 4.0f

typedef struct fuse_job {
    rlf_map *map;
    rlf_mat3 R_camera_world;
    rlf_pose T_world_camera;
    rlf_fuse_view view;
    int32_t turns; /* frames in which each block that is seen is fused once */
    rlf_map_change change;
} fuse_job;

static rlf_fuse_view view_make(const rlf_map *map, const rlf_map_view *in, int32_t turns)
{
    const rlf_camera *c = &map->pinhole;
    const rlf_map_def *def = &map->def;
    const float voxel = (float)def->voxel_m;
    const rlf_fuse_view view = {
        .width = c->width,
        .height = c->height,
        .fx = (float)c->fx,
        .fy = (float)c->fy,
        .cx = (float)c->cx,
        .cy = (float)c->cy,
        .planes = map->planes,
        .least = map->least,
        .rgba = in->rgba,
        .color_turn = (int32_t)(map->frames / turns & 3),
        .source_of = map->source_of,
        .noise = rlf_kernel_noise_make(&def->rig.noise),
        .sigmas = TRUNCATION_SIGMAS,
        .truncation_least = (float)MAP_TRUNCATION_LEAST * voxel,
        .truncation_most = (float)MAP_TRUNCATION_MOST * voxel,
        .voxel = voxel,
        .nearest_sigma = (float)rlf_depth_noise_sigma(&def->rig.noise, 1.0),
        /* A mean of c parts old and one part new passes zero after (c + 1/2) ln 2 frames. */
        .carve_weight = 1.4427f * CARVE_AFTER - 0.5f,
    };
    return view;
}

/* Frames in which each block that is seen has its turn. */
static int32_t turns_for(const rlf_map *map)
{
    const int32_t budget = map->def.blocks_per_frame;
    return budget > 0 && map->seen_count > 0 ? (map->seen_count - 1) / budget + 1 : 1;
}

/* Those that are new, and as many of the others as there is time for, in turn. */
static void choose_seen(fuse_job *job)
{
    rlf_map *map = job->map;
    const int32_t turns = job->turns, turn = (int32_t)(map->frames % turns);
    map->chosen_count = 0;
    for (int32_t i = 0; i < map->seen_count; i++) {
        const int32_t block = map->seen[i];
        const bool is_new = (map->volume.flags[block] & MAP_IS_NEW) != 0;
        if (is_new || block % turns == turn) {
            map->chosen[map->chosen_count++] = block;
        }
    }
}

/* Whether a block's middle is in front of what its pixel sees. */
static bool is_seen_through(const fuse_job *job, int32_t block)
{
    const rlf_map *map = job->map;
    const rlf_vec3 way = map_block_way(map, map->volume.place[block], job->T_world_camera.p);
    const rlf_vec3 p = rlf_mat3_mul_vec(&job->R_camera_world, way);
    const int32_t pixel = p.z > 0.1 ? camera_pixel_of(&map->def.rig.depth, p) : -1;
    return pixel >= 0 && map->clean[pixel] > p.z;
}

static void choose_carved(fuse_job *job)
{
    rlf_map *map = job->map;
    const map_volume *v = &map->volume;
    const bool has_time = map->def.blocks_per_frame == 0;
    const int32_t budget = has_time ? v->capacity : map->def.blocks_per_frame / 4 + 1;
    const int32_t share = has_time ? v->high : v->high / CARVE_FRAMES + 1;
    int32_t cursor = !has_time && map->carve_cursor < v->high ? map->carve_cursor : 0;
    const int32_t end = cursor + share < v->high ? cursor + share : v->high;
    const int32_t most = map->chosen_count + budget;
    for (; cursor < end && map->chosen_count < most; cursor++) {
        if ((v->flags[cursor] & MAP_LIVE) && v->marked[cursor] != map->tick &&
            is_seen_through(job, cursor)) {
            map->chosen[map->chosen_count++] = cursor;
        }
    }
    map->carve_cursor = cursor;
}

/* Brings a block's distances and weights near. */
static void look_ahead(const map_block *block)
{
    const char *at = (const char *)block;
    const ptrdiff_t size = offsetof(map_block, grey);
    for (ptrdiff_t i = 0; i < size; i += 64) {
        RLF_KERNEL_SOON(at + i);
    }
}

static void fuse_blocks(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const fuse_job *job = context;
    rlf_map *map = job->map;
    const double voxel = map->def.voxel_m, side = voxel * MAP_SIDE;
    const rlf_mat3 *R = &job->R_camera_world;
    rlf_fuse_place place;
    (void)worker;
    for (int32_t k = 0; k < 9; k++) {
        place.step[k / 3][k % 3] = (float)(R->m[k % 3][k / 3] * voxel);
    }
    for (int32_t i = begin; i < end; i++) {
        const int32_t block = map->chosen[i];
        if (i + 1 < end) {
            look_ahead(map_block_at(&map->volume, map->chosen[i + 1]));
        }
        const int16_t *at = map->volume.place[block];
        const rlf_vec3 corner = {at[0] * side, at[1] * side, at[2] * side};
        const rlf_vec3 p = rlf_mat3_mul_vec(R, rlf_sub(corner, job->T_world_camera.p));
        place.origin[0] = (float)p.x;
        place.origin[1] = (float)p.y;
        place.origin[2] = (float)p.z;
        if (rlf_kernel_fuse_block(&job->view, &place, map_block_at(&map->volume, block)) ||
            (map->volume.flags[block] & MAP_IS_NEW) != 0) {
            map_block_look(&map->volume, block);
        }
    }
}

/* Blocks that are nothing but free space, or of which nothing became known, are given back. */
static void give_back_empty(fuse_job *job)
{
    rlf_map *map = job->map;
    for (int32_t i = 0; i < map->chosen_count; i++) {
        const int32_t block = map->chosen[i];
        const uint8_t flags = map->volume.flags[block];
        map->volume.flags[block] = flags & (uint8_t)~MAP_IS_NEW;
        if ((flags & MAP_IS_EMPTY) != 0) {
            job->change.blocks_carved += (flags & MAP_IS_NEW) != 0 ? 0 : 1;
            map_volume_remove(&map->volume, block);
        }
    }
}

rlf_result rlf_map_integrate(rlf_map *map, const rlf_map_view *view, const rlf_pose *T_world_camera,
                             rlf_map_change *out)
{
    if (!RLF_ASSERT(map != NULL && view != NULL && T_world_camera != NULL) ||
        !RLF_ASSERT(view->depth != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (!math_pose_is_sound(T_world_camera)) {
        return rlf_fail(RLF_ERROR_INVALID, "map: the camera's pose is not finite or its quaternion "
                                           "is not of unit length: the frame is left out");
    }
    fuse_job job = {.map = map, .T_world_camera = *T_world_camera};
    job.T_world_camera.q = rlf_quat_normalize(T_world_camera->q);
    job.R_camera_world = rlf_quat_to_mat3(rlf_quat_conjugate(job.T_world_camera.q));
    map->tick++;
    map_view_prepare(map, view);
    map_mark(map, &job.T_world_camera, &job.change);
    job.turns = turns_for(map);
    job.view = view_make(map, view, job.turns);
    choose_seen(&job);
    choose_carved(&job);
    map_journal_expect(map, map->chosen_count);
    for (int32_t i = 0; i < map->chosen_count; i++) {
        map_journal_keep(map, map->chosen[i], false);
    }
    rlf_parallel_for(map->def.pool, map->chosen_count, GRAIN, fuse_blocks, &job);
    give_back_empty(&job);
    map_viewpoints_add(map, &job.T_world_camera);
    map->frames++;
    job.change.blocks_seen = map->seen_count;
    job.change.blocks_fused = map->chosen_count;
    if (out != NULL) {
        *out = job.change;
    }
    return RLF_OK;
}
