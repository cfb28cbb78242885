/* The synthetic room: what it says is true agrees with itself, and the same def gives the same
 * bits.
 */

#include "heavy.h"
#include "sim/scene.h"
#include "created.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define WIDTH 512
#define HEIGHT 424
#define PIXELS (WIDTH * HEIGHT)

static rlf_vec3 ray_of(const rlf_camera *camera, int i)
{
    return rlf_vec3_make((i % WIDTH - camera->cx) / camera->fx,
                         (i / WIDTH - camera->cy) / camera->fy, 1.0);
}

static rlf_vec3 normal_of(const rlf_truth *truth, int i)
{
    return rlf_vec3_make(truth->normal_x[i], truth->normal_y[i], truth->normal_z[i]);
}

static bool is_shell(int32_t label)
{
    return label <= RLF_SYNTHETIC_LABEL_COLUMN;
}

/* Every 7th pixel of a frame: the truth planes against the distance to the scene. */
static void check_truth(rlf_source *source, const rlf_frame *frame)
{
    const rlf_truth *truth = rlf_source_get_truth(source);
    int label_count = 0;
    int agree_count = 0;
    for (int i = 0; i < PIXELS; i += 7) {
        rlf_vec3 m = ray_of(&frame->rig->depth, i);
        rlf_vec3 n = normal_of(truth, i);
        rlf_vec3 p = rlf_scale(m, truth->depth[i]);
        assert_true(truth->depth[i] > 0.3f);
        assert_float_equal(rlf_length(n), 1.0, 1e-5);
        assert_true(rlf_dot(n, m) < 1e-4);
        double distance;
        rlf_vec3 normal;
        int32_t label;
        assert_int_equal(rlf_synthetic_distance(source, p, &distance, &normal, &label), RLF_OK);
        assert_float_equal(distance, 0.0, 1e-4);
        label_count++;
        agree_count += label == truth->label[i] && rlf_dot(normal, n) > 0.999;
        assert_int_equal(truth->foreground[i], truth->label[i] >= RLF_SYNTHETIC_LABEL_PERSON);
        if (truth->foreground[i] != 0) {
            assert_true(truth->depth[i] < truth->background_depth[i]);
        } else {
            assert_true(truth->depth[i] == truth->background_depth[i]);
        }
        if (is_shell(truth->label[i])) {
            assert_true(truth->thickness[i] == 0.0f);
            continue;
        }
        rlf_vec3 exit = rlf_scale(m, (double)truth->depth[i] + truth->thickness[i]);
        rlf_synthetic_distance(source, exit, &distance, &normal, &label);
        assert_true(distance < 1e-3);
        rlf_synthetic_distance(source, rlf_mad(exit, m, 2e-3), &distance, &normal, &label);
        assert_true(distance > -2e-3 || label != truth->label[i]);
    }
    /* at creases and where solids touch, either one may be nearest */
    assert_true(agree_count > 0.99 * label_count);
}

TEST_CASE(truth_agrees_with_the_distance_to_the_scene)
{
    static const char *const texts[] = {"synthetic:room?color=0", "synthetic:thesis?color=0",
                                        "synthetic:book?color=0", "synthetic:hand?color=0"};
    for (int k = 0; k < heavy(4, 2); k++) {
        rlf_source *source = synthetic_named(texts[k], NULL);
        for (uint64_t at = 0; at <= 180; at += 60) {
            rlf_frame frame = frame_at(source, at);
            check_truth(source, &frame);
        }
        rlf_source_destroy(&source);
    }
}

TEST_CASE(without_noise_depth_is_truth_in_millimetres)
{
    rlf_source *source = synthetic_named("synthetic:room?noise=0&color=0", NULL);
    for (uint64_t at = 0; at <= 120; at += 60) {
        rlf_frame frame = frame_at(source, at);
        const rlf_truth *truth = rlf_source_get_truth(source);
        assert_true(frame.depth_units_per_metre == 1000.0);
        assert_null(frame.color.data);
        for (int i = 0; i < PIXELS; i++) {
            double mm = 1000.0 * truth->depth[i];
            bool is_inside = mm >= 500.0 && mm <= 4500.0;
            assert_true(is_inside ? fabs(frame.depth_u16[i] - mm) <= 0.501
                                  : frame.depth_u16[i] == 0);
        }
    }
    rlf_source_destroy(&source);
}

TEST_CASE(the_ball_is_two_radii_thick)
{
    rlf_source *source = synthetic_named("synthetic:empty?color=0", NULL);
    rlf_frame frame = frame_at(source, 0);
    const rlf_truth *truth = rlf_source_get_truth(source);
    double thickest = 0.0;
    for (int i = 0; i < PIXELS; i++) {
        if (truth->label[i] == RLF_SYNTHETIC_LABEL_BALL) {
            double chord = truth->thickness[i] * rlf_length(ray_of(&frame.rig->depth, i));
            thickest = rlf_max(thickest, chord);
        }
    }
    assert_float_equal(thickest, 0.28, 5e-4);
    assert_int_equal(truth->pose_count, 0);
    rlf_source_destroy(&source);
}

/* A point of a moving surface keeps distance 0: d(distance)/dt = -n.v at a fixed point. */
TEST_CASE(velocity_is_what_the_distance_field_does)
{
    static synth_scene scene;
    const double h = 1e-4;
    synth_scene_build(&scene, RLF_SYNTHETIC_ROOM);
    rlf_source *source = synthetic_named("synthetic:room?color=0", NULL);
    int count = 0;
    int good = 0;
    double fastest = 0.0;
    for (uint64_t at = 50; at <= 260; at += 35) {
        rlf_frame frame = frame_at(source, at);
        const rlf_truth *truth = rlf_source_get_truth(source);
        for (int i = 0; i < PIXELS; i += 37) {
            rlf_vec3 v =
                rlf_vec3_make(truth->velocity_x[i], truth->velocity_y[i], truth->velocity_z[i]);
            if (truth->foreground[i] == 0) {
                assert_true(rlf_length(v) == 0.0);
                continue;
            }
            rlf_vec3 p = rlf_scale(ray_of(&frame.rig->depth, i), truth->depth[i]);
            rlf_vec3 n;
            double before;
            double after;
            synth_scene_move(&scene, (double)at / 30.0 - h);
            synth_nearest(scene.movers, scene.mover_count, p, &before, &n);
            synth_scene_move(&scene, (double)at / 30.0 + h);
            synth_nearest(scene.movers, scene.mover_count, p, &after, &n);
            double rate = (after - before) / (2.0 * h);
            count++;
            good += fabs(rate + rlf_dot(normal_of(truth, i), v)) < 0.02;
            fastest = rlf_max(fastest, rlf_length(v));
        }
    }
    rlf_source_destroy(&source);
    assert_true(count > 500);
    assert_true(good > 0.98 * count);
    assert_true(fastest > 0.5 && fastest < 5.0);
}

TEST_CASE(the_room_is_empty_at_first)
{
    static const char *const texts[] = {"synthetic:room", "synthetic:thesis", "synthetic:book",
                                        "synthetic:hand"};
    for (size_t k = 0; k < 4; k++) {
        char text[64];
        (void)snprintf(text, sizeof(text), "%s?color=0", texts[k]);
        rlf_source *source = synthetic_named(text, NULL);
        int first = 0;
        for (int frame = 0; frame < 120 && first == 0; frame++) {
            (void)frame_at(source, (uint64_t)frame);
            const rlf_truth *truth = rlf_source_get_truth(source);
            for (int i = 0; i < PIXELS; i++) {
                first = truth->foreground[i] != 0 && first == 0 ? frame : first;
            }
        }
        assert_in_range(first, 10, 100);
        rlf_source_destroy(&source);
    }
}

TEST_CASE(the_chair_is_taken_away)
{
    rlf_source *source = synthetic_named("synthetic:chair?color=0", NULL);
    int32_t before = 0;
    int32_t after = 0;
    (void)frame_at(source, 119);
    const rlf_truth *truth = rlf_source_get_truth(source);
    for (int i = 0; i < PIXELS; i++) {
        before += truth->label[i] == RLF_SYNTHETIC_LABEL_CHAIR;
    }
    (void)frame_at(source, 120);
    truth = rlf_source_get_truth(source);
    for (int i = 0; i < PIXELS; i++) {
        after += truth->label[i] == RLF_SYNTHETIC_LABEL_CHAIR;
        assert_true(truth->foreground[i] != 0 || truth->depth[i] == truth->background_depth[i]);
    }
    assert_true(before > 500);
    assert_int_equal(after, 0);
    assert_int_equal(rlf_source_restart(source), RLF_OK);
    (void)frame_at(source, 0);
    truth = rlf_source_get_truth(source);
    for (int i = 0; i < PIXELS; i++) {
        after += truth->label[i] == RLF_SYNTHETIC_LABEL_CHAIR;
    }
    assert_true(after > 500);
    rlf_source_destroy(&source);
}

/* Limbs do not slide or sink: at every moment one foot is on the floor, none is below it, and a
 * foot on the floor is at rest. */
static void check_feet(uint64_t person)
{
    static synth_scene scene;
    synth_scene_build(&scene, RLF_SYNTHETIC_ROOM);
    synth_scene_set_people(&scene, person);
    for (int k = 0; k < 1000; k++) {
        synth_scene_move(&scene, 0.01 * k);
        double lowest = 1.0;
        for (int32_t i = 0; i < scene.mover_count; i++) {
            const synth_part *part = &scene.movers[i];
            assert_true(rlf_length(part->velocity) < 6.0);
            if (strncmp(part->name, "foot", 4) != 0) {
                continue;
            }
            for (int end = 0; end < 2; end++) {
                rlf_vec3 p = rlf_transform(&part->shape.T_camera_shape,
                                           rlf_vec3_make(0, end * part->shape.length, 0));
                double gap = scene.floor_y - p.y - part->shape.radius_a;
                assert_true(gap > -0.012);
                lowest = rlf_min(lowest, gap);
            }
        }
        assert_true(lowest < 0.012);
    }
}

/* Cameras know no truth: it is made when it is asked for, whatever was asked before. */
TEST_CASE(truth_does_not_depend_on_when_it_was_asked_for)
{
    rlf_source *often = synthetic_named("synthetic:chair?color=0", NULL);
    rlf_source *seldom = synthetic_named("synthetic:chair?color=0", NULL);
    for (uint64_t i = 90; i < 130; i++) {
        (void)frame_at(often, i);
        (void)frame_at(seldom, i);
        const rlf_truth *all = rlf_source_get_truth(often);
        if (i % 13 != 0) {
            continue;
        }
        const rlf_truth *some = rlf_source_get_truth(seldom);
        assert_ptr_equal(rlf_source_get_truth(seldom), some);
        assert_memory_equal(some->label, all->label, PIXELS * sizeof(*some->label));
        assert_memory_equal(some->foreground, all->foreground, PIXELS);
        assert_memory_equal(some->thickness, all->thickness, PIXELS * sizeof(float));
        assert_memory_equal(some->normal_z, all->normal_z, PIXELS * sizeof(float));
        assert_memory_equal(some->velocity_x, all->velocity_x, PIXELS * sizeof(float));
    }
    rlf_source_destroy(&often);
    rlf_source_destroy(&seldom);
}

TEST_CASE(feet_carry_the_person)
{
    for (uint64_t person = 1; person <= 8; person++) {
        check_feet(person);
    }
}

/* Person 1 is the adult that the table describes; the others are as tall and as broad as people
 * are, no two alike. */
TEST_CASE(people_differ)
{
    enum { PEOPLE = 400 };
    synth_figure figure, second;
    synth_figure_make(&figure, 1, false);
    assert_memory_equal(figure.flesh, synth_person_flesh, sizeof(figure.flesh));
    double sum = 0.0, square = 0.0;
    for (uint64_t person = 2; person < 2 + PEOPLE; person++) {
        synth_figure_make(&figure, person, false);
        synth_figure_make(&second, person, true);
        double stature = 1.75 * (0.925 * figure.leg + 0.58 * figure.trunk) / (0.925 + 0.58);
        double waist = 2.0 * figure.flesh[1].size.x / stature;
        assert_true(stature > 1.499 && stature < 1.951);
        assert_true(waist > 0.13 && waist < 0.26);
        assert_true(figure.pace > 0.7 && figure.pace < 1.3);
        assert_memory_not_equal(figure.flesh, second.flesh, sizeof(figure.flesh));
        sum += stature;
        square += stature * stature;
    }
    double mean = sum / PEOPLE, deviation = sqrt(square / PEOPLE - mean * mean);
    assert_true(mean > 1.67 && mean < 1.71);
    assert_true(deviation > 0.07 && deviation < 0.10);
}

static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * 1099511628211u;
    }
    return hash;
}

/* FNV-1a of depth, colour and truth of some frames. */
static uint64_t hash_frames(rlf_source *source)
{
    uint64_t hash = 14695981039346656037u;
    static const uint64_t frames[] = {0, 45, 46, 120};
    for (size_t k = 0; k < 4; k++) {
        rlf_frame frame = frame_at(source, frames[k]);
        const rlf_truth *truth = rlf_source_get_truth(source);
        hash = hash_bytes(hash, frame.depth_u16, PIXELS * sizeof(uint16_t));
        hash = hash_bytes(hash, frame.color.data,
                          (size_t)frame.color.height * (size_t)frame.color.stride);
        hash = hash_bytes(hash, truth->depth, PIXELS * sizeof(float));
        hash = hash_bytes(hash, truth->normal_y, PIXELS * sizeof(float));
        hash = hash_bytes(hash, truth->thickness, PIXELS * sizeof(float));
        hash = hash_bytes(hash, truth->velocity_x, PIXELS * sizeof(float));
        hash = hash_bytes(hash, truth->label, PIXELS * sizeof(int32_t));
    }
    return hash;
}

TEST_CASE(same_def_gives_the_same_bits)
{
    rlf_pool *pool = pool_of(3);
    rlf_source *one = synthetic_named("synthetic:room?color=320x180", NULL);
    rlf_source *three = synthetic_named("synthetic:room?color=320x180", pool);
    rlf_source *other = synthetic_named("synthetic:room?color=320x180&seed=2", NULL);
    uint64_t hash = hash_frames(one);
    uint64_t allocations = rlf_alloc_count();
    assert_true(hash_frames(three) == hash);
    assert_true(hash_frames(other) != hash);
    assert_int_equal(rlf_source_restart(one), RLF_OK);
    assert_null(rlf_source_get_truth(one));
    assert_true(hash_frames(one) == hash);
    assert_true(rlf_alloc_count() == allocations); /* frames allocate nothing */
    rlf_source_destroy(&one);
    rlf_source_destroy(&three);
    rlf_source_destroy(&other);
    rlf_pool_destroy(&pool);
}

TEST_CASE(time_and_end_follow_the_def)
{
    rlf_source *source = synthetic_named("synthetic:empty?color=0&fps=50&frames=3", NULL);
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_string_equal(info->name, "synthetic:empty");
    assert_int_equal(info->frame_count, 3);
    assert_false(info->is_live);
    assert_false(info->rig.has_color);
    rlf_frame frame;
    for (int i = 0; i < 3; i++) {
        frame = frame_of(source);
        assert_int_equal(frame.sequence, i);
        assert_int_equal(frame.time_ns, i * 20000000);
    }
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    rlf_source_destroy(&source);
}

/* The picture is the empty room again where nobody is, and the rig is the documented one. */
TEST_CASE(colour_restores_what_the_person_covered)
{
    rlf_source *room = synthetic_named("synthetic:room?color=240x135", NULL);
    rlf_source *empty = synthetic_named("synthetic:empty?color=240x135", NULL);
    size_t size = 240 * 135 * 4;
    rlf_frame now = frame_at(room, 0);
    rlf_frame still = frame_at(empty, 0);
    assert_memory_equal(now.color.data, still.color.data, size);
    now = frame_at(room, 120);
    assert_memory_not_equal(now.color.data, still.color.data, size);
    now = frame_at(room, 299); /* gone again */
    assert_memory_equal(now.color.data, still.color.data, size);
    assert_float_equal(now.rig->T_color_depth.p.x, -0.052, 0.0);
    assert_float_equal(now.rig->color.fx, 1081.0 / 8.0, 1e-12);
    rlf_source_destroy(&room);
    rlf_source_destroy(&empty);
}

static rlf_result no_frame(void *self, rlf_frame *out)
{
    (void)self;
    (void)out;
    return RLF_END;
}

TEST_CASE(distance_needs_a_synthetic_source)
{
    rlf_source_info info = {.name = "other"};
    info.rig.depth = (rlf_camera){.width = 2, .height = 2, .fx = 1, .fy = 1};
    rlf_source_methods methods = {.next = no_frame};
    rlf_source *source = NULL;
    double distance;
    assert_int_equal(rlf_source_create_custom(&methods, &info, NULL, &source), RLF_OK);
    assert_int_equal(rlf_synthetic_distance(source, rlf_vec3_make(0, 0, 1), &distance, NULL, NULL),
                     RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "other"));
    rlf_source_destroy(&source);
    source = synthetic_named("synthetic:thesis?color=0", NULL);
    assert_int_equal(rlf_synthetic_distance(source, rlf_vec3_make(0, 0, 1), &distance, NULL, NULL),
                     RLF_OK);
    assert_float_equal(distance, 1.25, 1e-12); /* the floor */
    rlf_source_destroy(&source);
}
