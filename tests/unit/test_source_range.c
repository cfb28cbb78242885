/* Depth out of the range, mostly, is told once: its unit is wrong. */

#include "created.h"
#include "relief/source.h"
#include "test.h"

#include <string.h>

enum { WIDTH = 20, HEIGHT = 10, COUNT = WIDTH * HEIGHT };

typedef struct plane {
    uint16_t counts[COUNT];
    float metres[COUNT];
    bool is_float;
} plane;

static plane seen;
static int lines;
static char last[512];

static void keep(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    assert_int_equal(level, RLF_LOG_WARNING);
    lines++;
    strncpy(last, line, sizeof(last) - 1);
}

static rlf_result next(void *self, rlf_frame *out)
{
    const plane *p = self;
    out->depth_u16 = p->is_float ? NULL : p->counts;
    out->depth_f32 = p->is_float ? p->metres : NULL;
    out->depth_stride = WIDTH * (p->is_float ? 4 : 2);
    out->depth_units_per_metre = 1000;
    return RLF_OK;
}

static rlf_source *open_source(void)
{
    const rlf_source_methods methods = {.next = next};
    rlf_source_info info = {.name = "plane", .frame_count = -1};
    info.rig.depth = (rlf_camera){.width = WIDTH, .height = HEIGHT, .fx = 9, .fy = 9};
    info.rig.depth_min_m = 0.5;
    info.rig.depth_max_m = 8.0;
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &seen, &source), RLF_OK);
    lines = 0;
    rlf_set_log(keep, NULL);
    return source;
}

static void close_source(rlf_source *source)
{
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
}

static void read_frames(rlf_source *source, int count)
{
    for (int i = 0; i < count; i++) {
        frame_of(source);
    }
}

static void fill(uint16_t value)
{
    for (int i = 0; i < COUNT; i++) {
        seen.counts[i] = value;
        seen.metres[i] = (float)value;
    }
}

TEST_CASE(a_room_is_not_told)
{
    rlf_source *source = open_source();
    fill(2000);
    for (int i = 0; i < COUNT / 3; i++) {
        seen.counts[i] = 12000; /* some pixels may be farther */
    }
    read_frames(source, 3);
    fill(20000);
    read_frames(source, 3); /* who covers the lens later is not asked */
    assert_int_equal(lines, 0);
    close_source(source);
}

TEST_CASE(a_wrong_unit_is_told_once_when_there_is_depth)
{
    rlf_source *source = open_source();
    fill(0);
    read_frames(source, 3);
    assert_int_equal(lines, 0);
    fill(20000);
    read_frames(source, 3);
    assert_int_equal(lines, 1);
    assert_non_null(strstr(last, "plane: no pixel is between 0.50 and 8.00 m, the median is 20"));
    assert_non_null(strstr(last, "units_per_metre (it is 1000)"));
    close_source(source);
    source = open_source();
    fill(2); /* metres, read as millimetres */
    read_frames(source, 1);
    assert_non_null(strstr(last, "the median is 0.002 m"));
    close_source(source);
    source = open_source();
    seen.is_float = true;
    fill(1500); /* millimetres, read as metres */
    seen.metres[0] = seen.metres[1] = 1.0f;
    read_frames(source, 1);
    assert_int_equal(lines, 1);
    assert_non_null(strstr(last, "only 2 % of the pixels with depth are between"));
    seen.is_float = false;
    close_source(source);
}

TEST_CASE(the_range_can_be_another)
{
    rlf_source *source = open_source();
    rlf_source_expect_range(source, 0.5, 30.0);
    fill(20000);
    read_frames(source, 1);
    assert_int_equal(lines, 0);
    close_source(source);
    source = open_source();
    rlf_source_expect_range(source, 0.0, 0.0);
    read_frames(source, 1);
    assert_int_equal(lines, 0);
    close_source(source);
}
