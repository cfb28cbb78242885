/* A camera of a test's own, which draws what it sees, and the frame loop on it: one of each in a
 * test, gone after it. TEST_EACH(NULL, close_drawn). */
#ifndef RLF_TEST_DRAWN_SOURCE_H
#define RLF_TEST_DRAWN_SOURCE_H

#include "created.h"
#include "pinhole.h"

#include <string.h>

static rlf_source *source;
static rlf_pipeline *pipeline;
static rlf_pipeline_output out; /* of the last step */

static struct drawn {
    uint16_t depth[320 * 240]; /* millimetres; the next frame's */
    rlf_camera camera;
    int64_t frame, frame_count;
    double silence_s;
    void (*draw)(rlf_frame *frame); /* may change what the frame says by itself */
} drawn;

static inline rlf_result drawn_next(void *self, rlf_frame *frame)
{
    (void)self;
    if (drawn.frame == drawn.frame_count) {
        return RLF_END;
    }
    *frame = (rlf_frame){.sequence = (uint64_t)drawn.frame,
                         .time_ns = drawn.frame * 33333333,
                         .depth_u16 = drawn.depth,
                         .depth_stride = drawn.camera.width * (ptrdiff_t)sizeof(uint16_t),
                         .depth_units_per_metre = 1000};
    if (drawn.draw != NULL) {
        drawn.draw(frame);
    }
    drawn.frame++;
    return RLF_OK;
}

static inline rlf_result drawn_restart(void *self)
{
    (void)self;
    drawn.frame = 0;
    return RLF_OK;
}

static inline void drawn_status(void *self, rlf_source_status *status)
{
    (void)self;
    status->silence_s = drawn.silence_s;
}

static inline rlf_source_info drawn_info(int32_t width, int32_t height, double focal,
                                         int64_t frame_count)
{
    rlf_source_info info = {.name = "drawn", .frame_count = frame_count, .frames_per_second = 30};
    info.rig.depth = pinhole(width, height, focal);
    info.rig.T_color_depth = rlf_pose_identity();
    info.rig.depth_min_m = 0.3;
    info.rig.depth_max_m = 8.0;
    info.rig.noise = (rlf_depth_noise){0.001, 0.0, 0.001};
    return info;
}

/* Before it draws, everything is 2 m away. */
static inline void open_drawn(const rlf_source_info *info, void (*draw)(rlf_frame *frame))
{
    const rlf_source_methods methods = {drawn_next, drawn_restart, .status = drawn_status};
    drawn =
        (struct drawn){.camera = info->rig.depth, .frame_count = info->frame_count, .draw = draw};
    for (int32_t i = 0; i < drawn.camera.width * drawn.camera.height; i++) {
        drawn.depth[i] = 2000;
    }
    assert_int_equal(rlf_source_create_custom(&methods, info, NULL, &source), RLF_OK);
}

static inline int close_drawn(void **state)
{
    (void)state;
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    return 0;
}

static inline bool step(void)
{
    return rlf_pipeline_step(pipeline, &out) == RLF_OK;
}

#endif
