/* Room for a picture, once its header has been read and believed. */
#include "io/picture/picture.h"

rlf_result io_picture_fail_size(const char *name, int64_t width, int64_t height,
                                int32_t wanted_width, int32_t wanted_height)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: the picture is %lld x %lld but camera.json says %d x %d: correct "
                    "camera.json, or take the picture out",
                    name, (long long)width, (long long)height, (int)wanted_width,
                    (int)wanted_height);
}

rlf_result io_picture_prepare(const io_bytes *file, io_picture *picture, int64_t width,
                              int64_t height, int64_t pixels_per_byte, size_t pixel_size)
{
    const int32_t most = picture->size_max > 0 ? picture->size_max : RLF_IMAGE_SIZE_MAX;
    if (width < 1 || height < 1 || width > most || height > most) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: the picture is %lld x %lld: use sizes of 1 to %d",
                        file->name, (long long)width, (long long)height, (int)most);
    }
    if (picture->pixels_max > 0 && width * height > picture->pixels_max) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the picture is %lld x %lld, too large beside the others: make them "
                        "smaller",
                        file->name, (long long)width, (long long)height);
    }
    bool is_wanted = (picture->width == 0 || picture->width == width) &&
                     (picture->height == 0 || picture->height == height);
    if (!is_wanted) {
        return io_picture_fail_size(file->name, width, height, picture->width, picture->height);
    }
    /* A few bytes that claim a huge picture must not cost a huge allocation. */
    if (width * height / pixels_per_byte > (int64_t)file->size) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is cut short: %zu bytes cannot hold %lld x %lld pixels: copy or "
                        "record it again",
                        file->name, file->size, (long long)width, (long long)height);
    }
    picture->width = (int32_t)width;
    picture->height = (int32_t)height;
    if (picture->data == NULL) {
        picture->data = rlf_alloc_array((size_t)(width * height), pixel_size);
    }
    return picture->data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}
