/* A projector's picture: bodies alone, where its lens throws them, and nothing of what real things
 * hide from it. */
#include "created.h"
#include "pinhole.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 320
#define HEIGHT 240

/* A wall square to the depth camera, with or without a board before its right half. */
typedef struct room {
    uint16_t depth[WIDTH * HEIGHT];
    uint8_t color[4 * WIDTH * HEIGHT];
    rlf_rig rig;
    rlf_frame frame;
} room;

static room *make_room(double wall_m, double board_m)
{
    room *r = calloc(1, sizeof *r);
    assert_non_null(r);
    r->rig = rlf_rig_default();
    r->rig.depth = pinhole(WIDTH, HEIGHT, 260);
    r->rig.color = r->rig.depth;
    r->rig.has_color = true;
    r->rig.T_color_depth = rlf_pose_identity();
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const bool is_board = board_m > 0.0 && i % WIDTH >= WIDTH / 2;
        r->depth[i] = (uint16_t)(1000.0 * (is_board ? board_m : wall_m) + 0.5);
        memset(r->color + 4 * (ptrdiff_t)i, 70 + i % 50, 3);
        r->color[4 * i + 3] = 255;
    }
    r->frame = (rlf_frame){.depth_u16 = r->depth,
                           .depth_stride = 2 * WIDTH,
                           .depth_units_per_metre = 1000.0,
                           .color = {r->color, WIDTH, HEIGHT, 4 * WIDTH}};
    return r;
}

/* Balls that hang still; the picture has hard edges and the scene's light alone, as a projector's.
 */
static rlf_pipeline *make_pipeline(const room *r, const rlf_vec3 *places, int32_t count)
{
    rlf_pipeline *p = NULL;
    rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &r->rig, NULL);
    def.compositor.occlusion = RLF_OCCLUSION_DEPTH;
    def.compositor.enable_real_ambient = false;
    p = pipeline_of(&def);
    for (int32_t i = 0; i < count; i++) {
        rlf_body_def body = rlf_body_def_default();
        body.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.02};
        body.position = places[i];
        body.release_time = 100.0;
        add_body(rlf_pipeline_get_world(p), &body);
    }
    rlf_pipeline_set_view(p, RLF_VIEW_BODIES);
    return p;
}

static rlf_image_rgba8 picture_of(rlf_pipeline *p, const room *r)
{
    rlf_pipeline_output out;
    rlf_frame frame = r->frame;
    const rlf_result result = rlf_pipeline_push(p, &frame, &out);
    if (result != RLF_OK) {
        print_message("%s\n", rlf_error_text());
    }
    assert_int_equal(result, RLF_OK);
    return out.render.image;
}

/* Mean place of what shines; false where nothing does. */
static bool find_light(const rlf_image_rgba8 *image, double out[2])
{
    double sum = 0.0;
    out[0] = out[1] = 0.0;
    for (int32_t i = 0; i < image->width * image->height; i++) {
        const uint8_t *pixel = image->data + 4 * (ptrdiff_t)i;
        sum += pixel[3];
        out[0] += pixel[3] * (double)(i % image->width);
        out[1] += pixel[3] * (double)(i / image->width);
        if (pixel[3] == 0) {
            assert_int_equal(pixel[0] + pixel[1] + pixel[2], 0);
        }
    }
    out[0] /= sum > 0.0 ? sum : 1.0;
    out[1] /= sum > 0.0 ? sum : 1.0;
    return sum > 0.0;
}

/* Half a metre to the right of the camera, turned to the left by 12 degrees, with a lens. */
static rlf_camera projector_lens(void)
{
    return (rlf_camera){.width = 1280,
                        .height = 800,
                        .fx = 1500,
                        .fy = 1480,
                        .cx = 640,
                        .cy = 790, /* throws upwards, as projectors on tables do */
                        .distortion_model = RLF_DISTORTION_PLUMB_BOB,
                        .distortion = {-0.08, 0.03, 0.001, -0.002}};
}

static rlf_pose projector_pose(void)
{
    const double half = 0.5 * 12.0 * RLF_PI / 180.0;
    const rlf_pose T_depth_projector = {.q = {0.0, -sin(half), 0.0, cos(half)},
                                        .p = {0.5, 0.05, 0.1}};
    return rlf_pose_invert(&T_depth_projector);
}

TEST_CASE(a_body_lands_where_the_lens_throws_it)
{
    const rlf_vec3 places[4] = {
        {0.0, 0.0, 1.2}, {0.2, -0.25, 1.6}, {-0.3, -0.1, 1.5}, {0.35, -0.4, 1.9}};
    const rlf_camera lens = projector_lens();
    const rlf_pose T_projector_depth = projector_pose();
    room *r = make_room(2.4, 0.0);
    for (int i = 0; i < 4; i++) {
        rlf_pipeline *p = make_pipeline(r, &places[i], 1);
        assert_int_equal(rlf_pipeline_set_projector(p, &lens, &T_projector_depth), RLF_OK);
        const rlf_image_rgba8 image = picture_of(p, r);
        double seen[2], u, v;
        assert_int_equal(image.width, lens.width);
        assert_true(find_light(&image, seen));
        assert_true(
            rlf_camera_project(&lens, rlf_transform(&T_projector_depth, places[i]), &u, &v));
        assert_true(fabs(seen[0] - u) < 1.0 && fabs(seen[1] - v) < 1.0);
        rlf_pipeline_destroy(&p);
    }
    free(r);
}

/* The board is between the projector and the second body, and behind the first. */
TEST_CASE(real_things_hide_bodies_from_it)
{
    const rlf_vec3 places[2] = {{0.2, -0.1, 1.0}, {0.2, -0.1, 1.8}};
    const rlf_camera lens = projector_lens();
    const rlf_pose T_projector_depth = projector_pose();
    room *r = make_room(2.4, 1.3);
    for (int i = 0; i < 2; i++) {
        rlf_pipeline *p = make_pipeline(r, &places[i], 1);
        assert_int_equal(rlf_pipeline_set_projector(p, &lens, &T_projector_depth), RLF_OK);
        const rlf_image_rgba8 image = picture_of(p, r);
        double seen[2];
        assert_int_equal(find_light(&image, seen), i == 0);
        rlf_pipeline_destroy(&p);
    }
    free(r);
}

/* With the camera's own lens and place it is the camera's picture, without what is real. */
TEST_CASE(where_the_camera_is_the_picture_is_the_camera_s)
{
    const rlf_vec3 places[3] = {{0.0, 0.0, 1.2}, {0.3, 0.1, 1.6}, {-0.3, -0.2, 2.0}};
    room *r = make_room(2.4, 0.0);
    rlf_pipeline *camera = make_pipeline(r, places, 3), *projector = make_pipeline(r, places, 3);
    assert_int_equal(rlf_pipeline_set_projector(projector, &r->rig.color, &r->rig.T_color_depth),
                     RLF_OK);
    const rlf_image_rgba8 a = picture_of(camera, r), b = picture_of(projector, r);
    assert_int_equal(a.width, b.width);
    assert_memory_equal(a.data, b.data, 4 * WIDTH * HEIGHT);
    /* And over the camera's colours it is what the camera's view shows. */
    rlf_pipeline_output out;
    rlf_pipeline_set_view(camera, RLF_VIEW_CAMERA);
    static uint8_t alone[4 * WIDTH * HEIGHT];
    memcpy(alone, a.data, sizeof alone);
    assert_int_equal(rlf_pipeline_redraw(camera, &out), RLF_OK);
    int32_t opaque = 0;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const uint8_t *body = alone + 4 * (ptrdiff_t)i, *all = out.render.image.data + 4 * i;
        opaque += body[3] == 255;
        assert_int_equal(all[3], 255);
        assert_int_equal(body[3], out.render.matte.data[i]);
        assert_true(body[3] < 255 || abs(body[0] - all[0]) <= 6);      /* the camera's grain */
        assert_true(body[0] <= body[3] + 1 && body[2] <= body[3] + 1); /* premultiplied */
    }
    assert_true(opaque > 60);
    rlf_pipeline_destroy(&camera);
    rlf_pipeline_destroy(&projector);
    free(r);
}

TEST_CASE(a_wrong_lens_changes_nothing)
{
    room *r = make_room(2.4, 0.0);
    rlf_pipeline *p = make_pipeline(r, NULL, 0);
    rlf_camera lens = projector_lens();
    const rlf_pose T_projector_depth = projector_pose();
    lens.fx = 0.0;
    assert_int_equal(rlf_pipeline_set_projector(p, &lens, &T_projector_depth), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "fx"));
    assert_int_equal(picture_of(p, r).width, WIDTH);
    rlf_pipeline_destroy(&p);
    free(r);
}
