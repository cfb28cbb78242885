/* The voxels right in front of the surface of a block, as a camera sees them. */
#include "kernel/fuse.h"

RLF_KERNEL int32_t rlf_kernel_splat_block(const rlf_fuse_block *block, const rlf_fuse_place *place,
                                          const rlf_splat_camera *camera,
                                          rlf_splat_point *restrict out)
{
    uint8_t is_front[RLF_FUSE_VOXELS];
    const int32_t most = (int32_t)RLF_FUSE_STEPS;
    for (int32_t i = 0; i < RLF_FUSE_VOXELS; i++) {
        int32_t d = block->distance[i];
        is_front[i] = (uint8_t)((d > 0) & (d <= most) & (block->weight[i] > 0));
    }
    int32_t count = 0;
    for (int32_t i = rlf_kernel_next_mark(is_front, 0, RLF_FUSE_VOXELS); i < RLF_FUSE_VOXELS;
         i = rlf_kernel_next_mark(is_front, i + 1, RLF_FUSE_VOXELS)) {
        out[count++].voxel = i;
    }
    for (int32_t i = 0; i < count; i++) {
        float at[3], in[3] = {(float)(out[i].voxel & 7), (float)(out[i].voxel >> 3 & 7),
                              (float)(out[i].voxel >> 6)};
        for (int32_t k = 0; k < 3; k++) {
            at[k] = place->origin[k] + in[0] * place->step[0][k] + in[1] * place->step[1][k] +
                    in[2] * place->step[2][k];
        }
        bool is_ahead = at[2] > 0.05f;
        float inverse = 1.0f / (is_ahead ? at[2] : 1.0f);
        out[i].u = camera->fx * at[0] * inverse + camera->cx;
        out[i].v = camera->fy * at[1] * inverse + camera->cy;
        out[i].z = is_ahead ? at[2] : 0.0f;
    }
    return count;
}
