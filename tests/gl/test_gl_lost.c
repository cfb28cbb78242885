/* A context that is lost in the middle of a run, and a machine without OpenGL: the soft renderer
 * goes on, one line says so, and its pictures are those of a run that was soft from the start. */
#include "gl_scene.h"
#include "relief/gl.h"
#include "relief/pipeline.h"
#include "relief/synthetic.h"
#include "test.h"

#include <stdlib.h>

#define FRAMES 6
#define LOST_AT 3

/* What the driver's entry points were; libepoxy calls through these pointers. */
static EGLBoolean(EPOXY_CALLSPEC *make_current)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
static GLenum(EPOXY_CALLSPEC *reset_status)(void);

static EGLDisplay last_display;
static EGLContext last_context;
static bool is_reset; /* the driver says so */
static int switches;  /* of contexts, since it says so */

/* Remembers the context; once it is lost it cannot be made current any more (EGL 1.5, 3.7.3). */
static EGLBoolean EPOXY_CALLSPEC watch_context(EGLDisplay display, EGLSurface draw, EGLSurface read,
                                               EGLContext context)
{
    if (context == EGL_NO_CONTEXT) {
        return make_current(display, draw, read, context);
    }
    switches += is_reset;
    last_display = display;
    last_context = context;
    return is_reset ? EGL_FALSE : make_current(display, draw, read, context);
}

static GLenum EPOXY_CALLSPEC tell_reset(void)
{
    return is_reset ? GL_UNKNOWN_CONTEXT_RESET : GL_NO_ERROR;
}

/* ---- log ------------------------------------------------------------------------------------ */

static char line[512];
static int lines;

static void keep_line(void *context, rlf_log_level level, const char *text)
{
    (void)context;
    if (level == RLF_LOG_WARNING) {
        (void)snprintf(line, sizeof(line), "%s", text);
        lines++;
    }
}

/* ---- runs ----------------------------------------------------------------------------------- */

typedef struct run {
    rlf_source *source;
    rlf_pipeline *pipeline;
} run;

static run open_run(bool use_gl)
{
    run r = {NULL, NULL};
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.color_width = 320;
    synthetic.color_height = 180;
    synthetic.enable_truth = false;
    assert_int_equal(rlf_synthetic_create(&synthetic, &r.source), RLF_OK);
    static rlf_body_def body;
    body = rlf_body_def_default();
    body.position = rlf_vec3_make(0.2, 0.1, 1.5);
    body.gravity_scale = 0.0;
    const rlf_scene scene = {.bodies = &body, .body_count = 1};
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, r.source, NULL);
    def.scene = &scene;
    assert_int_equal(rlf_pipeline_create(&def, &r.pipeline), RLF_OK);
    if (use_gl) {
        rlf_compositor *compositor = NULL;
        rlf_compositor_def gl = rlf_pipeline_get_compositor_def(r.pipeline);
        assert_int_equal(rlf_gl_compositor_create(&gl, false, &compositor), RLF_OK);
        assert_int_equal(rlf_pipeline_set_compositor(r.pipeline, compositor), RLF_OK);
    }
    return r;
}

static void close_run(run *r)
{
    rlf_pipeline_destroy(&r->pipeline);
    rlf_source_destroy(&r->source);
}

/* Pictures before the loss are like those of a soft run, those after it the same. */
static void check_pictures(const rlf_render_output *a, const rlf_render_output *b, bool is_lost)
{
    assert_int_equal(a->image.width, b->image.width);
    int64_t sum = 0;
    for (int32_t y = 0; y < a->image.height; y++) {
        const uint8_t *p = rlf_rgba8_row(&a->image, y);
        const uint8_t *q = rlf_rgba8_row(&b->image, y);
        for (int32_t i = 0; i < 4 * a->image.width; i++) {
            sum += p[i] > q[i] ? p[i] - q[i] : q[i] - p[i];
        }
    }
    assert_true(is_lost ? sum == 0 : sum < 4 * (int64_t)a->image.width * a->image.height);
}

/* `lose` takes the context away between two pictures. */
static void check_loss(void (*lose)(void))
{
    is_reset = false;
    lines = 0;
    run gl = open_run(true), soft = open_run(false);
    rlf_set_log(keep_line, NULL);
    for (int i = 0; i < FRAMES; i++) {
        rlf_pipeline_output a, b;
        if (i == LOST_AT) {
            lose();
            /* A new renderer measures the camera's noise anew. */
            assert_int_equal(rlf_pipeline_set_compositor(soft.pipeline, NULL), RLF_OK);
        }
        assert_int_equal(rlf_pipeline_step(gl.pipeline, &a), RLF_OK);
        assert_int_equal(rlf_pipeline_step(soft.pipeline, &b), RLF_OK);
        assert_int_equal(lines, i < LOST_AT ? 0 : 1);
        check_pictures(&a.render, &b.render, i >= LOST_AT);
    }
    rlf_set_log(NULL, NULL);
    assert_non_null(strstr(line, "lost the context"));
    assert_non_null(strstr(line, "going on with the soft renderer"));
    assert_null(strchr(line, '\n'));
    close_run(&gl);
    close_run(&soft);
}

static void destroy_context(void)
{
    assert_true(eglDestroyContext(last_display, last_context));
}

static void reset_context(void)
{
    is_reset = true;
}

/* The context is gone, and its objects with it. */
static void a_context_is_destroyed(void **state)
{
    (void)state;
    make_current = epoxy_eglMakeCurrent;
    epoxy_eglMakeCurrent = watch_context;
    check_loss(destroy_context);
    epoxy_eglMakeCurrent = make_current;
}

static void a_context_cannot_be_made_current(void **state)
{
    (void)state;
    make_current = epoxy_eglMakeCurrent;
    epoxy_eglMakeCurrent = watch_context;
    switches = 0;
    check_loss(reset_context);
    assert_true(switches > 0);
    epoxy_eglMakeCurrent = make_current;
}

/* The driver resets the context while a picture is drawn and only tells when asked. */
static void a_context_is_reset(void **state)
{
    (void)state;
    gl_context context;
    assert_int_equal(gl_context_open(CONTEXT_API_ANY, &context), RLF_OK);
    bool tells_reset = context.tells_reset;
    gl_context_close(&context);
    if (!tells_reset) {
        print_message("SKIPPED: this driver does not tell of resets\n");
        skip();
    }
    reset_status = epoxy_glGetGraphicsResetStatus;
    epoxy_glGetGraphicsResetStatus = tell_reset;
    check_loss(reset_context);
    epoxy_glGetGraphicsResetStatus = reset_status;
}

int main(void)
{
    int unavailable = gl_scene_probe();
    if (unavailable != 0) {
        return unavailable;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_context_is_destroyed),
        cmocka_unit_test(a_context_cannot_be_made_current),
        cmocka_unit_test(a_context_is_reset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
