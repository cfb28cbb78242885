/* The field names of four programs, and Brown-Conrady coefficients in OpenCV's order, that all but
 * Open3D share: k1 k2 p1 p2 k3 k4 k5 k6. */
#include "io/calibration/calibration.h"

#include <string.h>

#define COEFFICIENTS_MAX 14 /* OpenCV's: thin prism and tilt follow, which must be 0 here */

rlf_result io_calibration_numbers(const io_json_object *top, const char *const *names, double *out,
                                  size_t max, size_t *out_count)
{
    *out_count = 0;
    for (; *names != NULL; names++) {
        json_t *value = json_object_get(top->value, *names);
        io_json_object object = *top;
        const char *key = *names;
        if (json_is_object(value)) {
            snprintf(object.path, sizeof(object.path), "%s", *names);
            object.value = value;
            key = "data";
            value = json_object_get(value, key);
        }
        if (value == NULL || json_is_null(value)) {
            continue;
        }
        const size_t count = json_array_size(value);
        if (!json_is_array(value) || count > max) {
            return io_json_fail(&object, key, "must be a list of at most %zu numbers", max);
        }
        const io_json_field field = {key, "a list of numbers", -1e9, 1e9, true};
        *out_count = count;
        return io_json_get_numbers(&object, &field, out, count);
    }
    return RLF_OK;
}

/* Wide bounds, as of camera.json: they catch normalised intrinsics and wrong sizes. */
rlf_result io_calibration_check_lens(const io_json_object *top, const rlf_camera *c)
{
    const double size[2] = {c->width, c->height};
    const double focal[2] = {c->fx, c->fy};
    const double centre[2] = {c->cx, c->cy};
    for (int i = 0; i < 2; i++) {
        if (!(focal[i] >= size[i] / 100 && focal[i] <= size[i] * 100) ||
            !(centre[i] >= -2 * size[i] && centre[i] <= 3 * size[i])) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: focal length %g and centre %g do not fit a picture of %g pixels: "
                            "both must be in pixels, of pictures of that size",
                            top->file, focal[i], centre[i], size[i]);
        }
    }
    return RLF_OK;
}

rlf_result io_calibration_set_coefficients(const io_json_object *top, const double *k, size_t count,
                                           rlf_camera *c)
{
    for (size_t i = 8; i < count; i++) {
        if (k[i] != 0.0) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: has distortion coefficient %zu (thin prism or tilt): calibrate "
                            "with the model plumb_bob or rational_polynomial",
                            top->file, i + 1);
        }
    }
    const size_t used = count < 8 ? count : 8;
    bool is_rational = false, is_any = false;
    for (size_t i = 0; i < used; i++) {
        c->distortion[i] = k[i];
        is_any = is_any || k[i] != 0.0;
        is_rational = is_rational || (i >= 5 && k[i] != 0.0);
    }
    c->distortion_model = is_rational ? RLF_DISTORTION_RATIONAL_POLYNOMIAL
                          : is_any    ? RLF_DISTORTION_PLUMB_BOB
                                      : RLF_DISTORTION_NONE;
    return RLF_OK;
}

static rlf_result set_size(const io_json_object *top, double width, double height, rlf_camera *c)
{
    const double size[2] = {width, height};
    for (int i = 0; i < 2; i++) {
        if (!(size[i] >= 1 && size[i] <= RLF_IMAGE_SIZE_MAX) || size[i] != (int32_t)size[i]) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: picture size %g x %g: use whole numbers from 1 to %d", top->file,
                            width, height, RLF_IMAGE_SIZE_MAX);
        }
    }
    c->width = (int32_t)width;
    c->height = (int32_t)height;
    return RLF_OK;
}

rlf_result io_calibration_set_motion(const io_json_object *top, const double *r, size_t row,
                                     const double *t, size_t step, rlf_rig *out)
{
    json_t *motion =
        json_pack("{s:{s:[[f,f,f],[f,f,f],[f,f,f]],s:[f,f,f]}}", "depth_to_color", "rotation", r[0],
                  r[1], r[2], r[row], r[row + 1], r[row + 2], r[2 * row], r[2 * row + 1],
                  r[2 * row + 2], "translation", t[0], t[step], t[2 * step]);
    io_json_object object = *top;
    object.value = motion;
    rlf_result result = motion != NULL ? io_rig_read_motion(&object, out) : RLF_ERROR_MEMORY;
    json_decref(motion);
    return result;
}

/* ---- ROS and OpenCV ------------------------------------------------------------------------- */

static rlf_result read_size(const io_json_object *top, rlf_camera *c)
{
    static const char *const sizes[] = {"image_size", "imageSize", "size", NULL};
    static const char *const widths[] = {"image_width", "width"};
    static const char *const heights[] = {"image_height", "height"};
    double both[2] = {0.0, 0.0};
    size_t count = 0;
    rlf_result result = io_calibration_numbers(top, sizes, both, 2, &count);
    for (int i = 0; i < 2 && count == 0 && both[0] == 0.0 && result == RLF_OK; i++) {
        both[0] = json_number_value(json_object_get(top->value, widths[i]));
        both[1] = json_number_value(json_object_get(top->value, heights[i]));
    }
    if (result == RLF_OK && both[0] == 0.0 && both[1] == 0.0) {
        return io_json_fail(top, "image_width",
                            "and image_height are missing: add the pictures' size in pixels");
    }
    return result == RLF_OK ? set_size(top, both[0], both[1], c) : result;
}

static rlf_result check_model(const io_json_object *top)
{
    static const io_json_field field = {"distortion_model", "a name", 0, 0, false};
    const char *model = NULL;
    rlf_result result = io_json_get_text(top, &field, &model);
    if (result == RLF_OK && model != NULL && model[0] != '\0' && strcmp(model, "plumb_bob") != 0 &&
        strcmp(model, "rational_polynomial") != 0 && strcmp(model, "none") != 0) {
        return io_json_fail(top, field.key,
                            "is \"%.60s\": only plumb_bob and rational_polynomial are read", model);
    }
    const json_t *fisheye = json_object_get(top->value, "fisheye_model"); /* of OpenCV's sample */
    if (json_is_true(fisheye) || json_number_value(fisheye) != 0.0) {
        return io_json_fail(top, "fisheye_model",
                            "is set: fisheye lenses are not read: calibrate without it");
    }
    return result;
}

static const char *const matrices[2][9] = {
    {"camera_matrix", "cameraMatrix", "Camera_Matrix", "K", "k", "M1", "K1", "cameraMatrix1", NULL},
    {"M2", "K2", "cameraMatrix2", NULL}};

bool io_calibration_has_matrix(const io_json_object *top)
{
    static const char *const sizes[] = {"image_width", "width", "image_size", "imageSize", NULL};
    const char *const *const lists[2] = {matrices[0], sizes};
    for (int l = 0; l < 2; l++) {
        for (const char *const *name = lists[l]; *name != NULL; name++) {
            if (json_object_get(top->value, *name) != NULL) {
                return true;
            }
        }
    }
    return false;
}

static rlf_result get_count(const json_t *from, const char *key, const io_json_object *top,
                            uint32_t *out)
{
    const json_t *value = json_object_get(from, key);
    const double number = json_is_number(value) ? json_number_value(value) : 0.0;
    if (!(number >= 0.0 && number <= RLF_IMAGE_SIZE_MAX) || number != (uint32_t)number) {
        return io_json_fail(top, key, "is %g: it must be a whole number of pixels", number);
    }
    *out = (uint32_t)number;
    return RLF_OK;
}

/* What ROS's CameraInfo says of the picture's part: K is of the whole. */
static rlf_result apply_window(const io_json_object *top, rlf_camera *c)
{
    const json_t *roi = json_object_get(top->value, "roi");
    io_camera_window w = {0};
    const struct {
        const json_t *from;
        const char *key;
        uint32_t *to;
    } fields[6] = {{top->value, "binning_x", &w.binning_x},
                   {top->value, "binning_y", &w.binning_y},
                   {roi, "x_offset", &w.x},
                   {roi, "y_offset", &w.y},
                   {roi, "width", &w.width},
                   {roi, "height", &w.height}};
    for (int i = 0; i < 6; i++) {
        rlf_result result = get_count(fields[i].from, fields[i].key, top, fields[i].to);
        if (result != RLF_OK) {
            return result;
        }
    }
    return io_camera_window_apply(&w, c)
               ? RLF_OK
               : io_json_fail(top, "roi", "or binning leaves no part of the picture of %d x %d",
                              (int)c->width, (int)c->height);
}

rlf_result io_calibration_read_matrix(const io_json_object *top, bool second, rlf_camera *out)
{
    static const char *const lenses[2][9] = {{"distortion_coefficients", "distCoeffs",
                                              "dist_coeffs", "Distortion_Coefficients", "D", "d",
                                              "D1", "distCoeffs1", NULL},
                                             {"D2", "distCoeffs2", NULL}};
    double m[9] = {0}, k[COEFFICIENTS_MAX] = {0};
    size_t count = 0, lens_count = 0;
    memset(out, 0, sizeof(*out));
    rlf_result result = check_model(top);
    result =
        result == RLF_OK ? io_calibration_numbers(top, matrices[second], m, 9, &count) : result;
    if (result == RLF_OK &&
        (count != 9 || m[1] != 0.0 || m[3] != 0.0 || m[6] != 0.0 || m[7] != 0.0 || m[8] != 1.0)) {
        return io_json_fail(top, matrices[second][0],
                            "must be 9 numbers fx 0 cx 0 fy cy 0 0 1, by rows");
    }
    io_json_object sized = *top;
    json_t *own = second ? json_object_get(top->value, "second_image") : NULL;
    sized.value = json_is_object(own) ? own : top->value;
    result = result == RLF_OK ? read_size(&sized, out) : result;
    result = result == RLF_OK
                 ? io_calibration_numbers(top, lenses[second], k, COEFFICIENTS_MAX, &lens_count)
                 : result;
    out->fx = m[0];
    out->cx = m[2];
    out->fy = m[4];
    out->cy = m[5];
    result = result == RLF_OK ? io_calibration_set_coefficients(top, k, lens_count, out) : result;
    result = result == RLF_OK ? io_calibration_check_lens(top, out) : result;
    return result == RLF_OK ? apply_window(top, out) : result;
}

/* ---- Open3D --------------------------------------------------------------------------------- */

rlf_result io_calibration_read_open3d(const io_json_object *top, rlf_camera *out)
{
    static const io_json_field inner = {"intrinsic", "an object of Open3D", 0, 0, false};
    static const io_json_field field = {
        "intrinsic_matrix", "9 numbers fx 0 0 0 fy 0 cx cy 1, by columns", -1e9, 1e9, true};
    io_json_object object;
    memset(out, 0, sizeof(*out));
    rlf_result result = io_json_get_object(top, &inner, &object);
    const io_json_object *from = object.value != NULL ? &object : top;
    double m[9] = {0};
    result = result == RLF_OK ? io_json_get_numbers(from, &field, m, 9) : result;
    if (result == RLF_OK && (m[1] != 0.0 || m[2] != 0.0 || m[3] != 0.0 || m[5] != 0.0)) {
        return io_json_fail(from, field.key, "must be %s", field.meaning);
    }
    result = result == RLF_OK ? read_size(from, out) : result;
    out->fx = m[0];
    out->fy = m[4];
    out->cx = m[6];
    out->cy = m[7];
    return result == RLF_OK ? io_calibration_check_lens(from, out) : result;
}

/* ---- mrcal ---------------------------------------------------------------------------------- */

/* Rodrigues' vector and translation. */
static rlf_pose pose_from_rt(const double rt[6])
{
    const rlf_vec3 r = rlf_vec3_make(rt[0], rt[1], rt[2]);
    const rlf_pose pose = {.p = rlf_vec3_make(rt[3], rt[4], rt[5]),
                           .q = rlf_quat_from_rotation_vector(r)};
    return pose;
}

rlf_result io_calibration_read_mrcal(const io_json_object *top, rlf_camera *out,
                                     rlf_pose *out_T_camera_reference)
{
    static const char *const names[4] = {"LENSMODEL_PINHOLE", "LENSMODEL_OPENCV4",
                                         "LENSMODEL_OPENCV5", "LENSMODEL_OPENCV8"};
    static const size_t counts[4] = {4, 8, 9, 12};
    static const io_json_field model_field = {"lensmodel", "a text", 0, 0, true};
    static const io_json_field size_field = {"imagersize", "width and height", 1,
                                             RLF_IMAGE_SIZE_MAX, true};
    static const char *const poses[] = {"extrinsics", "rt_cam_ref", NULL};
    const char *model = "";
    double k[12] = {0}, size[2] = {0}, rt[6] = {0};
    size_t count = 0;
    int i = 0;
    memset(out, 0, sizeof(*out));
    rlf_result result = io_json_get_text(top, &model_field, &model);
    while (result == RLF_OK && i < 4 && strcmp(model, names[i]) != 0) {
        i++;
    }
    if (result == RLF_OK && i == 4) {
        return io_json_fail(top, "lensmodel",
                            "is \"%.60s\": only LENSMODEL_PINHOLE and LENSMODEL_OPENCV4, 5 and 8 "
                            "are read; mrcal-convert-lensmodel makes one",
                            model);
    }
    const io_json_field lens_field = {"intrinsics", "fx fy cx cy and the model's coefficients",
                                      -1e9, 1e9, true};
    result = result == RLF_OK ? io_json_get_numbers(top, &lens_field, k, counts[i]) : result;
    result = result == RLF_OK ? io_json_get_numbers(top, &size_field, size, 2) : result;
    result = result == RLF_OK ? io_calibration_numbers(top, poses, rt, 6, &count) : result;
    if (result == RLF_OK && count != 0 && count != 6) {
        return io_json_fail(top, poses[0], "has %zu numbers: it must be six", count);
    }
    result = result == RLF_OK ? set_size(top, size[0], size[1], out) : result;
    out->fx = k[0];
    out->fy = k[1];
    out->cx = k[2];
    out->cy = k[3];
    *out_T_camera_reference = pose_from_rt(rt);
    result =
        result == RLF_OK ? io_calibration_set_coefficients(top, k + 4, counts[i] - 4, out) : result;
    return result == RLF_OK ? io_calibration_check_lens(top, out) : result;
}
