/* Views, text and sizes: each plane's pixel has the colour it should, in pictures of any size. */

#include "relief/compositor.h"
#include "test.h"

#include <math.h>
#include <string.h>

#include "render/soft/draw.h"
#include "render_scene.h"

static rlf_compositor *create(const rlf_compositor_def *def)
{
    rlf_compositor *compositor = NULL;
    assert_int_equal(rlf_compositor_create_soft(def, &compositor), RLF_OK);
    return compositor;
}

static rlf_render_output show(rlf_compositor *compositor, render_scene *s, rlf_view view)
{
    rlf_render_output out;
    s->input.view = view;
    assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
    return out;
}

/* Picture pixel in the middle of grid pixel (u, v): 512 x 424 fits 960 x 540 by height. */
static const uint8_t *grid_pixel(const rlf_render_output *out, double u, double v)
{
    double scale = 540.0 / 424.0;
    double left = (960 - (int32_t)(512 * scale + 0.5)) / 2;
    return rlf_rgba8_row(&out->image, (int32_t)((v + 0.5) * scale)) +
           4 * (ptrdiff_t)(left + (u + 0.5) * scale);
}

static void assert_color(const uint8_t *pixel, int r, int g, int b)
{
    assert_int_equal(pixel[0], r);
    assert_int_equal(pixel[1], g);
    assert_int_equal(pixel[2], b);
    assert_int_equal(pixel[3], 255);
}

TEST_CASE(names_go_there_and_back)
{
    for (int i = 0; i < RLF_VIEW_COUNT; i++) {
        rlf_view view = RLF_VIEW_COUNT;
        assert_true(rlf_view_parse(rlf_view_name((rlf_view)i), &view));
        assert_int_equal(view, i);
    }
    rlf_view view = RLF_VIEW_DEPTH;
    assert_false(rlf_view_parse("dept", &view));
    assert_null(rlf_view_name(RLF_VIEW_COUNT));
    assert_null(rlf_view_name((rlf_view)-1));
}

/* The row of a legend whose text begins so. */
static rlf_legend_row row_of(const rlf_legend *legend, const char *text)
{
    for (int32_t i = 0; i < legend->row_count; i++) {
        if (strncmp(legend->rows[i].text, text, strlen(text)) == 0) {
            return legend->rows[i];
        }
    }
    fail_msg("%s: no row '%s'", legend->title, text);
    return legend->rows[0];
}

TEST_CASE(every_view_has_a_legend)
{
    rlf_rig rig = {.depth_min_m = 0.5, .depth_max_m = 4.5};
    for (int i = 0; i < RLF_VIEW_COUNT; i++) {
        const rlf_legend legend = rlf_view_legend((rlf_view)i, &rig);
        assert_non_null(legend.title);
        assert_in_range(legend.row_count, i == RLF_VIEW_CAMERA ? 0 : 1, RLF_LEGEND_ROWS);
    }
    rlf_legend legend = rlf_view_legend(RLF_VIEW_DEPTH, &rig);
    soft_color two_and_a_half = soft_color_near_far(0.5);
    rlf_legend_row row = row_of(&legend, "2.50 m");
    assert_memory_equal(&row, &two_and_a_half, 3);
    legend = rlf_view_legend(RLF_VIEW_REASON, &rig);
    soft_color flying = soft_color_reason(RLF_REASON_FLYING);
    row = row_of(&legend, "flying");
    assert_memory_equal(&row, &flying, 3);
    legend = rlf_view_legend(RLF_VIEW_THICKNESS, &rig);
    (void)row_of(&legend, "0.50 m and more");
}

TEST_CASE(a_legend_stays_in_its_corner)
{
    enum { W = 320, H = 200 };
    static uint8_t data[H][4 * W];
    rlf_rig rig = {.depth_min_m = 0.5, .depth_max_m = 4.5};
    for (int32_t size = 1; size <= H; size += 33) {
        memset(data, 9, sizeof(data));
        const rlf_image_rgba8 image = {&data[0][0], size, size, 4 * (ptrdiff_t)W};
        const rlf_legend legend = rlf_view_legend(RLF_VIEW_REASON, &rig);
        rlf_legend_draw(&legend, &image);
        for (int32_t y = 0; y < H; y++) {
            for (int32_t x = y < size ? size : 0; x < W; x++) {
                assert_int_equal(data[y][4 * x], 9);
            }
        }
    }
    soft_color last = soft_color_reason((rlf_reason)(RLF_REASON_COUNT - 1));
    assert_memory_equal(&data[199 - 8][4 * 8], &last, 3);
}

TEST_CASE(near_is_lighter_than_far)
{
    int32_t last = 1 << 20;
    for (int i = 0; i <= 100; i++) {
        soft_color c = soft_color_near_far(i / 100.0);
        int32_t lightness = 299 * c.r + 587 * c.g + 114 * c.b; /* luma of ITU-R BT.601 */
        assert_true(lightness < last);
        last = lightness;
    }
    soft_color warm = soft_color_near_far(-1.0);
    soft_color cold = soft_color_near_far(2.0);
    assert_true(warm.r > warm.b && cold.b > cold.r);
}

TEST_CASE(planes_have_their_colors)
{
    render_scene *s = scene_make(2.5);
    scene_add_strip(s, 200, 300, 1.5);
    int32_t at = 212 * 512 + 250;
    for (int32_t i = at; i < at + 3; i++) {
        s->planes[PLANE_DEPTH][i - 512] = s->planes[PLANE_DEPTH][i] = 0.0f;
        s->planes[PLANE_DEPTH][i + 512] = 0.0f;
        s->planes[PLANE_NORMAL][i] = 0.6f;
        s->planes[PLANE_NORMAL + 1][i] = -0.8f;
        s->planes[PLANE_NORMAL + 2][i] = 0.0f;
        s->reason[i] = RLF_REASON_FLYING;
    }
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_DEPTH);
    soft_color strip = soft_color_near_far((1.5 - 0.5) / 4.0);
    assert_color(grid_pixel(&out, 251, 212), 0, 0, 0);
    assert_color(grid_pixel(&out, 220, 100), strip.r, strip.g, strip.b);
    assert_color(rlf_rgba8_row(&out.image, 270), 0, 0, 0); /* the bar beside the grid */
    out = show(compositor, s, RLF_VIEW_BACKGROUND);
    soft_color wall = soft_color_near_far((2.5 - 0.5) / 4.0);
    assert_color(grid_pixel(&out, 220, 100), wall.r, wall.g, wall.b);
    out = show(compositor, s, RLF_VIEW_NORMALS);
    assert_color(grid_pixel(&out, 251, 212), 204, 230, 128);
    assert_color(grid_pixel(&out, 100, 100), 128, 128, 255);
    out = show(compositor, s, RLF_VIEW_REASON);
    soft_color flying = soft_color_reason(RLF_REASON_FLYING);
    assert_color(grid_pixel(&out, 251, 212), flying.r, flying.g, flying.b);
    assert_int_equal(out.matte.data[270 * 960 + 480], 0);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(foreground_is_tinted_and_motion_colored)
{
    render_scene *s = scene_make(2.5);
    scene_add_strip(s, 200, 300, 1.5);
    for (int32_t i = 0; i < 512 * 424; i++) {
        s->planes[PLANE_VELOCITY][i] = s->foreground[i] != 0 ? 1.0f : 0.0f;
        s->planes[PLANE_THICKNESS][i] = s->foreground[i] != 0 ? 0.5f : 0.0f;
    }
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_FOREGROUND);
    const uint8_t *on = grid_pixel(&out, 250, 200);
    const uint8_t *off = grid_pixel(&out, 100, 200);
    assert_true(on[1] > on[0] + 30 && off[1] == off[0] && off[1] < 80);
    out = show(compositor, s, RLF_VIEW_VELOCITY);
    int32_t red = 0;
    for (int32_t v = 100; v < 300; v += 10) {
        red += grid_pixel(&out, 241, v)[0] > 200;
        assert_true(grid_pixel(&out, 50, v)[0] == grid_pixel(&out, 50, v)[2]);
    }
    assert_true(red == 20);
    out = show(compositor, s, RLF_VIEW_THICKNESS);
    soft_color full = soft_color_near_far(0.0);
    assert_color(grid_pixel(&out, 250, 200), full.r, full.g, full.b);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(regions_have_boxes_and_labels)
{
    render_scene *s = scene_make(2.5);
    s->region = (rlf_region){.label = 7,
                             .layer = RLF_LAYER_FOREGROUND,
                             .x0 = 200,
                             .y0 = 100,
                             .x1 = 300,
                             .y1 = 200,
                             .box = {{-0.5, -0.4, 2.0}, {0.5, 0.4, 2.4}}};
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_REGIONS);
    uint8_t *plain = malloc(960 * 540 * 4);
    memcpy(plain, out.image.data, 960 * 540 * 4);
    s->surface.regions = &s->region;
    s->surface.region_count = 1;
    out = show(compositor, s, RLF_VIEW_REGIONS);
    /* The middle of the box's near, upper, left-to-right edge, drawn in the label's colour. */
    double v = 365.5 * -0.4 / 2.0 + 211.5;
    soft_color c = soft_color_label(7);
    int32_t y = (int32_t)((v + 0.5) * 540.0 / 424.0 - 0.5);
    const uint8_t *above = rlf_rgba8_row(&out.image, y) + 4 * 400;
    const uint8_t *below = rlf_rgba8_row(&out.image, y + 1) + 4 * 400;
    int32_t away = abs(above[0] - c.r) + abs(above[1] - c.g) + abs(above[2] - c.b);
    int32_t away_below = abs(below[0] - c.r) + abs(below[1] - c.g) + abs(below[2] - c.b);
    assert_true((away < away_below ? away : away_below) < 150);
    assert_true(
        memcmp(plain + (size_t)(4 * 960) * (size_t)y, rlf_rgba8_row(&out.image, y), 4 * 960) != 0);
    int32_t white = 0, around = 0; /* "fg 7" in the middle of its pixels, and nowhere else */
    for (int32_t i = 0; i < 512 * 424; i++) {
        const uint8_t *p = grid_pixel(&out, i % 512, i / 512);
        bool is_white = p[0] == 255 && p[2] == 255;
        white += is_white;
        around += is_white && abs(i % 512 - 250) < 40 && i / 512 >= 149 && i / 512 < 170;
    }
    assert_true(white > 40);
    assert_int_equal(around, white);
    free(plain);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

/* Red in the picture is what the colour camera sees of the strip. 52 mm beside it the depth camera
 * sees wall there: it must not be red. */
TEST_CASE(what_the_color_camera_does_not_see_has_no_color)
{
    render_scene *s = scene_make(2.5);
    scene_add_strip(s, 200, 300, 1.0);
    for (int32_t i = 0; i < 960 * 540; i++) {
        double x = (i % 960 - 479.5) / 540.5 * 1.0 + 0.052, u = x * 365.5 + 255.5;
        s->color[4 * i] = u > 199.5 && u < 299.5 ? 255 : s->color[4 * i];
    }
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_FOREGROUND);
    int32_t hidden = 0;
    for (int32_t u = 150; u < 350; u++) {
        bool is_strip = s->foreground[212 * 512 + u] != 0;
        const uint8_t *p = grid_pixel(&out, u, 212);
        bool is_edge = abs(u - 200) < 2 || abs(u - 300) < 2;
        assert_true(is_edge || (p[0] > p[2] + 40) == is_strip);
        double wall_u = (u - 255.5) + 365.5 * 0.052 * (1.0 - 1.0 / 2.5);
        hidden += !is_strip && wall_u > 199.5 - 255.5 && wall_u < 299.5 - 255.5;
    }
    assert_in_range(hidden, 9, 13); /* 11.4 pixels of parallax */
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(mesh_lines_meet_where_the_points_are)
{
    render_scene *s = scene_make(2.0);
    memset(s->color, 0, 960 * 540 * 4);
    scene_add_strip(s, 0, 256, 1.0);
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_MESH);
    double u = 540.5 * ((320 - 255.5) / 365.5 - 0.052 / 2.0) + 479.5;
    double v = 540.5 * ((80 - 211.5) / 365.5) + 269.5;
    assert_true(rlf_rgba8_row(&out.image, (int32_t)(v + 0.5))[4 * (int32_t)(u + 0.5)] > 60);
    /* No edge bridges the jump from the strip's last column of lines to the wall's first. */
    double strip = 540.5 * ((248 - 255.5) / 365.5 - 0.052 / 1.0) + 479.5;
    double wall = 540.5 * ((256 - 255.5) / 365.5 - 0.052 / 2.0) + 479.5;
    for (int32_t y = 0; y < 540; y++) {
        for (int32_t x = (int32_t)strip + 3; x < (int32_t)wall - 2; x++) {
            assert_int_equal(rlf_rgba8_row(&out.image, y)[4 * x], 0);
        }
    }
    assert_true(wall - strip > 20);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(any_size_is_a_picture)
{
    static const int32_t sizes[6][2] = {{1, 1},   {3, 7},     {961, 1},
                                        {1, 333}, {333, 222}, {1200, 675}};
    const char *const lines[2] = {"any size", "is a picture \x01\xff"};
    for (int i = 0; i < 6; i++) {
        render_scene *s = scene_make(2.0);
        scene_add_body(s, scene_box(0.4), rlf_vec3_make(0, 0, 1.4));
        s->input.overlay = lines;
        s->input.overlay_count = 2;
        rlf_compositor_def def = scene_def(s);
        def.width = sizes[i][0];
        def.height = sizes[i][1];
        def.enable_overlay = true;
        for (int mode = 0; mode < 3; mode++) {
            def.occlusion = (rlf_occlusion)mode;
            rlf_compositor *compositor = create(&def);
            for (int view = 0; view < RLF_VIEW_COUNT; view++) {
                rlf_render_output out = show(compositor, s, (rlf_view)view);
                assert_int_equal(out.image.width, sizes[i][0]);
                assert_int_equal(out.matte.height, sizes[i][1]);
            }
            rlf_render_output out = show(compositor, s, RLF_VIEW_CAMERA);
            if (i >= 4) { /* the smaller ones are coarser than the body */
                const uint8_t *row = rlf_u8_row(&out.matte, sizes[i][1] / 2);
                assert_int_equal(row[sizes[i][0] * 47 / 100], 255);
            }
            rlf_compositor_destroy(&compositor);
        }
        scene_free(s);
    }
}

TEST_CASE(picture_without_bodies_is_the_camera_s)
{
    render_scene *s = scene_make(2.0);
    s->input.snapshot = NULL;
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_CAMERA);
    assert_memory_equal(out.image.data, s->color, 960 * 540 * 4);
    for (int32_t i = 0; i < 960 * 540; i++) {
        assert_int_equal(out.matte.data[i], 0);
    }
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(frame_without_color_is_grey_depth)
{
    for (int has_camera = 0; has_camera < 2; has_camera++) {
        render_scene *s = scene_make(2.5);
        s->rig.has_color = has_camera != 0;
        s->frame.color.data = NULL;
        rlf_compositor_def def = scene_def(s);
        rlf_compositor *compositor = create(&def);
        rlf_render_output out = show(compositor, s, RLF_VIEW_CAMERA);
        assert_int_equal(out.image.width, has_camera ? 960 : 512);
        const uint8_t *middle =
            rlf_rgba8_row(&out.image, out.image.height / 2) + 4 * (out.image.width / 2);
        assert_color(middle, 140, 140, 140); /* half way from 0.5 to 4.5 m */
        rlf_compositor_destroy(&compositor);
        scene_free(s);
    }
}

TEST_CASE(color_of_another_size_is_resized)
{
    render_scene *s = scene_make(2.5);
    uint8_t *half = malloc(480 * 270 * 4);
    for (int32_t i = 0; i < 480 * 270; i++) {
        int32_t x = i % 480;
        const uint8_t pixel[4] = {(uint8_t)(x / 2), (uint8_t)(i / 480 / 2), 9, 255};
        memcpy(half + 4 * i, pixel, 4);
    }
    s->frame.color = (rlf_image_rgba8){half, 480, 270, 480 * 4};
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_CAMERA);
    for (int32_t x = 0; x < 960; x += 37) {
        const uint8_t *pixel = rlf_rgba8_row(&out.image, 300) + 4 * x;
        assert_true(abs(pixel[0] - x / 4) <= 1 && abs(pixel[1] - 75) <= 1 && pixel[2] == 9);
    }
    rlf_compositor_destroy(&compositor);
    free(half);
    scene_free(s);
}

TEST_CASE(a_picture_may_be_8k)
{
    render_scene *s = scene_make(2.5);
    scene_add_body(s, scene_box(0.8), rlf_vec3_make(0.03, 0, 1.5));
    rlf_compositor_def def = scene_def(s);
    def.width = 7680;
    def.height = 4320;
    def.estimates_light = def.estimates_light_direction = true;
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_CAMERA);
    assert_int_equal(out.image.width, 7680);
    assert_int_equal(out.image.height, 4320);
    assert_int_equal(rlf_u8_row(&out.matte, 2160)[3840], 255);
    assert_int_equal(rlf_u8_row(&out.matte, 0)[0], 0);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(overlay_draws_its_letters_only_when_enabled)
{
    render_scene *s = scene_make(2.5);
    const char *const lines[1] = {"|"};
    s->input.overlay = lines;
    s->input.overlay_count = 1;
    s->input.snapshot = NULL;
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *without = create(&def);
    def.enable_overlay = true;
    rlf_compositor *with = create(&def);
    rlf_render_output out = show(without, s, RLF_VIEW_CAMERA);
    assert_memory_equal(out.image.data, s->color, 960 * 540 * 4);
    out = show(with, s, RLF_VIEW_CAMERA);
    int32_t scale = soft_text_scale(540);
    for (int32_t row = 0; row < 7 * scale; row++) { /* the stroke of '|' is the third column */
        const uint8_t *pixel = rlf_rgba8_row(&out.image, 4 * scale + row) + 4 * (6 * scale);
        assert_color(pixel, 245, 245, 235);
    }
    assert_true(rlf_rgba8_row(&out.image, 4 * scale)[4 * 4 * scale] < 90); /* the backing */
    assert_memory_equal(rlf_rgba8_row(&out.image, 100), s->color + 100 * 960 * 4, 960 * 4);
    rlf_compositor_destroy(&without);
    rlf_compositor_destroy(&with);
    scene_free(s);
}

TEST_CASE(letters_differ)
{
    for (int a = 0; a < 95; a++) {
        for (int b = a + 1; b < 95; b++) {
            assert_true(memcmp(soft_font[a], soft_font[b], 7) != 0);
        }
        for (int row = 0; row < 7; row++) {
            assert_in_range(soft_font[a][row], 0, 31);
        }
    }
}

TEST_CASE(wrong_defs_are_refused)
{
    render_scene *s = scene_make(2.5);
    const rlf_compositor_def good = scene_def(s);
    rlf_compositor *compositor = NULL;
    for (int i = 0; i < 6; i++) {
        rlf_compositor_def def = good;
        def.width = i == 0 ? -1 : (i == 1 ? RLF_IMAGE_SIZE_MAX + 1 : 0);
        def.rig.depth.fx = i == 2 ? 0.0 : def.rig.depth.fx;
        def.grid.width = i == 3 ? 0 : def.grid.width;
        def.light_direction.x = i == 4 ? NAN : def.light_direction.x;
        def.occlusion = i == 5 ? (rlf_occlusion)4 : def.occlusion;
        assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_ERROR_INVALID);
        assert_null(compositor);
        assert_true(rlf_error_text()[0] != '\0');
    }
    compositor = create(&good);
    s->surface.width = 100;
    rlf_render_output out;
    assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_ERROR_INVALID);
    rlf_compositor_destroy(&compositor);
    rlf_compositor_destroy(&compositor);
    rlf_compositor_destroy(NULL);
    scene_free(s);
}
