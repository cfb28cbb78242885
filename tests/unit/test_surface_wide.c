/* Wider planes for rough sensors: whose noise is alike in neighbouring pixels. */

#include "seen_view.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 240, COUNT = WIDTH * HEIGHT, PITCH = 4, COLUMNS = WIDTH / PITCH + 2 };

static int set_up(void **state)
{
    static seen_view view;
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rig.noise = (rlf_depth_noise){0.001, 0.0, 0.0015};
    seen_view_create(&view, rig, 11);
    *state = &view;
    return 0;
}

static int begin_noise(void **state)
{
    seen_view *v = *state;
    v->random = (analytic_random){11};
    return 0;
}

/* Independent every PITCH pixels, interpolated between; 1.5 makes up for what that averages. */
static void see(seen_view *v)
{
    static float knot[HEIGHT / PITCH + 2][COLUMNS];
    for (int y = 0; y < HEIGHT / PITCH + 2; y++) {
        for (int x = 0; x < COLUMNS; x++) {
            knot[y][x] = (float)random_normal(&v->random);
        }
    }
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH / PITCH, y = i / WIDTH / PITCH;
        float fx = (float)(i % WIDTH % PITCH) / PITCH, fy = (float)(i / WIDTH % PITCH) / PITCH;
        float top = knot[y][x] + (knot[y][x + 1] - knot[y][x]) * fx;
        float low = knot[y + 1][x] + (knot[y + 1][x + 1] - knot[y + 1][x]) * fx;
        double sigma = rlf_depth_noise_sigma(&v->rig.noise, v->truth[i]);
        float z = v->truth[i];
        v->seen[i] = z > 0.0f ? z + (float)sigma * 1.5f * (top + (low - top) * fy) : 0.0f;
    }
}

static rlf_reconstruct *make_stage(const seen_view *v, bool wide)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &v->rig);
    def.background_method = RLF_BACKGROUND_OFF;
    def.enable_wide_planes = wide;
    return stage_of(&def);
}

typedef struct errors {
    double normal, depth; /* mean, degrees; root of the mean square, metres */
    double wrong;         /* share of normals that are more than 30 degrees off */
} errors;

typedef rlf_vec3 normal_function(const seen_view *v, int i);

/* Of the pixels with a true depth. */
static errors measure(const seen_view *v, const rlf_surface *s, normal_function *normal)
{
    errors e = {0.0, 0.0, 0.0};
    int count = 0;
    for (int i = 0; i < COUNT; i++) {
        if (v->truth[i] > 0.0f && s->depth[i] > 0.0f) {
            rlf_vec3 n = rlf_vec3_make(s->normal_x[i], s->normal_y[i], s->normal_z[i]);
            double off = angle_deg(n, normal(v, i)), deep = s->depth[i] - v->truth[i];
            e.normal += off;
            e.wrong += off > 30.0 ? 1.0 : 0.0;
            e.depth += deep * deep;
            count++;
        }
    }
    assert_true(count > COUNT / 20);
    e.normal /= count;
    return (errors){e.normal, sqrt(e.depth / count), e.wrong / count};
}

static void compare(seen_view *v, normal_function *normal, errors out[2])
{
    see(v);
    for (int wide = 0; wide < 2; wide++) {
        rlf_reconstruct *stage = make_stage(v, wide != 0);
        out[wide] = measure(v, seen_view_process(v, stage, 0), normal);
        rlf_reconstruct_destroy(&stage);
    }
}

static rlf_vec3 wall_normal(const seen_view *v, int i)
{
    (void)v;
    (void)i;
    return rlf_normalize(rlf_vec3_make(0.3, 0.2, -1.0));
}

TEST_CASE_WITH(a_wall_is_flatter, begin_noise, NULL)
{
    seen_view *v = *state;
    for (int i = 0; i < COUNT; i++) {
        v->truth[i] = (float)plane_depth(wall_normal(v, i), -2.8, v->ray_x[i], v->ray_y[i]);
    }
    errors e[2];
    compare(v, wall_normal, e);
    assert_true(e[0].normal > 3.0); /* there is something to win */
    assert_true(e[1].normal < 0.25 * e[0].normal);
    assert_true(e[1].depth < 0.7 * e[0].depth);
}

/* Two walls meet in the middle, at a right angle. */
static rlf_vec3 corner_normal(const seen_view *v, int i)
{
    return rlf_normalize(rlf_vec3_make(v->ray_x[i] < 0.0f ? 1.0 : -1.0, 0.0, -1.0));
}

TEST_CASE_WITH(a_corner_stays_sharp, begin_noise, NULL)
{
    seen_view *v = *state;
    for (int i = 0; i < COUNT; i++) {
        rlf_vec3 n = corner_normal(v, i);
        v->truth[i] = (float)plane_depth(n, 3.2 * n.z, v->ray_x[i], v->ray_y[i]);
    }
    errors e[2];
    compare(v, corner_normal, e);
    assert_true(e[1].normal < 0.5 * e[0].normal);
    assert_true(e[1].wrong < e[0].wrong + 0.002);
}

/* A ball before nothing. */
static const rlf_vec3 ball = {0.1, 0.05, 2.2};

static rlf_vec3 ball_normal(const seen_view *v, int i)
{
    double z = v->truth[i];
    rlf_vec3 p = rlf_vec3_make(v->ray_x[i] * z, v->ray_y[i] * z, z);
    return rlf_normalize(rlf_sub(p, ball));
}

TEST_CASE_WITH(a_ball_stays_round, begin_noise, NULL)
{
    seen_view *v = *state;
    for (int i = 0; i < COUNT; i++) {
        v->truth[i] = (float)sphere_depth(ball, 0.35, v->ray_x[i], v->ray_y[i]);
    }
    errors e[2];
    compare(v, ball_normal, e);
    assert_true(e[1].normal < 1.1 * e[0].normal);
    assert_true(e[1].depth < 1.02 * e[0].depth);
}

/* What stands 6 cm before a wall, 24 pixels wide. */
TEST_CASE_WITH(a_step_stays_where_it_is, begin_noise, NULL)
{
    seen_view *v = *state;
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH - WIDTH / 2, y = i / WIDTH - HEIGHT / 2;
        v->truth[i] = x >= -12 && x < 12 && y >= -12 && y < 12 ? 1.94f : 2.0f;
    }
    see(v);
    rlf_reconstruct *stage = make_stage(v, true);
    const rlf_surface *s = seen_view_process(v, stage, 0);
    for (int i = 0; i < COUNT; i++) {
        if (s->reason[i] == RLF_REASON_OK) {
            assert_true(fabs(s->depth[i] - v->truth[i]) < 0.03);
        }
    }
    rlf_reconstruct_destroy(&stage);
}

TEST_CASE(a_fine_sensor_is_not_touched)
{
    seen_view fine;
    seen_view_create(&fine, analytic_rig(WIDTH, HEIGHT), 3);
    for (int i = 0; i < COUNT; i++) {
        fine.truth[i] =
            (float)plane_depth(wall_normal(&fine, i), -2.8, fine.ray_x[i], fine.ray_y[i]);
    }
    see(&fine);
    rlf_reconstruct *stages[2] = {make_stage(&fine, false), make_stage(&fine, true)};
    const rlf_surface *without = seen_view_process(&fine, stages[0], 0);
    const rlf_surface *with = seen_view_process(&fine, stages[1], 0);
    assert_memory_equal(without->depth, with->depth, COUNT * sizeof(float));
    assert_memory_equal(without->normal_x, with->normal_x, COUNT * sizeof(float));
    for (int k = 0; k < 2; k++) {
        rlf_reconstruct_destroy(&stages[k]);
    }
    void *view = &fine;
    seen_view_destroy(&view);
}

/* Mean error of the second layer's normals, degrees, after somebody came to stand in the middle. */
static double behind_error(seen_view *v, bool wide)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &v->rig);
    def.enable_wide_planes = wide;
    rlf_reconstruct *stage = stage_of(&def);
    for (int32_t k = 0; k < 50; k++) {
        (void)seen_view_process(v, stage, k);
    }
    for (int i = 0; i < COUNT; i++) {
        v->seen[i] = i % WIDTH > 100 && i % WIDTH < 220 ? 1.5f : v->seen[i];
    }
    const rlf_surface *s = seen_view_process(v, stage, 50);
    double sum = 0.0;
    int32_t hidden = 0;
    for (int i = 0; i < COUNT; i++) {
        rlf_vec3 n = {s->background_normal_x[i], s->background_normal_y[i],
                      s->background_normal_z[i]};
        sum += s->foreground[i] ? angle_deg(n, wall_normal(v, i)) : 0.0;
        hidden += s->foreground[i];
    }
    assert_true(hidden > COUNT / 4);
    rlf_reconstruct_destroy(&stage);
    return sum / hidden;
}

/* Noise that stays from frame to frame, as structured light's does: no mean over time helps. */
TEST_CASE_WITH(so_is_what_is_behind, begin_noise, NULL)
{
    seen_view *v = *state;
    for (int i = 0; i < COUNT; i++) {
        v->truth[i] = (float)plane_depth(wall_normal(v, i), -2.8, v->ray_x[i], v->ray_y[i]);
    }
    see(v);
    double narrow = behind_error(v, false);
    begin_noise(state);
    see(v);
    double wide = behind_error(v, true);
    assert_true(narrow > 3.0 && wide < 0.3 * narrow);
}

/* Odd sizes down to less than a block; everything missing but a pixel in seven. */
TEST_CASE(any_size_will_do)
{
    for (int32_t size = 1; size < 40; size += size < 8 ? 1 : 7) {
        seen_view v;
        rlf_rig rig = analytic_rig(size, size + 2);
        rig.depth.fx = rig.depth.fy = 300.0;
        rig.noise = (rlf_depth_noise){0.001, 0.0, 0.0015};
        seen_view_create(&v, rig, 3);
        for (int32_t k = 0; k < 8; k++) {
            for (int32_t i = 0; i < v.count; i++) {
                v.seen[i] = k < 7 && i % 7 != k ? 0.0f : 2.0f;
            }
            rlf_reconstruct *stage = make_stage(&v, true);
            const rlf_surface *s = seen_view_process(&v, stage, 0);
            for (int32_t i = 0; i < v.count; i++) {
                assert_true(isfinite(s->normal_z[i]) && s->depth[i] >= 0.0f && s->depth[i] < 2.1f);
            }
            rlf_reconstruct_destroy(&stage);
        }
        void *view = &v;
        seen_view_destroy(&view);
    }
}

TEST_GROUP(set_up, seen_view_destroy)
