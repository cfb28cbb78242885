/* `relief calibrate`: lenses and the motion between the cameras, from pictures of a chessboard. */
#include "calibrate/calibrate.h"
#include "calibrate/opencv/opencv.h"
#include "command.h"
#include "options.h"
#include "relief/io.h"
#include "session.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void print_help(void)
{
    printf(
        "usage: relief calibrate --left DIR [--right DIR] [OPTIONS]\n"
        "       relief calibrate SOURCE [OPTIONS]\n"
        "       relief calibrate --print-board CxR --square M --out FILE.pdf|.svg\n"
        "       relief calibrate --check SOURCE\n"
        "       relief calibrate --convert FILE --out FILE [--as FORMAT]\n\n"
        "Finds focal lengths, principal points and lens distortion of both cameras, and where one\n"
        "is in the other's frame, from pictures of a flat board. 15 to 20 views are good: the\n"
        "board in every part of the picture, tilted by 20 to 40 degrees to all sides.\n\n"
        "  --left DIR        pictures of the depth camera: infrared, or the left one of a pair\n"
        "  --right DIR       pictures of the colour camera; those of one moment have one number.\n"
        "                    Instead of a folder also a pattern in quotes: \"boards/left*\"\n"
        "  --depth DIR       16-bit depth pictures of the left camera, for its depth offset\n"
        "  --units N         counts a metre of the depth pictures, default 1000\n"
        "  SOURCE            a recording or a camera with colour: still and different poses are\n"
        "                    picked from it, until there are enough\n"
        "  --views N         of a SOURCE: enough, default 20\n"
        "  --seconds N       of a camera: go on with what there is after so long\n"
        "  --board CxR       inner corners of the chessboard, default 9x6; or the\n"
        "                    file that --print-board wrote\n"
        "  --square M        side of one square in metres (from 1 on: millimetres), default 0.025\n"
        "  --charuco CxR     a ChArUco board of so many squares instead\n"
        "  --marker M        side of its markers, default 0.75 squares\n"
        "  --dictionary N    of its markers: OpenCV's number, default 0 (4x4, 50 markers)\n"
        "  --outline WxH     size of the whole board in metres. Of a SOURCE: the depth camera is\n"
        "                    found by the board's outline in depth, as there is no infrared\n"
        "  --depth-lens      of a SOURCE with --outline: find its lens too (rough); else it is "
        "kept\n"
        "  --keep-outliers   leave no view out because it does not fit\n"
        "  --out FILE        write camera.json; else the result is only printed\n"
        "  --print-board CxR write a board to print on A4 as --out; --letter: on Letter\n"
        "  --check SOURCE    without any board: how far colour's edges are off depth's, the floor\n"
        "                    and how the camera stands; exit status 1 when the calibration is "
        "stale.\n"
        "                    Of a list of cameras, FILE.json: how far each is from where the list\n"
        "                    says, by what it and the first one see; --out FILE corrects the list\n"
        "  --convert FILE    read camera.json, or a calibration of ROS, OpenCV, Open3D or mrcal,\n"
        "                    and write it as --out; \"DEPTH,COLOR\" are two files\n"
        "  --as FORMAT       of --out: relief, ros, opencv, open3d or mrcal; else .yaml is ros,\n"
        "                    .yml opencv, .cameramodel mrcal, and the rest camera.json\n"
        "  --report DIR      write DIR/index.html: coverage, residuals, pictures before and "
        "after\n\n"
        "examples:\n"
        "  relief calibrate --left ir --right color --board 9x6 --square 0.025 --out camera.json\n"
        "  relief calibrate freenect2: --board 9x6 --square 0.025 --report report\n"
        "  relief calibrate recording.mcap --charuco 11x8 --square 0.03 --marker 0.022\n");
}

typedef struct int_pair {
    int32_t a, b;
} int_pair;

static bool take_size(const char *text, void *out)
{
    int_pair *p = out;
    char rest;
    return sscanf(text, "%dx%d%c", &p->a, &p->b, &rest) == 2 && p->a >= 3 && p->b >= 3 &&
           p->a <= 64 && p->b <= 64 && p->a * p->b <= RELIEF_OPENCV_CORNERS_MAX;
}

/* A board's size, or the file of one that was printed. */
typedef struct board_option {
    int_pair size;
    const char *path;
} board_option;

static bool take_board(const char *text, void *out)
{
    board_option *b = out;
    const char *dot = strrchr(text, '.');
    if (dot != NULL && (strcmp(dot, ".pdf") == 0 || strcmp(dot, ".svg") == 0)) {
        b->path = text;
        return true;
    }
    return take_size(text, &b->size);
}

static bool take_outline(const char *text, void *out)
{
    double *size = out;
    char rest;
    return sscanf(text, "%lfx%lf%c", &size[0], &size[1], &rest) == 2 && size[0] > 0.0 &&
           size[1] > 0.0 && size[0] < 100.0 && size[1] < 100.0;
}

static bool take_number(const char *text, void *out)
{
    char rest;
    double *number = out;
    return sscanf(text, "%lf%c", number, &rest) == 1 && *number > 0.0 && *number <= 1e6;
}

/* Nobody has squares of a metre: those are millimetres. */
static bool take_square(const char *text, void *out)
{
    double *square = out;
    const bool is_number = take_number(text, square) && *square <= 1000.0;
    *square *= *square >= 1.0 ? 1e-3 : 1.0;
    return is_number;
}

/* What the boards' options say together; an exit status, or -1. */
static int settle_board(calibrate_options *o, const board_option *option, int_pair charuco)
{
    int_pair board = option->size;
    if (option->path != NULL) {
        board_size read = {0};
        char text[32];
        if (board_read(option->path, &read) != RLF_OK) {
            return command_failed();
        }
        snprintf(text, sizeof(text), "%dx%d", (int)read.columns, (int)read.rows);
        if (!take_size(text, &board)) {
            return command_usage("calibrate", "%s: is of a board of %s, which is not usable",
                                 option->path, text);
        }
        o->board.square_m = o->board.square_m > 0.0 ? o->board.square_m : read.square_m;
    }
    o->board.square_m = o->board.square_m > 0.0 ? o->board.square_m : 0.025;
    o->board.is_charuco = charuco.a > 0;
    o->board.columns = o->board.is_charuco ? charuco.a - 1 : board.a;
    o->board.rows = o->board.is_charuco ? charuco.b - 1 : board.b;
    o->board.marker_m = o->board.marker_m > 0.0 ? o->board.marker_m : 0.75 * o->board.square_m;
    return o->board.marker_m < o->board.square_m
               ? -1
               : command_usage("calibrate", "--marker %g must be smaller than --square %g",
                               o->board.marker_m, o->board.square_m);
}

static int check(const calibrate_options *o, int arguments)
{
    if (o->convert != NULL) {
        return o->out_path != NULL && o->left == NULL && arguments == 0
                   ? -1
                   : command_usage("calibrate", "--convert needs --out FILE, and no pictures");
    }
    if (o->prints_board) {
        return o->out_path != NULL && o->left == NULL && arguments == 0
                   ? -1
                   : command_usage("calibrate", "--print-board needs --out FILE.pdf or FILE.svg");
    }
    if (o->check != NULL) {
        return o->left == NULL && arguments == 0
                   ? -1
                   : command_usage("calibrate", "--check takes one SOURCE and no pictures");
    }
    const bool has_folders = o->left != NULL || o->right != NULL;
    if (has_folders && o->left == NULL) {
        return command_usage("calibrate", "--right needs --left");
    }
    if (has_folders ? arguments != 0 : arguments != 1) {
        return command_usage("calibrate", has_folders
                                              ? "takes folders or a SOURCE, not both"
                                              : "needs --left DIR and --right DIR, or a SOURCE");
    }
    if (o->finds_depth_lens && !(o->board.outline_m[0] > 0.0)) {
        return command_usage("calibrate", "--depth-lens needs --outline WxH");
    }
    return -1;
}

static int parse(int argc, char **argv, calibrate_options *o)
{
    board_option board = {.size = {9, 6}};
    int_pair charuco = {0, 0}, printed = {0, 0};
    *o = (calibrate_options){.units_per_metre = 1000.0, .views = 20, .format = -1};
    const option_def options[] = {
        {.name = "left", .kind = OPTION_TEXT, .out = &o->left},
        {.name = "right", .kind = OPTION_TEXT, .out = &o->right},
        {.name = "depth", .kind = OPTION_TEXT, .out = &o->depth},
        {.name = "out",
         .kind = OPTION_FILE,
         .out = &o->out_path,
         .choices = ".json .yml .yaml .cameramodel .pdf .svg"},
        {.name = "check", .kind = OPTION_TEXT, .out = &o->check},
        {.name = "convert", .kind = OPTION_TEXT, .out = &o->convert},
        {.name = "as",
         .kind = OPTION_CHOICE,
         .out = &o->format,
         .take = calibrate_take_format,
         .choices = "use relief, ros, opencv, open3d or mrcal"},
        {.name = "report", .kind = OPTION_FOLDER, .out = &o->report},
        {.name = "units",
         .kind = OPTION_CHOICE,
         .out = &o->units_per_metre,
         .take = take_number,
         .choices = "is no number of counts a metre, as 1000"},
        {.name = "board",
         .kind = OPTION_CHOICE,
         .out = &board,
         .take = take_board,
         .choices = "use COLUMNSxROWS of inner corners, 3x3 to 64x16, as 9x6"},
        {.name = "print-board",
         .kind = OPTION_CHOICE,
         .out = &printed,
         .take = take_size,
         .choices = "use COLUMNSxROWS of inner corners, 3x3 to 64x16, as 9x6"},
        {.name = "letter", .kind = OPTION_FLAG, .out = &o->is_letter},
        {.name = "charuco",
         .kind = OPTION_CHOICE,
         .out = &charuco,
         .take = take_size,
         .choices = "use COLUMNSxROWS of squares, 3x3 to 64x16, as 11x8"},
        {.name = "square",
         .kind = OPTION_CHOICE,
         .out = &o->board.square_m,
         .take = take_square,
         .choices = "is no length in metres, as 0.025"},
        {.name = "marker",
         .kind = OPTION_CHOICE,
         .out = &o->board.marker_m,
         .take = take_number,
         .choices = "is no length in metres, as 0.018"},
        {.name = "dictionary", .kind = OPTION_INT32, .out = &o->board.dictionary, .high = 20},
        {.name = "outline",
         .kind = OPTION_CHOICE,
         .out = o->board.outline_m,
         .take = take_outline,
         .choices = "use WIDTHxHEIGHT in metres, as 0.30x0.21"},
        {.name = "depth-lens", .kind = OPTION_FLAG, .out = &o->finds_depth_lens},
        {.name = "keep-outliers", .kind = OPTION_FLAG, .out = &o->keeps_outliers},
        {.name = "views",
         .kind = OPTION_INT32,
         .out = &o->views,
         .low = 5,
         .high = CALIBRATE_VIEWS_MAX},
        {.name = "seconds", .kind = OPTION_INT32, .out = &o->seconds, .low = 1, .high = 86400},
        {.name = "plugin", .kind = OPTION_PLUGIN},
        {0},
    };
    int status = options_parse("calibrate", argc, argv, options, print_help);
    if (printed.a > 0) {
        board.size = printed;
        o->prints_board = true;
    }
    status = status < 0 ? check(o, argc - optind) : status;
    o->source = o->left == NULL && optind < argc ? argv[optind] : NULL;
    return status < 0 ? settle_board(o, &board, charuco) : status;
}

static rlf_result run(const calibrate_options *o, calibration *c)
{
    rlf_result result = calibrate_views_create(&o->board, &c->views);
    if (result == RLF_OK && o->out_path != NULL) {
        result = rlf_file_check(o->out_path);
    }
    if (result == RLF_OK) {
        result = o->left != NULL ? calibrate_folders(o, c) : calibrate_source(o, c);
    }
    if (command_interrupted) {
        return result;
    }
    if (result != RLF_OK) {
        calibrate_print_views(&c->views);
        return result;
    }
    calibrate_print(c);
    result = o->report != NULL ? calibrate_report(o, c) : RLF_OK;
    return result == RLF_OK && o->out_path != NULL ? calibrate_camera_write(o, c) : result;
}

static int print_board(const calibrate_options *o)
{
    const board_size board = {o->board.columns, o->board.rows, o->board.square_m};
    if (board_print(o->out_path, &board, o->is_letter) != RLF_OK) {
        return command_failed();
    }
    printf("written: %s\n", o->out_path);
    return EXIT_DONE;
}

/* Stale and failed are one exit status; only a failure has an error line. */
static int check_source(const calibrate_options *o)
{
    bool is_stale = false;
    const bool is_list = session_is_camera_list(o->check);
    if (!is_list && o->out_path != NULL) {
        return command_usage("calibrate", "--check writes --out of a list of cameras only");
    }
    rlf_result result = is_list ? calibrate_check_cameras(o->check, o->out_path, &is_stale)
                                : calibrate_check(o->check, &is_stale);
    if (command_interrupted) {
        return command_stopped("calibrate");
    }
    if (result != RLF_OK) {
        return command_failed();
    }
    return is_stale ? EXIT_FAILED : EXIT_DONE;
}

int calibrate_main(int argc, char **argv)
{
    calibrate_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    if (options.prints_board) {
        return print_board(&options);
    }
    if (options.check != NULL) {
        return check_source(&options);
    }
    if (options.convert != NULL) {
        return calibrate_convert(&options) == RLF_OK ? EXIT_DONE : command_failed();
    }
    calibration c = {.offset_m = NAN, .offset_deviation_m = NAN};
    rlf_result result = run(&options, &c);
    calibration_free(&c);
    if (command_interrupted) {
        return command_stopped("calibrate");
    }
    return result == RLF_OK ? EXIT_DONE : command_failed();
}
