/* Velocity and thickness of the front sheet against bodies whose motion and shape are known. */

#include "analytic.h"
#include "test.h"

enum { WIDTH = 256, HEIGHT = 212, COUNT = WIDTH * HEIGHT };

static float depth[COUNT];
static const double wall_z = 3.2;

typedef struct scene {
    rlf_rig rig;
    rlf_reconstruct *stage;
    analytic_random random;
    int32_t frame;
} scene;

static scene start(void)
{
    scene s = {.rig = analytic_rig(WIDTH, HEIGHT), .random = {17}};
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &s.rig);
    assert_int_equal(rlf_reconstruct_create(&def, &s.stage), RLF_OK);
    return s;
}

/* Depth of the body along a ray; 0 where it is not. */
typedef double (*body_fn)(double x, double y, double time);

static const rlf_surface *step(scene *s, body_fn body)
{
    const rlf_camera *c = &s->rig.depth;
    double time = s->frame / 30.0;
    for (int i = 0; i < COUNT; i++) {
        double x = (i % WIDTH - c->cx) / c->fx, y = (i / WIDTH - c->cy) / c->fy;
        double z = body != NULL ? body(x, y, time) : 0.0;
        z = z > 0.0 ? z : wall_z;
        depth[i] = (float)(z + rlf_depth_noise_sigma(&s->rig.noise, z) * random_normal(&s->random));
    }
    rlf_frame frame = analytic_frame(&s->rig, depth, s->frame++);
    const rlf_surface *surface = NULL;
    assert_int_equal(rlf_reconstruct_process(s->stage, &frame, &surface), RLF_OK);
    return surface;
}

static const rlf_vec3 plate_normal = {0.4, 0.0, -0.9165151390};

/* A plate of half a metre that moves along its normal at 0.5 m/s, about 2 m away. */
static double plate(double x, double y, double time)
{
    rlf_vec3 centre = rlf_mad(rlf_vec3_make(0, 0, 2.0), plate_normal, 0.5 * (time - 0.4));
    double z = plane_depth(plate_normal, rlf_dot(plate_normal, centre), x, y);
    double across = x * z - centre.x;
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

static double still_plate(double x, double y, double time)
{
    (void)time;
    return plate(x, y, 0.4);
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

static void moving_plate_has_its_velocity(void **state)
{
    (void)state;
    scene s = start();
    for (int k = 0; k < 8; k++) {
        step(&s, NULL);
    }
    const rlf_surface *f = NULL;
    for (int k = 0; k < 6; k++) {
        f = step(&s, plate);
    }
    double sum = 0.0, across = 0.0;
    int count = 0;
    for (int i = 0; i < COUNT; i++) {
        rlf_vec3 v = {f->velocity_x[i], f->velocity_y[i], f->velocity_z[i]};
        if (!f->foreground[i]) {
            assert_true(rlf_length(v) == 0.0); /* the still wall is exactly still */
            continue;
        }
        sum += rlf_dot(v, plate_normal);
        rlf_vec3 normal = {f->normal_x[i], f->normal_y[i], f->normal_z[i]};
        across = rlf_max(across, rlf_length(rlf_cross(v, normal)));
        count++;
    }
    assert_in_range(count, 1700, 2500);
    assert_true(sum / count > 0.475 && sum / count < 0.525);
    assert_true(across < 0.015); /* 9 mm/s: the twist makes up little along the plate */
    rlf_reconstruct_destroy(&s.stage);
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

static void rigid_things_have_their_whole_velocity(void **state)
{
    (void)state;
    scene s = start();
    for (int k = 0; k < 8; k++) {
        step(&s, NULL);
    }
    const rlf_surface *f = NULL;
    for (int k = 0; k < 6; k++) {
        f = step(&s, pyramid);
    }
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
    rlf_reconstruct_destroy(&s.stage);
}

static void flat_things_move_as_their_outline_does(void **state)
{
    (void)state;
    scene s = start();
    for (int k = 0; k < 8; k++) {
        step(&s, NULL);
    }
    double worst = 0.0;
    for (int k = 0; k < 12; k++) {
        const rlf_surface *f = step(&s, disc);
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
    print_message("a disc in its own plane: speed off by %.3f of 0.361 m/s at most\n", worst);
    assert_true(worst < 0.05);
    rlf_reconstruct_destroy(&s.stage);
}

static void still_things_have_exactly_no_velocity(void **state)
{
    (void)state;
    scene s = start();
    for (int k = 0; k < 8; k++) {
        step(&s, NULL);
    }
    for (int k = 0; k < 6; k++) {
        const rlf_surface *f = step(&s, still_plate);
        int moving = 0;
        for (int i = 0; i < COUNT; i++) {
            moving += f->velocity_x[i] != 0.0f || f->velocity_z[i] != 0.0f;
        }
        assert_int_equal(moving, 0);
        assert_true(f->foreground_count > 1700);
    }
    rlf_reconstruct_destroy(&s.stage);
}

/* Exit depth of the rays through a ball, where the front is not grazing. */
static void ball_is_as_thick_as_it_is(void **state)
{
    (void)state;
    const rlf_vec3 centre = {0.1, 0.0, 2.0};
    const double radius = 0.078;
    scene s = start();
    for (int k = 0; k < 8; k++) {
        step(&s, NULL);
    }
    const rlf_surface *f = NULL;
    for (int k = 0; k < 3; k++) {
        f = step(&s, ball);
    }
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
    rlf_reconstruct_destroy(&s.stage);
}

static void plates_are_thin(void **state)
{
    (void)state;
    scene s = start();
    for (int k = 0; k < 8; k++) {
        step(&s, NULL);
    }
    const rlf_surface *f = NULL;
    for (int k = 0; k < 3; k++) {
        f = step(&s, still_plate);
    }
    for (int i = 0; i < COUNT; i++) {
        assert_true(!f->foreground[i] || (f->thickness[i] > 0.015f && f->thickness[i] < 0.025f));
    }
    rlf_reconstruct_destroy(&s.stage);
}

static void nothing_is_thicker_than_the_room_behind_it(void **state)
{
    (void)state;
    scene s = start();
    for (int k = 0; k < 8; k++) {
        step(&s, NULL);
    }
    const rlf_surface *f = NULL;
    for (int k = 0; k < 3; k++) {
        f = step(&s, ball_at_wall);
    }
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
    rlf_reconstruct_destroy(&s.stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moving_plate_has_its_velocity),
        cmocka_unit_test(rigid_things_have_their_whole_velocity),
        cmocka_unit_test(flat_things_move_as_their_outline_does),
        cmocka_unit_test(still_things_have_exactly_no_velocity),
        cmocka_unit_test(ball_is_as_thick_as_it_is),
        cmocka_unit_test(plates_are_thin),
        cmocka_unit_test(nothing_is_thicker_than_the_room_behind_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
