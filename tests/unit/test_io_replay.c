/* How a recording is played: loops, parts, speeds, lost frames, and what was meant by a wrong key.
 */
#define _POSIX_C_SOURCE 200809L

#include "io/source/address.h"
#include "io/source/backends.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#define W 16
#define H 8
#define FRAMES 10
#define INTERVAL_NS 40000000
#define CAMERA "\"width\":16,\"height\":8,\"fx\":15,\"fy\":15,\"cx\":7.5,\"cy\":3.5"

/* Ten frames 40 ms apart; frame i holds 100 + i everywhere, its colour 10 i. */
static int make_clip(void **state)
{
    if (test_folder_make(state) != 0) {
        return -1;
    }
    test_write_text("camera.json", "{\"depth\":{" CAMERA ",\"units_per_metre\":1000},"
                                   "\"color\":{\"width\":16,\"height\":8,\"fx\":20,\"fy\":20,"
                                   "\"cx\":9,\"cy\":4},\"depth_to_color\":{\"rotation\":[[1,0,0],"
                                   "[0,1,0],[0,0,1]],\"translation\":[0.05,0,0]}}");
    char depth_list[512] = "", color_list[512] = "";
    for (int i = 0; i < FRAMES; i++) {
        char name[16], line[64];
        uint16_t depth[W * H];
        uint8_t color[W * H * 4];
        for (int p = 0; p < W * H; p++) {
            depth[p] = (uint16_t)(100 + i);
        }
        memset(color, 10 * i, sizeof(color));
        snprintf(name, sizeof(name), "d%d.png", i);
        assert_int_equal(rlf_png_write_u16(test_path(name), depth, W, H), RLF_OK);
        snprintf(line, sizeof(line), "%.2f d%d.png\n", 1.0 + 0.04 * i, i);
        strcat(depth_list, line);
        snprintf(name, sizeof(name), "c%d.png", i);
        const rlf_image_rgba8 image = {color, W, H, W * 4};
        assert_int_equal(rlf_png_write_rgba(test_path(name), &image), RLF_OK);
        snprintf(line, sizeof(line), "%.2f c%d.png\n", 1.0 + 0.04 * i, i);
        strcat(color_list, line);
    }
    test_write_text("depth.txt", depth_list);
    test_write_text("rgb.txt", color_list);
    return 0;
}

static rlf_result try_open(const char *keys, rlf_source **out)
{
    char text[256];
    snprintf(text, sizeof(text), "%s?%s", test_folder, keys);
    return rlf_open_source(text, NULL, out);
}

static rlf_source *open_with(const char *keys)
{
    rlf_source *source = NULL;
    if (try_open(keys, &source) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return source;
}

/* Asks until there is a frame. */
static int next_value(rlf_source *source, rlf_frame *frame)
{
    rlf_result result;
    while ((result = rlf_source_next(source, frame)) == RLF_NO_FRAME) {
    }
    assert_int_equal(result, RLF_OK);
    return frame->depth_u16[W * H - 1] - 100;
}

TEST_CASE_WITH(a_loop_goes_on_in_time_and_count, make_clip, test_folder_remove)
{
    rlf_source *source = open_with("loop=1");
    assert_int_equal(rlf_source_get_info(source)->frame_count, -1);
    rlf_frame frame;
    int64_t last_ns = 0;
    for (int i = 0; i < 3 * FRAMES + 5; i++) {
        assert_int_equal(next_value(source, &frame), i % FRAMES);
        assert_int_equal(frame.sequence, i);
        assert_true(i == 0 || frame.time_ns - last_ns == INTERVAL_NS);
        assert_true(frame.color_time_ns == frame.time_ns);
        const bool is_seam = i > 0 && i % FRAMES == 0;
        assert_int_equal(frame.flags & RLF_FRAME_DISCONTINUITY, is_seam ? 4 : 0);
        last_ns = frame.time_ns;
    }
    assert_int_equal(rlf_source_get_status(source).lost, 0);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(a_part_is_played, make_clip, test_folder_remove)
{
    rlf_source *source = open_with("start=3&count=4");
    assert_int_equal(rlf_source_get_info(source)->frame_count, 4);
    rlf_frame frame;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 3; i < 7; i++) {
            assert_int_equal(next_value(source, &frame), i);
            assert_int_equal(frame.flags, 0);
        }
        assert_int_equal(rlf_source_next(source, &frame), RLF_END);
        assert_int_equal(frame.depth_u16[0], 106); /* the end leaves the last one alone */
        assert_int_equal(rlf_source_restart(source), RLF_OK);
    }
    assert_int_equal(rlf_source_seek(source, 2), RLF_OK);
    assert_int_equal(next_value(source, &frame), 5);
    assert_true((frame.flags & RLF_FRAME_DISCONTINUITY) != 0);
    assert_int_equal(rlf_source_seek(source, 4), RLF_ERROR_INVALID);
    rlf_source_destroy(&source);

    source = open_with("start=8&count=99&loop=1");
    const int wanted[5] = {8, 9, 8, 9, 8};
    for (int i = 0; i < 5; i++) {
        assert_int_equal(next_value(source, &frame), wanted[i]);
        assert_int_equal(frame.sequence, 8 + i);
    }
    assert_int_equal(rlf_source_seek(source, 2), RLF_ERROR_INVALID);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(real_time_waits_and_never_for_long, make_clip, test_folder_remove)
{
    rlf_source *source = open_with("speed=0.25"); /* one frame in 160 ms */
    rlf_frame frame;
    assert_int_equal(next_value(source, &frame), 0);
    const int64_t start_ns = rlf_clock_ns();
    int waits = 0;
    for (;;) {
        const int64_t call_ns = rlf_clock_ns();
        const rlf_result result = rlf_source_next(source, &frame);
        const int64_t took_ns = rlf_clock_ns() - call_ns;
        if (result == RLF_OK) {
            break;
        }
        assert_int_equal(result, RLF_NO_FRAME);
        assert_int_equal(frame.depth_u16[0], 100); /* the last frame is left alone */
        assert_int_equal(frame.color.data[0], 0);
        assert_true(took_ns >= 49000000);
        waits++;
    }
    assert_true(rlf_clock_ns() - start_ns >= 159000000);
    assert_in_range(waits, 1, 3);
    assert_int_equal(frame.depth_u16[0], 101);
    assert_int_equal(frame.color.data[0], 10);
    rlf_source_destroy(&source);

    source = open_with("speed=20"); /* one in 2 ms: the clip takes 18 ms */
    const int64_t fast_ns = rlf_clock_ns();
    for (int i = 0; i < FRAMES; i++) {
        assert_int_equal(next_value(source, &frame), i);
    }
    assert_true(rlf_clock_ns() - fast_ns >= 17000000);
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(lost_frames_are_the_same_every_time_and_counted, make_clip, test_folder_remove)
{
    uint64_t sequences[2][400];
    int counts[2] = {0, 0};
    for (int run = 0; run < 2; run++) {
        rlf_source *source = open_with("loop=1&drop=0.3&seed=7");
        rlf_frame frame;
        while (counts[run] < 400) {
            next_value(source, &frame);
            sequences[run][counts[run]++] = frame.sequence;
        }
        const rlf_source_status status = rlf_source_get_status(source);
        assert_int_equal(status.given, 400);
        assert_true(status.lost > 110 && status.lost < 230); /* 30 of 100, the last of 10 stays */
        assert_int_equal(frame.sequence + 1, 400 + status.lost);
        rlf_source_destroy(&source);
    }
    assert_memory_equal(sequences[0], sequences[1], sizeof(sequences[0]));
    rlf_source *source = open_with("drop=1");
    rlf_frame frame;
    assert_int_equal(next_value(source, &frame), FRAMES - 1);
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    assert_int_equal(rlf_source_get_status(source).lost, FRAMES - 1);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(aligned_is_told_by_the_user, make_clip, test_folder_remove)
{
    rlf_source *source = open_with("aligned=1");
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    assert_true(rig->T_color_depth.p.x == 0.0);
    assert_true(rig->color.fx == 15.0 && rig->color.cx == 7.5);
    rlf_frame frame;
    next_value(source, &frame);
    assert_int_equal(frame.flags, RLF_FRAME_ALIGNED);
    assert_ptr_equal(frame.rig, rig);
    rlf_source_destroy(&source);
    source = open_with("aligned=0");
    assert_true(rlf_source_get_info(source)->rig.T_color_depth.p.x == 0.05);
    next_value(source, &frame);
    assert_int_equal(frame.flags, 0);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(wrong_keys_and_values_are_told, make_clip, test_folder_remove)
{
    const struct {
        const char *keys, *part, *cure;
    } cases[] = {
        {"lop=1", "\"loop\" may be meant", "use camera loop speed"},
        {"sped=1", "\"speed\" may be meant", "use camera"},
        {"quality=1", "no key \"quality\"", "use camera"},
        {"loop=2", "loop=2", "1 to start again"},
        {"speed=-1", "speed=-1", "as recorded"},
        {"speed=fast", "speed=fast", "as recorded"},
        {"start=10", "there are 10 frames", "use 0 to 9"},
        {"start=1.5", "start=1.5", "the first frame"},
        {"count=0", "count=0", "from 1"},
        {"drop=1.1", "drop=1.1", "from 0 to 1"},
        {"drop=nan", "drop=nan", "from 0 to 1"},
        {"aligned=yes", "aligned=yes", "depth camera's pixels"},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        rlf_source *source = NULL;
        test_expect_error(try_open(cases[i].keys, &source), RLF_ERROR_INVALID, test_folder,
                          cases[i].part, cases[i].cure);
        assert_null(source);
    }
}

TEST_CASE(the_nearest_word_is_found)
{
    char word[32];
    assert_true(rlf_word_nearest("loop speed start", "statr", word, sizeof(word)));
    assert_string_equal(word, "start");
    assert_true(rlf_word_nearest("loop speed start", "LOOP", word, sizeof(word)) == false);
    assert_false(rlf_word_nearest("loop speed start", "resolution", word, sizeof(word)));
    assert_false(rlf_word_nearest(NULL, "loop", word, sizeof(word)));
    assert_false(rlf_word_nearest("loop", "a word that is longer than any key of a source", word,
                                  sizeof(word)));
    assert_true(io_word_is_in("loop speed", "speed"));
    assert_false(io_word_is_in("loop speeds", "speed"));
}
