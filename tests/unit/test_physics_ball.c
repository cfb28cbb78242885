/* Where a thrown ball goes: off a bulge, off an edge and off a plane seen at a low angle, as exact
 * geometry says. */
#include "grid_shared.h"
#include "heavy.h"
#include "small_world.h"
#include "test.h"

#include <math.h>

#define RADIUS 0.06

static const rlf_vec3 ahead = {0, 0, -1}, left = {-1, 0, 0}, right = {1, 0, 0}; /* of faces */

/* Direction in which a ball without friction and with restitution 0.8 flies 0.5 s after. */
static rlf_vec3 thrown(rlf_vec3 from, rlf_vec3 velocity, double radius)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = radius};
    def.position = from;
    def.velocity = velocity;
    def.restitution = 0.8;
    def.friction = 0.0;
    return alone_after(&def, &fixture->grid, 15).velocity;
}

static double degrees_between(rlf_vec3 a, rlf_vec3 b)
{
    return atan2(rlf_length(rlf_cross(a, b)), rlf_dot(a, b)) * 180.0 / RLF_PI;
}

static void set_wall(void)
{
    const grid_plane wall = grid_wall(4);
    grid_fixture_set_room(fixture, &wall, 1);
}

static void show(int32_t i, double z, rlf_vec3 n)
{
    grid_fixture_paint(fixture, GRID_BACKGROUND, i, z, n);
}

/* What moves or stands before it, as thick as the camera sees it. */
static void show_front(int32_t i, bool is_there, double z, rlf_vec3 n, double thickness)
{
    fixture->mask[i] = is_there;
    fixture->planes[GRID_THICKNESS][i] = (float)thickness;
    grid_fixture_paint(fixture, GRID_FOREGROUND, i, z, n);
}

/* A way after a blow of restitution 0.8 on a face. */
static rlf_vec3 reflected(rlf_vec3 v, rlf_vec3 n)
{
    return rlf_mad(v, n, -1.8 * rlf_dot(n, v));
}

/* A solid ball of the background before a wall at 4 m. */
static void set_bulge(rlf_vec3 centre, double radius)
{
    set_wall();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 m = grid_fixture_ray(fixture, i);
        double a = rlf_dot(m, m), b = rlf_dot(m, centre);
        double root = b * b - a * (rlf_dot(centre, centre) - radius * radius);
        if (root < 0.0) {
            continue;
        }
        double z = (b - sqrt(root)) / a;
        show(i, z, rlf_scale(rlf_sub(rlf_scale(m, z), centre), 1.0 / radius));
    }
    fixture->grid.background.default_thickness = 0.3;
}

TEST_CASE(bounces_off_a_bulge_as_off_a_ball)
{
    const rlf_vec3 CENTRE = {0.1, 0.05, 2.4};
    for (int k = 0; k < 2; k++) {
        double radius = k == 0 ? 0.3 : 0.08;
        set_bulge(CENTRE, radius);
        double worst = 0.0;
        for (int i = 0; i < 25; i++) {
            double reach = 0.35 * (radius + RADIUS);
            rlf_vec3 off = {(i % 5 - 2) * reach / 2.83, (i / 5 - 2) * reach / 2.83, 0};
            rlf_vec3 v = {0, 0, 3};
            rlf_vec3 from = rlf_vec3_make(CENTRE.x + off.x, CENTRE.y + off.y, 1.6);
            double depth = sqrt((radius + RADIUS) * (radius + RADIUS) - rlf_dot(off, off));
            rlf_vec3 n = rlf_normalize(rlf_vec3_make(off.x, off.y, -depth));
            rlf_vec3 expected = reflected(v, n);
            worst = fmax(worst, degrees_between(thrown(from, v, RADIUS), expected));
        }
        assert_true(worst < (k == 0 ? 2.0 : 4.0));
    }
}

/* Normals as a sensor's are: means over the pixels around, so that they are round at edges. */
static void blur_normals(void)
{
    const int32_t R = 2;
    static float sharp[3][GRID_W * GRID_H];
    for (int k = 0; k < 3; k++) {
        memcpy(sharp[k], fixture->planes[3 + k], sizeof(sharp[k]));
    }
    for (int32_t y = R; y < GRID_H - R; y++) {
        for (int32_t x = R; x < GRID_W - R; x++) {
            rlf_vec3 sum = {0, 0, 0};
            for (int32_t i = 0; i < 25; i++) {
                int32_t k = (y + i / 5 - R) * GRID_W + x + i % 5 - R;
                sum = rlf_add(sum, rlf_vec3_make(sharp[0][k], sharp[1][k], sharp[2][k]));
            }
            sum = rlf_normalize(sum);
            show(y * GRID_W + x, fixture->planes[GRID_BACKGROUND][y * GRID_W + x], sum);
        }
    }
}

/* The upright edge at `edge` of a big box of the background, of which two faces are seen. */
static void set_box_edge(rlf_vec3 edge, const rlf_vec3 normals[2])
{
    set_wall();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 m = grid_fixture_ray(fixture, i);
        double z[2];
        for (int k = 0; k < 2; k++) {
            double slope = rlf_dot(normals[k], m);
            z[k] = slope < 0.0 ? rlf_dot(normals[k], edge) / slope : 1e9;
        }
        int face = z[0] > z[1] ? 0 : 1;
        if (z[face] < 3.9) {
            show(i, z[face], normals[face]);
        }
    }
    fixture->grid.background.default_thickness = 0.3;
}

/* Worst errors of 30 balls that meet the edge: of the direction, degrees, and of its share along
 * the edge. */
static void throw_at_edge(rlf_vec3 edge, const rlf_vec3 faces[2], double worst[2])
{
    worst[0] = worst[1] = 0.0;
    for (int i = 0; i < 30; i++) {
        double share = 0.15 + 0.14 * (i % 6);
        rlf_vec3 n =
            rlf_normalize(rlf_add(rlf_scale(faces[0], share), rlf_scale(faces[1], 1.0 - share)));
        rlf_vec3 v = rlf_add(rlf_scale(n, -3.0), rlf_vec3_make(0, i % 2 == 0 ? 1.0 : -1.5, 0));
        rlf_vec3 at = rlf_mad(rlf_vec3_make(edge.x, 0.03 * (i / 6 - 2), edge.z), n, RADIUS);
        rlf_vec3 expected = reflected(v, n);
        rlf_vec3 out = thrown(rlf_mad(at, v, -0.2), v, RADIUS);
        worst[0] = fmax(worst[0], degrees_between(out, expected));
        worst[1] = fmax(worst[1], fabs(rlf_normalize(out).y - rlf_normalize(expected).y));
    }
}

TEST_CASE(bounces_squarely_off_an_edge_between_two_faces)
{
    const rlf_vec3 edge = {0.011, 0, 2};
    const rlf_vec3 faces[2] = {{-0.8, 0, -0.6}, {0.6, 0, -0.8}};
    double sharp[2], blurred[2];
    set_box_edge(edge, faces);
    throw_at_edge(edge, faces, sharp);
    blur_normals();
    throw_at_edge(edge, faces, blurred);
    assert_less(sharp[0], 1.0);
    assert_less(sharp[1], 0.001);
    assert_less(blurred[1], 0.02);
}

/* A cube of the background, turned about the vertical, of which the top and two sides are seen. */
typedef struct turned_cube {
    rlf_vec3 centre, axes[3]; /* to the right, down and away, before the turn */
    double half;
} turned_cube;

static turned_cube make_cube(double yaw)
{
    return (turned_cube){.centre = {0.3, 0.5, 2.3},
                         .axes = {{cos(yaw), 0, sin(yaw)}, {0, 1, 0}, {-sin(yaw), 0, cos(yaw)}},
                         .half = 0.08};
}

/* Before a wall at 4 m. */
static void set_cube(const turned_cube *cube)
{
    set_wall();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 m = grid_fixture_ray(fixture, i), n = m;
        double in = 0.0, out = 9.0;
        for (int k = 0; k < 3; k++) {
            double slope = rlf_dot(cube->axes[k], m), side = slope > 0.0 ? -1.0 : 1.0;
            double middle = rlf_dot(cube->axes[k], cube->centre) / slope;
            double reach = cube->half / fabs(slope);
            n = middle - reach > in ? rlf_scale(cube->axes[k], side) : n;
            in = fmax(in, middle - reach);
            out = fmin(out, middle + reach);
        }
        if (in < out) {
            show(i, in, n);
        }
    }
    fixture->grid.background.default_thickness = 0.16;
}

/* Distance of a place outside the cube, and its direction from there. */
static double distance_to(const turned_cube *cube, rlf_vec3 p, rlf_vec3 *normal)
{
    rlf_vec3 d = rlf_sub(p, cube->centre), nearest = cube->centre;
    for (int k = 0; k < 3; k++) {
        double t = rlf_clamp(rlf_dot(d, cube->axes[k]), -cube->half, cube->half);
        nearest = rlf_mad(nearest, cube->axes[k], t);
    }
    *normal = rlf_normalize(rlf_sub(p, nearest));
    return rlf_length(rlf_sub(p, nearest));
}

/* Which way the cube's surface turns a ball that flies at it. */
static rlf_vec3 turned_back(const turned_cube *cube, rlf_vec3 p, rlf_vec3 v, double radius)
{
    rlf_vec3 n = {0, 0, 0};
    for (double gap = 1.0; gap > 1e-6;) {
        gap = distance_to(cube, p, &n) - radius;
        p = rlf_mad(p, v, rlf_max(gap, 0.0) / rlf_length(v));
    }
    return reflected(v, n);
}

/* At a corner of the top, or at up to 5 cm from it, whose sides along two axes have these signs. */
static double miss_at_corner(const turned_cube *cube, const double sign[2], int i)
{
    const rlf_vec3 from = {-0.25 + 0.1 * (i % 5), 0.1 + 0.06 * (i % 3), 1.6};
    rlf_vec3 at = rlf_mad(cube->centre, cube->axes[1], -cube->half);
    at = rlf_mad(at, cube->axes[0], sign[0] * (cube->half - 0.0125 * (i % 4)));
    at = rlf_mad(at, cube->axes[2], sign[1] * (cube->half - 0.0125 * (i / 2 % 4)));
    rlf_vec3 v = rlf_scale(rlf_normalize(rlf_sub(at, from)), 4.0);
    double radius = 0.05 + 0.02 * (i % 5);
    return degrees_between(thrown(from, v, radius), turned_back(cube, from, v, radius));
}

TEST_CASE(bounces_off_a_cubes_corners_where_they_are)
{
    const turned_cube cube = make_cube(0.5);
    const double signs[3][2] = {{-1, -1}, {-1, 1}, {1, -1}}; /* in front, on the left, the right */
    double sum = 0.0;
    int wrong = 0;
    set_cube(&cube);
    for (int i = 0; i < 90; i++) {
        double miss = miss_at_corner(&cube, signs[i % 3], i / 3);
        sum += miss;
        wrong += miss > 10.0;
    }
    assert_less(sum / 90, 5.0);
    assert_less(wrong, 5);
}

/* The rim of a board that faces the camera: from 20 to 70 % of the radius beyond it. */
TEST_CASE(bounces_off_a_rim_where_it_is)
{
    set_wall();
    grid_fixture_set_slab(fixture, grid_wall(2), rlf_vec3_make(0, 0, 2), rlf_vec3_make(0.2, 0.3, 0),
                          0.02, rlf_vec3_make(0, 0, 0));
    for (int i = 0; i < 6; i++) {
        double beyond = (0.2 + 0.1 * i) * RADIUS;
        rlf_vec3 v = {0, 0, 3};
        rlf_vec3 n = {beyond / RADIUS, 0, -sqrt(1.0 - beyond * beyond / (RADIUS * RADIUS))};
        rlf_vec3 expected = reflected(v, n);
        double error =
            degrees_between(thrown(rlf_vec3_make(0.2 + beyond, 0.02, 1.5), v, RADIUS), expected);
        assert_true(error < 10.0); /* half a pixel is 2.7 mm: 3 to 4 deg of normal */
    }
}

/* Pixels are 10 cm apart on a floor 0.5 m below the camera and 4 m away: none may be missed. */
TEST_CASE(bounces_off_a_floor_seen_at_a_low_angle)
{
    grid_plane room[2] = {grid_floor(0.5), grid_wall(6)};
    grid_fixture_set_room(fixture, room, 2);
    for (int i = 0; i < 40; i++) {
        rlf_vec3 v = {0.5, 2, 0.3};
        rlf_vec3 out = thrown(rlf_vec3_make(-0.4 + 0.02 * i, 0.0, 3.2 + 0.031 * i), v, RADIUS);
        assert_true(degrees_between(out, rlf_vec3_make(0.5, -1.6, 0.3)) < 0.1);
    }
}

/* A block's front at 2 m and its side, seen at a low angle, that comes out 1 cm too near. */
static void set_block(double side_x)
{
    set_wall();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        double mx = fixture->planes[0][i], z = side_x / mx;
        bool is_front = mx > -0.3 && 2.0 * mx < side_x;
        if (is_front || (mx < 0.0 && z > 2.0 && z < 2.4)) {
            show(i, is_front ? 2.0 : z - 0.01, is_front ? ahead : right);
        }
    }
    fixture->grid.background.default_thickness = 0.15;
}

/* How thick the block is behind its side was not seen: no such back stands out of its front. */
TEST_CASE(bounces_off_a_front_beside_a_slanted_side)
{
    set_block(-0.2);
    for (int i = 0; i < 20; i++) {
        rlf_vec3 from = {-0.23 - 0.01 * i, 0.02, 1.5};
        rlf_vec3 out = thrown(from, rlf_vec3_make(0, 0, 3), RADIUS);
        assert_true(degrees_between(out, rlf_vec3_make(0, 0, -1)) < 1.0);
    }
}

/* A ball that comes from beyond the block's edge, and passes that without a touch. */
TEST_CASE(bounces_off_a_front_behind_its_edge)
{
    set_block(-0.2);
    double worst = 0.0;
    for (int i = 0; i < 20; i++) {
        rlf_vec3 touched = {-0.205 - 0.002 * i, 0.02, 2.0 - RADIUS};
        rlf_vec3 from = rlf_mad(touched, rlf_vec3_make(-3.0, 0.0, 1.5), -0.12 - 0.001 * i);
        rlf_vec3 out = thrown(from, rlf_vec3_make(-3.0, 0.0, 1.5), RADIUS);
        worst = fmax(worst, degrees_between(out, rlf_vec3_make(-3.0, 0.0, -1.2)));
    }
    assert_less(worst, 2.0);
}

/* A leg 4 cm wide and deep, of whose side at x = side_x one or two columns are seen. */
static void set_leg(double side_x)
{
    set_wall();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        double mx = fixture->planes[0][i], z = side_x / mx;
        bool is_front = 2.58 * mx > side_x && 2.58 * mx < side_x + 0.04;
        if (is_front || (mx > 0.0 && z > 2.58 && z < 2.62)) {
            show(i, is_front ? 2.58 : z, is_front ? ahead : left);
        }
    }
    fixture->grid.background.default_thickness = 0.15;
}

/* Of a fast ball's way every second pixel is looked at: the side may be between them. */
TEST_CASE(bounces_off_a_side_one_pixel_wide)
{
    const double radius = 0.02;
    const int count = heavy(400, 15);
    int off = 0;
    for (int i = 0; i < count; i++) {
        const double side_x = 0.58 + 0.0035 * (i % 20);
        const rlf_vec3 v = {3.0, 4.6, 2.2};
        set_leg(side_x);
        rlf_vec3 touched = {side_x - radius, 0.02 + 0.0011 * i, 2.6};
        rlf_vec3 out = thrown(rlf_mad(touched, v, -0.08 - 0.0007 * (i / 20)), v, radius);
        off += degrees_between(out, rlf_vec3_make(-2.4, 4.6, 2.2)) > 10.0;
    }
    assert_less(100 * off, count);
}

/* The foreground becomes what the camera sees of a solid ball, as thick as that is. */
static void set_thick(rlf_vec3 centre, double radius)
{
    grid_fixture_set_slab(fixture, grid_wall(2), rlf_vec3_make(0, 0, 2), rlf_vec3_make(9, 9, 0),
                          0.3, rlf_vec3_make(0, 0, 0));
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 m = grid_fixture_ray(fixture, i);
        double a = rlf_dot(m, m), b = rlf_dot(m, centre);
        double square = b * b - a * (rlf_dot(centre, centre) - radius * radius);
        double root = sqrt(fmax(square, 0.0)), z = (b - root) / a;
        rlf_vec3 n = rlf_scale(rlf_sub(rlf_scale(m, z), centre), 1.0 / radius);
        show_front(i, square > 0.0, z, n, 2.0 * root / a);
    }
}

/* Pixels of what moves are of one frame: 4 mm and 6 degrees of noise, alike in blocks of 3 x 3. */
static void add_noise(void)
{
    uint32_t seed = 12345;
    for (int32_t y = 0; y + 3 <= GRID_H; y += 3) {
        for (int32_t x = 0; x + 3 <= GRID_W; x += 3) {
            double noise[3];
            for (int32_t k = 0; k < 3; k++) {
                seed = seed * 1664525u + 1013904223u;
                noise[k] = (double)(seed >> 8) / (1 << 23) - 1.0; /* -1 to 1 */
            }
            for (int32_t k = 0; k < 9; k++) {
                int32_t i = (y + k / 3) * GRID_W + x + k % 3;
                fixture->planes[6][i] += (float)(0.007 * noise[0]);
                fixture->planes[7][i] += (float)(0.17 * noise[1]);
                fixture->planes[8][i] += (float)(0.17 * noise[2]);
            }
        }
    }
}

/* A limb of 15 cm at 2.7 m from before. */
TEST_CASE(bounces_off_a_noisy_bulge_that_moves)
{
    const rlf_vec3 centre = {0, 0, 2.7};
    const double LIMB = 0.15;
    set_thick(centre, LIMB);
    add_noise();
    double sum = 0.0;
    for (int i = 0; i < 49; i++) {
        rlf_vec3 n = rlf_vec3_make(0.08 * (i % 7 - 3), 0.08 * (i / 7 - 3), 0.0);
        n.z = -sqrt(1.0 - n.x * n.x - n.y * n.y);
        rlf_vec3 v = {0, 0, 2}, at = rlf_mad(centre, n, LIMB + RADIUS);
        rlf_vec3 out = thrown(rlf_mad(at, v, -0.1), v, RADIUS);
        sum += degrees_between(out, reflected(v, n));
    }
    assert_less(sum / 49, 4.5);
}

/* The foreground becomes what the camera sees of an upright limb. */
static void set_limb(rlf_vec3 axis, double radius)
{
    set_wall();
    grid_fixture_set_slab(fixture, grid_wall(2), rlf_vec3_make(0, 0, 2), rlf_vec3_make(9, 9, 0),
                          0.3, rlf_vec3_make(0, 0, 0));
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        double m = fixture->planes[0][i], a = m * m + 1.0, b = m * axis.x + axis.z;
        double square = b * b - a * (axis.x * axis.x + axis.z * axis.z - radius * radius);
        double root = sqrt(fmax(square, 0.0)), z = (b - root) / a;
        rlf_vec3 n = {(m * z - axis.x) / radius, 0.0, (z - axis.z) / radius};
        show_front(i, square > 0.0, z, n, 2.0 * root / a);
    }
}

/* Beside a limb's outline its pixels lie on one side of the place that is touched. It bends across
 * itself only. */
TEST_CASE(bounces_off_a_limbs_flank)
{
    const rlf_vec3 AXIS = {0.1, 0, 2.6};
    const double LIMB = 0.05, BALL = 0.1;
    double sum = 0.0;
    set_limb(AXIS, LIMB);
    for (int i = 0; i < 40; i++) {
        double angle = (45.0 + 1.0 * (i / 2)) * (i % 2 == 0 ? 1.0 : -1.0) * RLF_PI / 180.0;
        rlf_vec3 n = {sin(angle), 0, -cos(angle)}, at = rlf_mad(AXIS, n, LIMB + BALL);
        rlf_vec3 v = rlf_scale(n, -3.0);
        rlf_vec3 out = thrown(rlf_mad(at, v, -0.05), v, BALL);
        sum += degrees_between(out, n);
    }
    assert_less(sum / 40, 1.0);
}

/* From behind, where the front is out of the ball's reach. */
TEST_CASE(bounces_off_the_back_of_something_thick)
{
    const rlf_vec3 CENTRE = {0, 0, 2.4};
    const double BULGE = 0.25;
    set_wall();
    set_thick(CENTRE, BULGE);
    double worst = 0.0;
    for (int i = 0; i < 8; i++) {
        rlf_vec3 v = {0, 0, -0.5 - 0.5 * i};
        double off = 0.02 * i - 0.07, sum = BULGE + RADIUS;
        rlf_vec3 n = {off / sum, 0, sqrt(1.0 - off * off / (sum * sum))};
        rlf_vec3 from = rlf_mad(rlf_mad(CENTRE, n, sum), v, -0.2);
        rlf_vec3 expected = reflected(v, n);
        worst = fmax(worst, degrees_between(thrown(from, v, RADIUS), expected));
    }
    assert_less(worst, 10.0);
}

TEST_EACH(set_up, tear_down)
