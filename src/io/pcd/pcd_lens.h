/* The camera that an organised cloud was made with. */
#ifndef RLF_IO_PCD_LENS_H
#define RLF_IO_PCD_LENS_H

#include "io/pcd/pcd_points.h"
#include "relief/camera.h"

/* Pinhole of u = fx x / z + cx and v = fy y / z + cy by least squares over all points. False when
 * the points do not lie so to a tenth of a pixel (root mean square), or are too few. */
bool io_pcd_lens_fit(const io_pcd_header *header, const io_pcd_points *points, rlf_camera *out);

#endif
