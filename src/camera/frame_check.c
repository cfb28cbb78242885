/* What a frame must be before anyone reads its planes. */
#include "relief/frame.h"

#include "base/checks.h"
#include "camera/checks.h"

#define STRIDE_MAX ((ptrdiff_t)1 << 30) /* bytes: no picture's, but a wrong number's */
#define UNITS_MAX 1e6                   /* counts a metre: a micrometre each */

static unsigned long long number_of(const rlf_frame *frame)
{
    return (unsigned long long)frame->sequence;
}

static rlf_result check_stride(const rlf_frame *frame, const char *who, const char *field,
                               ptrdiff_t stride, ptrdiff_t least, int unit)
{
    if (stride >= least && stride <= STRIDE_MAX && stride % unit == 0) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: frame %llu: %s is %lld; use at least %lld bytes, a multiple of %d", who,
                    number_of(frame), field, (long long)stride, (long long)least, unit);
}

static rlf_result check_depth(const rlf_rig *rig, const rlf_frame *f, const char *who)
{
    if ((f->depth_u16 == NULL) == (f->depth_f32 == NULL)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: set exactly one of depth_u16 and depth_f32", who,
                        number_of(f));
    }
    const int sample = f->depth_u16 != NULL ? 2 : 4;
    const ptrdiff_t width = rig->depth.width;
    const double units = f->depth_units_per_metre;
    if (f->depth_u16 != NULL && !(units >= 1.0 && units <= UNITS_MAX)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: depth_units_per_metre is %g; use 1000 for mm, 1 to %.0f",
                        who, number_of(f), units, UNITS_MAX);
    }
    rlf_result result =
        check_stride(f, who, "depth_stride", f->depth_stride, sample * width, sample);
    if (result == RLF_OK && f->confidence != NULL) {
        result = check_stride(f, who, "confidence_stride", f->confidence_stride, width, 1);
    }
    return result;
}

rlf_result color_check(const rlf_frame *f, const char *who)
{
    const rlf_image_rgba8 *c = &f->color;
    if (c->data == NULL) {
        return RLF_OK;
    }
    if (c->width < 1 || c->height < 1 || c->width > RLF_IMAGE_SIZE_MAX ||
        c->height > RLF_IMAGE_SIZE_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: color.width x height is %d x %d; use 1 to %d", who,
                        number_of(f), (int)c->width, (int)c->height, RLF_IMAGE_SIZE_MAX);
    }
    return check_stride(f, who, "color.stride", c->stride, 4 * (ptrdiff_t)c->width, 1);
}

static rlf_result check_color(const rlf_rig *rig, const rlf_frame *f, const char *who)
{
    const rlf_image_rgba8 *c = &f->color;
    if (c->data != NULL && rig->has_color &&
        (c->width != rig->color.width || c->height != rig->color.height)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: frame %llu: its colour is %d x %d pixels, and the colour camera was "
                        "%d x %d when it was opened: open it again",
                        who, number_of(f), (int)c->width, (int)c->height, (int)rig->color.width,
                        (int)rig->color.height);
    }
    return color_check(f, who);
}

static rlf_result check_times(const rlf_frame *f, const char *who)
{
    const struct {
        const char *name;
        int64_t ns;
    } times[] = {{"time_ns", f->time_ns},
                 {"color_time_ns", f->color_time_ns},
                 {"host_time_ns", f->host_time_ns}};
    for (size_t i = 0; i < sizeof(times) / sizeof(times[0]); i++) {
        if (!time_is_usable(times[i].ns)) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: frame %llu: %s is %lld ns, more than 146 years: use nanoseconds "
                            "from any nearer origin",
                            who, number_of(f), times[i].name, (long long)times[i].ns);
        }
    }
    return RLF_OK;
}

rlf_result rlf_frame_check(const rlf_rig *rig, const rlf_frame *frame, const char *who)
{
    if (!RLF_ASSERT(rig != NULL && frame != NULL && who != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = check_times(frame, who);
    if (result == RLF_OK) {
        result = check_depth(rig, frame, who);
    }
    if (result == RLF_OK) {
        result = check_color(rig, frame, who);
    }
    return result;
}
