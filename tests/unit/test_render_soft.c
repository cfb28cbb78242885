/* The CPU renderer against geometry: silhouettes, what hides what, and that nothing depends on
 * threads, order or memory. */

#include "relief/compositor.h"
#include "test.h"

#include <math.h>

#include "render_scene.h"

static rlf_compositor *create(const rlf_compositor_def *def)
{
    rlf_compositor *compositor = NULL;
    assert_int_equal(rlf_compositor_create_soft(def, &compositor), RLF_OK);
    assert_string_equal(rlf_compositor_name(compositor), "soft");
    return compositor;
}

static rlf_render_output render(rlf_compositor *compositor, const render_scene *s)
{
    rlf_render_output out;
    assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
    return out;
}

/* z along the camera's axis where the ray of pixel (u, v) meets the box first; 0 = not at all. */
static double box_depth(const render_scene *s, const rlf_body_state *body, double u, double v)
{
    const rlf_camera *k = &s->rig.color;
    rlf_vec3 ray = {(u - k->cx) / k->fx, (v - k->cy) / k->fy, 1.0};
    rlf_pose T_body_world = rlf_pose_invert(&body->T_world_body);
    rlf_pose T_world_color = rlf_pose_invert(&s->rig.T_color_depth);
    rlf_pose T = rlf_pose_mul(&T_body_world, &T_world_color);
    rlf_vec3 d = rlf_rotate(T.q, ray);
    const double origin[3] = {T.p.x, T.p.y, T.p.z};
    const double step[3] = {d.x, d.y, d.z};
    const double half[3] = {body->shape.size.x / 2, body->shape.size.y / 2, body->shape.size.z / 2};
    double enter = 0.0;
    double leave = 1e9;
    for (int i = 0; i < 3; i++) {
        double a = (-half[i] - origin[i]) / step[i];
        double b = (half[i] - origin[i]) / step[i];
        enter = rlf_max(enter, rlf_min(a, b));
        leave = rlf_min(leave, rlf_max(a, b));
    }
    return enter < leave ? enter : 0.0;
}

static bool is_box_shown(const render_scene *s, const rlf_body_state *body, double limit, double u,
                         double v)
{
    double z = box_depth(s, body, u, v);
    return z > 0.0 && z < limit;
}

/* Compares the matte with a box that shows wherever it is nearer than `limit`: pixels whose whole
 * neighbourhood (1.5 px, and the renderer's four samples) shows must be opaque, those whose whole
 * neighbourhood does not, empty. */
static int32_t check_box_matte(const render_scene *s, const rlf_render_output *out, double limit)
{
    const rlf_body_state *body = &s->bodies[0];
    static const double near[13][2] = {
        {-1.5, -1.5},    {0, -1.5},       {1.5, -1.5},   {-1.5, 0},  {0, 0},
        {1.5, 0},        {-1.5, 1.5},     {0, 1.5},      {1.5, 1.5}, {-0.125, -0.375},
        {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}};
    int32_t inside = 0;
    for (int32_t v = 0; v < out->matte.height; v++) {
        const uint8_t *row = rlf_u8_row(&out->matte, v);
        for (int32_t u = 0; u < out->matte.width; u++) {
            int32_t shown = 0;
            for (int i = 0; i < 13; i++) {
                shown += is_box_shown(s, body, limit, u + near[i][0], v + near[i][1]);
            }
            inside += shown == 13;
            if (shown == 13) {
                assert_int_equal(row[u], 255);
            } else if (shown == 0) {
                assert_int_equal(row[u], 0);
            }
        }
    }
    return inside;
}

static void turn(rlf_body_state *body, double angle)
{
    body->T_world_body.q = rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(1, 2, 0.5)), angle);
}

TEST_CASE(cube_in_front_shows_whole)
{
    render_scene *s = scene_make(2.0);
    turn(scene_add_body(s, scene_box(0.3), rlf_vec3_make(0.1, -0.05, 1.2)), 0.7);
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    assert_true(check_box_matte(s, &out, 2.0) > 10000);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(cube_behind_the_wall_leaves_the_picture_alone)
{
    render_scene *s = scene_make(1.5);
    turn(scene_add_body(s, scene_box(0.3), rlf_vec3_make(0, 0, 2.2)), 0.4);
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    int32_t inside = 0;
    for (int32_t v = 0; v < 540; v++) {
        for (int32_t u = 0; u < 960; u++) {
            inside += box_depth(s, &s->bodies[0], u, v) > 0.0;
            assert_int_equal(rlf_u8_row(&out.matte, v)[u], 0);
            assert_memory_equal(rlf_rgba8_row(&out.image, v) + 4 * u, s->color + 4 * (v * 960 + u),
                                4);
        }
    }
    assert_true(inside > 3000);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(cube_half_way_in_is_cut_at_the_wall)
{
    static const rlf_occlusion modes[2] = {RLF_OCCLUSION_DEPTH, RLF_OCCLUSION_THESIS};
    for (int mode = 0; mode < 2; mode++) {
        render_scene *s = scene_make(2.0);
        turn(scene_add_body(s, scene_box(0.4), rlf_vec3_make(0.05, 0.02, 2.02)), 0.9);
        rlf_compositor_def def = scene_def(s);
        def.occlusion = modes[mode];
        rlf_compositor *compositor = create(&def);
        rlf_render_output out = render(compositor, s);
        int32_t shown = check_box_matte(s, &out, 2.0);
        def.occlusion = RLF_OCCLUSION_OFF;
        rlf_compositor *off = create(&def);
        out = render(off, s);
        int32_t whole = check_box_matte(s, &out, 1e9);
        assert_true(shown > 2000 && shown < whole * 9 / 10);
        rlf_compositor_destroy(&off);
        rlf_compositor_destroy(&compositor);
        scene_free(s);
    }
}

/* A strip between camera and cube: its edges are where the colour camera sees them. */
TEST_CASE(cube_behind_a_strip_is_hidden_by_it)
{
    render_scene *s = scene_make(3.0);
    const double z = 1.2;
    scene_add_strip(s, 240, 270, z);
    scene_add_body(s, scene_box(0.6), rlf_vec3_make(0, 0, 2.0));
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    const rlf_camera *k = &s->rig.color;
    double left = k->fx * ((239.5 - 255.5) / 365.5 - 0.052 / z) + k->cx;
    double right = k->fx * ((269.5 - 255.5) / 365.5 - 0.052 / z) + k->cx;
    const uint8_t *row = rlf_u8_row(&out.matte, 270);
    int32_t hidden = 0;
    for (int32_t u = 0; u < 960; u++) {
        bool is_cube = box_depth(s, &s->bodies[0], u - 2, 270) > 0.0 &&
                       box_depth(s, &s->bodies[0], u + 2, 270) > 0.0;
        if (is_cube && (u < left - 2 || u > right + 2)) {
            assert_int_equal(row[u], 255); /* the parallax shadow belongs to the far wall */
        } else if (u > left + 2 && u < right - 2) {
            assert_int_equal(row[u], 0);
            hidden++;
        }
    }
    assert_true(hidden > 35);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(nearer_body_wins_in_any_order)
{
    for (int mode = 0; mode < 3; mode++) {
        render_scene *s = scene_make(3.0);
        rlf_body_state *red = scene_add_body(s, scene_box(0.2), rlf_vec3_make(0, 0, 1.5));
        red->color[0] = 1.0f;
        red->color[1] = red->color[2] = 0.0f;
        rlf_body_state *blue = scene_add_body(s, scene_box(0.6), rlf_vec3_make(0, 0, 2.2));
        blue->color[2] = 1.0f;
        blue->color[0] = blue->color[1] = 0.0f;
        rlf_compositor_def def = scene_def(s);
        def.occlusion = (rlf_occlusion)mode;
        rlf_compositor *a = create(&def), *b = create(&def);
        rlf_render_output first = render(a, s);
        rlf_body_state swap = s->bodies[0];
        s->bodies[0] = s->bodies[1];
        s->bodies[1] = swap;
        rlf_render_output second = render(b, s);
        assert_memory_equal(first.image.data, second.image.data, 960 * 540 * 4);
        assert_memory_equal(first.matte.data, second.matte.data, 960 * 540);
        int32_t middle = (int32_t)(s->rig.color.cx - 540.5 * 0.052 / 1.4);
        const uint8_t *pixel = rlf_rgba8_row(&first.image, 270) + 4 * (middle + 5);
        assert_true(pixel[0] > 60 && pixel[2] < pixel[0] / 2); /* a sheen is white */
        pixel = rlf_rgba8_row(&first.image, 270) + 4 * (middle + 60);
        assert_true(pixel[2] > 60 && pixel[0] < pixel[2] / 2);
        rlf_compositor_destroy(&a);
        rlf_compositor_destroy(&b);
        scene_free(s);
    }
}

static rlf_shape shape_of(int i)
{
    const rlf_shape shapes[4] = {scene_box(0.25),
                                 {.type = RLF_SHAPE_SPHERE, .radius = 0.15},
                                 {.type = RLF_SHAPE_CAPSULE, .radius = 0.08, .height = 0.2},
                                 {.type = RLF_SHAPE_CYLINDER, .radius = 0.1, .height = 0.3}};
    return shapes[i % 4];
}

static void add_crowd(render_scene *s)
{
    for (int i = 0; i < 12; i++) {
        const rlf_vec3 p = {-0.6 + 0.12 * i, 0.25 * (i % 3) - 0.25, 1.3 + 0.17 * (i % 5)};
        turn(scene_add_body(s, shape_of(i), p), 0.3 * i);
    }
}

/* One body alone is drawn without depths of samples, two in the same columns with them. */
TEST_CASE(hidden_body_changes_nothing)
{
    const rlf_vec3 eye = {0.052, 0, 0};
    for (int i = 0; i < 32; i++) {
        const rlf_vec3 p = rlf_vec3_make(0.03 * (i - 16), 0.02 * (i % 7 - 3), 1.1 + 0.05 * i);
        render_scene *s = scene_make(5.0);
        turn(scene_add_body(s, shape_of(i), p), 0.37 * i);
        scene_add_body(s, scene_box(0.01), rlf_mad(p, rlf_sub(p, eye), 0.4));
        rlf_compositor_def def = scene_def(s);
        def.occlusion = RLF_OCCLUSION_OFF;
        rlf_compositor *a = create(&def), *b = create(&def);
        const rlf_render_output both = render(a, s);
        s->snapshot.body_count = 1;
        const rlf_render_output one = render(b, s);
        assert_non_null(memchr(one.matte.data, 255, 960 * 540));
        assert_memory_equal(both.image.data, one.image.data, 960 * 540 * 4);
        assert_memory_equal(both.matte.data, one.matte.data, 960 * 540);
        rlf_compositor_destroy(&a);
        rlf_compositor_destroy(&b);
        scene_free(s);
    }
}

TEST_CASE(threads_do_not_change_a_bit)
{
    render_scene *s = scene_make(2.0);
    scene_add_strip(s, 200, 260, 1.4);
    add_crowd(s);
    for (int mode = 0; mode < 2; mode++) {
        rlf_compositor_def def = scene_def(s);
        def.occlusion = (rlf_occlusion)mode;
        rlf_pool *pool = NULL;
        assert_int_equal(rlf_pool_create(3, &pool), RLF_OK);
        rlf_compositor *alone = create(&def);
        def.pool = pool;
        rlf_compositor *shared = create(&def);
        for (int view = 0; view < RLF_VIEW_COUNT; view++) {
            s->input.view = (rlf_view)view;
            rlf_render_output a = render(alone, s);
            rlf_render_output b = render(shared, s);
            assert_memory_equal(a.image.data, b.image.data, 960 * 540 * 4);
            assert_memory_equal(a.matte.data, b.matte.data, 960 * 540);
        }
        rlf_compositor_destroy(&alone);
        rlf_compositor_destroy(&shared);
        rlf_pool_destroy(&pool);
        s->input.view = RLF_VIEW_CAMERA;
    }
    scene_free(s);
}

TEST_CASE(thesis_layers_give_the_same_matte)
{
    render_scene *s = scene_make(2.0);
    scene_add_strip(s, 200, 300, 1.5);
    for (int i = 0; i < 6; i++) { /* apart in depth: layers cannot cut into each other */
        rlf_vec3 p = {-0.3 + 0.12 * i, 0.05 * i, 1.1 + 0.25 * i};
        turn(scene_add_body(s, scene_box(0.12), p), 0.5 * i);
    }
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *depth = create(&def);
    def.occlusion = RLF_OCCLUSION_THESIS;
    rlf_compositor *thesis = create(&def);
    rlf_render_output a = render(depth, s);
    rlf_render_output b = render(thesis, s);
    int32_t opaque = 0;
    for (int32_t i = 0; i < 960 * 540; i++) {
        assert_true(abs(a.matte.data[i] - b.matte.data[i]) <= 1);
        opaque += a.matte.data[i] == 255;
    }
    assert_true(opaque > 5000);
    rlf_compositor_destroy(&depth);
    rlf_compositor_destroy(&thesis);
    scene_free(s);
}

TEST_CASE(later_pictures_allocate_nothing)
{
    render_scene *s = scene_make(2.0);
    add_crowd(s);
    const char *const lines[2] = {"60 fps", "12 bodies"};
    s->input.overlay = lines;
    s->input.overlay_count = 2;
    rlf_compositor_def def = scene_def(s);
    def.enable_overlay = true;
    rlf_compositor *compositor = create(&def);
    render(compositor, s);
    uint64_t before = rlf_alloc_count();
    for (int view = 0; view < RLF_VIEW_COUNT; view++) {
        s->input.view = (rlf_view)view;
        render(compositor, s);
    }
    assert_int_equal(rlf_alloc_count(), before);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(ball_is_round)
{
    render_scene *s = scene_make(3.0);
    rlf_shape ball = {.type = RLF_SHAPE_SPHERE, .radius = 0.2};
    scene_add_body(s, ball, rlf_vec3_make(0.052, 0, 1.5)); /* before the colour camera */
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    /* A sphere at distance d on the axis is a disc of radius f tan(asin(r / d)). */
    double radius = 540.5 * 0.2 / sqrt(1.5 * 1.5 - 0.2 * 0.2);
    for (int32_t v = 0; v < 540; v++) {
        for (int32_t u = 0; u < 960; u++) {
            double r = sqrt((u - 479.5) * (u - 479.5) + (v - 269.5) * (v - 269.5));
            if (r < radius - 1.5) {
                assert_int_equal(rlf_u8_row(&out.matte, v)[u], 255);
            } else if (r > radius + 1.0) {
                assert_int_equal(rlf_u8_row(&out.matte, v)[u], 0);
            }
        }
    }
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(hull_of_a_cube_covers_what_the_cube_does)
{
    rlf_vec3 vertices[8];
    for (int i = 0; i < 8; i++) {
        vertices[i] =
            rlf_vec3_make(i & 1 ? 0.15 : -0.15, i & 2 ? 0.15 : -0.15, i & 4 ? 0.15 : -0.15);
    }
    static const int32_t triangles[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                          2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const rlf_hull hull = {vertices, 8, triangles, 12};
    render_scene *s = scene_make(2.0);
    rlf_body_state *body = scene_add_body(s, scene_box(0.3), rlf_vec3_make(0, 0, 1.4));
    turn(body, 0.8);
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *a = create(&def), *b = create(&def);
    rlf_render_output box = render(a, s);
    assert_true(check_box_matte(s, &box, 2.0) > 5000);
    body->shape = (rlf_shape){.type = RLF_SHAPE_HULL, .hull = &hull};
    rlf_render_output other = render(b, s);
    int32_t different = 0;
    for (int32_t i = 0; i < 960 * 540; i++) {
        different += abs(box.matte.data[i] - other.matte.data[i]) > 64;
    }
    assert_true(different == 0);
    rlf_compositor_destroy(&a);
    rlf_compositor_destroy(&b);
    scene_free(s);
}

TEST_CASE(sees_bodies_from_a_moved_camera)
{
    render_scene *s = scene_make(2.0);
    rlf_body_state *body = scene_add_body(s, scene_box(0.3), rlf_vec3_make(0.1, 0, 1.3));
    turn(body, 0.7);
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *a = create(&def), *b = create(&def);
    rlf_render_output first = render(a, s);
    rlf_pose T = {{1.0, -0.5, 2.0}, rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.6)};
    s->input.T_world_camera = T;
    body->T_world_body = rlf_pose_mul(&T, &body->T_world_body);
    rlf_render_output second = render(b, s);
    int32_t different = 0;
    for (int32_t i = 0; i < 960 * 540; i++) {
        different += abs(first.matte.data[i] - second.matte.data[i]) > 64;
    }
    assert_true(different < 10); /* rounding may move a sample across an edge */
    rlf_compositor_destroy(&a);
    rlf_compositor_destroy(&b);
    scene_free(s);
}

TEST_CASE(distorted_lens_bends_the_bodies_too)
{
    render_scene *s = scene_make(3.0);
    s->rig.color.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    s->rig.color.distortion[0] = 0.1;
    rlf_body_state *body = scene_add_body(s, scene_box(0.1), rlf_vec3_make(0.8, 0.4, 1.5));
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    double u, v;
    rlf_vec3 p = rlf_transform(&s->rig.T_color_depth, body->T_world_body.p);
    assert_true(rlf_camera_project(&s->rig.color, p, &u, &v));
    double sum = 0, sum_u = 0, sum_v = 0;
    for (int32_t y = 0; y < 540; y++) {
        for (int32_t x = 0; x < 960; x++) {
            double alpha = rlf_u8_row(&out.matte, y)[x];
            sum += alpha;
            sum_u += alpha * x;
            sum_v += alpha * y;
        }
    }
    /* Without distortion it would be 9 px away; the cube's sides shift the centroid a little. */
    assert_true(sum > 0 && fabs(sum_u / sum - u) < 2.5 && fabs(sum_v / sum - v) < 2.5);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(coarse_surface_is_cut_by_the_frame_itself)
{
    render_scene *s = scene_make(2.0);
    rlf_camera full = s->grid;
    uint16_t *depth = malloc(sizeof(*depth) * 512 * 424);
    for (int32_t i = 0; i < 512 * 424; i++) {
        depth[i] = 1500;
    }
    s->frame.depth_u16 = depth;
    s->frame.depth_stride = 1024;
    s->frame.depth_units_per_metre = 1000.0;
    s->grid = rlf_camera_decimate(&full, 8);
    scene_fill_rays(s);
    s->surface.width = s->grid.width;
    s->surface.height = s->grid.height;
    s->surface.scale_factor = 8;
    turn(scene_add_body(s, scene_box(0.4), rlf_vec3_make(0, 0, 1.5)), 0.5);
    rlf_compositor_def def = scene_def(s);
    def.occlusion = RLF_OCCLUSION_THESIS;
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    assert_true(check_box_matte(s, &out, 1.5) > 3000); /* the surface says 2.0 */
    rlf_compositor_destroy(&compositor);
    free(depth);
    scene_free(s);
}

TEST_CASE(bodies_where_no_picture_can_show_them)
{
    render_scene *s = scene_make(2.0);
    scene_add_body(s, scene_box(0.3), rlf_vec3_make(0, 0, -1.0));
    scene_add_body(s, scene_box(0.3), rlf_vec3_make(50, 0, 1.0));
    scene_add_body(s, scene_box(0.3), rlf_vec3_make(NAN, 0, 1.0));
    scene_add_body(s, scene_box(0.3), rlf_vec3_make(0, INFINITY, 1.0));
    scene_add_body(s, (rlf_shape){.type = RLF_SHAPE_HULL}, rlf_vec3_make(0, 0, 1.0));
    scene_add_body(s, scene_box(0.0), rlf_vec3_make(0, 0, 1.0));
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    for (int32_t i = 0; i < 960 * 540; i++) {
        assert_int_equal(out.matte.data[i], 0);
    }
    assert_memory_equal(out.image.data, s->color, 960 * 540 * 4);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(near_plane_cuts_cleanly)
{
    render_scene *s = scene_make(3.0);
    /* A beam from behind the camera to 2 m before it, below the eye: its top fills the lower
     * middle, down to the picture's bottom, without a hole. */
    rlf_shape beam = {.type = RLF_SHAPE_BOX, .size = {0.3, 0.1, 4.0}};
    scene_add_body(s, beam, rlf_vec3_make(0.052, 0.2, 0.0));
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    int32_t top = (int32_t)(540.5 * 0.15 / 2.0 + 269.5) + 3;
    for (int32_t v = top; v < 540; v++) {
        assert_int_equal(rlf_u8_row(&out.matte, v)[480], 255);
    }
    assert_int_equal(rlf_u8_row(&out.matte, top - 6)[480], 0);
    /* A box around the camera is seen from inside: nothing. */
    s->bodies[0].shape = scene_box(1.0);
    s->bodies[0].T_world_body.p = rlf_vec3_make(0, 0, 0);
    out = render(compositor, s);
    assert_int_equal(rlf_u8_row(&out.matte, 270)[480], 0);
    s->bodies[0].shape = scene_box(90.0);
    s->bodies[0].T_world_body.p = rlf_vec3_make(0, 0, 47.0);
    out = render(compositor, s);
    assert_int_equal(rlf_u8_row(&out.matte, 270)[480], 255);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(crowd_beyond_the_first_capacity_is_drawn)
{
    render_scene *s = scene_make(3.0);
    const int32_t count = 1200;
    rlf_body_state *crowd = calloc((size_t)count, sizeof(*crowd));
    for (int32_t i = 0; i < count; i++) {
        crowd[i].T_world_body = rlf_pose_identity();
        crowd[i].T_world_body.p =
            rlf_vec3_make(-0.8 + 0.04 * (i % 40), -0.6 + 0.04 * (i / 40.0), 1.5);
        crowd[i].shape =
            i % 2 == 0 ? scene_box(0.02) : (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.01};
        crowd[i].color[i % 3] = 1.0f;
    }
    s->snapshot.bodies = crowd;
    s->snapshot.body_count = count;
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = create(&def);
    uint64_t before = rlf_alloc_count();
    render(compositor, s);
    assert_true(rlf_alloc_count() > before);
    before = rlf_alloc_count();
    rlf_render_output out = render(compositor, s);
    assert_int_equal(rlf_alloc_count(), before);
    for (int32_t i = 0; i < count; i++) {
        double u, v;
        rlf_vec3 p = rlf_transform(&s->rig.T_color_depth, crowd[i].T_world_body.p);
        assert_true(rlf_camera_project(&s->rig.color, p, &u, &v));
        assert_int_equal(rlf_u8_row(&out.matte, (int32_t)(v + 0.5))[(int32_t)(u + 0.5)], 255);
    }
    rlf_compositor_destroy(&compositor);
    free(crowd);
    scene_free(s);
}

TEST_CASE(shadow_darkens_the_wall_beside_a_ball)
{
    render_scene *s = scene_make(2.0);
    memset(s->color, 200, 960 * 540 * 4);
    rlf_shape ball = {.type = RLF_SHAPE_SPHERE, .radius = 0.1};
    scene_add_body(s, ball, rlf_vec3_make(0.0, 0, 1.9)); /* touches the wall */
    rlf_compositor_def def = scene_def(s);
    def.light_direction = rlf_normalize(rlf_vec3_make(1, 0, 1));
    rlf_compositor *compositor = create(&def);
    rlf_render_output out = render(compositor, s);
    int32_t middle = (int32_t)(479.5 - 540.5 * 0.052 / 1.9);
    const uint8_t *row = rlf_rgba8_row(&out.image, 270);
    int32_t right = row[4 * (middle + 36)]; /* the light comes from the left */
    int32_t left = row[4 * (middle - 36)];
    assert_int_equal(rlf_u8_row(&out.matte, 270)[middle + 36], 0);
    assert_int_equal(rlf_u8_row(&out.matte, 270)[middle - 36], 0);
    assert_true(right < left && left < 200);
    assert_int_equal(row[4 * (middle + 200)], 200);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}
