/* Every normal method against planes whose normal is known. */

#include "analytic.h"
#include "test.h"

enum { WIDTH = 65, HEIGHT = 53, COUNT = WIDTH * HEIGHT };

typedef struct grid {
    rlf_camera camera;
    float *ray_x, *ray_y;
    float depth[COUNT], x[COUNT], y[COUNT], z[COUNT];
} grid;

static int make_grid(void **state)
{
    static grid g;
    g.camera = analytic_rig(WIDTH, HEIGHT).depth;
    analytic_rays(&g.camera, &g.ray_x, &g.ray_y);
    *state = &g;
    return 0;
}
static int free_grid(void **state)
{
    grid *g = *state;
    rlf_free(g->ray_x);
    rlf_free(g->ray_y);
    return 0;
}

static void set_plane(grid *g, rlf_vec3 n, double d)
{
    for (int i = 0; i < COUNT; i++) {
        double z = plane_depth(n, d, g->ray_x[i], g->ray_y[i]);
        g->depth[i] = z > 0.0 && z < 50.0 ? (float)z : 0.0f;
    }
}

static void compute(grid *g, rlf_normal_method method, bool face, const rlf_depth_noise *noise)
{
    rlf_compute_normals(method, face, WIDTH, HEIGHT, g->ray_x, g->ray_y, g->depth, noise, g->x,
                        g->y, g->z);
}

static rlf_vec3 normal_at(const grid *g, int i)
{
    return rlf_vec3_make(g->x[i], g->y[i], g->z[i]);
}
static bool is_missing(const grid *g, int i)
{
    return g->x[i] == 0.0f && g->y[i] == 0.0f && g->z[i] == 0.0f;
}

/* A plane that faces the camera everywhere in the field, within 75 degrees. */
static rlf_vec3 random_plane(analytic_random *r)
{
    for (;;) {
        rlf_vec3 n = rlf_normalize(
            rlf_vec3_make(random_normal(r), random_normal(r), -0.2 - 2.0 * random_uniform(r)));
        bool facing = true;
        for (int k = 0; k < 4; k++) {
            rlf_vec3 corner = {k % 2 ? 0.7 : -0.7, k / 2 ? 0.6 : -0.6, 1.0};
            facing = facing && rlf_dot(n, rlf_normalize(corner)) < -0.26;
        }
        if (facing) {
            return n;
        }
    }
}

TEST_CASE(exact_methods_are_exact_on_planes)
{
    grid *g = *state;
    static const rlf_normal_method methods[] = {RLF_NORMALS_SIX_FACES, RLF_NORMALS_FOUR_FACES,
                                                RLF_NORMALS_INVERSE_DEPTH};
    analytic_random r = {7};
    for (int k = 0; k < 30; k++) {
        rlf_vec3 n = random_plane(&r);
        set_plane(g, n, -2.0);
        for (size_t m = 0; m < 3; m++) {
            compute(g, methods[m], true, NULL);
            for (int i = 0; i < COUNT; i++) { /* borders and corners too; float depth limits it */
                assert_true(angle_deg(normal_at(g, i), n) < 0.02);
            }
        }
    }
}

TEST_CASE(inverse_depth_is_exact_behind_a_distorting_lens)
{
    static grid own;
    grid *g = &own;
    g->camera = analytic_rig(WIDTH, HEIGHT).depth;
    g->camera.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    g->camera.distortion[0] = 0.0905;
    g->camera.distortion[1] = -0.268;
    g->camera.distortion[4] = 0.095;
    g->camera.distortion[2] = 0.004;
    analytic_rays(&g->camera, &g->ray_x, &g->ray_y);
    analytic_random r = {11};
    const rlf_depth_noise noise = {0.0015, -0.0005, 0.0003};
    for (int k = 0; k < 10; k++) {
        rlf_vec3 n = random_plane(&r);
        set_plane(g, n, -2.0);
        compute(g, RLF_NORMALS_INVERSE_DEPTH, true, NULL);
        for (int i = 0; i < COUNT; i++) {
            assert_true(g->ray_x[i] == 0.0f || angle_deg(normal_at(g, i), n) < 0.02);
        }
        compute(g, RLF_NORMALS_INVERSE_DEPTH, true, &noise);
        for (int i = 0; i < COUNT; i++) {
            assert_true(g->ray_x[i] == 0.0f || angle_deg(normal_at(g, i), n) < 0.02);
        }
    }
    rlf_free(g->ray_x);
    rlf_free(g->ray_y);
}

/* Eq. 4.3 written out again: with perspective it is the slope along the row and the column. */
TEST_CASE(thesis_normal_is_eq_4_3)
{
    grid *g = *state;
    analytic_random r = {3};
    rlf_vec3 n = random_plane(&r);
    set_plane(g, n, -2.0);
    compute(g, RLF_NORMALS_THESIS, false, NULL);
    double largest = 0.0;
    for (int y = 1; y < HEIGHT - 1; y++) {
        for (int x = 1; x < WIDTH - 1; x++) {
            int i = y * WIDTH + x;
            double L = g->depth[i - 1], R = g->depth[i + 1];
            double U = g->depth[i - WIDTH], D = g->depth[i + WIDTH];
            double dx = (R * g->ray_x[i + 1] - L * g->ray_x[i - 1]) / 2;
            double dy = (D * g->ray_y[i + WIDTH] - U * g->ray_y[i - WIDTH]) / 2;
            rlf_vec3 expected = rlf_normalize(rlf_vec3_make((R - L) / dx, (D - U) / dy, -2.0));
            assert_true(angle_deg(normal_at(g, i), expected) < 1e-4);
            largest = rlf_max(largest, angle_deg(normal_at(g, i), n));
        }
    }
    assert_true(largest > 0.5); /* the bias of errata 1 is there */
}

/* Slopes along one axis: eq. 4.3 is exact (errata 1). */
TEST_CASE(thesis_normal_is_exact_for_slopes_along_one_axis)
{
    grid *g = *state;
    const rlf_vec3 planes[2] = {{0.6, 0.0, -0.8}, {0.0, -0.6, -0.8}};
    for (int k = 0; k < 2; k++) {
        set_plane(g, planes[k], -2.0);
        compute(g, RLF_NORMALS_THESIS, true, NULL);
        for (int i = 0; i < COUNT; i++) {
            assert_true(angle_deg(normal_at(g, i), planes[k]) < 0.02);
        }
    }
}

TEST_CASE(orientation_is_to_the_camera_or_to_the_image)
{
    grid *g = *state;
    const rlf_vec3 floor_plane = {0.0, -0.9949874371, 0.1}; /* seen from above, leaning away */
    static const rlf_normal_method methods[] = {RLF_NORMALS_SIX_FACES, RLF_NORMALS_FOUR_FACES,
                                                RLF_NORMALS_THESIS, RLF_NORMALS_INVERSE_DEPTH};
    set_plane(g, floor_plane, -1.0);
    for (size_t m = 0; m < 4; m++) {
        compute(g, methods[m], true, NULL);
        for (int i = 0; i < COUNT; i++) {
            double facing = g->x[i] * g->ray_x[i] + g->y[i] * g->ray_y[i] + g->z[i];
            assert_true(is_missing(g, i) || facing < 0.0);
        }
        compute(g, methods[m], false, NULL);
        for (int i = 0; i < COUNT; i++) {
            assert_true(g->z[i] <= 0.0f);
        }
    }
    compute(g, RLF_NORMALS_INVERSE_DEPTH, true, NULL);
    assert_true(g->z[(HEIGHT - 3) * WIDTH + WIDTH / 2] > 0.05f);
}

TEST_CASE(missing_neighbour_takes_the_thesis_normal_away)
{
    grid *g = *state;
    const rlf_vec3 n = {0.0, 0.0, -1.0};
    int hole = 20 * WIDTH + 30;
    set_plane(g, n, -2.0);
    g->depth[hole] = 0.0f;
    compute(g, RLF_NORMALS_THESIS, true, NULL);
    const int cross[5] = {hole, hole - 1, hole + 1, hole - WIDTH, hole + WIDTH};
    for (int k = 0; k < 5; k++) {
        assert_true(is_missing(g, cross[k]));
    }
    assert_false(is_missing(g, hole - WIDTH + 1)); /* eq. 4.3 does not use the diagonal */
    compute(g, RLF_NORMALS_SIX_FACES, true, NULL);
    assert_true(is_missing(g, hole + WIDTH - 1)); /* its top right neighbour is the hole */
    assert_true(is_missing(g, hole - WIDTH + 1));
    assert_false(is_missing(g, hole + WIDTH + 1));
    const rlf_depth_noise noise = {0.0015, -0.0005, 0.0003};
    for (int k = 0; k < 2; k++) { /* ours loses only the hole itself */
        compute(g, RLF_NORMALS_INVERSE_DEPTH, true, k == 0 ? NULL : &noise);
        for (int i = 0; i < COUNT; i++) {
            assert_true(is_missing(g, i) == (i == hole));
            assert_true(i == hole || angle_deg(normal_at(g, i), n) < 0.02);
        }
    }
}

/* Corners of the grid (fig. 4.8): two mesh triangles at the top right and bottom left, one at the
 * others. The diagonal neighbour is moved off the plane to see whether it counts. */
TEST_CASE(corners_use_the_diagonal_where_the_mesh_has_one)
{
    grid *g = *state;
    const rlf_vec3 n = {0.0, 0.0, -1.0};
    const int corner[4] = {0, WIDTH - 1, COUNT - WIDTH, COUNT - 1};
    const int inward[4] = {WIDTH + 1, 2 * WIDTH - 2, COUNT - 2 * WIDTH + 1, COUNT - WIDTH - 2};
    const bool has_diagonal[4] = {false, true, true, false};
    for (int k = 0; k < 4; k++) {
        set_plane(g, n, -2.0);
        g->depth[inward[k]] = 1.9f;
        compute(g, RLF_NORMALS_THESIS, true, NULL);
        assert_true((angle_deg(normal_at(g, corner[k]), n) > 1.0) == has_diagonal[k]);
    }
}

TEST_CASE(normals_do_not_cross_a_depth_edge)
{
    grid *g = *state;
    const rlf_vec3 near = {0.6, 0.0, -0.8}, far = {0.0, 0.0, -1.0};
    const rlf_depth_noise noise = {0.0015, -0.0005, 0.0003};
    for (int i = 0; i < COUNT; i++) {
        bool left = i % WIDTH < 33;
        g->depth[i] = left ? (float)plane_depth(near, -0.8, g->ray_x[i], g->ray_y[i]) : 4.0f;
    }
    for (int k = 0; k < 2; k++) {
        compute(g, RLF_NORMALS_INVERSE_DEPTH, true, k == 0 ? NULL : &noise);
        for (int i = 0; i < COUNT; i++) {
            assert_true(angle_deg(normal_at(g, i), i % WIDTH < 33 ? near : far) < 0.05);
        }
    }
}

TEST_CASE(lone_pixels_face_the_camera)
{
    grid *g = *state;
    const rlf_depth_noise noise = {0.0015, -0.0005, 0.0003};
    memset(g->depth, 0, sizeof g->depth);
    g->depth[7 * WIDTH + 9] = 2.0f;
    for (int k = 0; k < 2; k++) {
        compute(g, RLF_NORMALS_INVERSE_DEPTH, true, k == 0 ? NULL : &noise);
        int i = 7 * WIDTH + 9;
        rlf_vec3 ray = rlf_normalize(rlf_vec3_make(g->ray_x[i], g->ray_y[i], 1.0));
        assert_true(angle_deg(normal_at(g, i), rlf_neg(ray)) < 0.01);
    }
}

TEST_GROUP(make_grid, free_grid)
