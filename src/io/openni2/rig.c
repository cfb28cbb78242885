/* The cameras of an OpenNI2 device. */
#include "io/live/driver.h"
#include "io/openni2/openni2.h"

#define DEPTH_LIMIT_M 20.0 /* what a device says beyond this is no depth */

double openni2_units(const openni2_device *device)
{
    return device->depth.mode.format == OPENNI2_DEPTH_100_UM ? 10000.0 : 1000.0;
}

/* Returns whether the stream tells its field of view. */
static bool camera_of(const openni2_device *device, const openni2_stream *stream,
                      const openni2_stream *size, rlf_camera *out)
{
    return io_camera_from_fov(size->mode.width, size->mode.height,
                              openni2_stream_float(device, stream, OPENNI2_STREAM_FOV_X, 0.0f),
                              openni2_stream_float(device, stream, OPENNI2_STREAM_FOV_Y, 0.0f),
                              out);
}

/* Depth that is warped into the colour camera has the colour camera's lens. Returns whether the
 * device tells its field of view. */
static bool cameras_of(const openni2_device *device, rlf_rig *out)
{
    const openni2_stream *depth = &device->depth;
    const openni2_stream *color = &device->color;
    const bool is_told = camera_of(device, depth, depth, &out->depth);
    out->has_color = color->handle != NULL;
    if (out->has_color && !camera_of(device, color, color, &out->color) && is_told) {
        (void)camera_of(device, depth, color, &out->color);
    }
    if (device->is_aligned) {
        out->depth = rlf_camera_resize(&out->color, depth->mode.width, depth->mode.height);
    }
    return is_told;
}

static void warn(const char *source, const openni2_device *device, bool has_color, bool is_told)
{
    if (has_color && !device->is_aligned) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the depth pictures are not aligned with colour, and OpenNI2 does not tell "
                "how the two cameras stand: give a calibration with ?camera=FILE%s",
                source, device->can_align ? ", or leave aligned=0 out" : "");
    }
    if (!is_told) {
        rlf_log(RLF_LOG_WARNING,
                "%s: does not tell its field of view: 58 degrees are taken; give a calibration "
                "with ?camera=FILE",
                source);
    }
}

rlf_result openni2_make_rig(const rlf_address *address, const openni2_device *device, rlf_rig *out)
{
    *out = rlf_rig_default();
    const bool is_told = cameras_of(device, out);
    if (address->rig == NULL) {
        warn(address->source, device, out->has_color, is_told);
    }
    const double farthest =
        openni2_stream_int(device, &device->depth, OPENNI2_STREAM_MAX, 0) / openni2_units(device);
    if (farthest > out->depth_min_m && farthest < DEPTH_LIMIT_M) {
        out->depth_max_m = farthest;
    }
    return io_live_use_rig(address, out);
}
