/* Models of real things: depth in their place, and the bodies that they hide. */
#include "known/layer.h"
#include "known_boxes.h"
#include "relief/known.h"
#include "render_scene.h"
#include "test.h"

#include <math.h>

static const rlf_camera camera = {
    .width = 160, .height = 120, .fx = 120, .fy = 120, .cx = 79.5, .cy = 59.5};

static int32_t pixel_at(int32_t x, int32_t y)
{
    return y * camera.width + x;
}

/* A layer before the camera with one model. */
static known_layer open_layer(const rlf_body_state *model)
{
    const rlf_depth_noise noise = {0.001, 0, 0};
    const rlf_snapshot snapshot = {.known = model, .known_count = 1};
    const rlf_pose T = rlf_pose_identity();
    known_layer layer;
    assert_int_equal(known_layer_create(&camera, &camera, &noise, &layer), RLF_OK);
    assert_int_equal(known_layer_place(&layer, &snapshot, &T), RLF_OK);
    return layer;
}

/* A box half a metre wide, 1.75 to 2.25 m away, on the axis: 120 * 0.25 / 1.75 = 17 pixels to each
 * side. */
TEST_CASE(model_takes_the_things_place)
{
    rlf_body_state model = {.shape = scene_box(0.5), .T_world_body = {{0, 0, 2}, {0, 0, 0, 1}}};
    known_layer layer = open_layer(&model);
    static float z[160 * 120], copy[160 * 120];
    static uint8_t mask[160 * 120];
    for (int32_t i = 0; i < 160 * 120; i++) {
        z[i] = 3.0f;
        mask[i] = 1;
    }
    z[pixel_at(80, 60)] = 0.0f;  /* a hole */
    z[pixel_at(81, 60)] = 1.76f; /* the thing */
    z[pixel_at(82, 60)] = 1.2f;  /* somebody before it */
    z[pixel_at(98, 60)] = 1.75f; /* the sensor widens the thing */
    memcpy(copy, z, sizeof(z));
    const known_seen seen = {.depth = z};
    known_layer_clear(&layer, &seen, copy, mask);
    assert_true(copy[pixel_at(81, 60)] == 0.0f && mask[pixel_at(81, 60)] == 0);
    assert_true(copy[pixel_at(82, 60)] == 1.2f && mask[pixel_at(82, 60)] == 1);
    assert_true(copy[pixel_at(83, 60)] == 3.0f && copy[pixel_at(98, 60)] == 0.0f);
    known_layer_cover(&layer, z);
    assert_true(fabs(z[pixel_at(80, 60)] - 1.75) < 1e-6 && fabs(z[pixel_at(81, 60)] - 1.75) < 1e-6);
    assert_true(z[pixel_at(82, 60)] == 1.2f && fabs(z[pixel_at(83, 60)] - 1.75) < 1e-6);
    assert_true(z[pixel_at(98, 60)] == 3.0f);
    int32_t covered = 0;
    for (int32_t i = 0; i < 160 * 120; i++) {
        covered += z[i] < 2.9f;
    }
    assert_int_equal(covered, 34 * 34);
    const rlf_snapshot none = {.known_count = 0};
    const rlf_pose T = rlf_pose_identity();
    assert_int_equal(known_layer_place(&layer, &none, &T), RLF_OK);
    assert_int_equal(layer.count, 0);
    known_layer_destroy(&layer);
}

/* Beside a model the sensor mixes it with what is behind; a slope behind it is no mixture. */
TEST_CASE(mixed_pixels_are_the_models)
{
    rlf_body_state model = {.shape = scene_box(0.5), .T_world_body = {{0, 0, 2}, {0, 0, 0, 1}}};
    known_layer layer = open_layer(&model);
    static float z[160 * 120], copy[160 * 120];
    for (int32_t i = 0; i < 160 * 120; i++) {
        int32_t x = i % camera.width;
        /* a wall, and to the right a plane that goes away: 1/z is linear, 4 cm more per pixel */
        z[i] = x < 80 ? 3.0f : 1.0f / (0.45f - 0.006f * (float)(x - 96));
    }
    z[pixel_at(61, 60)] = 2.4f;  /* one pixel outside */
    z[pixel_at(60, 60)] = 2.97f; /* of the wall, give or take noise */
    z[pixel_at(63, 60)] = 2.4f;  /* the model's last one */
    z[pixel_at(61, 70)] = 1.2f;  /* somebody before it */
    memcpy(copy, z, sizeof(z));
    const known_seen seen = {.depth = z};
    known_layer_clear(&layer, &seen, copy, NULL);
    assert_true(copy[pixel_at(61, 60)] == 0.0f && copy[pixel_at(63, 60)] == 0.0f);
    assert_true(copy[pixel_at(60, 60)] == 2.97f && copy[pixel_at(61, 70)] == 1.2f);
    for (int32_t x = 97; x < 102; x++) {
        assert_true(copy[pixel_at(x, 60)] == z[pixel_at(x, 60)]);
    }
    known_layer_cover(&layer, z);
    assert_true(z[pixel_at(61, 60)] == 3.0f && z[pixel_at(61, 70)] == 1.2f);
    known_layer_destroy(&layer);
}

/* In the inner corner of two bars the way out leads along one of them: what is behind is found
 * askew. */
TEST_CASE(inner_corners_are_mixed_too)
{
    static const rlf_vec3 at[2] = {{0, -0.2, 0}, {0.25, 0.1, 0}};
    static const rlf_vec3 size[2] = {{0.6, 0.1, 0.05}, {0.1, 0.6, 0.05}};
    rlf_model *bars = model_of_boxes(at, size, 2);
    rlf_body_state model = {.shape = {.type = RLF_SHAPE_BOX, .size = {0.6, 0.8, 0.1}},
                            .look = {bars, 1.0, {0, 0, 0}},
                            .T_world_body = {{0, 0, 2}, {0, 0, 0, 1}}};
    known_layer layer = open_layer(&model);
    static float z[160 * 120];
    for (int32_t i = 0; i < 160 * 120; i++) {
        z[i] = 3.0f;
    }
    /* the bars' edges are at x = 91.7 and y = 50.4 */
    for (int32_t k = 0; k < 3; k++) {
        z[pixel_at(91 - k, 51)] = z[pixel_at(91, 51 + k)] = k < 2 ? 1.98f : 2.4f;
    }
    known_layer_cover(&layer, z);
    for (int32_t i = 0; i < 9; i++) {
        assert_true(z[pixel_at(91 - i % 3, 51 + i / 3)] == 3.0f);
    }
    assert_true(z[pixel_at(92, 51)] < 2.0f && z[pixel_at(91, 50)] < 2.0f);
    known_layer_destroy(&layer);
    rlf_model_destroy(&bars);
}

/* Depth changes along a slant by more than noise from one pixel of the sensor to the next. */
TEST_CASE(slants_are_not_before_the_model)
{
    rlf_body_state model = {.shape = {.type = RLF_SHAPE_BOX, .size = {1, 0.2, 2}},
                            .T_world_body = {{0, 0.5, 3}, {0, 0, 0, 1}}};
    known_layer layer = open_layer(&model);
    static float z[160 * 120];
    /* its top, 0.4 m below the camera: z = 48 / (y - 59.5), at y = 75 3.1 m, in the next row 2.9 */
    z[pixel_at(80, 75)] = 48.0f / 16.5f;
    z[pixel_at(81, 75)] = 2.4f;
    known_layer_cover(&layer, z);
    assert_true(fabs(z[pixel_at(80, 75)] - 48.0 / 15.5) < 1e-3);
    assert_true(z[pixel_at(81, 75)] == 2.4f);
    known_layer_destroy(&layer);
}

/* What a silhouette leaves of a body behind it, wherever within a pixel it runs. */
TEST_CASE(models_cut_pixels_in_parts)
{
    render_scene *s = scene_make(3.0);
    scene_add_body(s, scene_box(0.3), rlf_vec3_make(0.15, 0, 2.4));
    rlf_compositor_def def = scene_def(s);
    def.occlusion = RLF_OCCLUSION_SOFT;
    rlf_compositor *compositor = NULL;
    assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
    const rlf_camera *picture = def.rig.has_color ? &def.rig.color : &def.rig.depth;
    const int32_t y = (int32_t)picture->cy;
    for (int k = 0; k < 8; k++) {
        double shift = 0.25 * k * 1.35 / picture->fx;
        rlf_body_state model = {.shape = scene_box(0.3),
                                .T_world_body = {{shift, 0, 1.5}, {0, 0, 0, 1}}};
        s->snapshot.known = &model;
        s->snapshot.known_count = 1;
        rlf_render_output out;
        assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
        double edge = picture->cx + picture->fx * (0.15 + shift + def.rig.T_color_depth.p.x) / 1.35;
        for (int32_t x = (int32_t)edge - 6; x < (int32_t)edge + 6; x++) {
            double shown = rlf_clamp(x + 0.5 - edge, 0.0, 1.0);
            double seen = out.matte.data[y * out.matte.stride + x] / 255.0;
            assert_true(fabs(seen - shown) < 0.13); /* of 4 x 4 samples */
        }
    }
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

/* A body behind a known box that the sensor does not see at all: hidden where the box is. */
TEST_CASE(unseen_model_hides_a_body)
{
    render_scene *s = scene_make(3.0);
    scene_add_body(s, scene_box(0.3), rlf_vec3_make(0.15, 0, 2.4));
    rlf_body_state model = {.shape = scene_box(0.3), .T_world_body = {{0, 0, 1.5}, {0, 0, 0, 1}}};
    for (int occlusion = RLF_OCCLUSION_DEPTH; occlusion <= RLF_OCCLUSION_SOFT; occlusion += 3) {
        rlf_compositor_def def = scene_def(s);
        def.occlusion = (rlf_occlusion)occlusion;
        rlf_compositor *compositor = NULL;
        assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
        int64_t shown[2] = {0, 0};
        for (int k = 0; k < 2; k++) {
            s->snapshot.known = &model;
            s->snapshot.known_count = k;
            rlf_render_output out;
            assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
            for (int32_t i = 0; i < out.matte.width * out.matte.height; i++) {
                shown[k] += out.matte.data[i] > 127;
            }
        }
        /* 540 px * 0.3 / 2.25 = 72 wide, of which all left of x = 0.15 / 1.35 * 540 is hidden */
        assert_true(shown[1] > shown[0] / 10 && shown[1] < shown[0] / 2);
        rlf_compositor_destroy(&compositor);
    }
    scene_free(s);
}

/* A frame of four bars hides with its bars; a body shows through its middle, though it collides as
 * a whole box. */
TEST_CASE(triangles_hide_and_holes_show)
{
    static const rlf_vec3 at[4] = {{-0.125, 0, 0}, {0.125, 0, 0}, {0, -0.125, 0}, {0, 0.125, 0}};
    static const rlf_vec3 size[4] = {
        {0.05, 0.3, 0.05}, {0.05, 0.3, 0.05}, {0.3, 0.05, 0.05}, {0.3, 0.05, 0.05}};
    render_scene *s = scene_make(3.0);
    scene_add_body(s, scene_box(0.6), rlf_vec3_make(0, 0, 2.4));
    rlf_model *frame = model_of_boxes(at, size, 4);
    rlf_body_state model = {.shape = {.type = RLF_SHAPE_BOX, .size = {0.6, 0.6, 0.1}},
                            .look = {frame, 2.0, {0, 0, 0}},
                            .T_world_body = {{0, 0, 1.5}, {0, 0, 0, 1}}};
    s->snapshot.known = &model;
    s->snapshot.known_count = 1;
    rlf_compositor_def def = scene_def(s);
    def.occlusion = RLF_OCCLUSION_SOFT;
    rlf_compositor *compositor;
    rlf_render_output out;
    assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
    assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
    /* the inner edges are 0.2 m, the outer ones 0.3 m from the middle, 1.45 m away */
    const rlf_camera *picture = &def.rig.color;
    for (int32_t x = 300; x < 600; x++) {
        double ray = (x - picture->cx) / picture->fx, left = def.rig.T_color_depth.p.x;
        double p = 1.45 * ray - left, body = 2.1 * ray - left;
        double off = fabs(fabs(p) - 0.25), pixel = 1.45 / picture->fx;
        bool is_bar = off<0.05 - pixel, is_free = off> 0.07; /* bars' inner sides show */
        uint8_t seen = out.matte.data[(int32_t)picture->cy * out.matte.stride + x];
        assert_true(!is_bar || seen == 0);
        assert_true(!is_free || fabs(body) > 0.29 || seen == 255);
    }
    rlf_compositor_destroy(&compositor);
    rlf_model_destroy(&frame);
    scene_free(s);
}
