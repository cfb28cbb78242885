/* Frames that a program pushes give what the same frames give when a source is asked for them. */

#include "created.h"
#include "test.h"

#include <string.h>

#define FRAMES 30

static rlf_source *open_room(void)
{
    rlf_source *source = NULL;
    const rlf_synthetic_def def = rlf_synthetic_def_default();
    source = synthetic_of(&def);
    return source;
}

static rlf_pipeline *make_pipeline(const rlf_pipeline_def *from, const rlf_scene *scene)
{
    rlf_pipeline_def def = *from;
    def.scene = scene;
    def.enable_render = false;
    return pipeline_of(&def);
}

TEST_CASE(pushed_frames_give_the_same_bodies)
{
    rlf_scene scene;
    assert_int_equal(rlf_scene_create_two_cubes(&scene), RLF_OK);
    rlf_source *asked = open_room(), *camera = open_room();
    const rlf_pipeline_def pull = rlf_pipeline_def_default(RLF_PROFILE_LIVE, asked, NULL);
    const rlf_pipeline_def push =
        rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &rlf_source_get_info(camera)->rig, NULL);
    rlf_pipeline *a = make_pipeline(&pull, &scene), *b = make_pipeline(&push, &scene);
    rlf_pipeline_output from_a, from_b;
    assert_int_equal(rlf_pipeline_step(b, &from_b), RLF_NO_FRAME);
    for (int i = 0; i < FRAMES; i++) {
        rlf_frame frame = frame_of(camera);
        assert_int_equal(rlf_pipeline_step(a, &from_a), RLF_OK);
        assert_int_equal(rlf_pipeline_push(b, &frame, &from_b), RLF_OK);
        assert_int_equal(from_b.frame_index, i);
        assert_ptr_equal(from_b.frame.depth_u16, frame.depth_u16);
    }
    assert_true(rlf_world_hash(rlf_pipeline_get_world(a)) ==
                rlf_world_hash(rlf_pipeline_get_world(b)));
    rlf_pipeline_destroy(&a);
    rlf_pipeline_destroy(&b);
    rlf_source_destroy(&asked);
    rlf_source_destroy(&camera);
    rlf_scene_destroy(&scene);
}

TEST_CASE(a_wrong_frame_is_named_and_changes_nothing)
{
    rlf_source *camera = open_room();
    const rlf_pipeline_def def =
        rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &rlf_source_get_info(camera)->rig, NULL);
    rlf_pipeline *p = make_pipeline(&def, NULL);
    rlf_pipeline_output out;
    rlf_frame frame = frame_of(camera);
    assert_int_equal(rlf_pipeline_push(p, &frame, &out), RLF_OK);
    rlf_frame wrong = frame;
    wrong.depth_stride = 2;
    assert_int_equal(rlf_pipeline_push(p, &wrong, &out), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "depth_stride"));
    wrong = frame;
    wrong.depth_u16 = NULL;
    assert_int_equal(rlf_pipeline_push(p, &wrong, &out), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "depth_u16"));
    frame = frame_of(camera);
    assert_int_equal(rlf_pipeline_push(p, &frame, &out), RLF_OK);
    assert_int_equal(out.frame_index, 1);
    assert_int_equal(rlf_pipeline_restart(p), RLF_OK);
    assert_int_equal(rlf_pipeline_push(p, &frame, &out), RLF_OK);
    assert_int_equal(out.frame_index, 0);
    rlf_pipeline_destroy(&p);
    rlf_source_destroy(&camera);
}

TEST_CASE(who_has_a_source_is_told_so)
{
    rlf_source *source = open_room();
    const rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    rlf_pipeline *p = make_pipeline(&def, NULL);
    rlf_frame frame;
    rlf_pipeline_output out;
    frame = frame_of(source);
    assert_int_equal(rlf_pipeline_push(p, &frame, &out), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "rlf_pipeline_step"));
    rlf_pipeline_destroy(&p);
    rlf_source_destroy(&source);
}

TEST_CASE(a_rig_without_a_camera_is_refused)
{
    const rlf_rig rig = rlf_rig_default();
    const rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &rig, NULL);
    rlf_pipeline *p = NULL;
    assert_int_equal(rlf_pipeline_create(&def, &p), RLF_ERROR_INVALID);
    assert_null(p);
    assert_non_null(strstr(rlf_error_text(), "width"));
}
