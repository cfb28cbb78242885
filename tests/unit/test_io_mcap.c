/* Recordings: what goes in comes out, whatever becomes of the file. */
#define _POSIX_C_SOURCE 200809L

#include "io/mcap/mcap.h"
#include "recording_sample.h"
#include "test.h"

#include <signal.h>
#include <sys/resource.h>

static rlf_source *open_file(const char *path)
{
    rlf_source *source = NULL;
    if (rlf_open_source(path, NULL, &source) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return source;
}

static void check_rig(const rlf_rig *got)
{
    const rlf_source_info info = sample_info();
    const rlf_rig *want = &info.rig;
    assert_memory_equal(&got->depth, &want->depth, sizeof(want->depth));
    assert_memory_equal(&got->color, &want->color, sizeof(want->color));
    assert_memory_equal(&got->T_color_depth, &want->T_color_depth, sizeof(want->T_color_depth));
    assert_memory_equal(&got->noise, &want->noise, sizeof(want->noise));
    assert_true(got->has_color);
    assert_memory_equal(&got->depth_min_m, &want->depth_min_m, 2 * sizeof(double));
}

/* The number of the sample frame that this is, every bit of it being right. */
static int32_t check_frame(const rlf_frame *f, bool is_float)
{
    const int64_t first = 1700000000123456789;
    const int32_t i = (int32_t)((f->time_ns - first) / SAMPLE_FRAME_NS);
    const rlf_frame want = sample_frame(f->rig, i, is_float);
    assert_true(f->time_ns == want.time_ns);
    assert_true(f->color_time_ns == want.color_time_ns);
    assert_int_equal(f->flags & ~(uint32_t)RLF_FRAME_DISCONTINUITY, RLF_FRAME_UNMIRRORED);
    assert_true(is_float || f->depth_units_per_metre == 4000);
    const void *depth = is_float ? (const void *)f->depth_f32 : f->depth_u16;
    assert_non_null(depth);
    assert_memory_equal(depth, is_float ? (const void *)sample_metres : sample_depth,
                        is_float ? sizeof(sample_metres) : sizeof(sample_depth));
    assert_memory_equal(f->color.data, sample_color, sizeof(sample_color));
    assert_true(f->has_pose);
    assert_memory_equal(&f->T_world_camera, &want.T_world_camera, sizeof(want.T_world_camera));
    return i;
}

/* All frames that come are right and in order; returns how many. */
static int32_t check_frames(const char *path, bool is_float)
{
    rlf_source *source = open_file(path);
    check_rig(&rlf_source_get_info(source)->rig);
    int32_t count = 0;
    int32_t last = -1;
    rlf_frame frame;
    while (rlf_source_next(source, &frame) == RLF_OK) {
        const int32_t i = check_frame(&frame, is_float);
        assert_true(i > last);
        last = i;
        count++;
    }
    rlf_source_destroy(&source);
    return count;
}

TEST_CASE(what_goes_in_comes_out)
{
    for (int codec = 0; codec < 2; codec++) {
        for (int compression = 0; compression < 3; compression++) {
            const rlf_recording_def def =
                sample_def((rlf_depth_codec)codec, (rlf_compression)compression);
            for (int is_float = 0; is_float < 2; is_float++) {
                sample_record(test_path("a.mcap"), &def, 20, is_float != 0);
                assert_int_equal(check_frames(test_path("a.mcap"), is_float != 0), 20);
            }
        }
    }
}

TEST_CASE(any_frame_can_be_gone_to)
{
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_ZSTD);
    sample_record(test_path("a.mcap"), &def, 30, false);
    rlf_source *source = open_file(test_path("a.mcap"));
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_int_equal(info->frame_count, 30);
    assert_true(info->frames_per_second > 29.9 && info->frames_per_second < 30.1);
    for (int32_t i = 29; i >= 0; i -= 7) {
        rlf_frame frame;
        assert_int_equal(rlf_source_seek(source, i), RLF_OK);
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_int_equal(check_frame(&frame, false), i);
    }
    rlf_source_destroy(&source);
}

TEST_CASE(folders_and_files_turn_into_each_other)
{
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_ZSTD);
    char folder[TEST_PATH_MAX];
    snprintf(folder, sizeof(folder), "%s/", test_path("clip"));
    sample_record(folder, &def, 5, false);
    rlf_source *source = open_file(test_path("clip"));
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    const rlf_source_info want = sample_info();
    assert_memory_equal(&rig->depth, &want.rig.depth, sizeof(rig->depth));
    assert_memory_equal(&rig->noise, &want.rig.noise, sizeof(rig->noise));
    for (int32_t i = 0; i < 5; i++) {
        rlf_frame frame;
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        const rlf_frame sample = sample_frame(rig, i, false);
        assert_true(frame.time_ns == sample.time_ns);
        assert_true(frame.depth_units_per_metre == 4000);
        assert_memory_equal(frame.depth_u16, sample_depth, sizeof(sample_depth));
        assert_memory_equal(frame.color.data, sample_color, sizeof(sample_color));
    }
    rlf_source_destroy(&source);
}

/* ---- damage -----------------------------------------------------------------------------------
 */

/* Whole chunks in so many bytes. */
static int32_t count_chunks(const uint8_t *data, size_t size)
{
    int32_t chunks = 0;
    cursor c = {data, size, false};
    cursor_take(&c, IO_MCAP_MAGIC_SIZE);
    cursor record;
    for (uint8_t op; (op = io_mcap_take_record(&c, &record)) != 0;) {
        chunks += op == IO_MCAP_CHUNK;
    }
    return chunks;
}

TEST_CASE(every_prefix_gives_its_whole_chunks)
{
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_ZSTD);
    sample_record(test_path("a.mcap"), &def, 7, false);
    size_t size;
    char *data = test_read(test_path("a.mcap"), &size);
    const int32_t all = count_chunks((const uint8_t *)data, size);
    assert_int_equal(all, 3);
    rlf_set_log(NULL, NULL);
    int32_t last = 0;
    for (size_t length = 0; length <= size; length++) {
        test_write("b.mcap", data, length);
        const int32_t chunks = count_chunks((const uint8_t *)data, length);
        if (chunks == 0) {
            rlf_source *source = NULL;
            assert_true(rlf_open_source(test_path("b.mcap"), NULL, &source) < 0);
            assert_non_null(strstr(rlf_error_text(), "b.mcap"));
            continue;
        }
        const int32_t frames = check_frames(test_path("b.mcap"), false);
        /* The first chunk has the first frame, the others three each. */
        assert_int_equal(frames, chunks == all ? 7 : 1 + 3 * (chunks - 1));
        assert_true(frames >= last);
        last = frames;
    }
    free(data);
}

/* Where the n-th chunk begins and ends. */
static size_t find_chunk(const uint8_t *data, size_t size, int32_t n, size_t *out_end)
{
    cursor c = {data + IO_MCAP_MAGIC_SIZE, size - IO_MCAP_MAGIC_SIZE, false};
    cursor record;
    for (;;) {
        const size_t begin = size - c.left;
        const uint8_t op = io_mcap_take_record(&c, &record);
        assert_true(op != 0);
        *out_end = size - c.left;
        if (op == IO_MCAP_CHUNK && n-- == 0) {
            return begin;
        }
    }
}

TEST_CASE(a_damaged_chunk_is_left_out_and_told)
{
    for (int compression = 0; compression < 3; compression++) {
        const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, (rlf_compression)compression);
        sample_record(test_path("a.mcap"), &def, 16, false);
        size_t size, end;
        char *data = test_read(test_path("a.mcap"), &size);
        find_chunk((const uint8_t *)data, size, 2, &end);
        data[end - 40] = (char)(data[end - 40] ^ 0x10);
        for (int has_summary = 1; has_summary >= 0; has_summary--) {
            test_write("b.mcap", data, has_summary ? size : size - 1);
            test_log log = {0};
            rlf_set_log(test_log_line, &log);
            assert_int_equal(check_frames(test_path("b.mcap"), false), 13);
            rlf_set_log(NULL, NULL);
            /* Of the chunk; then of its first frame and how many were left out, or of the file
             * without an end. */
            assert_int_equal(log.count, has_summary ? 3 : 2);
        }
        free(data);
    }
}

TEST_CASE(a_chunk_that_claims_too_much_is_left_out)
{
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_ZSTD);
    sample_record(test_path("a.mcap"), &def, 16, false);
    size_t size, end;
    char *data = test_read(test_path("a.mcap"), &size);
    const size_t begin = find_chunk((const uint8_t *)data, size, 1, &end);
    const uint64_t claims[3] = {UINT64_MAX, (uint64_t)1 << 32, 200000000};
    rlf_set_log(NULL, NULL);
    for (int i = 0; i < 3; i++) {
        memcpy(data + begin + IO_MCAP_RECORD_HEAD + 16, &claims[i], 8);
        test_write("b.mcap", data, size);
        assert_int_equal(check_frames(test_path("b.mcap"), false), 13);
    }
    free(data);
}

/* A limit on the size of files stands for a disk that is full. */
TEST_CASE(a_full_disk_keeps_what_was_written)
{
    const rlf_source_info info = sample_info();
    rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_NONE);
    struct rlimit before;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, SIG_IGN);
    for (rlim_t limit = 20000; limit < 36000; limit += 777) {
        const struct rlimit full = {limit, before.rlim_max};
        rlf_recording *recording = NULL;
        assert_int_equal(rlf_recording_open(test_path("a.mcap"), &info, &def, &recording), RLF_OK);
        setrlimit(RLIMIT_FSIZE, &full);
        rlf_result result = RLF_OK;
        for (int32_t i = 0; i < 200 && result == RLF_OK; i++) {
            const rlf_frame frame = sample_frame(&info.rig, i, false);
            result = rlf_recording_add(recording, &frame);
        }
        test_expect_error(result, RLF_ERROR_IO, "a.mcap", "cannot be written", "free some space");
        result = rlf_recording_close(&recording, NULL);
        setrlimit(RLIMIT_FSIZE, &before);
        test_expect_error(result, RLF_ERROR_IO, "a.mcap", "cannot be written", "is kept");
        size_t size;
        char *data = test_read(test_path("a.mcap"), &size);
        assert_true(size <= limit);
        assert_memory_equal(data + size - IO_MCAP_MAGIC_SIZE, io_mcap_magic, IO_MCAP_MAGIC_SIZE);
        const int32_t chunks = count_chunks((const uint8_t *)data, size);
        free(data);
        assert_true(chunks > 0);
        test_log log = {0};
        rlf_set_log(test_log_line, &log);
        assert_int_equal(check_frames(test_path("a.mcap"), false), 1 + 3 * (chunks - 1));
        rlf_set_log(NULL, NULL);
        assert_int_equal(log.count, 0);
    }
}

TEST_CASE(files_that_are_none_are_refused)
{
    rlf_source *source = NULL;
    test_write_text("a.mcap", "hello, this is no recording at all, but it has some length");
    test_expect_error(rlf_open_source(test_path("a.mcap"), NULL, &source), RLF_ERROR_FORMAT,
                      "a.mcap", "is not an MCAP file", NULL);
    test_write_text("a.mcap", "");
    test_expect_error(rlf_open_source(test_path("a.mcap"), NULL, &source), RLF_ERROR_FORMAT,
                      "a.mcap", "is not an MCAP file", NULL);
    test_expect_error(rlf_open_source(test_path("none.mcap"), NULL, &source), RLF_ERROR_IO,
                      "none.mcap", NULL, NULL);
    const rlf_source_info info = sample_info();
    const rlf_recording_def def = rlf_recording_def_default();
    rlf_recording *recording = NULL;
    test_expect_error(rlf_recording_open(test_path("no/such/a.mcap"), &info, &def, &recording),
                      RLF_ERROR_IO, "no/such", "cannot be created", "folder");
}

TEST_EACH(test_folder_make, test_folder_remove)
