/* A frame that stays while its source goes on. */
#include "io/clip/clip.h"

#include <string.h>

rlf_result io_frame_copy_create(const rlf_rig *rig, io_frame_copy *out)
{
    const size_t pixels = (size_t)rig->depth.width * (size_t)rig->depth.height;
    out->depth = rlf_alloc_array(pixels, sizeof(float));
    out->confidence = rlf_alloc_array(pixels, 1);
    if (rig->has_color) {
        out->color = rlf_alloc_array((size_t)rig->color.width * (size_t)rig->color.height, 4);
    }
    const bool is_whole =
        out->depth != NULL && out->confidence != NULL && (out->color != NULL || !rig->has_color);
    return is_whole ? RLF_OK : RLF_ERROR_MEMORY;
}

void io_frame_copy_destroy(io_frame_copy *slot)
{
    rlf_free(slot->depth);
    rlf_free(slot->color);
    rlf_free(slot->confidence);
    memset(slot, 0, sizeof(*slot));
}

static void copy_rows(void *out, const void *from, ptrdiff_t stride, size_t row_size, int32_t rows)
{
    uint8_t *to = out;
    const uint8_t *row = from;
    for (int32_t y = 0; y < rows; y++) {
        memcpy(to + (size_t)y * row_size, row + y * stride, row_size);
    }
}

void io_frame_copy_set(io_frame_copy *slot, const rlf_rig *rig, const rlf_frame *f)
{
    const bool is_u16 = f->depth_u16 != NULL;
    const int32_t width = rig->depth.width;
    const int32_t height = rig->depth.height;
    const size_t row_size = (size_t)width * (is_u16 ? 2 : 4);
    rlf_frame *own = &slot->frame;
    *own = *f;
    copy_rows(slot->depth, is_u16 ? (const void *)f->depth_u16 : (const void *)f->depth_f32,
              f->depth_stride, row_size, height);
    own->depth_u16 = is_u16 ? slot->depth : NULL;
    own->depth_f32 = is_u16 ? NULL : slot->depth;
    own->depth_stride = (ptrdiff_t)row_size;
    if (!rig->has_color) {
        own->color = (rlf_image_rgba8){0};
    } else if (f->color.data != NULL) {
        own->color.data = slot->color;
        own->color.stride = 4 * (ptrdiff_t)f->color.width;
        copy_rows(slot->color, f->color.data, f->color.stride, (size_t)own->color.stride,
                  f->color.height);
    }
    if (f->confidence != NULL) {
        own->confidence = slot->confidence;
        own->confidence_stride = width;
        copy_rows(slot->confidence, f->confidence, f->confidence_stride, (size_t)width, height);
    }
}
