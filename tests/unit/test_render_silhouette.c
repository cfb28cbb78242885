/* Soft occlusion: edges follow the colour image where it shows them, the depth where it does not,
 * and stay still where nothing changes. */

#include "relief/compositor.h"
#include "test.h"

#include <math.h>

#include "render_scene.h"

#define NEAR_Z 1.2
#define FAR_Z 3.0
#define BOX_Z 2.0

typedef struct stage {
    render_scene *scene;
    rlf_compositor *compositor;
    double left, right; /* true edges of the strip in the picture, pixels */
} stage;

static double to_light(double code)
{
    double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* sRGB code of a pixel that gets a share of its light from the near side. */
static uint8_t mix(double share, int near_value, int far_value)
{
    double light = to_light(far_value) + share * (to_light(near_value) - to_light(far_value));
    double c = light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1.0 / 2.4) - 0.055;
    return (uint8_t)(255.0 * c + 0.5);
}

/* Colours of a strip between two edges, each edge pixel mixed by area. */
static void paint_strip(stage *g, int near_value, int far_value)
{
    for (int32_t i = 0; i < 960 * 540; i++) {
        double x = i % 960;
        double from = rlf_max(x - 0.5, g->left);
        double to = rlf_min(x + 0.5, g->right);
        memset(g->scene->color + 4 * (size_t)i, mix(rlf_max(to - from, 0.0), near_value, far_value),
               3);
    }
}

/* A strip whose depth is `grow` depth pixels too wide on each side, before a box that it hides in
 * part. */
static stage make_stage(int32_t grow, rlf_pool *pool)
{
    stage g = {.scene = scene_make(FAR_Z)};
    render_scene *s = g.scene;
    s->rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    const rlf_camera *k = &s->rig.color;
    g.left = k->fx * ((239.6 - 255.5) / 365.5 - 0.052 / NEAR_Z) + k->cx;
    g.right = k->fx * ((270.3 - 255.5) / 365.5 - 0.052 / NEAR_Z) + k->cx;
    scene_add_strip(s, 240 - grow, 271 + grow, NEAR_Z);
    scene_add_body(s, scene_box(0.6), rlf_vec3_make(0, 0, BOX_Z));
    paint_strip(&g, 200, 60);
    rlf_compositor_def def = scene_def(s);
    def.occlusion = RLF_OCCLUSION_SOFT;
    def.pool = pool;
    assert_int_equal(rlf_compositor_create_soft(&def, &g.compositor), RLF_OK);
    return g;
}

static void free_stage(stage *g)
{
    rlf_compositor_destroy(&g->compositor);
    scene_free(g->scene);
}

static rlf_render_output draw(stage *g)
{
    rlf_render_output out;
    g->scene->frame.sequence++;
    assert_int_equal(rlf_compositor_render(g->compositor, &g->scene->input, &out), RLF_OK);
    return out;
}

/* Width of the hidden part of row y inside the box, pixels; out is where it begins. */
static double hidden_width(const rlf_render_output *out, int32_t y, double *out_begin)
{
    const uint8_t *row = rlf_u8_row(&out->matte, y);
    double hidden = 0.0;
    double before = 0.0;
    for (int32_t u = 390; u < 510; u++) { /* inside the box */
        double share = 1.0 - row[u] / 255.0;
        before += hidden > 0.3 || share > 0.5 ? 0.0 : 1.0 - share;
        hidden += share;
    }
    *out_begin = 390.0 - 0.5 + before;
    return hidden;
}

TEST_CASE(edges_follow_the_colours)
{
    for (int32_t grow = -1; grow <= 2; grow++) {
        stage g = make_stage(grow, NULL);
        rlf_render_output out = draw(&g);
        for (int32_t y = 200; y < 340; y++) {
            double begin;
            double width = hidden_width(&out, y, &begin);
            assert_true(fabs(width - (g.right - g.left)) < 0.1);
            assert_true(fabs(begin - g.left) < 0.6);
        }
        free_stage(&g);
    }
}

/* To a part of a pixel, whichever side is brighter, and however little. */
TEST_CASE(mixed_pixels_show_by_their_share_of_light)
{
    const int values[4][2] = {{200, 60}, {60, 200}, {30, 250}, {120, 160}};
    for (int k = 0; k < 32; k++) {
        stage g = make_stage(0, NULL);
        g.left = 432.0 + 0.125 * (k / 4);
        g.right = 477.0 + 0.125 * (k / 4);
        paint_strip(&g, values[k % 4][0], values[k % 4][1]);
        const rlf_render_output out = draw(&g);
        double begin;
        const double width = hidden_width(&out, 270, &begin);
        assert_true(fabs(width - 45.0) < 0.1);
        assert_true(fabs(begin - g.left) < 0.6);
        free_stage(&g);
    }
}

/* A rim of another shade than the rest of the near side is what its edge is mixed of. */
TEST_CASE(a_rim_has_its_own_colour)
{
    stage g = make_stage(0, NULL);
    paint_strip(&g, 200, 60);
    for (int32_t i = 0; i < 960 * 540; i++) {
        double x = i % 960;
        if (x > g.left + 4.0 && x < g.right - 4.0) {
            memset(g.scene->color + 4 * (size_t)i, 130, 3);
        }
    }
    rlf_render_output out = draw(&g);
    double begin;
    double width = hidden_width(&out, 270, &begin);
    assert_true(fabs(width - (g.right - g.left)) < 0.1);
    free_stage(&g);
}

/* Far side and near side of one colour: only the depth knows. */
TEST_CASE(edges_of_one_colour_stay_where_depth_has_them)
{
    stage g = make_stage(0, NULL);
    paint_strip(&g, 120, 120);
    rlf_render_output out = draw(&g);
    double begin;
    double width = hidden_width(&out, 270, &begin);
    assert_true(fabs(width - (g.right - g.left)) < 1.5);
    free_stage(&g);
    stage wide = make_stage(2, NULL);
    paint_strip(&wide, 120, 120);
    out = draw(&wide);
    width = hidden_width(&out, 270, &begin);
    double ratio = 540.5 / 365.5;
    assert_true(fabs(width - (wide.right - wide.left) - 4 * ratio) < 1.5);
    free_stage(&wide);
}

/* A stripe on the near side, or a slit of light on the far side, is of neither side's colour: the
 * edge does not go there. */
TEST_CASE(patterns_beside_an_edge_do_not_move_it)
{
    for (int32_t k = 0; k < 2; k++) {
        stage g = make_stage(0, NULL);
        double from = k == 0 ? g.left + 1.0 : g.left - 4.0;
        for (int32_t i = 0; i < 960 * 540; i++) {
            if (i % 960 > from && i % 960 < from + 3.0) {
                memcpy(g.scene->color + 4 * (size_t)i, (const uint8_t[3]){20, 160, 250}, 3);
            }
        }
        rlf_render_output out = draw(&g);
        double begin;
        double width = hidden_width(&out, 270, &begin);
        assert_true(fabs(width - (g.right - g.left)) < 0.6);
        assert_true(fabs(begin - g.left) < 1.0);
        free_stage(&g);
    }
}

TEST_CASE(missing_or_smaller_colour_is_no_trouble)
{
    stage g = make_stage(1, NULL);
    uint8_t *small = calloc(480 * 270, 4);
    for (int32_t i = 0; i < 480 * 270; i++) {
        size_t from = 4 * (size_t)(i / 480 * 2 * 960 + i % 480 * 2);
        memcpy(small + 4 * (size_t)i, g.scene->color + from, 4);
    }
    g.scene->frame.color = (rlf_image_rgba8){small, 480, 270, 4 * 480};
    rlf_render_output out = draw(&g);
    double begin;
    assert_true(fabs(hidden_width(&out, 270, &begin) - (g.right - g.left)) < 2.0);
    g.scene->frame.color.data = NULL;
    out = draw(&g);
    double width = hidden_width(&out, 270, &begin);
    assert_true(fabs(width - (g.right - g.left) - 2 * 540.5 / 365.5) < 1.5);
    free(small);
    free_stage(&g);
}

/* Ragged depth edges that change from picture to picture, under colours with a little noise. */
TEST_CASE(still_pictures_do_not_flicker)
{
    stage g = make_stage(0, NULL);
    uint32_t random = 1;
    uint8_t *last = calloc(960 * 540, 1);
    double worst = 0.0;
    for (int picture = 0; picture < 12; picture++) {
        paint_strip(&g, 200, 60);
        for (int32_t i = 0; i < 960 * 540; i++) {
            random = random * 1664525u + 1013904223u;
            g.scene->color[4 * i + 1] = (uint8_t)(g.scene->color[4 * i + 1] + (random >> 30));
        }
        for (int32_t y = 0; y < 424; y++) {
            for (int32_t x = 238; x < 242; x++) {
                random = random * 1664525u + 1013904223u;
                bool is_near = x + (int32_t)(random >> 31) >= 240;
                g.scene->planes[PLANE_DEPTH][y * 512 + x] = (float)(is_near ? NEAR_Z : FAR_Z);
            }
        }
        rlf_render_output out = draw(&g);
        double change = 0.0;
        int32_t count = 0;
        for (int32_t y = 200; y < 340; y++) {
            for (int32_t u = (int32_t)g.left - 9; u < (int32_t)g.left + 9; u++) {
                change += abs(rlf_u8_row(&out.matte, y)[u] - last[y * 960 + u]) / 255.0;
                count++;
            }
        }
        worst = picture >= 4 ? rlf_max(worst, change / count) : 0.0;
        memcpy(last, out.matte.data, 960 * 540);
    }
    assert_true(worst < 0.005);
    free(last);
    free_stage(&g);
}

/* A thing of the room's brightness, but of another tint, comes by: it hides at once. */
TEST_CASE(what_moves_is_told_by_its_tint)
{
    stage g = make_stage(0, NULL);
    for (int picture = 0; picture < 4; picture++) {
        const double by = picture < 3 ? 40.0 : 0.0;
        const int32_t pixels = (int32_t)(by / (540.5 / 365.5));
        for (int32_t i = 0; i < 512 * 424; i++) {
            const int32_t x = i % 512 - pixels;
            g.scene->planes[PLANE_DEPTH][i] = (float)(x >= 240 && x < 271 ? NEAR_Z : FAR_Z);
        }
        for (int32_t i = 0; i < 960 * 540; i++) {
            const double x = i % 960 - by;
            const bool is_near = x > g.left && x < g.right;
            const uint8_t color[2][3] = {{140, 140, 140}, {180, 140, 100}};
            memcpy(g.scene->color + 4 * (size_t)i, color[is_near], 3);
        }
        const rlf_render_output out = draw(&g);
        for (int32_t u = 390; u < 510 && picture == 3; u++) {
            const bool is_inside = u > g.left + 1.5 && u < g.right - 1.5;
            const bool is_outside = u < g.left - 1.5 || u > g.right + 1.5;
            assert_true(!is_inside || rlf_u8_row(&out.matte, 270)[u] < 32);
            assert_true(!is_outside || rlf_u8_row(&out.matte, 270)[u] > 223);
        }
    }
    free_stage(&g);
}

/* A body that meets a wall fades over the sensor's noise, +- 2 sigma. */
TEST_CASE(contact_with_a_surface_is_soft)
{
    stage g = make_stage(0, NULL);
    g.scene->snapshot.body_count = 0;
    rlf_body_state *body = scene_add_body(g.scene, scene_box(0.4), rlf_vec3_make(0.5, 0, FAR_Z));
    double sigma = rlf_depth_noise_sigma(&g.scene->rig.noise, FAR_Z);
    const double in_front[4] = {2.5, 1.0, 0.0, -1.0}; /* sigma */
    const double expected[4] = {1.0, 0.75, 0.5, 0.25};
    for (int i = 0; i < 4; i++) {
        body->T_world_body.p.z = FAR_Z + 0.2 - in_front[i] * sigma;
        rlf_render_output out = draw(&g);
        double u = 540.5 * (0.5 - 0.052) / (FAR_Z - in_front[i] * sigma) + 479.5;
        double share = rlf_u8_row(&out.matte, 270)[(int32_t)u] / 255.0;
        assert_true(fabs(share - expected[i]) < 0.02);
    }
    free_stage(&g);
}

TEST_CASE(threads_and_redraws_change_nothing)
{
    rlf_pool *pool = NULL;
    assert_int_equal(rlf_pool_create(3, &pool), RLF_OK);
    stage a = make_stage(1, NULL);
    stage b = make_stage(1, pool);
    for (int i = 0; i < 3; i++) {
        rlf_render_output first = draw(&a);
        rlf_render_output second = draw(&b);
        assert_memory_equal(first.image.data, second.image.data, 960 * 540 * 4);
        assert_memory_equal(first.matte.data, second.matte.data, 960 * 540);
        uint64_t before = rlf_alloc_count();
        uint8_t *matte = malloc(960 * 540);
        memcpy(matte, first.matte.data, 960 * 540);
        assert_int_equal(rlf_compositor_render(a.compositor, &a.scene->input, &first), RLF_OK);
        assert_memory_equal(first.matte.data, matte, 960 * 540);
        assert_int_equal(rlf_alloc_count(), before);
        free(matte);
    }
    free_stage(&a);
    free_stage(&b);
    rlf_pool_destroy(&pool);
}
