/* One surface or a depth step: planes at many slants and distances are one surface, noise and all;
 * real steps are found as far as a pixel's footprint lets anyone tell them from a slant. */

#include "relief/math.h"
#include "surface/depth_step.h"
#include "test.h"

static const rlf_depth_noise time_of_flight = {0.0015, -0.0005, 0.0003};
static const rlf_depth_noise structured_light = {0.0008, 0.0, 0.0012};

enum { SENSORS = 2, DISTANCES = 6, SLANTS = 6 };

static const double distance[DISTANCES] = {0.5, 1.0, 1.5, 2.0, 3.0, 4.5};
static const double slant_deg[SLANTS] = {0, 20, 45, 60, 70, 78};

static depth_step sensor(int32_t k)
{
    return k == 0 ? depth_step_make(&time_of_flight, 365.0)
                  : depth_step_make(&structured_light, 575.0);
}

/* A plane at distance z on the middle ray, turned by `slant` about an axis at `turn` to y. */
typedef struct plane {
    rlf_vec3 normal;
    double z;
} plane;

static plane plane_at(double z, double slant, double turn)
{
    double s = rlf_sin(slant);
    return (plane){{s * rlf_cos(turn), s * rlf_sin(turn), -rlf_cos(slant)}, z};
}

/* Depth of the plane on the ray (x, y, 1). */
static double depth_of(const plane *p, double x, double y)
{
    return p->normal.z * p->z / (p->normal.x * x + p->normal.y * y + p->normal.z);
}

static float slope_of(const plane *p, double x, double y)
{
    return depth_step_slope((float)p->normal.x, (float)p->normal.y, (float)p->normal.z, (float)x,
                            (float)y);
}

/* Both samples are off by three sigma, away from each other. */
static void add_noise(const depth_step *s, double *a, double *b)
{
    double way = *a < *b ? -3.0 : 3.0;
    *a += way * (double)rlf_kernel_sigma(s->noise, (float)*a);
    *b -= way * (double)rlf_kernel_sigma(s->noise, (float)*b);
}

static void check_plane(const depth_step *s, const plane *p, double x, double y, int32_t pixels)
{
    double step = pixels * (double)s->footprint;
    const double beside[2][2] = {{x + step, y}, {x, y + step}};
    for (int32_t k = 0; k < 2; k++) {
        double a = depth_of(p, x, y), b = depth_of(p, beside[k][0], beside[k][1]);
        if (!(b > 0.0) || !(b < 10.0)) {
            continue; /* the ray does not meet it, or beyond any range */
        }
        add_noise(s, &a, &b);
        bool is_step = depth_step_is(s, (float)a, (float)b, slope_of(p, x, y), (float)pixels) ||
                       (pixels == 1 && depth_step_between(s, (float)a, (float)b));
        assert_false(is_step);
        assert_true(depth_step_is(s, (float)a, (float)b, 0.0f, 0.0f) ==
                    depth_step_since(s, (float)a, (float)b));
    }
}

TEST_CASE(a_plane_is_one_surface_at_any_slant_and_distance)
{
    static const double ray[3][2] = {{0.0, 0.0}, {0.4, -0.2}, {-0.3, 0.3}};
    for (int32_t k = 0; k < SENSORS * DISTANCES * SLANTS * 8; k++) {
        const depth_step s = sensor(k % SENSORS);
        double z = distance[k / SENSORS % DISTANCES];
        double slant = RLF_PI / 180.0 * slant_deg[k / (SENSORS * DISTANCES) % SLANTS];
        double turn = RLF_PI / 4.0 * (k / (SENSORS * DISTANCES * SLANTS));
        const plane p = plane_at(z, slant, turn);
        for (int32_t r = 0; r < 3; r++) {
            bool is_seen = slope_of(&p, ray[r][0], ray[r][1]) < DEPTH_STEP_STEEPEST &&
                           depth_of(&p, ray[r][0], ray[r][1]) > 0.0;
            for (int32_t pixels = 1; pixels <= 3 && is_seen; pixels++) {
                check_plane(&s, &p, ray[r][0], ray[r][1], pixels);
            }
        }
    }
}

TEST_CASE(a_missing_normal_may_be_as_steep_as_any)
{
    assert_true(depth_step_slope(0.0f, 0.0f, 0.0f, 0.1f, 0.2f) == DEPTH_STEP_STEEPEST);
    assert_true(depth_step_slope(1.0f, 0.0f, 0.0f, 0.0f, 0.0f) == DEPTH_STEP_STEEPEST);
    assert_true(depth_step_slope(0.0f, 0.0f, -1.0f, 0.3f, 0.2f) == 0.0f);
    assert_true(rlf_kernel_abs(depth_step_slope(0.6f, 0.0f, -0.8f, 0.0f, 0.0f) - 0.75f) < 1e-6f);
}

/* A hand's breadth, 8 cm, is a step between neighbours wherever cameras are used indoors. */
TEST_CASE(a_hand_before_a_wall_is_a_step_whatever_the_slope)
{
    for (int32_t k = 0; k < DISTANCES && distance[k] <= 2.0; k++) {
        float z = (float)distance[k];
        for (int32_t n = 0; n < SENSORS; n++) {
            const depth_step s = sensor(n);
            assert_true(depth_step_between(&s, z, z + 0.08f));
            assert_true(depth_step_between(&s, z + 0.08f, z));
        }
    }
}

/* Where the surface is known to face the camera, steps of a book's thickness are found. */
TEST_CASE(what_faces_the_camera_shows_smaller_steps)
{
    const depth_step s = sensor(0);
    for (int32_t k = 0; k < DISTANCES && distance[k] <= 2.0; k++) {
        float z = (float)distance[k], slope = depth_step_slope(0.5f, 0.0f, -0.866f, 0.0f, 0.0f);
        assert_true(depth_step_is(&s, z, z + 0.025f, slope, 1.0f));
        assert_true(depth_step_since(&s, z, z + 0.02f));
        assert_false(depth_step_since(&s, z, z + 0.005f));
    }
}
