/* A synthetic camera that moves: its poses and its pictures tell the same story. */

#include "created.h"
#include "test.h"

#include <string.h>

#define WIDTH 512
#define HEIGHT 424

static rlf_frame next_of(rlf_source *source)
{
    rlf_frame frame = frame_of(source);
    assert_true(frame.has_pose);
    return frame;
}

/* Points of the room that a frame's true depth shows, put into the world, lie on the room's
 * surfaces as they stand in the next frame. */
static void check_pair(rlf_source *source)
{
    enum { STEP = 37, MOST = WIDTH * HEIGHT / STEP + 1 };
    static rlf_vec3 world[MOST];
    int32_t count = 0;
    rlf_frame frame = next_of(source);
    const rlf_truth *truth = rlf_source_get_truth(source);
    const rlf_camera *c = &frame.rig->depth;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i += STEP) {
        if (truth->depth[i] > 0.0f && truth->foreground[i] == 0) {
            const double z = (double)truth->depth[i];
            const rlf_vec3 p = {(i % WIDTH - c->cx) / c->fx * z, (i / WIDTH - c->cy) / c->fy * z,
                                z};
            world[count++] = rlf_transform(&frame.T_world_camera, p);
        }
    }
    assert_true(count > 4000);
    frame = next_of(source);
    for (int32_t i = 0; i < count; i++) {
        const rlf_vec3 p = rlf_transform_inverse(&frame.T_world_camera, world[i]);
        double distance;
        assert_int_equal(rlf_synthetic_distance(source, p, &distance, NULL, NULL), RLF_OK);
        assert_true(distance < 2e-4); /* a person may stand there by now: then it is less */
    }
}

TEST_CASE(test_pictures_agree_with_poses)
{
    static const char *const sources[] = {"synthetic:empty?path=handheld&color=0&noise=0&fps=2",
                                          "synthetic:room?path=look_away&color=0&noise=0&fps=0.5",
                                          "synthetic:random?path=walk&color=0&seed=3&fps=1"};
    for (size_t i = 0; i < sizeof(sources) / sizeof(sources[0]); i++) {
        rlf_source *source = synthetic_named(sources[i], NULL);
        check_pair(source);
        check_pair(source);
        rlf_source_destroy(&source);
    }
}

/* Every path begins where a camera at rest is, and is smooth: no more than the paths promise. */
TEST_CASE(test_paths_begin_at_rest)
{
    static const char *const names[] = {"orbit", "walk",    "handheld", "look_away",
                                        "fast",  "carried", "bump"};
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        char text[80] = "synthetic:empty?color=0&fps=30&frames=6&path=";
        strncat(text, names[i], sizeof(text) - strlen(text) - 1);
        rlf_source *source = synthetic_named(text, NULL);
        rlf_pose last = next_of(source).T_world_camera;
        assert_true(rlf_length(last.p) == 0.0 && last.q.w == 1.0);
        for (int k = 1; k < 6; k++) {
            const rlf_pose pose = next_of(source).T_world_camera;
            assert_true(rlf_length(rlf_sub(pose.p, last.p)) < 0.06);
            assert_true(rlf_vec3_is_finite(pose.p));
            last = pose;
        }
        rlf_source_destroy(&source);
    }
}

/* What the second camera sees of the person is where the first camera's truth has the person. */
TEST_CASE(test_the_opposite_camera_sees_the_same_person)
{
    rlf_source *front = synthetic_named("synthetic:room?color=0&noise=0&fps=1", NULL);
    rlf_source *back = synthetic_named("synthetic:room?path=opposite&color=0&noise=0&fps=1", NULL);
    rlf_frame unused, frame;
    int32_t count = 0;
    for (int k = 0; k < 6; k++) {
        assert_int_equal(rlf_source_next(front, &unused), RLF_OK);
        frame = next_of(back);
    }
    assert_true(frame.T_world_camera.p.z == 5.0);
    const rlf_truth *truth = rlf_source_get_truth(back);
    const rlf_camera *c = &frame.rig->depth;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i += 13) {
        if (truth->label[i] == RLF_SYNTHETIC_LABEL_PERSON) {
            const double z = (double)truth->depth[i];
            const rlf_vec3 p = {(i % WIDTH - c->cx) / c->fx * z, (i / WIDTH - c->cy) / c->fy * z,
                                z};
            double distance;
            int32_t label;
            assert_int_equal(rlf_synthetic_distance(front, rlf_transform(&frame.T_world_camera, p),
                                                    &distance, NULL, &label),
                             RLF_OK);
            assert_true(distance < 1e-4 && distance > -1e-4);
            assert_int_equal(label, RLF_SYNTHETIC_LABEL_PERSON);
            count++;
        }
    }
    assert_true(count > 500);
    rlf_source_destroy(&front);
    rlf_source_destroy(&back);
}

TEST_CASE(test_a_restart_gives_the_same_bits)
{
    static uint16_t first[WIDTH * HEIGHT];
    rlf_source *source = synthetic_named("synthetic:room?path=fast&color=64x36&fps=2", NULL);
    (void)next_of(source);
    memcpy(first, next_of(source).depth_u16, sizeof(first));
    assert_int_equal(rlf_source_restart(source), RLF_OK);
    (void)next_of(source);
    assert_memory_equal(next_of(source).depth_u16, first, sizeof(first));
    rlf_source_destroy(&source);
}

TEST_CASE(test_hostile_settings)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    assert_int_equal(rlf_synthetic_parse("synthetic:room?path=sideways", &def), RLF_ERROR_INVALID);
    assert_int_equal(rlf_synthetic_parse("synthetic:random?path=walk&push=lift", &def), RLF_OK);
    rlf_source *source = NULL;
    assert_int_equal(rlf_synthetic_create(&def, &source), RLF_ERROR_INVALID);
}
