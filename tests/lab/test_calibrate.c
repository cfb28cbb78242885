/* `relief calibrate` on boards that the test draws, with cameras that it knows. */
#include "board_scene.h"
#include "calibrate/calibrate.h"
#include "eval/analytic.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FOLDER "calibrate_pictures"
#define PIXELS (320 * 240)

static void need_opencv(void)
{
    if (opencv_get() == NULL) {
        print_message("SKIPPED: %s\n", rlf_error_text());
        skip();
    }
}

static void write_gray(const char *folder, int number, const uint8_t *data, int32_t width,
                       int32_t height)
{
    char path[256];
    snprintf(path, sizeof(path), "%s/%03d.png", folder, number);
    const rlf_plane_u8 plane = {
        .data = (uint8_t *)data, .width = width, .height = height, .stride = width};
    assert_int_equal(rlf_png_write_u8(path, &plane), RLF_OK);
}

static void make_folder(const char *folder)
{
    char command[256];
    snprintf(command, sizeof(command), "rm -rf %s", folder);
    assert_int_equal(system(command), 0);
    assert_int_equal(rlf_make_folder(folder), RLF_OK);
}

/* Pictures of both cameras, drawn once. */
static uint8_t drawn[2][BOARD_VIEWS][PIXELS];
static rlf_vec3 middle_rays[PIXELS]; /* of the first camera's pixels */

static int draw_all(void **state)
{
    (void)state;
    const rlf_rig rig = board_rig();
    static rlf_vec3 rays[PIXELS * BOARD_RAYS];
    for (int c = 0; c < 2; c++) {
        board_rays(c == 0 ? &rig.depth : &rig.color, rays);
        for (int i = 0; i < BOARD_VIEWS; i++) {
            rlf_pose T = board_pose(i);
            T = c == 1 ? rlf_pose_mul(&rig.T_color_depth, &T) : T;
            board_draw(PIXELS, rays, &T, drawn[c][i]);
        }
    }
    for (int i = 0; i < PIXELS; i++) {
        rlf_camera_unproject(&rig.depth, i % 320, i / 320, &middle_rays[i]);
    }
    return 0;
}

static void write_pairs(void)
{
    make_folder(FOLDER "/left");
    make_folder(FOLDER "/right");
    for (int i = 0; i < BOARD_VIEWS; i++) {
        write_gray(FOLDER "/left", i, drawn[0][i], 320, 240);
        write_gray(FOLDER "/right", i, drawn[1][i], 320, 240);
    }
}

static calibrate_options folder_options(bool has_right)
{
    return (calibrate_options){.board = test_board,
                               .left = FOLDER "/left",
                               .right = has_right ? FOLDER "/right" : NULL,
                               .units_per_metre = 1000.0};
}

static rlf_result run_folders(const calibrate_options *o, calibration *c)
{
    *c = (calibration){.offset_m = NAN};
    assert_int_equal(calibrate_views_create(&o->board, &c->views), RLF_OK);
    return calibrate_folders(o, c);
}

static void assert_refused(const calibrate_options *o, const char *word)
{
    calibration c;
    assert_int_not_equal(run_folders(o, &c), RLF_OK);
    if (strstr(rlf_error_text(), word) == NULL) {
        fail_msg("no '%s' in: %s", word, rlf_error_text());
    }
    calibration_free(&c);
}

static calibrate_model pairs_model; /* what test_pairs found */

/* Both lenses and the motion come out as they are. */
TEST_CASE(test_pairs)
{
    need_opencv();
    const rlf_rig rig = board_rig();
    calibration c;
    write_pairs();
    const calibrate_options o = folder_options(true);
    assert_int_equal(run_folders(&o, &c), RLF_OK);
    assert_int_equal(calibrate_views_used(&c.views, -1), BOARD_VIEWS);
    assert_true(c.fit.rms < 0.2);
    assert_true(fabs(c.model.camera[0].fx - rig.depth.fx) < 1.5);
    assert_true(fabs(c.model.camera[1].fy - rig.color.fy) < 1.5);
    assert_true(rlf_length(rlf_sub(c.model.T_second_first.p, rig.T_color_depth.p)) < 0.001);
    assert_true(c.epipolar < 0.15);
    assert_true(c.leave_one_out[0] < 0.2 && c.leave_one_out[1] < 0.2);
    pairs_model = c.model;
    calibrate_options written = o;
    written.out_path = FOLDER "/camera.json";
    written.report = FOLDER "/report";
    assert_int_equal(calibrate_camera_write(&written, &c), RLF_OK);
    assert_int_equal(calibrate_report(&written, &c), RLF_OK);
    rlf_rig read;
    double units;
    assert_int_equal(rlf_rig_load(written.out_path, &read, &units), RLF_OK);
    assert_true(fabs(read.depth.fx - c.model.camera[0].fx) < 1e-9);
    assert_true(fabs(read.T_color_depth.p.x - c.model.T_second_first.p.x) < 1e-9);
    calibration_free(&c);
}

static void mirror(const uint8_t *in, uint8_t *out)
{
    for (int i = 0; i < PIXELS; i++) {
        out[i] = in[i / 320 * 320 + 319 - i % 320];
    }
}

/* A double, a mirrored picture, one cut off: each is left out with its reason, the rest is used. */
TEST_CASE(test_bad_views_are_named)
{
    need_opencv();
    calibration c;
    static uint8_t picture[PIXELS];
    write_pairs();
    mirror(drawn[1][4], picture);
    write_gray(FOLDER "/right", 4, picture, 320, 240);
    write_gray(FOLDER "/left", 20, drawn[0][2], 320, 240);
    write_gray(FOLDER "/right", 20, drawn[1][2], 320, 240);
    memcpy(picture, drawn[0][3], PIXELS);
    memset(picture, 110, PIXELS * 2 / 3);
    write_gray(FOLDER "/left", 21, picture, 320, 240);
    const calibrate_options o = folder_options(true);
    if (run_folders(&o, &c) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    print_message("%s\n", c.views.views[4].reason);
    assert_non_null(strstr(c.views.views[4].reason, "mirrored"));
    assert_non_null(strstr(c.views.views[BOARD_VIEWS].reason, "002.png"));
    assert_non_null(strstr(c.views.views[BOARD_VIEWS + 1].reason, "not to be seen"));
    assert_int_equal(calibrate_views_used(&c.views, -1), BOARD_VIEWS - 1);
    assert_true(c.fit.rms < 0.2);
    calibration_free(&c);
}

static void blur(const uint8_t *in, uint8_t *out, int radius)
{
    for (int i = 0; i < PIXELS; i++) {
        int sum = 0, count = 0;
        for (int k = -radius; k <= radius; k++) {
            for (int j = -radius; j <= radius; j++) {
                const int x = i % 320 + k, y = i / 320 + j;
                if (x >= 0 && y >= 0 && x < 320 && y < 240) {
                    sum += in[y * 320 + x];
                    count++;
                }
            }
        }
        out[i] = (uint8_t)(sum / count);
    }
}

TEST_CASE(test_refusals)
{
    need_opencv();
    static uint8_t picture[PIXELS];
    calibrate_options o = folder_options(false);
    write_pairs();
    o.board.columns = 8;
    o.board.rows = 5;
    assert_refused(&o, "9x6");
    o = folder_options(false);
    write_gray(FOLDER "/left", 5, drawn[0][5], 160, 240);
    assert_refused(&o, "one size");
    make_folder(FOLDER "/left");
    assert_refused(&o, "no .png");
    eval_random random = eval_random_start(3);
    for (int n = 0; n < 3; n++) { /* cats */
        for (int i = 0; i < PIXELS; i++) {
            picture[i] = (uint8_t)(255.0 * eval_random_uniform(&random));
        }
        write_gray(FOLDER "/left", n, picture, 320, 240);
    }
    assert_refused(&o, "none of the 3 pictures");
    for (int n = 0; n < 3; n++) {
        write_gray(FOLDER "/left", n, drawn[0][n], 320, 240);
    }
    assert_refused(&o, "too few");
    o.left = "no/such/folder";
    assert_refused(&o, "not a folder");
}

TEST_CASE(test_blurred)
{
    need_opencv();
    static uint8_t picture[PIXELS];
    calibrate_sight sight = {.count = 0};
    blur(drawn[0][4], picture, 6);
    const calibrate_gray sharp = {drawn[0][4], 320, 240}, blurred = {picture, 320, 240};
    assert_int_equal(calibrate_find(opencv_get(), &sharp, &test_board, &sight), CALIBRATE_FOUND);
    const calibrate_found found = calibrate_find(opencv_get(), &blurred, &test_board, &sight);
    assert_true(found == CALIBRATE_BLURRED || found == CALIBRATE_ABSENT);
    rlf_free(sight.points);
}

/* Views with exact corners of one camera; flat: all boards face the camera. */
static void make_views(calibrate_views *views, bool is_flat, double noise, uint64_t seed)
{
    const rlf_rig rig = board_rig();
    eval_random random = eval_random_start(seed);
    assert_int_equal(calibrate_views_create(&test_board, views), RLF_OK);
    views->camera_count = 2;
    for (int c = 0; c < 2; c++) {
        views->width[c] = 320;
        views->height[c] = 240;
        views->camera_name[c] = c == 0 ? "left" : "right";
    }
    for (int i = 0; i < BOARD_VIEWS; i++) {
        calibrate_view *view = calibrate_views_add(views);
        view->T_first_board = board_pose(i);
        view->T_first_board.q = is_flat ? rlf_quat_identity() : view->T_first_board.q;
        for (int c = 0; c < 2; c++) {
            assert_int_equal(calibrate_sight_resize(&view->sight[c], 54), RLF_OK);
            for (int k = 0; k < 54; k++) {
                calibrate_point *p = &view->sight[c].points[k];
                calibrate_board_point(&test_board, k, &p->x, &p->y);
                rlf_vec3 at = rlf_transform(&view->T_first_board, rlf_vec3_make(p->x, p->y, 0));
                at = c == 1 ? rlf_transform(&rig.T_color_depth, at) : at;
                assert_true(rlf_camera_project(c == 0 ? &rig.depth : &rig.color, at, &p->u, &p->v));
                p->u += noise * eval_random_normal(&random);
                p->v += noise * eval_random_normal(&random);
            }
        }
    }
}

static calibrate_model wrong_model(void)
{
    const rlf_rig rig = board_rig();
    calibrate_model model = {.T_second_first = rig.T_color_depth};
    model.camera[0] = rig.depth;
    model.camera[1] = rig.color;
    for (int c = 0; c < 2; c++) {
        model.camera[c].fx *= 1.05;
        model.camera[c].cy += 4.0;
        model.camera[c].distortion[0] = 0.0;
    }
    model.T_second_first.p.x -= 0.01;
    return model;
}

/* Exact corners give the cameras back exactly, from a start that is off; without OpenCV. */
TEST_CASE(test_solve)
{
    const rlf_rig rig = board_rig();
    calibrate_views views;
    calibrate_model model = wrong_model();
    calibrate_fit fit;
    make_views(&views, false, 0.0, 1);
    views.views[3].sight[1].count = 0; /* views of one camera count too */
    views.views[7].sight[0].count = 0;
    assert_int_equal(calibrate_solve(&views, &model, &fit), RLF_OK);
    assert_true(fit.is_determined && fit.rms < 1e-7);
    assert_true(fabs(model.camera[0].fx - rig.depth.fx) < 1e-5);
    assert_true(fabs(model.camera[1].distortion[0] - rig.color.distortion[0]) < 1e-6);
    assert_true(rlf_length(rlf_sub(model.T_second_first.p, rig.T_color_depth.p)) < 1e-8);
    calibrate_views_destroy(&views);
}

/* The uncertainty that is told is the scatter over trials. */
TEST_CASE(test_deviation)
{
    const rlf_rig rig = board_rig();
    double squares = 0.0, told = 0.0;
    for (int trial = 0; trial < 30; trial++) {
        calibrate_views views;
        calibrate_model model = wrong_model();
        calibrate_fit fit;
        make_views(&views, false, 0.1, (uint64_t)trial + 1);
        assert_int_equal(calibrate_solve(&views, &model, &fit), RLF_OK);
        assert_true(fabs(fit.sigma - 0.1) < 0.01);
        squares += (model.camera[0].fx - rig.depth.fx) * (model.camera[0].fx - rig.depth.fx);
        told += calibrate_deviation(&fit, 0) / 30.0;
        calibrate_views_destroy(&views);
    }
    const double ratio = sqrt(squares / 30.0) / told;
    assert_true(ratio > 0.7 && ratio < 1.4);
}

TEST_CASE(test_flat_poses_are_refused)
{
    calibrate_views views;
    calibrate_model model = wrong_model();
    calibrate_fit fit;
    make_views(&views, true, 0.1, 1);
    assert_int_equal(calibrate_solve(&views, &model, &fit), RLF_OK);
    assert_int_not_equal(calibrate_judge_fit(&views, &model, &fit), RLF_OK);
    assert_non_null(strstr(rlf_error_text(), "flat poses"));
    calibrate_views_destroy(&views);
}

TEST_CASE(test_one_part_is_refused)
{
    calibrate_views views;
    calibrate_model model = wrong_model();
    calibrate_fit fit;
    make_views(&views, false, 0.1, 1);
    for (int c = 0; c < 2; c++) { /* as if the pictures were of a camera with twice the view */
        views.width[c] *= 3;
        views.height[c] *= 3;
    }
    assert_int_equal(calibrate_solve(&views, &model, &fit), RLF_OK);
    assert_int_not_equal(calibrate_judge_fit(&views, &model, &fit), RLF_OK);
    assert_non_null(strstr(rlf_error_text(), "upper left"));
    calibrate_views_destroy(&views);
}

/* Records the board held still in each pose for four frames, as a sensor says that has a wrong idea
 * of where its colour camera is. */
static void record_clip(double offset_m)
{
    const rlf_rig truth = board_rig();
    static uint8_t rgba[PIXELS * 4];
    static uint16_t depth[PIXELS];
    rlf_source_info info = {.name = "test", .rig = truth, .frames_per_second = 30.0};
    info.rig.T_color_depth.p.x += 0.008;
    info.rig.color.fx *= 1.02;
    rlf_recording_def def = rlf_recording_def_default();
    rlf_recording *recording = NULL;
    def.jpeg_quality = 0;
    make_folder(FOLDER "/clip");
    assert_int_equal(rlf_recording_open(FOLDER "/clip/", &info, &def, &recording), RLF_OK);
    for (int i = 0; i < BOARD_VIEWS * 4; i++) {
        const rlf_pose first = board_pose(i / 4);
        board_depth(PIXELS, middle_rays, &first, offset_m, depth);
        for (int k = 0; k < 4 * PIXELS; k++) {
            rgba[k] = k % 4 == 3 ? 255 : drawn[1][i / 4][k / 4];
        }
        rlf_frame frame = {.sequence = (uint64_t)i,
                           .time_ns = (int64_t)i * 33333333,
                           .rig = &info.rig,
                           .depth_u16 = depth,
                           .depth_stride = 640,
                           .depth_units_per_metre = 1000.0,
                           .color = {.data = rgba, .width = 320, .height = 240, .stride = 1280}};
        assert_int_equal(rlf_recording_add(recording, &frame), RLF_OK);
    }
    assert_int_equal(rlf_recording_close(&recording, NULL), RLF_OK);
}

/* From a recording: still poses are picked, colour by corners, depth by the board's outline. */
TEST_CASE(test_source)
{
    need_opencv();
    const rlf_rig truth = board_rig();
    record_clip(0.0);
    const calibrate_options o = {
        .board = test_board, .source = FOLDER "/clip", .views = BOARD_VIEWS};
    calibration c = {.offset_m = NAN};
    assert_int_equal(calibrate_views_create(&o.board, &c.views), RLF_OK);
    assert_int_equal(calibrate_source(&o, &c), RLF_OK);
    assert_in_range(c.views.count, 8, BOARD_VIEWS);
    assert_less(fabs(c.model.camera[1].fx - truth.color.fx), 3.0);
    const double off = rlf_length(rlf_sub(c.model.T_second_first.p, truth.T_color_depth.p));
    assert_less(off, 0.004);
    assert_true(c.is_thesis_way);
    calibration_free(&c);
}

/* Depth pictures beside the infrared ones give the depth offset; the cameras come out as in
 * test_pairs to the last bit. */
TEST_CASE(test_depth_offset)
{
    need_opencv();
    calibration c;
    static uint16_t depth[PIXELS];
    write_pairs();
    make_folder(FOLDER "/depth");
    for (int i = 0; i < BOARD_VIEWS; i++) {
        char path[256];
        const rlf_pose first = board_pose(i);
        board_depth(PIXELS, middle_rays, &first, 0.024, depth);
        snprintf(path, sizeof(path), FOLDER "/depth/%03d.png", i);
        assert_int_equal(rlf_png_write_u16(path, depth, 320, 240), RLF_OK);
    }
    calibrate_options o = folder_options(true);
    o.depth = FOLDER "/depth";
    assert_int_equal(run_folders(&o, &c), RLF_OK);
    assert_memory_equal(&c.model, &pairs_model, sizeof(c.model));
    assert_int_equal(c.offset_boards, BOARD_VIEWS);
    assert_less(fabs(c.offset_m - 0.024), 0.002);
    assert_less(fabs(c.offset_m - 0.024), 3.0 * c.offset_deviation_m);
    o.out_path = FOLDER "/camera.json";
    assert_int_equal(calibrate_camera_write(&o, &c), RLF_OK);
    rlf_rig read;
    double units;
    assert_int_equal(rlf_rig_load(o.out_path, &read, &units), RLF_OK);
    assert_true(read.depth_offset_m == c.offset_m);
    calibration_free(&c);
}

/* A printed board says what it is; other files do not. */
TEST_CASE(test_printed_board)
{
    make_folder(FOLDER);
    const char *const paths[] = {FOLDER "/board.pdf", FOLDER "/board.svg"};
    for (int i = 0; i < 4; i++) {
        const board_size board = {9, 6, 0.0251};
        board_size read = {0};
        assert_int_equal(board_print(paths[i % 2], &board, i >= 2), RLF_OK);
        assert_int_equal(board_read(paths[i % 2], &read), RLF_OK);
        assert_true(read.columns == 9 && read.rows == 6);
        assert_true(fabs(read.square_m - 0.0251) < 1e-9);
    }
    const board_size large = {20, 14, 0.025};
    board_size read = {0};
    assert_int_equal(board_print(FOLDER "/large.pdf", &large, false), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "does not fit on A4"));
    assert_int_equal(rlf_file_write(FOLDER "/cat.pdf", "relief-board 9x", 15), RLF_OK);
    assert_int_equal(board_read(FOLDER "/cat.pdf", &read), RLF_ERROR_FORMAT);
    assert_int_equal(board_read(FOLDER "/none.pdf", &read), RLF_ERROR_IO);
}

/* The floor is the lowest level face that is large, not the lowest pixel or the largest table. */
TEST_CASE(test_floor_is_the_lowest)
{
    static calibrate_stand s = {.level = 1000};
    double below = 0.0;
    assert_false(calibrate_stand_floor(&s, &below));
    const struct {
        int bin;
        int64_t count;
    } faces[] = {{35, 700}, {65, 280}, {90, 20}};
    for (int i = 0; i < 3; i++) {
        s.count[faces[i].bin] = faces[i].count;
        s.below_m[faces[i].bin] = (0.02 * faces[i].bin + 0.005) * (double)faces[i].count;
    }
    assert_true(calibrate_stand_floor(&s, &below));
    assert_true(fabs(below - 1.305) < 1e-9);
}

TEST_GROUP(draw_all, NULL)
