/* Rectified pairs (both pictures turned until points lie on one level line) and depth's edges drawn
 * into colour. */
#include "calibrate/calibrate.h"

#include "info/info.h"
#include "relief/io.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define LINES 16        /* level lines through a pair */
#define WIDTH_MOST 640  /* of one picture of a pair */
#define EDGE_SHARE 0.05 /* of the depth: a step beyond this is drawn */

static rlf_result canvas_create(int32_t width, int32_t height, rlf_image_rgba8 *out)
{
    *out = (rlf_image_rgba8){
        .width = width, .height = height, .stride = 4 * (ptrdiff_t)width, .data = NULL};
    out->data = rlf_alloc_array((size_t)width * (size_t)height, 4);
    return out->data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

static void put(const rlf_image_rgba8 *canvas, int32_t x, int32_t y, uint8_t r, uint8_t g,
                uint8_t b)
{
    if (x >= 0 && y >= 0 && x < canvas->width && y < canvas->height) {
        uint8_t *p = rlf_rgba8_row(canvas, y) + 4 * (ptrdiff_t)x;
        p[0] = r;
        p[1] = g;
        p[2] = b;
        p[3] = 255;
    }
}

/* Between pixels, bilinear; 0 outside. */
static uint8_t sample(const calibrate_gray *g, double u, double v)
{
    if (!(u >= 0.0 && v >= 0.0 && u < g->width - 1 && v < g->height - 1)) {
        return 0;
    }
    const int32_t x = (int32_t)u, y = (int32_t)v;
    const double a = u - x, b = v - y;
    const uint8_t *p = g->data + (ptrdiff_t)y * g->width + x, *q = p + g->width;
    return (uint8_t)((1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1]) + 0.5);
}

/* Rotation from the first camera's frame to one whose x runs along the baseline. */
static rlf_mat3 rectifying(const rlf_pose *T)
{
    const rlf_quat back = rlf_quat_conjugate(T->q);
    rlf_vec3 x = rlf_normalize(rlf_neg(rlf_rotate(back, T->p)));
    x = x.x < 0.0 ? rlf_neg(x) : x;
    const rlf_vec3 ahead =
        rlf_add(rlf_vec3_make(0, 0, 1), rlf_rotate(back, rlf_vec3_make(0, 0, 1)));
    const rlf_vec3 y = rlf_normalize(rlf_cross(ahead, x));
    const rlf_vec3 z = rlf_cross(x, y);
    return (rlf_mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
}

/* The pixel of a camera that a pixel of the rectified picture shows. */
static bool rectified_source(const calibration *c, const rlf_mat3 *to_first, const rlf_camera *flat,
                             int k, double u, double v, double out[2])
{
    const rlf_vec3 ray = rlf_vec3_make((u - flat->cx) / flat->fx, (v - flat->cy) / flat->fy, 1.0);
    rlf_vec3 p = rlf_mat3_mul_vec(to_first, ray);
    p = k == 1 ? rlf_rotate(c->model.T_second_first.q, p) : p;
    return rlf_camera_project(&c->model.camera[k], p, &out[0], &out[1]);
}

/* Both pictures side by side in the size of `flat`; as they are, or rectified. */
static void draw_pair(const calibration *c, const calibrate_gray gray[2], const rlf_camera *flat,
                      bool is_rectified, const rlf_image_rgba8 *canvas)
{
    const rlf_mat3 rotation = rectifying(&c->model.T_second_first);
    const rlf_mat3 to_first = rlf_mat3_transpose(&rotation);
    for (int32_t y = 0; y < canvas->height; y++) {
        const bool is_line = y % (canvas->height / LINES) == canvas->height / LINES / 2;
        for (int32_t x = 0; x < canvas->width; x++) {
            const int k = x / flat->width;
            const double u = x % flat->width;
            double at[2] = {(u + 0.5) * gray[k].width / flat->width - 0.5,
                            (y + 0.5) * gray[k].height / flat->height - 0.5};
            const bool is_seen = !is_rectified || rectified_source(c, &to_first, flat, k, u, y, at);
            const uint8_t value = is_seen ? sample(&gray[k], at[0], at[1]) : 0;
            put(canvas, x, y, is_line ? 255 : value, is_line ? value / 2 : value,
                is_line ? value / 2 : value);
        }
    }
}

static rlf_result write_picture(const char *folder, const char *name, const rlf_image_rgba8 *canvas)
{
    char path[CALIBRATE_PATH_SIZE];
    snprintf(path, sizeof(path), "%.3900s/%s", folder, name);
    return rlf_png_write_rgba(path, canvas);
}

static rlf_result write_pair(const calibrate_options *o, const calibration *c,
                             const calibrate_gray gray[2])
{
    const rlf_camera *first = &c->model.camera[0];
    const int32_t width = first->width < WIDTH_MOST ? first->width : WIDTH_MOST;
    rlf_camera flat = rlf_camera_resize(first, width, width * first->height / first->width);
    flat.cx = 0.5 * (flat.width - 1);
    flat.cy = 0.5 * (flat.height - 1);
    rlf_image_rgba8 canvas;
    rlf_result result = canvas_create(2 * flat.width, flat.height, &canvas);
    if (result == RLF_OK) {
        draw_pair(c, gray, &flat, false, &canvas);
        result = write_picture(o->report, "before.png", &canvas);
    }
    if (result == RLF_OK) {
        draw_pair(c, gray, &flat, true, &canvas);
        result = write_picture(o->report, "after.png", &canvas);
    }
    rlf_free(canvas.data);
    return result;
}

/* The first view that both cameras see and that is used. */
static const calibrate_view *find_pair(const calibrate_views *views)
{
    for (int32_t i = 0; i < views->count; i++) {
        const calibrate_view *view = &views->views[i];
        if (view->is_used && view->sight[0].count > 0 && view->sight[1].count > 0) {
            return view;
        }
    }
    return NULL;
}

static rlf_result pair_pictures(const calibrate_options *o, const calibration *c, int *out_count)
{
    const calibrate_view *view = find_pair(&c->views);
    calibrate_gray gray[CALIBRATE_CAMERAS] = {{.data = NULL}};
    rlf_result result = RLF_OK;
    for (int k = 0; k < CALIBRATE_CAMERAS && view != NULL && result == RLF_OK; k++) {
        calibrate_pictures list;
        char path[CALIBRATE_PATH_SIZE];
        result = calibrate_pictures_list(k == 0 ? o->left : o->right, &list);
        if (result == RLF_OK) {
            calibrate_pictures_path(&list, view->name[k], path);
            result = calibrate_gray_read(path, &gray[k]);
        }
        calibrate_pictures_free(&list);
    }
    if (result == RLF_OK && view != NULL) {
        result = write_pair(o, c, gray);
        *out_count = 2;
    }
    rlf_free(gray[0].data);
    rlf_free(gray[1].data);
    return result;
}

/* Red where the near side of a depth step lands in colour. */
static void draw_edges(const calibration *c, const calibrate_model *model,
                       const rlf_image_rgba8 *canvas)
{
    const rlf_camera *depth = &c->before.camera[0];
    for (int32_t y = 0; y < canvas->height; y++) {
        for (int32_t x = 0; x < canvas->width; x++) {
            const uint8_t value = c->sample.data[(ptrdiff_t)y * c->sample.width + x];
            put(canvas, x, y, value, value, value);
        }
    }
    for (int32_t i = depth->width; i < depth->width * (depth->height - 1); i++) {
        const float *z = &c->sample_depth[i];
        const int32_t beside[4] = {-1, 1, -depth->width, depth->width};
        bool is_edge = false;
        for (int k = 0; k < 4; k++) {
            const double there = z[beside[k]];
            is_edge = is_edge || (z[0] > 0.0F && there > (1.0 + EDGE_SHARE) * z[0]);
        }
        double at[2];
        if (is_edge && calibrate_map(model, i % depth->width, i / depth->width, z[0], at)) {
            const int32_t u = (int32_t)(at[0] + 0.5), v = (int32_t)(at[1] + 0.5);
            for (int k = 0; k < 9; k++) {
                put(canvas, u + k % 3 - 1, v + k / 3 - 1, 255, 0, 0);
            }
        }
    }
}

static rlf_result aligned_pictures(const calibrate_options *o, const calibration *c, int *out_count)
{
    rlf_image_rgba8 canvas;
    rlf_result result = canvas_create(c->sample.width, c->sample.height, &canvas);
    if (result == RLF_OK) {
        draw_edges(c, &c->before, &canvas);
        result = write_picture(o->report, "before.png", &canvas);
    }
    if (result == RLF_OK) {
        draw_edges(c, &c->model, &canvas);
        result = write_picture(o->report, "after.png", &canvas);
    }
    rlf_free(canvas.data);
    *out_count = 2;
    return result;
}

rlf_result calibrate_report_pictures(const calibrate_options *options, const calibration *c,
                                     int *out_count)
{
    *out_count = 0;
    if (c->sample.data != NULL && c->sample_depth != NULL) {
        return aligned_pictures(options, c, out_count);
    }
    return options->right != NULL ? pair_pictures(options, c, out_count) : RLF_OK;
}
