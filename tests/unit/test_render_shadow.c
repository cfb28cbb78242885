/* Shadows and contact darkening: where geometry says, by the body's real shape, on surfaces and on
 * other bodies; and what is left out can really take no light. */

#include "render/caster.h"
#include "test.h"

#include <math.h>

#include "render_scene.h"

static rlf_vec3 unit(double x, double y, double z)
{
    return rlf_normalize(rlf_vec3_make(x, y, z));
}

static caster make(rlf_shape shape, rlf_pose T, rlf_vec3 to_light)
{
    rlf_body_state body = {.shape = shape, .T_world_body = T};
    rlf_pose identity = rlf_pose_identity();
    caster c;
    assert_true(caster_make(&body, &identity, to_light, &c));
    return c;
}

/* What is left of both lights at a point, and, to see that the short way for points that are all
 * far from the body changes nothing, with the body's centre beside it. */
static void lights_at(const caster *c, rlf_vec3 p, float *ambient, float *direct)
{
    float x[CASTER_LANES], y[CASTER_LANES], z[CASTER_LANES];
    float left[2][2][CASTER_LANES];
    const caster_points points = {x, y, z, CASTER_LANES};
    for (int i = 0; i < CASTER_LANES; i++) {
        x[i] = (float)(p.x / p.z);
        y[i] = (float)(p.y / p.z);
        z[i] = (float)p.z;
        left[0][0][i] = left[0][1][i] = left[1][0][i] = left[1][1][i] = 1.0f;
    }
    for (int i = 0; i < 2; i++) {
        caster_take_ambient(c, &points, 1.0f, left[i][0]);
        caster_take_direct(c, &points, 1.0f, left[i][1]);
        x[1] = c->center[0] / c->center[2];
        y[1] = c->center[1] / c->center[2];
        z[1] = c->center[2];
    }
    *ambient = left[0][0][0];
    *direct = left[0][1][0];
    assert_true(*ambient == left[1][0][0] && *direct == left[1][1][0]);
}

/* Along the light from the middle of each shape there is full shadow, fading with distance; beside
 * it and towards the light there is none. */
TEST_CASE(shadow_lies_behind_the_body)
{
    const rlf_shape shapes[4] = {scene_box(0.2),
                                 {.type = RLF_SHAPE_SPHERE, .radius = 0.1},
                                 {.type = RLF_SHAPE_CAPSULE, .radius = 0.08, .height = 0.2},
                                 {.type = RLF_SHAPE_CYLINDER, .radius = 0.1, .height = 0.2}};
    rlf_vec3 to_light = unit(-0.3, -0.9, 0.1);
    rlf_vec3 aside = unit(0.9, -0.3, 0.0);
    rlf_pose T = {{0.1, 0.0, 2.0}, rlf_quat_from_rotation_vector(rlf_vec3_make(0.4, 0.9, -0.2))};
    for (int i = 0; i < 4; i++) {
        caster c = make(shapes[i], T, to_light);
        float ambient, near_light, far_light;
        lights_at(&c, rlf_mad(T.p, to_light, -0.35), &ambient, &near_light);
        lights_at(&c, rlf_mad(T.p, to_light, -0.9), &ambient, &far_light);
        assert_true(near_light < 0.4f && far_light > near_light && far_light < 0.95f);
        assert_true(ambient == 1.0f);
        lights_at(&c, rlf_mad(T.p, to_light, -0.5 - (double)c.length_m), &ambient, &far_light);
        assert_true(far_light == 1.0f);
        lights_at(&c, rlf_mad(T.p, to_light, 0.5), &ambient, &far_light);
        assert_true(far_light == 1.0f);
        lights_at(&c, rlf_mad(rlf_mad(T.p, to_light, -0.35), aside, 0.5), &ambient, &far_light);
        assert_true(far_light == 1.0f && ambient == 1.0f);
    }
}

/* Straight above a plane the shadow of a square is a square: its corner is dark where that of the
 * ball inside it is not. */
TEST_CASE(a_box_has_corners)
{
    rlf_vec3 to_light = {0, -1, 0};
    rlf_pose T = {{0, 0, 2.0}, rlf_quat_identity()};
    caster box = make(scene_box(0.4), T, to_light);
    caster ball = make((rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.2}, T, to_light);
    rlf_vec3 corner = {0.165, 0.22, 2.165}; /* 23 cm from the middle, along the diagonal */
    float ambient, direct;
    lights_at(&box, corner, &ambient, &direct);
    assert_true(direct < 0.6f);
    lights_at(&ball, corner, &ambient, &direct);
    assert_true(direct > 0.85f);
    rlf_vec3 beside = {0.3, 0.22, 2.0};
    lights_at(&box, beside, &ambient, &direct);
    assert_true(direct == 1.0f);
    assert_true(ambient > 0.3f && ambient < 1.0f); /* 10 cm from its side */
}

/* The shadow of an octahedron is what is seen of it from the light, not of a box about it, and so
 * is the light around that it takes. */
TEST_CASE(a_hull_has_an_outline)
{
    static const rlf_vec3 tips[6] = {{-0.2, 0, 0}, {0.2, 0, 0},  {0, -0.2, 0},
                                     {0, 0.2, 0},  {0, 0, -0.2}, {0, 0, 0.2}};
    const rlf_hull hull = {.vertices = tips, .vertex_count = 6};
    const rlf_shape shape = {.type = RLF_SHAPE_HULL, .hull = &hull};
    const rlf_pose T = {{0, 0, 2.0}, rlf_quat_from_rotation_vector(rlf_vec3_make(0, 0.3, 0))};
    const rlf_vec3 to_light = {0, -1, 0};
    const caster octahedron = make(shape, T, to_light);
    const caster box = make(scene_box(0.4), T, to_light);
    assert_int_equal(octahedron.edge_count, 4);
    const rlf_vec3 inside = {0.07, 0.22, 0.07}, corner = {0.15, 0.22, 0.15};
    float ambient, direct, of_box, unused;
    lights_at(&octahedron, rlf_transform(&T, inside), &ambient, &direct);
    assert_true(direct < 0.2f && ambient < 0.2f);
    lights_at(&octahedron, rlf_transform(&T, corner), &ambient, &direct);
    lights_at(&box, rlf_transform(&T, corner), &of_box, &unused);
    assert_true(direct == 1.0f && ambient > of_box + 0.2f);
}

/* Random bodies and points: wherever light is lost, the bounds must have said so. */
TEST_CASE(bounds_leave_nothing_out)
{
    srand(3);
    rlf_camera k = {.width = 640, .height = 480, .fx = 500, .fy = 500, .cx = 320, .cy = 240};
    int32_t taken = 0;
    for (int i = 0; i < 200; i++) {
        rlf_vec3 l = unit(rand() % 200 - 100.5, rand() % 200 - 100, rand() % 200 - 100);
        rlf_shape shape = scene_box(0.1 + 0.01 * (rand() % 30));
        shape.size.y *= 0.2 + 0.01 * (rand() % 200);
        shape = i % 3 == 0 ? (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.12} : shape;
        rlf_pose T = {{0.01 * (rand() % 100) - 0.5, 0.01 * (rand() % 100) - 0.5, 2.0},
                      rlf_quat_from_rotation_vector(unit(rand() % 9 - 4, rand() % 9 - 4, 1.5))};
        caster c = make(shape, T, l);
        pixel_rect rect;
        (void)caster_reach(&c, &k, l, &rect);
        for (int n = 0; n < 300; n++) {
            rlf_vec3 p = {0.01 * (rand() % 300 - 150), 0.01 * (rand() % 240 - 120),
                          1.0 + 0.01 * (rand() % 250)};
            float ambient, direct;
            lights_at(&c, p, &ambient, &direct);
            const float at[3] = {(float)p.x + 0.05f, (float)p.y, (float)p.z};
            int32_t takes = caster_may_take(&c, at, 0.051f);
            assert_true(ambient == 1.0f || (takes & CASTER_TAKES_AMBIENT) != 0);
            assert_true(direct == 1.0f || (takes & CASTER_TAKES_DIRECT) != 0);
            double u = k.fx * p.x / p.z + k.cx;
            double v = k.fy * p.y / p.z + k.cy;
            bool is_in_picture = u >= 0 && v >= 0 && u <= 639 && v <= 479;
            if (is_in_picture && (ambient < 0.999f || direct < 0.999f)) {
                taken++;
                assert_true(u >= rect.x0 && u < rect.x1 && v >= rect.y0 && v < rect.y1);
            }
        }
    }
    assert_true(taken > 1000);
}

static int32_t red_at(const rlf_render_output *out, int32_t u, int32_t v)
{
    return rlf_rgba8_row(&out->image, v)[4 * u];
}

/* A plate above a box, the light from above: the box's upper face loses light, more so the nearer
 * the plate is, and none when it is on the other side. */
TEST_CASE(bodies_shade_each_other)
{
    render_scene *s = scene_make(4.0);
    rlf_shape plate = {.type = RLF_SHAPE_BOX, .size = {0.5, 0.03, 0.5}};
    scene_add_body(s, scene_box(0.4), rlf_vec3_make(0.052, 0.5, 1.8));
    rlf_body_state *other = scene_add_body(s, plate, rlf_vec3_make(0.052, -1.0, 1.9));
    rlf_compositor_def def = scene_def(s);
    def.light_direction = rlf_vec3_make(0, 1, 0);
    rlf_compositor *compositor = NULL;
    assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
    const double heights[4] = {-3.0, -0.1, 0.1, 1.2};
    int32_t red[4];
    for (int i = 0; i < 4; i++) {
        rlf_render_output out;
        other->T_world_body.p.y = heights[i];
        assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
        int32_t v = (int32_t)(540.5 * 0.3 / 1.8 + 269.5);
        assert_int_equal(rlf_u8_row(&out.matte, v)[480], 255);
        red[i] = red_at(&out, 480, v);
    }
    assert_true(red[0] > 60 && red[1] < red[0] * 9 / 10 && red[2] < red[1]);
    assert_int_equal(red[3], red[0]);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(nearest_bodies_are_chosen)
{
    caster casters[7];
    const double at[7] = {0.0, -0.5, -0.3, 0.6, -0.9, -0.7, -0.4};
    rlf_vec3 l = {0, -1, 0};
    for (int i = 0; i < 7; i++) {
        rlf_pose T = {{0, at[i], 2.0}, rlf_quat_identity()};
        casters[i] = make(scene_box(0.2), T, l);
    }
    casters[2].near_m = 0.0f; /* casts nothing */
    int32_t chosen[CASTER_BODIES];
    assert_int_equal(caster_choose(casters, 7, 0, chosen), 3);
    assert_int_equal(chosen[0], 6);
    assert_int_equal(chosen[1], 1);
    assert_int_equal(chosen[2], 5);
}
