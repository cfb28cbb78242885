/* A frame's depth in metres. */
#include "info/depth_plane.h"

void info_depth_plane(const rlf_frame *frame, float *out)
{
    const int32_t width = frame->rig->depth.width;
    const int32_t height = frame->rig->depth.height;
    for (ptrdiff_t y = 0; y < height; y++) {
        const unsigned char *base = frame->depth_u16 != NULL
                                        ? (const unsigned char *)frame->depth_u16
                                        : (const unsigned char *)frame->depth_f32;
        const void *row = base + y * frame->depth_stride;
        for (int32_t x = 0; x < width; x++) {
            const double z = frame->depth_u16 != NULL
                                 ? ((const uint16_t *)row)[x] / frame->depth_units_per_metre
                                 : (double)((const float *)row)[x];
            *out++ = z > 0.0 && z < 1000.0 ? (float)z : 0.0f;
        }
    }
}
