/* Any calibration file as a rig. */
#include "relief/io.h"
#include "io/calibration/calibration.h"
#include "io/clip/clip.h"

#include <string.h>

#define UNITS_DEFAULT 1000.0 /* counts a metre: what most cameras store */

/* What one file tells. */
typedef struct part {
    rlf_rig rig; /* a file with one camera: it is rig.depth */
    double units_per_metre;
    bool has_motion;    /* rig.T_color_depth was read */
    bool has_reference; /* mrcal: cameras of one rig share it */
    rlf_pose T_camera_reference;
    bool has_shift; /* ROS: of a rectified pair */
    rlf_quat to_rectified;
    double shift_m; /* of the other camera's points along x, rectified */
} part;

static bool has_key(const io_json_object *top, const char *key)
{
    return json_object_get(top->value, key) != NULL;
}

/* R and T of OpenCV's stereo calibration: p2 = R p1 + T. */
static rlf_result read_stereo(const io_json_object *top, part *out)
{
    static const char *const rotations[] = {"R", NULL};
    static const char *const translations[] = {"T", NULL};
    double r[9], t[3];
    size_t count[2] = {0, 0};
    rlf_result result = io_calibration_numbers(top, rotations, r, 9, &count[0]);
    result = result == RLF_OK ? io_calibration_numbers(top, translations, t, 3, &count[1]) : result;
    if (result != RLF_OK) {
        return result;
    }
    if (count[0] != 9 || count[1] != 3) {
        return io_json_fail(top, "R",
                            "and T are missing: a pair needs p2 = R p1 + T, 9 and 3 "
                            "numbers");
    }
    out->has_motion = true;
    return io_calibration_set_motion(top, r, 3, t, 1, &out->rig);
}

/* ROS has a rectified pair's baseline in P: P[3] = -fx baseline, and R turns into that frame. */
static rlf_result read_shift(const io_json_object *top, part *out)
{
    static const char *const rotations[] = {"rectification_matrix", "R", "r", NULL};
    static const char *const projections[] = {"projection_matrix", "P", "p", NULL};
    double p[12], r[9];
    size_t count[2] = {0, 0};
    rlf_result result = io_calibration_numbers(top, projections, p, 12, &count[0]);
    result = result == RLF_OK ? io_calibration_numbers(top, rotations, r, 9, &count[1]) : result;
    if (result != RLF_OK || count[0] != 12 || count[1] != 9 || !(p[0] > 0.0)) {
        return result;
    }
    rlf_mat3 m;
    memcpy(m.m, r, sizeof(r));
    out->has_shift = true;
    out->to_rectified = rlf_quat_normalize(rlf_quat_from_mat3(&m));
    out->shift_m = p[3] / p[0];
    return RLF_OK;
}

static rlf_result read_yaml(const io_json_object *top, part *out)
{
    static const char *const seconds[] = {"M2", "K2", "cameraMatrix2"};
    rlf_result result = io_calibration_read_matrix(top, false, &out->rig.depth);
    for (int i = 0; i < 3 && result == RLF_OK; i++) {
        if (has_key(top, seconds[i])) {
            out->rig.has_color = true;
            result = io_calibration_read_matrix(top, true, &out->rig.color);
            return result == RLF_OK ? read_stereo(top, out) : result;
        }
    }
    return result == RLF_OK ? read_shift(top, out) : result;
}

static rlf_result read_part(const io_json_object *top, part *out)
{
    rlf_result result = RLF_OK;
    if (has_key(top, "lensmodel")) {
        out->has_reference = true;
        return io_calibration_read_mrcal(top, &out->rig.depth, &out->T_camera_reference);
    }
    if (io_calibration_is_kalibr(top)) {
        return io_calibration_read_kalibr(top, &out->rig, &out->has_motion);
    }
    if (has_key(top, "intrinsic_matrix") || has_key(top, "intrinsic")) {
        result = io_calibration_read_open3d(top, &out->rig.depth);
    } else if (io_calibration_has_matrix(top)) {
        result = read_yaml(top, out);
    } else {
        return io_calibration_fail_unknown(top);
    }
    if (result == RLF_OK && has_key(top, "depth_to_color")) {
        out->has_motion = true;
        result = io_rig_read_motion(top, &out->rig);
    }
    return result;
}

static rlf_result parse(const io_bytes *file, part *out)
{
    *out = (part){.rig = rlf_rig_default(), .units_per_metre = UNITS_DEFAULT};
    json_t *document = NULL;
    io_calibration_kind kind = IO_CALIBRATION_JSON;
    rlf_result result = io_calibration_kind_of(file, &kind);
    if (result == RLF_OK) {
        result = kind == IO_CALIBRATION_JSON   ? io_json_parse(file, &document)
                 : kind == IO_CALIBRATION_TEXT ? io_calibration_text_parse(file, &document)
                                               : io_calibration_xml_parse(file, &document);
    }
    if (result == RLF_OK) {
        const io_json_object top = io_json_top(file, document);
        /* An empty object is told what is missing. */
        const bool is_own =
            kind == IO_CALIBRATION_JSON &&
            (has_key(&top, "depth") || has_key(&top, "color") || json_object_size(document) == 0);
        result = is_own ? io_rig_from_json(&top, &out->rig, &out->units_per_metre)
                        : read_part(&top, out);
    }
    json_decref(document);
    return result;
}

static rlf_result load(const char *path, part *out)
{
    io_buffer buffer = {0};
    io_bytes file;
    rlf_result result = io_file_read(path, IO_JSON_FILE_MAX,
                                     "write the camera's intrinsics there, docs/formats.md shows "
                                     "how",
                                     &buffer, &file);
    result = result == RLF_OK ? parse(&file, out) : result;
    io_buffer_free(&buffer);
    return result;
}

/* ---- two files ------------------------------------------------------------------------------ */

static rlf_result join(const char *path, const part *depth, const part *color, rlf_rig *out)
{
    if (depth->rig.has_color || color->rig.has_color) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: one of the two files holds two cameras: give it "
                        "alone",
                        path);
    }
    *out = depth->rig;
    out->has_color = true;
    out->color = color->rig.depth;
    if (color->has_motion) {
        out->T_color_depth = color->rig.T_color_depth;
    } else if (depth->has_reference && color->has_reference) {
        const rlf_pose back = rlf_pose_invert(&depth->T_camera_reference);
        out->T_color_depth = rlf_pose_mul(&color->T_camera_reference, &back);
    } else if (depth->has_shift && color->has_shift && color->shift_m != depth->shift_m) {
        const rlf_quat back = rlf_quat_conjugate(color->to_rectified);
        const rlf_vec3 shift = rlf_vec3_make(color->shift_m - depth->shift_m, 0.0, 0.0);
        out->T_color_depth.q = rlf_quat_mul(back, depth->to_rectified);
        out->T_color_depth.p = rlf_rotate(back, shift);
    } else {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: neither file tells where the second camera is: add depth_to_color to "
                        "it, as in docs/calibration.md",
                        path);
    }
    return RLF_OK;
}

rlf_result rlf_rig_load(const char *path, rlf_rig *out, double *out_units_per_metre)
{
    if (!RLF_ASSERT(path != NULL && out != NULL && out_units_per_metre != NULL)) {
        return RLF_ERROR_INVALID;
    }
    char first[IO_PATH_MAX];
    part depth, color;
    const char *comma = strchr(path, ',');
    const size_t length = comma != NULL ? (size_t)(comma - path) : 0;
    const bool is_pair = comma != NULL && length < sizeof(first) && !io_path_exists(path);
    if (is_pair) {
        memcpy(first, path, length);
        first[length] = '\0';
    }
    rlf_result result = load(is_pair ? first : path, &depth);
    if (result == RLF_OK && is_pair) {
        result = load(comma + 1, &color);
        result = result == RLF_OK ? join(path, &depth, &color, &depth.rig) : result;
    }
    if (result == RLF_OK) {
        *out = depth.rig;
        *out_units_per_metre = depth.units_per_metre;
    }
    return result;
}

/* ---- calibration of recordings that hold none --------------------------------------------------
 */

static bool is_file(const char *path)
{
    return io_path_exists(path) && !io_path_is_folder(path);
}

static bool find_file(const char *place, char out[IO_PATH_MAX])
{
    const char *slash = strrchr(place, '/');
    const char *name = slash != NULL ? slash + 1 : place;
    const char *dot = strrchr(name, '.');
    const int stem = (int)(dot != NULL && dot > name ? dot - place : (ptrdiff_t)strlen(place));
    int length = snprintf(out, IO_PATH_MAX, "%.*s.json", stem, place);
    if (length > 0 && length < IO_PATH_MAX && is_file(out)) {
        return true;
    }
    length = snprintf(out, IO_PATH_MAX, "%.*scamera.json", (int)(name - place), place);
    return length > 0 && length < IO_PATH_MAX && is_file(out);
}

rlf_result io_rig_beside(const rlf_address *address, rlf_rig *out, double *out_units_per_metre,
                         bool *out_found)
{
    char path[IO_PATH_MAX];
    *out_found = true;
    if (address->rig != NULL) {
        *out = *address->rig;
        *out_units_per_metre = address->units_per_metre;
        return RLF_OK;
    }
    *out_found = find_file(address->place, path);
    return *out_found ? rlf_rig_load(path, out, out_units_per_metre) : RLF_OK;
}

rlf_result io_rig_check_size(const char *name, const char *what, int64_t width, int64_t height,
                             const rlf_camera *camera)
{
    return width == camera->width && height == camera->height
               ? RLF_OK
               : rlf_fail(RLF_ERROR_INVALID,
                          "%s: its pictures of %s are %lld x %lld, and the calibration is for %d x "
                          "%d: give one of that size with ?camera=FILE",
                          name, what, (long long)width, (long long)height, (int)camera->width,
                          (int)camera->height);
}
