/* What an installation needs of the window: the picture's corners, cut or with bars, bodies that
 * come back, and a kiosk that goes on by itself. */
#include "relief/gl.h"
#include "relief/synthetic.h"
#include "relief/window.h"
#include "test.h"
#include "viewer/corners.h"
#include "viewer/files.h"
#include "viewer/mouse.h"

#include "viewer_drive.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- corners -------------------------------------------------------------------------------- */

static const double askew[8] = {0.1, 0.05, 0.9, 0.2, 1.0, 0.95, 0.0, 0.8};

static void map(const rlf_mat3 *m, double x, double y, double out[2])
{
    const double z = m->m[2][0] * x + m->m[2][1] * y + m->m[2][2];
    assert_true(z > 0.0);
    out[0] = (m->m[0][0] * x + m->m[0][1] * y + m->m[0][2]) / z;
    out[1] = (m->m[1][0] * x + m->m[1][1] * y + m->m[1][2]) / z;
}

TEST_CASE(test_corners)
{
    viewer_corners c = {.selected = 0};
    viewer_corners_reset(&c);
    assert_true(viewer_corners_set(&c, askew));
    assert_true(c.is_askew);
    double at[2];
    for (int i = 0; i < 4; i++) { /* the corners go to the window's own */
        map(&c.map, askew[2 * i], askew[2 * i + 1], at);
        assert_float_equal(at[0], i == 1 || i == 2, 1e-9);
        assert_float_equal(at[1], i >= 2, 1e-9);
    }
    /* The diagonals cross in the middle, whatever the perspective. */
    const double d1[2] = {askew[4] - askew[0], askew[5] - askew[1]};
    const double d2[2] = {askew[6] - askew[2], askew[7] - askew[3]};
    const double t = ((askew[2] - askew[0]) * d2[1] - (askew[3] - askew[1]) * d2[0]) /
                     (d1[0] * d2[1] - d1[1] * d2[0]);
    map(&c.map, askew[0] + t * d1[0], askew[1] + t * d1[1], at);
    assert_float_equal(at[0], 0.5, 1e-9);
    assert_float_equal(at[1], 0.5, 1e-9);
    /* A dent, and a corner over the opposite side, make no picture. */
    viewer_corners_pick(&c, 0.0, 0.0);
    assert_int_equal(c.selected, 0);
    assert_false(viewer_corners_move(&c, 0.6, 0.6));
    assert_memory_equal(c.at, askew, sizeof askew);
    assert_true(viewer_corners_move(&c, 0.0, 0.0));
    viewer_corners_nudge(&c, 10.0, 0.0);
    assert_float_equal(c.at[0], 0.01, 1e-12);
}

TEST_CASE(test_corners_are_kept)
{
    viewer_corners c = {.selected = 0}, again;
    assert_true(viewer_corners_set(&c, askew));
    assert_int_equal(viewer_corners_save(&c, "corners"), RLF_OK);
    viewer_corners_load(&again, "corners");
    for (int i = 0; i < 8; i++) {
        assert_float_equal(again.at[i], askew[i], 1e-6);
    }
    FILE *file = fopen("corners", "w");
    assert_non_null(file);
    (void)fputs("relief corners 1\n0 0\n1000000 0\n0 0\n0 1000000\n", file);
    (void)fclose(file);
    viewer_corners_load(&again, "corners");
    assert_false(again.is_askew);
    viewer_corners_load(&again, "there is none");
    assert_false(again.is_askew);
    assert_int_equal(viewer_corners_save(&c, "no/such/folder"), RLF_ERROR_IO);
    (void)remove("corners");
}

/* A picture of 200 x 100 that fills a window of 400 x 400 is four times as large, and cut. */
TEST_CASE(test_pick)
{
    viewer_corners c = {.selected = 0};
    viewer_fit fit = {400, 400, 200, 100, true, NULL};
    double u, v;
    assert_true(viewer_fit_pick(&fit, 2.0, 2.0, &u, &v));
    assert_float_equal(u, 50.0, 1e-9);
    assert_float_equal(v, 0.0, 1e-9);
    assert_true(viewer_corners_set(&c, askew));
    fit = (viewer_fit){400, 400, 400, 400, false, &c.map};
    assert_true(viewer_fit_pick(&fit, 400 * 0.9 - 0.01, 400 * 0.2 + 0.01, &u, &v));
    assert_true(u > 398.5 && v < 0.5); /* the upper right corner */
    assert_false(viewer_fit_pick(&fit, 4.0, 4.0, &u, &v));
}

/* Folders first, by name; hidden and other files are left out. */
TEST_CASE(test_files)
{
    static viewer_files files;
    char path[VIEWER_FILES_PATH];
    (void)mkdir("list_of_files", 0777);
    (void)mkdir("list_of_files/b", 0777);
    const char *names[4] = {"list_of_files/z.glb", "list_of_files/a.obj", "list_of_files/c.txt",
                            "list_of_files/.hidden.obj"};
    for (int i = 0; i < 4; i++) {
        FILE *file = fopen(names[i], "w");
        assert_non_null(file);
        (void)fclose(file);
    }
    assert_true(viewer_files_enter(&files, "", NULL)); /* the working folder */
    assert_true(viewer_files_enter(&files, "list_of_files", ".glb .obj"));
    assert_int_equal(files.count, 3);
    assert_true(files.list[0].is_folder && strcmp(files.list[0].name, "b") == 0);
    assert_string_equal(files.list[1].name, "a.obj");
    assert_string_equal(files.list[2].name, "z.glb");
    assert_true(viewer_files_path(&files, "a.obj", path));
    assert_int_equal(access(path, R_OK), 0);
    assert_false(viewer_files_enter(&files, "c.txt", NULL));
    assert_int_equal(files.count, 3);
    assert_true(viewer_files_enter(&files, "b", NULL));
    assert_int_equal(files.count, 0);
    assert_true(viewer_files_enter(&files, "..", NULL));
    assert_int_equal(files.count, 4);
    for (int i = 0; i < 4; i++) {
        (void)remove(names[i]);
    }
    (void)rmdir("list_of_files/b");
    (void)rmdir("list_of_files");
}

/* ---- presenter ------------------------------------------------------------------------------ */

static void check_pixel(int x, int y_from_top, int red)
{
    uint8_t pixel[4];
    glReadPixels(x, 199 - y_from_top, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    assert_in_range(pixel[0] + 2, red, red + 4);
}

TEST_CASE(test_presenter)
{
    if (!has_display()) {
        skip();
    }
    GLFWwindow *hidden = open_hidden();
    rlf_gl_presenter *presenter = NULL;
    assert_int_equal(rlf_gl_presenter_create(&presenter), RLF_OK);
    uint8_t data[4 * 8 * 4]; /* left half 250, right half 30 */
    for (int i = 0; i < 8 * 4; i++) {
        memset(data + 4 * (ptrdiff_t)i, i % 8 < 4 ? 250 : 30, 4);
    }
    const rlf_image_rgba8 image = {data, 8, 4, 32};
    rlf_gl_presenter_set_place(presenter, true, NULL);
    rlf_gl_presenter_draw(presenter, &image, 200, 200);
    check_pixel(20, 5, 250); /* where there were bars */
    check_pixel(180, 195, 30);
    viewer_corners c = {.selected = 0};
    const double small[8] = {0.25, 0.25, 0.75, 0.25, 0.75, 0.75, 0.25, 0.75};
    assert_true(viewer_corners_set(&c, small));
    rlf_gl_presenter_set_place(presenter, true, &c.map);
    rlf_gl_presenter_draw(presenter, &image, 200, 200);
    check_pixel(60, 60, 250);
    check_pixel(140, 140, 30);
    check_pixel(40, 100, 0);
    check_pixel(160, 100, 0);
    check_pixel(100, 40, 0);
    rlf_gl_presenter_set_place(presenter, false, NULL);
    rlf_gl_presenter_draw(presenter, &image, 200, 200);
    check_pixel(20, 5, 0);
    check_pixel(20, 60, 250);
    assert_int_equal(glGetError(), GL_NO_ERROR);
    rlf_gl_presenter_destroy(&presenter);
    glfwDestroyWindow(hidden);
    glfwTerminate();
}

/* ---- the window ----------------------------------------------------------------------------- */

static rlf_pipeline *open_pipeline(rlf_source *source)
{
    rlf_pipeline *p = NULL;
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_THESIS, source, NULL);
    assert_int_equal(rlf_pipeline_create(&def, &p), RLF_OK);
    return p;
}

static rlf_source *open_room(int32_t frames)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    rlf_source *source = NULL;
    def.enable_truth = false;
    def.frame_count = frames;
    def.color_width = 320;
    def.color_height = 180;
    assert_int_equal(rlf_synthetic_create(&def, &source), RLF_OK);
    return source;
}

typedef struct deleting {
    int64_t frames;
    int32_t thrown, deleted, back;
    double restitution;
    rlf_pipeline *pipeline;
} deleting;

static rlf_result play_deleting(void *context, const rlf_pipeline_output *frame)
{
    deleting *s = context;
    const rlf_snapshot *now = frame->snapshot;
    rlf_body_def def;
    int width, height;
    switch (++s->frames) {
    case 2:
        glfwGetWindowSize(window(), &width, &height);
        glfwSetCursorPos(window(), 0.5 * width, 0.5 * height);
        press(GLFW_KEY_T);
        break;
    case 3:
        s->thrown = now->body_count;
        press(GLFW_KEY_SPACE);
        press(GLFW_KEY_DELETE);
        press(GLFW_KEY_N);
        break;
    case 4:
        s->deleted = now->body_count;
        press(GLFW_KEY_U);
        press(GLFW_KEY_N);
        break;
    case 5:
        s->back = now->body_count;
        assert_true(
            rlf_world_get_body_def(rlf_pipeline_get_world(s->pipeline), now->bodies[0].id, &def));
        s->restitution = def.restitution;
        press(GLFW_KEY_Q);
        break;
    default: break;
    }
    return RLF_OK;
}

TEST_CASE(test_bodies_come_back)
{
    if (!has_display()) {
        skip();
    }
    rlf_source *source = open_room(20);
    deleting s = {.pipeline = open_pipeline(source)};
    rlf_window_def options = rlf_window_def_default();
    options.hides_panel = true;
    options.use_gl = false;
    options.on_frame = play_deleting;
    options.context = &s;
    assert_int_equal(rlf_window_run(s.pipeline, &options), RLF_OK);
    assert_int_equal(s.thrown, 1);
    assert_int_equal(s.deleted, 0);
    assert_int_equal(s.back, 1);
    assert_float_equal(s.restitution, viewer_throw_def_default().restitution, 1e-12);
    rlf_pipeline_destroy(&s.pipeline);
    rlf_source_destroy(&source);
}

typedef struct unattended {
    int64_t frames;
    int32_t openings;
    bool is_full, is_full_again, is_pointer_hidden;
    rlf_source *source;
    rlf_pipeline *pipeline;
} unattended;

/* The source ends after five frames; the first attempt to open it again finds no camera. */
static rlf_result open_again(void *context, rlf_window_opening what, const char *text,
                             rlf_window_stage *out)
{
    unattended *s = context;
    (void)text;
    assert_int_equal(what, RLF_WINDOW_OPEN_AGAIN);
    rlf_source_destroy(&s->source);
    if (s->openings++ == 0) { /* keys do no harm while there is no source */
        const int keys[] = {GLFW_KEY_N, GLFW_KEY_T, GLFW_KEY_DELETE, GLFW_KEY_U, GLFW_KEY_K,
                            GLFW_KEY_3, GLFW_KEY_1, GLFW_KEY_P,      GLFW_KEY_K};
        for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
            press(keys[i]);
        }
        return rlf_fail(RLF_ERROR_DEVICE, "camera: none is plugged in");
    }
    press(GLFW_KEY_SPACE); /* N has paused it */
    rlf_pipeline *old = s->pipeline;
    s->source = open_room(5);
    s->pipeline = open_pipeline(s->source);
    *out = (rlf_window_stage){
        .pipeline = s->pipeline, .source = s->source, .source_name = "camera", .scene_name = ""};
    rlf_pipeline_destroy(&old);
    return RLF_OK;
}

static rlf_result play_unattended(void *context, const rlf_pipeline_output *frame)
{
    unattended *s = context;
    (void)frame;
    s->frames++;
    if (s->frames == 2) {
        s->is_pointer_hidden = glfwGetInputMode(window(), GLFW_CURSOR) == GLFW_CURSOR_HIDDEN;
        s->is_full = unplug_monitor();
        assert_null(glfwGetWindowMonitor(window()));
    } else if (s->frames == 4) {
        s->is_full_again = glfwGetWindowMonitor(window()) != NULL;
    }
    return RLF_OK;
}

TEST_CASE(test_kiosk)
{
    if (!has_display()) {
        skip();
    }
    unattended s = {.source = open_room(5)};
    s.pipeline = open_pipeline(s.source);
    rlf_window_def options = rlf_window_def_default();
    options.is_kiosk = true;
    options.use_gl = false;
    options.frame_count = 8;
    options.stage.source = s.source;
    options.stage.source_name = "camera";
    options.on_frame = play_unattended;
    options.on_open = open_again;
    options.context = &s;
    assert_int_equal(rlf_window_run(s.pipeline, &options), RLF_OK);
    assert_int_equal(s.frames, 8);
    assert_int_equal(s.openings, 2);
    assert_true(s.is_full && s.is_pointer_hidden && s.is_full_again);
    rlf_pipeline_destroy(&s.pipeline);
    rlf_source_destroy(&s.source);
}

/* ---- pace ----------------------------------------------------------------------------------- */

typedef struct hurried {
    int64_t frames;
    int32_t first_width, last_width, placing_width;
} hurried;

static rlf_result play_hurried(void *context, const rlf_pipeline_output *frame)
{
    hurried *s = context;
    const int32_t width = frame->render.image.width;
    s->frames++;
    s->first_width = s->frames == 1 ? width : s->first_width;
    s->last_width = s->frames == 50 ? width : s->last_width;
    s->placing_width = width;
    if (s->frames == 51) { /* placing needs the camera's own pixels */
        press(GLFW_KEY_K);
    }
    return RLF_OK;
}

/* A thousand frames a second are more than any machine can draw. */
TEST_CASE(test_pace)
{
    if (!has_display()) {
        skip();
    }
    for (int keeps = 0; keeps < 2; keeps++) {
        hurried s = {.frames = 0};
        rlf_synthetic_def def = rlf_synthetic_def_default();
        rlf_source *source = NULL;
        def.enable_truth = false;
        def.color_width = 1280;
        def.color_height = 720;
        assert_int_equal(rlf_synthetic_create(&def, &source), RLF_OK);
        rlf_pipeline *pipeline = open_pipeline(source);
        rlf_window_def options = rlf_window_def_default();
        options.use_gl = false;
        options.hides_panel = true;
        options.keeps_size = keeps;
        options.stage.frames_per_second = 1000.0;
        options.frame_count = 53;
        options.on_frame = play_hurried;
        options.context = &s;
        assert_int_equal(rlf_window_run(pipeline, &options), RLF_OK);
        assert_int_equal(s.first_width, 1280);
        assert_int_equal(s.last_width, keeps ? 1280 : 640);
        assert_int_equal(s.placing_width, 1280);
        rlf_pipeline_destroy(&pipeline);
        rlf_source_destroy(&source);
    }
}
