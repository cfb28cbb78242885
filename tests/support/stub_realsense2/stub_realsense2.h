/* Control of the stub librealsense2: one camera with 848x480 and 640x480 depth, 1280x720 and
 * 640x480 colour. */
#ifndef RLF_TEST_STUB_REALSENSE2_H
#define RLF_TEST_STUB_REALSENSE2_H

#include "io/realsense/realsense.h"
#include "stub_camera.h"

/* Lens and transform of the colour camera. */
#define STUB_RS_DEPTH_FX(width) ((float)(width)*0.5F)
#define STUB_RS_COLOR_FX(width) ((float)(width)*0.72F)

typedef struct stub_realsense2 {
    stub_fault fault;
    int color_format; /* that the camera has: one of rs2_format; 5 = RGB8 */
    bool has_color, has_big_modes;
    int color_model; /* rs2_distortion */
    float color_coeffs[5];
    float depth_scale;                  /* metres */
    float baseline_mm;                  /* 0 = the option is not supported */
    bool has_bad_numbers, has_bad_turn; /* calibration of a broken camera */
    int late_clock_at;                  /* from this wait on times are of another clock */
} stub_realsense2;

stub_realsense2 *stub_realsense2_get(void);

/* The library's own projection. */
void rs2_project_point_to_pixel(float out[2], const rs2_intrinsics *in, const float point[3]);

#endif
