/* The cameras of an OpenNI2 device. */
#include "io/openni2/device.h"

/* Horizontal focal length over width of PrimeSense cameras: 58.5 degrees (Kinect v1, Xtion). */
#define FOCAL_TYPICAL 0.9

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

static bool is_angle(float radians)
{
    return radians > 0.1f && radians < 3.0f;
}

/* The fields of view cover whole pixels, so the centre lies between the middle ones. Returns
 * whether the stream tells them. */
static bool camera_of(const openni2_device *device, const openni2_stream *stream,
                      const openni2_stream *size, rlf_camera *out)
{
    const int w = size->mode.width;
    const int h = size->mode.height;
    *out = (rlf_camera){.width = w,
                        .height = h,
                        .fx = FOCAL_TYPICAL * w,
                        .fy = FOCAL_TYPICAL * w,
                        .cx = 0.5 * (w - 1),
                        .cy = 0.5 * (h - 1)};
    const float x = openni2_stream_float(device, stream, OPENNI2_STREAM_FOV_X, 0.0f);
    const float y = openni2_stream_float(device, stream, OPENNI2_STREAM_FOV_Y, 0.0f);
    if (!is_angle(x) || !is_angle(y)) {
        return false;
    }
    out->fx = 0.5 * w * rlf_cos(0.5 * x) / rlf_sin(0.5 * x);
    out->fy = 0.5 * h * rlf_cos(0.5 * y) / rlf_sin(0.5 * y);
    return true;
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

static rlf_result check_size(const rlf_address *address, const char *what,
                             const rlf_camera *camera, const openni2_mode *mode)
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
