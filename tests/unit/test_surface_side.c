/* Narrow things before a wall, of which the sensor drops the edges: a post's side that is a pixel
 * or two wide, a plate that has none, the wall in a slit. */

#include "seen_view.h"
#include "test.h"

enum { WIDTH = 256, HEIGHT = 64, COUNT = WIDTH * HEIGHT, FRAMES = 24 };

/* A block from left to right (metres), its front at `near`, its back at `far`. */
typedef struct block {
    double left, right, near, far;
} block;

static const double wall = 3.8;

static uint8_t is_side_at[COUNT];

static int set_up(void **state)
{
    static seen_view view;
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rig.depth.fx = rig.depth.fy = 365.5;
    rig.depth.cx = 250.0; /* the left half of a wider picture */
    seen_view_create(&view, rig, 31);
    *state = &view;
    return 0;
}

static void set_wall(seen_view *f)
{
    for (int i = 0; i < COUNT; i++) {
        f->truth[i] = (float)wall;
        is_side_at[i] = 0;
    }
}

/* To the left of the axis: the camera sees its front and its right side. */
static void add_block(seen_view *f, block b)
{
    for (int i = 0; i < COUNT; i++) {
        double x = f->ray_x[i], side = b.right / x;
        bool front = x * b.near >= b.left && x * b.near <= b.right;
        bool aside = !front && side > b.near && side <= b.far;
        f->truth[i] = (float)(front ? b.near : (aside ? side : f->truth[i]));
        is_side_at[i] = aside;
    }
}

/* As a driver delivers it: a pixel at a jump is dropped, one beside it in three frames of five;
 * noise is that of Fankhauser et al. 2015, here eight times as high on sides. */
static void take_frame(seen_view *f)
{
    for (int i = 0; i < COUNT; i++) {
        const float *z = f->truth + i;
        bool inside = i % WIDTH >= 3 && i % WIDTH < WIDTH - 3;
        double jump = 0.04 * *z;
        bool at = inside && (z[1] - z[0] > jump || z[0] - z[1] > jump || z[-1] - z[0] > jump ||
                             z[0] - z[-1] > jump);
        bool beside = inside && (z[2] - z[1] > jump || z[1] - z[2] > jump || z[-2] - z[-1] > jump ||
                                 z[-1] - z[-2] > jump);
        bool dropped = at || (beside && random_uniform(&f->random) < 0.6);
        double sigma = rlf_depth_noise_sigma(&f->rig.noise, *z) * (is_side_at[i] ? 8.0 : 1.0);
        f->seen[i] = dropped ? 0.0f : (float)(*z + sigma * random_normal(&f->random));
    }
}

static const rlf_surface *watch(seen_view *f, rlf_reconstruct **stage)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    *stage = stage_of(&def);
    const rlf_surface *s = NULL;
    for (int32_t k = 0; k < FRAMES; k++) {
        take_frame(f);
        s = seen_view_process(f, *stage, k);
    }
    return s;
}

typedef struct score {
    int side, side_wrong, front, front_wrong;
} score;

static score judge(seen_view *f)
{
    rlf_reconstruct *stage = NULL;
    const rlf_surface *s = watch(f, &stage);
    score result = {0};
    for (int i = 12 * WIDTH; i < COUNT - 12 * WIDTH; i++) {
        bool is_side = is_side_at[i] != 0, is_front = !is_side && f->truth[i] < wall - 0.01;
        rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
        rlf_vec3 truth = {is_side ? 1.0 : 0.0, 0.0, is_side ? 0.0 : -1.0};
        bool wrong = angle_deg(n, truth) > 30.0;
        result.side += is_side;
        result.side_wrong += is_side && wrong;
        result.front += is_front;
        result.front_wrong += is_front && wrong;
    }
    rlf_reconstruct_destroy(&stage);
    return result;
}

/* A post before the wall, at eight places between two pixels' columns. */
static score judge_posts(seen_view *f, double width, double far)
{
    score all = {0};
    for (int k = 0; k < 8; k++) {
        double right = -0.95 + 0.0012 * k;
        set_wall(f);
        add_block(f, (block){right - width, right, 3.2, far});
        score s = judge(f);
        all.side += s.side;
        all.side_wrong += s.side_wrong;
        all.front += s.front;
        all.front_wrong += s.front_wrong;
    }
    print_message("side %d of %d wrong, front %d of %d\n", all.side_wrong, all.side,
                  all.front_wrong, all.front);
    return all;
}

TEST_CASE(the_side_of_a_post_is_a_face)
{
    score all = judge_posts(*state, 0.05, 3.26);
    assert_true(all.side > 8 * (HEIGHT - 24));
    assert_true(100 * all.side_wrong <= 12 * all.side);
    assert_true(100 * all.front_wrong <= 2 * all.front);
}

/* A pixel of it, which the sensor drops in every frame. */
TEST_CASE(a_narrow_post_is_as_deep_as_it_is_wide)
{
    score all = judge_posts(*state, 0.045, 3.235);
    assert_true(all.side > 6 * (HEIGHT - 24) && all.side <= 9 * (HEIGHT - 24));
    assert_true(10 * all.side_wrong <= all.side);
    assert_true(10 * all.front_wrong <= all.front);
}

/* A block after so many frames that the background's tiles were made once more. */
static const rlf_surface *watch_long(seen_view *f, block b, rlf_reconstruct **stage)
{
    enum { LONG = 96 };
    set_wall(f);
    add_block(f, b);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    *stage = stage_of(&def);
    const rlf_surface *s = NULL;
    for (int32_t k = 0; k < LONG; k++) {
        take_frame(f);
        s = seen_view_process(f, *stage, k);
    }
    return s;
}

/* The background takes over what many frames have told. */
TEST_CASE(the_background_has_the_side)
{
    seen_view *f = *state;
    rlf_reconstruct *stage = NULL;
    const rlf_surface *s = watch_long(f, (block){-1.00, -0.95, 3.2, 3.26}, &stage);
    int side = 0, wrong = 0;
    const rlf_vec3 truth = {1.0, 0.0, 0.0};
    for (int i = 12 * WIDTH; i < COUNT - 12 * WIDTH; i++) {
        rlf_vec3 n = {s->background_normal_x[i], s->background_normal_y[i],
                      s->background_normal_z[i]};
        side += is_side_at[i];
        wrong += is_side_at[i] && angle_deg(n, truth) > 30.0;
    }
    assert_true(side >= HEIGHT - 24);
    assert_true(100 * wrong <= 12 * side);
    rlf_reconstruct_destroy(&stage);
}

TEST_CASE(a_plate_has_no_side)
{
    seen_view *f = *state;
    set_wall(f);
    add_block(f, (block){-1.50, -1.40, 3.2, 3.2});
    score s = judge(f);
    print_message("front %d of %d wrong\n", s.front_wrong, s.front);
    assert_int_equal(s.side, 0);
    assert_true(50 * s.front_wrong <= s.front);
}

static bool is_wall(const seen_view *f, int i)
{
    return f->truth[i] > wall - 0.01;
}

TEST_CASE(the_wall_shows_in_a_slit)
{
    seen_view *f = *state;
    set_wall(f);
    add_block(f, (block){-1.50, -1.44, 3.2, 3.2});
    add_block(f, (block){-1.408, -1.34, 3.2, 3.2});
    rlf_reconstruct *stage = NULL;
    const rlf_surface *s = watch(f, &stage);
    int slit = 0, wrong = 0;
    for (int i = 12 * WIDTH + 3; i < COUNT - 12 * WIDTH; i++) {
        bool left = is_wall(f, i) && is_wall(f, i - 1) && !is_wall(f, i - 2) && !is_wall(f, i + 3);
        bool right = is_wall(f, i) && is_wall(f, i + 1) && !is_wall(f, i + 2) && !is_wall(f, i - 3);
        bool in_slit = left || right;
        slit += in_slit;
        wrong += in_slit && !(s->depth[i] > wall - 0.05 && s->depth[i] < wall + 0.05);
    }
    assert_true(slit > 0 && 20 * wrong <= slit);
    rlf_reconstruct_destroy(&stage);
}

TEST_GROUP(set_up, seen_view_destroy)
