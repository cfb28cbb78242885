/* A recorded clip as a source: pairs, counts, seeking, damaged frames. */
#include "io/clip/clip.h"
#include "io/source/address.h"
#include "io/source/backends.h"
#include "test.h"

#include <stdio.h>
#include <string.h>

#define MS INT64_C(1000000)

typedef struct reader {
    int32_t damaged, damaged_end; /* so many from this index on cannot be read; -1 = none */
    int32_t damaged_color;
    int32_t destroyed;
} reader;

static rlf_result read_depth(void *self, int32_t index, void *out)
{
    const reader *r = self;
    if (index >= r->damaged && index < r->damaged_end) {
        return rlf_fail(RLF_ERROR_FORMAT, "frame %d: is damaged", (int)index);
    }
    ((uint16_t *)out)[0] = (uint16_t)(1000 + index);
    return RLF_OK;
}

static rlf_result read_color(void *self, int32_t index, const rlf_image_rgba8 *out)
{
    const reader *r = self;
    if (index == r->damaged_color) {
        return rlf_fail(RLF_ERROR_FORMAT, "colour %d: is damaged", (int)index);
    }
    out->data[0] = (uint8_t)index;
    return RLF_OK;
}

static void destroy(void *self)
{
    ((reader *)self)->destroyed++;
}

static const int64_t depth_times[6] = {0, 33 * MS, 66 * MS, 66 * MS, 165 * MS, 198 * MS};
static const int64_t color_times[3] = {2 * MS, 60 * MS, 190 * MS};

static rlf_source *open_clip(reader *r)
{
    io_clip_def def = {.name = "clip",
                       .units_per_metre = 1000.0,
                       .depth = {depth_times, sizeof(depth_times[0]), 6},
                       .color = {color_times, sizeof(color_times[0]), 3},
                       .color_gap_max_ns = 20 * MS,
                       .read_depth = read_depth,
                       .read_color = read_color,
                       .destroy = destroy,
                       .self = r};
    def.rig.depth = (rlf_camera){.width = 2, .height = 2, .fx = 1, .fy = 1};
    def.rig.color = def.rig.depth;
    def.rig.has_color = true;
    rlf_opened opened;
    rlf_source *source = NULL;
    assert_int_equal(io_clip_open(&def, &opened), RLF_OK);
    assert_int_equal(rlf_source_create_custom(&opened.methods, &opened.info, opened.self, &source),
                     RLF_OK);
    return source;
}

TEST_CASE(lost_doubled_and_unpaired_frames_are_counted)
{
    reader r = {.damaged_color = -1};
    rlf_source *source = open_clip(&r);
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_int_equal(info->frame_count, 5);
    assert_true(info->frames_per_second > 30.2 && info->frames_per_second < 30.4);
    const int depth[5] = {1000, 1001, 1002, 1004, 1005};
    const int color[5] = {0, -1, 1, -1, 2};
    const uint64_t sequence[5] = {0, 1, 2, 5, 6}; /* two were lost between 66 and 165 ms */
    rlf_frame frame;
    for (int i = 0; i < 5; i++) {
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_int_equal(frame.depth_u16[0], depth[i]);
        assert_int_equal(frame.sequence, sequence[i]);
        assert_int_equal(frame.flags, 0);
        assert_int_equal(frame.color.data != NULL ? frame.color.data[0] : -1, color[i]);
    }
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    const rlf_source_status s = rlf_source_get_status(source);
    assert_int_equal(s.given, 5);
    assert_int_equal(s.lost, 2);
    assert_int_equal(s.doubled, 1);
    assert_int_equal(s.unpaired, 2);
    assert_true(s.is_connected);
    rlf_source_destroy(&source);
    assert_int_equal(r.destroyed, 1);
}

TEST_CASE(a_seek_says_that_the_frame_does_not_follow)
{
    reader r = {.damaged_color = -1};
    rlf_source *source = open_clip(&r);
    rlf_frame frame;
    assert_int_equal(rlf_source_seek(source, 3), RLF_OK);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.depth_u16[0], 1004);
    assert_int_equal(frame.flags, RLF_FRAME_DISCONTINUITY);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.flags, 0);
    assert_int_equal(rlf_source_seek(source, 5), RLF_ERROR_INVALID);
    assert_int_equal(rlf_source_seek(source, -1), RLF_ERROR_INVALID);
    rlf_source_destroy(&source);
}

typedef struct log_lines {
    int32_t count;
    char last[256];
} log_lines;

static void keep_line(void *context, rlf_log_level level, const char *text)
{
    log_lines *lines = context;
    (void)level;
    lines->count++;
    (void)snprintf(lines->last, sizeof(lines->last), "%s", text);
}

TEST_CASE(a_damaged_frame_is_left_out_and_told)
{
    reader r = {.damaged = 1, .damaged_end = 3, .damaged_color = 2};
    log_lines lines = {0};
    rlf_set_log(keep_line, &lines);
    rlf_frame frame;
    rlf_source *source = open_clip(&r);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(lines.count, 0);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.depth_u16[0], 1004);
    assert_int_equal(lines.count, 1);
    assert_string_equal(lines.last, "frame 1: is damaged; frames that cannot be read are left out");
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK); /* depth counts */
    assert_null(frame.color.data);
    assert_string_equal(lines.last, "colour 2: is damaged; such frames have no colour");
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    assert_int_equal(rlf_source_get_status(source).damaged, 3);
    assert_int_equal(lines.count, 4);
    rlf_source_destroy(&source);
    assert_int_equal(lines.count, 4);
    rlf_set_log(NULL, NULL);
}

TEST_CASE(a_clip_that_cannot_be_read_fails)
{
    rlf_set_log(NULL, NULL);
    reader r = {.damaged = 0, .damaged_end = 6, .damaged_color = -1};
    rlf_frame frame;
    rlf_source *source = open_clip(&r);
    assert_int_equal(rlf_source_next(source, &frame), RLF_ERROR_FORMAT);
    assert_string_equal(rlf_error_text(), "frame 0: is damaged (and no other frame could be read)");
    rlf_source_destroy(&source);
}

TEST_CASE(times_beyond_all_reason_are_refused)
{
    static const int64_t times[][2] = {{INT64_MIN, INT64_MAX}, {0, INT64_MAX}, {INT64_MIN, 0}};
    static const int64_t good[2] = {-RLF_TIME_MAX_NS, RLF_TIME_MAX_NS};
    for (int i = 0; i < 6; i++) {
        const bool is_color = i >= 3;
        reader r = {.damaged = -1};
        io_clip_def def = {.name = "clip",
                           .units_per_metre = 1000.0,
                           .depth = {is_color ? good : times[i % 3], sizeof(good[0]), 2},
                           .color = {is_color ? times[i % 3] : good, sizeof(good[0]), 2},
                           .read_depth = read_depth,
                           .read_color = read_color,
                           .self = &r};
        def.rig.depth = (rlf_camera){.width = 2, .height = 2, .fx = 1, .fy = 1};
        def.rig.color = def.rig.depth;
        def.rig.has_color = true;
        rlf_opened opened;
        assert_int_equal(io_clip_open(&def, &opened), RLF_ERROR_FORMAT);
        assert_non_null(strstr(rlf_error_text(), is_color ? "clip: colour" : "clip: depth"));
        assert_non_null(strstr(rlf_error_text(), "correct its times"));
    }
}

/* Not this picture or that: the disk, or the whole folder. */
TEST_CASE(ten_damaged_frames_in_a_row_end_the_clip)
{
    reader r = {.damaged = 2, .damaged_end = 12, .damaged_color = -1};
    int64_t times[20];
    for (int i = 0; i < 20; i++) {
        times[i] = 33 * MS * i;
    }
    const io_clip_def def = {.name = "clip",
                             .rig = {.depth = {.width = 2, .height = 2, .fx = 1, .fy = 1}},
                             .units_per_metre = 1000.0,
                             .depth = {times, sizeof(times[0]), 20},
                             .read_depth = read_depth,
                             .self = &r};
    for (int longer = 0; longer < 2; longer++) {
        rlf_opened opened;
        rlf_source *source = NULL;
        assert_int_equal(io_clip_open(&def, &opened), RLF_OK);
        assert_int_equal(
            rlf_source_create_custom(&opened.methods, &opened.info, opened.self, &source), RLF_OK);
        rlf_frame frame;
        r.damaged = longer ? 2 : 3;
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        if (!longer) {
            assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        }
        assert_int_equal(rlf_source_next(source, &frame), longer ? RLF_ERROR_FORMAT : RLF_OK);
        rlf_source_destroy(&source);
    }
}

TEST_CASE(addresses_are_taken_apart)
{
    io_address a;
    assert_int_equal(io_address_parse("openni2:1d27?mode=640x480&aligned=1", &a), RLF_OK);
    assert_string_equal(a.scheme, "openni2");
    assert_string_equal(a.place, "1d27");
    assert_string_equal(io_address_take(&a, "mode"), "640x480");
    assert_null(io_address_take(&a, "mode"));
    assert_int_equal(a.key_count, 1);
    assert_int_equal(io_address_parse("some/clip.mcap?loop=1", &a), RLF_OK);
    assert_string_equal(a.scheme, "");
    assert_string_equal(a.place, "some/clip.mcap");
    assert_int_equal(io_address_parse("x:?loop", &a), RLF_ERROR_INVALID);
    assert_int_equal(io_address_parse("x:?=1", &a), RLF_ERROR_INVALID);
    assert_int_equal(io_address_parse("x:?a=1&a=2", &a), RLF_ERROR_INVALID);
    char text[IO_ADDRESS_MAX + 8];
    memset(text, 'x', sizeof(text));
    text[sizeof(text) - 1] = '\0';
    assert_int_equal(io_address_parse(text, &a), RLF_ERROR_INVALID);
}
