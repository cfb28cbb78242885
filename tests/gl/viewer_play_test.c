/* The window with recordings and bodies: what comes after the end, other places, what is held by
 * the mouse, what is dropped, monitors that go. */
#include "relief/playback.h"
#include "relief/synthetic.h"
#include "relief/window.h"
#include "test.h"
#include "viewer/mouse.h"

#include "viewer_drive.h"

#include <string.h>

/* ---- playback ------------------------------------------------------------------------------- */

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

static rlf_frame next(rlf_source *source)
{
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    return frame;
}

/* Four frames of a recording of three: the first again, and its time goes on. */
TEST_CASE(test_loop)
{
    rlf_playback *p = NULL;
    rlf_source *source = open_room(3);
    assert_int_equal(rlf_playback_wrap(&source, RLF_PLAYBACK_LOOP, &p), RLF_OK);
    assert_int_equal(rlf_playback_get_index(p), -1);
    int64_t last_ns = -1;
    for (int i = 0; i < 7; i++) {
        const rlf_frame frame = next(source);
        assert_true(frame.time_ns > last_ns);
        /* The cut is a time in which nobody knows what was: bodies wait. */
        assert_true(i == 0 || (frame.time_ns - last_ns > INT64_C(1000000000)) == (i % 3 == 0));
        assert_int_equal(rlf_playback_get_index(p), i % 3);
        last_ns = frame.time_ns;
    }
    rlf_source_destroy(&source);
}

TEST_CASE(test_hold_and_stop)
{
    rlf_playback *p = NULL;
    rlf_frame frame;
    rlf_source *source = open_room(2);
    assert_int_equal(rlf_playback_wrap(&source, RLF_PLAYBACK_HOLD, &p), RLF_OK);
    (void)next(source);
    const rlf_frame last = next(source);
    const rlf_frame held = next(source);
    assert_ptr_equal(held.depth_u16, last.depth_u16);
    assert_int_equal((held.time_ns - last.time_ns) / 1000000, 33);
    rlf_playback_set_end(p, RLF_PLAYBACK_STOP);
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    assert_int_equal(rlf_source_restart(source), RLF_OK);
    assert_int_equal(next(source).time_ns, 0);
    rlf_source_destroy(&source);
}

TEST_CASE(test_seek)
{
    rlf_playback *p = NULL;
    rlf_source *source = open_room(20);
    rlf_source *plain = open_room(20);
    assert_int_equal(rlf_playback_wrap(&source, RLF_PLAYBACK_LOOP, &p), RLF_OK);
    assert_int_equal(rlf_playback_get_count(p), 20);
    (void)next(source);
    assert_int_equal(rlf_playback_seek(p, 17), RLF_OK);
    const rlf_frame frame = next(source);
    rlf_frame expected = next(plain);
    for (int i = 0; i < 17; i++) {
        expected = next(plain);
    }
    assert_int_equal(rlf_playback_get_index(p), 17);
    for (int32_t y = 0; y < 100; y += 10) {
        const ptrdiff_t at = y * frame.depth_stride / 2;
        assert_memory_equal(frame.depth_u16 + at, expected.depth_u16 + at, 400);
    }
    assert_int_equal(rlf_playback_seek(p, 20), RLF_ERROR_INVALID);
    rlf_source_destroy(&source);
    rlf_source_destroy(&plain);
}

/* ---- held by the mouse ---------------------------------------------------------------------- */

static const rlf_body_state *body_of(const rlf_world *world)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    assert_int_equal(s->body_count, 1);
    return &s->bodies[0];
}

/* Carried to the cursor within a second at any frame rate, without passing it by far, and it flies
 * on with its speed when it is let go. */
static void check_carried(double rate)
{
    rlf_world_def def = rlf_world_def_default();
    rlf_world *world = NULL;
    assert_int_equal(rlf_world_create(&def, &world), RLF_OK);
    rlf_body_def body = rlf_body_def_default();
    body.position = rlf_vec3_make(0.0, 0.0, 2.0);
    body.angular_velocity = rlf_vec3_make(3.0, -2.0, 1.0);
    rlf_body_id id;
    rlf_ray_hit hit;
    viewer_grab grab;
    const viewer_ray ray = {{0, 0, 0}, {0, 0, 1}};
    assert_int_equal(rlf_world_add_body(world, &body, &id), RLF_OK);
    rlf_world_advance(world, NULL, 1e-4);
    assert_true(viewer_grab_find(world, &ray, &hit));
    viewer_grab_begin(&grab, world, &ray, &hit);
    assert_true(grab.is_on);
    const rlf_vec3 aim = {0.5, -0.3, 2.0};
    grab.ray.direction = rlf_normalize(aim);
    for (int i = 0; i < (int)rate; i++) {
        viewer_grab_pull(&grab, world, 1.0 / rate);
        rlf_world_advance(world, NULL, 1.0 / rate);
        assert_true(body_of(world)->T_world_body.p.x < 0.55);
    }
    const rlf_vec3 end = rlf_mad(grab.offset, grab.ray.direction, grab.distance);
    assert_true(rlf_length(rlf_sub(body_of(world)->T_world_body.p, end)) < 0.02);
    assert_true(rlf_length(body_of(world)->angular_velocity) < 0.1);
    for (int i = 0; i < 6; i++) {
        grab.ray.direction = rlf_normalize(rlf_vec3_make(0.5 + 0.1 * (i + 1), -0.3, 2.0));
        viewer_grab_pull(&grab, world, 1.0 / 30);
        rlf_world_advance(world, NULL, 1.0 / 30);
    }
    assert_true(body_of(world)->velocity.x > 1.0);
    rlf_world_remove_body(world, id);
    viewer_grab_pull(&grab, world, 1.0 / rate); /* deleted meanwhile */
    assert_false(grab.is_on);
    rlf_world_destroy(&world);
}

TEST_CASE(test_grab)
{
    check_carried(15.0);
    check_carried(30.0);
    check_carried(120.0);
}

/* ---- in the window -------------------------------------------------------------------------- */

typedef struct script {
    rlf_pipeline *pipeline;
    rlf_playback *playback;
    int64_t frames, index_after_seek;
    int32_t opened, models, bodies_end;
    rlf_window_opening what;
    char path[64];
    rlf_vec3 picked, carried;
    bool picture_has_text;
} script;

static rlf_result save(void *context, const rlf_image_rgba8 *image, char *out, size_t size)
{
    script *s = context;
    (void)snprintf(out, size, "saved");
    for (int32_t y = 0; y < 40; y++) { /* letters have one colour, which nothing else has */
        for (int32_t x = 0; x < 160; x++) {
            const uint8_t *p = rlf_rgba8_row(image, y) + 4 * (ptrdiff_t)x;
            s->picture_has_text |= p[0] == 245 && p[1] == 245 && p[2] == 235;
        }
    }
    return RLF_OK;
}

static rlf_result refuse(void *context, rlf_window_opening what, const char *text,
                         rlf_window_stage *out)
{
    script *s = context;
    (void)out;
    s->opened++;
    s->what = what;
    (void)snprintf(s->path, sizeof(s->path), "%s", text);
    return rlf_fail(RLF_ERROR_FORMAT, "%s: is no clip", text);
}

static rlf_result give_model(void *context, const char *path, double size_m, rlf_shape *out_shape,
                             rlf_look *out_look)
{
    (void)path;
    (void)out_look;
    *out_shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.5 * size_m};
    ((script *)context)->models++;
    return RLF_OK;
}

/* A still ball in the middle of the picture, picked up and moved to the right, then deleted. */
static rlf_result play_mouse(void *context, const rlf_pipeline_output *frame)
{
    script *s = context;
    const double middle[2] = {160, 90};
    const double right[2] = {200, 90};
    const rlf_image_rgba8 *image = &frame->render.image;
    rlf_world *world = rlf_pipeline_get_world(s->pipeline);
    s->frames++;
    s->bodies_end = frame->snapshot->body_count;
    switch (s->frames) {
    case 1: {
        rlf_body_def def = rlf_body_def_default();
        rlf_body_id id;
        def.position = rlf_vec3_make(0.05, 0.0, 1.0); /* before the colour camera */
        def.gravity_scale = 0.0;
        rlf_world_set_gravity(world, (rlf_vec3){0});
        assert_int_equal(rlf_world_add_body(world, &def, &id), RLF_OK);
        press(GLFW_KEY_I); /* hides all text, and shows it again */
        press(GLFW_KEY_I);
        break;
    }
    case 3:
        s->picked = body_of(world)->T_world_body.p;
        point_at(image, middle);
        button(GLFW_PRESS);
        break;
    case 4: point_at(image, right); break;
    case 16:
        button(GLFW_RELEASE);
        s->carried = body_of(world)->T_world_body.p;
        press(GLFW_KEY_P);
        break;
    case 17: press(GLFW_KEY_DELETE); break;
    case 18: drop("notes.txt"); break;
    case 19: drop("teapot.glb"); break;
    case 20: glfwSetWindowSize(window(), 1, 1); break;
    case 22: glfwSetWindowSize(window(), 7680, 4320); break;
    case 24: glfwSetWindowSize(window(), 640, 360); break;
    case 25: assert_int_equal(rlf_playback_seek(s->playback, 3), RLF_OK); break;
    case 26: s->index_after_seek = rlf_playback_get_index(s->playback); break;
    default: break;
    }
    return RLF_OK;
}

TEST_CASE(test_mouse_and_drops)
{
    if (!has_display()) {
        skip();
    }
    script s = {.index_after_seek = -1};
    rlf_source *source = open_room(20); /* loops */
    assert_int_equal(rlf_playback_wrap(&source, RLF_PLAYBACK_LOOP, &s.playback), RLF_OK);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    assert_int_equal(rlf_pipeline_create(&def, &s.pipeline), RLF_OK);
    rlf_window_def options = rlf_window_def_default();
    options.hides_panel = true; /* clicks are on the whole window */
    options.stage.source_name = "synthetic:room";
    options.stage.playback = s.playback;
    options.frame_count = 28;
    options.use_gl = false;
    options.on_frame = play_mouse;
    options.on_picture = save;
    options.on_open = refuse;
    options.on_model = give_model;
    options.context = &s;
    assert_int_equal(rlf_window_run(s.pipeline, &options), RLF_OK);
    assert_int_equal(s.frames, 28);
    assert_true(s.carried.x > s.picked.x + 0.05);
    assert_false(s.picture_has_text);
    assert_int_equal(s.bodies_end, 0);
    assert_int_equal(s.opened, 1); /* and what was shown went on */
    assert_int_equal(s.what, RLF_WINDOW_OPEN_SOURCE);
    assert_string_equal(s.path, "notes.txt");
    assert_int_equal(s.models, 1);
    assert_int_equal(s.index_after_seek, 3);
    rlf_pipeline_destroy(&s.pipeline);
    rlf_source_destroy(&source);
}

/* ---- monitors ------------------------------------------------------------------------------- */

typedef struct screens {
    int64_t frames;
    bool was_full, is_full_after;
} screens;

static rlf_result play_screens(void *context, const rlf_pipeline_output *frame)
{
    (void)frame;
    screens *s = context;
    s->frames++;
    if (s->frames == 3) {
        s->was_full = unplug_monitor();
    } else if (s->frames == 5) {
        s->is_full_after = glfwGetWindowMonitor(window()) != NULL;
    }
    return RLF_OK;
}

TEST_CASE(test_monitors)
{
    if (!has_display()) {
        skip();
    }
    screens s = {.frames = 0};
    rlf_source *source = open_room(10);
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_THESIS, source, NULL);
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    rlf_window_def options = rlf_window_def_default();
    options.hides_panel = true; /* clicks are on the whole window */
    options.stage.source_name = "synthetic:room";
    options.frame_count = 6;
    options.use_gl = false;
    options.on_frame = play_screens;
    options.context = &s;
    options.is_fullscreen = true;
    assert_int_equal(rlf_window_run(pipeline, &options), RLF_OK);
    assert_true(s.was_full);
    assert_false(s.is_full_after);
    options.monitor = 9;
    assert_int_equal(rlf_window_run(pipeline, &options), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "no monitor 9: 1 is"));
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}
