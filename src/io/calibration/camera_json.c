/* camera.json: the intrinsics of the depth and colour cameras and the transform between them. */
#include "io/calibration/calibration.h"
#include "io/json.h"

#include <math.h>
#include <string.h>

#define SIZE_MEANING "the picture's size in pixels, a whole number from 1 to 16384"
#define FOCAL_MEANING "the focal length in pixels, between a hundredth and a hundred times the size"
#define CENTRE_MEANING "the principal point in pixels, no farther than two sizes from the picture"

/* Deviation from a rotation that rounding to four decimals can cause. */
#define ROTATION_TOLERANCE 1e-3
/* Of the cosine of half an angle: the rotation and the quaternion were written as one. */
#define QUATERNION_TOLERANCE 1e-12

static void warn_unknown(const io_json_object *object, const char *const *known, size_t count)
{
    const char *key = io_json_unknown_key(object, known, count);
    if (key != NULL) {
        rlf_log(RLF_LOG_WARNING, "%s: %s%s%.60s is not a known key and is not used", object->file,
                object->path, object->path[0] != '\0' ? "." : "", key);
    }
}

/* Numbers beside "none" would be dropped, whatever they are for. */
static rlf_result check_no_distortion(const io_json_object *object, const json_t *numbers)
{
    for (size_t i = 0; i < json_array_size(numbers); i++) {
        if (json_number_value(json_array_get(numbers, i)) != 0.0) {
            return io_json_fail(
                object, "distortion",
                "has numbers other than 0 beside the distortion_model \"none\": name "
                "their model, or leave them out");
        }
    }
    return RLF_OK;
}

static rlf_result read_distortion(const io_json_object *object, rlf_camera *camera)
{
    static const io_json_field model_field = {
        "distortion_model", "\"none\", \"plumb_bob\" or \"rational_polynomial\"", 0, 0, false};
    static const io_json_field plumb_bob_field = {
        "distortion", "the 5 numbers k1 k2 p1 p2 k3 of plumb_bob", -1e6, 1e6, true};
    static const io_json_field rational_field = {
        "distortion", "the 8 numbers k1 k2 p1 p2 k3 k4 k5 k6 of rational_polynomial", -1e6, 1e6,
        true};
    const char *model = NULL;
    rlf_result result = io_json_get_text(object, &model_field, &model);
    if (result != RLF_OK) {
        return result;
    }
    const json_t *numbers = json_object_get(object->value, "distortion");
    if (model == NULL && numbers != NULL && json_array_size(numbers) != 0) {
        return io_json_fail(object, "distortion_model",
                            "is missing beside distortion: it must be "
                            "%s",
                            model_field.meaning);
    }
    if (model == NULL || strcmp(model, "none") == 0) {
        return check_no_distortion(object, numbers);
    }
    if (strcmp(model, "plumb_bob") == 0) {
        camera->distortion_model = RLF_DISTORTION_PLUMB_BOB;
        return io_json_get_numbers(object, &plumb_bob_field, camera->distortion, 5);
    }
    if (strcmp(model, "rational_polynomial") == 0) {
        camera->distortion_model = RLF_DISTORTION_RATIONAL_POLYNOMIAL;
        return io_json_get_numbers(object, &rational_field, camera->distortion, 8);
    }
    return io_json_fail(object, "distortion_model", "is \"%.60s\": it must be %s", model,
                        model_field.meaning);
}

static rlf_result read_camera(const io_json_object *object, rlf_camera *camera)
{
    memset(camera, 0, sizeof(*camera));
    const io_json_field width = {"width", SIZE_MEANING, 1, RLF_IMAGE_SIZE_MAX, true};
    const io_json_field height = {"height", SIZE_MEANING, 1, RLF_IMAGE_SIZE_MAX, true};
    rlf_result result = io_json_get_integer(object, &width, &camera->width);
    result = result == RLF_OK ? io_json_get_integer(object, &height, &camera->height) : result;
    if (result != RLF_OK) {
        return result;
    }
    /* Wide bounds: they only catch normalised intrinsics (fx = 0.7) and wrong sizes. */
    double w = camera->width;
    double h = camera->height;
    const io_json_field fields[4] = {{"fx", FOCAL_MEANING, w / 100, w * 100, true},
                                     {"fy", FOCAL_MEANING, h / 100, h * 100, true},
                                     {"cx", CENTRE_MEANING, -2 * w, 3 * w, true},
                                     {"cy", CENTRE_MEANING, -2 * h, 3 * h, true}};
    double *const targets[4] = {&camera->fx, &camera->fy, &camera->cx, &camera->cy};
    for (int i = 0; i < 4; i++) {
        result = io_json_get_number(object, &fields[i], targets[i]);
        if (result != RLF_OK) {
            return result;
        }
    }
    return read_distortion(object, camera);
}

static rlf_result read_depth(const io_json_object *top, rlf_rig *rig, double *out_units)
{
    static const char *const known[] = {"width",
                                        "height",
                                        "fx",
                                        "fy",
                                        "cx",
                                        "cy",
                                        "distortion_model",
                                        "distortion",
                                        "units_per_metre",
                                        "depth_min_m",
                                        "depth_max_m",
                                        "noise",
                                        "depth_offset_m"};
    static const io_json_field field = {"depth", "an object with the depth camera's intrinsics", 0,
                                        0, true};
    static const io_json_field units = {
        "units_per_metre", "the depth counts per metre, 1 to 1000000 (1000 for millimetres)", 1,
        1e6, true};
    static const io_json_field range[2] = {
        {"depth_min_m", "the nearest depth in metres, 0 to 1000", 0, 1000, false},
        {"depth_max_m", "the farthest depth in metres, > depth_min_m and at most 1000", IO_POSITIVE,
         1000, false}};
    static const io_json_field noise = {
        "noise", "three numbers [c0, c1, c2]: sigma = c0 + c1 z + c2 z^2 metres", -1, 1, false};
    io_json_object depth;
    rlf_result result = io_json_get_object(top, &field, &depth);
    result = result == RLF_OK ? read_camera(&depth, &rig->depth) : result;
    result = result == RLF_OK ? io_json_get_number(&depth, &units, out_units) : result;
    result = result == RLF_OK ? io_json_get_number(&depth, &range[0], &rig->depth_min_m) : result;
    result = result == RLF_OK ? io_json_get_number(&depth, &range[1], &rig->depth_max_m) : result;
    double c[3] = {rig->noise.c0, rig->noise.c1, rig->noise.c2};
    result = result == RLF_OK ? io_json_get_numbers(&depth, &noise, c, 3) : result;
    if (result != RLF_OK) {
        return result;
    }
    rig->noise = (rlf_depth_noise){c[0], c[1], c[2]};
    static const io_json_field offset = {
        "depth_offset_m", "by how many metres depth is too far, -0.5 to 0.5", -0.5, 0.5, false};
    result = io_json_get_number(&depth, &offset, &rig->depth_offset_m);
    if (result != RLF_OK) {
        return result;
    }
    if (rig->depth_max_m <= rig->depth_min_m) {
        return io_json_fail(&depth, "depth_max_m", "is %g: it must be %s", rig->depth_max_m,
                            range[1].meaning);
    }
    warn_unknown(&depth, known, sizeof(known) / sizeof(known[0]));
    return RLF_OK;
}

static rlf_result read_color(const io_json_object *top, rlf_rig *rig)
{
    static const char *const known[] = {"width", "height",           "fx",        "fy", "cx",
                                        "cy",    "distortion_model", "distortion"};
    static const io_json_field field = {"color", "an object with the colour camera's intrinsics", 0,
                                        0, false};
    io_json_object color;
    rlf_result result = io_json_get_object(top, &field, &color);
    if (result != RLF_OK || color.value == NULL) {
        return result;
    }
    rig->has_color = true;
    result = read_camera(&color, &rig->color);
    if (result == RLF_OK) {
        warn_unknown(&color, known, sizeof(known) / sizeof(known[0]));
    }
    return result;
}

/* Largest entry of |R R^T - 1|; infinity where R is not finite. */
static double rotation_error(const double *rows)
{
    rlf_mat3 r;
    memcpy(r.m, rows, sizeof(r.m));
    const rlf_mat3 transposed = rlf_mat3_transpose(&r);
    const rlf_mat3 product = rlf_mat3_mul(&r, &transposed);
    double worst = 0.0;
    for (int i = 0; i < 9; i++) {
        const double error = fabs(product.m[i / 3][i % 3] - (i / 3 == i % 3 ? 1.0 : 0.0));
        worst = isfinite(error) ? rlf_max(worst, error) : INFINITY;
    }
    return worst;
}

static double determinant(const double *r)
{
    return rlf_dot(rlf_vec3_make(r[0], r[1], r[2]),
                   rlf_cross(rlf_vec3_make(r[3], r[4], r[5]), rlf_vec3_make(r[6], r[7], r[8])));
}

bool io_rotation_read(const double rows[9], double tolerance, rlf_quat *out)
{
    rlf_mat3 r;
    memcpy(r.m, rows, sizeof(r.m));
    if (!(rotation_error(rows) <= tolerance) || !(determinant(rows) > 0.0)) {
        return false;
    }
    *out = rlf_quat_normalize(rlf_quat_from_mat3(&r));
    return true;
}

static rlf_result read_rotation(const io_json_object *object, rlf_quat *out)
{
    static const char meaning[] =
        "three rows of three numbers that form a rotation (orthogonal, determinant +1)";
    const json_t *list = json_object_get(object->value, "rotation");
    double rows[9];
    bool is_complete = json_is_array(list) && json_array_size(list) == 3;
    for (size_t r = 0; r < 3 && is_complete; r++) {
        const json_t *row = json_array_get(list, r);
        is_complete = json_is_array(row) && json_array_size(row) == 3;
        for (size_t c = 0; c < 3 && is_complete; c++) {
            is_complete = json_is_number(json_array_get(row, c));
            rows[3 * r + c] = json_number_value(json_array_get(row, c));
        }
    }
    if (!is_complete) {
        return io_json_fail(object, "rotation", "is %s: it must be %s",
                            list == NULL ? "missing" : "not complete", meaning);
    }
    if (!io_rotation_read(rows, ROTATION_TOLERANCE, out)) {
        return io_json_fail(object, "rotation",
                            "is not a rotation (off by %.3g, determinant %.3g): it must be %s",
                            rotation_error(rows), determinant(rows), meaning);
    }
    return RLF_OK;
}

/* The same motion bit by bit, as Relief wrote it. Where the two differ someone has changed the
 * rotation, which counts. */
static rlf_result read_quaternion(const io_json_object *object, rlf_quat *inout)
{
    static const io_json_field field = {
        "quaternion", "four numbers x y z w of unit length, the same as rotation", -1, 1, false};
    double n[4] = {inout->x, inout->y, inout->z, inout->w};
    rlf_result result = io_json_get_numbers(object, &field, n, 4);
    const double cosine = n[0] * inout->x + n[1] * inout->y + n[2] * inout->z + n[3] * inout->w;
    const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3];
    if (result == RLF_OK && cosine * cosine > 1.0 - QUATERNION_TOLERANCE &&
        square < 1.0 + QUATERNION_TOLERANCE) {
        *inout = (rlf_quat){n[0], n[1], n[2], n[3]};
    }
    return result;
}

rlf_result io_rig_read_motion(const io_json_object *top, rlf_rig *rig)
{
    static const char *const known[] = {"rotation", "quaternion", "translation"};
    static const io_json_field field = {
        "depth_to_color", "an object with rotation and translation: p_color = R p_depth + t", 0, 0,
        false};
    static const io_json_field translation = {
        "translation", "three numbers in metres (not millimetres), each at most 10", -10, 10, true};
    io_json_object object;
    rlf_result result = io_json_get_object(top, &field, &object);
    if (result != RLF_OK || object.value == NULL) {
        return result;
    }
    double t[3];
    result = read_rotation(&object, &rig->T_color_depth.q);
    result = result == RLF_OK ? read_quaternion(&object, &rig->T_color_depth.q) : result;
    result = result == RLF_OK ? io_json_get_numbers(&object, &translation, t, 3) : result;
    if (result == RLF_OK) {
        rig->T_color_depth.p = rlf_vec3_make(t[0], t[1], t[2]);
        warn_unknown(&object, known, sizeof(known) / sizeof(known[0]));
    }
    return result;
}

rlf_result io_rig_from_json(const io_json_object *top, rlf_rig *out, double *out_units_per_metre)
{
    static const char *const known[] = {"depth", "color", "depth_to_color", "note"};
    rlf_rig rig = rlf_rig_default();
    double units = 0.0;
    rlf_result result = read_depth(top, &rig, &units);
    result = result == RLF_OK ? read_color(top, &rig) : result;
    result = result == RLF_OK ? io_rig_read_motion(top, &rig) : result;
    if (result == RLF_OK) {
        warn_unknown(top, known, sizeof(known) / sizeof(known[0]));
        *out = rig;
        *out_units_per_metre = units;
    }
    return result;
}

rlf_result io_rig_parse(const io_bytes *file, rlf_rig *out, double *out_units_per_metre)
{
    json_t *document = NULL;
    rlf_result result = io_json_parse(file, &document);
    if (result == RLF_OK) {
        const io_json_object top = io_json_top(file, document);
        result = io_rig_from_json(&top, out, out_units_per_metre);
    }
    json_decref(document);
    return result;
}

/* ---- windows and binning ----------------------------------------------------------------- */

/* One direction. Centres of pixels are whole numbers, so the first pixel of n joined ones begins at
 * -0.5 and their common centre is at (n - 1) / 2. */
static bool cut(uint32_t begin, uint32_t length, uint32_t binning, int32_t *size, double *focal,
                double *centre)
{
    const uint32_t whole = *size > 0 ? (uint32_t)*size : 0;
    const uint32_t kept = length > 0 ? length : whole;
    const uint32_t joined = binning > 0 ? binning : 1;
    if (begin > whole || kept > whole - begin || kept / joined == 0) {
        return false;
    }
    *size = (int32_t)(kept / joined);
    if (joined > 1 || begin > 0) {
        *focal /= joined;
        *centre = (*centre - begin + 0.5) / joined - 0.5;
    }
    return true;
}

bool io_camera_window_apply(const io_camera_window *window, rlf_camera *camera)
{
    const bool is_part = window->width > 0 || window->height > 0;
    const uint32_t x = is_part ? window->x : 0;
    const uint32_t y = is_part ? window->y : 0;
    rlf_camera c = *camera;
    if (!cut(x, window->width, window->binning_x, &c.width, &c.fx, &c.cx) ||
        !cut(y, window->height, window->binning_y, &c.height, &c.fy, &c.cy)) {
        return false;
    }
    *camera = c;
    return true;
}
