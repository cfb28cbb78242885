/* Velocity and thickness of the front sheet against bodies whose motion and shape are known. */

#include "painted.h"
#include "test.h"

enum { WIDTH = 256, HEIGHT = 212, COUNT = WIDTH * HEIGHT };

static const double wall_z = 3.2;
static analytic_random noise;

/* Depth of the body along a ray; 0 where it is not. */
typedef double (*body_fn)(double x, double y, double time);

/* The wall for so many frames, and what the body hides of it; with the sensor's noise. */
static const rlf_surface *watch(body_fn body, int frames)
{
    const rlf_camera *c = &rig.depth;
    const rlf_surface *surface = NULL;
    for (int k = 0; k < frames; k++) {
        double time = frames_seen / 30.0;
        for (int i = 0; i < COUNT; i++) {
            double x = (i % WIDTH - c->cx) / c->fx, y = (i / WIDTH - c->cy) / c->fy;
            double z = body != NULL ? body(x, y, time) : 0.0;
            z = z > 0.0 ? z : wall_z;
            depth[i] = (float)(z + rlf_depth_noise_sigma(&rig.noise, z) * random_normal(&noise));
        }
        surface = see();
    }
    return surface;
}

/* Each test begins when the wall is known. */
static int start(void **state)
{
    (void)state;
    const rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    noise = (analytic_random){17};
    start_seeing(&def);
    watch(NULL, 8);
    return 0;
}

static const rlf_vec3 plate_normal = {0.4, 0.0, -0.9165151390};

/* A plate of half a metre, about 2 m away. */
static double plate(double x, double y, double time)
{
    (void)time;
    double z = plane_depth(plate_normal, 2.0 * plate_normal.z, x, y);
    double across = x * z;
    return rlf_max(across, -across) < 0.25 && rlf_max(y * z, -y * z) < 0.25 ? z : 0.0;
}

static const rlf_vec3 disc_velocity = {0.3, -0.2, 0.0};

/* A disc that faces the camera and moves in its own plane: its depth tells nothing of that. */
static double disc(double x, double y, double time)
{
    const double z = 2.0, radius = 0.2;
    rlf_vec3 p = rlf_mad(rlf_vec3_make(x * z, y * z, 0), disc_velocity, 0.4 - time);
    return rlf_dot(p, p) < radius * radius ? z : 0.0;
}

static double ball(double x, double y, double time)
{
    (void)time;
    return sphere_depth(rlf_vec3_make(0.1, 0.0, 2.0), 0.078, x, y);
}

/* Its far side lies behind the wall's front. */
static double ball_at_wall(double x, double y, double time)
{
    (void)time;
    return sphere_depth(rlf_vec3_make(0.0, 0.0, wall_z), 0.14, x, y);
}

/* A pyramid that moves sideways at 0.5 m/s: no face shows it all, the four together do. */
static double pyramid(double x, double y, double time)
{
    double middle = 0.5 * (time - 0.4), z = 2.0;
    for (int k = 0; k < 40; k++) {
        double across = rlf_max(x * z - middle, middle - x * z), up = rlf_max(y * z, -y * z);
        double out = rlf_max(across, up);
        z = 0.5 * (z + 1.9 + 0.6 * out);
        if (out > 0.27) {
            return 0.0;
        }
    }
    return z;
}

TEST_CASE(rigid_things_have_their_whole_velocity)
{
    const rlf_surface *f = watch(pyramid, 6);
    rlf_vec3 sum = {0.0, 0.0, 0.0};
    for (int i = 0; i < COUNT; i++) {
        sum = rlf_add(sum, rlf_vec3_make(f->velocity_x[i], f->velocity_y[i], f->velocity_z[i]));
    }
    assert_true(f->foreground_count > 1500);
    sum = rlf_scale(sum, 1.0 / f->foreground_count);
    assert_true(rlf_length(rlf_sub(sum, rlf_vec3_make(0.5, 0.0, 0.0))) < 0.025);
    const rlf_region *region = &f->regions[f->region_count - 1];
    assert_int_equal(region->layer, RLF_LAYER_FOREGROUND);
    assert_true(rlf_length(rlf_sub(region->linear_velocity, rlf_vec3_make(0.5, 0, 0))) < 0.025);
    assert_true(rlf_length(region->angular_velocity) < 0.15);
}

TEST_CASE(flat_things_move_as_their_outline_does)
{
    double worst = 0.0;
    for (int k = 0; k < 12; k++) {
        const rlf_surface *f = watch(disc, 1);
        const rlf_region *region = &f->regions[f->region_count - 1];
        double error = rlf_length(rlf_sub(region->linear_velocity, disc_velocity));
        worst = k > 0 && error > worst ? error : worst;
        int as_seen = 0;
        for (int i = 0; i < COUNT; i++) {
            rlf_vec3 v = {f->velocity_x[i], f->velocity_y[i], f->velocity_z[i]};
            as_seen += f->foreground[i] && rlf_length(rlf_sub(v, disc_velocity)) < 0.15;
        }
        assert_true(k == 0 || 10 * as_seen > 8 * f->foreground_count);
    }
    assert_less(worst, 0.05);
}

TEST_CASE(still_things_have_exactly_no_velocity)
{
    for (int k = 0; k < 6; k++) {
        const rlf_surface *f = watch(plate, 1);
        int moving = 0;
        for (int i = 0; i < COUNT; i++) {
            moving += f->velocity_x[i] != 0.0f || f->velocity_z[i] != 0.0f;
        }
        assert_int_equal(moving, 0);
        assert_true(f->foreground_count > 1700);
    }
}

/* Exit depth of the rays through a ball, where the front is not grazing. */
TEST_CASE(ball_is_as_thick_as_it_is)
{
    const rlf_vec3 centre = {0.1, 0.0, 2.0};
    const double radius = 0.078;
    const rlf_surface *f = watch(ball, 3);
    double error = 0.0;
    int count = 0;
    for (int i = 0; i < COUNT; i++) {
        assert_true(f->foreground[i] || f->thickness[i] == 0.0f);
        rlf_vec3 m = {f->ray_x[i], f->ray_y[i], 1.0};
        double b = rlf_dot(m, centre), a = rlf_dot(m, m);
        double root = b * b - a * (rlf_dot(centre, centre) - radius * radius);
        if (root <= 0.0 || !f->foreground[i]) {
            continue;
        }
        error +=
            rlf_max(2.0 * sqrt(root) / a - f->thickness[i], f->thickness[i] - 2.0 * sqrt(root) / a);
        count++;
    }
    assert_in_range(count, 80, 200);
    assert_true(error / count < 0.01);
}

TEST_CASE(plates_are_thin)
{
    const rlf_surface *f = watch(plate, 3);
    for (int i = 0; i < COUNT; i++) {
        assert_true(!f->foreground[i] || (f->thickness[i] > 0.015f && f->thickness[i] < 0.025f));
    }
}

TEST_CASE(nothing_is_thicker_than_the_room_behind_it)
{
    const rlf_surface *f = watch(ball_at_wall, 3);
    int count = 0, clamped = 0;
    for (int i = 0; i < COUNT; i++) {
        if (!f->foreground[i]) {
            continue;
        }
        double room = wall_z - f->depth[i];
        assert_true(f->thickness[i] <= room + 0.01);
        clamped += f->thickness[i] > room - 0.01;
        count++;
    }
    assert_true(count > 100 && clamped > count / 2);
}

TEST_EACH(start, stop_seeing)
