/* Raw pictures as robots' messages and recordings hold them: to RGBA, and to depth counts. */
#ifndef RLF_IO_PIXELS_H
#define RLF_IO_PIXELS_H

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

/* Depth to in->width x in->height counts without padding; the caller has checked that size against
 * its room. 16UC1 and mono16 are taken as they are, 1000 per metre as ROS (REP 118) has it. 32FC1
 * is metres; missing ones (NaN, infinite, <= 0) and what is beyond the range become 0. */
rlf_result io_pixels_to_depth(const io_pixels *in, uint16_t *out, double *out_units_per_metre);

/* YUV of full or limited range to RGB (BT.601), three bytes. */
void io_yuv_to_rgb(int32_t y, int32_t u, int32_t v, bool is_full_range, uint8_t *out);

#endif
