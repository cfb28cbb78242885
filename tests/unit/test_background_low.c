/* A level top seen at ten degrees, four rows high and far noisier than what faces the camera: the
 * background has its plane. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>

#include "analytic.h"
#include "surface/steps.h"

enum { WIDTH = 160, HEIGHT = 120, COUNT = WIDTH * HEIGHT, FRAMES = 60 };

static const double top_m = 0.42, front_m = 2.2, back_m = 2.9, wall_m = 3.9, plate_m = 1.5;
/* A rough sample of a top, as in Fankhauser et al. 2015: metres. */
static const double top_sigma = 0.022;
static const double kept_at_step = 0.05, kept_beside_step = 0.4; /* by the driver */

static float depth[COUNT];

/* Depth along the ray whose y is given; whether it is of the top, so far below the camera. */
static double depth_of(double level_m, double y, bool *is_top)
{
    double z = y > 0.0 ? level_m / y : wall_m;
    *is_top = z > front_m && z < back_m;
    return *is_top ? z : z <= front_m ? front_m : wall_m;
}

static double true_depth(double y, bool *is_top)
{
    return depth_of(top_m, y, is_top);
}

/* With a slab of that height on the middle of the top. */
static void make_frame(const rlf_rig *rig, double slab_m, analytic_random *random)
{
    for (int32_t i = 0; i < COUNT; i++) {
        double y = (i / WIDTH - rig->depth.cy) / rig->depth.fy, pitch = 1.0 / rig->depth.fy;
        double level = top_m - (i % WIDTH >= 40 && i % WIDTH < 120 ? slab_m : 0.0);
        bool is_top, other;
        double z = depth_of(level, y, &is_top), near = depth_of(level, y + pitch, &other);
        double far = depth_of(level, y - pitch, &other);
        double farther = depth_of(level, y - 2.0 * pitch, &other);
        bool is_step = far - z > 0.2 || z - near > 0.2, is_beside = farther - far > 0.2;
        double kept = is_step ? kept_at_step : is_beside ? kept_beside_step : 1.0;
        double sigma = is_top ? top_sigma : rlf_depth_noise_sigma(&rig->noise, z);
        double sample = z + sigma * random_normal(random);
        depth[i] = random_uniform(random) < kept ? (float)sample : 0.0f;
    }
}

typedef struct show {
    rlf_reconstruct *stage;
    const rlf_surface *surface;
    analytic_random random;
    int32_t frame;
} show;

static show begin_show(void)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    show s = {.random = {7}};
    assert_int_equal(rlf_reconstruct_create(&def, &s.stage), RLF_OK);
    return s;
}

static void process(show *s)
{
    rlf_frame frame = analytic_frame(&s->stage->def.rig, depth, s->frame++);
    frame.rig = NULL;
    assert_int_equal(rlf_reconstruct_process(s->stage, &frame, &s->surface), RLF_OK);
}

static void look(show *s, int32_t frames, double slab_m)
{
    for (int32_t t = 0; t < frames; t++) {
        make_frame(&s->stage->def.rig, slab_m, &s->random);
        process(s);
    }
}

/* Means over the top's pixels that the background shows as such. */
static void measure(const show *of, double *out_off, double *out_turn)
{
    const rlf_surface *s = of->surface;
    const rlf_rig *rig = &of->stage->def.rig;
    const rlf_vec3 up = {0, -1, 0};
    double count = 0.0, off = 0.0, turn = 0.0;
    for (int32_t i = 0; i < COUNT; i++) {
        double y = (i / WIDTH - rig->depth.cy) / rig->depth.fy, z = s->background_depth[i];
        rlf_vec3 n = {s->background_normal_x[i], s->background_normal_y[i],
                      s->background_normal_z[i]};
        bool is_top, is_inside = i % WIDTH > 20 && i % WIDTH < WIDTH - 20;
        (void)true_depth(y, &is_top);
        if (is_inside && is_top && z < wall_m - 0.5) {
            count += 1.0;
            off += fabs(z * y - top_m);
            turn += angle_deg(n, up);
        }
    }
    assert_true(count > 300);
    *out_off = off / count;
    *out_turn = turn / count;
}

static void a_top_seen_at_a_low_angle_is_flat_and_level(void **state)
{
    (void)state;
    show s = begin_show();
    double off, turn;
    look(&s, FRAMES, 0.0);
    measure(&s, &off, &turn);
    print_message("top: %.2f mm off, %.2f degrees\n", 1000.0 * off, turn);
    assert_true(off < 0.0006 && turn < 0.4);
    rlf_reconstruct_destroy(&s.stage);
}

/* It is less than the noise of a sample, so that no pixel proves that it has left. */
static void a_slab_that_lay_on_it_is_forgotten(void **state)
{
    (void)state;
    show s = begin_show();
    double off, turn;
    look(&s, 120, 0.0);
    look(&s, 300, 0.01);
    look(&s, 240, 0.0);
    measure(&s, &off, &turn);
    print_message("top, 8 s after: %.2f mm off, %.2f degrees\n", 1000.0 * off, turn);
    assert_true(off < 0.0006 && turn < 0.4);
    rlf_reconstruct_destroy(&s.stage);
}

/* ---- a box that is taken away ---- */

/* Whether pixel i would show the box's top; its depth along the ray. */
static bool is_of_box(const rlf_rig *rig, int32_t i, double *out_z, bool *is_top)
{
    int32_t x = i % WIDTH;
    double y = (i / WIDTH - rig->depth.cy) / rig->depth.fy;
    *out_z = true_depth(y, is_top);
    return x >= 20 && x < WIDTH - 10 && *out_z < wall_m;
}

static void watch(show *s, int32_t frames, bool has_box, bool has_plate)
{
    const rlf_rig *rig = &s->stage->def.rig;
    for (int32_t t = 0; t < frames; t++) {
        for (int32_t i = 0; i < COUNT; i++) {
            bool is_top, is_hidden = has_plate && i % WIDTH >= 30 && i % WIDTH < 130;
            double z, sigma;
            bool is_box = is_of_box(rig, i, &z, &is_top) && has_box;
            z = is_hidden ? plate_m : is_box ? z : wall_m;
            sigma =
                is_box && is_top && !is_hidden ? top_sigma : rlf_depth_noise_sigma(&rig->noise, z);
            depth[i] = (float)(z + sigma * random_normal(&s->random));
        }
        process(s);
    }
}

/* Pixels at which the background shows the top. */
static int32_t count_top(const show *s, int32_t *all)
{
    int32_t count = 0;
    *all = 0;
    for (int32_t i = 0; i < COUNT; i++) {
        double z;
        bool is_top;
        if (is_of_box(&s->stage->def.rig, i, &z, &is_top) && is_top) {
            float shown = s->surface->background_depth[i];
            *all += 1;
            count += shown > 0.0f && shown < (float)wall_m - 0.4f;
        }
    }
    return count;
}

/* Somebody comes before it; behind him it is taken away, the wall is seen for four frames, and he
 * is there again. */
static void a_top_that_was_taken_away_does_not_stay(void **state)
{
    (void)state;
    show s = begin_show();
    int32_t all, hidden, seen;
    watch(&s, 90, true, false);
    watch(&s, 20, true, true);
    watch(&s, 4, false, false);
    watch(&s, 100, false, true);
    hidden = count_top(&s, &all);
    watch(&s, 240, false, false);
    seen = count_top(&s, &all);
    print_message("of %d pixels of the top %d stay while hidden, %d seen\n", all, hidden, seen);
    assert_true(all > 500 && hidden * 50 < all && seen * 50 < all);
    rlf_reconstruct_destroy(&s.stage);
}

/* A background that is never made anew asks for no such means. */
static void only_a_background_that_is_renewed_keeps_means(void **state)
{
    (void)state;
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    rlf_reconstruct *stage = NULL;
    def.background_method = RLF_BACKGROUND_AVERAGE;
    assert_int_equal(rlf_reconstruct_create(&def, &stage), RLF_OK);
    assert_null(stage->background.low.mark);
    rlf_reconstruct_destroy(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_top_seen_at_a_low_angle_is_flat_and_level),
        cmocka_unit_test(a_slab_that_lay_on_it_is_forgotten),
        cmocka_unit_test(a_top_that_was_taken_away_does_not_stay),
        cmocka_unit_test(only_a_background_that_is_renewed_keeps_means),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
