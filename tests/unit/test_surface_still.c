/* What is curved and stands still: windows of normals shrink as averaging lowers the noise. */

#include "seen_view.h"
#include "test.h"

#include <math.h>

enum { WIDTH = 320, HEIGHT = 240, COUNT = WIDTH * HEIGHT, LAST = 60 };

/* A torus that is seen from above, before a wall. */
static const rlf_vec3 middle = {0.02, -0.01, 1.2};
static const double ring = 0.1, tube = 0.035, wall_m = 1.4;

static double torus_distance(rlf_vec3 p)
{
    rlf_vec3 q = rlf_sub(p, middle);
    double out = sqrt(q.x * q.x + q.y * q.y) - ring;
    return sqrt(out * out + q.z * q.z) - tube;
}

static rlf_vec3 torus_normal(rlf_vec3 p)
{
    rlf_vec3 q = rlf_sub(p, middle);
    double round = ring / sqrt(q.x * q.x + q.y * q.y);
    return rlf_normalize(rlf_vec3_make(q.x * (1.0 - round), q.y * (1.0 - round), q.z));
}

typedef struct still_view {
    seen_view view;
    rlf_vec3 *normal;
    bool *is_curved;
} still_view;

/* Depth and normal along the ray, by steps of the distance. */
static void draw(still_view *s, int i)
{
    seen_view *v = &s->view;
    rlf_vec3 ray = {v->ray_x[i], v->ray_y[i], 1.0};
    double z = 1.0;
    for (int k = 0; k < 60 && z < wall_m; k++) {
        z += 0.8 * torus_distance(rlf_scale(ray, z));
    }
    s->is_curved[i] = z < wall_m - 0.05;
    z = s->is_curved[i] ? z : wall_m;
    v->truth[i] = (float)z;
    s->normal[i] =
        s->is_curved[i] ? torus_normal(rlf_scale(ray, z)) : rlf_vec3_make(0.0, 0.0, -1.0);
}

static int set_up(void **state)
{
    static still_view s;
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rig.depth.fx = rig.depth.fy = 700.0;
    rig.noise = (rlf_depth_noise){0.0, 0.0, 0.0015};
    seen_view_create(&s.view, rig, 5);
    s.normal = rlf_alloc_array(COUNT, sizeof *s.normal);
    s.is_curved = rlf_alloc_array(COUNT, sizeof *s.is_curved);
    for (int i = 0; i < COUNT; i++) {
        draw(&s, i);
    }
    *state = &s;
    return 0;
}

static int tear_down(void **state)
{
    still_view *s = *state;
    rlf_free(s->normal);
    rlf_free(s->is_curved);
    void *view = &s->view;
    return seen_view_destroy(&view);
}

/* More than six pixels from an outline. */
static bool is_inside(const still_view *s, int i)
{
    int x = i % WIDTH, y = i / WIDTH;
    bool is_same = x >= 6 && x < WIDTH - 6 && y >= 6 && y < HEIGHT - 6;
    for (int dy = -6; dy <= 6 && is_same; dy++) {
        for (int dx = -6; dx <= 6; dx++) {
            is_same = is_same && s->is_curved[i + dy * WIDTH + dx] == s->is_curved[i];
        }
    }
    return is_same;
}

typedef struct errors {
    double curved, flat; /* mean, degrees */
} errors;

static errors measure(const still_view *s, const rlf_surface *f)
{
    double sum[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};
    for (int i = 0; i < COUNT; i++) {
        if (is_inside(s, i)) {
            rlf_vec3 n = {f->normal_x[i], f->normal_y[i], f->normal_z[i]};
            assert_true(rlf_length(n) > 0.5);
            sum[s->is_curved[i]] += angle_deg(n, s->normal[i]);
            count[s->is_curved[i]] += 1.0;
        }
    }
    assert_true(count[0] > COUNT / 10 && count[1] > COUNT / 40);
    return (errors){sum[1] / count[1], sum[0] / count[0]};
}

/* Errors of the first frame and after two seconds. `lasting`: share of the noise that is the same
 * in every frame. */
static void watch(still_view *s, float lasting, errors out[2])
{
    static float always[COUNT];
    seen_view *v = &s->view;
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &v->rig);
    rlf_reconstruct *stage = stage_of(&def);
    v->random = (analytic_random){5};
    for (int i = 0; i < COUNT; i++) {
        always[i] = lasting * (seen_view_noisy(v, v->truth[i]) - v->truth[i]);
    }
    float rest = (float)sqrt(1.0 - (double)lasting * (double)lasting);
    for (int32_t k = 0; k <= LAST; k++) {
        for (int i = 0; i < COUNT; i++) {
            float now = seen_view_noisy(v, v->truth[i]) - v->truth[i];
            v->seen[i] = v->truth[i] + always[i] + rest * now;
        }
        const rlf_surface *f = seen_view_process(v, stage, k);
        if (k == 0 || k == LAST) {
            out[k == LAST] = measure(s, f);
        }
    }
    rlf_reconstruct_destroy(&stage);
}

TEST_CASE(what_is_curved_sharpens)
{
    errors e[2];
    watch(*state, 0.0f, e);
    assert_true(e[1].curved < 0.65 * e[0].curved);
    assert_true(e[1].flat < 0.5 * e[0].flat);
}

/* Where averaging does not help, nothing is taken for curved that is not. */
TEST_CASE(noise_that_lasts_is_no_curve)
{
    errors e[2];
    watch(*state, 0.8f, e);
    assert_true(e[1].curved < 1.05 * e[0].curved);
    assert_true(e[1].flat < 1.05 * e[0].flat);
}

TEST_GROUP(set_up, tear_down)
