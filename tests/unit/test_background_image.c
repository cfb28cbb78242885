/* The published background: made a few tiles a frame, it is what one made at once would be. */

#include "surface/objects/objects.h" /* before the names of painted.h */
#include "surface/steps.h"

#include "heavy.h"
#include "painted.h"
#include "test.h"

enum { WIDTH = 330, HEIGHT = 230, COUNT = WIDTH * HEIGHT, TILES = 4 * 3 };

static analytic_random noise;

static void begin(uint64_t seed)
{
    const rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    start_seeing(&def);
    noise = (analytic_random){seed};
    assert_int_equal(background_image_tiles(&stage->grid), TILES);
}

/* Of two walls that meet in a corner. */
static double corner_depth(int i, double away)
{
    const rlf_vec3 left = {0.6, 0.0, -0.8}, right = {-0.6, 0.0, -0.8};
    double x = (i % WIDTH - rig.depth.cx) / rig.depth.fx;
    double y = (i / WIDTH - rig.depth.cy) / rig.depth.fy;
    return rlf_min(plane_depth(left, -1.6 - away, x, y), plane_depth(right, -1.6 - away, x, y));
}

static void sense(int i, double z)
{
    depth[i] = (float)(z + rlf_depth_noise_sigma(&rig.noise, z) * random_normal(&noise));
}

/* The corner, `away` farther than at first. */
static const rlf_surface *step(double away)
{
    for (int i = 0; i < COUNT; i++) {
        sense(i, corner_depth(i, away));
    }
    return see();
}

/* Cosine of the angle between two normals; 1 where both are missing. */
static double agreement(const rlf_surface *s, float *const whole[3], int32_t i)
{
    rlf_vec3 a = {s->background_normal_x[i], s->background_normal_y[i], s->background_normal_z[i]};
    rlf_vec3 b = {whole[0][i], whole[1][i], whole[2][i]};
    return rlf_length(a) == 0.0 && rlf_length(b) == 0.0 ? 1.0 : rlf_dot(a, b);
}

TEST_CASE(tiles_make_the_same_normals_as_the_whole)
{
    begin(5);
    stage->def.enable_edge_normals = false; /* those of the frames are not the model's */
    const rlf_surface *s = NULL;
    for (int t = 0; t < 90; t++) {
        s = step(0.0);
    }
    static float planes[3][COUNT];
    float *const whole[3] = {planes[0], planes[1], planes[2]};
    rlf_compute_normals(RLF_NORMALS_INVERSE_DEPTH, true, WIDTH, HEIGHT, s->ray_x, s->ray_y,
                        s->background_depth, &s->noise, whole[0], whole[1], whole[2]);
    int differ = 0;
    for (int i = 0; i < COUNT; i++) {
        differ += agreement(s, whole, i) < 0.99996; /* half a degree */
    }
    assert_true(differ * 1000 < COUNT);
}

/* The first image is the mean of five frames; the last one of many. */
TEST_CASE(means_get_better_without_a_change)
{
    heavy_needs_whole(); /* the other tests run the same code */
    begin(6);
    double sum[2] = {0.0, 0.0};
    for (int t = 0; t < 90; t++) {
        const rlf_surface *s = step(0.0);
        for (int i = 0; (t == 4 || t == 89) && i < COUNT; i++) {
            if (i % WIDTH > WIDTH / 2 - 20 && i % WIDTH < WIDTH / 2 + 20) {
                continue; /* the corner */
            }
            double off = s->background_normal_x[i] * s->background_normal_x[i] - 0.36;
            sum[t == 89] += off * off;
        }
    }
    assert_true(sum[1] < 0.5 * sum[0]);
}

static int32_t tiles_made(const int32_t *before)
{
    int32_t made = 0;
    for (int tile = 0; tile < TILES; tile++) {
        made += stage->background.version[tile] != before[tile];
    }
    return made;
}

/* The whole room steps back: everything is replaced, soon, but not in one frame. */
TEST_CASE(no_frame_makes_more_than_its_share)
{
    begin(7);
    for (int t = 0; t < 90; t++) {
        step(0.0);
    }
    int32_t before[TILES], total = 0;
    for (int t = 90; t < 100; t++) {
        memcpy(before, stage->background.version, sizeof before);
        const rlf_surface *s = step(0.5);
        int32_t made = tiles_made(before);
        assert_true(made <= 1 + TILES / 5);
        total += made;
        if (t == 99) {
            assert_true(total >= TILES);
            for (int i = 0; i < COUNT; i++) {
                double z = depth[i];
                assert_true(rlf_max(s->background_depth[i] - z, z - s->background_depth[i]) < 0.1);
            }
        }
    }
}

/* The regions of a image cost as much as all its tiles: no frame finds them all, nor makes tiles
 * beside a part of that. Only what leaves is shown at once. */
TEST_CASE(regions_take_several_frames)
{
    begin(11);
    const rlf_background *background = &stage->background;
    int32_t before[TILES], images = 0;
    for (int t = 0; t < 90; t++) {
        int32_t steps = background->object_steps, newest = background->newest;
        bool is_made = background->is_made;
        memcpy(before, background->version, sizeof before);
        step(0.0);
        bool is_new = newest >= 0 && background->newest != newest;
        assert_true(!is_new || (is_made && steps == RLF_OBJECT_STEPS));
        assert_true(is_new || background->object_steps <= steps + 1);
        assert_true(!is_made || tiles_made(before) == 0);
        images += is_new;
    }
    assert_true(images >= 2);
}

static double sum_of(const rlf_surface *s)
{
    double sum = 0.0;
    for (int i = 0; i < COUNT; i++) {
        sum += s->background_depth[i] * (1.0 + i % 7) + s->background_normal_x[i];
        sum += s->background_label[i];
    }
    return sum;
}

/* Tiles are made in a image that no valid surface shows. */
TEST_CASE(valid_surfaces_keep_their_background)
{
    heavy_needs_whole(); /* the other tests run the same code */
    begin(8);
    const rlf_surface *s[RLF_RECONSTRUCT_SURFACES] = {NULL};
    double sum[RLF_RECONSTRUCT_SURFACES] = {0.0};
    for (int t = 0; t < 60; t++) {
        int now = t % RLF_RECONSTRUCT_SURFACES;
        s[now] = step(t < 30 ? 0.0 : 0.02 * (t - 30));
        sum[now] = sum_of(s[now]);
        for (int k = 0; k < RLF_RECONSTRUCT_SURFACES; k++) {
            assert_true(s[k] == NULL || sum_of(s[k]) == sum[k]);
        }
    }
}

/* Early on, something small leaves: one tile changes, and the others stay in the new image. */
TEST_CASE(one_tile_changes_alone)
{
    begin(9);
    int32_t images = 0;
    for (int t = 0; t < 38; t++) {
        for (int i = 0; i < COUNT; i++) {
            bool is_thing = t < 8 && is_in((area){30, 42, 30, 42}, i);
            sense(i, corner_depth(i, 0.0) - (is_thing ? 0.4 : 0.0));
        }
        int32_t newest = stage->background.newest;
        const rlf_surface *s = see();
        images += stage->background.newest != newest;
        for (int i = 0; i < COUNT && s->background_state == RLF_BACKGROUND_READY; i++) {
            assert_true(s->background_depth[i] > 0.0f);
        }
    }
    assert_true(images >= 2); /* the first one, and one without the thing */
}

/* In each frame one of three small patches steps back: that must not keep the others waiting. */
TEST_CASE(a_sheet_is_finished_while_something_changes)
{
    enum { SIDE = 6 };
    begin(10);
    int32_t images = 0;
    for (int t = 0; t < 80; t++) {
        for (int i = 0; i < COUNT; i++) {
            int x = i % WIDTH - 40, y = i / WIDTH - 40, patch = x / BACKGROUND_TILE;
            bool is_patch = x >= 0 && y >= 0 && y < SIDE && patch < 3 && x % BACKGROUND_TILE < SIDE;
            double z = 1.5 + (is_patch && t > 8 ? 0.1 * ((t + patch) / 3) : 0.0);
            sense(i, z);
        }
        int32_t newest = stage->background.newest;
        see();
        images += stage->background.newest != newest;
    }
    assert_true(images >= 4); /* one of five frames, and better ones */
}

TEST_EACH(NULL, stop_seeing)
