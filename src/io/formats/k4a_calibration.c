/* The calibration of an Azure Kinect or a Femto camera. */
#include "io/formats/matroska.h"

#include "io/calibration/calibration.h"
#include "io/json.h"

#include <string.h>

/* Deviation from a rotation that rounding can cause. */
#define ROTATION_TOLERANCE 1e-2

/* The window of the whole, binned sensor that a mode gives. */
typedef struct window {
    double width, height; /* of the binned sensor */
    double left, top;
} window;

static rlf_result depth_window(const char *file, const rlf_camera *camera, window *out)
{
    static const struct {
        int32_t width, height;
        window window;
    } modes[] = {
        {640, 576, {1024, 1024, 192, 180}}, /* NFOV_UNBINNED */
        {320, 288, {512, 512, 96, 90}},     /* NFOV_2X2BINNED */
        {512, 512, {512, 512, 0, 0}},       /* WFOV_2X2BINNED */
        {1024, 1024, {1024, 1024, 0, 0}},   /* WFOV_UNBINNED */
    };
    for (size_t i = 0; i < sizeof(modes) / sizeof(modes[0]); i++) {
        if (modes[i].width == camera->width && modes[i].height == camera->height) {
            *out = modes[i].window;
            return RLF_OK;
        }
    }
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "%s: the depth pictures are %d x %d, which no mode of an Azure Kinect gives: "
                    "give the calibration with ?camera=FILE",
                    file, (int)camera->width, (int)camera->height);
}

/* The colour sensor is 4:3; wider modes leave out as many rows above as below. Old calibrations are
 * of the 16:9 part alone. */
static window color_window(const rlf_camera *camera, json_t *from)
{
    const json_int_t width = json_integer_value(json_object_get(from, "SensorWidth"));
    const json_int_t height = json_integer_value(json_object_get(from, "SensorHeight"));
    const bool is_wide = width > 0 && width <= 16384 && width * 9 / 16 == height;
    const double rows = camera->width * (is_wide ? 9.0 / 16.0 : 0.75);
    return (window){camera->width, rows, 0, 0.5 * (rows - camera->height)};
}

/* The camera of a place: "CALIBRATION_CameraLocationD0" is depth, "...PV0" is colour. */
static json_t *find_camera(json_t *top, const char *location)
{
    json_t *cameras = json_object_get(json_object_get(top, "CalibrationInformation"), "Cameras");
    for (size_t i = 0; i < json_array_size(cameras); i++) {
        json_t *camera = json_array_get(cameras, i);
        const char *name = json_string_value(json_object_get(camera, "Location"));
        if (name != NULL && strcmp(name, location) == 0) {
            return camera;
        }
    }
    return NULL;
}

static bool read_numbers(const json_t *array, double *out, size_t count)
{
    if (!json_is_array(array) || json_array_size(array) < count) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        const json_t *value = json_array_get(array, i);
        if (!json_is_number(value)) {
            return false;
        }
        out[i] = json_number_value(value);
    }
    return true;
}

/* The early model differs in the terms p1 and p2, which are 0 in every camera that was sold. */
static void tell_lost(const char *file, const json_t *intrinsics, const double v[14])
{
    const char *type = json_string_value(json_object_get(intrinsics, "ModelType"));
    const bool has_centre = v[10] != 0.0 || v[11] != 0.0;
    const bool has_tangent = v[12] != 0.0 || v[13] != 0.0;
    const bool is_known = type == NULL || strstr(type, "BrownConrady") != NULL ||
                          (strstr(type, "Rational6KT") != NULL && !has_tangent);
    if (!is_known || has_centre) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the attached calibration has %s%.60s, which Relief does not have: it is left "
                "out; give a calibration with ?camera=FILE",
                file, has_centre ? "a centre of distortion" : "the lens model ",
                has_centre ? "" : type);
    }
}

/* cx cy fx fy, k1 .. k6, the centre of distortion (0), p2 p1. A pixel's corner is its origin. */
static bool read_intrinsics(const char *file, json_t *from, const window *w, rlf_camera *out)
{
    double v[14];
    const json_t *intrinsics = json_object_get(from, "Intrinsics");
    if (!read_numbers(json_object_get(intrinsics, "ModelParameters"), v, 14)) {
        return false;
    }
    tell_lost(file, intrinsics, v);
    out->cx = v[0] * w->width - w->left - 0.5;
    out->cy = v[1] * w->height - w->top - 0.5;
    out->fx = v[2] * w->width;
    out->fy = v[3] * w->height;
    const double distortion[8] = {v[4], v[5], v[13], v[12], v[6], v[7], v[8], v[9]};
    out->distortion_model = RLF_DISTORTION_RATIONAL_POLYNOMIAL;
    memcpy(out->distortion, distortion, sizeof(distortion));
    return true;
}

/* p_camera = R p_reference + t, metres. */
static bool read_pose(json_t *from, rlf_pose *out)
{
    double r[9];
    double t[3];
    json_t *rt = json_object_get(from, "Rt");
    if (!read_numbers(json_object_get(rt, "Rotation"), r, 9) ||
        !read_numbers(json_object_get(rt, "Translation"), t, 3)) {
        return false;
    }
    if (!io_rotation_read(r, ROTATION_TOLERANCE, &out->q)) {
        return false;
    }
    out->p = rlf_vec3_make(t[0], t[1], t[2]);
    return true;
}

static rlf_result read_all(json_t *top, const char *file, rlf_rig *rig)
{
    window w;
    rlf_pose T_depth = rlf_pose_identity();
    rlf_pose T_color = rlf_pose_identity();
    json_t *depth = find_camera(top, "CALIBRATION_CameraLocationD0");
    json_t *color = find_camera(top, "CALIBRATION_CameraLocationPV0");
    rlf_result result = depth_window(file, &rig->depth, &w);
    if (result != RLF_OK) {
        return result;
    }
    bool is_whole = read_intrinsics(file, depth, &w, &rig->depth) && read_pose(depth, &T_depth);
    if (is_whole && rig->has_color) {
        w = color_window(&rig->color, color);
        is_whole = read_intrinsics(file, color, &w, &rig->color) && read_pose(color, &T_color);
    }
    if (!is_whole) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the attached calibration is not complete: give one with ?camera=FILE",
                        file);
    }
    const rlf_pose T_reference = rlf_pose_invert(&T_depth);
    rig->T_color_depth =
        rig->has_color ? rlf_pose_mul(&T_color, &T_reference) : rlf_pose_identity();
    return RLF_OK;
}

rlf_result k4a_calibration_read(const io_bytes *file, rlf_rig *rig)
{
    io_bytes text = *file;
    while (text.size > 0 && text.data[text.size - 1] == '\0') {
        text.size--; /* some recorders attach the ending zero too */
    }
    json_t *top = NULL;
    rlf_result result = io_json_parse(&text, &top);
    if (result == RLF_OK) {
        result = read_all(top, file->name, rig);
        json_decref(top);
    }
    return result;
}
