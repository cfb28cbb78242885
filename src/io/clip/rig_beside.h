/* Calibration of recordings that hold none. */
#ifndef RLF_IO_CLIP_RIG_BESIDE_H
#define RLF_IO_CLIP_RIG_BESIDE_H

#include "relief/backend.h"

/* The user's own (?camera=FILE), else FILE.json beside the recording FILE.xyz, else camera.json in
 * its folder. *out_found tells whether there is one; when there is none the others keep what they
 * hold. */
rlf_result io_rig_beside(const rlf_address *address, rlf_rig *out, double *out_units_per_metre,
                         bool *out_found);

#endif
