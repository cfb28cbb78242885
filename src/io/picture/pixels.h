/* Raw pictures as robots' messages and recordings hold them: to RGBA, and to depth counts. */
#ifndef RLF_IO_PICTURE_PIXELS_H
#define RLF_IO_PICTURE_PIXELS_H

#include "io/file.h"
#include "relief/base.h"
#include "relief/image.h"

/* A picture whose rows lie in memory as its maker left them. */
typedef struct io_pixels {
    const char *name;      /* for error lines: file, topic and number of the frame */
    const char *encoding;  /* as in ROS, sensor_msgs/image_encodings.h: "rgb8", "16UC1" ... */
    int64_t width, height; /* unchecked, as the message says */
    int64_t step;          /* bytes from row to row; 0 = no gap between rows */
    bool is_bigendian;
    const uint8_t *data;
    size_t size;
} io_pixels;

/* Counts per metre that 32FC1 becomes: steps of 0.2 mm, finer than any sensor's noise, up to
 * 13.1 m. */
#define IO_PIXELS_FLOAT_UNITS 5000.0

/* Whether the encoding holds depth: 16UC1, mono16, 32FC1. */
bool io_pixels_is_depth(const char *encoding);
/* Whether io_pixels_to_rgba knows the encoding. */
bool io_pixels_is_picture(const char *encoding);

/* Colour or grey to RGBA: rgb8 rgba8 bgr8 bgra8 8UC3 8UC4 (as OpenCV: blue first) mono8 8UC1 mono16
 * 16UC1 (high byte) yuv422 uyvy yuv422_yuy2 yuyv nv12 nv21 and the four bayer_*8. `out` has the
 * size that is wanted and room for it; another one is an error. */
rlf_result io_pixels_to_rgba(const io_pixels *in, const rlf_image_rgba8 *out);

/* A row of `width` pixels: alpha becomes 255, or is dropped. */
void io_rgb_to_rgba(const uint8_t *rgb, int32_t width, uint8_t *out_rgba);
void io_rgba_to_rgb(const uint8_t *rgba, int32_t width, uint8_t *out_rgb);

/* Depth to in->width x in->height counts without padding; the caller has checked that size against
 * its room. 16UC1 and mono16 are taken as they are, 1000 per metre as ROS (REP 118) has it. 32FC1
 * is metres; missing ones (NaN, infinite, <= 0) and what is beyond the range become 0. */
rlf_result io_pixels_to_depth(const io_pixels *in, uint16_t *out, double *out_units_per_metre);

/* ---- Whether a raw picture holds what its header says ---- */

/* The picture has a size within the limits and `row_count` whole rows of width x pixel_size bytes:
 * half as many again as the height where planes of colour follow. */
rlf_result io_pixels_check(const io_pixels *in, int32_t pixel_size, int64_t row_count);

/* Lossless code for depth pictures: RVL (Wilson, "Fast Lossless Depth Image Compression", 2017). */

#define IO_RVL_WINDOW 4096 /* all values of three nibbles */
#define IO_RVL_SHORT 512   /* zigzag values that fit three nibbles */

/* What three nibbles say: up to three whole differences. */
typedef struct io_rvl_entry {
    int16_t sum[3]; /* of the first one, two, three of them; repeated when there are fewer */
    uint8_t count;  /* 0 = the first does not end here */
    uint8_t bits;   /* of all of them */
} io_rvl_entry;

/* Tables of both directions; constant once made, so threads may share them. */
typedef struct io_rvl {
    io_rvl_entry decode[IO_RVL_WINDOW];
    uint16_t encode[IO_RVL_SHORT]; /* nibbles, with their number times 4096 */
} io_rvl;

void io_rvl_init(io_rvl *rvl);

/* Most bytes that `count` pixels can take. */
size_t io_rvl_bound(size_t count);
/* Writes at most io_rvl_bound bytes and returns how many. */
size_t io_rvl_encode(const io_rvl *rvl, const uint16_t *depth, size_t count, uint8_t *out);
/* Reads exactly `count` pixels; false when the bytes end before or say more than that. Whatever the
 * bytes are, nothing else is read or written. */
bool io_rvl_decode(const io_rvl *rvl, const uint8_t *data, size_t size, uint16_t *out,
                   size_t count);

/* ---- Depth pictures of ROS's compressed_depth_image_transport ---- */

/* Whether a message of that format and data holds depth: compressedDepth, or a PNG of 16-bit grey,
 * as the plain compressed transport and cv_bridge write it. */
bool io_compressed_depth_is(const io_bytes *file, const char *format);

/* The size it says; false when it says none. */
bool io_compressed_depth_size(const io_bytes *file, const char *format, int32_t *out_width,
                              int32_t *out_height);

/* Counts as they were coded, PNG or RVL. `format` is the message's, e.g. "16UC1; compressedDepth
 * png"; `file` its data: 12 bytes that say how floats were quantised, then the picture. `out` has
 * room for width x height counts; another size is an error. */
rlf_result io_compressed_depth_counts(const io_rvl *rvl, const io_bytes *file, const char *format,
                                      int32_t width, int32_t height, uint16_t *out);

/* The same in units: 16UC1 gives its counts, 1000 per metre; 32FC1 gives IO_PIXELS_FLOAT_UNITS. */
rlf_result io_compressed_depth_decode(const io_rvl *rvl, const io_bytes *file, const char *format,
                                      int32_t width, int32_t height, uint16_t *out,
                                      double *out_units_per_metre);

#endif
