/* The unit meshes are closed, face outwards and enclose the volume of their shapes; the textures'
 * levels are means. */
#include "render/body_texture.h"
#include "render/shape_mesh.h"
#include "test.h"

static rlf_vec3 body_point(const shape_vertex *v, const shape_mesh_scale *s)
{
    return rlf_vec3_make(s->scale.x * (double)v->position[0],
                         s->scale.y * (double)v->position[1] + s->half_height * (double)v->shift,
                         s->scale.z * (double)v->position[2]);
}

static const rlf_shape shapes[4] = {
    {RLF_SHAPE_BOX, {0.2, 0.3, 0.5}, 0, 0, NULL},
    {RLF_SHAPE_SPHERE, {0, 0, 0}, 0.25, 0, NULL},
    {RLF_SHAPE_CAPSULE, {0, 0, 0}, 0.1, 0.4, NULL},
    {RLF_SHAPE_CYLINDER, {0, 0, 0}, 0.15, 0.6, NULL},
};

static shape_mesh_set mesh;

static rlf_vec3 corner(const shape_mesh_range *range, int32_t i, const shape_mesh_scale *s)
{
    return body_point(&mesh.vertices[mesh.indices[range->first_index + i]], s);
}

TEST_CASE(test_volumes)
{
    const double r = 0.1;
    const double expected[4] = {0.2 * 0.3 * 0.5, 4.0 / 3.0 * RLF_PI * 0.25 * 0.25 * 0.25,
                                4.0 / 3.0 * RLF_PI * r * r * r + RLF_PI * r * r * 0.4,
                                RLF_PI * 0.15 * 0.15 * 0.6};
    for (int t = 0; t < 4; t++) {
        const shape_mesh_range *range = &mesh.range[t];
        shape_mesh_scale s = shape_mesh_scale_of(&shapes[t]);
        double volume = 0.0;
        for (int32_t i = 0; i < range->index_count; i += 3) {
            rlf_vec3 a = corner(range, i, &s);
            rlf_vec3 b = corner(range, i + 1, &s);
            rlf_vec3 c = corner(range, i + 2, &s);
            double signed_volume = rlf_dot(a, rlf_cross(b, c)) / 6.0;
            assert_true(signed_volume > 0.0); /* convex round the origin: all face outwards */
            volume += signed_volume;
        }
        /* Inscribed in the round shapes: less, by at most 2.5 %. */
        assert_true(volume <= expected[t] * (1.0 + 1e-6));
        assert_true(volume >= expected[t] * (t == 0 ? 1.0 - 1e-6 : 0.975));
    }
}

static bool is_same(rlf_vec3 a, rlf_vec3 b)
{
    rlf_vec3 d = rlf_sub(a, b);
    return rlf_dot(d, d) < 1e-14;
}

TEST_CASE(test_closed)
{
    for (int t = 0; t < 4; t++) {
        const shape_mesh_range *range = &mesh.range[t];
        shape_mesh_scale s = shape_mesh_scale_of(&shapes[t]);
        for (int32_t i = 0; i < range->index_count; i++) {
            rlf_vec3 a = corner(range, i, &s);
            rlf_vec3 b = corner(range, i - i % 3 + (i + 1) % 3, &s);
            int32_t partners = 0;
            for (int32_t k = 0; k < range->index_count; k++) {
                partners += is_same(corner(range, k, &s), b) &&
                            is_same(corner(range, k - k % 3 + (k + 1) % 3, &s), a);
            }
            assert_int_equal(partners, 1); /* every edge is run through once each way */
        }
    }
}

TEST_CASE(test_normals)
{
    for (int32_t i = 0; i < mesh.vertex_count; i++) {
        const float *n = mesh.vertices[i].normal;
        assert_float_equal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0f, 1e-6f);
    }
    for (int t = 0; t < 4; t++) {
        shape_mesh_scale s = shape_mesh_scale_of(&shapes[t]);
        for (int32_t i = 0; i < mesh.range[t].index_count; i += 3) {
            rlf_vec3 a = corner(&mesh.range[t], i, &s);
            rlf_vec3 b = corner(&mesh.range[t], i + 1, &s);
            rlf_vec3 c = corner(&mesh.range[t], i + 2, &s);
            rlf_vec3 face = rlf_normalize(rlf_cross(rlf_sub(b, a), rlf_sub(c, a)));
            for (int k = 0; k < 3; k++) {
                const float *n =
                    mesh.vertices[mesh.indices[mesh.range[t].first_index + i + k]].normal;
                rlf_vec3 normal = rlf_vec3_make((double)n[0], (double)n[1], (double)n[2]);
                assert_true(rlf_dot(face, normal) > 0.98);
            }
        }
    }
}

TEST_CASE(test_hull_triangle)
{
    const rlf_vec3 vertices[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    const int32_t triangles[6] = {0, 1, 2, 0, 1, 3};
    const rlf_hull hull = {vertices, 4, triangles, 2};
    shape_vertex v[3];
    assert_true(shape_mesh_hull_triangle(&hull, 0, 2.0, v));
    assert_float_equal(v[0].normal[2], 1.0f, 1e-7f);
    assert_float_equal(v[1].uv[0], 0.75f, 1e-7f);
    assert_float_equal(v[2].uv[1], 0.75f, 1e-7f);
    assert_false(shape_mesh_hull_triangle(&hull, 1, 2.0, v)); /* three points on a line */
}

TEST_CASE(test_texture_levels)
{
    static uint8_t texture[BODY_TEXTURE_BYTES];
    for (int kind = 0; kind < BODY_TEXTURE_KINDS; kind++) {
        body_texture_fill((body_texture_kind)kind, texture);
        int64_t sum = 0;
        for (int i = 0; i < BODY_TEXTURE_SIZE * BODY_TEXTURE_SIZE; i++) {
            sum += texture[4 * i];
        }
        double mean = (double)sum / (BODY_TEXTURE_SIZE * BODY_TEXTURE_SIZE);
        size_t last = body_texture_level_offset(BODY_TEXTURE_LEVELS - 1);
        assert_int_equal(last + 4, BODY_TEXTURE_BYTES);
        assert_float_equal(texture[last], mean, 3.0);
        assert_int_equal(texture[last + 3], 255);
    }
    /* A hull is drawn in its body's colour, whatever made it. */
    assert_int_equal(body_texture_kind_of(RLF_SHAPE_HULL), BODY_TEXTURE_PLAIN);
    body_texture_fill(BODY_TEXTURE_PLAIN, texture);
    for (size_t i = 0; i < BODY_TEXTURE_BYTES; i++) {
        assert_int_equal(texture[i], 255);
    }
}

TEST_CASE(test_texture_level_choice)
{
    /* A ball of 0.5 m across at 1 m, focal length 256: 128 pixels, as many as level 0 has. */
    const rlf_shape ball = {RLF_SHAPE_SPHERE, {0, 0, 0}, 0.25, 0, NULL};
    assert_int_equal(body_texture_level_of(&ball, 1.0, 256.0), 0);
    assert_int_equal(body_texture_level_of(&ball, 2.0, 256.0), 1);
    assert_int_equal(body_texture_level_of(&ball, 1e9, 256.0), BODY_TEXTURE_LEVELS - 1);
    assert_int_equal(body_texture_level_of(&ball, -1.0, 256.0), 0);
}

static int build(void **state)
{
    (void)state;
    shape_mesh_set_build(&mesh);
    return 0;
}

TEST_GROUP(build, NULL)
