/* What a frame must be before anyone reads its planes. */
#include "relief/frame.h"

#define UNITS_MAX 1e6 /* counts a metre: a micrometre each */

static unsigned long long number_of(const rlf_frame *frame)
{
    return (unsigned long long)frame->sequence;
}

static rlf_result check_depth(const rlf_rig *rig, const rlf_frame *f, const char *who)
{
    if ((f->depth_u16 == NULL) == (f->depth_f32 == NULL)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: set exactly one of depth_u16 and depth_f32", who,
                        number_of(f));
    }
    const ptrdiff_t sample = f->depth_u16 != NULL ? 2 : 4;
    if (f->depth_stride < sample * rig->depth.width || f->depth_stride % sample != 0) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: depth_stride is %lld; use at least %lld bytes, a multiple "
                        "of %d",
                        who, number_of(f), (long long)f->depth_stride,
                        (long long)(sample * rig->depth.width), (int)sample);
    }
    const double units = f->depth_units_per_metre;
    if (f->depth_u16 != NULL && !(units >= 1.0 && units <= UNITS_MAX)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: depth_units_per_metre is %g; use 1000 for mm, 1 to %.0f",
                        who, number_of(f), units, UNITS_MAX);
    }
    return RLF_OK;
}

static rlf_result check_color(const rlf_rig *rig, const rlf_frame *f, const char *who)
{
    const rlf_image_rgba8 *c = &f->color;
    if (c->width != rig->color.width || c->height != rig->color.height) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: its colour is %d x %d pixels, and the colour camera was "
                        "%d x %d when it was opened: open it again",
                        who, number_of(f), (int)c->width, (int)c->height, (int)rig->color.width,
                        (int)rig->color.height);
    }
    if (c->stride < 4 * (ptrdiff_t)c->width) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: the colour's stride is %lld; use at least %lld bytes", who,
                        number_of(f), (long long)c->stride, 4 * (long long)c->width);
    }
    return RLF_OK;
}

rlf_result rlf_frame_check(const rlf_rig *rig, const rlf_frame *frame, const char *who)
{
    if (!RLF_ASSERT(rig != NULL && frame != NULL && who != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = check_depth(rig, frame, who);
    if (result == RLF_OK && rig->has_color && frame->color.data != NULL) {
        result = check_color(rig, frame, who);
    }
    if (result == RLF_OK && frame->confidence != NULL &&
        frame->confidence_stride < rig->depth.width) {
        result = rlf_fail(
            RLF_ERROR_INVALID, "%s: frame %llu: confidence_stride is %lld; use at least %d bytes",
            who, number_of(frame), (long long)frame->confidence_stride, (int)rig->depth.width);
    }
    return result;
}
