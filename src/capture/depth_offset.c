/* A copy of the depth plane, since that of the frame is the device's. */
#include "capture/depth_checks.h"

size_t depth_offset_size(const rlf_rig *rig)
{
    const size_t pixels = (size_t)rig->depth.width * (size_t)rig->depth.height;
    return rig->depth_offset_m != 0.0 ? pixels * sizeof(float) : 0;
}

static void take_counts(const rlf_rig *rig, const rlf_frame *frame, uint16_t *out)
{
    const double exact = rig->depth_offset_m * frame->depth_units_per_metre;
    const int32_t offset = (int32_t)(exact + (exact < 0.0 ? -0.5 : 0.5));
    for (int32_t y = 0; y < rig->depth.height; y++) {
        const char *row = (const char *)frame->depth_u16 + y * frame->depth_stride;
        const uint16_t *in = (const uint16_t *)(const void *)row;
        for (int32_t x = 0; x < rig->depth.width; x++) {
            const int32_t value = in[x] - offset;
            const bool is_known = in[x] > 0 && value > 0;
            *out++ = (uint16_t)(!is_known ? 0 : value < UINT16_MAX ? value : UINT16_MAX);
        }
    }
}

static void take_metres(const rlf_rig *rig, const rlf_frame *frame, float *out)
{
    const float offset = (float)rig->depth_offset_m;
    for (int32_t y = 0; y < rig->depth.height; y++) {
        const char *row = (const char *)frame->depth_f32 + y * frame->depth_stride;
        const float *in = (const float *)(const void *)row;
        for (int32_t x = 0; x < rig->depth.width; x++) {
            *out++ = in[x] > 0.0F && in[x] > offset ? in[x] - offset : 0.0F;
        }
    }
}

void depth_offset_take(const rlf_rig *rig, void *plane, rlf_frame *frame)
{
    if (frame->depth_u16 != NULL) {
        take_counts(rig, frame, plane);
        frame->depth_u16 = plane;
        frame->depth_stride = (ptrdiff_t)rig->depth.width * (ptrdiff_t)sizeof(uint16_t);
    } else if (frame->depth_f32 != NULL) {
        take_metres(rig, frame, plane);
        frame->depth_f32 = plane;
        frame->depth_stride = (ptrdiff_t)rig->depth.width * (ptrdiff_t)sizeof(float);
    }
}
