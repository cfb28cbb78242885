/* Relief: the static room in world coordinates, from all views so far.
 *
 * A truncated signed distance volume in hashed blocks of 8 x 8 x 8 voxels: signed distance to the
 * nearest surface (positive in front of it, in free space), weight and colour per voxel. Frames are
 * fused with their poses; what a frame sees to be free is carved, so that furniture that left goes.
 *
 *      camera      free space      | front  surface  behind |      nobody knows
 *        o- - - - - - - - - - - - -|+++++++++++0-----------|- - - - - - - - - -
 *                                    truncation on both sides
 *
 * Source: Curless and Levoy 1996 (the volume); Newcombe et al. 2011, KinectFusion (live fusion and
 * prediction); Niessner et al. 2013 (hashed blocks).
 *
 * World = any right-handed frame in metres that the poses refer to; usually the first camera's.
 * Blocks reach 32767 blocks from its origin: 1.5 km at 6 mm.
 *
 * Thread-safety: one call at a time that changes a map. Calls that take a const map may run at the
 * same time as each other, not as one that changes it. Nothing depends on the number of threads.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_MAP_H
#define RELIEF_MAP_H

#include "relief/frame.h"
#include "relief/prediction.h"
#include "relief/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Voxels along each edge of a block. */
#define RLF_MAP_BLOCK 8
/* Most memory that a map can have, MiB. */
#define RLF_MAP_MEMORY_MOST_MB 16384

/* Settings of a map. Memory is taken in slabs as the room grows, and never more than memory_mb. */
typedef struct rlf_map_def {
    uint32_t cookie;   /* from rlf_map_def_default */
    rlf_rig rig;       /* of the frames to come; its depth camera, lens and noise; must be set */
    double voxel_m;    /* edge of a voxel, 0.002..0.05 metres; default 0.006 */
    int32_t memory_mb; /* most memory of blocks, 8..16384 MiB; default 288. When it is full, the
                          blocks farthest from the camera leave first */
    int32_t blocks_per_frame; /* most blocks that one frame is fused into; the others have their
                                 turn in the next ones. 0 = all. Default 768 */
    rlf_pool *pool;           /* borrowed; NULL = one thread */
} rlf_map_def;

/* The room. Made by rlf_map_create, gone by rlf_map_destroy. */
typedef struct rlf_map rlf_map;

/* Defaults as the fields say; rig is empty and must be set. */
RLF_API rlf_map_def rlf_map_def_default(void);

/* An empty map. RLF_ERROR_INVALID names the field that cannot be used; RLF_ERROR_MEMORY. */
RLF_API rlf_result rlf_map_create(const rlf_map_def *def, rlf_map **out);
/* Frees it and nulls the pointer. NULL and a NULL map are allowed. */
RLF_API void rlf_map_destroy(rlf_map **map);
/* Forgets everything: an empty map with the same settings. */
RLF_API void rlf_map_clear(rlf_map *map);

/* ---- fusion ---------------------------------------------------------------------------------- */

/* One view of the room. Planes have the rig's depth camera's size, row-major without padding, and
 * are only read during the call. */
typedef struct rlf_map_view {
    const float *depth; /* metres along z; <= 0 or not finite = missing */
    /* Unit normals towards the camera, (0, 0, 0) = none. NULL: found from the depth. */
    const float *normal_x, *normal_y, *normal_z;
    /* 1 = static room, 0 = not to be fused (a person, what moves). NULL = all is room. Space in
     * front of what is masked is carved all the same. */
    const uint8_t *is_static;
    /* Colour of each depth pixel (R, G, B, A; A = 0: none), 4 bytes a pixel. NULL = none. */
    const uint8_t *rgba;
} rlf_map_view;

/* What a frame did to the map, for logs and figures. */
typedef struct rlf_map_change {
    int32_t blocks_seen;    /* near the surface that the frame saw */
    int32_t blocks_fused;   /* that the frame was fused into */
    int32_t blocks_new;     /* for the first time */
    int32_t blocks_evicted; /* left, since the memory is full */
    int32_t blocks_carved;  /* found to be nothing but free space, and given back */
} rlf_map_change;

/* Fuses a view from a pose (camera to world). Only call it with a pose that is trusted: while the
 * tracker says that it tracks. A pose that is not finite or whose quaternion is not of unit length
 * (to 1 %) is RLF_ERROR_INVALID, and the map stays as it is. `out` may be NULL. Allocates nothing
 * but further slabs (RLF_ERROR_MEMORY: the map stays usable and does not grow).
 * Cost: about 3 us a block and 2 ms a frame, one core. */
RLF_API rlf_result rlf_map_integrate(rlf_map *map, const rlf_map_view *view,
                                     const rlf_pose *T_world_camera, rlf_map_change *out);

/* Says that all that was fused so far is right: rlf_map_take_back returns to here. Free. */
RLF_API void rlf_map_fence(rlf_map *map);
/* Brings back, bit for bit, what the map was at the last fence, or when it was made: for a pose
 * that proved to be wrong. False, with a warning in the log, when more has changed since than the
 * eighth of the memory that is kept for it; the fence had then moved by itself, to the frame at
 * which that was full, and the map is what it was there. */
RLF_API bool rlf_map_take_back(rlf_map *map);

/* ---- questions ------------------------------------------------------------------------------- */

/* What is known at a point. */
typedef enum rlf_map_state {
    RLF_MAP_UNKNOWN = 0, /* nobody has looked there, or it is deep inside of something */
    RLF_MAP_FREE = 1,    /* in front of a surface, or seen to be empty */
    RLF_MAP_INSIDE = 2   /* behind a surface, not deeper than the truncation */
} rlf_map_state;

/* Answer of rlf_map_sample. */
typedef struct rlf_map_point {
    rlf_map_state state; /* whether the place was seen, and what is there */
    /* Signed distance to the nearest surface, metres: > 0 FREE, <= 0 INSIDE. Cut at the truncation:
     * where is_far, the surface is at least that far. 0 when UNKNOWN. */
    double distance;
    /* Unit, out of the surface (the way in which distance grows); (0, 0, 0) when UNKNOWN or far
     * from any surface. */
    rlf_vec3 gradient;
    bool is_far; /* distance is cut, see above */
} rlf_map_point;

/* Distance and gradient at a world point: trilinear. About 0.1 us. */
RLF_API rlf_map_point rlf_map_sample(const rlf_map *map, rlf_vec3 p_world);
/* The distance within which rlf_map_sample is true on both sides of a near surface, metres. */
RLF_API double rlf_map_truncation(const rlf_map *map);

/* Predicts what `camera` (its distortion is left out) sees of the room from a pose. Planes of *out
 * are the map's and hold until its next prediction; camera.width x height must be within the rig's
 * depth camera's size. rlf_camera_decimate gives a smaller one: cost is about 0.06 us a pixel. A
 * pose that is not finite gives RLF_ERROR_INVALID. */
RLF_API rlf_result rlf_map_predict(rlf_map *map, const rlf_camera *camera,
                                   const rlf_pose *T_world_camera, rlf_prediction *out);

/* The colours (R, G, B, A) of the last prediction, 4 bytes a pixel, of its size; NULL when
 * there was none. For pictures; costs about as much as the prediction. */
RLF_API const uint8_t *rlf_map_predict_color(rlf_map *map);

/* Where a map stands. */
typedef struct rlf_map_status {
    double voxel_m;                      /* edge of a voxel, metres */
    int32_t block_count, block_capacity; /* in use, and at most */
    size_t bytes;                        /* of all memory that the map holds */
    int64_t frames;                      /* fused */
    rlf_aabb box; /* of all blocks, world, metres; empty when there are none */
    bool is_full; /* blocks have had to leave */
} rlf_map_status;

/* How large it is. Thread-safety: not while it is changed. */
RLF_API rlf_map_status rlf_map_get_status(const rlf_map *map);

/* Poses from which the map was seen, world from camera, at least 0.25 m or 15 degrees apart, 256 at
 * most; the map's, until it changes. They are kept in files. A tracker that comes into a known room
 * remembers what is predicted from there (rlf_tracker_remember). */
RLF_API const rlf_pose *rlf_map_get_viewpoints(const rlf_map *map, int32_t *out_count);

/* ---- mesh ------------------------------------------------------------------------------------ */

/* Triangles of the zero level, counter-clockwise as seen from free space. World frame, metres. */
typedef struct rlf_map_mesh {
    float *position;                     /* 3 a vertex */
    float *normal;                       /* 3 a vertex, unit, out of the surface */
    uint8_t *rgba;                       /* 4 a vertex; A = 0: nobody showed one */
    uint32_t *index;                     /* 3 a triangle */
    size_t vertex_count, triangle_count; /* 3 indices a triangle */
} rlf_map_mesh;

/* Marching cubes over all blocks (Lorensen and Cline 1987; ambiguous faces are parted the same way
 * on both sides, so that there are no cracks). Voxels of less than min_weight (1..255) are left
 * out: a frame from near by adds 16, one from far or aslant down to 1. Free with
 * rlf_map_mesh_destroy. Thread-safety: as a const map. */
RLF_API rlf_result rlf_map_mesh_create(const rlf_map *map, int32_t min_weight, rlf_map_mesh *out);
/* Frees the arrays and zeroes the struct. NULL and a zeroed one are allowed. */
RLF_API void rlf_map_mesh_destroy(rlf_map_mesh *mesh);

/* ---- files ----------------------------------------------------------------------------------- */

/* Takes `size` bytes; false = stop, an error. */
typedef bool (*rlf_map_write_fn)(void *context, const void *data, size_t size);
/* Gives exactly `size` bytes; false = there are not so many. */
typedef bool (*rlf_map_read_fn)(void *context, void *data, size_t size);

/* Writes the map: version, settings, blocks, checksum; little endian (docs/moving-camera.md has the
 * layout). RLF_ERROR_IO when `write` stops. */
RLF_API rlf_result rlf_map_save(const rlf_map *map, rlf_map_write_fn write, void *context);
/* Replaces what the map holds. The file's voxel size is taken over. RLF_ERROR_FORMAT: it is no map,
 * of another version, cut short or damaged; RLF_ERROR_CAPACITY: more than memory_mb holds. The map
 * is then empty. Nothing that a file says is believed before it is checked. */
RLF_API rlf_result rlf_map_load(rlf_map *map, rlf_map_read_fn read, void *context);

#ifdef __cplusplus
}
#endif
#endif
