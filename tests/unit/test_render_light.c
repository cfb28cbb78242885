/* Light on bodies that follows the camera's picture. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render/room_light.h"

#include <math.h>

#include "render_scene.h"

static void fill(render_scene *s, int r, int g, int b)
{
    for (int32_t i = 0; i < 960 * 540; i++) {
        uint8_t *pixel = s->color + 4 * (size_t)i;
        pixel[0] = (uint8_t)r;
        pixel[1] = (uint8_t)g;
        pixel[2] = (uint8_t)b;
    }
}

/* Colour in the middle of a body before the wall, in a picture of one colour. */
static void body_color(const rlf_compositor_def *def, render_scene *s, uint8_t out[3])
{
    rlf_compositor *compositor = NULL;
    rlf_render_output output;
    assert_int_equal(rlf_compositor_create_soft(def, &compositor), RLF_OK);
    assert_int_equal(rlf_compositor_render(compositor, &s->input, &output), RLF_OK);
    memcpy(out, rlf_rgba8_row(&output.image, 270) + 4 * 480, 3);
    rlf_compositor_destroy(&compositor);
}

/* A picture half as bright as a lit room's mean halves a body; a bright one leaves it alone. */
static void bodies_are_as_dark_as_the_picture(void **state)
{
    (void)state;
    render_scene *s = scene_make(3.0);
    scene_add_body(s, scene_box(0.5), rlf_vec3_make(0, 0, 1.5))->color[2] = 0.8f;
    rlf_compositor_def def = scene_def(s);
    uint8_t plain[3];
    uint8_t lit[3];
    body_color(&def, s, plain);
    def.estimates_light = true;
    fill(s, 200, 200, 200);
    body_color(&def, s, lit);
    assert_memory_equal(lit, plain, 3);
    fill(s, 59, 59, 59);
    body_color(&def, s, lit);
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(lit[k] - 0.5 * plain[k]) < 1.5);
    }
    fill(s, 0, 0, 0);
    body_color(&def, s, lit);
    assert_true(fabs(lit[0] - 0.25 * plain[0]) < 1.5); /* never black */
    s->frame.color.data = NULL;
    body_color(&def, s, lit);
    assert_memory_equal(lit, plain, 3); /* nothing to estimate from */
    rlf_compositor_def dim = scene_def(s);
    dim.light_color[1] = 0.5f;
    body_color(&dim, s, lit);
    assert_int_equal(lit[0], plain[0]);
    assert_true(fabs(lit[1] - 0.5 * plain[1]) < 1.5);
    scene_free(s);
}

static void tint_is_limited_and_change_is_slow(void **state)
{
    (void)state;
    render_scene *s = scene_make(3.0);
    rlf_compositor_def def = scene_def(s);
    room_light l = {.is_known = false};
    def.estimates_light = true;
    fill(s, 90, 60, 30); /* mean 60 */
    room_light_update(&l, &def, &s->frame);
    const float mean = 60.0f / 118.0f;
    assert_true(fabsf(l.color[0] - 1.15f * mean) < 1e-4f);
    assert_true(fabsf(l.color[1] - mean) < 1e-4f);
    assert_true(fabsf(l.color[2] - 0.85f * mean) < 1e-4f);
    fill(s, 118, 118, 118);
    room_light_update(&l, &def, &s->frame); /* the same frame once more: nothing new */
    assert_true(fabsf(l.color[1] - mean) < 1e-4f);
    float last = l.color[1];
    for (uint64_t i = 1; i < 100; i++) {
        s->frame.sequence = i;
        room_light_update(&l, &def, &s->frame);
        assert_true(l.color[1] > last && l.color[1] - last < 0.051f * (1.0f - mean));
        last = l.color[1];
    }
    assert_true(last > 0.99f);
    scene_free(s);
}

static void wrong_light_is_refused(void **state)
{
    (void)state;
    render_scene *s = scene_make(3.0);
    const float wrong[3] = {-0.1f, 1.1f, NAN};
    for (int i = 0; i < 3; i++) {
        rlf_compositor_def def = scene_def(s);
        rlf_compositor *compositor = NULL;
        def.light_color[i] = wrong[i];
        assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_ERROR_INVALID);
        assert_non_null(strstr(rlf_error_text(), "light_color"));
    }
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_as_dark_as_the_picture),
        cmocka_unit_test(tint_is_limited_and_change_is_slow),
        cmocka_unit_test(wrong_light_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
