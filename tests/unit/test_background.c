/* Background and foreground: the thesis's average, and the model by observation. */

#include "seen_view.h"
#include "test.h"

enum { WIDTH = 96, HEIGHT = 72, COUNT = WIDTH * HEIGHT };

static float depth[COUNT];

static rlf_reconstruct *make_stage(rlf_profile profile, rlf_background_method method)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(profile, &rig);
    def.enable_smoothing = false; /* the background's own arithmetic, not the planes' */
    def.enable_steadying = false;
    def.scale_factor = 1;
    def.background_method = method;
    def.min_region_points = 8;
    def.segment_tau_m = 0.1;
    return seen_view_stage(&def);
}

static const rlf_surface *process(rlf_reconstruct *stage, int32_t number)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    return seen_depth_process(&rig, depth, stage, number);
}

static void wall(float z)
{
    for (int i = 0; i < COUNT; i++) {
        depth[i] = z;
    }
}

static void box(int x0, int x1, float z)
{
    for (int y = 20; y < 50; y++) {
        for (int x = x0; x < x1; x++) {
            depth[y * WIDTH + x] = z;
        }
    }
}

static bool in_box(int i, int x0, int x1)
{
    return i % WIDTH >= x0 && i % WIDTH < x1 && i / WIDTH >= 20 && i / WIDTH < 50;
}

static void average_is_the_mean_of_the_valid_samples(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_THESIS, RLF_BACKGROUND_AVERAGE);
    const rlf_surface *s = NULL;
    for (int t = 0; t < 5; t++) {
        wall(3.0f + 0.01f * (float)t);
        depth[7] = t < 3 ? 0.0f : 2.0f + (float)t; /* seen twice: 5 (too far) and 6 (too far) */
        depth[8] = t < 3 ? 0.0f : 2.0f + 0.2f * (float)t;
        depth[9] = 0.0f;
        s = process(stage, t);
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
    wall(3.02f);
    depth[9] = 2.0f; /* no background there: the difference does not exist */
    s = process(stage, 5);
    assert_int_equal(s->foreground[9], 0);
    rlf_reconstruct_destroy(&stage);
}

static void foreground_is_what_differs_and_one_region(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_THESIS, RLF_BACKGROUND_AVERAGE);
    for (int t = 0; t < 5; t++) {
        wall(3.0f);
        process(stage, t);
    }
    wall(3.0f);
    box(10, 30, 2.0f);
    box(50, 60, 1.5f);
    box(70, 80, 3.2f); /* farther counts too: |dz| */
    box(82, 90, 3.02f);
    const rlf_surface *s = process(stage, 5);
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
    rlf_reconstruct_destroy(&stage);
}

/* The foreground's point cloud is normal-mapped by itself: inside it the normal is its own, at its
 * rim the neighbours are missing; behind it the stored background's. */
static void thesis_normals_are_per_layer(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_THESIS, RLF_BACKGROUND_AVERAGE);
    for (int t = 0; t < 5; t++) {
        wall(3.0f);
        process(stage, t);
    }
    wall(3.0f);
    box(10, 30, 2.0f);
    const rlf_surface *s = process(stage, 5);
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        bool rim = in_box(i, 10, 30) && (x == 10 || x == 29 || y == 20 || y == 49);
        assert_true(rim ? s->normal_z[i] == 0.0f : s->normal_z[i] < -0.999f);
        assert_true(s->background_normal_z[i] < -0.999f);
    }
    rlf_reconstruct_destroy(&stage);
}

static void several_people_are_several_regions_when_asked(void **state)
{
    (void)state;
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_THESIS, &rig);
    def.scale_factor = 1;
    def.segment_tau_m = 0.1;
    def.foreground_segment = RLF_SEGMENT_THESIS;
    rlf_reconstruct *stage;
    assert_int_equal(rlf_reconstruct_create(&def, &stage), RLF_OK);
    for (int t = 0; t < 5; t++) {
        wall(3.0f);
        process(stage, t);
    }
    box(10, 30, 2.0f);
    box(40, 60, 1.5f);
    const rlf_surface *s = process(stage, 5);
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
    rlf_reconstruct_destroy(&stage);
}

static void adaptive_foreground_is_one_sided_and_noise_scaled(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_LIVE, RLF_BACKGROUND_ADAPTIVE);
    for (int t = 0; t < 6; t++) {
        wall(3.0f);
        process(stage, t);
    }
    box(10, 30, 2.0f);
    box(40, 60, 3.0f - 0.015f); /* below 6 sigma and 20 mm */
    box(70, 80, 3.5f);          /* farther: never foreground */
    const rlf_surface *s = process(stage, 6);
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        bool corner = (x == 10 || x == 29) && (y == 20 || y == 49); /* 3x3 majority */
        assert_true(corner || s->foreground[i] == in_box(i, 10, 30));
    }
    rlf_reconstruct_destroy(&stage);
}

/* A thing that was there from the start and leaves: seen beyond for three frames, it is gone. */
static void what_left_leaves_no_phantom(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_LIVE, RLF_BACKGROUND_ADAPTIVE);
    const rlf_surface *s = NULL;
    for (int t = 0; t < 10; t++) {
        wall(3.0f);
        box(30, 60, 2.0f);
        s = process(stage, t);
    }
    assert_float_equal(s->background_depth[30 * WIDTH + 40], 2.0, 1e-6);
    for (int t = 10; t < 13; t++) {
        wall(3.0f);
        s = process(stage, t);
        assert_int_equal(s->foreground_count, 0);
    }
    for (int i = 0; i < COUNT; i++) {
        assert_float_equal(s->background_depth[i], 3.0, 1e-6);
    }
    /* the returning thing is foreground now */
    box(30, 60, 2.0f);
    s = process(stage, 13);
    assert_int_equal(s->foreground[30 * WIDTH + 40], 1);
    rlf_reconstruct_destroy(&stage);
}

/* Someone stands in the room while it is learnt, and moves: what he uncovers is background. */
static void the_room_need_not_be_empty(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_LIVE, RLF_BACKGROUND_ADAPTIVE);
    const rlf_surface *s = NULL;
    for (int t = 0; t < 5; t++) {
        wall(3.0f);
        box(10 + 12 * t, 22 + 12 * t, 1.5f);
        s = process(stage, t);
    }
    for (int i = 0; i < COUNT; i++) {
        assert_float_equal(s->background_depth[i], 3.0, 1e-6);
    }
    rlf_reconstruct_destroy(&stage);
}

static void holes_of_the_background_are_filled_as_they_are_seen(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_LIVE, RLF_BACKGROUND_ADAPTIVE);
    const rlf_surface *s = NULL;
    int32_t hole = 60 * WIDTH + 60;
    for (int t = 0; t < 50; t++) {
        wall(3.0f);
        for (int y = 0; y < 20 && t < 8; y++) { /* a hole too wide to be bridged */
            for (int x = 0; x < 40; x++) {
                depth[(50 + y) * WIDTH + 40 + x] = 0.0f;
            }
        }
        s = process(stage, t);
    }
    /* large and new: it was foreground at first, and is not for ever */
    assert_true(s->background_depth[10 * WIDTH + 10] > 2.9f);
    for (int t = 50; t < 300; t++) {
        s = process(stage, t);
    }
    assert_float_equal(s->background_depth[hole], 3.0, 1e-5);
    assert_int_equal(s->foreground_count, 0);
    rlf_reconstruct_destroy(&stage);
}

/* A box is put down: foreground for two seconds, then background; taken away, the wall is back at
 * once. Someone who walks past meanwhile is foreground. */
static void what_stands_still_becomes_background(void **state)
{
    (void)state;
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    assert_float_equal(def.absorb_after_s, 20.0, 0.0);
    def.min_region_points = 8;
    def.absorb_after_s = 2.0;
    rlf_reconstruct *stage = NULL;
    assert_int_equal(rlf_reconstruct_create(&def, &stage), RLF_OK);
    const int32_t middle = 30 * WIDTH + 40;
    const rlf_surface *s = NULL;
    int32_t frame = 0;
    for (; frame < 10; frame++) {
        wall(3.0f);
        s = process(stage, frame);
    }
    for (; frame < 65; frame++) {
        wall(3.0f);
        box(30, 60, 2.0f);
        s = process(stage, frame);
        assert_int_equal(s->foreground[middle], 1);
    }
    for (; frame < 80; frame++) {
        s = process(stage, frame);
    }
    assert_int_equal(s->foreground[middle], 0);
    assert_float_equal(s->background_depth[middle], 2.0, 1e-3);
    wall(3.0f);
    box(30, 60, 2.0f);
    box(35, 45, 1.2f);
    s = process(stage, frame++);
    assert_int_equal(s->foreground[middle], 1);
    wall(3.0f);
    s = process(stage, frame++);
    assert_int_equal(s->foreground_count, 0);
    assert_float_equal(s->background_depth[middle], 3.0, 1e-3);
    rlf_reconstruct_destroy(&stage);
}

/* Two pieces too small to be regions: one beside the box, as a foot behind a table's leg, belongs
 * to it; one by itself is noise. */
static void small_pieces_belong_to_what_is_around_them(void **state)
{
    (void)state;
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    def.min_region_points = 40;
    rlf_reconstruct *stage = NULL;
    assert_int_equal(rlf_reconstruct_create(&def, &stage), RLF_OK);
    const rlf_surface *s = NULL;
    for (int t = 0; t < 8; t++) {
        wall(3.0f);
        if (t > 5) {
            box(30, 50, 2.0f);
        }
        for (int k = 0; t > 5 && k < 25; k++) {
            depth[(30 + k / 5) * WIDTH + 52 + k % 5] = t == 6 ? 3.0f : 2.02f;
            depth[(30 + k / 5) * WIDTH + 80 + k % 5] = t == 6 ? 3.0f : 2.02f;
        }
        s = process(stage, t);
    }
    const int32_t beside = 32 * WIDTH + 52;
    assert_int_equal(s->foreground[beside], 1);
    assert_int_equal(s->label[beside], s->label[32 * WIDTH + 40]);
    assert_int_equal(s->foreground[32 * WIDTH + 82], 0);
    const rlf_region *region = &s->regions[s->region_count - 1];
    assert_int_equal(region->label, s->label[beside]);
    int32_t count = 0;
    for (int i = 0; i < COUNT; i++) {
        bool inside = i % WIDTH >= region->x0 && i % WIDTH < region->x1 &&
                      i / WIDTH >= region->y0 && i / WIDTH < region->y1;
        count += inside && s->label[i] == region->label;
    }
    assert_int_equal(count, region->point_count);
    assert_int_equal(count, s->foreground_count);
    rlf_reconstruct_destroy(&stage);
}

static void reset_forgets(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_LIVE, RLF_BACKGROUND_ADAPTIVE);
    for (int t = 0; t < 8; t++) {
        wall(2.0f);
        process(stage, t);
    }
    rlf_reconstruct_reset(stage);
    wall(1.0f);
    const rlf_surface *s = process(stage, 8);
    assert_int_equal(s->background_state, RLF_BACKGROUND_LEARNING);
    assert_int_equal(s->foreground_count, 0);
    assert_true(s->background_depth[5] == 0.0f);
    assert_int_equal(s->region_count, 1); /* the wall of this frame */
    rlf_reconstruct_destroy(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(average_is_the_mean_of_the_valid_samples),
        cmocka_unit_test(foreground_is_what_differs_and_one_region),
        cmocka_unit_test(thesis_normals_are_per_layer),
        cmocka_unit_test(several_people_are_several_regions_when_asked),
        cmocka_unit_test(adaptive_foreground_is_one_sided_and_noise_scaled),
        cmocka_unit_test(what_left_leaves_no_phantom),
        cmocka_unit_test(the_room_need_not_be_empty),
        cmocka_unit_test(holes_of_the_background_are_filled_as_they_are_seen),
        cmocka_unit_test(what_stands_still_becomes_background),
        cmocka_unit_test(small_pieces_belong_to_what_is_around_them),
        cmocka_unit_test(reset_forgets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
