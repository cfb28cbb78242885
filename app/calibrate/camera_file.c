/* The calibration as camera.json (docs/formats.md). */
#include "calibrate/calibrate.h"
#include "calibrate/judge.h"
#include "json_file.h"

#include <math.h>
#include <stdio.h>

static json_t *camera_json(const rlf_camera *camera)
{
    json_t *distortion = json_array();
    for (int i = 0; i < 5; i++) {
        json_array_append_new(distortion, json_real(camera->distortion[i]));
    }
    return json_pack("{s:i, s:i, s:f, s:f, s:f, s:f, s:s, s:o}", "width", (int)camera->width,
                     "height", (int)camera->height, "fx", camera->fx, "fy", camera->fy, "cx",
                     camera->cx, "cy", camera->cy, "distortion_model", "plumb_bob", "distortion",
                     distortion);
}

static json_t *motion_json(const rlf_pose *T)
{
    const rlf_mat3 r = rlf_quat_to_mat3(T->q);
    return json_pack("{s:[[f,f,f],[f,f,f],[f,f,f]], s:[f,f,f]}", "rotation", r.m[0][0], r.m[0][1],
                     r.m[0][2], r.m[1][0], r.m[1][1], r.m[1][2], r.m[2][0], r.m[2][1], r.m[2][2],
                     "translation", T->p.x, T->p.y, T->p.z);
}

static void add_depth_keys(const calibration *c, json_t *depth)
{
    json_object_set_new(depth, "units_per_metre", json_real(c->units_per_metre));
    if (c->depth_max_m > 0.0) {
        json_object_set_new(depth, "depth_min_m", json_real(c->depth_min_m));
        json_object_set_new(depth, "depth_max_m", json_real(c->depth_max_m));
    }
    /* Where the motion was kept, its own error along z would look like an offset. */
    if (c->offset_boards >= CALIBRATE_VIEWS_LEAST && !c->model.is_fixed[CALIBRATE_MOTION]) {
        json_object_set_new(depth, "depth_offset_m", json_real(c->offset_before_m + c->offset_m));
    } else if (c->offset_before_m != 0.0) {
        json_object_set_new(depth, "depth_offset_m", json_real(c->offset_before_m));
    }
    if (c->noise.c0 != 0.0 || c->noise.c1 != 0.0 || c->noise.c2 != 0.0) {
        json_object_set_new(depth, "noise",
                            json_pack("[f,f,f]", c->noise.c0, c->noise.c1, c->noise.c2));
    }
}

static json_t *note_json(const calibration *c)
{
    char text[400];
    int length = snprintf(text, sizeof(text), "relief calibrate: %d views, RMS %.4f px",
                          (int)calibrate_views_used(&c->views, -1), c->fit.rms);
    for (int k = 0; k < c->views.camera_count && length < (int)sizeof(text); k++) {
        if (isnan(c->leave_one_out[k])) {
            continue;
        }
        length +=
            snprintf(text + length, sizeof(text) - (size_t)length, ", %s leave-one-out %.4f px",
                     c->views.camera_name[k], c->leave_one_out[k]);
    }
    if (c->views.camera_count == 2 && length < (int)sizeof(text)) {
        length += snprintf(text + length, sizeof(text) - (size_t)length,
                           ", depth in colour +- %.2f px", c->mapping_p95);
    }
    if (c->offset_boards > 0 && length < (int)sizeof(text)) {
        snprintf(text + length, sizeof(text) - (size_t)length, ", depth too far by %.2f +- %.2f mm",
                 1e3 * c->offset_m, 1e3 * c->offset_deviation_m);
    }
    return json_string(text);
}

rlf_result calibrate_camera_write(const calibrate_options *options, const calibration *c)
{
    json_t *root = json_object();
    json_t *depth = camera_json(&c->model.camera[0]);
    add_depth_keys(c, depth);
    json_object_set_new(root, "depth", depth);
    if (c->views.camera_count == CALIBRATE_CAMERAS) {
        json_object_set_new(root, "color", camera_json(&c->model.camera[1]));
        json_object_set_new(root, "depth_to_color", motion_json(&c->model.T_second_first));
    }
    json_object_set_new(root, "note", note_json(c));
    rlf_result result = json_file_write(options->out_path, root);
    if (result == RLF_OK) {
        printf("written: %s\n", options->out_path);
    }
    return result;
}
