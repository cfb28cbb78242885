/* A recorder that is killed at a random moment: what it wrote until then can be read, all of it.
 * test_io_mcap_killed [TIMES]: 10 by default. */
#define _POSIX_C_SOURCE 200809L

#include "io/mcap/mcap.h"
#include "recording_sample.h"
#include "test.h"

#include <signal.h>
#include <sys/wait.h>
#include <time.h>

static int times = 10;

/* Never returns. */
static void record_until_killed(const char *path, const rlf_recording_def *def)
{
    const rlf_source_info info = sample_info();
    rlf_recording *recording = NULL;
    bool is_good = rlf_recording_open(path, &info, def, &recording) == RLF_OK;
    for (int32_t i = 0; is_good; i++) {
        const rlf_frame frame = sample_frame(&info.rig, i, false);
        is_good = rlf_recording_add(recording, &frame) == RLF_OK;
    }
    _exit(1);
}

/* Frames in the whole chunks of the file: the records of Message, one in four of which is of depth;
 * counted from the uncompressed chunks, without any of the reader. */
static int32_t count_frames(const uint8_t *data, size_t size, int32_t *out_chunks)
{
    int32_t messages = 0;
    cursor c = {data, size, false};
    cursor_take(&c, IO_MCAP_MAGIC_SIZE);
    cursor record;
    *out_chunks = 0;
    for (uint8_t op; (op = io_mcap_take_record(&c, &record)) != 0;) {
        if (op != IO_MCAP_CHUNK) {
            continue;
        }
        ++*out_chunks;
        cursor_take(&record, 28);
        cursor_block(&record);
        cursor_take(&record, 8);
        cursor message;
        for (uint8_t inner; (inner = io_mcap_take_record(&record, &message)) != 0;) {
            messages += inner == IO_MCAP_MESSAGE;
        }
    }
    /* Each frame has a picture of depth, one of colour and a pose; the first three messages are
     * calibration. */
    return (messages - 3) / 3;
}

static int32_t read_frames(const char *path)
{
    rlf_source *source = NULL;
    if (rlf_open_source(path, NULL, &source) != RLF_OK) {
        fail_msg("refused: %s", rlf_error_text());
    }
    int32_t count = 0;
    rlf_frame frame;
    while (rlf_source_next(source, &frame) == RLF_OK) {
        const rlf_frame want = sample_frame(frame.rig, count, false);
        assert_true(frame.time_ns == want.time_ns);
        assert_memory_equal(frame.depth_u16, sample_depth, sizeof(sample_depth));
        assert_memory_equal(frame.color.data, sample_color, sizeof(sample_color));
        count++;
    }
    assert_int_equal(rlf_source_get_status(source).damaged, 0);
    rlf_source_destroy(&source);
    return count;
}

static void whole_chunks_are_read_whenever_it_dies(void **state)
{
    (void)state;
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_NONE);
    rlf_set_log(NULL, NULL);
    uint32_t random = (uint32_t)time(NULL) | 1;
    int recorded = 0;
    int64_t chunks_read = 0;
    for (int i = 0; i < times; i++) {
        remove(test_path("a.mcap"));
        const pid_t child = fork();
        if (child == 0) {
            record_until_killed(test_path("a.mcap"), &def);
        }
        assert_true(child > 0);
        random = random * 1664525u + 1013904223u;
        const struct timespec pause = {.tv_nsec = 1000000 + (long)(random % 150000000)};
        nanosleep(&pause, NULL);
        kill(child, SIGKILL);
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status));
        if (!test_exists(test_path("a.mcap"))) {
            continue; /* it had not begun */
        }
        size_t size;
        char *data = test_read(test_path("a.mcap"), &size);
        int32_t chunks;
        const int32_t frames = count_frames((const uint8_t *)data, size, &chunks);
        free(data);
        if (chunks > 0) {
            assert_int_equal(read_frames(test_path("a.mcap")), frames);
            recorded++;
            chunks_read += chunks;
        }
    }
    print_message("killed %d times: %d files with pictures, %lld whole chunks, all read\n", times,
                  recorded, (long long)chunks_read);
}

int main(int argc, char **argv)
{
    times = argc > 1 ? atoi(argv[1]) : times;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(whole_chunks_are_read_whenever_it_dies, test_folder_make,
                                        test_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
