/* camera.json from memory. */
#ifndef RLF_IO_CAMERA_JSON_H
#define RLF_IO_CAMERA_JSON_H

#include "relief/frame.h"
#include "io/file.h"

/* What a sensor that says nothing of itself is taken to see. */
typedef struct io_rig_defaults {
    double depth_min_m, depth_max_m;
    rlf_depth_noise noise;
} io_rig_defaults;

io_rig_defaults io_rig_defaults_get(void);

rlf_result io_rig_parse(const io_bytes *file, rlf_rig *out, double *out_units_per_metre);

#endif
