/* A camera that moves is told, and people who move before a camera that stands are not. */

#include "painted.h"
#include "test.h"

enum { WIDTH = 160, HEIGHT = 120, COUNT = WIDTH * HEIGHT, STILL = 20, TOLD = 10, LEARNING = 5 };

#define RAD (RLF_PI / 180.0)
#define TURN 3.0 /* degrees a frame */

static int start(void **state)
{
    (void)state;
    rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    def.min_region_points = 8;
    start_seeing(&def);
    return 0;
}

static rlf_vec3 ray_of(int32_t i)
{
    return rlf_vec3_make((i % WIDTH - rig.depth.cx) / rig.depth.fx,
                         (i / WIDTH - rig.depth.cy) / rig.depth.fy, 1.0);
}

static void sense(int32_t i, double z, analytic_random *random)
{
    depth[i] = (float)(z + rlf_depth_noise_sigma(&rig.noise, z) * random_normal(random));
}

/* A corner of a room with a ball, seen from a pose, with the sensor's noise. */
static void look(const rlf_pose *T_room_camera, int32_t number)
{
    static const rlf_vec3 n[3] = {{0, -1, 0}, {0.6, 0, -0.8}, {-0.8, 0, -0.6}};
    static const double d[3] = {-1.0, -1.9, -1.8};
    const rlf_vec3 ball = {0.1, 0.5, 1.7};
    analytic_random random = {(uint64_t)number + 7};
    rlf_vec3 origin = T_room_camera->p;
    for (int32_t i = 0; i < COUNT; i++) {
        rlf_vec3 way = rlf_rotate(T_room_camera->q, ray_of(i));
        double nearest = 9.0;
        for (int32_t k = 0; k < 3; k++) {
            double t = (d[k] - rlf_dot(n[k], origin)) / rlf_dot(n[k], way);
            nearest = t > 0.0 && t < nearest ? t : nearest;
        }
        double t, leave;
        if (sphere_ray(ball, 0.25, origin, way, &t, &leave) && t > 0.0) {
            nearest = rlf_min(nearest, t);
        }
        sense(i, nearest, &random);
    }
}

/* A board that comes in from the left and covers half of what is seen. */
static void put_board(int32_t number)
{
    int32_t edge = 4 * number < WIDTH * 6 / 10 ? 4 * number : WIDTH * 6 / 10;
    for (int32_t i = 0; i < COUNT; i++) {
        double z = 1.1 - 0.003 * number;
        depth[i] = i % WIDTH < edge && depth[i] > z ? (float)z : depth[i];
    }
}

/* A camera in a hand: it walks by 0.15 m/s and turns by 10 degrees per second. */
static rlf_pose carried(int32_t frames)
{
    rlf_pose pose = {{0.003 * frames, 0.001 * frames, 0.004 * frames},
                     rlf_quat_from_axis_angle(rlf_vec3_make(0.3, 1.0, 0.0), 0.33 * RAD * frames)};
    return pose;
}

TEST_CASE(a_camera_that_moves_is_told)
{
    const rlf_pose still = rlf_pose_identity();
    for (int32_t k = 0; k < STILL; k++) {
        look(&still, k);
        assert_false(see()->camera_moves);
    }
    for (int32_t k = 1; k <= 3 * TOLD; k++) {
        rlf_pose pose = carried(k);
        look(&pose, STILL + k);
        const rlf_surface *s = see();
        assert_true(s->camera_moves || k < TOLD);
        assert_true(s->camera_moves || s->camera_may_move || k < TOLD - 1);
        for (int32_t i = 0; i < COUNT && s->camera_moves; i++) {
            assert_true(s->foreground[i] == 0 && s->velocity_x[i] == 0.0f &&
                        s->velocity_y[i] == 0.0f && s->velocity_z[i] == 0.0f);
        }
    }
    const rlf_pose stands = carried(3 * TOLD);
    const rlf_surface *s = NULL;
    for (int32_t k = 0; k < 2 * TOLD + LEARNING; k++) {
        look(&stands, 1000 + k);
        s = see();
    }
    assert_false(s->camera_moves);
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
}

TEST_CASE(who_walks_by_moves_no_camera)
{
    const rlf_pose still = rlf_pose_identity();
    for (int32_t k = 0; k < STILL + 40; k++) {
        look(&still, k);
        if (k >= STILL) {
            put_board(k - STILL);
        }
        const rlf_surface *s = see();
        assert_false(s->camera_moves || s->camera_may_move);
    }
}

static double to_ellipsoid(rlf_vec3 ray, rlf_vec3 centre, rlf_vec3 radii, double angle)
{
    const rlf_quat back = rlf_quat_from_axis_angle(rlf_vec3_make(0.0, 1.0, 0.0), -angle);
    const rlf_vec3 d = rlf_rotate(back, ray), c = rlf_rotate(back, centre);
    const rlf_vec3 way = {d.x / radii.x, d.y / radii.y, d.z / radii.z};
    const rlf_vec3 to = {c.x / radii.x, c.y / radii.y, c.z / radii.z};
    double a = rlf_dot(way, way), b = rlf_dot(way, to);
    double root = b * b - a * (rlf_dot(to, to) - 1.0);
    return root > 0.0 ? (b - sqrt(root)) / a : 9.0;
}

/* Somebody turns on the spot before a bare wall, which cannot tell motion along itself: a trunk, a
 * head and two arms, by 3 degrees a frame, and leans to both sides. The sensor draws the wall wavy,
 * as structured light does. */
static void look_at_wall(int32_t number)
{
    enum { MAN_PARTS = 4 };
    static const rlf_vec3 centres[MAN_PARTS] = {
        {0.0, 0.25, 0.0}, {0.0, -0.45, 0.0}, {-0.34, 0.2, -0.1}, {0.34, 0.2, -0.1}};
    static const rlf_vec3 radii[MAN_PARTS] = {
        {0.27, 0.58, 0.17}, {0.12, 0.16, 0.13}, {0.08, 0.36, 0.1}, {0.08, 0.36, 0.1}};
    const double angle = number > STILL ? TURN * RAD * (number - STILL) : 0.0;
    const rlf_quat turn = rlf_quat_from_axis_angle(rlf_vec3_make(0.0, 1.0, 0.0), angle);
    const double lean = number > STILL ? 0.4 * sin(0.15 * (number - STILL)) : 0.0;
    const rlf_quat upright = rlf_quat_from_axis_angle(rlf_vec3_make(0.0, 0.0, 1.0), -lean);
    analytic_random random = {(uint64_t)number + 7};
    for (int32_t i = 0; i < COUNT; i++) {
        rlf_vec3 ray = ray_of(i);
        double nearest = 2.2 + 0.006 * sin(33.0 * ray.x) * sin(28.6 * ray.y + 1.0);
        ray = rlf_rotate(upright, ray);
        for (int32_t k = 0; k < MAN_PARTS; k++) {
            rlf_vec3 centre = rlf_add(rlf_vec3_make(0.0, 0.0, 1.5), rlf_rotate(turn, centres[k]));
            nearest = rlf_min(nearest, to_ellipsoid(ray, centre, radii[k], angle));
        }
        sense(i, nearest, &random);
    }
}

TEST_CASE(who_turns_before_a_bare_wall_moves_no_camera)
{
    for (int32_t k = 0; k < STILL + 60; k++) {
        look_at_wall(k);
        const rlf_surface *s = see();
        assert_false(s->camera_moves || s->camera_may_move);
        assert_true(s->camera_rests || k < 2);
        assert_true(k < STILL + 8 || s->foreground_count > 0);
    }
}

TEST_EACH(start, stop_seeing)
