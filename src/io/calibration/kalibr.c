/* camchain.yaml: cam0, cam1 ..., each a pinhole with its lens. */
#include "io/calibration/calibration.h"

#include <string.h>

static const io_json_field cameras[2] = {{"cam0", "a camera of kalibr", 0, 0, true},
                                         {"cam1", "a camera of kalibr", 0, 0, false}};

bool io_calibration_is_kalibr(const io_json_object *top)
{
    return json_is_object(json_object_get(top->value, "cam0"));
}

static rlf_result read_model(const io_json_object *camera, bool *out_is_straight)
{
    static const io_json_field shape = {"camera_model", "\"pinhole\"", 0, 0, true};
    static const io_json_field lens = {"distortion_model", "\"radtan\" or \"none\"", 0, 0, false};
    const char *model = "", *distortion = NULL;
    rlf_result result = io_json_get_text(camera, &shape, &model);
    result = result == RLF_OK ? io_json_get_text(camera, &lens, &distortion) : result;
    if (result == RLF_OK && strcmp(model, "pinhole") != 0) {
        return io_json_fail(camera, shape.key,
                            "is \"%.40s\": only pinhole is read: calibrate with pinhole-radtan",
                            model);
    }
    *out_is_straight = distortion == NULL || strcmp(distortion, "none") == 0;
    if (result == RLF_OK && !*out_is_straight && strcmp(distortion, "radtan") != 0) {
        return io_json_fail(camera, lens.key,
                            "is \"%.40s\": only radtan and none are read: calibrate with "
                            "pinhole-radtan",
                            distortion);
    }
    return result;
}

static rlf_result read_camera(const io_json_object *camera, rlf_camera *out)
{
    static const io_json_field size = {"resolution", "width and height in pixels", 1,
                                       RLF_IMAGE_SIZE_MAX, true};
    static const io_json_field pinhole = {"intrinsics", "fu fv pu pv in pixels", -1e9, 1e9, true};
    static const io_json_field lens = {"distortion_coeffs", "k1 k2 p1 p2", -1e6, 1e6, true};
    double s[2] = {0}, k[4] = {0}, d[4] = {0};
    bool is_straight = false;
    rlf_result result = read_model(camera, &is_straight);
    result = result == RLF_OK ? io_json_get_numbers(camera, &size, s, 2) : result;
    result = result == RLF_OK ? io_json_get_numbers(camera, &pinhole, k, 4) : result;
    if (result == RLF_OK && !is_straight) {
        result = io_json_get_numbers(camera, &lens, d, 4);
    }
    *out = (rlf_camera){.width = (int32_t)s[0],
                        .height = (int32_t)s[1],
                        .fx = k[0],
                        .fy = k[1],
                        .cx = k[2],
                        .cy = k[3]};
    result = result == RLF_OK ? io_calibration_set_coefficients(camera, d, 4, out) : result;
    return result == RLF_OK ? io_calibration_check_lens(camera, out) : result;
}

/* T_cn_cnm1: four rows that lead from the camera before to this one, metres. */
static rlf_result read_motion(const io_json_object *camera, rlf_rig *out)
{
    static const char key[] = "T_cn_cnm1";
    const json_t *rows = json_object_get(camera->value, key);
    double m[3][4];
    bool is_whole = json_is_array(rows) && json_array_size(rows) == 4;
    for (size_t i = 0; i < 12 && is_whole; i++) {
        const json_t *number = json_array_get(json_array_get(rows, i / 4), i % 4);
        is_whole = json_is_number(number);
        m[i / 4][i % 4] = json_number_value(number);
    }
    if (!is_whole) {
        return io_json_fail(camera, key, "must be four rows of four numbers");
    }
    return io_calibration_set_motion(camera, &m[0][0], 4, &m[0][3], 4, out);
}

rlf_result io_calibration_read_kalibr(const io_json_object *top, rlf_rig *out, bool *out_has_motion)
{
    io_json_object first, second;
    rlf_result result = io_json_get_object(top, &cameras[0], &first);
    result = result == RLF_OK ? io_json_get_object(top, &cameras[1], &second) : result;
    result = result == RLF_OK ? read_camera(&first, &out->depth) : result;
    if (result != RLF_OK || second.value == NULL) {
        return result;
    }
    if (json_object_get(top->value, "cam2") != NULL) {
        rlf_log(RLF_LOG_WARNING,
                "%s: has more than two cameras: cam0 is taken as depth, cam1 as colour, and the "
                "others are left out",
                top->file);
    }
    out->has_color = true;
    *out_has_motion = true;
    result = read_camera(&second, &out->color);
    return result == RLF_OK ? read_motion(&second, out) : result;
}
