/* The viewer: mouse positions and rays anywhere; the window, its keys and the presenter where there
 * is a display (the build runs this under xvfb-run when it finds it). */
#include "relief/gl.h"
#include "relief/synthetic.h"
#include "relief/window.h"
#include "test.h"
#include "viewer/mouse.h"

#include "count_assert.h"
#include "viewer_drive.h"

#include <string.h>

/* ---- mouse ---------------------------------------------------------------------------------- */

TEST_CASE(test_pick)
{
    /* A picture of 200 x 100 in a window of 400 x 400: twice as large, bars of 100 above and below.
     */
    const viewer_fit fit = {400, 400, 200, 100, false, NULL};
    double u, v;
    assert_true(viewer_fit_pick(&fit, 1.0, 101.0, &u, &v));
    assert_float_equal(u, 0.0, 1e-9);
    assert_float_equal(v, 0.0, 1e-9);
    assert_true(viewer_fit_pick(&fit, 399.0, 299.0, &u, &v));
    assert_float_equal(u, 199.0, 1e-9);
    assert_float_equal(v, 99.0, 1e-9);
    assert_false(viewer_fit_pick(&fit, 200.0, 50.0, &u, &v));
    assert_false(viewer_fit_pick(&fit, 200.0, 350.0, &u, &v));
}

/* A point on the ray through a pixel projects back to the pixel. */
TEST_CASE(test_ray)
{
    rlf_compositor_def def = rlf_compositor_def_default();
    def.rig.has_color = true;
    def.rig.color = (rlf_camera){
        320, 240, 250, 252, 158, 121, RLF_DISTORTION_PLUMB_BOB, {0.1, -0.05, 0.001, 0.002, 0.0}};
    def.rig.T_color_depth.p = rlf_vec3_make(0.05, 0.01, -0.02);
    def.rig.T_color_depth.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.1, -0.2, 0.05));
    def.width = 640;
    def.height = 480;
    rlf_pose T_world_camera = {{1.0, -0.5, 0.2},
                               rlf_quat_from_rotation_vector(rlf_vec3_make(-0.3, 0.4, 0.1))};
    viewer_ray ray = viewer_ray_make(&def, &T_world_camera, 500.0, 77.0);
    assert_float_equal(rlf_length(ray.direction), 1.0, 1e-12);
    rlf_vec3 p_world = rlf_mad(ray.origin, ray.direction, 1.7);
    rlf_vec3 p_camera = rlf_transform_inverse(&T_world_camera, p_world);
    rlf_camera picture = rlf_camera_resize(&def.rig.color, 640, 480);
    double u, v;
    assert_true(
        rlf_camera_project(&picture, rlf_transform(&def.rig.T_color_depth, p_camera), &u, &v));
    assert_float_equal(u, 500.0, 1e-6);
    assert_float_equal(v, 77.0, 1e-6);
}

TEST_CASE(test_throw)
{
    assert_float_equal(viewer_throw_speed(0.0), VIEWER_THROW_SPEED, 0.0);
    assert_true(viewer_throw_speed(0.1) < viewer_throw_speed(0.5));
    assert_float_equal(viewer_throw_speed(5.0), VIEWER_THROW_SPEED_MAX, 0.0);
    const viewer_ray ray = {{0, 0, 0}, {0, 0, 1}};
    const viewer_throw_def thrown = viewer_throw_def_default();
    rlf_body_def body = viewer_throw_body(&thrown, &ray, 3.0, 7);
    assert_float_equal(body.velocity.z, 3.0, 1e-12);
    assert_true(body.position.z > 0.2 && body.position.z < 0.6);
}

/* ---- placing -------------------------------------------------------------------------------- */

static rlf_known_def crate(void)
{
    rlf_known_def def = rlf_known_def_default(); /* the large box of the synthetic room */
    (void)snprintf(def.name, sizeof(def.name), "crate");
    def.shape.size = rlf_vec3_make(0.34, 0.22, 0.26);
    def.has_pose = false;
    return def;
}

/* Where its first four points, and the fifth, are in the picture of 960 x 540. */
static const double corners[5][2] = {
    {730.2, 349.3}, {821.2, 353.5}, {821.2, 407.1}, {730.2, 400.2}, {725.2, 341.8}};

TEST_CASE(test_place)
{
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output frame;
    char text[VIEWER_PLACE_TEXT];
    rlf_known_def def = crate();
    const rlf_scene scene = {.known = &def, .known_count = 1};
    assert_int_equal(rlf_synthetic_create(&synthetic, &source), RLF_OK);
    rlf_pipeline_def pipeline_def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    pipeline_def.enable_render = false;
    pipeline_def.scene = &scene;
    assert_int_equal(rlf_pipeline_create(&pipeline_def, &pipeline), RLF_OK);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(rlf_pipeline_step(pipeline, &frame), RLF_OK);
    }
    viewer_place place = {.is_on = false};
    assert_true(viewer_place_toggle(&place, pipeline, text));
    viewer_place_hint(&place, text);
    assert_non_null(strstr(text, "crate"));
    assert_non_null(strstr(text, "left top near"));
    viewer_place_pick(&place, pipeline, corners[0][0], corners[0][1], text);
    viewer_place_act(&place, pipeline, VIEWER_PLACE_SOLVE, text);
    assert_non_null(strstr(text, "3 points"));
    viewer_place_act(&place, pipeline, VIEWER_PLACE_UNDO, text);
    assert_int_equal(place.def.point_count, 0);
    for (int i = 0; i < 4; i++) {
        viewer_place_pick(&place, pipeline, corners[i][0], corners[i][1], text);
    }
    viewer_place_hint(&place, text);
    assert_non_null(strstr(text, "left top far"));
    viewer_place_act(&place, pipeline, VIEWER_PLACE_SOLVE, text);
    assert_non_null(strstr(text, "placed"));
    int32_t count;
    const rlf_known_def *list = rlf_pipeline_get_known(pipeline, &count);
    rlf_vec3 p = list[0].T_world_model.p;
    assert_int_equal(count, 1);
    assert_true(rlf_length(rlf_sub(p, rlf_vec3_make(1.34, 0.455, 2.40))) < 0.005);
    const rlf_pose T = rlf_pose_identity();
    viewer_place_nudge(&place, pipeline, &T, rlf_vec3_make(0.01, 0, -0.02), 0.0, text);
    list = rlf_pipeline_get_known(pipeline, &count);
    rlf_vec3 moved = rlf_sub(list[0].T_world_model.p, p);
    assert_true(rlf_length(rlf_sub(moved, rlf_vec3_make(0.01, 0, -0.02))) < 1e-9);
    for (int i = 0; i < 3; i++) { /* all at one place: refused, and it stays where it is */
        viewer_place_pick(&place, pipeline, 100, 100, text);
    }
    viewer_place_act(&place, pipeline, VIEWER_PLACE_SOLVE, text);
    assert_non_null(strstr(text, "line"));
    list = rlf_pipeline_get_known(pipeline, &count);
    assert_true(list[0].has_pose && list[0].point_count == 0);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

/* ---- window --------------------------------------------------------------------------------- */

/* What happened in a run, and what to do at which frame. */
typedef struct script {
    int64_t frames;
    int32_t bodies_before, bodies_after;
    int64_t index_after_restart;
    int32_t pictures, recordings;
    uint8_t camera_pixel[3], normals_pixel[3];
    bool is_short; /* quit at the fifth frame */
} script;

static rlf_result play(void *context, const rlf_pipeline_output *frame)
{
    script *s = context;
    const rlf_image_rgba8 *image = &frame->render.image;
    const uint8_t *pixel = rlf_rgba8_row(image, image->height - 20) + 4 * (image->width / 2);
    s->frames++;
    switch (s->frames) {
    case 1:
        memcpy(s->camera_pixel, pixel, 3);
        press(GLFW_KEY_3);
        break;
    case 2:
        memcpy(s->normals_pixel, pixel, 3);
        press(GLFW_KEY_1);
        glfwSetWindowSize(window(), 300, 500);
        break;
    case 3:
        s->bodies_before = frame->snapshot->body_count;
        glfwSetCursorPos(window(), 150, 250);
        press(GLFW_KEY_T);
        press(GLFW_KEY_P);
        press(GLFW_KEY_E);
        break;
    case 4:
        s->bodies_after = frame->snapshot->body_count;
        press(GLFW_KEY_N); /* pauses and goes on by one frame */
        break;
    case 5: press(s->is_short ? GLFW_KEY_Q : GLFW_KEY_R); break; /* still paused */
    case 6:
        s->index_after_restart = frame->frame_index;
        press(GLFW_KEY_SPACE);
        break;
    default: break;
    }
    return RLF_OK;
}

static rlf_result take_picture(void *context, const rlf_image_rgba8 *image, char *out_message,
                               size_t message_size)
{
    script *s = context;
    s->pictures += image->data != NULL;
    (void)snprintf(out_message, message_size, "taken");
    return RLF_OK;
}

static rlf_result take_recording(void *context, char *out_message, size_t message_size)
{
    script *s = context;
    s->recordings++;
    (void)snprintf(out_message, message_size, "recording");
    return RLF_OK;
}

static bool tell_recording(void *context, char *out, size_t size)
{
    const script *s = context;
    (void)snprintf(out, size, "REC clip.mcap");
    return s->recordings > 0;
}

static void run_script(script *s, bool use_gl)
{
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.enable_truth = false;
    synthetic.color_width = 320;
    synthetic.color_height = 180;
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_synthetic_create(&synthetic, &source), RLF_OK);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_THESIS, source, NULL);
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    rlf_window_def options = rlf_window_def_default();
    options.hides_panel = true; /* clicks are on the whole window */
    options.title = "Relief viewer test";
    options.stage.source_name = "synthetic:room";
    options.frame_count = 8;
    options.use_gl = use_gl;
    options.avoid_software_gl = s->is_short;
    options.on_frame = play;
    options.on_picture = take_picture;
    options.on_record = take_recording;
    options.on_status = tell_recording;
    options.context = s;
    rlf_result result = rlf_window_run(pipeline, &options);
    if (result != RLF_OK) {
        print_message("%s\n", rlf_error_text());
    }
    assert_int_equal(result, RLF_OK);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

static void check_run(bool use_gl)
{
    script s = {.index_after_restart = -1};
    run_script(&s, use_gl);
    assert_int_equal(s.frames, 8);
    assert_memory_not_equal(s.camera_pixel, s.normals_pixel, 3);
    assert_int_equal(s.bodies_before, 0);
    assert_int_equal(s.bodies_after, 1);
    assert_int_equal(s.pictures, 1);
    assert_int_equal(s.recordings, 1);
    assert_int_equal(s.index_after_restart, 0);
}

TEST_CASE(test_window_with_gl)
{
    if (!has_display()) {
        skip();
    }
    check_run(true);
}

TEST_CASE(test_window_with_soft)
{
    if (!has_display()) {
        skip();
    }
    check_run(false);
}

/* ---- placing in the window ------------------------------------------------------------------ */

typedef struct placing {
    int64_t frames;
    rlf_known_def saved;
    int32_t saved_count;
} placing;

static rlf_result play_placing(void *context, const rlf_pipeline_output *frame)
{
    placing *s = context;
    s->frames++;
    switch (s->frames) {
    case 6: press(GLFW_KEY_K); break;
    case 7:
    case 8:
    case 9:
    case 10: click_pixel(&frame->render.image, corners[s->frames - 7]); break;
    case 11: press(GLFW_KEY_ENTER); break;
    case 12: press(GLFW_KEY_S); break;
    case 13: press(GLFW_KEY_K); break;
    default: break;
    }
    return RLF_OK;
}

static rlf_result keep_scene(void *context, const rlf_known_def *known, int32_t count, char *out,
                             size_t size)
{
    placing *s = context;
    s->saved_count = count;
    s->saved = known[0];
    (void)snprintf(out, size, "kept");
    return RLF_OK;
}

/* K, four clicks on the crate's corners, Enter, S: the crate is where it stands. */
TEST_CASE(test_place_in_window)
{
    if (!has_display()) {
        skip();
    }
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.enable_truth = false;
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_synthetic_create(&synthetic, &source), RLF_OK);
    rlf_known_def def = crate();
    const rlf_scene scene = {.known = &def, .known_count = 1};
    rlf_pipeline_def pipeline_def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    pipeline_def.scene = &scene;
    assert_int_equal(rlf_pipeline_create(&pipeline_def, &pipeline), RLF_OK);
    placing s = {.frames = 0};
    rlf_window_def options = rlf_window_def_default();
    options.hides_panel = true; /* clicks are on the whole window */
    options.stage.source_name = "synthetic:room";
    options.frame_count = 15;
    options.use_gl = false;
    options.on_frame = play_placing;
    options.on_scene = keep_scene;
    options.context = &s;
    assert_int_equal(rlf_window_run(pipeline, &options), RLF_OK);
    assert_int_equal(s.frames, 15);
    assert_int_equal(s.saved_count, 1);
    assert_true(s.saved.has_pose && s.saved.point_count == 0);
    rlf_vec3 p = s.saved.T_world_model.p;
    assert_true(rlf_length(rlf_sub(p, rlf_vec3_make(1.34, 0.455, 2.40))) < 0.005);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

TEST_CASE(test_quit)
{
    if (!has_display()) {
        skip();
    }
    script s = {.is_short = true};
    run_script(&s, true);
    assert_int_equal(s.frames, 5);
}

TEST_CASE(test_no_display)
{
    char display[256];
    bool had_display = getenv("DISPLAY") != NULL;
    (void)snprintf(display, sizeof(display), "%s", had_display ? getenv("DISPLAY") : "");
    unsetenv("DISPLAY");
    if (getenv("WAYLAND_DISPLAY") == NULL) {
        rlf_synthetic_def synthetic = rlf_synthetic_def_default();
        rlf_source *source = NULL;
        rlf_pipeline *pipeline = NULL;
        assert_int_equal(rlf_synthetic_create(&synthetic, &source), RLF_OK);
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_THESIS, source, NULL);
        assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
        rlf_window_def options = rlf_window_def_default();
        options.hides_panel = true; /* clicks are on the whole window */
        assert_int_equal(rlf_window_run(pipeline, &options), RLF_ERROR_DEVICE);
        assert_non_null(strstr(rlf_error_text(), "--headless"));
        assert_null(strchr(rlf_error_text(), '\n'));
        rlf_pipeline_destroy(&pipeline);
        rlf_source_destroy(&source);
    }
    if (had_display) {
        setenv("DISPLAY", display, 1);
    }
}

/* ---- presenter ------------------------------------------------------------------------------ */

static void check_pixel(int x, int y_from_top, const uint8_t expected[3])
{
    uint8_t pixel[4];
    glReadPixels(x, 199 - y_from_top, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    for (int c = 0; c < 3; c++) {
        assert_in_range(pixel[c] + 2, expected[c], expected[c] + 4);
    }
}

/* A picture of 2 x 1 blocks in a square: its rows in order, black above and below. */
TEST_CASE(test_presenter)
{
    if (!has_display()) {
        skip();
    }
    GLFWwindow *hidden = open_hidden();
    rlf_gl_presenter *presenter = NULL;
    assert_int_equal(rlf_gl_presenter_create(&presenter), RLF_OK);
    uint8_t data[4 * 8 * 4];
    for (int i = 0; i < 8 * 4; i++) {
        const uint8_t color[4] = {i % 8 < 4 ? 250 : 30, i / 8 < 2 ? 200 : 10, 90, 255};
        memcpy(data + 4 * i, color, 4);
    }
    const rlf_image_rgba8 image = {data, 8, 4, 32};
    rlf_gl_presenter_draw(presenter, &image, 200, 200);
    check_pixel(100, 20, (const uint8_t[3]){0, 0, 0});
    check_pixel(100, 180, (const uint8_t[3]){0, 0, 0});
    check_pixel(20, 60, (const uint8_t[3]){250, 200, 90});
    check_pixel(180, 60, (const uint8_t[3]){30, 200, 90});
    check_pixel(20, 140, (const uint8_t[3]){250, 10, 90});
    const rlf_image_rgba8 corner = {data, 1, 1, 4}; /* half a pixel of it over the black bar */
    data[3] = 128;
    rlf_gl_presenter_draw_over(presenter, &corner, 100, 20, 200);
    check_pixel(100, 20, (const uint8_t[3]){125, 100, 45});
    check_pixel(101, 20, (const uint8_t[3]){0, 0, 0});
    rlf_gl_presenter_set_mirror(presenter, true);
    rlf_gl_presenter_draw(presenter, &image, 200, 200);
    check_pixel(180, 60, (const uint8_t[3]){250, 200, 90});
    check_pixel(20, 60, (const uint8_t[3]){30, 200, 90});
    rlf_gl_presenter_draw(presenter, &image, 1, 1);       /* a window of one pixel */
    rlf_gl_presenter_draw(presenter, &image, 7680, 4320); /* and one of 8K */
    rlf_gl_presenter_draw(presenter, &image, 0, 0);       /* minimised */
    assert_int_equal(glGetError(), GL_NO_ERROR);
    rlf_gl_presenter_destroy(&presenter);
    assert_null(presenter);
    glfwDestroyWindow(hidden);
    glfwTerminate();
}

TEST_CASE(test_null)
{
    int count = 0;
    const rlf_window_def options = rlf_window_def_default();
    rlf_window_choice choice;
    rlf_set_assert(count_assert, &count);
    assert_int_equal(rlf_window_run(NULL, &options), RLF_ERROR_INVALID);
    assert_int_equal(rlf_window_choose(NULL, NULL, NULL, &choice), RLF_ERROR_INVALID);
    assert_int_equal(count, 2);
    rlf_set_assert(NULL, NULL);
}
