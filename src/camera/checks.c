/* Checks of poses, rigs and frames. */
#include "camera/checks.h"

#include <stdio.h>

#define STRIDE_MAX ((ptrdiff_t)1 << 30) /* bytes: no picture's, but a wrong number's */

rlf_result pose_check(const rlf_pose *T, const char *who, const char *field)
{
    const rlf_quat q = T->q;
    if (!rlf_vec3_is_finite(T->p) || !rlf_is_finite(q.x) || !rlf_is_finite(q.y) ||
        !rlf_is_finite(q.z) || !rlf_is_finite(q.w)) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %s is not finite; use metres and a unit quaternion",
                        who, field);
    }
    return RLF_OK;
}

static rlf_result check_camera(const rlf_camera *camera, const char *who, const char *field)
{
    char text[128];
    (void)snprintf(text, sizeof(text), "%s: %s", who, field);
    return rlf_camera_check(camera, text);
}

rlf_result rig_check(const rlf_rig *rig, const char *who)
{
    rlf_result result = check_camera(&rig->depth, who, "rig.depth");
    if (result == RLF_OK && rig->has_color) {
        result = check_camera(&rig->color, who, "rig.color");
    }
    if (result == RLF_OK && rig->has_color) {
        result = pose_check(&rig->T_color_depth, who, "rig.T_color_depth");
    }
    const struct {
        const char *name;
        double value;
    } numbers[] = {
        {"depth_min_m", rig->depth_min_m},
        {"depth_max_m", rig->depth_max_m},
        {"depth_offset_m", rig->depth_offset_m},
        {"noise.c0", rig->noise.c0},
        {"noise.c1", rig->noise.c1},
        {"noise.c2", rig->noise.c2},
    };
    for (size_t i = 0; result == RLF_OK && i < sizeof(numbers) / sizeof(numbers[0]); i++) {
        if (!(numbers[i].value >= -1000.0 && numbers[i].value <= 1000.0)) {
            result = rlf_fail(RLF_ERROR_INVALID, "%s: rig.%s is %g; use -1000 to 1000", who,
                              numbers[i].name, numbers[i].value);
        }
    }
    return result;
}

static bool is_stride(ptrdiff_t stride, ptrdiff_t least)
{
    return stride >= least && stride <= STRIDE_MAX;
}

static rlf_result fail_stride(const rlf_frame *frame, const char *who, const char *field,
                              ptrdiff_t stride, ptrdiff_t least, int unit)
{
    return rlf_fail(
        RLF_ERROR_INVALID, "%s: frame %llu: %s is %lld; use at least %lld bytes, a multiple of %d",
        who, (unsigned long long)frame->sequence, field, (long long)stride, (long long)least, unit);
}

static rlf_result check_depth(const rlf_frame *frame, const rlf_rig *rig, const char *who)
{
    if ((frame->depth_u16 == NULL) == (frame->depth_f32 == NULL)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: set exactly one of depth_u16 and depth_f32", who,
                        (unsigned long long)frame->sequence);
    }
    const int sample = frame->depth_u16 != NULL ? 2 : 4;
    const ptrdiff_t least = sample * (ptrdiff_t)rig->depth.width;
    if (!is_stride(frame->depth_stride, least) || frame->depth_stride % sample != 0) {
        return fail_stride(frame, who, "depth_stride", frame->depth_stride, least, sample);
    }
    const double units = frame->depth_units_per_metre;
    if (frame->depth_u16 != NULL && (!(units > 0.0) || !rlf_is_finite(units))) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: depth_units_per_metre is %g; use 1000 for mm", who,
                        (unsigned long long)frame->sequence, units);
    }
    if (frame->confidence != NULL && !is_stride(frame->confidence_stride, rig->depth.width)) {
        return fail_stride(frame, who, "confidence_stride", frame->confidence_stride,
                           rig->depth.width, 1);
    }
    return RLF_OK;
}

rlf_result color_check(const rlf_frame *frame, const char *who)
{
    const rlf_image_rgba8 *color = &frame->color;
    if (color->data == NULL) {
        return RLF_OK;
    }
    if (color->width < 1 || color->height < 1 || color->width > RLF_IMAGE_SIZE_MAX ||
        color->height > RLF_IMAGE_SIZE_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: color.width x height is %d x %d; use 1 to %d", who,
                        (unsigned long long)frame->sequence, (int)color->width, (int)color->height,
                        RLF_IMAGE_SIZE_MAX);
    }
    const ptrdiff_t least = 4 * (ptrdiff_t)color->width;
    return is_stride(color->stride, least)
               ? RLF_OK
               : fail_stride(frame, who, "color.stride", color->stride, least, 1);
}

rlf_result frame_check(const rlf_frame *frame, const rlf_rig *rig, const char *who)
{
    rlf_result result = check_depth(frame, rig, who);
    if (result == RLF_OK) {
        result = color_check(frame, who);
    }
    if (result == RLF_OK && frame->has_pose) {
        char field[64];
        (void)snprintf(field, sizeof(field), "frame %llu: T_world_camera",
                       (unsigned long long)frame->sequence);
        result = pose_check(&frame->T_world_camera, who, field);
    }
    return result;
}
