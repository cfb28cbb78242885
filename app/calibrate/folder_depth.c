/* Depth offset from a folder of depth pictures. */
#include "calibrate/calibrate.h"

#include "relief/io.h"

/* The picture of the view's number, or NULL. */
static const char *find_name(const calibrate_pictures *p, const calibrate_view *view)
{
    const int64_t number = calibrate_picture_number(view->name[0]);
    for (int32_t i = 0; i < p->count; i++) {
        if (calibrate_picture_number(p->names[i]) == number) {
            return p->names[i];
        }
    }
    return NULL;
}

static rlf_result measure(const calibrate_options *o, calibration *c, const char *path,
                          calibrate_view *view)
{
    uint16_t *counts = NULL;
    int32_t width, height;
    const rlf_camera *camera = &c->model.camera[0];
    rlf_result result = rlf_png_read_u16(path, &counts, &width, &height);
    if (result != RLF_OK) {
        return result;
    }
    const size_t size = (size_t)width * (size_t)height;
    float *depth = rlf_alloc_array(size, sizeof(*depth));
    if (depth == NULL) {
        result = RLF_ERROR_MEMORY;
    } else if (width != camera->width || height != camera->height) {
        result = rlf_fail(RLF_ERROR_INVALID,
                          "%s: is %dx%d, but the infrared pictures are %dx%d: both are of one "
                          "camera and need one size",
                          path, (int)width, (int)height, (int)camera->width, (int)camera->height);
    } else {
        for (size_t i = 0; i < size; i++) {
            depth[i] = (float)(counts[i] / o->units_per_metre);
        }
        view->offset_m = depth_offset_on(view, &c->views.board, camera, depth);
    }
    rlf_free(depth);
    rlf_free(counts);
    return result;
}

rlf_result calibrate_folder_depth(const calibrate_options *options, calibration *c)
{
    calibrate_pictures pictures;
    rlf_result result = calibrate_pictures_list(options->depth, &pictures);
    for (int32_t i = 0; i < c->views.count && result == RLF_OK; i++) {
        calibrate_view *view = &c->views.views[i];
        const char *name = find_name(&pictures, view);
        if (view->is_used && view->sight[0].count > 0 && name != NULL) {
            char path[CALIBRATE_PATH_SIZE];
            calibrate_pictures_path(&pictures, name, path);
            result = measure(options, c, path, view);
        }
    }
    calibrate_pictures_free(&pictures);
    depth_offset_combine(c);
    if (result == RLF_OK && c->offset_boards == 0) {
        rlf_log(RLF_LOG_WARNING, "%s: no picture has the number of a view and depth on its board",
                options->depth);
    }
    return result;
}
