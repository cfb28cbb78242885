/* What stands still becomes room, and nothing else does. */
#include "pipeline/moving/moving.h"
#include "test.h"

#define LABEL 7
#define AFTER_S 2.0
#define STEP_NS 33333333
#define FRAMES 120 /* 4 s */

/* Frames in which a cube at x, half as large as `size` times 0.2 m, was told to be room. */
static int32_t frames_of_room(double (*x_at)(int32_t), double (*size_at)(int32_t), double turn)
{
    absorb a = {.thing_count = 0};
    int32_t count = 0;
    for (int32_t k = 0; k < FRAMES; k++) {
        const rlf_pose T_world_camera = {
            rlf_vec3_make(0.001 * k, 0, 0),
            rlf_quat_from_rotation_vector(rlf_vec3_make(0, turn * k / FRAMES, 0))};
        const rlf_vec3 centre =
            rlf_transform_inverse(&T_world_camera, rlf_vec3_make(x_at(k), 0, 2.0));
        const double half = 0.1 * size_at(k);
        const rlf_vec3 corner = rlf_vec3_make(half, half, half);
        const rlf_region region = {.label = LABEL,
                                   .layer = RLF_LAYER_FOREGROUND,
                                   .centroid = centre,
                                   .box = {rlf_sub(centre, corner), rlf_add(centre, corner)}};
        const rlf_surface surface = {
            .regions = &region, .region_count = 1, .time_ns = (int64_t)k * STEP_NS};
        absorb_update(&a, &surface, &T_world_camera, AFTER_S);
        count += absorb_is_room(&a, LABEL);
        assert_false(absorb_is_room(&a, LABEL + 1));
    }
    return count;
}

static double stands(int32_t k)
{
    return 0.01 * (k % 3);
}

static double walks(int32_t k)
{
    return 0.03 * k;
}

/* To and fro, once a second. */
static double sways(int32_t k)
{
    return 0.2 * (k % 30 < 15 ? k % 15 : 15 - k % 15) / 15.0;
}

static double one(int32_t k)
{
    (void)k;
    return 1.0;
}

/* An arm is held out, now and again. */
static double reaches(int32_t k)
{
    return k % 40 < 20 ? 1.0 : 1.5;
}

/* Half of it is fused already. */
static double shrinks(int32_t k)
{
    return k < 70 ? 1.0 : 0.5;
}

TEST_CASE(what_stands_is_room_after_a_while)
{
    const int32_t due = FRAMES - (int32_t)(AFTER_S * 30.0) - 1;
    assert_int_equal(frames_of_room(stands, one, 0.0), due);
    assert_int_equal(frames_of_room(stands, one, 0.4), due);
    assert_int_equal(frames_of_room(stands, shrinks, 0.0), due);
}

TEST_CASE(what_moves_never_is)
{
    assert_int_equal(frames_of_room(walks, one, 0.0), 0);
    assert_int_equal(frames_of_room(sways, one, 0.0), 0);
    assert_int_equal(frames_of_room(stands, reaches, 0.0), 0);
}
