/* ROS 1 bags: topics, calibration, transforms, every kind of chunk, damage of every kind. */
#define _POSIX_C_SOURCE 200809L
#include "bag_sample.h"
#include "io/ros/bag.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>
#ifdef RLF_HAVE_BZ2
#include <bzlib.h>
#endif

static void save(bag_file *b)
{
    test_write("clip.bag", b->file.data, b->file.size);
    free(b);
}

static rlf_source *open_bag(const char *keys)
{
    char source[TEST_PATH_MAX];
    snprintf(source, sizeof(source), "rosbag:%s%s", test_path("clip.bag"), keys);
    rlf_source *opened = NULL;
    if (rlf_open_source(source, NULL, &opened) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return opened;
}

static void expect_frame(rlf_source *source, int i)
{
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.time_ns, 1000000000 + i * 31250000);
    assert_true(frame.depth_units_per_metre == 1000.0);
    for (int p = 0; p < BAG_SAMPLE_PIXELS; p++) {
        assert_int_equal(frame.depth_u16[p], 1000 * i + p);
    }
    assert_non_null(frame.color.data);
    assert_int_equal(frame.color_time_ns, 1010000000 + i * 31250000);
    const uint8_t red[4] = {(uint8_t)(50 * i), 0, 0, 255};
    assert_memory_equal(frame.color.data, red, 4);
}

static void expect_all(rlf_source *source)
{
    assert_int_equal(rlf_source_get_info(source)->frame_count, BAG_SAMPLE_FRAMES);
    rlf_frame frame;
    for (int i = 0; i < BAG_SAMPLE_FRAMES; i++) {
        expect_frame(source, i);
    }
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    assert_int_equal(rlf_source_seek(source, 1), RLF_OK);
    expect_frame(source, 1);
}

TEST_CASE_WITH(frames_and_cameras_are_read, test_folder_make, test_folder_remove)
{
    save(bag_sample_make(true));
    rlf_source *source = open_bag("");
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    assert_int_equal(rig->depth.width, 4);
    assert_true(rig->depth.fx == 4.5 && rig->depth.fy == 4.25);
    assert_true(rig->depth.cx == 1.5 && rig->depth.cy == 1.0);
    assert_int_equal(rig->depth.distortion_model, RLF_DISTORTION_PLUMB_BOB);
    assert_true(rig->depth.distortion[4] == 0.05 && rig->depth.distortion[5] == 0.0);
    assert_true(rig->has_color);
    assert_int_equal(rig->color.width, 2);
    assert_int_equal(rig->color.distortion_model, RLF_DISTORTION_RATIONAL_POLYNOMIAL);
    assert_true(rig->color.distortion[7] == 0.01);
    assert_true(fabs(rig->T_color_depth.p.x + 0.05) < 1e-12);
    assert_true(rig->T_color_depth.q.w == 1.0);
    assert_true(fabs(rlf_source_get_info(source)->frames_per_second - 32.0) < 1e-6);
    expect_all(source);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(a_bag_without_an_index_is_read, test_folder_make, test_folder_remove)
{
    save(bag_sample_make(false));
    rlf_source *source = open_bag("");
    expect_all(source);
    rlf_source_destroy(&source);
}

/* The header of a chunk is written last: until then it says 0 and what follows has no index. */
TEST_CASE_WITH(a_chunk_that_was_never_ended_is_read, test_folder_make, test_folder_remove)
{
    bag_file *b = bag_file_new();
    for (int i = 0; i < BAG_SAMPLE_FRAMES; i++) {
        bag_sample_chunk(b, i);
        if (i + 1 < BAG_SAMPLE_FRAMES) {
            bag_file_flush(b, "none", NULL, true);
        }
    }
    byte_file *rest = calloc(1, sizeof(*rest));
    *rest = b->chunk;
    b->chunk.size = 0;
    bag_file_flush(b, "none", NULL, false);
    bytes_put(&b->file, rest->data, rest->size);
    free(rest);
    save(b);
    rlf_source *source = open_bag("");
    expect_all(source);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(lz4_chunks_are_read, test_folder_make, test_folder_remove)
{
    bag_file *b = bag_file_new();
    byte_file *packed = calloc(1, sizeof(*packed));
    for (int i = 0; i < BAG_SAMPLE_FRAMES; i++) {
        bag_sample_chunk(b, i);
        bag_sample_lz4(&b->chunk, packed);
        bag_file_flush(b, "lz4", packed, i != 1);
    }
    bag_file_finish(b);
    save(b);
    free(packed);
#ifdef RLF_HAVE_LZ4
    rlf_source *source = open_bag("");
    expect_all(source);
    rlf_source_destroy(&source);
#else
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source(test_path("clip.bag"), NULL, &source), RLF_ERROR_UNSUPPORTED,
                      "clip.bag", "lz4", "liblz4-dev");
#endif
}

/* Their times are those of recording: unpacking all of them for the stamps would take too long. */
TEST_CASE_WITH(bz2_chunks_are_read, test_folder_make, test_folder_remove)
{
#ifdef RLF_HAVE_BZ2
    bag_file *b = bag_file_new();
    byte_file *packed = calloc(1, sizeof(*packed));
    for (int i = 0; i < BAG_SAMPLE_FRAMES; i++) {
        bag_sample_chunk(b, i);
        unsigned size = BYTE_FILE_MAX;
        assert_int_equal(BZ2_bzBuffToBuffCompress((char *)packed->data, &size,
                                                  (char *)b->chunk.data, (unsigned)b->chunk.size, 9,
                                                  0, 0),
                         BZ_OK);
        packed->size = size;
        bag_file_flush(b, "bz2", packed, i != 1);
    }
    bag_file_finish(b);
    save(b);
    free(packed);
    rlf_source *source = open_bag("?gap=200");
    rlf_frame frame;
    for (int i = 0; i < BAG_SAMPLE_FRAMES; i++) {
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_int_equal(frame.depth_u16[5], 1000 * i + 5);
        assert_int_equal(frame.time_ns, 1500000000 + i * 31250000);
        assert_non_null(frame.color.data);
    }
    rlf_source_destroy(&source);
#else
    print_message("SKIPPED: built without bz2\n");
    skip();
#endif
}

TEST_CASE_WITH(topics_can_be_chosen, test_folder_make, test_folder_remove)
{
    save(bag_sample_make(true));
    rlf_source *source = open_bag("?depth=/camera/depth/image_raw&color=none");
    assert_false(rlf_source_get_info(source)->rig.has_color);
    rlf_source_destroy(&source);
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    source = open_bag("?color=/camera/rgb/image_raw&gap=5");
    assert_non_null(strstr(log.last, "10 ms or more away"));
    rlf_set_log(NULL, NULL);
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_null(frame.color.data); /* 10 ms away */
    assert_int_equal(rlf_source_get_status(source).unpaired, 1);
    rlf_source_destroy(&source);
    char name[TEST_PATH_MAX];
    snprintf(name, sizeof(name), "rosbag:%s?depth=/tf_static", test_path("clip.bag"));
    test_expect_error(rlf_open_source(name, NULL, &source), RLF_ERROR_INVALID, "clip.bag",
                      "depth=/tf_static", "/camera/depth/image_raw (16UC1)");
    snprintf(name, sizeof(name), "rosbag:%s?gap=x", test_path("clip.bag"));
    test_expect_error(rlf_open_source(name, NULL, &source), RLF_ERROR_INVALID, "clip.bag", "gap=x",
                      "milliseconds");
}

/* Every prefix: an error line, or the frames that are whole. */
TEST_CASE_WITH(every_prefix_gives_whole_frames, test_folder_make, test_folder_remove)
{
    rlf_set_log(NULL, NULL);
    bag_file *b = bag_sample_make(true);
    int64_t most = 0;
    for (size_t size = 0; size <= b->file.size; size += size < 200 ? 1 : 7) {
        test_write("clip.bag", b->file.data, size);
        rlf_source *source = NULL;
        if (rlf_open_source(test_path("clip.bag"), NULL, &source) != RLF_OK) {
            assert_null(strchr(rlf_error_text(), '\n'));
            continue;
        }
        rlf_frame frame;
        int64_t count = 0;
        while (rlf_source_next(source, &frame) == RLF_OK) {
            assert_int_equal(frame.depth_u16[5], 1000 * count + 5);
            count++;
        }
        assert_true(count >= most);
        most = count;
        rlf_source_destroy(&source);
    }
    assert_int_equal(most, BAG_SAMPLE_FRAMES);
    free(b);
    rlf_set_log(test_log_line, &(test_log){0});
}

/* Sizes that no memory holds cost none. */
TEST_CASE_WITH(chunks_that_lie_are_refused, test_folder_make, test_folder_remove)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    const char *const kinds[3] = {"none", "lz4", "bz2"};
    for (int i = 0; i < 3; i++) {
#ifndef RLF_HAVE_LZ4
        if (i == 1) {
            continue;
        }
#endif
#ifndef RLF_HAVE_BZ2
        if (i == 2) {
            continue;
        }
#endif
        bag_file *b = bag_file_new();
        bag_sample_chunk(b, 0);
        byte_file *packed = calloc(1, sizeof(*packed));
        bytes_u32(packed, 0x184D2204);
        b->chunk.size = 0xFFFFFFFFu; /* what the header will claim */
        bag_file_flush(b, kinds[i], packed, true);
        save(b);
        free(packed);
        rlf_source *source = NULL;
        log.last[0] = '\0';
        test_expect_error(rlf_open_source(test_path("clip.bag"), NULL, &source), RLF_ERROR_FORMAT,
                          "clip.bag", "no depth pictures", NULL);
        assert_non_null(strstr(log.last, i < 2 ? "damaged or cut short at byte" : "claims to"));
    }
    rlf_set_log(NULL, NULL);
}

/* A chunk that claims to be empty has no memory to unpack into. */
TEST_CASE_WITH(a_chunk_that_claims_to_be_empty_is_refused, test_folder_make, test_folder_remove)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    const char *const kinds[3] = {"lz4", "bz2", "none"};
    for (int i = 0; i < 3; i++) {
        bag_file *b = bag_file_new();
        bag_sample_chunk(b, 0);
        byte_file *packed = calloc(1, sizeof(*packed));
        bag_sample_lz4(&b->chunk, packed);
        packed->size = i == 2 ? 0 : packed->size;
        b->chunk.size = 0; /* what the header will claim */
        bag_file_flush(b, kinds[i], packed, false);
        save(b);
        free(packed);
        rlf_source *source = NULL;
        const rlf_result wanted = rlf_open_source(test_path("clip.bag"), NULL, &source);
        assert_true(wanted == RLF_ERROR_FORMAT || wanted == RLF_ERROR_UNSUPPORTED);
        assert_null(source);
    }
    rlf_set_log(NULL, NULL);
}

TEST_CASE_WITH(a_file_that_is_no_bag_is_told, test_folder_make, test_folder_remove)
{
    rlf_source *source = NULL;
    test_write_text("clip.bag", "#ROSBAG V1.2\nnot for us");
    test_expect_error(rlf_open_source(test_path("clip.bag"), NULL, &source), RLF_ERROR_FORMAT,
                      "clip.bag", "version 2.0", "rosbag fix");
    test_expect_error(rlf_open_source("rosbag:/nowhere.bag", NULL, &source), RLF_ERROR_IO,
                      "/nowhere.bag", "cannot be opened", "check");
}

TEST_CASE_WITH(without_camera_info_a_file_beside_serves, test_folder_make, test_folder_remove)
{
    bag_file *b = bag_file_new();
    bag_file_connect(b, 3, "/depth/image", "sensor_msgs/Image");
    bag_file_connect(b, 4, "/rgb/image", "sensor_msgs/Image");
    bag_sample_frame(b, 0);
    bag_file_flush(b, "none", NULL, true);
    bag_file_finish(b);
    save(b);
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source(test_path("clip.bag"), NULL, &source), RLF_ERROR_FORMAT,
                      "clip.bag", "/depth/image", "camera=FILE");
    test_write_text("clip.json", "{\"depth\": {\"width\": 4, \"height\": 3, \"fx\": 5, \"fy\": 5, "
                                 "\"cx\": 2, \"cy\": 1, \"units_per_metre\": 5000}}");
    source = open_bag("");
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_true(frame.depth_units_per_metre == 5000.0);
    assert_null(frame.color.data);
    rlf_source_destroy(&source);
    test_write_text("clip.json", "{\"depth\": {\"width\": 8, \"height\": 6, \"fx\": 5, \"fy\": 5, "
                                 "\"cx\": 2, \"cy\": 1, \"units_per_metre\": 5000}}");
    test_expect_error(rlf_open_source(test_path("clip.bag"), NULL, &source), RLF_ERROR_INVALID,
                      "4 x 3", "8 x 6", "camera=FILE");
}

/* As librealsense writes them: the reference is the depth stream, units in an option. */
TEST_CASE(realsense_topics_are_known)
{
#ifndef RLF_HAVE_LZ4
    puts("SKIPPED: built without lz4");
    skip();
#endif
    const char *path = RLF_TEST_SHARED "/data/realsense_d435_one_frame.bag";
    if (!test_exists(path)) {
        print_message("SKIPPED: no %s\n", path);
        skip();
    }
    char name[TEST_PATH_MAX];
    snprintf(name, sizeof(name), "rosbag:%s?gap=200", path);
    rlf_source *source = NULL;
    assert_int_equal(rlf_open_source(name, NULL, &source), RLF_OK);
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_true(fabs(info->rig.depth.fx - 390.43) < 0.01);
    assert_true(fabs(info->rig.depth.cx - 331.39) < 0.01);
    assert_true(fabs(info->rig.T_color_depth.p.x - 0.01431) < 1e-5);
    assert_non_null(strstr(info->device, "RealSense D435"));
    assert_int_equal(info->frame_count, 2);
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_true(fabs(frame.depth_units_per_metre - 1000.0) < 1e-3);
    assert_int_equal(frame.depth_u16[240 * 640 + 320], 1536);
    assert_non_null(frame.color.data);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.depth_u16[240 * 640 + 320], 1540);
    rlf_source_destroy(&source);
}
