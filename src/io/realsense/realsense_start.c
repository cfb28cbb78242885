/* Starting a RealSense camera: which streams, and what the device says about them. */
#include "io/realsense/realsense.h"

#include <math.h>
#include <stdio.h>

/* A lens that is off by more than this is told. */
#define LENS_ERROR_TOLD_PX 0.5

/* Noise of a stereo camera: sigma(z) = z^2 d / (f B), with a disparity noise d that Intel's tuning
 * guide gives as below 0.1 pixel on textured walls. */
#define DISPARITY_NOISE_PX 0.08
/* Streams to ask for. */
typedef struct wish {
    io_mode depth, color; /* 0 = any */
    bool has_color;
    int color_format;
} wish;

static rlf_result configure(const realsense *r, const wish *w, rs2_config *config)
{
    rs2_error *error = NULL;
    r->api->config_enable_device(config, r->serial, &error);
    if (error == NULL) {
        r->api->config_enable_stream(config, RS2_STREAM_DEPTH, -1, w->depth.width, w->depth.height,
                                     RS2_FORMAT_Z16, w->depth.frames_per_second, &error);
    }
    if (error == NULL && w->has_color) {
        r->api->config_enable_stream(config, RS2_STREAM_COLOR, -1, w->color.width, w->color.height,
                                     w->color_format, w->color.frames_per_second, &error);
    }
    return io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "plug it in again");
}

/* RLF_NO_FRAME: the camera has no such streams. */
static rlf_result try_wish(const realsense *r, const wish *w, rs2_pipeline_profile **out)
{
    rs2_error *error = NULL;
    rs2_config *config = r->api->create_config(&error);
    if (error != NULL) {
        return io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "try again");
    }
    rlf_result result = configure(r, w, config);
    if (result == RLF_OK) {
        const int is_possible = r->api->config_can_resolve(config, r->pipeline, &error);
        result = io_realsense_forget(r->api, &error) || is_possible == 0 ? RLF_NO_FRAME : RLF_OK;
    }
    if (result == RLF_OK) {
        *out = r->api->pipeline_start_with_config(r->pipeline, config, &error);
        result = io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source,
                                    "close other programs that use it, or plug it in again");
    }
    r->api->delete_config(config);
    return result;
}

/* From the best to the least: USB 2 and some models have fewer modes, some no colour at all. */
static rlf_result start_streams(const realsense *r, const io_mode *depth, const io_mode *color,
                                rs2_pipeline_profile **out)
{
    const io_mode any = {0};
    wish wishes[] = {{{848, 480, 30}, {1280, 720, 30}, true, RS2_FORMAT_RGB8},
                     {{640, 480, 30}, {640, 480, 30}, true, RS2_FORMAT_RGB8},
                     {any, any, true, RS2_FORMAT_RGB8},
                     {any, any, true, RS2_FORMAT_ANY},
                     {{640, 480, 30}, any, false, RS2_FORMAT_ANY},
                     {any, any, false, RS2_FORMAT_ANY}};
    const bool color_is_asked = color->width > 0;
    for (size_t i = 0; i < sizeof(wishes) / sizeof(wishes[0]); i++) {
        wish *w = &wishes[i];
        if (!w->has_color && color_is_asked) {
            break;
        }
        w->depth = depth->width > 0 ? *depth : w->depth;
        w->color = color_is_asked ? *color : w->color;
        rlf_result result = try_wish(r, w, out);
        if (result != RLF_NO_FRAME) {
            return result;
        }
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: the camera has no such mode over this connection: leave mode and color "
                    "out, or take one that realsense-viewer shows",
                    r->source);
}

/* The streams that run. */
typedef struct streams {
    const rs2_stream_profile *depth, *color; /* NULL = none */
    int color_format, depth_rate;
} streams;

static rlf_result find_streams(realsense *r, const rs2_stream_profile_list *list, streams *out)
{
    rs2_error *error = NULL;
    const int count = r->api->get_stream_profiles_count(list, &error);
    for (int i = 0; i < count && error == NULL; i++) {
        int stream = 0;
        int format = 0;
        int index = 0;
        int id = 0;
        int rate = 0;
        const rs2_stream_profile *p = r->api->get_stream_profile(list, i, &error);
        if (error == NULL) {
            r->api->get_stream_profile_data(p, &stream, &format, &index, &id, &rate, &error);
        }
        if (error == NULL && stream == RS2_STREAM_DEPTH) {
            out->depth = p;
            out->depth_rate = rate;
        } else if (error == NULL && stream == RS2_STREAM_COLOR) {
            out->color = p;
            out->color_format = format;
        }
    }
    rlf_result result =
        io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "plug it in again");
    return result != RLF_OK || out->depth != NULL
               ? result
               : rlf_fail(RLF_ERROR_DEVICE, "%s: the camera streams no depth: use another",
                          r->source);
}

static const char *encoding_of(int format)
{
    switch (format) {
    case RS2_FORMAT_YUYV: return "yuyv";
    case RS2_FORMAT_RGB8: return "rgb8";
    case RS2_FORMAT_BGR8: return "bgr8";
    case RS2_FORMAT_RGBA8: return "rgba8";
    case RS2_FORMAT_BGRA8: return "bgra8";
    default: return NULL;
    }
}

static rlf_result read_camera(const realsense *r, const rs2_stream_profile *profile,
                              const char *which, rlf_camera *out)
{
    rs2_error *error = NULL;
    rs2_intrinsics in = {0};
    r->api->get_video_stream_intrinsics(profile, &in, &error);
    rlf_result result = io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source,
                                           "calibrate it, or give a calibration by ?camera=FILE");
    if (result != RLF_OK) {
        return result;
    }
    const double off_px = io_realsense_lens(r->api, &in, out);
    if (isinf(off_px)) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the %s lens (librealsense2's model %d) is not understood and is left out: "
                "give a calibration by ?camera=FILE",
                r->source, which, in.model);
    } else if (off_px > LENS_ERROR_TOLD_PX) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the %s lens (librealsense2's model %d) is off by up to %.1f pixels here: give "
                "a calibration by ?camera=FILE",
                r->source, which, in.model, off_px);
    }
    return rlf_camera_check(out, r->source);
}

static rlf_result read_transform(realsense *r, const streams *s)
{
    rs2_error *error = NULL;
    rs2_extrinsics in = {0};
    r->api->get_extrinsics(s->depth, s->color, &in, &error);
    rlf_result result = io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source,
                                           "give a calibration by ?camera=FILE");
    if (result != RLF_OK) {
        return result;
    }
    float rows[9];
    for (int i = 0; i < 9; i++) {
        rows[i] = in.rotation[i % 3 * 3 + i / 3];
    }
    return io_live_pose(rows, in.translation, 1.0, &r->rig.T_color_depth)
               ? RLF_OK
               : rlf_fail(RLF_ERROR_DEVICE,
                          "%s: its transform from depth to colour is no rotation: calibrate it, or "
                          "give a calibration by ?camera=FILE",
                          r->source);
}

static rlf_result read_cameras(realsense *r, const streams *s)
{
    rlf_result result = read_camera(r, s->depth, "depth", &r->rig.depth);
    r->color_encoding = s->color != NULL ? encoding_of(s->color_format) : NULL;
    r->rig.has_color = r->color_encoding != NULL;
    if (result == RLF_OK && s->color != NULL && !r->rig.has_color) {
        rlf_log(RLF_LOG_WARNING,
                "%s: colour comes in librealsense2's format %d, which is not read: there is no "
                "colour",
                r->source, s->color_format);
    }
    if (result == RLF_OK && r->rig.has_color) {
        result = read_camera(r, s->color, "colour", &r->rig.color);
        result = result == RLF_OK ? read_transform(r, s) : result;
    }
    return result;
}

/* Units and baseline from the sensor that measures depth. */
static bool read_sensor(realsense *r, rs2_sensor *sensor)
{
    rs2_error *error = NULL;
    const int is_depth =
        r->api->is_sensor_extendable_to(sensor, RS2_EXTENSION_DEPTH_SENSOR, &error);
    if (io_realsense_forget(r->api, &error) || is_depth == 0) {
        return false;
    }
    const double scale = (double)r->api->get_depth_scale(sensor, &error);
    if (io_realsense_forget(r->api, &error) || !(scale > 0.0)) {
        return false;
    }
    /* 0.001 in single precision is meant to be a thousandth. */
    const double units = 1.0 / scale;
    r->units_per_metre = fabs(units - round(units)) < 1e-6 * units ? round(units) : units;
    if (r->api->supports_option(sensor, RS2_OPTION_STEREO_BASELINE, &error) != 0 && error == NULL) {
        const double base_m =
            fabs((double)r->api->get_option(sensor, RS2_OPTION_STEREO_BASELINE, &error)) / 1000.0;
        if (error == NULL && base_m > 0.0) {
            const double growth = DISPARITY_NOISE_PX / (r->rig.depth.fx * base_m);
            r->rig.noise = (rlf_depth_noise){0.0, 0.0, growth};
        }
    }
    io_realsense_forget(r->api, &error);
    return true;
}

static rlf_result read_sensors(realsense *r)
{
    rs2_error *error = NULL;
    bool is_found = false;
    rs2_sensor_list *list = r->api->query_sensors(r->device, &error);
    const int count = error == NULL ? r->api->get_sensors_count(list, &error) : 0;
    for (int i = 0; i < count && error == NULL && !is_found; i++) {
        rs2_sensor *sensor = r->api->create_sensor(list, i, &error);
        if (error == NULL) {
            is_found = read_sensor(r, sensor);
            r->api->delete_sensor(sensor);
        }
    }
    if (list != NULL) {
        r->api->delete_sensor_list(list);
    }
    rlf_result result =
        io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "plug it in again");
    return result != RLF_OK || is_found
               ? result
               : rlf_fail(RLF_ERROR_DEVICE,
                          "%s: the camera does not say its depth unit: use another", r->source);
}

static rlf_result read_rig(realsense *r, rs2_pipeline_profile *profile)
{
    rs2_error *error = NULL;
    streams s = {0};
    rs2_stream_profile_list *list = r->api->pipeline_profile_get_streams(profile, &error);
    rlf_result result =
        io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "plug it in again");
    if (result == RLF_OK) {
        result = find_streams(r, list, &s);
        result = result == RLF_OK ? read_cameras(r, &s) : result;
        r->api->delete_stream_profiles_list(list);
    }
    r->frames_per_second = s.depth_rate;
    r->count.interval_ns = s.depth_rate > 0 ? 1000000000 / s.depth_rate : 0;
    return result == RLF_OK ? read_sensors(r) : result;
}

rlf_result io_realsense_start(realsense *r, const io_mode *depth, const io_mode *color)
{
    rs2_error *error = NULL;
    r->rig = rlf_rig_default(); /* its noise where the camera tells no baseline */
    r->pipeline = r->api->create_pipeline(r->context, &error);
    rlf_result result =
        io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "plug it in again");
    rs2_pipeline_profile *profile = NULL;
    result = result == RLF_OK ? start_streams(r, depth, color, &profile) : result;
    if (result == RLF_OK) {
        r->is_streaming = true;
        result = read_rig(r, profile);
        r->api->delete_pipeline_profile(profile);
    }
    return result;
}
