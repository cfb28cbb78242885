/* Whether a raw picture holds what its header says. */
#include "io/picture/pixels.h"

rlf_result io_pixels_check(const io_pixels *in, int32_t pixel_size, int64_t row_count)
{
    const int64_t most = RLF_IMAGE_SIZE_MAX;
    if (in->width < 1 || in->height < 1 || in->width > most || in->height > most) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: the picture is %lld x %lld: use sizes of 1 to %lld",
                        in->name, (long long)in->width, (long long)in->height, (long long)most);
    }
    const int64_t row_size = in->width * pixel_size;
    /* A step is bounded before it is multiplied. */
    if (in->step < row_size || in->step > UINT32_MAX ||
        (int64_t)(in->size / (size_t)in->step) < row_count - 1 ||
        (int64_t)in->size - in->step * (row_count - 1) < row_size) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the picture is cut short: %zu bytes cannot hold %lld rows of %lld: "
                        "copy or record it again",
                        in->name, in->size, (long long)row_count, (long long)in->step);
    }
    return RLF_OK;
}
