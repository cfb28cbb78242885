/* Depth pictures of ROS's compressed_depth_image_transport. */
#ifndef RLF_IO_COMPRESSED_DEPTH_H
#define RLF_IO_COMPRESSED_DEPTH_H

#include "io/codec/rvl.h"
#include "io/file.h"

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
