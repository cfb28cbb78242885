/* Depth and colour as ROS 2 messages. */
#include "io/ros/write.h"

#include <stdio.h>
#include <string.h>

#define LEVEL 1 /* of zlib: recording has to keep up */

rlf_result io_ros_encoder_init(io_ros_encoder *e, const rlf_rig *rig, const rlf_recording_def *def)
{
    *e = (io_ros_encoder){
        .rig = *rig, .depth_codec = def->depth_codec, .jpeg_quality = def->jpeg_quality};
    io_rvl_init(&e->rvl);
    e->scratch = rlf_alloc_array((size_t)rig->depth.width * (size_t)rig->depth.height, 4);
    rlf_result result = e->scratch != NULL ? io_jpeg_encoder_create(&e->jpeg) : RLF_ERROR_MEMORY;
    if (result != RLF_OK) {
        io_ros_encoder_free(e);
    }
    return result;
}

void io_ros_encoder_free(io_ros_encoder *e)
{
    io_jpeg_encoder_destroy(&e->jpeg);
    rlf_free(e->scratch);
    e->scratch = NULL;
}

io_ros_header io_ros_header_at(int64_t time_ns, const char *frame_id)
{
    io_ros_header header = {.stamp_ns = time_ns > 0 ? time_ns : 0};
    snprintf(header.frame_id, sizeof(header.frame_id), "%s", frame_id);
    return header;
}

static void put_rvl(io_ros_encoder *e, const uint16_t *rows, io_byte_buffer *b)
{
    const rlf_camera *c = &e->rig.depth;
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    io_put_u32(b, (uint32_t)c->width);
    io_put_u32(b, (uint32_t)c->height);
    uint8_t *out = io_byte_buffer_reserve(b, io_rvl_bound(pixels));
    if (out != NULL) {
        io_byte_buffer_grow(b, io_rvl_encode(&e->rvl, rows, pixels, out));
    }
}

/* compressed_depth_image_transport: 12 bytes that say nothing about 16UC1, then the picture. */
rlf_result io_ros_write_counts(io_ros_encoder *e, const rlf_frame *frame,
                               const io_ros_header *header, io_cdr_writer *cdr)
{
    static const uint8_t head[12] = {0};
    const rlf_camera *c = &e->rig.depth;
    const bool is_rvl = e->depth_codec == RLF_DEPTH_RVL;
    io_ros_image image = {.header = *header};
    snprintf(image.encoding, sizeof(image.encoding), "16UC1; compressedDepth %s",
             is_rvl ? "rvl" : "png");
    const size_t begin = io_ros_begin_compressed(cdr, &image);
    io_byte_buffer_add(cdr->buffer, head, sizeof(head));
    const uint16_t *rows = io_depth_rows(frame, &e->rig, e->scratch);
    rlf_result result = RLF_OK;
    if (is_rvl) {
        put_rvl(e, rows, cdr->buffer);
    } else {
        const io_png_def def = {"depth",         rows, c->width, c->height, (ptrdiff_t)c->width * 2,
                                IO_PNG_GREY_U16, LEVEL};
        result = io_png_encode(&def, cdr->buffer);
    }
    io_cdr_end_bytes(cdr, begin);
    return result;
}

void io_ros_write_depth(io_ros_encoder *e, const rlf_frame *frame, const io_ros_header *header,
                        io_cdr_writer *cdr)
{
    const rlf_camera *c = &e->rig.depth;
    const bool is_float = frame->depth_f32 != NULL;
    const uint32_t step = (uint32_t)c->width * (is_float ? 4 : 2);
    io_ros_image image = {.header = *header,
                          .width = (uint32_t)c->width,
                          .height = (uint32_t)c->height,
                          .step = step};
    snprintf(image.encoding, sizeof(image.encoding), "%s", is_float ? "32FC1" : "16UC1");
    const size_t begin = io_ros_begin_image(cdr, &image);
    io_byte_buffer_add(cdr->buffer, io_depth_rows(frame, &e->rig, e->scratch),
                       (size_t)step * (size_t)c->height);
    io_cdr_end_bytes(cdr, begin);
}

rlf_result io_ros_write_compressed(io_ros_encoder *e, const rlf_image_rgba8 *c,
                                   const io_ros_header *header, io_cdr_writer *cdr)
{
    const bool is_jpeg = e->jpeg_quality > 0;
    io_ros_image image = {.header = *header};
    snprintf(image.encoding, sizeof(image.encoding), "rgb8; %s compressed %s",
             is_jpeg ? "jpeg" : "png", is_jpeg ? "bgr8" : "rgb8");
    const size_t begin = io_ros_begin_compressed(cdr, &image);
    rlf_result result;
    if (is_jpeg) {
        result = io_jpeg_encode(e->jpeg, c, e->jpeg_quality, cdr->buffer);
    } else {
        const io_png_def def = {"colour",  c->data,    c->width, c->height,
                                c->stride, IO_PNG_RGB, LEVEL};
        result = io_png_encode(&def, cdr->buffer);
    }
    io_cdr_end_bytes(cdr, begin);
    return result;
}

void io_ros_write_color(const rlf_image_rgba8 *c, const io_ros_header *header, io_cdr_writer *cdr)
{
    const size_t row = (size_t)c->width * 3;
    io_ros_image image = {.header = *header,
                          .width = (uint32_t)c->width,
                          .height = (uint32_t)c->height,
                          .step = (uint32_t)row,
                          .encoding = "rgb8"};
    const size_t begin = io_ros_begin_image(cdr, &image);
    uint8_t *out = io_byte_buffer_reserve(cdr->buffer, row * (size_t)c->height);
    if (out != NULL) {
        for (int32_t y = 0; y < c->height; y++) {
            io_rgba_to_rgb(c->data + (ptrdiff_t)y * c->stride, c->width, out + (size_t)y * row);
        }
        io_byte_buffer_grow(cdr->buffer, row * (size_t)c->height);
    }
    io_cdr_end_bytes(cdr, begin);
}
