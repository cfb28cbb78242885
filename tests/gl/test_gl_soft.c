/* The OpenGL and the soft renderer draw the same picture, within a small tolerance. */
#include "gl_scene.h"
#include "model_sample.h"
#include "test.h"

static gl_scene scene;

/* What one comparison may differ by. */
static const double mean_limit = 3.0; /* of 255, inside the bodies */
static const double iou_limit = 0.97;

static void add_shapes(void)
{
    static const rlf_vec3 tetra[4] = {
        {0.12, 0.1, 0.1}, {-0.12, -0.1, 0.1}, {-0.12, 0.1, -0.1}, {0.12, -0.1, -0.1}};
    static const int32_t triangles[12] = {0, 1, 3, 0, 2, 1, 0, 3, 2, 1, 2, 3};
    static const rlf_hull hull = {tetra, 4, triangles, 4};
    rlf_quat q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.6, 0.8, -0.3));
    gl_scene_add(&scene, gl_scene_box(0.25, 0.2, 0.3), rlf_vec3_make(-0.4, -0.2, 1.3), q);
    rlf_shape sphere = {.type = RLF_SHAPE_SPHERE, .radius = 0.15};
    gl_scene_add(&scene, sphere, rlf_vec3_make(0.1, -0.2, 1.2), q);
    rlf_shape capsule = {.type = RLF_SHAPE_CAPSULE, .radius = 0.08, .height = 0.2};
    gl_scene_add(&scene, capsule, rlf_vec3_make(0.45, -0.1, 1.4), q);
    rlf_shape cylinder = {.type = RLF_SHAPE_CYLINDER, .radius = 0.1, .height = 0.25};
    gl_scene_add(&scene, cylinder, rlf_vec3_make(-0.3, 0.3, 1.5), q);
    rlf_shape tetrahedron = {.type = RLF_SHAPE_HULL, .hull = &hull};
    gl_scene_add(&scene, tetrahedron, rlf_vec3_make(0.2, 0.25, 1.1), q);
    gl_scene_add(&scene, gl_scene_box(0.3, 0.3, 0.3), rlf_vec3_make(0.0, 0.0, 1.6), q);
}

/* A wall with a pillar in front that hides parts of the bodies, and a floor below. */
static void add_room(void)
{
    for (int32_t y = 0; y < SCENE_HEIGHT; y++) {
        for (int32_t x = 0; x < SCENE_WIDTH; x++) {
            int32_t i = y * SCENE_WIDTH + x;
            double floor_z = scene.ray_y[i] > 0.05f ? 0.5 / (double)scene.ray_y[i] : 9.0;
            double z = x > 72 && x < 84 ? 1.22 : rlf_min(2.0, floor_z);
            scene.depth[i] = (float)z;
        }
    }
}

typedef struct difference {
    double mean, worst; /* of colour inside the bodies of either picture, 0..255 */
    double elsewhere;   /* the largest outside both */
    double iou;
    int32_t inside;
} difference;

static difference compare(const rlf_render_output *a, const rlf_render_output *b)
{
    difference d = {0, 0, 0, 0, 0};
    gl_scene_overlap overlap = {0, 0};
    for (int32_t y = 0; y < a->image.height; y++) {
        const uint8_t *p = rlf_rgba8_row(&a->image, y);
        const uint8_t *q = rlf_rgba8_row(&b->image, y);
        for (int32_t x = 0; x < a->image.width; x++) {
            int32_t alpha_a = rlf_u8_row(&a->matte, y)[x];
            int32_t alpha_b = rlf_u8_row(&b->matte, y)[x];
            double sum = 0.0;
            for (int c = 0; c < 3; c++) {
                int32_t step = p[4 * x + c] - q[4 * x + c];
                sum += step < 0 ? -step : step;
            }
            gl_scene_count(&overlap, alpha_a > 127, alpha_b > 127);
            if (alpha_a > 0 || alpha_b > 0) {
                d.inside++;
                d.mean += sum / 3.0;
                d.worst = rlf_max(d.worst, sum / 3.0);
            } else {
                d.elsewhere = rlf_max(d.elsewhere, sum / 3.0);
            }
        }
    }
    d.mean = d.inside > 0 ? d.mean / d.inside : 0.0;
    d.iou = gl_scene_iou(&overlap);
    return d;
}

/* Renders with both and compares; the soft picture and the OpenGL one. */
static difference render_both(const rlf_compositor_def *def, gl_api api, const char *name)
{
    rlf_compositor *soft = NULL;
    rlf_compositor *gl = NULL;
    rlf_render_output a, b;
    assert_int_equal(rlf_compositor_create_soft(def, &soft), RLF_OK);
    assert_int_equal(gl_compositor_create_offscreen(def, api, &gl), RLF_OK);
    assert_string_equal(rlf_compositor_name(gl), "gl");
    assert_int_equal(rlf_compositor_render(soft, &scene.input, &a), RLF_OK);
    assert_int_equal(rlf_compositor_render(gl, &scene.input, &b), RLF_OK);
    assert_int_equal(a.image.width, b.image.width);
    assert_int_equal(a.image.height, b.image.height);
    difference d = compare(&a, &b);
    print_message("%s: mean %.2f worst %.0f elsewhere %.1f IoU %.4f of %d pixels\n", name, d.mean,
                  d.worst, d.elsewhere, d.iou, (int)d.inside);
    rlf_compositor_destroy(&soft);
    rlf_compositor_destroy(&gl);
    return d;
}

/* Shadows on the room, which are worked out more coarsely by the soft renderer, may differ more. */
static void check_within(const rlf_compositor_def *def, gl_api api, const char *name,
                         double elsewhere)
{
    difference d = render_both(def, api, name);
    assert_true(d.inside > 1500);
    assert_true(d.mean <= mean_limit);
    assert_true(d.elsewhere <= elsewhere);
    assert_true(d.iou >= iou_limit);
}

static void check_alike(const rlf_compositor_def *def, gl_api api, const char *name)
{
    check_within(def, api, name, 3.0);
}

static void make_scene(void)
{
    gl_scene_init(&scene);
    add_room();
    add_shapes();
}

/* Sums over a picture that GL drew. */
typedef struct drawn_sums {
    uint64_t matte, image;
} drawn_sums;

static drawn_sums draw(const rlf_compositor_def *def)
{
    rlf_compositor *gl = NULL;
    rlf_render_output out;
    drawn_sums sums = {0, 0};
    assert_int_equal(gl_compositor_create_offscreen(def, CONTEXT_API_ANY, &gl), RLF_OK);
    assert_int_equal(rlf_compositor_render(gl, &scene.input, &out), RLF_OK);
    for (int32_t i = 0; i < out.matte.width * out.matte.height; i++) {
        sums.matte += out.matte.data[i];
    }
    for (int32_t i = 0; i < 4 * out.image.width * out.image.height; i++) {
        sums.image += out.image.data[i];
    }
    rlf_compositor_destroy(&gl);
    return sums;
}

static void set_normals(void)
{
    for (int32_t i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++) {
        const bool is_floor = scene.depth[i] < 2.0f && scene.ray_y[i] > 0.05f &&
                              scene.depth[i] * scene.ray_y[i] > 0.499f;
        scene.normal[1][i] = is_floor ? -1.0f : 0.0f;
        scene.normal[2][i] = is_floor ? 0.0f : -1.0f;
    }
    scene.surface.normal_x = scene.normal[0];
    scene.surface.normal_y = scene.normal[1];
    scene.surface.normal_z = scene.normal[2];
}

/* Every shape on the floor, and one of them at the wall: darker there, alike in both. */
static void test_real_ambient(void **state)
{
    (void)state;
    gl_scene_init(&scene);
    add_room();
    set_normals();
    const rlf_quat q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.6);
    const rlf_shape sphere = {.type = RLF_SHAPE_SPHERE, .radius = 0.1};
    const rlf_shape capsule = {.type = RLF_SHAPE_CAPSULE, .radius = 0.08, .height = 0.1};
    const rlf_shape cylinder = {.type = RLF_SHAPE_CYLINDER, .radius = 0.1, .height = 0.2};
    gl_scene_add(&scene, gl_scene_box(0.25, 0.25, 0.25), rlf_vec3_make(-0.3, 0.37, 1.4), q);
    gl_scene_add(&scene, sphere, rlf_vec3_make(0.25, 0.4, 1.4), q);
    gl_scene_add(&scene, capsule, rlf_vec3_make(0.5, 0.37, 1.7), q);
    gl_scene_add(&scene, cylinder, rlf_vec3_make(0.15, 0.4, 1.75), q);
    gl_scene_add(&scene, gl_scene_box(0.3, 0.3, 0.3), rlf_vec3_make(-0.5, 0.35, 1.82), q);
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    def.enable_real_shade = false;
    check_within(&def, CONTEXT_API_CORE_33, "real ambient, OpenGL 3.3", 12.0);
    check_within(&def, CONTEXT_API_ES_30, "real ambient, ES 3.0", 12.0);
    const uint64_t dark = draw(&def).image;
    def.enable_real_ambient = false;
    check_within(&def, CONTEXT_API_ANY, "no real ambient", 12.0);
    const uint64_t plain = draw(&def).image;
    print_message("real ambient takes %d\n", (int)(plain - dark));
    assert_true(plain > dark + 10000);
}

/* A box and the triangles of a ball that the sensor does not show hide bodies, alike in both. */
static void test_known(void **state)
{
    (void)state;
    make_scene();
    rlf_model *ball = sample_ball(0);
    rlf_quat q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.2, 0.5, 0.1));
    const rlf_shape round = {.type = RLF_SHAPE_SPHERE, .radius = 0.12};
    rlf_body_state known[2] = {
        {.shape = gl_scene_box(0.2, 0.3, 0.1), .T_world_body = {{-0.25, -0.15, 0.9}, q}},
        {.shape = round, .look = {ball, 0.12, {0, 0, 0}}, .T_world_body = {{0.12, 0.2, 0.8}, q}}};
    scene.rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    for (int i = 0; i < 2; i++) {
        rlf_compositor_def def =
            gl_scene_def(&scene, i == 0 ? RLF_OCCLUSION_DEPTH : RLF_OCCLUSION_SOFT);
        scene.snapshot.known_count = 0;
        uint64_t shown = draw(&def).matte;
        scene.snapshot.known = known;
        scene.snapshot.known_count = 2;
        assert_true(draw(&def).matte < 3 * shown / 4);
        check_alike(&def, CONTEXT_API_CORE_33, "known, OpenGL 3.3");
        check_alike(&def, CONTEXT_API_ES_30, "known, ES 3.0");
    }
    rlf_model_destroy(&ball);
}

/* Models with and without textures, near and far, drawn again from what the GPU has kept. */
static void test_models(void **state)
{
    (void)state;
    gl_scene_init(&scene);
    add_room();
    rlf_model *board = sample_ball(8);
    rlf_model *plain = sample_ball(0);
    rlf_model *worn = sample_worn_ball();
    rlf_quat q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.6, 0.8, -0.3));
    const rlf_vec3 places[5] = {
        {-0.4, -0.2, 1.3}, {0.2, -0.2, 1.0}, {0.5, 0.1, 1.9}, {-0.3, 0.3, 1.5}, {0.35, 0.25, 1.0}};
    for (int i = 0; i < 5; i++) {
        const double radius = 0.1 + 0.03 * i;
        rlf_shape ball = {.type = RLF_SHAPE_SPHERE, .radius = radius};
        rlf_body_state *body = gl_scene_add(&scene, ball, places[i], q);
        body->look =
            (rlf_look){i == 1 ? worn : (i % 2 == 0 ? board : plain), radius, {0.01, 0.02, 0}};
    }
    gl_scene_add(&scene, gl_scene_box(0.3, 0.3, 0.3), rlf_vec3_make(-0.1, 0.1, 1.7), q);
    for (int i = 0; i < 4; i++) {
        static const rlf_occlusion occlusions[4] = {RLF_OCCLUSION_DEPTH, RLF_OCCLUSION_THESIS,
                                                    RLF_OCCLUSION_OFF, RLF_OCCLUSION_SOFT};
        scene.rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
        rlf_compositor_def def = gl_scene_def(&scene, occlusions[i]);
        const double elsewhere = i % 3 == 0 ? 12.0 : 3.0; /* with and without shadows */
        check_within(&def, CONTEXT_API_CORE_33, "models, OpenGL 3.3", elsewhere);
        check_within(&def, CONTEXT_API_ES_30, "models, ES 3.0", elsewhere);
    }
    rlf_model_destroy(&board);
    rlf_model_destroy(&plain);
    rlf_model_destroy(&worn);
}

static void test_depth_occlusion(void **state)
{
    (void)state;
    make_scene();
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    check_alike(&def, CONTEXT_API_CORE_33, "depth, OpenGL 3.3");
    check_alike(&def, CONTEXT_API_ES_30, "depth, ES 3.0");
}

/* Soft edges: a sharp pillar of its own colour, where the two share the cover that both work out on
 * the CPU. */
static void test_soft_occlusion(void **state)
{
    (void)state;
    make_scene();
    scene.rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    for (int32_t i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++) {
        if (i % SCENE_WIDTH > 71 && i % SCENE_WIDTH < 85) {
            memset(&scene.color[4 * i], 20, 3);
        }
    }
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_SOFT);
    check_alike(&def, CONTEXT_API_CORE_33, "soft, OpenGL 3.3");
    check_alike(&def, CONTEXT_API_ES_30, "soft, ES 3.0");
    def.width = 240;
    def.height = 180;
    check_alike(&def, CONTEXT_API_ANY, "soft, resized");
}

/* Light from elsewhere, of another colour, in a dark room. */
static void test_light(void **state)
{
    (void)state;
    make_scene();
    for (int32_t i = 0; i < 4 * SCENE_WIDTH * SCENE_HEIGHT; i++) {
        scene.color[i] = (uint8_t)(scene.color[i] / 3);
    }
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    def.light_direction = rlf_normalize(rlf_vec3_make(-0.7, 0.4, 0.6));
    def.light_color[2] = 0.7f;
    def.estimates_light = true;
    check_alike(&def, CONTEXT_API_ANY, "light");
}

static void test_thesis_occlusion(void **state)
{
    (void)state;
    make_scene();
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_THESIS);
    check_alike(&def, CONTEXT_API_CORE_33, "thesis, OpenGL 3.3");
    check_alike(&def, CONTEXT_API_ES_30, "thesis, ES 3.0");
}

static void test_no_occlusion(void **state)
{
    (void)state;
    make_scene();
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_OFF);
    check_alike(&def, CONTEXT_API_ANY, "off");
}

/* Colour camera beside the depth camera, turned a little, of another size, and a mount pose. */
static void test_rig_and_mount(void **state)
{
    (void)state;
    make_scene();
    scene.rig.color = (rlf_camera){320, 240, 270, 272, 161, 118, RLF_DISTORTION_NONE, {0}};
    scene.rig.T_color_depth.p = rlf_vec3_make(-0.052, 0.004, 0.01);
    scene.rig.T_color_depth.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.02, -0.03, 0.01));
    scene.frame.color = (rlf_image_rgba8){scene.color, 320, 240, 4 * 320};
    scene.input.T_world_camera.p = rlf_vec3_make(0.05, 0.02, -0.1);
    scene.input.T_world_camera.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.05, 0.04, 0.0));
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    check_alike(&def, CONTEXT_API_ANY, "rig");
    def.width = 240; /* and a picture that is smaller than the camera's */
    def.height = 180;
    check_alike(&def, CONTEXT_API_ANY, "resized");
}

static void test_lens(void **state)
{
    (void)state;
    make_scene();
    const rlf_camera lens = {320,
                             240,
                             258,
                             258,
                             160,
                             127,
                             RLF_DISTORTION_PLUMB_BOB,
                             {0.262, -0.953, -0.0054, 0.0026, 1.163}};
    scene.rig.color = lens;
    scene.frame.color = (rlf_image_rgba8){scene.color, 320, 240, 4 * 320};
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    check_alike(&def, CONTEXT_API_ANY, "plumb_bob");
    scene.rig.color.distortion_model = RLF_DISTORTION_RATIONAL_POLYNOMIAL;
    const double rational[8] = {0.33, -2.49, -0.0016, -0.0013, 1.44, 0.21, -2.32, 1.37};
    memcpy(scene.rig.color.distortion, rational, sizeof(rational));
    def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    check_alike(&def, CONTEXT_API_ANY, "rational");
}

/* A coarse surface: both register the frame's own depth. */
static void test_coarse_surface(void **state)
{
    (void)state;
    static float ray_x[20 * 15], ray_y[20 * 15], depth[20 * 15];
    make_scene();
    rlf_camera grid = rlf_camera_decimate(&scene.rig.depth, 8);
    for (int32_t i = 0; i < 20 * 15; i++) {
        int32_t j = i / 20 * 8 * SCENE_WIDTH + i % 20 * 8;
        ray_x[i] = scene.ray_x[j];
        ray_y[i] = scene.ray_y[j];
        depth[i] = scene.depth[j];
    }
    scene.surface.width = 20;
    scene.surface.height = 15;
    scene.surface.scale_factor = 8;
    scene.surface.camera = grid;
    scene.surface.depth = depth;
    scene.surface.ray_x = ray_x;
    scene.surface.ray_y = ray_y;
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    def.ray_x = ray_x;
    def.ray_y = ray_y;
    check_alike(&def, CONTEXT_API_ANY, "coarse");
}

static void test_grey_without_color(void **state)
{
    (void)state;
    make_scene();
    scene.frame.color.data = NULL;
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    check_alike(&def, CONTEXT_API_ANY, "colour missing");
    scene.rig.has_color = false;
    def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    check_alike(&def, CONTEXT_API_ANY, "no colour camera");
}

/* A colour image with padded and unaligned rows. */
static void test_color_strides(void **state)
{
    (void)state;
    make_scene();
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    scene.frame.color.stride = 4 * SCENE_WIDTH + 64;
    check_alike(&def, CONTEXT_API_ANY, "padded rows");
    scene.frame.color.stride = 4 * SCENE_WIDTH + 3;
    check_alike(&def, CONTEXT_API_ANY, "unaligned rows");
}

static void test_overlay(void **state)
{
    (void)state;
    static const char *const lines[2] = {"30.0 fps  2 bodies", "paused"};
    make_scene();
    scene.snapshot.body_count = 0;
    scene.input.overlay = lines;
    scene.input.overlay_count = 2;
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    def.enable_overlay = true;
    difference d = render_both(&def, CONTEXT_API_ANY, "overlay");
    assert_true(d.elsewhere == 0.0);
    scene.input.overlay_count = 0;
    rlf_compositor *gl = NULL;
    rlf_render_output plain;
    assert_int_equal(gl_compositor_create_offscreen(&def, CONTEXT_API_ANY, &gl), RLF_OK);
    assert_int_equal(rlf_compositor_render(gl, &scene.input, &plain), RLF_OK);
    assert_memory_equal(plain.image.data, scene.color, 4 * SCENE_WIDTH * SCENE_HEIGHT);
    rlf_compositor_destroy(&gl);
}

/* Share of pixels that differ visibly. */
static double share_of_changes(const rlf_image_rgba8 *a, const rlf_image_rgba8 *b)
{
    int32_t count = 0;
    for (int32_t i = 0; i < a->width * a->height; i++) {
        int32_t sum = 0;
        for (int c = 0; c < 3; c++) {
            int32_t step = a->data[4 * i + c] - b->data[4 * i + c];
            sum += step < 0 ? -step : step;
        }
        count += sum > 24 ? 1 : 0;
    }
    return (double)count / ((double)a->width * a->height);
}

/* The wireframe lies on the same lines, bodies alone are alike; every other view is the soft
 * renderer's own. */
static void test_views(void **state)
{
    (void)state;
    make_scene();
    rlf_compositor_def def = gl_scene_def(&scene, RLF_OCCLUSION_DEPTH);
    rlf_compositor *soft = NULL;
    rlf_compositor *gl = NULL;
    rlf_render_output a, b;
    assert_int_equal(rlf_compositor_create_soft(&def, &soft), RLF_OK);
    assert_int_equal(rlf_gl_compositor_create(&def, false, &gl), RLF_OK);
    scene.input.view = RLF_VIEW_MESH;
    assert_int_equal(rlf_compositor_render(soft, &scene.input, &a), RLF_OK);
    assert_int_equal(rlf_compositor_render(gl, &scene.input, &b), RLF_OK);
    rlf_image_rgba8 bare = scene.frame.color;
    double lines = share_of_changes(&b.image, &bare);
    double changes = share_of_changes(&a.image, &b.image);
    print_message("mesh: lines %.3f of the picture, differing %.3f\n", lines, changes);
    assert_true(lines > 0.2 && lines < 0.7);
    assert_true(changes < 0.5 * lines); /* the two draw the edges of a line differently */
    scene.input.view = RLF_VIEW_BODIES;
    assert_int_equal(rlf_compositor_render(soft, &scene.input, &a), RLF_OK);
    assert_int_equal(rlf_compositor_render(gl, &scene.input, &b), RLF_OK);
    const difference alone = compare(&a, &b);
    assert_true(alone.inside > 1500 && alone.mean <= mean_limit && alone.iou >= iou_limit);
    assert_true(alone.elsewhere == 0.0);
    for (int32_t i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++) {
        assert_int_equal(b.image.data[4 * i + 3], b.matte.data[i]);
    }
    scene.input.view = RLF_VIEW_DEPTH;
    assert_int_equal(rlf_compositor_render(soft, &scene.input, &a), RLF_OK);
    assert_int_equal(rlf_compositor_render(gl, &scene.input, &b), RLF_OK);
    assert_memory_equal(a.image.data, b.image.data, 4 * SCENE_WIDTH * SCENE_HEIGHT);
    rlf_compositor_destroy(&soft);
    rlf_compositor_destroy(&gl);
}

int main(void)
{
    if (gl_scene_probe() != 0) {
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_models),
        cmocka_unit_test(test_known),
        cmocka_unit_test(test_real_ambient),
        cmocka_unit_test(test_depth_occlusion),
        cmocka_unit_test(test_soft_occlusion),
        cmocka_unit_test(test_light),
        cmocka_unit_test(test_thesis_occlusion),
        cmocka_unit_test(test_no_occlusion),
        cmocka_unit_test(test_rig_and_mount),
        cmocka_unit_test(test_lens),
        cmocka_unit_test(test_coarse_surface),
        cmocka_unit_test(test_grey_without_color),
        cmocka_unit_test(test_color_strides),
        cmocka_unit_test(test_overlay),
        cmocka_unit_test(test_views),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
