/* Points from a free viewpoint, contacts and the plot: where geometry says they must be. */

#include "render_scene.h"
#include "test.h"

#include <math.h>

static rlf_compositor *create(const render_scene *s)
{
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = NULL;
    def.enable_overlay = true;
    assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
    return compositor;
}

static rlf_render_output show(rlf_compositor *compositor, render_scene *s, rlf_view view)
{
    rlf_render_output out;
    s->input.view = view;
    assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
    return out;
}

static const uint8_t *pixel(const rlf_render_output *out, double u, double v)
{
    return rlf_rgba8_row(&out->image, (int32_t)(v + 0.5)) + 4 * (int32_t)(u + 0.5);
}

/* Middle of the pixels that the matte shows; false when there are none. */
static bool middle_of_matte(const rlf_render_output *out, double *u, double *v)
{
    double count = 0.0;
    *u = *v = 0.0;
    for (int32_t y = 0; y < out->matte.height; y++) {
        for (int32_t x = 0; x < out->matte.width; x++) {
            if (rlf_u8_row(&out->matte, y)[x] > 127) {
                *u += x;
                *v += y;
                count += 1.0;
            }
        }
    }
    *u /= count > 0.0 ? count : 1.0;
    *v /= count > 0.0 ? count : 1.0;
    return count > 0.0;
}

/* The scene's range is 0.5 to 4.5 m: the orbit turns about (0, 0, 2.5). */
static rlf_vec3 seen_from(rlf_vec3 p, double yaw, double pitch, double zoom)
{
    double x = p.x;
    double y = p.y;
    double z = p.z - 2.5;
    double turned_x = cos(yaw) * x + sin(yaw) * z;
    double turned_z = -sin(yaw) * x + cos(yaw) * z;
    return rlf_vec3_make(turned_x, cos(pitch) * y - sin(pitch) * turned_z,
                         sin(pitch) * y + cos(pitch) * turned_z + 2.5 * zoom);
}

TEST_CASE(body_is_where_the_orbit_puts_it)
{
    static const rlf_orbit orbits[4] = {{0, 0, 0}, {0.6, 0, 1}, {-0.4, 0.5, 1}, {0.3, -0.2, 1.6}};
    const rlf_vec3 at = {0.2, -0.1, 2.2};
    for (int i = 0; i < 4; i++) {
        render_scene *s = scene_make(3.0);
        scene_add_body(s, (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.1}, at);
        rlf_compositor *compositor = create(s);
        s->input.orbit = orbits[i];
        rlf_render_output out = show(compositor, s, RLF_VIEW_POINTS);
        double zoom = orbits[i].zoom > 0.0 ? orbits[i].zoom : 1.0;
        rlf_vec3 p = seen_from(at, orbits[i].yaw, orbits[i].pitch, zoom);
        double u, v;
        assert_true(middle_of_matte(&out, &u, &v));
        assert_true(fabs(u - (540.5 * p.x / p.z + 479.5)) < 2.0);
        assert_true(fabs(v - (540.5 * p.y / p.z + 269.5)) < 2.0);
        rlf_compositor_destroy(&compositor);
        scene_free(s);
    }
}

/* Yaw > 0 looks from further right: what is behind comes out on the right of what is in front. */
TEST_CASE(points_hide_bodies_behind_them)
{
    render_scene *s = scene_make(3.5);
    scene_add_strip(s, 236, 276, 1.5);
    scene_add_body(s, scene_box(0.1), rlf_vec3_make(0, 0, 2.5));
    rlf_compositor *compositor = create(s);
    double u, v;
    rlf_render_output out = show(compositor, s, RLF_VIEW_POINTS);
    assert_false(middle_of_matte(&out, &u, &v));
    s->input.orbit = (rlf_orbit){.yaw = 0.5};
    out = show(compositor, s, RLF_VIEW_POINTS);
    assert_true(middle_of_matte(&out, &u, &v));
    s->input.orbit = (rlf_orbit){.yaw = (double)NAN, .pitch = (double)INFINITY, .zoom = -1.0};
    out = show(compositor, s, RLF_VIEW_POINTS);
    assert_false(middle_of_matte(&out, &u, &v)); /* as all zero */
    /* The main view is not changed by it. */
    rlf_render_output camera = show(compositor, s, RLF_VIEW_CAMERA);
    assert_false(middle_of_matte(&camera, &u, &v));
    assert_memory_equal(camera.image.data, s->color, 4);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(contact_is_an_arrow_along_its_normal)
{
    render_scene *s = scene_make(2.0);
    const rlf_contact contact = {.other = RLF_CONTACT_BACKGROUND,
                                 .point = {0.252, 0.1, 2.0},
                                 .normal = {0, -1, 0},
                                 .impulse = 0.2};
    s->snapshot.contacts = &contact;
    s->snapshot.contact_count = 1;
    rlf_compositor *compositor = create(s);
    rlf_render_output out = show(compositor, s, RLF_VIEW_CONTACTS);
    double u = 540.5 * 0.2 / 2.0 + 479.5;
    double v = 540.5 * 0.1 / 2.0 + 269.5;
    double length = 540.5 * (0.03 + 0.15) / 2.0;
    assert_int_equal(pixel(&out, u, v)[0], 255);
    assert_int_equal(pixel(&out, u, v)[2], 60);
    assert_true(pixel(&out, u, v - 0.5 * length)[0] > 200); /* along it */
    assert_int_equal(pixel(&out, u, v - length - 4.0)[0], pixel(&out, u, v - length - 4.0)[1]);
    assert_int_equal(pixel(&out, u, v + 6.0)[0], pixel(&out, u, v + 6.0)[1]); /* grey wall */
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(plot_is_as_high_as_its_values)
{
    static const char *const names[2] = {"a", "b"};
    const float values[3 * 2] = {10, 10, 20, 20, (float)NAN, 1e9f};
    const rlf_plot plot = {names, values, 2, 3, 40.0f};
    render_scene *s = scene_make(2.0);
    rlf_compositor *compositor = create(s);
    rlf_render_output out = show(compositor, s, RLF_VIEW_CAMERA);
    static uint8_t before[960 * 540 * 4];
    memcpy(before, out.image.data, sizeof(before));
    s->input.plot = &plot;
    out = show(compositor, s, RLF_VIEW_CAMERA);
    /* Text scale 2: bars are 2 pixels wide from x = 8, 80 pixels are twice the line. */
    int32_t height[2] = {0, 0};
    for (int32_t i = 0; i < 2; i++) {
        for (int32_t y = 430; y < 512; y++) {
            const uint8_t *now = rlf_rgba8_row(&out.image, y) + 4 * (8 + 2 * i);
            height[i] += now[0] + now[1] + now[2] > 300;
        }
    }
    assert_in_range(height[0], 19, 22);
    assert_in_range(height[1], 38, 42);
    for (int32_t y = 0; y < 400; y++) {
        assert_memory_equal(rlf_rgba8_row(&out.image, y), before + 4 * 960 * y, 4 * 960);
    }
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}
