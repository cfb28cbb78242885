/* Normals at creases: two walls that meet, towards the camera or away from it. */

#include "seen_view.h"
#include "test.h"

#include <math.h>

enum { WIDTH = 192, HEIGHT = 96, COUNT = WIDTH * HEIGHT };

typedef struct fixture {
    rlf_rig rig;
    float *ray_x, *ray_y;
    float truth[COUNT], seen[COUNT];
    rlf_vec3 normal[COUNT];
    uint8_t face[COUNT];
    analytic_random random;
} fixture;

static int make_fixture(void **state)
{
    static fixture f;
    f.rig = analytic_rig(WIDTH, HEIGHT);
    f.random = (analytic_random){17};
    analytic_rays(&f.rig.depth, &f.ray_x, &f.ray_y);
    *state = &f;
    return 0;
}

/* With another focal length, in pixels. */
static void set_focus(fixture *f, double focus)
{
    rlf_free(f->ray_x);
    rlf_free(f->ray_y);
    f->rig.depth.fx = f->rig.depth.fy = focus;
    analytic_rays(&f->rig.depth, &f->ray_x, &f->ray_y);
}

static int free_fixture(void **state)
{
    fixture *f = *state;
    rlf_free(f->ray_x);
    rlf_free(f->ray_y);
    return 0;
}

/* Two planes through the point p: on a convex edge the ray meets the farther one. */
static void set_walls(fixture *f, const rlf_vec3 n[2], rlf_vec3 p, bool convex)
{
    for (int i = 0; i < COUNT; i++) {
        double z[2];
        for (int k = 0; k < 2; k++) {
            z[k] = plane_depth(n[k], rlf_dot(n[k], p), f->ray_x[i], f->ray_y[i]);
        }
        f->face[i] = (z[1] > z[0]) == convex;
        f->truth[i] = (float)z[f->face[i]];
        f->normal[i] = n[f->face[i]];
    }
}

static bool is_at_crease(const fixture *f, int i)
{
    int32_t x = i % WIDTH, y = i / WIDTH;
    if (x < 8 || y < 8 || x >= WIDTH - 8 || y >= HEIGHT - 8) {
        return false;
    }
    bool same = true;
    for (int32_t dy = -2; dy <= 2; dy++) {
        for (int32_t dx = -2; dx <= 2; dx++) {
            same = same && f->face[i] == f->face[i + dy * WIDTH + dx];
        }
    }
    return !same;
}

typedef struct score {
    int count, wrong;
} score;

/* The caller destroys the stage; the surface is valid until then. */
static const rlf_surface *reconstruct(const fixture *f, bool creases, rlf_reconstruct **stage)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    def.enable_edge_normals = creases;
    assert_int_equal(rlf_reconstruct_create(&def, stage), RLF_OK);
    rlf_frame frame = analytic_frame(&f->rig, f->seen, 0);
    const rlf_surface *s = surface_of(*stage, &frame);
    return s;
}

static void add_noise(fixture *f)
{
    for (int i = 0; i < COUNT; i++) {
        double sigma = rlf_depth_noise_sigma(&f->rig.noise, f->truth[i]);
        f->seen[i] = f->truth[i] + (float)(sigma * random_normal(&f->random));
    }
}

static score judge_surface(const fixture *f, const rlf_surface *s)
{
    score result = {0, 0};
    for (int i = 0; i < COUNT; i++) {
        rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
        bool at_crease = is_at_crease(f, i);
        result.count += at_crease;
        result.wrong += at_crease && angle_deg(n, f->normal[i]) > 30.0;
    }
    return result;
}

static score judge(fixture *f)
{
    add_noise(f);
    rlf_reconstruct *stage = NULL;
    const rlf_surface *s = reconstruct(f, true, &stage);
    score result = judge_surface(f, s);
    rlf_reconstruct_destroy(&stage);
    return result;
}

/* Walls at right angles, turned and tilted in many ways: of the five pixels across the crease the
 * one that it halves may be given to either side. */
TEST_CASE(creases_are_sharp)
{
    fixture *f = *state;
    score all = {0, 0};
    for (int k = 0; k < 24; k++) {
        double roll = 0.26 * k, turn = 0.5 + 0.03 * (k % 5);
        rlf_vec3 across = {rlf_cos(roll), rlf_sin(roll), 0.0};
        bool convex = k % 2 == 0;
        double side = convex ? -1.0 : 1.0;
        rlf_vec3 n[2];
        for (int w = 0; w < 2; w++) {
            double angle = w == 0 ? turn : 0.5 * RLF_PI - turn;
            double out = (w == 0 ? side : -side) * rlf_sin(angle);
            n[w] = rlf_vec3_make(out * across.x, out * across.y, -rlf_cos(angle));
        }
        set_walls(f, n, rlf_vec3_make(0.02 * k - 0.2, 0.1, 2.5), convex);
        score s = judge(f);
        assert_true(s.count > 200);
        assert_true(40 * s.wrong < s.count);
        all.count += s.count;
        all.wrong += s.wrong;
    }
    assert_true(150 * all.wrong < all.count);
}

/* Lines of missing pixels, two wide, cross a crease: what is filled is on one face or the other, as
 * the planes beside the line say, and not between them. */
TEST_CASE(creases_go_on_through_holes)
{
    fixture *f = *state;
    score filled = {0, 0};
    for (int k = 0; k < 12; k++) {
        double turn = 0.15 + 0.05 * k, side = k % 2 == 0 ? -1.0 : 1.0;
        const rlf_vec3 n[2] = {{0.0, side * rlf_sin(turn), -rlf_cos(turn)},
                               {0.0, -side * rlf_cos(turn), -rlf_sin(turn)}};
        set_walls(f, n, rlf_vec3_make(0.0, 0.01 * k, 2.5), k % 2 == 0);
        add_noise(f);
        for (int i = 0; i < COUNT; i++) {
            f->seen[i] = i % WIDTH % 12 < 2 ? 0.0f : f->seen[i];
        }
        rlf_reconstruct *stage = NULL;
        const rlf_surface *s = reconstruct(f, true, &stage);
        for (int i = 0; i < COUNT; i++) {
            rlf_vec3 found = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
            bool counts = f->seen[i] == 0.0f && is_at_crease(f, i);
            filled.count += counts;
            filled.wrong += counts && angle_deg(found, f->normal[i]) > 30.0;
        }
        rlf_reconstruct_destroy(&stage);
    }
    assert_less(1000, filled.count);
    assert_less(12 * filled.wrong, filled.count);
}

/* A side face at x = `edge` that meets a wall in a corner and ends nearer, at another wall. */
static void set_corner(fixture *f, double edge)
{
    const rlf_vec3 wall = {0.0, 0.0, -1.0}, side = {-1.0, 0.0, 0.0};
    for (int i = 0; i < COUNT; i++) {
        double at_side = edge / rlf_max(f->ray_x[i], 0.01);
        f->face[i] = at_side < 3.9 && at_side > 3.6;
        f->truth[i] = (float)rlf_max(rlf_min(at_side, 3.9), 3.6);
        f->normal[i] = f->face[i] ? side : wall;
    }
}

/* Planes of so narrow a face, seen edge-on, are not certain enough to tell where its corner is.
 * What has been seen for a while is. */
TEST_CASE(time_tells_where_a_corner_is)
{
    fixture *f = *state;
    const double focus = f->rig.depth.fx;
    set_focus(f, 365.5);
    score first = {0, 0}, last = {0, 0};
    for (int k = 0; k < 12; k++) {
        set_corner(f, 0.8 + 0.001 * k);
        rlf_reconstruct *stage = NULL;
        add_noise(f);
        score s = judge_surface(f, reconstruct(f, true, &stage));
        first.count += s.count;
        first.wrong += s.wrong;
        for (int t = 1; t < 24; t++) {
            add_noise(f);
            rlf_frame frame = analytic_frame(&f->rig, f->seen, t);
            const rlf_surface *surface = surface_of(stage, &frame);
            s = judge_surface(f, surface);
        }
        last.count += s.count;
        last.wrong += s.wrong;
        rlf_reconstruct_destroy(&stage);
    }
    set_focus(f, focus);
    assert_true(last.count > 2000);
    assert_true(2 * last.wrong < first.wrong);
}

/* Waves of twice the noise, as wide as a window, turn the normals of a wall by more than a crease's
 * least angle. Real sensors make such waves: there is nothing to sharpen. */
TEST_CASE(waves_of_noise_are_no_creases)
{
    fixture *f = *state;
    const double z = 3.0, wave = 2.0 * RLF_PI / 16.0;
    const rlf_depth_noise quiet = f->rig.noise;
    f->rig.noise =
        (rlf_depth_noise){0.005, 0.0, 0.005}; /* 2.3 pixels' widths, a Kinect v1's at 3.5 m */
    double height = 2.0 * rlf_depth_noise_sigma(&f->rig.noise, z);
    for (int i = 0; i < COUNT; i++) {
        double across = rlf_sin(wave * (i % WIDTH)), down = rlf_sin(wave * (i / WIDTH));
        f->seen[i] = (float)(z + height * across * down);
    }
    rlf_reconstruct *stages[2] = {NULL, NULL};
    const rlf_surface *plain = reconstruct(f, false, &stages[0]);
    const rlf_surface *sharp = reconstruct(f, true, &stages[1]);
    f->rig.noise = quiet;
    rlf_vec3 wall = {0.0, 0.0, -1.0};
    double steepest = 0.0;
    for (int i = 0; i < COUNT; i++) {
        rlf_vec3 n = {plain->normal_x[i], plain->normal_y[i], plain->normal_z[i]};
        steepest = rlf_max(steepest, angle_deg(n, wall));
        assert_true(sharp->normal_x[i] == plain->normal_x[i]);
        assert_true(sharp->normal_y[i] == plain->normal_y[i]);
        assert_true(sharp->normal_z[i] == plain->normal_z[i]);
    }
    assert_true(steepest > 13.0); /* on both sides of a wave: as much as cos 0.9 */
    rlf_reconstruct_destroy(&stages[0]);
    rlf_reconstruct_destroy(&stages[1]);
}

TEST_GROUP(make_fixture, free_fixture)
