/* Views from a recording or a camera: colour by the board's corners; depth, which has no infrared
 * picture here, by the board's outline, or kept as the source says. */
#include "calibrate/calibrate.h"
#include "command.h"
#include "info/info.h"

#include "relief/io.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MOST_FOR_WISHES 2 /* times the views asked for, while something is still wished */

typedef struct gatherer {
    const calibrate_options *options;
    const relief_opencv_api *api;
    calibration *c;
    const rlf_rig *rig;
    calibrate_picker picker;
    float *depth[CALIBRATE_VIEWS_MAX]; /* of each view, metres */
    double units;
    bool is_live;
} gatherer;

static rlf_result keep_depth(gatherer *g, const rlf_frame *frame, int32_t index)
{
    const size_t size = (size_t)g->rig->depth.width * (size_t)g->rig->depth.height;
    g->depth[index] = rlf_alloc_array(size, sizeof(float));
    if (g->depth[index] == NULL) {
        return RLF_ERROR_MEMORY;
    }
    info_depth_plane(frame, g->depth[index]);
    return RLF_OK;
}

static void tell(const gatherer *g)
{
    char wish[256];
    const int32_t count = g->c->views.count;
    if (calibrate_picker_wish(&g->picker, &g->c->views, wish, sizeof(wish))) {
        fprintf(stderr, "view %d taken; still wished: %s\n", (int)count, wish);
    } else {
        fprintf(stderr, "view %d taken; %d are asked for\n", (int)count, (int)g->options->views);
    }
}

/* One view is kept for the report: the first, and then one from the middle. */
static rlf_result keep_sample(gatherer *g, const rlf_frame *frame)
{
    calibration *c = g->c;
    const size_t size = (size_t)g->rig->depth.width * (size_t)g->rig->depth.height;
    if (c->views.count != 1 && c->views.count != g->options->views / 2) {
        return RLF_OK;
    }
    rlf_free(c->sample.data);
    c->sample.data = NULL;
    c->sample_depth =
        c->sample_depth != NULL ? c->sample_depth : rlf_alloc_array(size, sizeof(float));
    if (c->sample_depth == NULL) {
        return RLF_ERROR_MEMORY;
    }
    info_depth_plane(frame, c->sample_depth);
    return calibrate_gray_from_rgba(&frame->color, &c->sample);
}

/* Takes the sight over. */
static rlf_result take(gatherer *g, const rlf_frame *frame, calibrate_sight *sight)
{
    calibrate_views *views = &g->c->views;
    calibrate_view *view = calibrate_views_add(views);
    if (view == NULL) {
        return RLF_OK;
    }
    snprintf(view->name[1], sizeof(view->name[1]), "frame %llu",
             (unsigned long long)frame->sequence);
    view->sight[1] = *sight;
    *sight = (calibrate_sight){.count = 0};
    calibrate_picker_took(&g->picker, views, &view->sight[1]);
    rlf_result result = keep_depth(g, frame, views->count - 1);
    tell(g);
    return result == RLF_OK ? keep_sample(g, frame) : result;
}

static rlf_result look(gatherer *g, const rlf_frame *frame)
{
    calibrate_gray gray;
    calibrate_sight sight = {.count = 0};
    rlf_result result = calibrate_gray_from_rgba(&frame->color, &gray);
    if (result != RLF_OK) {
        return result;
    }
    calibrate_board board = g->options->board;
    board.is_quick = true;
    if (calibrate_find(g->api, &gray, &board, &sight) == CALIBRATE_FAILED) {
        result = RLF_ERROR_INVALID;
    } else if (calibrate_picker_next(&g->picker, &g->c->views, &sight) == CALIBRATE_PICK_TAKE) {
        result = take(g, frame, &sight);
    }
    rlf_free(sight.points);
    rlf_free(gray.data);
    return result;
}

static bool is_enough(const gatherer *g)
{
    char wish[256];
    const int32_t count = g->c->views.count, asked = g->options->views;
    const bool is_wishing = calibrate_picker_wish(&g->picker, &g->c->views, wish, sizeof(wish));
    return count >= CALIBRATE_VIEWS_MAX || count >= MOST_FOR_WISHES * asked ||
           (count >= asked && !is_wishing);
}

static rlf_result gather(gatherer *g, rlf_source *source)
{
    const int64_t begin = rlf_clock_ns();
    const double limit = g->options->seconds;
    rlf_result result = RLF_OK;
    while (result == RLF_OK && !command_interrupted && !is_enough(g)) {
        rlf_frame frame;
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK) {
            g->units = frame.depth_u16 != NULL ? frame.depth_units_per_metre : 1000.0;
            result = frame.color.data != NULL ? look(g, &frame) : RLF_OK;
        } else if (result == RLF_NO_FRAME) {
            result = RLF_OK;
        }
        if (g->is_live && limit > 0.0 && (double)(rlf_clock_ns() - begin) > 1e9 * limit) {
            break;
        }
    }
    return result == RLF_END ? RLF_OK : result;
}

/* The depth camera as the source has it; pixels are taken through its lens before they are used, so
 * that here it is a pinhole, whatever the lens model. */
static void start_model(gatherer *g)
{
    calibration *c = g->c;
    calibrate_views *v = &c->views;
    v->camera_count = CALIBRATE_CAMERAS;
    v->camera_name[0] = "depth";
    v->camera_name[1] = "color";
    v->width[0] = g->rig->depth.width;
    v->height[0] = g->rig->depth.height;
    v->width[1] = g->rig->color.width;
    v->height[1] = g->rig->color.height;
    c->depth_min_m = g->rig->depth_min_m;
    c->depth_max_m = g->rig->depth_max_m;
    c->noise = g->rig->noise;
    c->model.camera[0] = g->rig->depth;
    c->before.camera[0] = g->rig->depth;
    c->before.camera[1] = g->rig->color;
    c->before.T_second_first = g->rig->T_color_depth;
    c->model.camera[0].distortion_model = RLF_DISTORTION_NONE;
    memset(c->model.camera[0].distortion, 0, sizeof(c->model.camera[0].distortion));
    c->model.T_second_first = g->rig->T_color_depth;
    for (int i = 0; i < CALIBRATE_SHARED; i++) {
        c->model.is_fixed[i] = i < CALIBRATE_LENS || i >= CALIBRATE_MOTION;
    }
}

static rlf_result set_outline(calibrate_view *view, double corners[4][2], const double size[2],
                              double sigma)
{
    rlf_result result = calibrate_sight_resize(&view->sight[0], 4);
    for (int i = 0; i < 4 && result == RLF_OK; i++) {
        view->sight[0].points[i] = (calibrate_point){.x = (i % 2 - 0.5) * size[0],
                                                     .y = (i / 2 - 0.5) * size[1],
                                                     .u = corners[i][0],
                                                     .v = corners[i][1]};
    }
    view->sight[0].sigma = sigma;
    return result;
}

/* Boards' poses by colour alone, then their outlines in depth; both weighted by what they scatter.
 */
static rlf_result find_outlines(gatherer *g)
{
    calibration *c = g->c;
    const double *size = g->options->board.outline_m;
    rlf_result result = calibrate_seed(g->api, &c->views, &c->model);
    result = result == RLF_OK ? calibrate_solve(&c->views, &c->model, &c->fit) : result;
    int32_t count = 0;
    for (int32_t i = 0; i < c->views.count && result == RLF_OK; i++) {
        calibrate_view *view = &c->views.views[i];
        double corners[4][2], sigma;
        if (calibrate_outline(g->rig, &view->T_first_board, size, g->depth[i], corners, &sigma)) {
            result = set_outline(view, corners, size, sigma / rlf_max(c->fit.sigma, 0.05));
            count++;
        } else {
            rlf_log(RLF_LOG_WARNING, "%s: the board's outline is not to be seen in depth",
                    view->name[1]);
        }
    }
    if (result == RLF_OK && count < CALIBRATE_VIEWS_LEAST) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "the board's outline is to be seen in depth in %d views, and %d are "
                        "needed: hold it free in front of something farther away, and check "
                        "--outline",
                        (int)count, CALIBRATE_VIEWS_LEAST);
    }
    for (int i = CALIBRATE_MOTION; i < CALIBRATE_SHARED; i++) {
        c->model.is_fixed[i] = false;
    }
    for (int i = 0; i < 4; i++) {
        c->model.is_fixed[i] = !g->options->finds_depth_lens;
    }
    c->is_thesis_way = true;
    return result;
}

/* What was solved as a pinhole is the source's lens again; then the depth offset. */
static void settle_depth(gatherer *g)
{
    calibration *c = g->c;
    const rlf_camera pinhole = c->model.camera[0];
    c->model.camera[0] = g->rig->depth;
    c->model.camera[0].fx = pinhole.fx;
    c->model.camera[0].fy = pinhole.fy;
    c->model.camera[0].cx = pinhole.cx;
    c->model.camera[0].cy = pinhole.cy;
    for (int32_t i = 0; i < c->views.count; i++) {
        calibrate_view *view = &c->views.views[i];
        if (view->is_used && g->depth[i] != NULL) {
            view->offset_m =
                depth_offset_on(view, &c->views.board, &c->model.camera[0], g->depth[i]);
        }
    }
    depth_offset_combine(c);
    c->offset_before_m = g->rig->depth_offset_m;
    c->units_per_metre = g->units;
}

static rlf_result run(gatherer *g, rlf_source *source)
{
    const rlf_source_info *info = rlf_source_get_info(source);
    g->rig = &info->rig;
    g->is_live = info->is_live;
    if (!g->rig->has_color) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s has no colour pictures, and the board's squares are not to be seen in "
                        "depth: record its infrared pictures as a folder and use --left",
                        g->options->source);
    }
    start_model(g);
    rlf_result result = gather(g, source);
    if (result != RLF_OK || command_interrupted) {
        return result;
    }
    if (g->c->views.count == 0) {
        return rlf_fail(
            RLF_ERROR_INVALID, "%s: no frame shows a whole %dx%d board that is held still",
            g->options->source, (int)g->options->board.columns, (int)g->options->board.rows);
    }
    const bool has_outline = g->options->board.outline_m[0] > 0.0;
    result = has_outline && g->c->views.count >= CALIBRATE_VIEWS_LEAST ? find_outlines(g) : result;
    result = result == RLF_OK ? calibrate_finish(g->options, g->c) : result;
    if (result == RLF_OK) {
        settle_depth(g);
    }
    return result;
}

rlf_result calibrate_source(const calibrate_options *options, calibration *c)
{
    gatherer g = {.options = options, .api = opencv_get(), .c = c};
    rlf_source *source = NULL;
    rlf_result result = g.api != NULL ? RLF_OK : RLF_ERROR_UNSUPPORTED;
    result = result == RLF_OK ? rlf_open_source(options->source, NULL, &source) : result;
    result = result == RLF_OK ? run(&g, source) : result;
    rlf_source_destroy(&source);
    calibrate_picker_destroy(&g.picker);
    for (int32_t i = 0; i < CALIBRATE_VIEWS_MAX; i++) {
        rlf_free(g.depth[i]);
    }
    return result;
}
