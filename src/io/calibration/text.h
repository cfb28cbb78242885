/* Text of other programs' calibration files as a JSON value: the part of YAML that ROS and OpenCV
 * write, and the Python dictionary of mrcal. */
#ifndef RLF_IO_CALIBRATION_TEXT_H
#define RLF_IO_CALIBRATION_TEXT_H

#include "io/file.h"

#include <jansson.h>

#define IO_CALIBRATION_FILE_MAX ((size_t)1 << 20)

/* Reads block mappings, lists of plain values, flow lists and maps, quoted and plain values, tags
 * and comments; anchors, block texts and lists of blocks are errors. A key given twice is one too.
 * The top must be a mapping. json_decref(*out). */
rlf_result io_calibration_text_parse(const io_bytes *file, json_t **out);

#endif
