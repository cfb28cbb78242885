/* The window with a camera that stops, and its start page. */
#include "relief/synthetic.h"
#include "relief/window.h"
#include "relief/window.h"
#include "test.h"
#include "viewer_drive.h"
#include "viewer/panel.h"

/* ---- a camera that stops -------------------------------------------------------------------- */

/* Gives five frames, nothing for six calls, and frames again. */
typedef struct stopping {
    rlf_source *room;
    int calls, silent_calls;
    int64_t frames;
} stopping;

static rlf_result stopping_next(void *self, rlf_frame *out)
{
    stopping *s = self;
    const int call = s->calls++;
    if (call >= 5 && call < 11) {
        s->silent_calls++;
        return RLF_NO_FRAME;
    }
    s->silent_calls = 0;
    rlf_result result = rlf_source_next(s->room, out);
    out->host_time_ns = rlf_clock_ns();
    return result;
}

static void stopping_status(void *self, rlf_source_status *out)
{
    const stopping *s = self;
    out->is_connected = s->silent_calls == 0;
    out->silence_s = s->silent_calls;
}

static rlf_result play_stopping(void *context, const rlf_pipeline_output *frame)
{
    stopping *s = context;
    assert_true(frame->latency_ms > 0.0);
    assert_false(frame->is_stale);
    s->frames++;
    return RLF_OK;
}

TEST_CASE(test_camera_stops)
{
    if (!has_display()) {
        skip();
    }
    stopping s = {.calls = 0};
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = NULL;
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.enable_truth = false;
    synthetic.enable_color = false;
    assert_int_equal(rlf_synthetic_create(&synthetic, &s.room), RLF_OK);
    rlf_source_info info = *rlf_source_get_info(s.room);
    info.is_live = true;
    const rlf_source_methods methods = {.next = stopping_next, .status = stopping_status};
    assert_int_equal(rlf_source_create_custom(&methods, &info, &s, &source), RLF_OK);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_THESIS, source, NULL);
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    rlf_window_def options = rlf_window_def_default();
    options.hides_panel = true; /* clicks are on the whole window */
    options.stage.source_name = "camera";
    options.stage.source = source;
    options.frame_count = 10;
    options.use_gl = false;
    options.on_frame = play_stopping;
    options.context = &s;
    assert_int_equal(rlf_window_run(pipeline, &options), RLF_OK);
    assert_int_equal(s.frames, 10);
    assert_int_equal(s.calls, 16);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    rlf_source_destroy(&s.room);
}

/* ---- start page ----------------------------------------------------------------------------- */

typedef struct page {
    int lists;
    int first_key, second_key; /* pressed while it is listed */
    double click_row;          /* of the second list, which R makes; < 0 = no click */
} page;

static int32_t list_choices(void *context, rlf_window_choice *out)
{
    page *p = context;
    const int32_t count = 2 + p->lists++; /* one more camera each time */
    for (int32_t i = 0; i < count; i++) {
        (void)snprintf(out[i].source, sizeof(out[i].source), "source %d", (int)i);
        (void)snprintf(out[i].text, sizeof(out[i].text), "text %d", (int)i);
    }
    if (p->click_row >= 0.0 && p->lists == 2) { /* a picture of 480 x 270 that fills the window */
        const double first = viewer_panel_is_built() ? 33.0 : 12.0; /* where row 0 begins */
        const double pixels[2] = {100.0, first + 10.0 * p->click_row};
        const rlf_image_rgba8 image = {NULL, 480, 270, 0};
        click_pixel(&image, pixels);
    }
    press(p->first_key);
    p->first_key = p->second_key;
    return count;
}

static const char *choose(page p, rlf_result expected)
{
    static rlf_window_choice choice;
    choice.source[0] = '\0';
    const rlf_result result = rlf_window_choose(list_choices, &p, NULL, &choice);
    if (result != expected) {
        print_message("%s\n", rlf_error_text());
    }
    assert_int_equal(result, expected);
    return choice.source;
}

TEST_CASE(test_start_page)
{
    if (!has_display()) {
        skip();
    }
    assert_string_equal(choose((page){.first_key = GLFW_KEY_2, .click_row = -1}, RLF_OK),
                        "source 1");
    assert_string_equal(choose((page){.first_key = GLFW_KEY_ENTER, .click_row = -1}, RLF_OK),
                        "source 0");
    assert_string_equal(
        choose((page){.first_key = GLFW_KEY_R, .second_key = GLFW_KEY_H, .click_row = 1.5}, RLF_OK),
        "source 1");
    /* R looks again: the third is there then. */
    assert_string_equal(
        choose((page){.first_key = GLFW_KEY_R, .second_key = GLFW_KEY_3, .click_row = -1}, RLF_OK),
        "source 2");
    assert_string_equal(choose((page){.first_key = GLFW_KEY_Q, .click_row = -1}, RLF_END), "");
    static const volatile sig_atomic_t interrupted = 1;
    page p = {.first_key = GLFW_KEY_H, .click_row = -1};
    rlf_window_choice choice;
    assert_int_equal(rlf_window_choose(list_choices, &p, &interrupted, &choice), RLF_END);
}
