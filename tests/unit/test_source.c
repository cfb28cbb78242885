/* The source object: a caller's methods behind rlf_source. */

#include "created.h"
#include "relief/source.h"
#include "test.h"

#include <string.h>

typedef struct counter {
    int32_t frame, limit;
    int32_t destroyed;
    rlf_truth truth;
    uint16_t depth[4];
} counter;

static rlf_result counter_next(void *self, rlf_frame *out)
{
    counter *c = self;
    if (c->frame == c->limit) {
        return RLF_END;
    }
    out->sequence = (uint64_t)c->frame++;
    out->depth_u16 = c->depth;
    out->depth_stride = 4;
    out->depth_units_per_metre = 1000;
    return RLF_OK;
}

static rlf_result counter_restart(void *self)
{
    ((counter *)self)->frame = 0;
    return RLF_OK;
}

static const rlf_truth *counter_truth(void *self)
{
    return &((counter *)self)->truth;
}

static void counter_destroy(void *self)
{
    ((counter *)self)->destroyed++;
}

static rlf_source_info make_info(void)
{
    rlf_source_info info = {.name = "counter", .frame_count = 3};
    info.rig.depth = (rlf_camera){.width = 2, .height = 2, .fx = 1, .fy = 1};
    return info;
}

TEST_CASE(frames_come_in_order_with_the_rig)
{
    counter c = {.limit = 3};
    rlf_source_info info = make_info();
    rlf_source_methods methods = {.next = counter_next,
                                  .restart = counter_restart,
                                  .truth = counter_truth,
                                  .destroy = counter_destroy};
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &c, &source), RLF_OK);
    assert_string_equal(rlf_source_get_info(source)->name, "counter");
    assert_ptr_equal(rlf_source_get_truth(source), &c.truth);
    for (int round = 0; round < 2; round++) {
        rlf_frame frame;
        for (uint64_t i = 0; i < 3; i++) {
            frame = frame_of(source);
            assert_int_equal(frame.sequence, i);
            assert_ptr_equal(frame.rig, &rlf_source_get_info(source)->rig);
            assert_ptr_equal(frame.depth_u16, c.depth);
            assert_null(frame.color.data);
        }
        frame.sequence = 77;
        assert_int_equal(rlf_source_next(source, &frame), RLF_END);
        assert_int_equal(frame.sequence, 77);
        assert_int_equal(rlf_source_restart(source), RLF_OK);
    }
    rlf_source_destroy(&source);
    assert_null(source);
    assert_int_equal(c.destroyed, 1);
    rlf_source_destroy(&source);
    rlf_source_destroy(NULL);
}

TEST_CASE(optional_methods_may_be_missing)
{
    counter c = {.limit = 3};
    rlf_source_info info = make_info();
    rlf_source_methods methods = {.next = counter_next};
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &c, &source), RLF_OK);
    assert_null(rlf_source_get_truth(source));
    assert_int_equal(rlf_source_restart(source), RLF_ERROR_UNSUPPORTED);
    assert_non_null(strstr(rlf_error_text(), "counter"));
    rlf_source_destroy(&source);
    assert_int_equal(c.destroyed, 0);
}

typedef struct stamped {
    counter counts;
    int64_t times[3]; /* time_ns, color_time_ns, host_time_ns */
} stamped;

static rlf_result stamped_next(void *self, rlf_frame *out)
{
    stamped *s = self;
    rlf_result result = counter_next(&s->counts, out);
    out->time_ns = s->times[0];
    out->color_time_ns = s->times[1];
    out->host_time_ns = s->times[2];
    return result;
}

/* Any two times can be subtracted. */
TEST_CASE(times_that_cannot_be_subtracted_are_refused)
{
    static const int64_t bad[] = {INT64_MIN, INT64_MAX, RLF_TIME_MAX_NS + 1, -RLF_TIME_MAX_NS - 1};
    static const char *const names[3] = {"time_ns", "color_time_ns", "host_time_ns"};
    rlf_source_info info = make_info();
    rlf_source_methods methods = {.next = stamped_next};
    for (int i = 0; i < 12; i++) {
        stamped s = {.counts = {.limit = 3}, .times = {RLF_TIME_MAX_NS, -RLF_TIME_MAX_NS, 0}};
        rlf_source *source = NULL;
        rlf_frame frame;
        assert_int_equal(rlf_source_create_custom(&methods, &info, &s, &source), RLF_OK);
        frame = frame_of(source);
        s.times[i % 3] = bad[i / 3];
        assert_int_equal(rlf_source_next(source, &frame), RLF_ERROR_INVALID);
        assert_non_null(strstr(rlf_error_text(), "counter: frame 1: "));
        assert_non_null(strstr(rlf_error_text(), names[i % 3]));
        assert_non_null(strstr(rlf_error_text(), "nanoseconds"));
        rlf_source_destroy(&source);
    }
}

TEST_CASE(a_bad_camera_is_named_and_self_is_kept)
{
    counter c = {.limit = 3};
    rlf_source_info info = make_info();
    rlf_source_methods methods = {.next = counter_next, .destroy = counter_destroy};
    rlf_source *source = NULL;
    info.rig.depth.fx = 0.0;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &c, &source), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "depth"));
    assert_non_null(strstr(rlf_error_text(), "fx"));
    assert_null(source);
    info = make_info();
    info.rig.has_color = true;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &c, &source), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "color"));
    assert_int_equal(c.destroyed, 0);
}

static uint16_t seen_depth[4];

static void see(void *context, const rlf_frame *frame)
{
    (void)context;
    memcpy(seen_depth, frame->depth_u16, sizeof(seen_depth));
}

static rlf_frame_fn observer;
static void *observer_context;

static void counter_observe(void *self, rlf_frame_fn fn, void *context)
{
    (void)self;
    observer = fn;
    observer_context = context;
}

/* A sensor that measures 24 mm too far: frames come without them, missing stays missing, and the
 * device's own plane stays as it is. */
TEST_CASE(the_depth_offset_is_taken_away)
{
    counter c = {.limit = 3, .depth = {1000, 0, 10, 65535}};
    rlf_source_info info = make_info();
    info.rig.depth_offset_m = 0.024;
    rlf_source_methods methods = {.next = counter_next, .observe = counter_observe};
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &c, &source), RLF_OK);
    rlf_frame frame = frame_of(source);
    const uint16_t expected[4] = {976, 0, 0, 65511};
    assert_memory_equal(frame.depth_u16, expected, sizeof(expected));
    assert_int_equal(c.depth[0], 1000);
    assert_true(rlf_source_observe(source, see, NULL));
    const rlf_frame raw = {.depth_u16 = c.depth, .depth_stride = 4, .depth_units_per_metre = 1000};
    observer(observer_context, &raw);
    assert_memory_equal(seen_depth, expected, sizeof(expected));
    assert_true(rlf_source_observe(source, NULL, NULL));
    assert_null(observer);
    rlf_source_destroy(&source);
}

static rlf_result bad_next(void *self, rlf_frame *out)
{
    *out = *(const rlf_frame *)self;
    return RLF_OK;
}

/* What the pipeline, a recorder or a renderer would read past its end. */
TEST_CASE(a_frame_that_is_none_is_not_given)
{
    static const uint16_t depth[4];
    static uint8_t color[4 * 4];
    rlf_source_info info = make_info();
    info.rig.has_color = true;
    info.rig.color = info.rig.depth;
    const int32_t width = info.rig.depth.width;
    const int32_t height = info.rig.depth.height;
    const rlf_frame good = {.depth_u16 = depth,
                            .depth_stride = 2 * (ptrdiff_t)width,
                            .depth_units_per_metre = 1000,
                            .color = {color, width, height, 4 * (ptrdiff_t)width}};
    rlf_frame frames[] = {good, good, good, good, good, good, good};
    frames[1].depth_u16 = NULL;
    frames[2].depth_stride = 2 * (ptrdiff_t)width - 2;
    frames[3].depth_units_per_metre = 0;
    frames[4].color.width = width + 1;
    frames[5].color.stride = 4 * (ptrdiff_t)width - 1;
    frames[6].confidence = color;
    const rlf_source_methods methods = {.next = bad_next};
    for (size_t i = 0; i < sizeof(frames) / sizeof(frames[0]); i++) {
        rlf_source *source = NULL;
        rlf_frame frame;
        assert_int_equal(rlf_source_create_custom(&methods, &info, &frames[i], &source), RLF_OK);
        assert_int_equal(rlf_source_next(source, &frame), i == 0 ? RLF_OK : RLF_ERROR_INVALID);
        rlf_source_destroy(&source);
    }
}
