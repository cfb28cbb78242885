/* MCAP files without chunks, or without an index of them: the format allows both. */
#define _POSIX_C_SOURCE 200809L

#include "io/mcap/mcap.h"
#include "relief/io.h"
#include "ros_file.h"
#include "test.h"

#define FRAMES 4
#define DATA_LONGEST 40 /* head of a chunk: 8 + 8 + 8 + 4 + 4 + 8, its compression "" */

static const uint32_t size[2] = {4, 3};

/* Two chunks of two pictures each. */
static void make(void)
{
    uint16_t depth[12] = {1000};
    ros_file f = ros_file_open("whole");
    const uint16_t d = ros_topic(&f, IO_ROS_IMAGE, "/d/image");
    const uint16_t i = ros_topic(&f, IO_ROS_CAMERA_INFO, "/d/camera_info");
    const io_camera_info info = ros_lens("d", size, 4);
    ros_info(&f, i, &info);
    for (int n = 0; n < FRAMES; n++) {
        depth[0] = (uint16_t)(1000 + n);
        f.ms = 33 * n;
        ros_image(&f, d, "d", "16UC1", size, depth, sizeof(depth));
        if (n == 1) {
            assert_int_equal(io_mcap_flush(f.mcap), RLF_OK);
        }
    }
    ros_file_close(&f, "whole");
}

/* What is made of the whole file. */
typedef struct change {
    int chunks;      /* so many stay; the records of the others lie in the file itself */
    bool has_index;  /* ChunkIndex of those that stay */
    bool has_counts; /* Statistics */
    bool has_summary;
    bool is_closed, is_damaged;
    const char *text; /* what is told; NULL = nothing */
} change;

static void put_record(byte_file *out, const uint8_t *record, uint64_t length)
{
    bytes_put(out, record, IO_MCAP_RECORD_HEAD + length);
}

static void end_file(byte_file *out, uint64_t summary_at)
{
    bytes_u8(out, IO_MCAP_FOOTER);
    bytes_u64(out, 20);
    bytes_u64(out, summary_at);
    bytes_u64(out, 0);
    bytes_u32(out, 0);
    bytes_put(out, io_mcap_magic, IO_MCAP_MAGIC_SIZE);
}

static void rewrite(const change *c)
{
    size_t whole_size;
    char *whole = test_read(test_path("whole.mcap"), &whole_size);
    byte_file *out = calloc(1, sizeof(*out));
    uint64_t summary_at = 0;
    int chunks = 0, indexes = 0;
    bytes_put(out, whole, IO_MCAP_MAGIC_SIZE);
    for (size_t at = IO_MCAP_MAGIC_SIZE; at + IO_MCAP_MAGIC_SIZE < whole_size;) {
        const uint8_t *record = (const uint8_t *)whole + at;
        uint64_t length;
        memcpy(&length, record + 1, 8);
        at += IO_MCAP_RECORD_HEAD + length;
        const bool is_late = summary_at > 0;
        switch (record[0]) {
        case IO_MCAP_CHUNK:
            if (chunks++ < c->chunks) {
                put_record(out, record, length);
            } else {
                bytes_put(out, record + IO_MCAP_RECORD_HEAD + DATA_LONGEST, length - DATA_LONGEST);
            }
            break;
        case IO_MCAP_MESSAGE_INDEX:
            if (chunks <= c->chunks) {
                put_record(out, record, length);
            }
            break;
        case IO_MCAP_DATA_END:
            if (c->is_damaged) {
                bytes_put(out, "\0\0\0\0", 4);
            }
            put_record(out, record, 4);
            summary_at = out->size;
            break;
        case IO_MCAP_CHUNK_INDEX:
            if (c->has_summary && c->has_index && indexes++ < c->chunks) {
                put_record(out, record, length);
            }
            break;
        case IO_MCAP_STATISTICS:
            if (c->has_summary && c->has_counts) {
                put_record(out, record, length);
            }
            break;
        case IO_MCAP_HEADER: put_record(out, record, length); break;
        case IO_MCAP_SCHEMA:
        case IO_MCAP_CHANNEL:
            if (c->has_summary || !is_late) {
                put_record(out, record, length);
            }
            break;
        default: break;
        }
    }
    end_file(out, c->has_summary ? summary_at : 0);
    test_write("a.mcap", out->data, c->is_closed ? out->size : summary_at - 20);
    free(out);
    free(whole);
}

static void expect(const change *c, size_t index)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rewrite(c);
    rlf_source *source = NULL;
    rlf_frame frame;
    if (rlf_open_source(test_path("a.mcap"), NULL, &source) != RLF_OK) {
        fail_msg("%zu: %s", index, rlf_error_text());
    }
    const int32_t count = c->is_closed ? FRAMES : FRAMES - 1;
    if (rlf_source_get_info(source)->frame_count != count ||
        log.count != (c->text != NULL ? 1 : 0) ||
        (c->text != NULL && strstr(log.last, c->text) == NULL)) {
        fail_msg("%zu: %d frames, %d lines: %s", index,
                 (int)rlf_source_get_info(source)->frame_count, log.count, log.last);
    }
    for (int32_t n = 0; n < count; n++) {
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_int_equal(frame.depth_u16[0], 1000 + n);
    }
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
}

TEST_CASE(files_without_chunks_or_index_are_read)
{
    static const change changes[] = {
        {.chunks = 2,
         .has_index = true,
         .has_counts = true,
         .has_summary = true,
         .is_closed = true},
        {.chunks = 0, .is_closed = true},
        {.chunks = 0, .has_summary = true, .is_closed = true},
        {.chunks = 0, .has_summary = true, .has_counts = true, .is_closed = true},
        {.chunks = 2, .is_closed = true},
        {.chunks = 2, .has_summary = true, .has_counts = true, .is_closed = true},
        {.chunks = 1, .is_closed = true},
        /* Messages beside chunks that have an index. */
        {.chunks = 1,
         .has_index = true,
         .has_counts = true,
         .has_summary = true,
         .is_closed = true},
        {.chunks = 1, .has_index = true, .has_summary = true, .is_closed = true},
        {.chunks = 0, .text = "was not closed as it should have been: its 0 whole chunks, and 4"},
        {.chunks = 1, .text = "was not closed as it should have been: its 1 whole chunks, and 4"},
        {.chunks = 1, .is_closed = true, .is_damaged = true, .text = "is damaged (byte"},
    };
    make();
    for (size_t i = 0; i < sizeof(changes) / sizeof(changes[0]); i++) {
        expect(&changes[i], i);
    }
}

TEST_EACH(test_folder_make, test_folder_remove)
