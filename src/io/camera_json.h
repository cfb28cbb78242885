/* camera.json from memory. */
#ifndef RLF_IO_CAMERA_JSON_H
#define RLF_IO_CAMERA_JSON_H

#include "relief/frame.h"
#include "io/file.h"

/* What holds of a sensor that says nothing about itself: range, noise, no transform, no colour. */
rlf_rig io_rig_default(void);

rlf_result io_rig_parse(const io_bytes *file, rlf_rig *out, double *out_units_per_metre);

#endif
