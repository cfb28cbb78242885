/* What a person hides: a trunk seen from the side, with an arm before it and one stretched out. */

#include "pipeline/far_side.h"
#include "test.h"

#include <string.h>

#define WIDTH 200
#define HEIGHT 160
#define MIDDLE 3.0f /* of the trunk, m along the ground */
#define WALL 9.0f

/* x0, y0, x1, y1 in pixels; front and thickness along the ground, m. */
typedef struct part {
    int32_t x0, y0, x1, y1;
    float front, thick;
} part;

static const part trunk = {80, 20, 110, 120, MIDDLE - 0.14f, 0.28f};
static const part arm = {90, 30, 100, 110, MIDDLE - 0.25f, 0.10f};
static const part hand = {125, 60, 150, 70, MIDDLE - 0.25f, 0.10f};
static const part reach = {85, 40, 95, 50, MIDDLE - 0.50f, 0.10f};

typedef struct view {
    rlf_surface surface;
    rlf_region region;
    float depth[WIDTH * HEIGHT], thickness[WIDTH * HEIGHT], background[WIDTH * HEIGHT];
    float ray_x[WIDTH * HEIGHT], ray_y[WIDTH * HEIGHT];
    int32_t label[WIDTH * HEIGHT];
    rlf_vec3 forward, down; /* along the ground and square to it */
    far_side far;
} view;

/* A camera that looks down by the angle whose sine and cosine are given. */
static void look(view *v, double sine, double cosine)
{
    far_side_destroy(&v->far);
    memset(v, 0, sizeof(*v));
    assert_int_equal(far_side_create(WIDTH, HEIGHT, &v->far), RLF_OK);
    v->forward = rlf_vec3_make(0.0, -sine, cosine);
    v->down = rlf_vec3_make(0.0, cosine, sine);
    v->region = (rlf_region){.label = 1, .layer = RLF_LAYER_FOREGROUND, .x1 = WIDTH, .y1 = HEIGHT};
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        v->ray_x[i] = (float)((i % WIDTH - 99.5) / 150.0);
        v->ray_y[i] = (float)((i / WIDTH - 79.5) / 150.0);
        v->depth[i] = v->background[i] = WALL;
    }
    v->surface = (rlf_surface){.width = WIDTH,
                               .height = HEIGHT,
                               .camera = {.width = WIDTH, .height = HEIGHT, .fx = 150, .fy = 150},
                               .ray_x = v->ray_x,
                               .ray_y = v->ray_y,
                               .depth = v->depth,
                               .thickness = v->thickness,
                               .label = v->label,
                               .background_depth = v->background,
                               .regions = &v->region,
                               .region_count = 1};
}

/* Upright, at a distance along the ground. */
static void draw(view *v, const part *p)
{
    for (int32_t y = p->y0; y < p->y1; y++) {
        for (int32_t x = p->x0; x < p->x1; x++) {
            int32_t i = y * WIDTH + x;
            float way = (float)v->forward.y * v->ray_y[i] + (float)v->forward.z;
            v->depth[i] = p->front / way;
            v->thickness[i] = p->thick / way;
            v->label[i] = 1;
        }
    }
}

/* Distance along the ground at which the solid ends at a pixel. */
static float end_at(view *v, int32_t x, int32_t y)
{
    const float *thickness = far_side_thicken(&v->far, &v->surface, v->down);
    int32_t i = y * WIDTH + x;
    float way = (float)v->forward.y * v->ray_y[i] + (float)v->forward.z;
    return (v->depth[i] + thickness[i]) * way;
}

TEST_CASE(an_arm_before_the_trunk_has_its_like_behind_it)
{
    view *v = *state;
    const double sines[2] = {0.0, 0.5}, cosines[2] = {1.0, 0.8660254};
    for (int32_t k = 0; k < 2; k++) {
        look(v, sines[k], cosines[k]);
        draw(v, &trunk);
        draw(v, &arm);
        assert_true(end_at(v, 95, 40) > MIDDLE + 0.23f && end_at(v, 95, 40) < MIDDLE + 0.27f);
        assert_true(end_at(v, 95, 100) > MIDDLE + 0.23f && end_at(v, 95, 100) < MIDDLE + 0.27f);
        assert_true(end_at(v, 85, 70) > MIDDLE + 0.12f && end_at(v, 85, 70) < MIDDLE + 0.16f);
    }
}

TEST_CASE(what_is_not_over_the_trunk_stays_as_thin_as_it_is)
{
    view *v = *state;
    look(v, 0.0, 1.0);
    draw(v, &trunk);
    draw(v, &hand);
    draw(v, &reach);
    assert_float_equal(end_at(v, 140, 65), MIDDLE - 0.15f, 1e-3f);
    assert_float_equal(end_at(v, 90, 45), MIDDLE - 0.40f, 1e-3f);
}

TEST_CASE(what_has_no_trunk_or_no_side_stays_as_it_is)
{
    view *v = *state;
    look(v, 0.0, 1.0);
    draw(v, &arm);
    assert_float_equal(end_at(v, 95, 70), MIDDLE - 0.15f, 1e-3f);
    draw(v, &trunk);
    v->down = rlf_vec3_make(0.0, 0.0, 1.0); /* seen from above, there is no side */
    assert_ptr_equal(far_side_thicken(&v->far, &v->surface, v->down), v->thickness);
}

TEST_CASE(two_trunks_in_one_region_have_no_middle)
{
    view *v = *state;
    part other = trunk;
    look(v, 0.0, 1.0);
    draw(v, &trunk);
    other.x0 = 110;
    other.x1 = 140;
    other.front += 0.5f;
    draw(v, &other);
    assert_ptr_equal(far_side_thicken(&v->far, &v->surface, v->down), v->thickness);
}

TEST_CASE(nothing_reaches_into_the_wall)
{
    view *v = *state;
    look(v, 0.0, 1.0);
    draw(v, &trunk);
    draw(v, &arm);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        v->background[i] = MIDDLE + 0.2f;
    }
    assert_float_equal(end_at(v, 95, 70), MIDDLE + 0.2f, 1e-3f);
}

static int create(void **state)
{
    static view memory;
    *state = &memory;
    return 0;
}

static int destroy(void **state)
{
    far_side_destroy(&((view *)*state)->far);
    return 0;
}

TEST_GROUP(create, destroy)
