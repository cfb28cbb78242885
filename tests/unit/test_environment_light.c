/* Light on bodies that follows the camera's picture. */

#include "environment/light.h"
#include "test.h"

#include <math.h>

#include "render_scene.h"

static rlf_result create_direction(const rlf_compositor_def *def, light_direction *out)
{
    return light_direction_create(def->light_direction, def->estimates_light_direction, &def->grid,
                                  out);
}

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
TEST_CASE(bodies_are_as_dark_as_the_picture)
{
    render_scene *s = scene_make(3.0);
    scene_add_body(s, scene_box(0.5), rlf_vec3_make(0, 0, 1.5))->color[2] = 0.8f;
    rlf_compositor_def def = scene_def(s);
    uint8_t plain[3];
    uint8_t lit[3];
    rlf_compositor_def estimating = def;
    estimating.estimates_light = true;
    body_color(&def, s, plain);
    fill(s, 59, 59, 59);
    body_color(&estimating, s, lit);
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(lit[k] - 0.5 * plain[k]) < 1.5);
    }
    fill(s, 200, 200, 200);
    body_color(&def, s, plain);
    body_color(&estimating, s, lit);
    assert_memory_equal(lit, plain, 3);
    fill(s, 0, 0, 0);
    body_color(&def, s, plain);
    body_color(&estimating, s, lit);
    assert_true(fabs(lit[0] - 0.25 * plain[0]) < 1.5); /* never black */
    s->frame.color.data = NULL;
    body_color(&def, s, plain);
    body_color(&estimating, s, lit);
    assert_memory_equal(lit, plain, 3); /* nothing to estimate from */
    rlf_compositor_def dim = scene_def(s);
    dim.light_color[1] = 0.5f;
    body_color(&dim, s, lit);
    assert_int_equal(lit[0], plain[0]);
    assert_true(fabs(lit[1] - 0.5 * plain[1]) < 1.5);
    scene_free(s);
}

TEST_CASE(tint_is_limited_and_change_is_slow)
{
    render_scene *s = scene_make(3.0);
    rlf_compositor_def def = scene_def(s);
    room_light l = {.is_known = false};
    def.estimates_light = true;
    fill(s, 90, 60, 30); /* mean 60 */
    room_light_update(&l, def.light_color, def.estimates_light, &s->frame);
    const float mean = 60.0f / 118.0f;
    assert_true(fabsf(l.color[0] - 1.15f * mean) < 1e-4f);
    assert_true(fabsf(l.color[1] - mean) < 1e-4f);
    assert_true(fabsf(l.color[2] - 0.85f * mean) < 1e-4f);
    fill(s, 118, 118, 118);
    room_light_update(&l, def.light_color, def.estimates_light,
                      &s->frame); /* the same frame once more: nothing new */
    assert_true(fabsf(l.color[1] - mean) < 1e-4f);
    float last = l.color[1];
    for (uint64_t i = 1; i < 100; i++) {
        s->frame.sequence = i;
        room_light_update(&l, def.light_color, def.estimates_light, &s->frame);
        assert_true(l.color[1] > last && l.color[1] - last < 0.051f * (1.0f - mean));
        last = l.color[1];
    }
    assert_true(last > 0.99f);
    scene_free(s);
}

TEST_CASE(wrong_light_is_refused)
{
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

/* Normal of a wall of balls, 30 cm apart, at (x, y). */
static rlf_vec3 bump_at(double x, double y)
{
    const double radius = 0.17;
    double u = x - 0.3 * floor(x / 0.3) - 0.15;
    double v = y - 0.3 * floor(y / 0.3) - 0.15;
    double square = rlf_min(u * u + v * v, 0.9 * radius * radius);
    double shrink = sqrt(square / (u * u + v * v + 1e-12));
    return rlf_vec3_make(u * shrink / radius, v * shrink / radius,
                         -sqrt(1.0 - square / (radius * radius)));
}

static uint8_t encode(double light)
{
    return (uint8_t)(255.0 * pow(light, 1.0 / 2.2) + 0.5);
}

/* The wall at 3 m, with its colours under a light that is all around, but more from one side. */
static void light_bumps(render_scene *s, rlf_vec3 direction, double directed)
{
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        rlf_vec3 n = bump_at(3.0 * (double)s->ray_x[i], 3.0 * (double)s->ray_y[i]);
        s->planes[PLANE_NORMAL][i] = (float)n.x;
        s->planes[PLANE_NORMAL + 1][i] = (float)n.y;
        s->planes[PLANE_NORMAL + 2][i] = (float)n.z;
    }
    const rlf_camera *k = &s->rig.color;
    for (int32_t i = 0; i < k->width * k->height; i++) {
        double x = 3.0 * (i % k->width - k->cx) / k->fx + 0.052;
        double y = 3.0 * (i / k->width - k->cy) / k->fy;
        double light = 0.5 * (1.0 - directed * rlf_dot(bump_at(x, y), direction));
        s->color[4 * (size_t)i] = encode(light);
        s->color[4 * (size_t)i + 1] = encode(0.7 * light);
        s->color[4 * (size_t)i + 2] = encode(0.5 * light);
    }
}

TEST_CASE(shading_tells_where_the_light_is)
{
    const rlf_vec3 lights[4] = {
        {0.3, 0.8, 0.5}, {-0.8, 0.3, 0.5}, {0.1, -0.4, 0.9}, {0.7, 0.6, -0.1}};
    render_scene *s = scene_make(3.0);
    rlf_compositor_def def = scene_def(s);
    def.estimates_light_direction = true;
    for (int i = 0; i < 4; i++) {
        rlf_vec3 direction = rlf_normalize(lights[i]);
        light_direction l;
        light_bumps(s, direction, 0.6);
        assert_int_equal(create_direction(&def, &l), RLF_OK);
        light_direction_update(&l, &def.rig, &s->frame, &s->surface);
        assert_true(l.is_known);
        assert_true(rlf_dot(l.now, direction) > 0.99); /* 8 degrees */
        light_direction_destroy(&l);
    }
    scene_free(s);
}

TEST_CASE(given_light_stays_where_nothing_tells)
{
    render_scene *s = scene_make(3.0);
    rlf_compositor_def def = scene_def(s);
    light_direction l;
    assert_int_equal(create_direction(&def, &l), RLF_OK);
    light_direction_update(&l, &def.rig, &s->frame, &s->surface);
    assert_false(l.has_sums); /* not asked for */
    def.estimates_light_direction = true;
    assert_int_equal(create_direction(&def, &l), RLF_OK);
    light_direction_update(&l, &def.rig, &s->frame, &s->surface);
    assert_false(l.is_known); /* a flat wall */
    light_direction_destroy(&l);
    light_bumps(s, def.light_direction, 0.0);
    assert_int_equal(create_direction(&def, &l), RLF_OK);
    light_direction_update(&l, &def.rig, &s->frame, &s->surface);
    assert_false(l.is_known); /* light from everywhere */
    assert_true(rlf_dot(l.now, def.light_direction) > 0.999999);
    light_direction_destroy(&l);
    s->frame.color.data = NULL;
    assert_int_equal(create_direction(&def, &l), RLF_OK);
    light_direction_update(&l, &def.rig, &s->frame, &s->surface);
    assert_false(l.has_sums);
    light_direction_destroy(&l);
    scene_free(s);
}

/* The direction follows a light that moves without a jump. */
TEST_CASE(direction_changes_slowly)
{
    render_scene *s = scene_make(3.0);
    rlf_compositor_def def = scene_def(s);
    def.estimates_light_direction = true;
    light_direction l;
    rlf_vec3 right = rlf_normalize(rlf_vec3_make(0.7, 0.3, 0.5));
    light_bumps(s, rlf_normalize(rlf_vec3_make(-0.7, 0.3, 0.5)), 0.6);
    assert_int_equal(create_direction(&def, &l), RLF_OK);
    light_direction_update(&l, &def.rig, &s->frame, &s->surface);
    light_bumps(s, right, 0.6);
    rlf_vec3 last = l.now;
    for (uint64_t i = 1; i < 120; i++) {
        s->frame.sequence = i;
        light_direction_update(&l, &def.rig, &s->frame, &s->surface);
        assert_true(rlf_dot(l.now, last) > 0.9);
        last = l.now;
    }
    assert_true(rlf_dot(last, right) > 0.95);
    light_direction_destroy(&l);
    scene_free(s);
}
