/* Bodies in front of, behind and half through real surfaces, against masks from ray casting, for
 * OpenGL and ES, with both ways of occlusion. */
#include "gl_scene.h"
#include "test.h"

static gl_scene scene;

typedef struct setting {
    gl_api api;
    rlf_occlusion occlusion;
} setting;

static const setting settings[4] = {{CONTEXT_API_CORE_33, RLF_OCCLUSION_DEPTH},
                                    {CONTEXT_API_CORE_33, RLF_OCCLUSION_THESIS},
                                    {CONTEXT_API_ES_30, RLF_OCCLUSION_DEPTH},
                                    {CONTEXT_API_ES_30, RLF_OCCLUSION_THESIS}};

/* A compositor, or NULL with a notice when this machine lacks that API. */
static rlf_compositor *open_compositor(const setting *s)
{
    rlf_compositor_def def = gl_scene_def(&scene, s->occlusion);
    rlf_compositor *compositor = NULL;
    if (gl_compositor_create_offscreen(&def, s->api, &compositor) != RLF_OK) {
        print_message("SKIPPED one setting: %s\n", rlf_error_text());
    }
    return compositor;
}

static rlf_render_output render(rlf_compositor *compositor)
{
    rlf_render_output out;
    assert_int_equal(rlf_compositor_render(compositor, &scene.input, &out), RLF_OK);
    assert_int_equal(out.image.width, SCENE_WIDTH);
    assert_int_equal(out.matte.height, SCENE_HEIGHT);
    return out;
}

/* z of the nearest box on a pixel's ray; 1e9 when there is none. */
static double nearest_z(int32_t i)
{
    double nearest = 1e9;
    for (int32_t b = 0; b < scene.snapshot.body_count; b++) {
        rlf_vec3 ray = {(double)scene.ray_x[i], (double)scene.ray_y[i], 1.0};
        double z = gl_scene_ray_box(&scene.bodies[b], ray);
        nearest = z > 0.0 ? rlf_min(nearest, z) : nearest;
    }
    return nearest;
}

/* Real depth as a bound on z: what is unknown hides nothing. */
static double real_z(int32_t i)
{
    return scene.depth[i] > 0.0f ? (double)scene.depth[i] : 1e8;
}

/* The mask that rays say: the nearest box is in front of the real depth. */
static bool is_seen(int32_t i)
{
    return nearest_z(i) < real_z(i);
}

/* What alpha must be where no edge is near: all boxes around in front of all that is real around,
 * or all behind. -1 where an edge is. */
static int32_t expected_alpha(int32_t i)
{
    double box[2] = {1e9, 0.0};
    double real[2] = {1e9, 0.0};
    for (int32_t k = 0; k < 9; k++) {
        int32_t j = i + (k / 3 - 1) * SCENE_WIDTH + k % 3 - 1;
        box[0] = rlf_min(box[0], nearest_z(j));
        box[1] = rlf_max(box[1], nearest_z(j));
        real[0] = rlf_min(real[0], real_z(j));
        real[1] = rlf_max(real[1], real_z(j));
    }
    return box[1] < real[0] ? 255 : (box[0] > real[1] ? 0 : -1);
}

/* IoU with the rays' mask; away from edges alpha must be exact. */
static double compare_with_rays(const rlf_plane_u8 *matte)
{
    gl_scene_overlap overlap = {0, 0};
    for (int32_t y = 0; y < SCENE_HEIGHT; y++) {
        for (int32_t x = 0; x < SCENE_WIDTH; x++) {
            int32_t i = y * SCENE_WIDTH + x;
            uint8_t alpha = rlf_u8_row(matte, y)[x];
            gl_scene_count(&overlap, is_seen(i), alpha > 127);
            bool is_inside = x > 0 && y > 0 && x < SCENE_WIDTH - 1 && y < SCENE_HEIGHT - 1;
            int32_t expected = is_inside ? expected_alpha(i) : -1;
            if (expected >= 0) {
                assert_int_equal(alpha, expected);
            }
        }
    }
    return gl_scene_iou(&overlap);
}

static int32_t count_seen(void)
{
    int32_t count = 0;
    for (int32_t i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++) {
        count += is_seen(i);
    }
    return count;
}

/* Renders the scene with every setting and checks the matte. */
static void check_scene(const char *name, int32_t seen_min, int32_t seen_max)
{
    int32_t seen = count_seen();
    assert_in_range(seen, seen_min, seen_max); /* the scene shows what its test is about */
    for (int i = 0; i < 4; i++) {
        rlf_compositor *compositor = open_compositor(&settings[i]);
        if (compositor == NULL) {
            continue;
        }
        rlf_render_output out = render(compositor);
        double iou = compare_with_rays(&out.matte);
        print_message("%s, %s, %s: IoU %.4f\n", name,
                      settings[i].api == CONTEXT_API_ES_30 ? "ES 3.0" : "OpenGL 3.3",
                      settings[i].occlusion == RLF_OCCLUSION_THESIS ? "thesis" : "depth", iou);
        assert_true(iou >= 0.97);
        rlf_compositor_destroy(&compositor);
    }
}

static rlf_quat tilted(void)
{
    return rlf_quat_from_rotation_vector(rlf_vec3_make(0.5, 0.7, 0.2));
}

static void test_in_front(void **state)
{
    (void)state;
    gl_scene_init(&scene);
    gl_scene_add(&scene, gl_scene_box(0.3, 0.3, 0.3), rlf_vec3_make(0.1, -0.05, 1.2), tilted());
    check_scene("in front", 1000, 3000);
}

static void test_behind(void **state)
{
    (void)state;
    gl_scene_init(&scene);
    gl_scene_add(&scene, gl_scene_box(0.3, 0.3, 0.3), rlf_vec3_make(0.1, -0.05, 2.4), tilted());
    check_scene("behind", 0, 0);
}

static void test_half_through(void **state)
{
    (void)state;
    gl_scene_init(&scene);
    for (int32_t i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++) {
        scene.depth[i] = 1.16f; /* a wall that the box sticks through */
    }
    gl_scene_add(&scene, gl_scene_box(0.4, 0.4, 0.4), rlf_vec3_make(-0.1, 0.0, 1.2), tilted());
    check_scene("half through", 500, 4500);
}

static void test_missing_depth_hides_nothing(void **state)
{
    (void)state;
    gl_scene_init(&scene);
    memset(scene.depth, 0, sizeof(scene.depth));
    gl_scene_add(&scene, gl_scene_box(0.3, 0.3, 0.3), rlf_vec3_make(0.0, 0.0, 3.0), tilted());
    check_scene("no depth", 200, 600);
}

/* Two boxes one behind the other, a real pillar at 0.9 m, and a real board between them. */
static void make_two_boxes(void)
{
    gl_scene_init(&scene);
    for (int32_t i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++) {
        int32_t x = i % SCENE_WIDTH;
        scene.depth[i] = x < 70 ? 0.9f : (x < 90 ? 1.5f : 3.0f);
    }
    gl_scene_add(&scene, gl_scene_box(0.9, 0.5, 0.3), rlf_vec3_make(0.1, 0.1, 2.2), tilted());
    gl_scene_add(&scene, gl_scene_box(0.2, 0.2, 0.2), rlf_vec3_make(0.03, 0.0, 1.2), tilted());
}

static void test_several_bodies(void **state)
{
    (void)state;
    make_two_boxes();
    check_scene("two boxes", 1500, 8000);
    /* In either order in the snapshot. */
    rlf_body_state first = scene.bodies[0];
    scene.bodies[0] = scene.bodies[1];
    scene.bodies[1] = first;
    check_scene("two boxes swapped", 1500, 8000);
}

/* Where both boxes are on the ray, the near one's colour must show. */
static void test_nearest_color_wins(void **state)
{
    (void)state;
    make_two_boxes();
    rlf_vec3 ray = {(double)scene.ray_x[60 * SCENE_WIDTH + 92],
                    (double)scene.ray_y[60 * SCENE_WIDTH + 92], 1.0};
    assert_true(gl_scene_ray_box(&scene.bodies[0], ray) > 1.7);
    assert_true(gl_scene_ray_box(&scene.bodies[1], ray) > 0.5);
    for (int i = 0; i < 4; i++) {
        rlf_compositor *compositor = open_compositor(&settings[i]);
        if (compositor != NULL) {
            rlf_render_output out = render(compositor);
            const uint8_t *pixel = rlf_rgba8_row(&out.image, 60) + 4 * 92;
            assert_true(pixel[1] > pixel[0] && pixel[1] > pixel[2]); /* the second box is green */
            assert_int_equal(pixel[3], 255);
            rlf_compositor_destroy(&compositor);
        }
    }
}

static void test_off_hides_nothing(void **state)
{
    (void)state;
    const setting off = {CONTEXT_API_ANY, RLF_OCCLUSION_OFF};
    make_two_boxes();
    rlf_compositor *compositor = open_compositor(&off);
    rlf_render_output out = render(compositor);
    memset(scene.depth, 0, sizeof(scene.depth)); /* for the rays: nothing is in front */
    assert_true(compare_with_rays(&out.matte) >= 0.98);
    rlf_compositor_destroy(&compositor);
}

static void test_picture_without_bodies_is_the_camera_image(void **state)
{
    (void)state;
    gl_scene_init(&scene);
    for (int i = 0; i < 4; i++) {
        rlf_compositor *compositor = open_compositor(&settings[i]);
        if (compositor != NULL) {
            rlf_render_output out = render(compositor);
            assert_memory_equal(out.image.data, scene.color, 4 * SCENE_WIDTH * SCENE_HEIGHT);
            assert_int_equal(out.matte.data[0], 0);
            rlf_compositor_destroy(&compositor);
        }
    }
}

/* Each has its own context; ending one leaves the other whole. */
static void test_two_compositors_at_once(void **state)
{
    (void)state;
    make_two_boxes();
    rlf_compositor *first = open_compositor(&settings[0]);
    rlf_compositor *second = open_compositor(&settings[0]);
    (void)render(first);
    rlf_compositor_destroy(&first);
    rlf_render_output out = render(second);
    assert_true(compare_with_rays(&out.matte) >= 0.98);
    rlf_compositor_destroy(&second);
}

static void test_frames_allocate_nothing(void **state)
{
    (void)state;
    make_two_boxes();
    for (int i = 0; i < 2; i++) {
        rlf_compositor *compositor = open_compositor(&settings[i]);
        scene.input.view = RLF_VIEW_MESH;
        (void)render(compositor);
        scene.input.view = RLF_VIEW_CAMERA;
        (void)render(compositor);
        uint64_t before = rlf_alloc_count();
        for (int k = 0; k < 3; k++) {
            scene.input.view = k == 1 ? RLF_VIEW_MESH : RLF_VIEW_CAMERA;
            (void)render(compositor);
        }
        assert_int_equal(rlf_alloc_count(), before);
        rlf_compositor_destroy(&compositor);
    }
}

static void test_bad_sizes(void **state)
{
    (void)state;
    rlf_compositor *compositor = NULL;
    gl_scene_init(&scene);
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    def.width = 20000;
    assert_int_equal(rlf_gl_compositor_create(&def, false, &compositor), RLF_ERROR_INVALID);
    assert_null(compositor);
    compositor = open_compositor(&settings[0]);
    scene.surface.width = 80;
    rlf_render_output out;
    assert_int_equal(rlf_compositor_render(compositor, &scene.input, &out), RLF_ERROR_INVALID);
    rlf_compositor_destroy(&compositor);
    /* No window's context is current in this thread. */
    gl_scene_init(&scene);
    def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    assert_int_equal(rlf_gl_compositor_create(&def, true, &compositor), RLF_ERROR_DEVICE);
    assert_null(compositor);
}

int main(void)
{
    if (gl_scene_probe() != 0) {
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_in_front),
        cmocka_unit_test(test_behind),
        cmocka_unit_test(test_half_through),
        cmocka_unit_test(test_missing_depth_hides_nothing),
        cmocka_unit_test(test_several_bodies),
        cmocka_unit_test(test_nearest_color_wins),
        cmocka_unit_test(test_off_hides_nothing),
        cmocka_unit_test(test_picture_without_bodies_is_the_camera_image),
        cmocka_unit_test(test_two_compositors_at_once),
        cmocka_unit_test(test_frames_allocate_nothing),
        cmocka_unit_test(test_bad_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
