/* Background and foreground: the thesis's average, and the model by observation. */

#include "painted.h"
#include "test.h"

enum { WIDTH = 96, HEIGHT = 72, COUNT = WIDTH * HEIGHT, MIDDLE = 30 * WIDTH + 40 };

static void begin(rlf_profile profile, rlf_background_method method)
{
    see_size(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(profile, &rig);
    def.enable_smoothing = false; /* the background's own arithmetic, not the planes' */
    def.enable_steadying = false;
    def.scale_factor = 1;
    def.background_method = method;
    def.min_region_points = 8;
    def.segment_tau_m = 0.1;
    start_seeing(&def);
}

static void begin_average(void)
{
    begin(RLF_PROFILE_THESIS, RLF_BACKGROUND_AVERAGE);
}

static void begin_adaptive(void)
{
    begin(RLF_PROFILE_LIVE, RLF_BACKGROUND_ADAPTIVE);
}

static const rlf_surface *see_wall(float z, int32_t frames)
{
    paint_all(z);
    return see_often(frames);
}

static void box(int x0, int x1, float z)
{
    paint((area){x0, x1, 20, 50}, z);
}

static bool in_box(int i, int x0, int x1)
{
    return is_in((area){x0, x1, 20, 50}, i);
}

TEST_CASE(average_is_the_mean_of_the_valid_samples)
{
    begin_average();
    const rlf_surface *s = NULL;
    for (int t = 0; t < 5; t++) {
        paint_all(3.0f + 0.01f * (float)t);
        depth[7] = t < 3 ? 0.0f : 2.0f + (float)t; /* seen twice: 5 (too far) and 6 (too far) */
        depth[8] = t < 3 ? 0.0f : 2.0f + 0.2f * (float)t;
        depth[9] = 0.0f;
        s = see();
        assert_int_equal(s->foreground_count, 0);
        assert_int_equal(s->background_state,
                         t < 4 ? RLF_BACKGROUND_LEARNING : RLF_BACKGROUND_READY);
        assert_true(s->background_depth[0] == 0.0f || t == 4);
    }
    assert_float_equal(s->background_depth[0], 3.02, 1e-5);
    assert_float_equal(s->background_depth[8], 2.7, 1e-5);
    assert_true(s->background_depth[7] == 0.0f && s->background_depth[9] == 0.0f);
    assert_true(s->background_normal_z[40 * WIDTH + 40] < -0.999f);
    assert_int_equal(s->region_count, 1);
    assert_int_equal(s->regions[0].layer, RLF_LAYER_BACKGROUND);
    paint_all(3.02f);
    depth[9] = 2.0f; /* no background there: the difference does not exist */
    s = see();
    assert_int_equal(s->foreground[9], 0);
}

TEST_CASE(foreground_is_what_differs_and_one_region)
{
    begin_average();
    see_wall(3.0f, 5);
    box(10, 30, 2.0f);
    box(50, 60, 1.5f);
    box(70, 80, 3.2f); /* farther counts too: |dz| */
    box(82, 90, 3.02f);
    const rlf_surface *s = see();
    int32_t regions = 0;
    for (int i = 0; i < COUNT; i++) {
        bool front = in_box(i, 10, 30) || in_box(i, 50, 60) || in_box(i, 70, 80);
        assert_int_equal(s->foreground[i], front);
        assert_float_equal(s->background_depth[i], 3.0, 1e-6);
    }
    const rlf_region *person = NULL;
    for (int32_t r = 0; r < s->region_count; r++) {
        if (s->regions[r].layer == RLF_LAYER_FOREGROUND) {
            person = &s->regions[r];
            regions++;
        }
    }
    assert_int_equal(regions, 1);
    assert_int_equal(person->point_count, 30 * (20 + 10 + 10));
    assert_int_equal(person->point_count, s->foreground_count);
    for (int i = 0; i < COUNT; i++) {
        assert_true((s->label[i] == person->label) == (s->foreground[i] != 0));
    }
    assert_float_equal(person->box.min.z, 1.5, 1e-6);
}

/* The foreground's point cloud is normal-mapped by itself: inside it the normal is its own, at its
 * rim the neighbours are missing; behind it the stored background's. */
TEST_CASE(thesis_normals_are_per_layer)
{
    begin_average();
    see_wall(3.0f, 5);
    box(10, 30, 2.0f);
    const rlf_surface *s = see();
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        bool rim = in_box(i, 10, 30) && (x == 10 || x == 29 || y == 20 || y == 49);
        assert_true(rim ? s->normal_z[i] == 0.0f : s->normal_z[i] < -0.999f);
        assert_true(s->background_normal_z[i] < -0.999f);
    }
}

TEST_CASE(several_people_are_several_regions_when_asked)
{
    see_size(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_THESIS, &rig);
    def.scale_factor = 1;
    def.segment_tau_m = 0.1;
    def.foreground_segment = RLF_SEGMENT_THESIS;
    start_seeing(&def);
    see_wall(3.0f, 5);
    box(10, 30, 2.0f);
    box(40, 60, 1.5f);
    const rlf_surface *s = see();
    assert_int_equal(s->region_count, 3);
    int32_t a = s->label[30 * WIDTH + 20], b = s->label[30 * WIDTH + 50];
    int32_t background = s->background_label[30 * WIDTH + 20];
    assert_true(a > 0 && b > 0 && background > 0 && a != b && a != background && b != background);
    for (int i = 0; i < COUNT; i++) { /* eq. 4.4 looks right and down: those rims are lost */
        int x = i % WIDTH, y = i / WIDTH;
        bool lost = s->foreground[i] && (x == 29 || x == 59 || y == 49);
        int32_t own = x < 35 ? a : b;
        assert_true(!s->foreground[i] || s->label[i] == (lost ? 0 : own));
    }
}

TEST_CASE(adaptive_foreground_is_one_sided_and_noise_scaled)
{
    begin_adaptive();
    see_wall(3.0f, 6);
    box(10, 30, 2.0f);
    box(40, 60, 3.0f - 0.015f); /* below 6 sigma and 20 mm */
    box(70, 80, 3.5f);          /* farther: never foreground */
    const rlf_surface *s = see();
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        bool corner = (x == 10 || x == 29) && (y == 20 || y == 49); /* 3x3 majority */
        assert_true(corner || s->foreground[i] == in_box(i, 10, 30));
    }
}

/* A thing that was there from the start and leaves: seen beyond for three frames, it is gone. */
TEST_CASE(what_left_leaves_no_phantom)
{
    begin_adaptive();
    paint_all(3.0f);
    box(30, 60, 2.0f);
    const rlf_surface *s = see_often(10);
    assert_float_equal(s->background_depth[MIDDLE], 2.0, 1e-6);
    for (int t = 10; t < 13; t++) {
        s = see_wall(3.0f, 1);
        assert_int_equal(s->foreground_count, 0);
    }
    for (int i = 0; i < COUNT; i++) {
        assert_float_equal(s->background_depth[i], 3.0, 1e-6);
    }
    /* the returning thing is foreground now */
    box(30, 60, 2.0f);
    s = see();
    assert_int_equal(s->foreground[MIDDLE], 1);
}

/* Someone stands in the room while it is learnt, and moves: what he uncovers is background. */
TEST_CASE(the_room_need_not_be_empty)
{
    begin_adaptive();
    const rlf_surface *s = NULL;
    for (int t = 0; t < 5; t++) {
        paint_all(3.0f);
        box(10 + 12 * t, 22 + 12 * t, 1.5f);
        s = see();
    }
    for (int i = 0; i < COUNT; i++) {
        assert_float_equal(s->background_depth[i], 3.0, 1e-6);
    }
}

TEST_CASE(holes_of_the_background_are_filled_as_they_are_seen)
{
    begin_adaptive();
    paint_all(3.0f);
    paint((area){40, 80, 50, 70}, 0.0f); /* a hole too wide to be bridged */
    see_often(8);
    const rlf_surface *s = see_wall(3.0f, 42);
    /* large and new: it was foreground at first, and is not for ever */
    assert_true(s->background_depth[10 * WIDTH + 10] > 2.9f);
    s = see_often(250);
    assert_float_equal(s->background_depth[60 * WIDTH + 60], 3.0, 1e-5);
    assert_int_equal(s->foreground_count, 0);
}

/* A box is put down: foreground for two seconds, then background; taken away, the wall is back at
 * once. Someone who walks past meanwhile is foreground. */
TEST_CASE(what_stands_still_becomes_background)
{
    rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    assert_float_equal(def.absorb_after_s, 20.0, 0.0);
    def.min_region_points = 8;
    def.absorb_after_s = 2.0;
    start_seeing(&def);
    see_wall(3.0f, 10);
    box(30, 60, 2.0f);
    for (int32_t frame = 10; frame < 65; frame++) {
        assert_int_equal(see()->foreground[MIDDLE], 1);
    }
    const rlf_surface *s = see_often(15);
    assert_int_equal(s->foreground[MIDDLE], 0);
    assert_float_equal(s->background_depth[MIDDLE], 2.0, 1e-3);
    box(35, 45, 1.2f);
    assert_int_equal(see()->foreground[MIDDLE], 1);
    s = see_wall(3.0f, 1);
    assert_int_equal(s->foreground_count, 0);
    assert_float_equal(s->background_depth[MIDDLE], 3.0, 1e-3);
}

/* Two pieces too small to be regions: one beside the box, as a foot behind a table's leg, belongs
 * to it; one by itself is noise. */
TEST_CASE(small_pieces_belong_to_what_is_around_them)
{
    rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    def.min_region_points = 40;
    start_seeing(&def);
    see_wall(3.0f, 6);
    box(30, 50, 2.0f);
    see();
    paint((area){52, 57, 30, 35}, 2.02f);
    paint((area){80, 85, 30, 35}, 2.02f);
    const rlf_surface *s = see();
    const int32_t beside = 32 * WIDTH + 52;
    assert_int_equal(s->foreground[beside], 1);
    assert_int_equal(s->label[beside], s->label[32 * WIDTH + 40]);
    assert_int_equal(s->foreground[32 * WIDTH + 82], 0);
    const rlf_region *region = &s->regions[s->region_count - 1];
    assert_int_equal(region->label, s->label[beside]);
    int32_t count = 0;
    for (int i = 0; i < COUNT; i++) {
        const area box_of_it = {region->x0, region->x1, region->y0, region->y1};
        count += is_in(box_of_it, i) && s->label[i] == region->label;
    }
    assert_int_equal(count, region->point_count);
    assert_int_equal(count, s->foreground_count);
}

TEST_CASE(reset_forgets)
{
    begin_adaptive();
    see_wall(2.0f, 8);
    rlf_reconstruct_reset(stage);
    paint_all(1.0f);
    const rlf_surface *s = see();
    assert_int_equal(s->background_state, RLF_BACKGROUND_LEARNING);
    assert_int_equal(s->foreground_count, 0);
    assert_true(s->background_depth[5] == 0.0f);
    assert_int_equal(s->region_count, 1); /* the wall of this frame */
}

TEST_EACH(NULL, stop_seeing)
