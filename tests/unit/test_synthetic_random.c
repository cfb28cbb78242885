/* Rooms drawn at random: the same seed gives the same bits, truth agrees with rays cast at it, and
 * every seed gives a room that a camera sees. */

#include "heavy.h"
#include "relief/base.h"
#include "sim/shape.h"
#include "created.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define WIDTH 512
#define HEIGHT 424
#define PIXELS (WIDTH * HEIGHT)

/* FNV-1a over the depth, the colour and the truth of a few frames. */
static uint64_t hash_of(const char *text, rlf_pool *pool)
{
    rlf_source *source = synthetic_named(text, pool);
    uint64_t hash = 14695981039346656037u;
    for (uint64_t at = 0; at <= 100; at += 50) {
        const rlf_frame frame = frame_at(source, at);
        const rlf_truth *truth = rlf_source_get_truth(source);
        for (int i = 0; i < PIXELS; i++) {
            hash = (hash ^ frame.depth_u16[i]) * 1099511628211u;
            hash = (hash ^ (uint64_t)truth->label[i]) * 1099511628211u;
        }
        for (int32_t i = 0; i < 4 * frame.color.width * frame.color.height; i++) {
            hash = (hash ^ ((const uint8_t *)frame.color.data)[i]) * 1099511628211u;
        }
    }
    rlf_source_destroy(&source);
    return hash;
}

TEST_CASE(a_seed_gives_the_same_bits_with_any_number_of_threads)
{
    rlf_pool *pool = pool_of(2);
    const char *const text = "synthetic:random?seed=4&color=96x54";
    const uint64_t once = hash_of(text, NULL);
    assert_true(once == hash_of(text, NULL));
    assert_true(once == hash_of(text, pool));
    assert_true(once != hash_of("synthetic:random?seed=5&color=96x54", NULL));
    rlf_pool_destroy(&pool);
}

/* Depth and label of pixels against rays cast at all parts by themselves. */
static void check_rays(rlf_source *source, const rlf_frame *frame)
{
    const rlf_truth *truth = rlf_source_get_truth(source);
    const rlf_camera *camera = &frame->rig->depth;
    int agree = 0, count = 0;
    for (int i = 0; i < PIXELS; i += 97) {
        const rlf_vec3 ray = {(i % WIDTH - camera->cx) / camera->fx,
                              (i / WIDTH - camera->cy) / camera->fy, 1.0};
        const rlf_vec3 origin = {0, 0, 0},
                       n = {truth->normal_x[i], truth->normal_y[i], truth->normal_z[i]};
        float distance;
        int32_t label;
        assert_int_equal(rlf_synthetic_cast(source, origin, &ray, 1, &distance, &label), RLF_OK);
        const bool is_same = fabs(distance - truth->depth[i]) < 1e-3 && label == truth->label[i];
        agree += is_same;
        count++;
        double off;
        rlf_vec3 normal;
        const rlf_vec3 p = rlf_scale(ray, truth->depth[i]);
        assert_int_equal(rlf_synthetic_distance(source, p, &off, &normal, NULL), RLF_OK);
        assert_true(!is_same || fabs(off) < 2e-3); /* or a part inside another is nearer */
        assert_float_equal(rlf_length(n), 1.0, 1e-4);
        assert_true(rlf_dot(n, ray) < 1e-3);
        const bool is_mover = truth->label[i] >= RLF_SYNTHETIC_LABEL_PERSON &&
                              truth->label[i] < RLF_SYNTHETIC_LABEL_THING;
        assert_true(!is_mover || truth->foreground[i] != 0);
    }
    assert_true(agree > 0.995 * count); /* single precision at silhouettes */
}

TEST_CASE(truth_agrees_with_rays_of_its_own)
{
    for (int seed = 0; seed < heavy(12, 1); seed += 3) {
        char text[64];
        snprintf(text, sizeof(text), "synthetic:random?color=0&seed=%d", seed);
        rlf_source *source = synthetic_named(text, NULL);
        for (uint64_t at = 0; at <= (uint64_t)heavy(120, 60); at += 60) {
            const rlf_frame frame = frame_at(source, at);
            check_rays(source, &frame);
        }
        rlf_source_destroy(&source);
    }
}

TEST_CASE(every_seed_gives_a_room_that_is_seen)
{
    const int seeds = heavy(41, 1);
    int with_people = 0;
    for (int seed = 0; seed < seeds; seed++) {
        char text[64];
        snprintf(text, sizeof(text), "synthetic:random?color=0&seed=%d", seed);
        rlf_source *source = synthetic_named(text, NULL);
        int valid = 0, foreground = 0;
        rlf_frame frame = frame_at(source, 0);
        const rlf_truth *truth = rlf_source_get_truth(source);
        for (int i = 0; i < PIXELS; i++) {
            valid += frame.depth_u16[i] != 0;
            assert_true(truth->depth[i] > 0.6f); /* nothing hangs before the lens */
            assert_int_equal(truth->foreground[i], 0);
        }
        assert_true(valid > 0.3 * PIXELS);
        frame = frame_at(source, 120);
        truth = rlf_source_get_truth(source);
        for (int i = 0; i < PIXELS; i++) {
            foreground += truth->foreground[i];
        }
        with_people += foreground > PIXELS / 200;
        rlf_vec3 down;
        assert_int_equal(rlf_synthetic_get_down(source, &down), RLF_OK);
        assert_float_equal(rlf_length(down), 1.0, 1e-9);
        rlf_source_destroy(&source);
    }
    assert_true(with_people > 0.8 * seeds);
}

/* Until it starts it is a part of the room, then it moves at its speed against gravity. */
TEST_CASE(a_plate_stands_and_rises)
{
    rlf_source *source =
        synthetic_named("synthetic:random?color=0&seed=3&push=lift&speed=0.25", NULL);
    rlf_vec3 down;
    assert_int_equal(rlf_synthetic_get_down(source, &down), RLF_OK);
    (void)frame_at(source, 89);
    const rlf_truth *truth = rlf_source_get_truth(source);
    assert_int_equal(truth->pose_count, 1);
    assert_string_equal(truth->poses[0].name, "plate");
    const rlf_vec3 before = truth->poses[0].T_camera_object.p;
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(truth->foreground[i], 0);
    }
    (void)frame_at(source, 120);
    truth = rlf_source_get_truth(source);
    assert_int_equal(truth->pose_count, 1);
    const rlf_vec3 risen = rlf_sub(truth->poses[0].T_camera_object.p, before);
    assert_float_equal(rlf_dot(risen, down), -0.25, 1e-9);
    assert_float_equal(rlf_length(risen), 0.25, 1e-9);
    int foreground = 0;
    for (int i = 0; i < PIXELS; i++) {
        foreground += truth->foreground[i];
    }
    assert_true(foreground > 500);
    rlf_source_destroy(&source);
}

/* The solid with flat ends: known crossings, and rays against distances. */
TEST_CASE(rays_and_distances_of_a_frustum_agree)
{
    const synth_shape shape = {.type = SYNTH_FRUSTUM,
                               .T_camera_shape = {{0, -0.5, 3}, {0, 0, 0, 1}},
                               .length = 1.0,
                               .radius_a = 0.2,
                               .radius_b = 0.6};
    synth_interval hit;
    synth_ray ray = {{0, 0, 0}, {0, 0, 1}};
    assert_true(synth_shape_intersect(&shape, &ray, &hit));
    assert_float_equal(hit.near, 2.6, 1e-12);
    assert_float_equal(hit.far, 3.4, 1e-12);
    ray = (synth_ray){{0.1, -2, 3}, {0, 1, 0}};
    assert_true(synth_shape_intersect(&shape, &ray, &hit));
    assert_float_equal(hit.near, 1.5, 1e-12);
    assert_float_equal(hit.far, 2.5, 1e-12);
    for (int i = 0; i < 400; i++) {
        const rlf_vec3 target = {0.04 * (i % 20) - 0.4, 0.06 * (i / 20.0) - 0.6, 3.0};
        const synth_ray r = {{0.3, -1.5, 0.5}, rlf_sub(target, rlf_vec3_make(0.3, -1.5, 0.5))};
        if (!synth_shape_intersect(&shape, &r, &hit)) {
            continue;
        }
        const rlf_vec3 p = rlf_mad(r.origin, r.direction, hit.near);
        rlf_vec3 normal;
        assert_float_equal(synth_shape_distance(&shape, p, &normal), 0.0, 1e-9);
        const rlf_vec3 n = synth_shape_normal(&shape, p);
        const rlf_vec3 out = rlf_mad(p, n, 0.01);
        assert_float_equal(synth_shape_distance(&shape, out, &normal), 0.01, 1e-9);
        assert_true(synth_shape_distance(&shape, rlf_mad(p, n, -0.001), &normal) < 0.0);
    }
}
