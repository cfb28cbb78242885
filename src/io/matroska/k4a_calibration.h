/* The calibration that an Azure Kinect or a Femto camera holds, as k4arecorder attaches it. */
#ifndef RLF_IO_MATROSKA_K4A_CALIBRATION_H
#define RLF_IO_MATROSKA_K4A_CALIBRATION_H

#include "relief/frame.h"
#include "io/file.h"

/* Fills cameras and transform for pictures of rig->depth.width x height and, when has_color,
 * rig->color.width x height, which are given. The file is normalised to the whole sensors; a mode
 * bins it and cuts a window out, which the size tells. */
rlf_result k4a_calibration_read(const io_bytes *file, rlf_rig *rig);

#endif
