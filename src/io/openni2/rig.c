/* The cameras of an OpenNI2 device. */
#include "io/openni2/device.h"
#include "io/source/field_of_view.h"

/* A camera writes 0 where it is too near to measure: what it did write is believed. */
#define DEPTH_MIN_M 0.1
#define DEPTH_MAX_M 8.0
#define DEPTH_LIMIT_M 20.0

/* Structured light, as for camera.json: 2 mm at 1 m, 6 mm at 2 m. */
static const rlf_depth_noise structured_light = {0.0008, 0.0, 0.0012};

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

/* Depth that is warped into the colour camera has the colour camera's lens. */
static void cameras_of(const rlf_address *address, const openni2_device *device, rlf_rig *out)
{
    const openni2_stream *depth = &device->depth;
    const openni2_stream *color = &device->color;
    bool is_told = camera_of(device, depth, depth, &out->depth);
    out->has_color = color->handle != NULL;
    if (out->has_color && !camera_of(device, color, color, &out->color) && is_told) {
        (void)camera_of(device, depth, color, &out->color);
    }
    if (device->is_aligned) {
        out->depth = rlf_camera_resize(&out->color, depth->mode.width, depth->mode.height);
    } else if (out->has_color) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the depth pictures are not aligned with colour, and OpenNI2 does not tell "
                "how the two cameras stand: give a calibration with ?camera=FILE%s",
                address->source, device->can_align ? ", or leave aligned=0 out" : "");
    }
    if (!is_told) {
        rlf_log(RLF_LOG_WARNING,
                "%s: does not tell its field of view: 58 degrees are taken; give a calibration "
                "with ?camera=FILE",
                address->source);
    }
}

static rlf_result check_size(const rlf_address *address, const char *what, const rlf_camera *camera,
                             const openni2_mode *mode)
{
    if (camera->width == mode->width && camera->height == mode->height) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: the calibration is for %s pictures of %d x %d, but they come with %d x "
                    "%d: give mode=%dx%d, or a calibration of this size",
                    address->source, what, (int)camera->width, (int)camera->height, mode->width,
                    mode->height, (int)camera->width, (int)camera->height);
}

static rlf_result use_calibration(const rlf_address *address, const openni2_device *device,
                                  rlf_rig *out)
{
    *out = *address->rig;
    out->has_color = address->rig->has_color && device->color.handle != NULL;
    rlf_result result = check_size(address, "depth", &out->depth, &device->depth.mode);
    if (result == RLF_OK && out->has_color) {
        result = check_size(address, "colour", &out->color, &device->color.mode);
    }
    return result;
}

rlf_result openni2_make_rig(const rlf_address *address, const openni2_device *device, rlf_rig *out)
{
    if (address->rig != NULL) {
        return use_calibration(address, device, out);
    }
    *out = (rlf_rig){.T_color_depth = rlf_pose_identity(),
                     .depth_min_m = DEPTH_MIN_M,
                     .depth_max_m = DEPTH_MAX_M,
                     .noise = structured_light};
    cameras_of(address, device, out);
    const double farthest =
        openni2_stream_int(device, &device->depth, OPENNI2_STREAM_MAX, 0) / openni2_units(device);
    if (farthest > DEPTH_MIN_M && farthest < DEPTH_LIMIT_M) {
        out->depth_max_m = farthest;
    }
    return RLF_OK;
}
