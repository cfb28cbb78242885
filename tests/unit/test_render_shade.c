/* Real things keep the light from bodies: by their shape, as far as the depth image knows it. */

#include "render/real_shade.h"
#include "test.h"

#include <math.h>

#include "render_scene.h"

/* A table top 30 cm below the camera, 1.5 to 2.2 m away, before a wall at 4 m. */
static render_scene *make_table(void)
{
    render_scene *s = scene_make(4.0);
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        float z = s->ray_y[i] > 0.01f ? 0.3f / s->ray_y[i] : 9.0f;
        float x = z * s->ray_x[i];
        if (z > 1.5f && z < 2.2f && x > -0.6f && x < 0.6f) {
            s->planes[PLANE_DEPTH][i] = z;
            s->planes[PLANE_BACK][i] = z;
        }
    }
    return s;
}

/* Least and most of the light that is left of a ball of 8 cm radius. */
static void left_at(const render_scene *s, rlf_vec3 p, rlf_vec3 to_light, float *least, float *most)
{
    rlf_body_state body = {.shape = {.type = RLF_SHAPE_SPHERE, .radius = 0.08}};
    rlf_pose identity = rlf_pose_identity();
    real_shade_world world = {&s->surface, NULL, identity, rlf_normalize(to_light), 540.0};
    caster c;
    real_shade shade;
    body.T_world_body = identity;
    body.T_world_body.p = p;
    assert_true(caster_make(&body, &identity, world.to_light, &c));
    real_shade_make(&world, &c, &shade);
    *least = *most = 1.0f;
    for (int i = 0; shade.takes && i < REAL_SHADE_CELLS; i++) {
        *most = i == 0 ? shade.left[0] : fmaxf(*most, shade.left[i]);
        *least = fminf(*least, shade.left[i]);
    }
}

static void check_lit(const render_scene *s, rlf_vec3 p, rlf_vec3 to_light)
{
    float least, most;
    left_at(s, p, to_light, &least, &most);
    assert_true(least == 1.0f);
}

static void check_shadowed(const render_scene *s, rlf_vec3 p, rlf_vec3 to_light)
{
    float least, most;
    left_at(s, p, to_light, &least, &most);
    assert_true(most < 0.1f);
}

TEST_CASE(a_table_shades_what_is_under_it)
{
    render_scene *s = make_table();
    rlf_vec3 up = {0, -1, 0};
    check_shadowed(s, rlf_vec3_make(0.0, 0.7, 1.85), up);
    check_shadowed(s, rlf_vec3_make(0.3, 0.5, 1.8), up);
    check_lit(s, rlf_vec3_make(0.0, 0.7, 2.6), up);   /* behind it */
    check_lit(s, rlf_vec3_make(0.0, 0.1, 1.8), up);   /* above it */
    check_lit(s, rlf_vec3_make(0.0, 0.21, 1.8), up);  /* lies on it */
    check_lit(s, rlf_vec3_make(0.0, 0.7, 1.2), up);   /* before it */
    check_lit(s, rlf_vec3_make(0.85, 0.7, 1.85), up); /* beside it */
    check_shadowed(s, rlf_vec3_make(0.85, 0.7, 1.85), rlf_vec3_make(-0.8, -0.6, 0.0));
    check_lit(s, rlf_vec3_make(0.0, 0.0, 3.8),
              rlf_vec3_make(0.0, -0.5, 0.5)); /* through the wall */
    float least, most;
    left_at(s, rlf_vec3_make(0.6, 0.6, 1.85), up, &least, &most); /* half under the edge */
    assert_true(least < 0.1f && most > 0.9f);
    scene_free(s);
}

/* Someone 30 cm deep: light that passes half a metre behind his back is not lost. */
TEST_CASE(a_person_is_no_endless_slab)
{
    render_scene *s = scene_make(4.0);
    scene_add_strip(s, 220, 280, 2.0);
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        s->planes[PLANE_THICKNESS][i] = s->foreground[i] ? 0.3f : 0.0f;
    }
    rlf_vec3 aside = {-1.0, -0.2, 0.0};
    check_shadowed(s, rlf_vec3_make(0.5, 0.0, 2.15), aside);
    check_lit(s, rlf_vec3_make(0.5, 0.0, 2.7), aside);
    check_lit(s, rlf_vec3_make(0.5, 0.0, 1.8), aside);
    check_shadowed(s, rlf_vec3_make(0.4, 0.0, 2.6), rlf_vec3_make(-1.0, 0.0, -1.0));
    scene_free(s);
}

/* Light from behind a cupboard that is background: the ray goes in at its front and comes out at
 * its side. Through the wall behind it no light comes. */
TEST_CASE(a_cupboard_shades_what_is_before_it)
{
    render_scene *s = scene_make(4.0);
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        bool is_cupboard = i % s->grid.width >= 220 && i % s->grid.width < 300;
        s->planes[PLANE_DEPTH][i] = is_cupboard ? 2.0f : 4.0f;
        s->planes[PLANE_BACK][i] = s->planes[PLANE_DEPTH][i];
    }
    check_shadowed(s, rlf_vec3_make(-0.2, 0.0, 1.8), rlf_vec3_make(0.8, 0.0, 0.6));
    check_lit(s, rlf_vec3_make(0.4, 0.0, 1.8), rlf_vec3_make(0.8, 0.0, 0.6));
    check_lit(s, rlf_vec3_make(1.2, 0.0, 3.7), rlf_vec3_make(0.3, 0.0, 0.9));
    scene_free(s);
}

/* A body whose way to the light is free by the tiles loses none by its rays. */
TEST_CASE(what_the_tiles_leave_out_is_lit)
{
    render_scene *s = make_table();
    scene_add_strip(s, 220, 280, 1.4);
    depth_tiles tiles;
    assert_int_equal(depth_tiles_create(s->grid.width, s->grid.height, &tiles), RLF_OK);
    depth_tiles_update(&tiles, &s->surface, NULL, NULL);
    srand(5);
    int32_t free_count = 0;
    for (int i = 0; i < 2000; i++) {
        rlf_vec3 l = {0.01 * (rand() % 200 - 100), -0.01 * (rand() % 100) - 0.1,
                      0.01 * (rand() % 200 - 100)};
        rlf_vec3 p = {0.01 * (rand() % 300 - 150), 0.01 * (rand() % 200 - 100),
                      0.5 + 0.01 * (rand() % 400)};
        const light_path_ball ball = {{(float)p.x, (float)p.y, (float)p.z}, 0.1f};
        const rlf_vec3 unit = rlf_normalize(l);
        const float to_light[3] = {(float)unit.x, (float)unit.y, (float)unit.z};
        if (!light_path_may_lose(&s->surface, &tiles, &ball, to_light)) {
            check_lit(s, p, l); /* a ball of 8 cm */
            free_count++;
        }
    }
    assert_true(free_count > 300);
    depth_tiles_destroy(&tiles);
    scene_free(s);
}

TEST_CASE(nothing_known_shades_nothing)
{
    render_scene *s = make_table();
    memset(s->planes[PLANE_DEPTH], 0, sizeof(float) * 512 * 424);
    memset(s->planes[PLANE_BACK], 0, sizeof(float) * 512 * 424);
    check_lit(s, rlf_vec3_make(0.0, 0.7, 1.85), rlf_vec3_make(0, -1, 0));
    s->surface.background_depth = NULL;
    s->surface.thickness = NULL;
    s->surface.foreground = NULL;
    check_lit(s, rlf_vec3_make(0.0, 0.7, 1.85), rlf_vec3_make(0, -1, 0));
    s->surface.depth = NULL;
    check_lit(s, rlf_vec3_make(0.0, 0.7, 1.85), rlf_vec3_make(0, -1, 0));
    scene_free(s);
}

static int32_t red_of_ball(render_scene *s, rlf_body_state *ball, rlf_vec3 p, bool is_shaded)
{
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = NULL;
    rlf_render_output out;
    def.light_direction = rlf_vec3_make(0, 1, 0);
    def.enable_real_shade = is_shaded;
    ball->T_world_body.p = p;
    assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
    assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
    int32_t u = (int32_t)(540.5 * (p.x - 0.052) / p.z + 479.5);
    int32_t v = (int32_t)(540.5 * (p.y - 0.06) / p.z + 269.5);
    assert_int_equal(rlf_u8_row(&out.matte, v)[u], 255);
    int32_t red = rlf_rgba8_row(&out.image, v)[4 * u];
    rlf_compositor_destroy(&compositor);
    return red;
}

/* The whole renderer: darker under the table, and only there; a setting switches it off. */
TEST_CASE(a_ball_under_a_table_is_dark)
{
    render_scene *s = make_table();
    rlf_shape shape = {.type = RLF_SHAPE_SPHERE, .radius = 0.12};
    rlf_body_state *ball = scene_add_body(s, shape, rlf_vec3_make(0, 0, 1));
    rlf_vec3 under = {0.0, 0.75, 1.85};
    rlf_vec3 above = {0.0, 0.1, 1.85};
    int32_t shaded = red_of_ball(s, ball, under, true);
    int32_t plain = red_of_ball(s, ball, under, false);
    assert_true(plain > 100 && shaded < plain * 7 / 10 && shaded > plain / 3);
    assert_int_equal(red_of_ball(s, ball, above, true), red_of_ball(s, ball, above, false));
    scene_free(s);
}
