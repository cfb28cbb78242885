/* The view of the fused room, and what a moving camera must not smear. */

#include "render_scene.h"
#include "test.h"

#include <math.h>

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

static const uint8_t *pixel(const rlf_render_output *out, int32_t u, int32_t v)
{
    return rlf_rgba8_row(&out->image, v) + 4 * u;
}

enum { WIDTH = 240, HEIGHT = 135 };

/* A wall 2 m before a view; its left half is green, the right half has no colour, and nothing is
 * known of the lowest rows. */
typedef struct seen_wall {
    float depth[WIDTH * HEIGHT], none[WIDTH * HEIGHT], normal_z[WIDTH * HEIGHT];
    uint8_t rgba[4 * WIDTH * HEIGHT];
    rlf_prediction prediction;
    rlf_room_sight sight;
} seen_wall;

static seen_wall *see_wall(const rlf_pose *T_world_view)
{
    seen_wall *w = calloc(1, sizeof(*w));
    const rlf_rig rig = scene_rig();
    for (int32_t i = 0; i < WIDTH * (HEIGHT - 20); i++) {
        w->depth[i] = 2.0f;
        w->normal_z[i] = -1.0f;
        w->rgba[4 * i + 1] = 200;
        w->rgba[4 * i + 3] = i % WIDTH < WIDTH / 2 ? 255 : 0;
    }
    w->prediction = (rlf_prediction){.camera = rlf_camera_resize(&rig.color, WIDTH, HEIGHT),
                                     .T_world_camera = *T_world_view,
                                     .depth = w->depth,
                                     .normal_x = w->none,
                                     .normal_y = w->none,
                                     .normal_z = w->normal_z};
    w->sight = (rlf_room_sight){.prediction = &w->prediction, .rgba = w->rgba};
    return w;
}

/* The view stands 1 m to the right of the camera: bodies are where the world has them, before the
 * wall or behind it, and so is the camera's way. */
TEST_CASE(room_bodies_and_way_are_where_they_are)
{
    const rlf_pose T_world_view = {{1, 0, 0}, rlf_quat_identity()};
    const double f = 540.5, up = -108.5 * 1.5 / f; /* row 161 */
    const rlf_vec3 way[3] = {{0.4, up, 1.5}, {1.4, up, 1.5}, {1.4, up, -9.0}};
    render_scene *s = scene_make(3.0);
    seen_wall *w = see_wall(&T_world_view);
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    scene_add_body(s, scene_box(0.2), rlf_vec3_make(0.8, 0, 1.5));
    scene_add_body(s, scene_box(0.2), rlf_vec3_make(1.2, 0, 2.5));
    w->sight.path = way;
    w->sight.path_count = 3;
    s->input.room = &w->sight;
    rlf_render_output out = show(compositor, s, RLF_VIEW_MAP);
    assert_int_equal(rlf_u8_row(&out.matte, 270)[(int32_t)(479.5 - f * 0.2 / 1.5)], 255);
    assert_int_equal(rlf_u8_row(&out.matte, 270)[(int32_t)(479.5 + f * 0.2 / 2.5)], 0);
    assert_int_equal(pixel(&out, 100, 400)[1], 200);
    assert_int_equal(pixel(&out, 100, 400)[0], 0);
    assert_int_equal(pixel(&out, 800, 400)[0], 210); /* grey, square to the view */
    assert_true(pixel(&out, 800, 535)[0] < 30);      /* not seen */
    assert_true(pixel(&out, 480, 161)[0] > 230);     /* the way: orange */
    assert_true(pixel(&out, 480, 161)[2] < 80);
    rlf_compositor_destroy(&compositor);
    free(w);
    scene_free(s);
}

TEST_CASE(without_a_map_a_line_says_how_to_get_one)
{
    render_scene *s = scene_make(3.0);
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = show(compositor, s, RLF_VIEW_MAP);
    int32_t bright = 0;
    for (int32_t i = 0; i < 960 * 540; i++) {
        bright += out.image.data[4 * i] > 200;
    }
    assert_in_range(bright, 1000, 20000);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

/* All of a room that is wide and low, or high and narrow, from any side. */
TEST_CASE(look_shows_the_whole_room)
{
    static const rlf_aabb rooms[2] = {{{-3, -1.2, 0.2}, {3, 1.2, 4}}, {{-1, -4, 1}, {1, 1, 2}}};
    static const rlf_orbit orbits[3] = {{0, 0, 0}, {1.0, 0.3, 0}, {-2.5, -0.4, 1.2}};
    render_scene *s = scene_make(3.0);
    const rlf_compositor_def def = scene_def(s);
    const rlf_pose base = {{7, 7, 7}, rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.3)};
    for (int i = 0; i < 6; i++) {
        const rlf_aabb *room = &rooms[i % 2];
        rlf_camera camera;
        rlf_pose T_world_view;
        rlf_room_look(&def, room, &base, &orbits[i / 2], &camera, &T_world_view);
        assert_true(camera.width <= s->rig.depth.width && camera.height <= s->rig.depth.height);
        const rlf_pose T_view_world = rlf_pose_invert(&T_world_view);
        const rlf_vec3 middle =
            rlf_transform(&T_view_world, rlf_scale(rlf_add(room->min, room->max), 0.5));
        double u, v;
        assert_true(rlf_camera_project(&camera, middle, &u, &v));
        assert_true(fabs(u - camera.cx) < 1e-6 && fabs(v - camera.cy) < 1e-6);
        assert_true(middle.z > 0.5 * rlf_length(rlf_sub(room->max, room->min)));
    }
    scene_free(s);
}

static double matte_apart(const rlf_render_output *a, const uint8_t *b)
{
    double sum = 0.0;
    for (int32_t i = 0; i < 960 * 540; i++) {
        sum += abs(a->matte.data[i] - b[i]);
    }
    return sum / 255.0;
}

/* A strip before a body, as a camera sees it that has moved: the silhouette is that of a renderer
 * that never saw it elsewhere. One that stands still has it steady. */
TEST_CASE(silhouettes_do_not_lag_behind_a_camera)
{
    static uint8_t fresh[960 * 540];
    double apart[2];
    for (int moves = 0; moves < 2; moves++) {
        render_scene *s = scene_make(3.0);
        memset(s->color, 128, 960 * 540 * 4);
        rlf_compositor_def def = scene_def(s);
        def.occlusion = RLF_OCCLUSION_SOFT;
        rlf_compositor *old = create(&def), *other = create(&def);
        rlf_body_state *body = scene_add_body(s, scene_box(0.3), rlf_vec3_make(0, 0, 2.0));
        for (int frame = 0; frame < 4; frame++) {
            const double x = moves != 0 ? 0.02 * frame : 0.0; /* 5 pixels a frame */
            s->frame.sequence = (uint64_t)frame + 1;
            for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
                s->planes[PLANE_DEPTH][i] = 3.0f;
            }
            scene_add_strip(s, 250 - 5 * frame, 256 - 5 * frame, 1.5);
            s->input.T_world_camera.p.x = x;
            body->T_world_body.p.x = x;
            show(old, s, RLF_VIEW_CAMERA);
        }
        rlf_render_output out = show(other, s, RLF_VIEW_CAMERA);
        memcpy(fresh, out.matte.data, sizeof(fresh));
        out = show(old, s, RLF_VIEW_CAMERA);
        apart[moves] = matte_apart(&out, fresh);
        rlf_compositor_destroy(&old);
        rlf_compositor_destroy(&other);
        scene_free(s);
    }
    print_message("silhouette: %.1f pixels off, camera moved %.1f\n", apart[0], apart[1]);
    assert_true(apart[1] == 0.0);
    assert_true(apart[0] > 1.0);
}
