/* The calibration as camera.json (docs/formats.md), or in another program's format. */
#include "calibrate/calibrate.h"
#include "relief/io.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void note(const calibration *c, char *text, size_t size)
{
    int length = snprintf(text, size, "relief calibrate: %d views, RMS %.4f px",
                          (int)calibrate_views_used(&c->views, -1), c->fit.rms);
    for (int k = 0; k < c->views.camera_count && length < (int)size; k++) {
        if (isnan(c->leave_one_out[k])) {
            continue;
        }
        length += snprintf(text + length, size - (size_t)length, ", %s leave-one-out %.4f px",
                           c->views.camera_name[k], c->leave_one_out[k]);
    }
    if (c->views.camera_count == 2 && length < (int)size) {
        length += snprintf(text + length, size - (size_t)length, ", depth in colour +- %.2f px",
                           c->mapping_p95);
    }
    if (c->offset_boards > 0 && length < (int)size) {
        snprintf(text + length, size - (size_t)length, ", depth too far by %.2f +- %.2f mm",
                 1e3 * c->offset_m, 1e3 * c->offset_deviation_m);
    }
}

static rlf_rig rig_of(const calibration *c)
{
    rlf_rig rig = {.depth = c->model.camera[0],
                   .has_color = c->views.camera_count == CALIBRATE_CAMERAS,
                   .T_color_depth = rlf_pose_identity(),
                   .depth_min_m = c->depth_min_m,
                   .depth_max_m = c->depth_max_m,
                   .noise = c->noise,
                   .depth_offset_m = c->offset_before_m};
    if (rig.has_color) {
        rig.color = c->model.camera[1];
        rig.T_color_depth = c->model.T_second_first;
    }
    /* Where the motion was kept, its own error along z would look like an offset. */
    if (c->offset_boards >= CALIBRATE_VIEWS_LEAST && !c->model.is_fixed[CALIBRATE_MOTION]) {
        rig.depth_offset_m += c->offset_m;
    }
    return rig;
}

bool calibrate_take_format(const char *text, void *out)
{
    static const char *const names[] = {"relief", "ros", "opencv", "open3d", "mrcal"};
    for (int i = 0; i < 5; i++) {
        if (strcmp(text, names[i]) == 0) {
            *(int32_t *)out = i;
            return true;
        }
    }
    return false;
}

/* By the name where --as does not say. */
static rlf_rig_format format_of(const calibrate_options *o)
{
    const char *dot = strrchr(o->out_path, '.');
    if (o->format >= 0) {
        return (rlf_rig_format)o->format;
    }
    if (dot != NULL && strcmp(dot, ".yaml") == 0) {
        return RLF_RIG_ROS;
    }
    if (dot != NULL && strcmp(dot, ".yml") == 0) {
        return RLF_RIG_OPENCV;
    }
    return dot != NULL && strcmp(dot, ".cameramodel") == 0 ? RLF_RIG_MRCAL : RLF_RIG_RELIEF;
}

static rlf_result save(const calibrate_options *o, const rlf_rig *rig, double units,
                       const char *text)
{
    const rlf_rig_format format = format_of(o);
    const bool is_two = rig->has_color && format != RLF_RIG_RELIEF && format != RLF_RIG_OPENCV;
    rlf_result result = rlf_rig_save(o->out_path, format, rig, units, text);
    if (result == RLF_OK) {
        printf("written: %s%s\n", o->out_path, is_two ? ", as _depth and _color" : "");
    }
    return result;
}

rlf_result calibrate_camera_write(const calibrate_options *options, const calibration *c)
{
    char text[400];
    const rlf_rig rig = rig_of(c);
    note(c, text, sizeof(text));
    return save(options, &rig, c->units_per_metre, text);
}

rlf_result calibrate_convert(const calibrate_options *options)
{
    rlf_rig rig;
    double units = 0.0;
    rlf_result result = rlf_rig_load(options->convert, &rig, &units);
    return result == RLF_OK ? save(options, &rig, units, NULL) : result;
}
