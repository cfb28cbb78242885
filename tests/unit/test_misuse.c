/* A caller's mistake other than NULL (test_null_calls.c) is a safe no-op, too: sizes, factors and
 * views that are none. */

#include "count_assert.h"
#include "relief/relief.h"
#include "created.h"
#include "test.h"

TEST_CASE(cameras_of_nothing_are_refused)
{
    const rlf_camera camera = {.width = 64, .height = 48, .fx = 50, .fy = 50, .cx = 32, .cy = 24};
    const rlf_camera nowhere = {.width = 0};
    int count = 0;
    rlf_set_assert(count_assert, &count);
    (void)rlf_camera_decimate(&camera, 0);
    assert_int_equal(count, 1);
    (void)rlf_camera_resize(&nowhere, 8, 8);
    assert_int_equal(count, 2);
    rlf_set_assert(NULL, NULL);
}

static rlf_pipeline *make_pipeline(rlf_source **source)
{
    rlf_synthetic_def room = rlf_synthetic_def_default();
    room.scene = RLF_SYNTHETIC_EMPTY;
    room.color_width = 64;
    room.color_height = 36;
    assert_int_equal(rlf_synthetic_create(&room, source), RLF_OK);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, *source, NULL);
    return pipeline_of(&def);
}

/* A view that is none is refused by both calls, and a missing line is an empty one. */
TEST_CASE(pipeline_refuses_views_that_are_none)
{
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = make_pipeline(&source);
    const int none[] = {-7, 99, RLF_VIEW_COUNT};
    int count = 0;
    rlf_set_assert(count_assert, &count);
    for (int i = 0; i < 3; i++) {
        const rlf_view view = (rlf_view)none[i];
        rlf_pipeline_set_view(pipeline, view);
        assert_int_equal(rlf_pipeline_set_views(pipeline, &view, 1), RLF_ERROR_INVALID);
    }
    assert_int_equal(count, 6);
    const char *const lines[] = {"first", NULL};
    rlf_pipeline_set_overlay(pipeline, lines, 2);
    assert_int_equal(count, 6);
    rlf_pipeline_set_overlay(pipeline, lines, -1);
    assert_int_equal(count, 7);
    rlf_set_assert(NULL, NULL);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}
