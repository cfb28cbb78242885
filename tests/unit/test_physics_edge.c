/* How deep a solid is guessed to be of which only the front is seen. */
#include "physics/grid/field.h"
#include "test.h"

#include <math.h>

#define WIDTH 320
#define HEIGHT 240
#define FOCAL 300.0
#define DISTANCE 1.0
#define RADIUS 0.025
#define WALL 3.0F
#define LIMIT 0.5

static float planes[6][WIDTH * HEIGHT]; /* ray x, y, depth, normal x, y, z */

static void show(int32_t i, double z, rlf_vec3 n)
{
    planes[2][i] = (float)z;
    planes[3][i] = (float)n.x;
    planes[4][i] = (float)n.y;
    planes[5][i] = (float)n.z;
}

/* A wall, and before it an upright leg; false: nothing of it is on the ray. */
typedef bool (*leg_fn)(double ray_x, double *z, rlf_vec3 *n);

static rlf_grid paint(leg_fn leg)
{
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        double z;
        rlf_vec3 n;
        planes[0][i] = (float)((i % WIDTH - 160) / FOCAL);
        planes[1][i] = (float)((i / WIDTH - 120) / FOCAL);
        if (leg((double)planes[0][i], &z, &n)) {
            show(i, z, n);
        } else {
            show(i, (double)WALL, rlf_vec3_make(0, 0, -1));
        }
    }
    rlf_grid grid = {.width = WIDTH, .height = HEIGHT, .ray_x = planes[0], .ray_y = planes[1]};
    grid.pixel_angle = 1.0 / FOCAL;
    grid.background = (rlf_grid_sheet){.depth = planes[2],
                                       .normal_x = planes[3],
                                       .normal_y = planes[4],
                                       .normal_z = planes[5],
                                       .default_thickness = LIMIT};
    return grid;
}

static bool round_leg(double ray_x, double *z, rlf_vec3 *n)
{
    const double CENTRE = DISTANCE + RADIUS;
    double a = ray_x * ray_x + 1.0;
    double root = CENTRE * CENTRE - a * (CENTRE * CENTRE - RADIUS * RADIUS);
    if (!(root > 0.0)) {
        return false;
    }
    *z = (CENTRE - sqrt(root)) / a;
    *n = rlf_scale(rlf_vec3_make(*z * ray_x, 0, *z - CENTRE), 1.0 / RADIUS);
    return true;
}

/* A front of 20 pixels, and 5 beside it of a side that leans away by 60 degrees. */
static bool square_leg(double ray_x, double *z, rlf_vec3 *n)
{
    double pixel = ray_x * FOCAL;
    *z = DISTANCE;
    *n = rlf_vec3_make(0, 0, -1);
    if (pixel > 10.5) {
        *z = DISTANCE + (pixel - 10.0) / FOCAL * sqrt(3.0);
        *n = rlf_vec3_make(0.5 * sqrt(3.0), 0, -0.5);
    }
    return pixel > -9.5 && pixel < 15.5;
}

static double depth_at(const rlf_grid *grid, int32_t x)
{
    field_cell cell;
    assert_true(grid_cell_read(grid, &grid->background, x, HEIGHT / 2, &cell));
    return grid_guess_depth(grid, &grid->background, &cell, LIMIT);
}

TEST_CASE(what_is_round_is_as_deep_as_wide)
{
    rlf_grid grid = paint(round_leg);
    for (int32_t x = 155; x <= 165; x++) {
        double deep = depth_at(&grid, x);
        assert_true(deep > 0.7 * 2 * RADIUS && deep < 1.1 * 2 * RADIUS);
    }
}

/* Two pixels at each outline show nothing: they are no side of the solid. */
TEST_CASE(missing_pixels_are_no_side)
{
    rlf_grid grid = paint(round_leg);
    for (int32_t i = 1; i < WIDTH * HEIGHT - 2; i++) {
        if (planes[2][i] == WALL && planes[2][i + 1] > 0.0F && planes[2][i + 1] < WALL) {
            show(i, 0.0, rlf_vec3_make(0, 0, 0));
            show(i - 1, 0.0, rlf_vec3_make(0, 0, 0));
        } else if (planes[2][i + 1] == WALL && planes[2][i] > 0.0F && planes[2][i] < WALL) {
            show(i + 1, 0.0, rlf_vec3_make(0, 0, 0));
            show(i + 2, 0.0, rlf_vec3_make(0, 0, 0));
        }
    }
    for (int32_t x = 155; x <= 165; x++) {
        assert_true(depth_at(&grid, x) > 0.9 * 2 * RADIUS);
    }
}

TEST_CASE(a_side_beside_a_front_is_not_counted)
{
    rlf_grid grid = paint(square_leg);
    double deep = depth_at(&grid, 160);
    assert_true(deep > 19.5 / FOCAL && deep < 20.5 / FOCAL);
}
