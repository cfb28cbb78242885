/* What a file that is given as a calibration is. */
#ifndef RLF_IO_CALIBRATION_KIND_H
#define RLF_IO_CALIBRATION_KIND_H

#include "io/json.h"

typedef enum io_calibration_kind {
    IO_CALIBRATION_JSON = 0,
    IO_CALIBRATION_TEXT, /* YAML, or a Python dictionary */
    IO_CALIBRATION_XML
} io_calibration_kind;

/* By what is in it, and by its name where that leaves two. A file that is empty, or holds bytes
 * that no text has, is refused as what it looks like. */
rlf_result io_calibration_kind_of(const io_bytes *file, io_calibration_kind *out);

/* The error for a document with none of the keys that are read: says what it looks like. */
rlf_result io_calibration_fail_unknown(const io_json_object *top);

#endif
