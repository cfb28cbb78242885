/* A rig in the formats of other programs, and as camera.json. */
#include "relief/io.h"
#include "io/json.h"

#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_MAX 8192

/* A text that grows in place; whatever does not fit is an error at the end. */
typedef struct writer {
    char text[TEXT_MAX];
    size_t length;
} writer;

RLF_PRINTF(2, 3) static void add(writer *w, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int count =
        vsnprintf(w->text + w->length, sizeof(w->text) - w->length, format, arguments);
    va_end(arguments);
    w->length = count < 0 || w->length + (size_t)count >= sizeof(w->text)
                    ? sizeof(w->text) - 1
                    : w->length + (size_t)count;
}

/* "[1.0, 2.5]", as JSON, YAML and Python all read it; jansson keeps every bit in any locale. */
static void add_numbers(writer *w, const double *x, int count)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++) {
        json_array_append_new(list, json_real(x[i]));
    }
    char *text = json_dumps(list, JSON_ENCODE_ANY);
    add(w, "%s", text != NULL ? text : "[]");
    free(text);
    json_decref(list);
}

static rlf_result finish(const writer *w, const char *path)
{
    if (w->length + 1 >= sizeof(w->text)) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: the text is too long", path);
    }
    return rlf_file_write(path, w->text, w->length);
}

static int coefficient_count(const rlf_camera *c)
{
    return c->distortion_model == RLF_DISTORTION_RATIONAL_POLYNOMIAL ? 8 : 5;
}

static const char *model_name(const rlf_camera *c)
{
    return c->distortion_model == RLF_DISTORTION_RATIONAL_POLYNOMIAL ? "rational_polynomial"
                                                                     : "plumb_bob";
}

static void camera_matrix(const rlf_camera *c, double out[9])
{
    const double m[9] = {c->fx, 0.0, c->cx, 0.0, c->fy, c->cy, 0.0, 0.0, 1.0};
    memcpy(out, m, sizeof(m));
}

/* ---- camera.json and Open3D ----------------------------------------------------------------- */

static json_t *motion_json(const rlf_pose *T)
{
    const rlf_mat3 r = rlf_quat_to_mat3(T->q);
    return json_pack("{s:[[f,f,f],[f,f,f],[f,f,f]], s:[f,f,f,f], s:[f,f,f]}", "rotation", r.m[0][0],
                     r.m[0][1], r.m[0][2], r.m[1][0], r.m[1][1], r.m[1][2], r.m[2][0], r.m[2][1],
                     r.m[2][2], "quaternion", T->q.x, T->q.y, T->q.z, T->q.w, "translation", T->p.x,
                     T->p.y, T->p.z);
}

static json_t *camera_json(const rlf_camera *c)
{
    json_t *out = json_pack("{s:i, s:i, s:f, s:f, s:f, s:f}", "width", (int)c->width, "height",
                            (int)c->height, "fx", c->fx, "fy", c->fy, "cx", c->cx, "cy", c->cy);
    if (c->distortion_model != RLF_DISTORTION_NONE) {
        json_t *distortion = json_array();
        for (int i = 0; i < coefficient_count(c); i++) {
            json_array_append_new(distortion, json_real(c->distortion[i]));
        }
        json_object_set_new(out, "distortion_model", json_string(model_name(c)));
        json_object_set_new(out, "distortion", distortion);
    }
    return out;
}

static void add_depth_keys(const rlf_rig *rig, double units_per_metre, json_t *depth)
{
    const rlf_depth_noise *n = &rig->noise;
    json_object_set_new(depth, "units_per_metre", json_real(units_per_metre));
    if (rig->depth_max_m > 0.0) {
        json_object_set_new(depth, "depth_min_m", json_real(rig->depth_min_m));
        json_object_set_new(depth, "depth_max_m", json_real(rig->depth_max_m));
    }
    if (rig->depth_offset_m != 0.0) {
        json_object_set_new(depth, "depth_offset_m", json_real(rig->depth_offset_m));
    }
    if (n->c0 != 0.0 || n->c1 != 0.0 || n->c2 != 0.0) {
        json_object_set_new(depth, "noise", json_pack("[f,f,f]", n->c0, n->c1, n->c2));
    }
}

static rlf_result write_relief(const char *path, const rlf_rig *rig, double units_per_metre,
                               const char *note)
{
    json_t *root = json_object();
    json_t *depth = camera_json(&rig->depth);
    add_depth_keys(rig, units_per_metre, depth);
    json_object_set_new(root, "depth", depth);
    if (rig->has_color) {
        json_object_set_new(root, "color", camera_json(&rig->color));
        json_object_set_new(root, "depth_to_color", motion_json(&rig->T_color_depth));
    }
    if (note != NULL) {
        json_object_set_new(root, "note", json_string(note));
    }
    return io_json_write(path, root, 0);
}

static rlf_result write_open3d(const char *path, const rlf_camera *c, const rlf_pose *T_color_depth)
{
    json_t *root = json_pack("{s:i, s:i, s:[f,f,f,f,f,f,f,f,f]}", "width", (int)c->width, "height",
                             (int)c->height, "intrinsic_matrix", c->fx, 0.0, 0.0, 0.0, c->fy, 0.0,
                             c->cx, c->cy, 1.0);
    if (T_color_depth != NULL) {
        json_object_set_new(root, "depth_to_color", motion_json(T_color_depth));
    }
    if (c->distortion_model != RLF_DISTORTION_NONE) {
        rlf_log(RLF_LOG_WARNING,
                "%s: Open3D's format has no lens distortion: use it with undistorted pictures",
                path);
    }
    return io_json_write(path, root, 0);
}

/* ---- YAML ----------------------------------------------------------------------------------- */

static void add_matrix(writer *w, const char *key, const char *tag, const double *x, int rows,
                       int columns)
{
    add(w, "%s:%s\n  rows: %d\n  cols: %d\n%s  data: ", key, tag, rows, columns,
        tag[0] != '\0' ? "  dt: d\n" : "");
    add_numbers(w, x, rows * columns);
    add(w, "\n");
}

static rlf_result write_ros(const char *path, const rlf_camera *c, const char *name,
                            const rlf_pose *T_color_depth)
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double p[12] = {c->fx, 0, c->cx, 0, 0, c->fy, c->cy, 0, 0, 0, 1, 0};
    writer w = {.length = 0};
    double m[9];
    camera_matrix(c, m);
    add(&w, "image_width: %d\nimage_height: %d\ncamera_name: %s\n", (int)c->width, (int)c->height,
        name);
    add_matrix(&w, "camera_matrix", "", m, 3, 3);
    add(&w, "distortion_model: %s\n", model_name(c));
    add_matrix(&w, "distortion_coefficients", "", c->distortion, 1, coefficient_count(c));
    add_matrix(&w, "rectification_matrix", "", identity, 3, 3);
    add_matrix(&w, "projection_matrix", "", p, 3, 4);
    if (T_color_depth != NULL) {
        const rlf_mat3 r = rlf_quat_to_mat3(T_color_depth->q);
        const double t[3] = {T_color_depth->p.x, T_color_depth->p.y, T_color_depth->p.z};
        add(&w, "depth_to_color:\n  rotation: [");
        for (int i = 0; i < 3; i++) {
            add_numbers(&w, r.m[i], 3);
            add(&w, i < 2 ? ", " : "]\n  translation: ");
        }
        add_numbers(&w, t, 3);
        add(&w, "\n");
    }
    return finish(&w, path);
}

static void add_opencv_lens(writer *w, const rlf_camera *c, const char *matrix, const char *lens)
{
    double m[9];
    camera_matrix(c, m);
    add_matrix(w, matrix, " !!opencv-matrix", m, 3, 3);
    add_matrix(w, lens, " !!opencv-matrix", c->distortion, 1, coefficient_count(c));
}

static rlf_result write_opencv(const char *path, const rlf_rig *rig)
{
    writer w = {.length = 0};
    add(&w, "%%YAML:1.0\n---\nimage_width: %d\nimage_height: %d\n", (int)rig->depth.width,
        (int)rig->depth.height);
    if (!rig->has_color) {
        add_opencv_lens(&w, &rig->depth, "camera_matrix", "distortion_coefficients");
        return finish(&w, path);
    }
    const rlf_mat3 r = rlf_quat_to_mat3(rig->T_color_depth.q);
    const rlf_vec3 p = rig->T_color_depth.p;
    const double t[3] = {p.x, p.y, p.z};
    double rows[9];
    for (int i = 0; i < 9; i++) {
        rows[i] = r.m[i / 3][i % 3];
    }
    add_opencv_lens(&w, &rig->depth, "M1", "D1");
    add(&w, "second_image:\n  image_width: %d\n  image_height: %d\n", (int)rig->color.width,
        (int)rig->color.height);
    add_opencv_lens(&w, &rig->color, "M2", "D2");
    add_matrix(&w, "R", " !!opencv-matrix", rows, 3, 3);
    add_matrix(&w, "T", " !!opencv-matrix", t, 3, 1);
    return finish(&w, path);
}

/* ---- mrcal ---------------------------------------------------------------------------------- */

/* Rodrigues' vector of a rotation: the axis times the angle, 0 to pi. */
static rlf_vec3 rotation_vector(rlf_quat q)
{
    if (q.w < 0.0) {
        q = (rlf_quat){-q.x, -q.y, -q.z, -q.w};
    }
    const rlf_vec3 v = rlf_vec3_make(q.x, q.y, q.z);
    const double sine = rlf_length(v);
    return rlf_scale(v, sine > 1e-9 ? 2.0 * rlf_atan2(sine, q.w) / sine : 2.0);
}

static rlf_result write_mrcal(const char *path, const rlf_camera *c, const rlf_pose *T)
{
    const rlf_vec3 v = rotation_vector(T->q);
    const double rt[6] = {v.x, v.y, v.z, T->p.x, T->p.y, T->p.z};
    const bool is_pinhole = c->distortion_model == RLF_DISTORTION_NONE;
    const int count = is_pinhole ? 0 : coefficient_count(c);
    double lens[12] = {c->fx, c->fy, c->cx, c->cy};
    memcpy(lens + 4, c->distortion, (size_t)count * sizeof(lens[0]));
    writer w = {.length = 0};
    add(&w, "{\n    'lensmodel': 'LENSMODEL_%s',\n    'intrinsics': ",
        is_pinhole ? "PINHOLE" : (count == 8 ? "OPENCV8" : "OPENCV5"));
    add_numbers(&w, lens, 4 + count);
    add(&w, ",\n    'extrinsics': ");
    add_numbers(&w, rt, 6);
    add(&w, ",\n    'imagersize': [%d, %d],\n}\n", (int)c->width, (int)c->height);
    return finish(&w, path);
}

/* ---- all ------------------------------------------------------------------------------------ */

/* STEM_depth.EXT of STEM.EXT. */
static rlf_result name_with(const char *path, const char *name, char out[IO_PATH_MAX])
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(path, '.');
    const bool has_dot = dot != NULL && (slash == NULL || dot > slash + 1) && dot > path;
    const int stem = (int)(has_dot ? (size_t)(dot - path) : strlen(path));
    const int length =
        snprintf(out, IO_PATH_MAX, "%.*s_%s%s", stem, path, name, has_dot ? dot : "");
    return length > 0 && length < IO_PATH_MAX
               ? RLF_OK
               : rlf_fail(RLF_ERROR_INVALID, "%s: the name is too long", path);
}

static rlf_result write_one(const char *path, rlf_rig_format format, const rlf_rig *rig,
                            bool second)
{
    const rlf_camera *c = second ? &rig->color : &rig->depth;
    const rlf_pose identity = rlf_pose_identity();
    const rlf_pose *T = second ? &rig->T_color_depth : NULL;
    switch (format) {
    case RLF_RIG_ROS: return write_ros(path, c, second ? "color" : "depth", T);
    case RLF_RIG_OPEN3D: return write_open3d(path, c, T);
    default: return write_mrcal(path, c, T != NULL ? T : &identity);
    }
}

rlf_result rlf_rig_save(const char *path, rlf_rig_format format, const rlf_rig *rig,
                        double units_per_metre, const char *note)
{
    if (!RLF_ASSERT(path != NULL && rig != NULL && format >= RLF_RIG_RELIEF &&
                    format <= RLF_RIG_MRCAL)) {
        return RLF_ERROR_INVALID;
    }
    if (format == RLF_RIG_RELIEF) {
        return write_relief(path, rig, units_per_metre, note);
    }
    if (format == RLF_RIG_OPENCV) {
        return write_opencv(path, rig);
    }
    if (!rig->has_color) {
        return write_one(path, format, rig, false);
    }
    char names[2][IO_PATH_MAX];
    rlf_result result = name_with(path, "depth", names[0]);
    result = result == RLF_OK ? name_with(path, "color", names[1]) : result;
    result = result == RLF_OK ? write_one(names[0], format, rig, false) : result;
    return result == RLF_OK ? write_one(names[1], format, rig, true) : result;
}
