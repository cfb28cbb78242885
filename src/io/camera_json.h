/* camera.json from memory. */
#ifndef RLF_IO_CAMERA_JSON_H
#define RLF_IO_CAMERA_JSON_H

#include "relief/frame.h"
#include "io/file.h"
#include "io/json.h"

rlf_result io_rig_parse(const io_bytes *file, rlf_rig *out, double *out_units_per_metre);

/* The same of a parsed document. */
rlf_result io_rig_from_json(const io_json_object *top, rlf_rig *out, double *out_units_per_metre);
/* Only its depth_to_color, into rig->T_color_depth; left as it is where there is none. */
rlf_result io_rig_read_motion(const io_json_object *top, rlf_rig *rig);

#endif
