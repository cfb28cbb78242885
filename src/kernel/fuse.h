/* fuse_block.c, fuse_view.c: a view of the room into blocks of a signed distance volume.
 * splat_block.c: out of them again. */
#ifndef RLF_KERNEL_FUSE_H
#define RLF_KERNEL_FUSE_H

#include "kernel/kernel.h"

enum { RLF_FUSE_SIDE = 8, RLF_FUSE_VOXELS = 512, RLF_FUSE_CHROMA = 64 };

/* Nothing nearer is fused or drawn, metres. */
#define RLF_FUSE_NEAREST_M 0.05f
/* Distances are kept in steps of 1 / 1024 of a voxel. */
#define RLF_FUSE_STEPS 1024.0f
/* Weight of a frame at the noise of the nearest depths; what is noisier has less, at least 1. */
#define RLF_FUSE_WEIGHT 16.0f
#define RLF_FUSE_WEIGHT_MOST 255.0f

/* Distance of a voxel that nobody saw: farther than any. */
#define RLF_FUSE_UNKNOWN INT16_MAX

/* 8 x 8 x 8 voxels, x fastest. */
typedef struct rlf_fuse_block {
    int16_t distance[RLF_FUSE_VOXELS];  /* steps; RLF_FUSE_UNKNOWN where the weight is 0 */
    uint8_t weight[RLF_FUSE_VOXELS];    /* 0 = nobody looked there */
    uint8_t grey[RLF_FUSE_VOXELS];      /* luma; 0 = no colour yet */
    uint8_t chroma[2][RLF_FUSE_CHROMA]; /* Cb and Cr of 2 x 2 x 2 voxels, 128 = grey */
} rlf_fuse_block;

/* The plane through a pixel's point: n . p = offset, n unit and towards the camera, so that offset
 * < 0. All 0 = there is none. */
typedef struct rlf_fuse_plane {
    float x, y, z, offset;
} rlf_fuse_plane;

/* A view, and how it is fused. */
typedef struct rlf_fuse_view {
    int32_t width, height;
    float fx, fy, cx, cy;
    const rlf_fuse_plane *planes; /* of the source's pixels */
    const float *least;           /* least depth of 3 x 3 pixels, 0 where one is missing */
    const uint8_t *rgba;          /* NULL = none */
    int32_t color_turn;           /* 0..3: which row of four gets its colour again */
    const int32_t *source_of; /* pixel of the planes above per pinhole pixel, -1 = none; or NULL */
    rlf_kernel_noise noise;
    float sigmas;                                   /* of truncation */
    float truncation_least, truncation_most, voxel; /* metres */
    float nearest_sigma;                            /* that has the whole weight, metres */
    float carve_weight; /* times a frame's weight: most that what is seen through keeps */
} rlf_fuse_view;

/* A block in the camera's frame: its first voxel, and the ways to the next in x, y, z, metres. */
typedef struct rlf_fuse_place {
    float origin[3], step[3][3];
} rlf_fuse_place;

/* The surface in one eighth of a block: the voxel right in front of it, by a voxel at most, its
 * distance, and the way out of the surface, which is 127 long; all 0 where that is not known. */
typedef struct rlf_fuse_patch {
    uint16_t voxel; /* RLF_FUSE_NO_VOXEL: there is none */
    uint8_t ahead;  /* 1/256 voxel */
    int8_t normal[3];
} rlf_fuse_patch;

#define RLF_FUSE_NO_VOXEL 0xffffu

/* What a block is after it: its least distance from any surface (magnitude), and its least signed
 * distance, steps; 32767 where nothing is known. */
typedef struct rlf_fuse_summary {
    int32_t nearest, lowest;
    rlf_fuse_patch front[8]; /* of each 4 x 4 x 4 voxels (bits x = 1, y = 2, z = 4) */
} rlf_fuse_summary;

/* False when it sees nothing of the block, which then stays as it is. */
bool rlf_kernel_fuse_block(const rlf_fuse_view *view, const rlf_fuse_place *place,
                           rlf_fuse_block *restrict block);
rlf_fuse_summary rlf_kernel_fuse_summary(const rlf_fuse_block *block);

/* ---- splat_block.c */

/* Focal lengths and principal point, pixels. */
typedef struct rlf_splat_camera {
    float fx, fy, cx, cy;
} rlf_splat_camera;

/* Where voxels are seen; z 0 = behind the camera. */
typedef struct rlf_splat_points {
    float u[RLF_FUSE_VOXELS], v[RLF_FUSE_VOXELS], z[RLF_FUSE_VOXELS];
    int32_t voxel[RLF_FUSE_VOXELS];
} rlf_splat_points;

/* Voxels in front of the surface, by less than one voxel; returns how many. */
int32_t rlf_kernel_splat_block(const rlf_fuse_block *restrict block,
                               const rlf_fuse_place *restrict place,
                               const rlf_splat_camera *restrict camera,
                               rlf_splat_points *restrict out);

/* ---- fuse_view.c */

/* A row of the picture; depth is sound: 0 = missing, else > 0. */
typedef struct rlf_fuse_row {
    const float *depth, *above, *below; /* two rows above and below, or the row itself */
    const float *ray_x, *ray_y;
    const float *ray_y_above, *ray_y_below, *ray_x_above, *ray_x_below;
    const uint8_t *is_static; /* or NULL */
    rlf_kernel_noise noise;
} rlf_fuse_row;

/* Planes from given normals. */
void rlf_kernel_fuse_planes(const rlf_fuse_row *row, const float *restrict nx,
                            const float *restrict ny, const float *restrict nz, int32_t count,
                            rlf_fuse_plane *restrict out);
/* Normals of the depth itself, from the pixels two to each side where they go on. */
void rlf_kernel_fuse_normals(const rlf_fuse_row *row, int32_t count, float *restrict nx,
                             float *restrict ny, float *restrict nz);
/* Least of three neighbours; 0 beside the ends. */
void rlf_kernel_fuse_least_row(const float *restrict depth, int32_t count, float *restrict out);
/* Least of three rows. */
void rlf_kernel_fuse_least(const float *restrict a, const float *restrict b,
                           const float *restrict c, int32_t count, float *restrict out);

#endif
