/* The volume inside of rlf_map: blocks, where they are, and what was before the last fence.
 *
 * Voxel (i, j, k) is the sample at the world point (i, j, k) * voxel_m; block (a, b, c) has the
 * voxels 8 a .. 8 a + 7 and so on. A cell is the cube between eight voxels; its lowest corner names
 * it, so that the cells of a block reach into the blocks after it. */
#ifndef RLF_MAP_VOLUME_H
#define RLF_MAP_VOLUME_H

#include "base/arena.h"
#include "kernel/fuse.h"
#include "math/rigid.h"
#include "relief/map.h"

/* Least and most truncation, voxels. */
#define MAP_TRUNCATION_LEAST 4.0
#define MAP_TRUNCATION_MOST 8.0

typedef struct rlf_fuse_block map_block;

enum { MAP_SIDE = RLF_MAP_BLOCK, MAP_VOXELS = RLF_FUSE_VOXELS, MAP_SLAB = 256 };

/* Memory that grows in slabs of MAP_SLAB blocks; the list of them is of the arena. */
typedef struct map_slabs {
    map_block **slab;
    int32_t slab_count, slab_capacity;
} map_slabs;

/* Most poses from which a map knows that it was seen. */
#define MAP_VIEWPOINTS 256

/* A place in the table of blocks; block < 0 = nobody there. */
typedef struct map_entry {
    uint64_t key;
    int32_t block;
} map_entry;

/* Flags of a block. */
enum {
    MAP_LIVE = 1,
    MAP_HAS_SURFACE = 2,
    MAP_IS_EMPTY = 4, /* of what was known before: all is free, or nothing is known */
    MAP_IS_NEW = 8    /* made by this frame */
};

/* All blocks. Those of a count that never ran so high yet are not in the free list. */
typedef struct map_volume {
    int32_t capacity, count,
        high; /* blocks that may be, that are, and the highest index ever + 1 */
    map_slabs slabs;
    int16_t (*place)[4]; /* of each block, in blocks */
    int32_t (*after)[8]; /* neighbours by bits x = 1, y = 2, z = 4; itself at 0; -1 = none */
    uint32_t *marked;    /* the frame that saw it last */
    uint32_t *kept;      /* the epoch in which the journal took it */
    uint8_t *flags;
    rlf_fuse_patch (*front)[8];
    int32_t *free_list;
    int32_t free_count;
    map_entry *table;
    uint32_t table_mask;
} map_volume;

/* What a block was at the fence; slot < 0: there was none. */
typedef struct map_memo {
    int16_t place[4];
    int32_t slot;
} map_memo;

/* Blocks as they were at the last fence, taken when they are first touched after it. */
typedef struct map_journal {
    uint32_t epoch;
    map_slabs slabs;
    int32_t slot_capacity, slot_count;
    map_memo *memo;
    int32_t memo_count, memo_capacity;
    int64_t frames; /* at the fence */
    int32_t viewpoint_count;
    bool has_moved; /* the fence had to move by itself */
} map_journal;

/* Planes of the last prediction. */
typedef struct map_view_planes {
    float *depth, *normal[3];
    uint8_t *grey;
    uint8_t *rgba;
    int32_t *start;  /* block of the voxel drawn at a pixel */
    float *tile_far; /* per tile of a prediction, the depth beyond which there is no surface */
    rlf_prediction last;
} map_view_planes;

struct rlf_map {
    rlf_map_def def;
    rlf_arena arena; /* all but the blocks */
    map_volume volume;
    map_journal journal;
    rlf_camera pinhole; /* the rig's depth camera without its distortion */
    int32_t *source_of; /* pixel of the rig's picture that a pinhole's pixel is; NULL = the same */
    float *ray_x, *ray_y;     /* of the rig's pixels; 0, 0 = none */
    rlf_fuse_plane *planes;   /* of the view, on the rig's grid */
    float *clean, *scratch;   /* sound depth; three rows of floats per worker */
    float *row_least, *least; /* least depth of 1 x 3 and of 3 x 3 pixels */
    int32_t *seen, *chosen;   /* blocks of this frame */
    int32_t seen_count, chosen_count;
    int32_t carve_cursor;
    rlf_pose viewpoint[MAP_VIEWPOINTS]; /* world from camera */
    int32_t viewpoint_count;
    int64_t frames;
    uint32_t tick; /* counts frames, also those that were taken back */
    bool is_full;
    map_view_planes out;
};

static inline int32_t map_floor(double x)
{
    const int32_t i = (int32_t)x;
    return x < (double)i ? i - 1 : i;
}
/* Along an axis, the block of a voxel. */
static inline int32_t map_block_of(int32_t voxel)
{
    return (voxel - (voxel & 7)) / MAP_SIDE;
}

/* ---- blocks.c */
void map_slabs_take(map_slabs *slabs, rlf_arena *arena, int32_t blocks);
bool map_slabs_reserve(map_slabs *slabs, int32_t count);
void map_slabs_free(map_slabs *slabs);
static inline map_block *map_slabs_at(const map_slabs *slabs, int32_t i)
{
    return &slabs->slab[i / MAP_SLAB][i % MAP_SLAB];
}
static inline map_block *map_block_at(const map_volume *v, int32_t i)
{
    return map_slabs_at(&v->slabs, i);
}
static inline uint64_t map_key(int32_t x, int32_t y, int32_t z)
{
    return (uint64_t)(uint16_t)(x + 32768) << 32 | (uint64_t)(uint16_t)(y + 32768) << 16 |
           (uint64_t)(uint16_t)(z + 32768);
}
/* Its tables; map_volume_clear makes them true. Blocks are the caller's: map_slabs_free. */
void map_volume_take(map_volume *v, rlf_arena *arena, int32_t capacity);
void map_volume_clear(map_volume *v);
/* -1 = none. */
int32_t map_volume_find(const map_volume *v, int32_t x, int32_t y, int32_t z);
/* Before it is looked for: brings its entry near. */
void map_volume_soon(const map_volume *v, int32_t x, int32_t y, int32_t z);
/* A new, empty block at a place where there is none; -1: no room, or no memory. */
int32_t map_volume_add(map_volume *v, int32_t x, int32_t y, int32_t z);
void map_volume_remove(map_volume *v, int32_t block);
/* Makes table, neighbours and flags true again for one block whose voxels were written whole. */
void map_block_look(map_volume *v, int32_t block);
/* Writes the blocks in the order of their keys to `out`, `count` of them; false without memory. */
bool map_volume_sorted(const map_volume *v, int32_t *out);

/* ---- journal.c */
void map_journal_take(map_journal *j, rlf_arena *arena, int32_t slots, int32_t blocks);
/* Before a frame that changes so many blocks: moves the fence when they are too many. */
void map_journal_expect(rlf_map *map, int32_t count);
/* Before a block is changed or removed, or after it was added. */
void map_journal_keep(rlf_map *map, int32_t block, bool is_new);

/* ---- view.c */
/* Planes and least depths of a view. */
void map_view_prepare(rlf_map *map, const rlf_map_view *view);

/* ---- sample.c */
/* The cell whose lowest corner is voxel (i, j, k) of a block; corners by bits x = 1, y = 2, z = 4.
 */
typedef struct map_cell {
    float distance[8]; /* voxels */
    uint8_t weight[8];
    const map_block *block[8];
    int16_t voxel[8]; /* index in its block */
} map_cell;
/* False when one of its voxels is unknown. */
bool map_cell_read(const map_volume *v, int32_t block, int32_t i, int32_t j, int32_t k,
                   map_cell *out);
/* Trilinear value of a cell's corners at a place in 0..1 within it, and its gradient. */
static inline float map_cell_value(const float d[8], const float in[3], float gradient[3])
{
    const float x = in[0], y = in[1], z = in[2];
    /* Along x, then y, then z. */
    const float a0 = d[0] + x * (d[1] - d[0]), a1 = d[2] + x * (d[3] - d[2]);
    const float a2 = d[4] + x * (d[5] - d[4]), a3 = d[6] + x * (d[7] - d[6]);
    const float b0 = a0 + y * (a1 - a0), b1 = a2 + y * (a3 - a2);
    const float x0 = (d[1] - d[0]) + y * ((d[3] - d[2]) - (d[1] - d[0]));
    const float x1 = (d[5] - d[4]) + y * ((d[7] - d[6]) - (d[5] - d[4]));
    gradient[0] = x0 + z * (x1 - x0);
    gradient[1] = (a1 - a0) + z * ((a3 - a2) - (a1 - a0));
    gradient[2] = b1 - b0;
    return b0 + z * (b1 - b0);
}
/* The block of the voxel nearest to a point, or -1; the voxel's index in it. */
int32_t map_voxel_near(const rlf_map *map, rlf_vec3 p, int32_t *out_voxel);
/* Grey and colour of a voxel; A = 0 when it has none. */
void map_voxel_color(const map_block *block, int32_t voxel, uint8_t rgba[4]);

/* ---- map.c */
/* From a point to the middle of the block at a place, world, metres. */
static inline rlf_vec3 map_block_way(const rlf_map *map, const int16_t place[4], rlf_vec3 from)
{
    const double side = map->def.voxel_m * MAP_SIDE;
    return rlf_vec3_make((place[0] + 0.5) * side - from.x, (place[1] + 0.5) * side - from.y,
                         (place[2] + 0.5) * side - from.z);
}
/* The pose becomes a viewpoint, unless one is near already, or there is no room. */
void map_viewpoints_add(rlf_map *map, const rlf_pose *T_world_camera);

/* ---- mark.c */
/* Fills map->seen with the blocks near the surfaces that the view's planes show; makes those that
 * there are not yet. When the memory is full, the farthest leave. */
void map_mark(rlf_map *map, const rlf_pose *T_world_camera, rlf_map_change *change);

/* ---- predict.c, splat.c: a view of the volume; what is drawn says where each ray begins */
#define MAP_TILE 8 /* pixels */

/* A camera that casts: world to voxels. */
typedef struct map_caster {
    const rlf_map *map;
    rlf_camera camera;
    rlf_mat3 R_world_camera, R_camera_world;
    rlf_vec3 eye; /* world, metres */
    /* In voxels: the eye, the way of pixel (0, 0)'s ray for a metre of depth, and what it gains
     * from pixel to pixel. */
    float at[3], way[3], way_x[3], way_y[3];
    float to_eighth[8][3]; /* from a block's corner to the middles of its eighths, camera frame */
    float step[3][3];      /* by voxels along x, y, z, camera frame, metres */
    map_view_planes *out;
    float per_metre; /* voxels */
    int32_t tile_columns;
    float slack; /* metres behind a drawn voxel where its surface still may be */
} map_caster;

/* Draws the blocks with a surface: farthest depth per tile, and into the plane of depth, per pixel,
 * one over the depth at which its ray may meet the nearest surface; 0 where there is none. */
void map_splat(map_caster *caster);

#endif
