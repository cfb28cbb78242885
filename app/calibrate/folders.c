/* Views from folders of pictures. */
#include "calibrate/calibrate.h"
#include "command.h"

#include "relief/io.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define HINTS 3 /* pictures that are looked at for a board of another size */

typedef struct folders {
    const calibrate_options *options;
    const relief_opencv_api *api;
    const char *folder[CALIBRATE_CAMERAS];
    calibrate_pictures pictures[CALIBRATE_CAMERAS];
    calibration *calibration;
} folders;

/* The first picture says how large a camera's pictures are. */
static rlf_result check_size(folders *f, int c, const char *name, const calibrate_gray *gray)
{
    calibrate_views *v = &f->calibration->views;
    if (v->width[c] == 0) {
        v->width[c] = gray->width;
        v->height[c] = gray->height;
    }
    return v->width[c] == gray->width && v->height[c] == gray->height
               ? RLF_OK
               : rlf_fail(RLF_ERROR_INVALID,
                          "%s: %s is %dx%d, but those before it are %dx%d; all pictures of one "
                          "camera need one size",
                          f->folder[c], name, (int)gray->width, (int)gray->height, (int)v->width[c],
                          (int)v->height[c]);
}

/* Looks for the board in one picture; what is wrong with the picture alone goes to the log. */
static rlf_result look(folders *f, int c, const char *name, calibrate_view *view)
{
    char path[CALIBRATE_PATH_SIZE];
    calibrate_gray gray;
    calibrate_pictures_path(&f->pictures[c], name, path);
    if (calibrate_gray_read(path, &gray) != RLF_OK) {
        rlf_log(RLF_LOG_WARNING, "%s", rlf_error_text());
        return RLF_OK;
    }
    rlf_result result = check_size(f, c, name, &gray);
    if (result == RLF_OK) {
        snprintf(view->name[c], sizeof(view->name[c]), "%s", name);
        switch (calibrate_find(f->api, &gray, &f->options->board, &view->sight[c])) {
        case CALIBRATE_FOUND: break;
        case CALIBRATE_BLURRED:
            rlf_log(RLF_LOG_WARNING, "%s: blurred, its edges are as wide as half a square", path);
            break;
        case CALIBRATE_ABSENT:
            rlf_log(RLF_LOG_WARNING, "%s: the whole board is not to be seen", path);
            break;
        case CALIBRATE_FAILED: result = RLF_ERROR_INVALID; break;
        }
    }
    rlf_free(gray.data);
    return result;
}

static rlf_result look_at_pairs(folders *f, const calibrate_pair *pairs, int32_t count)
{
    rlf_result result = RLF_OK;
    const int32_t kept = count < CALIBRATE_VIEWS_MAX ? count : CALIBRATE_VIEWS_MAX;
    if (kept < count) {
        rlf_log(RLF_LOG_WARNING, "%d views are many: %d of them, evenly spread, are used",
                (int)count, (int)kept);
    }
    for (int32_t i = 0; i < kept && result == RLF_OK && !command_interrupted; i++) {
        const calibrate_pair *pair = &pairs[(int64_t)i * count / kept];
        calibrate_view *view = calibrate_views_add(&f->calibration->views);
        for (int c = 0; c < CALIBRATE_CAMERAS && result == RLF_OK; c++) {
            if (pair->index[c] >= 0) {
                result = look(f, c, f->pictures[c].names[pair->index[c]], view);
            }
        }
        if (view->sight[0].count + view->sight[1].count == 0) {
            calibrate_view_leave(view, "the whole board is not to be seen");
        }
    }
    return result;
}

/* Another size of board that some picture shows; `out` stays empty when there is none. */
static void hint_other(const folders *f, int c, char *out, size_t size)
{
    out[0] = '\0';
    for (int32_t i = 0; i < f->pictures[c].count && i < HINTS && out[0] == '\0'; i++) {
        char path[CALIBRATE_PATH_SIZE];
        calibrate_gray gray;
        int32_t columns, rows;
        const char *name = f->pictures[c].names[i];
        calibrate_pictures_path(&f->pictures[c], name, path);
        if (calibrate_gray_read(path, &gray) == RLF_OK) {
            if (calibrate_find_other(f->api, &gray, &f->options->board, &columns, &rows)) {
                snprintf(out, size, ", but %s shows one of %dx%d: try --board %dx%d", name,
                         (int)columns, (int)rows, (int)columns, (int)rows);
            }
            rlf_free(gray.data);
        }
    }
}

/* The first board found is not a part of a larger one. */
static rlf_result check_board(const folders *f, int c)
{
    const calibrate_board *board = &f->options->board;
    const calibrate_views *v = &f->calibration->views;
    for (int32_t i = 0; i < v->count; i++) {
        char path[CALIBRATE_PATH_SIZE];
        calibrate_gray gray;
        int32_t columns, rows;
        if (v->views[i].sight[c].count == 0) {
            continue;
        }
        calibrate_pictures_path(&f->pictures[c], v->views[i].name[c], path);
        rlf_result result = calibrate_gray_read(path, &gray);
        if (result != RLF_OK) {
            return result;
        }
        const bool is_part = calibrate_find_larger(f->api, &gray, board, &columns, &rows);
        rlf_free(gray.data);
        return !is_part ? RLF_OK
                        : rlf_fail(RLF_ERROR_INVALID,
                                   "%s: the board has %dx%d inner corners, not %dx%d: use --board "
                                   "%dx%d",
                                   path, (int)columns, (int)rows, (int)board->columns,
                                   (int)board->rows, (int)columns, (int)rows);
    }
    char hint[256];
    hint_other(f, c, hint, sizeof(hint));
    return rlf_fail(
        RLF_ERROR_INVALID, "%s: none of the %d pictures shows a whole %s of %dx%d inner corners%s",
        f->folder[c], (int)f->pictures[c].count, board->is_charuco ? "ChArUco board" : "chessboard",
        (int)board->columns, (int)board->rows, hint);
}

static rlf_result look_at_all(folders *f)
{
    const int32_t most = f->pictures[0].count + f->pictures[1].count;
    calibrate_pair *pairs = rlf_alloc_array((size_t)most, sizeof(*pairs));
    if (pairs == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const int32_t count = calibrate_pictures_pair(&f->pictures[0], &f->pictures[1], pairs);
    rlf_result result =
        count >= 0 ? look_at_pairs(f, pairs, count)
                   : rlf_fail(RLF_ERROR_INVALID,
                              "%s has %d pictures and %s %d, and their names hold no numbers that "
                              "pair them: name those of one moment with one number, as left07.png "
                              "and right07.png",
                              f->folder[0], (int)f->pictures[0].count, f->folder[1],
                              (int)f->pictures[1].count);
    rlf_free(pairs);
    return result;
}

rlf_result calibrate_folders(const calibrate_options *options, calibration *c)
{
    folders f = {.options = options, .api = opencv_get(), .calibration = c};
    rlf_result result = f.api != NULL ? RLF_OK : RLF_ERROR_UNSUPPORTED;
    f.folder[0] = options->left;
    f.folder[1] = options->right;
    c->views.camera_count = options->right != NULL ? 2 : 1;
    c->views.camera_name[0] = "left";
    c->views.camera_name[1] = "right";
    c->units_per_metre = options->units_per_metre;
    for (int k = 0; k < c->views.camera_count && result == RLF_OK; k++) {
        result = calibrate_pictures_list(f.folder[k], &f.pictures[k]);
    }
    result = result == RLF_OK ? look_at_all(&f) : result;
    for (int k = 0; k < c->views.camera_count && result == RLF_OK && !command_interrupted; k++) {
        result = check_board(&f, k);
    }
    for (int k = 0; k < CALIBRATE_CAMERAS; k++) {
        calibrate_pictures_free(&f.pictures[k]);
    }
    result = result == RLF_OK && !command_interrupted ? calibrate_finish(options, c) : result;
    return result == RLF_OK && options->depth != NULL && !command_interrupted
               ? calibrate_folder_depth(options, c)
               : result;
}
