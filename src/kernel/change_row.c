/* What has become of the pixels of one row since they were last seen. */
#include "kernel/kernel.h"

/* Share of the depth, beside four sigmas: the step that counts as a depth edge. */
static const float least_share = 0.03f, least_sigmas = 4.0f;

RLF_KERNEL void rlf_kernel_change_row(rlf_kernel_noise noise, const float *restrict depth,
                                      const float *restrict mean, const float *restrict frames,
                                      int32_t count, uint8_t *restrict change)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i];
        float limit = least_share * z + least_sigmas * rlf_kernel_sigma(noise, z);
        bool moved = (frames[i] > 0.0f || frames[i] < 0.0f) &&
                     rlf_kernel_abs(z * (1.0f - z * mean[i])) > limit;
        int32_t seen = moved ? RLF_CHANGE_MOVED : RLF_CHANGE_STILL;
        change[i] = (uint8_t)(z > 0.0f ? seen : RLF_CHANGE_UNSEEN);
    }
}

RLF_KERNEL void rlf_kernel_moved_row(const float *restrict from, const float *restrict to,
                                     float share, float least, int32_t count,
                                     uint8_t *restrict moved)
{
    enum { CHUNK = 128 };
    for (int32_t first = 0; first < count; first += CHUNK) {
        int32_t size = count - first < CHUNK ? count - first : CHUNK, is_far[CHUNK];
        for (int32_t k = 0; k < size; k++) {
            float z = from[first + k];
            bool is_off = rlf_kernel_abs(to[first + k] - z) > share * z + least;
            is_far[k] = (z > 0.0f ? 1 : 0) & (is_off ? 1 : 0);
        }
        for (int32_t k = 0; k < size; k++) { /* apart, because bytes make longer vectors */
            moved[first + k] = (uint8_t)is_far[k];
        }
    }
}
