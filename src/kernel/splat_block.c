/* The voxels right in front of the surface of a block, as a camera sees them. */
#include "kernel/fuse.h"

RLF_KERNEL int32_t rlf_kernel_splat_block(const rlf_fuse_block *restrict block,
                                          const rlf_fuse_place *restrict place,
                                          const rlf_splat_camera *restrict camera,
                                          rlf_splat_points *restrict out)
{
    uint8_t is_front[RLF_FUSE_VOXELS];
    const int16_t most = (int16_t)RLF_FUSE_STEPS;
    for (int32_t i = 0; i < RLF_FUSE_VOXELS; i++) {
        int16_t d = block->distance[i];
        is_front[i] = (uint8_t)((d > 0) & (d <= most));
    }
    int32_t count = 0;
    for (int32_t i = rlf_kernel_next_mark(is_front, 0, RLF_FUSE_VOXELS); i < RLF_FUSE_VOXELS;
         i = rlf_kernel_next_mark(is_front, i + 1, RLF_FUSE_VOXELS)) {
        out->voxel[count++] = i;
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t voxel = out->voxel[i];
        float a = (float)(voxel & 7), b = (float)(voxel >> 3 & 7), c = (float)(voxel >> 6);
        float x = place->origin[0] + a * place->step[0][0] + b * place->step[1][0] +
                  c * place->step[2][0];
        float y = place->origin[1] + a * place->step[0][1] + b * place->step[1][1] +
                  c * place->step[2][1];
        float z = place->origin[2] + a * place->step[0][2] + b * place->step[1][2] +
                  c * place->step[2][2];
        float inverse = 1.0f / (z > RLF_FUSE_NEAREST_M ? z : RLF_FUSE_NEAREST_M);
        out->u[i] = camera->fx * x * inverse + camera->cx;
        out->v[i] = camera->fy * y * inverse + camera->cy;
        out->z[i] = z > RLF_FUSE_NEAREST_M ? z : 0.0f;
    }
    return count;
}
