/* OpenCV's FileStorage in XML as a JSON value. */
#ifndef RLF_IO_CALIBRATION_XML_H
#define RLF_IO_CALIBRATION_XML_H

#include "io/file.h"

#include <jansson.h>

/* Reads what cv::FileStorage writes: the elements of <opencv_storage> are keys. An element holds
 * elements, one number or text, or several numbers with blanks between. Attributes and comments are
 * passed over. Other XML is an error. json_decref(*out). */
rlf_result io_calibration_xml_parse(const io_bytes *file, json_t **out);

#endif
