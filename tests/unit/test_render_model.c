/* Models: what they are made of, and how the CPU renderer draws them. */
#include "model_sample.h"
#include "render/probe.h"
#include "render_scene.h"
#include "test.h"

#define GOLDEN_HASH 0xd293762f84e4fcb4u

static rlf_render_output draw(render_scene *s, rlf_compositor *compositor)
{
    rlf_render_output out;
    s->frame.sequence++;
    assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
    return out;
}

static rlf_compositor *make(const render_scene *s, rlf_occlusion occlusion, rlf_pool *pool)
{
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = NULL;
    def.occlusion = occlusion;
    def.pool = pool;
    assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
    return compositor;
}

static rlf_body_state *add_model(render_scene *s, const rlf_model *model, double scale, rlf_vec3 p)
{
    rlf_shape ball = {.type = RLF_SHAPE_SPHERE, .radius = scale};
    rlf_body_state *body = scene_add_body(s, ball, p);
    body->look = (rlf_look){model, scale, {0, 0, 0}};
    body->color[0] = body->color[1] = body->color[2] = 1.0f;
    return body;
}

/* A square of side 2 in its xy plane that faces -z, red as u and green as v, matt. */
static rlf_model *make_ramp(void)
{
    static uint8_t pixels[4 * 256 * 256];
    static const int32_t triangles[6] = {0, 3, 2, 0, 2, 1};
    rlf_model_vertex v[4];
    for (int i = 0; i < 4; i++) {
        float x = i == 1 || i == 2 ? 1.0f : -1.0f;
        float y = i >= 2 ? 1.0f : -1.0f;
        v[i] = (rlf_model_vertex){{x, y, 0}, {0, 0, -1}, {0.5f * x + 0.5f, 0.5f * y + 0.5f}};
    }
    for (int i = 0; i < 256 * 256; i++) {
        const uint8_t color[4] = {(uint8_t)(i % 256), (uint8_t)(i / 256), 128, 255};
        memcpy(pixels + 4 * i, color, 4);
    }
    const rlf_image_rgba8 image = {pixels, 256, 256, 1024};
    rlf_model_def def = rlf_model_def_default();
    def.vertices = v;
    def.vertex_count = 4;
    def.triangles = triangles;
    def.triangle_count = 2;
    def.images = &image;
    def.image_count = 1;
    rlf_model *model = NULL;
    assert_int_equal(rlf_model_create(&def, &model), RLF_OK);
    return model;
}

/* Code of a channel of the ramp's pixel, whose blue is 128 and became `blue`: codes are the square
 * roots of light, and a sheen is the same in all channels. */
static double code_beside(double share, double code, double blue)
{
    return sqrt(rlf_max(0.0, share * (code * code - 128.0 * 128.0) + blue * blue));
}

/* What u and v are where a pixel's ray meets the tilted square: linear in the square, not in the
 * picture. */
TEST_CASE(texture_is_right_in_perspective)
{
    render_scene *s = scene_make(4.0);
    rlf_model *model = make_ramp();
    rlf_body_state *body = add_model(s, model, 0.4, rlf_vec3_make(0.05, 0.02, 1.0));
    body->T_world_body.q = rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(0.3, 1, 0.1)), 0.9);
    rlf_compositor *compositor = make(s, RLF_OCCLUSION_OFF, NULL);
    rlf_render_output out = draw(s, compositor);
    rlf_pose T = rlf_pose_mul(&s->rig.T_color_depth, &body->T_world_body);
    rlf_vec3 light = rlf_neg(scene_def(s).light_direction);
    rlf_vec3 n = rlf_rotate(T.q, rlf_vec3_make(0, 0, -1));
    const double share = PROBE_AMBIENT + PROBE_DIRECT * rlf_max(0.0, rlf_dot(n, light));
    int checked = 0;
    for (int32_t y = 0; y < out.image.height; y++) {
        for (int32_t x = 0; x < out.image.width; x++) {
            rlf_vec3 ray;
            assert_true(rlf_camera_unproject(&s->rig.color, x, y, &ray));
            rlf_vec3 at = rlf_scale(ray, rlf_dot(n, T.p) / rlf_dot(n, ray));
            rlf_vec3 p = rlf_transform_inverse(&T, at);
            double u = 0.5 * p.x / 0.4 + 0.5;
            double v = 0.5 * p.y / 0.4 + 0.5;
            if (u < 0.03 || u > 0.97 || v < 0.03 || v > 0.97) {
                continue;
            }
            const uint8_t *pixel = rlf_rgba8_row(&out.image, y) + 4 * (ptrdiff_t)x;
            const double red = code_beside(share, 256.0 * u - 0.5, pixel[2]);
            const double green = code_beside(share, 256.0 * v - 0.5, pixel[2]);
            assert_true(pixel[0] - red < 2.5 && red - pixel[0] < 2.5);
            assert_true(pixel[1] - green < 2.5 && green - pixel[1] < 2.5);
            assert_int_equal(rlf_u8_row(&out.matte, y)[x], 255);
            checked++;
        }
    }
    assert_true(checked > 20000);
    rlf_compositor_destroy(&compositor);
    rlf_model_destroy(&model);
    scene_free(s);
}

/* A board of squares far smaller than a pixel is grey, and stays so while it moves. */
TEST_CASE(far_textures_do_not_shimmer)
{
    render_scene *s = scene_make(4.0);
    rlf_model *model = sample_ball(64);
    rlf_body_state *body = add_model(s, model, 0.05, rlf_vec3_make(0, 0, 3.0));
    rlf_compositor *compositor = make(s, RLF_OCCLUSION_OFF, NULL);
    double last = 0.0;
    double worst = 0.0;
    for (int step = 0; step < 40; step++) {
        body->T_world_body.p.x = 0.052 + 0.0003 * step; /* 0.05 pixels */
        rlf_render_output out = draw(s, compositor);
        const uint8_t *pixel = rlf_rgba8_row(&out.image, 269) + 4 * (ptrdiff_t)480;
        double change = step > 0 ? pixel[0] - last : 0.0;
        worst = rlf_max(worst, change < 0.0 ? -change : change);
        last = pixel[0];
    }
    print_message("largest change of a pixel in a step: %.0f of 255\n", worst);
    assert_true(worst <= 4.0);
    rlf_compositor_destroy(&compositor);
    rlf_model_destroy(&model);
    scene_free(s);
}

/* Its colours times the body's, its outline that of a ball, smooth from face to face. */
TEST_CASE(a_ball_looks_like_a_ball)
{
    render_scene *s = scene_make(3.0);
    rlf_model *model = sample_ball(0);
    rlf_body_state *body = add_model(s, model, 0.3, rlf_vec3_make(0.052, 0, 1.5));
    body->color[0] = 0.5f;
    rlf_compositor *compositor = make(s, RLF_OCCLUSION_DEPTH, NULL);
    rlf_render_output out = draw(s, compositor);
    const double radius = 540.5 * 0.3 / sqrt(1.5 * 1.5 - 0.3 * 0.3);
    int32_t covered = 0;
    for (int32_t i = 0; i < out.matte.width * out.matte.height; i++) {
        covered += out.matte.data[i] > 127 ? 1 : 0;
    }
    double share = covered / (RLF_PI * radius * radius);
    print_message("outline: %.3f of the ball's\n", share);
    assert_true(share > 0.96 && share < 1.01);
    int32_t most = 0;
    for (int32_t x = 420; x < 540; x++) {
        const uint8_t *p = rlf_rgba8_row(&out.image, 270) + 4 * (ptrdiff_t)x;
        int32_t step = p[1] - p[5];
        most = step * step > most ? step * step : most;
        assert_true(p[0] * 1.6 < p[1] + 4.0 && p[0] * 1.6 > p[1] - 4.0); /* 0.5 x 1 to 0.8 */
    }
    assert_true(most <= 9);
    rlf_compositor_destroy(&compositor);
    rlf_model_destroy(&model);
    scene_free(s);
}

/* Cut by the near plane, around the camera, behind it, and far larger than its shape. */
TEST_CASE(any_place_is_drawn)
{
    static const double z[6] = {0.0, 0.05, 0.31, -1.0, 1.5, 50.0};
    render_scene *s = scene_make(3.0);
    rlf_model *model = sample_ball(8);
    rlf_body_state *body = add_model(s, model, 0.3, rlf_vec3_make(0, 0, 1));
    rlf_compositor *compositor = make(s, RLF_OCCLUSION_SOFT, NULL);
    for (int i = 0; i < 6; i++) {
        body->T_world_body.p = rlf_vec3_make(0.1, 0.05, z[i]);
        draw(s, compositor);
        body->look.scale = 3.0;
        draw(s, compositor);
        body->look.scale = 0.3;
    }
    rlf_compositor_destroy(&compositor);
    rlf_model_destroy(&model);
    scene_free(s);
}

static uint64_t hash_image(const rlf_render_output *out)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (int32_t i = 0; i < 4 * out->image.width * out->image.height; i++) {
        hash = (hash ^ out->image.data[i]) * 0x100000001b3u;
    }
    return hash;
}

/* The same bits with any number of workers, compiler and machine; nothing allocated later on. */
/* A square that faces -z, u along x and v along y, with its vertices' normals; of one texture that
 * is the same all over, which is that of metal and roughness, or of normals. */
static rlf_model *make_square(rlf_model_part part, rlf_vec3 normal, const uint8_t texel[4])
{
    static const int32_t triangles[6] = {0, 3, 2, 0, 2, 1};
    const rlf_image_rgba8 image = {(uint8_t *)(uintptr_t)texel, 1, 1, 4};
    rlf_model_vertex v[4];
    for (int i = 0; i < 4; i++) {
        const float x = i == 1 || i == 2 ? 1.0f : -1.0f;
        const float y = i >= 2 ? 1.0f : -1.0f;
        v[i] = (rlf_model_vertex){{x, y, 0},
                                  {(float)normal.x, (float)normal.y, (float)normal.z},
                                  {0.5f * x + 0.5f, 0.5f * y + 0.5f}};
    }
    part.triangle_count = 2;
    part.texture = -1;
    part.color[0] = part.color[1] = part.color[2] = 0.7f;
    rlf_model_def def = rlf_model_def_default();
    def.vertices = v;
    def.vertex_count = 4;
    def.triangles = triangles;
    def.triangle_count = 2;
    def.parts = &part;
    def.part_count = 1;
    def.images = &image;
    def.image_count = 1;
    rlf_model *model = NULL;
    assert_int_equal(rlf_model_create(&def, &model), RLF_OK);
    return model;
}

/* What a texture says in every texel is what the part or its vertices say. */
TEST_CASE(surfaces_are_as_their_textures)
{
    static const uint8_t worn[4] = {0, 102, 204, 255}; /* roughness 0.4, metal 0.8 */
    static const uint8_t bent[4] = {191, 64, 218, 255};
    const rlf_vec3 flat = {0, 0, -1};
    const rlf_vec3 turned = rlf_normalize(rlf_vec3_make(191 - 127.5, 127.5 - 64, 127.5 - 218));
    rlf_model *models[4] = {
        make_square((rlf_model_part){.metallic = 1.0f, .surface_texture = 1}, flat, worn),
        make_square((rlf_model_part){.metallic = 0.8f, .gloss = 0.6f}, flat, worn),
        make_square((rlf_model_part){.gloss = 0.7f, .normal_texture = 1}, flat, bent),
        make_square((rlf_model_part){.gloss = 0.7f}, turned, bent)};
    render_scene *s = scene_make(4.0);
    rlf_body_state *body = add_model(s, models[0], 0.4, rlf_vec3_make(0.05, 0.02, 1.0));
    body->T_world_body.q = rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(0.3, 1, 0.1)), 0.4);
    const int32_t size = 4 * s->rig.color.width * s->rig.color.height;
    uint8_t *first = malloc((size_t)size);
    assert_non_null(first);
    for (int i = 0; i < 4; i++) {
        body->look.model = models[i];
        rlf_compositor *compositor = make(s, RLF_OCCLUSION_OFF, NULL);
        const rlf_render_output out = draw(s, compositor);
        for (int32_t k = 0; k < size && i % 2 == 1; k++) {
            const int off = out.image.data[k] - first[k];
            assert_true(off >= -1 && off <= 1);
        }
        memcpy(first, out.image.data, (size_t)size);
        rlf_compositor_destroy(&compositor);
    }
    free(first);
    for (int i = 0; i < 4; i++) {
        rlf_model_destroy(&models[i]);
    }
    scene_free(s);
}

TEST_CASE(the_picture_is_exact)
{
    render_scene *s = scene_make(2.0);
    rlf_model *ball = sample_ball(8);
    rlf_model *ramp = make_ramp();
    add_model(s, ball, 0.2, rlf_vec3_make(-0.3, 0.1, 1.4))->T_world_body.q =
        rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(1, 2, 3)), 0.7);
    add_model(s, ramp, 0.3, rlf_vec3_make(0.3, -0.1, 1.9))->T_world_body.q =
        rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.5);
    scene_add_body(s, scene_box(0.2), rlf_vec3_make(0, 0.2, 1.3));
    for (int workers = 1; workers <= 3; workers += 2) {
        rlf_pool *pool = NULL;
        assert_int_equal(rlf_pool_create(workers, &pool), RLF_OK);
        rlf_compositor *compositor = make(s, RLF_OCCLUSION_SOFT, pool);
        draw(s, compositor);
        uint64_t before = rlf_alloc_count();
        rlf_render_output out = draw(s, compositor);
        assert_true(rlf_alloc_count() == before);
        uint64_t hash = hash_image(&out);
        if (hash != GOLDEN_HASH) {
            fail_msg("picture 0x%016llx with %d workers", (unsigned long long)hash, workers);
        }
        rlf_compositor_destroy(&compositor);
        rlf_pool_destroy(&pool);
    }
    rlf_model_destroy(&ball);
    rlf_model_destroy(&ramp);
    scene_free(s);
}

/* ---- what a model may be -------------------------------------------------------------------- */

static rlf_model_vertex corners[3] = {
    {{0, 0, 0}, {0, 0, 0}, {0, 0}}, {{0, 2, 0}, {0, 0, 0}, {0, 1}}, {{1, 0, 0}, {0, 0, 0}, {1, 0}}};
static int32_t triangle[3] = {0, 1, 2};

static rlf_model_def triangle_def(void)
{
    rlf_model_def def = rlf_model_def_default();
    def.vertices = corners;
    def.vertex_count = 3;
    def.triangles = triangle;
    def.triangle_count = 1;
    return def;
}

TEST_CASE(missing_normals_are_made)
{
    rlf_model_def def = triangle_def();
    rlf_model *model = NULL;
    assert_int_equal(rlf_model_create(&def, &model), RLF_OK);
    assert_true(model->vertices[1].normal[2] == -1.0f);
    assert_true(model->radius == 2.0 && model->box.max.x == 1.0);
    assert_int_equal(model->part_count, 1);
    rlf_model_destroy(&model);
    rlf_model_destroy(&model);
    rlf_model_destroy(NULL);
}

static void expect_refused(const rlf_model_def *def, const char *piece)
{
    rlf_model *model = NULL;
    assert_int_equal(rlf_model_create(def, &model), RLF_ERROR_INVALID);
    assert_null(model);
    if (strstr(rlf_error_text(), piece) == NULL) {
        fail_msg("\"%s\" does not mention \"%s\"", rlf_error_text(), piece);
    }
}

TEST_CASE(bad_models_are_refused)
{
    rlf_model_def def = triangle_def();
    def.triangle_count = 0;
    expect_refused(&def, "no triangles");
    def.triangle_count = 10000000;
    expect_refused(&def, "10000000 triangles, at most 200000");
    def = triangle_def();
    triangle[2] = 3;
    expect_refused(&def, "vertex 3 of 3");
    triangle[2] = 2;
    corners[1].position[0] = (float)NAN;
    expect_refused(&def, "position of vertex 1");
    corners[1].position[0] = 0.0f;
    corners[2].uv[1] = INFINITY;
    expect_refused(&def, "texture coordinate of vertex 2");
    corners[2].uv[1] = 0.0f;
    rlf_model_part part = {.triangle_count = 1, .color = {1, 1, 1}};
    def.parts = &part;
    def.part_count = 1;
    expect_refused(&def, "part 0");
    part = (rlf_model_part){.triangle_count = 2, .color = {1, 1, 1}, .texture = -1};
    expect_refused(&def, "part 0");
    uint8_t texel[4] = {0};
    const rlf_image_rgba8 image = {texel, 9000, 1, 4};
    def = triangle_def();
    def.images = &image;
    def.image_count = 1;
    expect_refused(&def, "9000 x 1");
}
