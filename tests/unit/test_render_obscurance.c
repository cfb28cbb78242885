/* Real surfaces keep light around from bodies close to them: by a formula that is held to its
 * integral, where the depth image shows such surfaces, and in pictures. */

#include "render/real_shade.h"
#include "test.h"

#include <math.h>

#include "render_scene.h"

#define FLOOR_Y 0.6 /* metres below the camera */
#define WALL_Z 3.0

/* ---- the formula ---------------------------------------------------------------------------- */

/* (1 / pi) of the cosine to the normal, times 1 - d / reach, over all directions in which the plane
 * is nearer than the reach. */
static double integrate(double facing, double height)
{
    enum { STEPS = 160 };
    const double across = sqrt(1.0 - facing * facing);
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double down = (i + 0.5) / STEPS;
        const double aside = sqrt(1.0 - down * down);
        const double lost = rlf_max(0.0, 1.0 - height / down);
        for (int k = 0; k < 2 * STEPS; k++) {
            const double turn = (k + 0.5) / STEPS * RLF_PI;
            sum += lost * rlf_max(0.0, across * aside * cos(turn) - facing * down);
        }
    }
    return sum / (STEPS * STEPS);
}

TEST_CASE(the_formula_is_the_integral)
{
    for (int i = -10; i <= 10; i++) {
        const float facing = 0.1f * (float)i;
        assert_true(fabsf(obscurance_lost(facing, 0.0f) - 0.5f * (1.0f - facing)) < 1e-6f);
        assert_true(obscurance_lost(facing, 1.0f) == 0.0f);
        assert_true(obscurance_lost(facing, 7.0f) == 0.0f);
        for (int k = 0; k <= 20; k++) {
            const float height = 0.05f * (float)k;
            const float lost = obscurance_lost(facing, height);
            assert_true(fabs((double)lost - integrate((double)facing, (double)height)) < 0.015);
            assert_true(lost <= obscurance_lost(facing, 0.05f * (float)(k - 1)) || k == 0);
            assert_true(lost <= obscurance_lost(facing - 0.1f, height) || i == -10);
        }
    }
    assert_true(fabsf(obscurance_lost(-1.0f, 0.3f) - 0.49f) < 1e-6f);
}

/* ---- what the depth image shows ------------------------------------------------------------- */

/* A floor, and from x = wall_x on a wall at the right (NAN = none), before the wall behind. */
static render_scene *make_room(float wall_x)
{
    render_scene *s = scene_make(WALL_Z);
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        const float floor_z = s->ray_y[i] > 0.01f ? (float)FLOOR_Y / s->ray_y[i] : 99.0f;
        const float side_z = s->ray_x[i] > 0.01f ? wall_x / s->ray_x[i] : NAN;
        int axis = 2;
        float z = (float)WALL_Z;
        axis = floor_z < z ? 1 : axis;
        z = floor_z < z ? floor_z : z;
        axis = side_z < z ? 0 : axis;
        z = side_z < z ? side_z : z;
        s->planes[PLANE_DEPTH][i] = s->planes[PLANE_BACK][i] = z;
        for (int k = 0; k < 3; k++) {
            s->planes[PLANE_NORMAL + k][i] = k == axis ? -1.0f : 0.0f;
        }
    }
    s->surface.background_normal_x = s->planes[PLANE_NORMAL];
    s->surface.background_normal_y = s->planes[PLANE_NORMAL + 1];
    s->surface.background_normal_z = s->planes[PLANE_NORMAL + 2];
    return s;
}

static rlf_vec3 on_floor(double x, double z, double half)
{
    return rlf_vec3_make(x, FLOOR_Y - half, z);
}

static obscurance find(const render_scene *s, rlf_shape shape, rlf_vec3 p)
{
    const rlf_pose identity = rlf_pose_identity();
    rlf_body_state body = {.shape = shape, .T_world_body = identity};
    caster c;
    obscurance found;
    body.T_world_body.p = p;
    assert_true(caster_make(&body, &identity, rlf_vec3_make(0, -1, 0), &c));
    obscurance_find(&s->surface, &identity, &c, &found);
    return found;
}

TEST_CASE(the_nearest_planes_are_found)
{
    render_scene *s = make_room(0.8f);
    const rlf_shape box = scene_box(0.2);
    obscurance o = find(s, box, on_floor(0.0, 2.0, 0.1));
    assert_int_equal(o.count, 1);
    assert_true(o.normal[0][1] < -0.999f && o.presence[0] == 1.0f);
    assert_true(fabsf(o.offset[0] - (float)FLOOR_Y) < 1e-4f);
    assert_true(fabsf(o.per_reach - 5.0f) < 1e-4f);
    assert_int_equal(find(s, box, on_floor(0.7, 2.0, 0.1)).count, 2);
    assert_int_equal(find(s, box, on_floor(0.7, 2.9, 0.1)).count, 3);
    assert_int_equal(find(s, box, rlf_vec3_make(0.0, 0.25, 2.0)).count, 0); /* 25 cm above */
    assert_int_equal(find(s, box, rlf_vec3_make(0.0, 0.0, 1.0)).count, 0);
    assert_int_equal(find(s, box, rlf_vec3_make(0.0, 0.8, 2.0)).count, 0); /* below the floor */
    s->surface.normal_z = NULL;
    assert_int_equal(find(s, box, on_floor(0.0, 2.0, 0.1)).count, 0);
    s->surface.depth = NULL;
    assert_int_equal(find(s, box, on_floor(0.0, 2.0, 0.1)).count, 0);
    scene_free(s);
}

/* A table top from 1.5 to 2.2 m in the middle of a room: half over its edge a box is near half of
 * it, and beside it near none. */
TEST_CASE(a_plane_ends_where_it_is_seen_to_end)
{
    render_scene *s = scene_make(4.0);
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        const float z = s->ray_y[i] > 0.01f ? 0.3f / s->ray_y[i] : 9.0f;
        if (z > 1.5f && z < 2.2f && fabsf(z * s->ray_x[i]) < 0.5f) {
            s->planes[PLANE_DEPTH][i] = z;
            s->planes[PLANE_NORMAL + 1][i] = -1.0f;
            s->planes[PLANE_NORMAL + 2][i] = 0.0f;
        }
    }
    const rlf_shape box = scene_box(0.1);
    assert_true(find(s, box, rlf_vec3_make(0.0, 0.25, 1.8)).presence[0] == 1.0f);
    const obscurance half = find(s, box, rlf_vec3_make(0.5, 0.25, 1.8));
    assert_int_equal(half.count, 1);
    assert_true(half.presence[0] > 0.2f && half.presence[0] < 0.8f);
    assert_int_equal(find(s, box, rlf_vec3_make(0.6, 0.25, 1.8)).count, 0);
    scene_free(s);
}

/* Behind a person the floor is where it was. */
TEST_CASE(what_is_hidden_is_known_from_before)
{
    render_scene *s = make_room(NAN);
    scene_add_strip(s, 200, 320, 1.2);
    const obscurance o = find(s, scene_box(0.2), on_floor(0.0, 2.0, 0.1));
    assert_int_equal(o.count, 1);
    assert_true(o.normal[0][1] < -0.999f && o.presence[0] == 1.0f);
    scene_free(s);
}

/* ---- pictures ------------------------------------------------------------------------------- */

/* The picture of a box or ball of half size 0.1 m at p. Free the compositor. */
static rlf_render_output draw(render_scene *s, rlf_shape_type type, rlf_vec3 p, bool is_near,
                              rlf_compositor **compositor)
{
    const rlf_shape shape = {.type = type, .size = {0.2, 0.2, 0.2}, .radius = 0.1, .height = 0.2};
    rlf_compositor_def def = scene_def(s);
    rlf_render_output out;
    def.light_direction = rlf_vec3_make(0, 1, 0);
    def.enable_real_shade = false;
    def.enable_real_ambient = is_near;
    s->snapshot.body_count = 0;
    (void)scene_add_body(s, shape, p);
    s->frame.color.data = NULL; /* then light comes evenly from everywhere else */
    assert_int_equal(rlf_compositor_create_soft(&def, compositor), RLF_OK);
    assert_int_equal(rlf_compositor_render(*compositor, &s->input, &out), RLF_OK);
    return out;
}

/* What is left of the light of a pixel that shows p: its code is the light's square root. */
static double left_at(render_scene *s, rlf_shape_type type, rlf_vec3 center, rlf_vec3 p)
{
    double red[2];
    for (int i = 0; i < 2; i++) {
        rlf_compositor *compositor = NULL;
        const rlf_render_output out = draw(s, type, center, i == 1, &compositor);
        const int32_t u = (int32_t)(540.5 * (p.x - 0.052) / p.z + 480.0);
        const int32_t v = (int32_t)(540.5 * p.y / p.z + 270.0);
        assert_int_equal(rlf_u8_row(&out.matte, v)[u], 255);
        red[i] = rlf_rgba8_row(&out.image, v)[4 * u];
        rlf_compositor_destroy(&compositor);
    }
    assert_true(red[0] > 40.0);
    return red[1] * red[1] / (red[0] * red[0]);
}

/* The front of a box gets the light around alone: what is left of it is by the formula. */
TEST_CASE(a_box_is_darker_the_nearer_to_the_floor)
{
    render_scene *s = make_room(NAN);
    const rlf_vec3 center = on_floor(0.0, 2.0, 0.1);
    double above = 1.0;
    for (int i = 9; i >= 1; i--) {
        const double height = 0.02 * i;
        const rlf_vec3 p = {0.0, FLOOR_Y - height, 1.9};
        const double left = left_at(s, RLF_SHAPE_BOX, center, p);
        const double lost = (double)obscurance_lost(0.0f, (float)(height / 0.2));
        assert_true(left <= above + 0.025); /* a step of a code */
        assert_true(fabs(left - (1.0 - OBSCURANCE_SHARE * lost)) < 0.03);
        above = left;
    }
    assert_true(above < 0.8);
    const rlf_vec3 top = {0.0, FLOOR_Y - 0.2, 1.95};
    assert_true(left_at(s, RLF_SHAPE_BOX, center, top) == 1.0);
    scene_free(s);
}

TEST_CASE(a_corner_is_darker_than_a_floor)
{
    render_scene *s = make_room(NAN);
    const rlf_vec3 center = on_floor(0.3, 2.0, 0.1);
    const rlf_vec3 p = {0.39, FLOOR_Y - 0.03, 1.9};
    const double floor_alone = left_at(s, RLF_SHAPE_BOX, center, p);
    scene_free(s);
    s = make_room(0.401f);
    const double corner = left_at(s, RLF_SHAPE_BOX, center, p);
    assert_true(corner < 0.85 * floor_alone && corner > 0.4 * floor_alone);
    scene_free(s);
}

/* Balls, capsules and cylinders lose most at the floor, and nothing at the top. */
TEST_CASE(round_bodies_are_dark_below)
{
    static const rlf_shape_type types[3] = {RLF_SHAPE_SPHERE, RLF_SHAPE_CAPSULE,
                                            RLF_SHAPE_CYLINDER};
    render_scene *s = make_room(NAN);
    for (int i = 0; i < 3; i++) {
        const double half = i == 1 ? 0.2 : 0.1;
        const rlf_vec3 center = on_floor(0.0, 2.0, half);
        const rlf_vec3 low = {0.0, FLOOR_Y - 0.02, 1.97 - 0.02 * i};
        const rlf_vec3 middle = {0.0, FLOOR_Y - 0.1, 1.9};
        const rlf_vec3 top = {0.0, FLOOR_Y - 2.0 * half + 0.01, 1.97};
        const double below = left_at(s, types[i], center, low);
        const double between = left_at(s, types[i], center, middle);
        assert_true(below < between - 0.05 && below > 0.3);
        assert_true(between < 1.0 && left_at(s, types[i], center, top) >= 0.99);
    }
    scene_free(s);
}

/* Far from everything the picture is the same to the bit. */
TEST_CASE(a_body_in_the_air_is_as_bright_as_ever)
{
    render_scene *s = make_room(NAN);
    rlf_compositor *with = NULL;
    rlf_compositor *without = NULL;
    const rlf_vec3 p = {0.1, 0.1, 1.8};
    const rlf_render_output a = draw(s, RLF_SHAPE_BOX, p, true, &with);
    const rlf_render_output b = draw(s, RLF_SHAPE_BOX, p, false, &without);
    assert_memory_equal(a.image.data, b.image.data, (size_t)960 * 540 * 4);
    rlf_compositor_destroy(&with);
    rlf_compositor_destroy(&without);
    scene_free(s);
}
