/* Recordings of ROS 1 and 2 alike: which topics are taken, and which lens is theirs. */
#define _POSIX_C_SOURCE 200809L

#include "io/mcap/mcap.h"
#include "io/picture/picture.h"
#include "relief/io.h"
#include "ros_file.h"
#include "test.h"

#include <math.h>

static const uint32_t small[2] = {8, 6};
static const uint32_t coded[2] = {0, 0};
static uint16_t depth_mm[48];
static uint8_t rgb[144];
static test_log told;

/* Keeps what was told first: the last line may be another matter. */
static void keep_all(void *context, rlf_log_level level, const char *line)
{
    test_log *log = context;
    (void)level;
    log->count++;
    const size_t length = strlen(log->last);
    snprintf(log->last + length, sizeof(log->last) - length, "%s\n", line);
}

static int set_up(void **state)
{
    memset(&told, 0, sizeof(told));
    rlf_set_log(keep_all, &told);
    for (int i = 0; i < 48; i++) {
        depth_mm[i] = (uint16_t)(1000 + i);
    }
    return test_folder_make(state);
}

static int tear_down(void **state)
{
    rlf_set_log(NULL, NULL);
    return test_folder_remove(state);
}

/* Opens a.mcap or a.bag with keys. */
static rlf_result open_one(int kind, const char *keys, rlf_source **out)
{
    char address[TEST_PATH_MAX];
    memset(&told, 0, sizeof(told));
    snprintf(address, sizeof(address), "%s:%s%s", kind == 0 ? "mcap" : "rosbag",
             test_path(kind == 0 ? "a.mcap" : "a.bag"), keys);
    return rlf_open_source(address, NULL, out);
}

static void expect_told(const char *text)
{
    if (strstr(told.last, text) == NULL) {
        fail_msg("\"%s\" does not mention \"%s\"", told.last, text);
    }
}

/* ---- the lens ------------------------------------------------------------------------------- */

TEST_CASE(binning_and_windows_are_applied)
{
    static const struct {
        uint32_t width, height;
        io_camera_window window;
        double fx, cx, cy;
    } cases[] = {
        {8, 6, {0}, 100, 50, 40},
        {8, 6, {.binning_x = 1, .binning_y = 1}, 100, 50, 40},
        /* The centre of two joined pixels lies between them. */
        {16, 12, {.binning_x = 2, .binning_y = 2}, 50, 24.75, 19.75},
        {16, 6, {.binning_x = 2}, 50, 24.75, 40},
        {20, 20, {.x = 4, .y = 6, .width = 8, .height = 6}, 100, 46, 34},
        {20, 20, {4, 6, 16, 12, 2, 2}, 50, 22.75, 16.75},
        {8, 6, {.x = 4, .y = 6}, 100, 50, 40}, /* 0 x 0: all of it */
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        io_camera_info info = ros_lens("d", (uint32_t[2]){cases[i].width, cases[i].height}, 100);
        info.k[2] = info.p[2] = 50;
        info.k[5] = info.p[6] = 40;
        info.window = cases[i].window;
        rlf_camera camera;
        assert_int_equal(io_camera_info_lens(&info, "a.mcap", "/d/image_raw", &camera), RLF_OK);
        assert_int_equal(camera.width, 8);
        assert_int_equal(camera.height, 6);
        assert_true(camera.fx == cases[i].fx && camera.cx == cases[i].cx &&
                    camera.cy == cases[i].cy);
    }
    assert_int_equal(told.count, 0);
    io_camera_info info = ros_lens("d", small, 100);
    info.window = (io_camera_window){.x = 4, .y = 0, .width = 8, .height = 6};
    rlf_camera camera;
    test_expect_error(io_camera_info_lens(&info, "a.mcap", "/d/image_raw", &camera),
                      RLF_ERROR_FORMAT, "a.mcap", "/d/image_raw", "?camera=FILE");
    info = ros_lens("d", small, 0);
    test_expect_error(io_camera_info_lens(&info, "a.mcap", "/d/image_raw", &camera),
                      RLF_ERROR_FORMAT, "a.mcap", "not calibrated", "?camera=FILE");
    info = ros_lens("d", small, 100);
    info.d[1] = (double)NAN;
    test_expect_error(io_camera_info_lens(&info, "a.mcap", "/d/image_raw", &camera),
                      RLF_ERROR_FORMAT, "a.mcap", "distortion[1] is not a finite", "?camera=FILE");
}

/* Rays of known angles, by the formula of the lens, are where the fitted camera puts them. */
TEST_CASE(an_equidistant_lens_is_fitted)
{
    static const double lenses[][4] = {{0, 0, 0, 0}, {0.02, -0.005, 0.001, 0}, {-0.03, 0.01, 0, 0}};
    for (size_t i = 0; i < sizeof(lenses) / sizeof(lenses[0]); i++) {
        const double *k = lenses[i];
        rlf_camera c = {.width = 640, .height = 480, .fx = 600, .fy = 601, .cx = 318, .cy = 242};
        assert_true(io_equidistant_lens(k, &c) < 0.1);
        for (int a = 0; a < 12; a++) {
            for (double t = 0.02; t < 0.38; t += 0.02) {
                const double way = a * 0.5,
                             r = t * (1 + t * t * (k[0] + t * t * (k[1] + t * t * k[2])));
                double u, v;
                assert_true(rlf_camera_project(
                    &c, rlf_vec3_make(sin(t) * cos(way), sin(t) * sin(way), cos(t)), &u, &v));
                assert_true(fabs(u - (c.cx + c.fx * r * cos(way))) < 0.15);
                assert_true(fabs(v - (c.cy + c.fy * r * sin(way))) < 0.15);
            }
        }
    }
    rlf_camera wide = {.width = 640, .height = 480, .fx = 200, .fy = 200, .cx = 320, .cy = 240};
    assert_true(isinf(io_equidistant_lens(lenses[0], &wide))); /* 115 degrees to its corners */
}

TEST_CASE(what_is_left_out_is_told)
{
    static const struct {
        const char *topic, *model;
        double d[IO_ROS_DISTORTION_MAX], r01, p0, p3;
        const char *text; /* NULL: nothing is lost */
        int distortion;
    } cases[] = {
        {"/d/image",
         "rational_polynomial",
         {[0] = 0.1, [8] = 0.001, [12] = 0.01},
         0,
         0,
         0,
         "thin prism (s1 to s4 = 0.001 0 0 0), tilt (tauX, tauY = 0.01 0)",
         RLF_DISTORTION_RATIONAL_POLYNOMIAL},
        {"/d/image", "plumb_bob", {[13] = 0.01}, 0, 0, 0, "tilt", RLF_DISTORTION_NONE},
        {"/d/image", "equidistant", {0.1, 0.01}, 0, 0, 0, NULL, RLF_DISTORTION_PLUMB_BOB},
        {"/d/image", "equidistant", {-300, 0}, 0, 0, 0, "\"equidistant\"", RLF_DISTORTION_NONE},
        {"/d/image", "equidistant", {0}, 0, 0, 0, NULL, RLF_DISTORTION_NONE},
        {"/d/image", "plumb_bob", {0.1}, 0.02, 90, 0, NULL, RLF_DISTORTION_PLUMB_BOB},
        {"/d/image",
         "plumb_bob",
         {0.1, 0, 0, 0, 0, 0.2},
         0,
         0,
         0,
         NULL,
         RLF_DISTORTION_RATIONAL_POLYNOMIAL},
        {"/d/image", "", {0.1}, 0, 0, 0, NULL, RLF_DISTORTION_PLUMB_BOB},
        {"/d/image", "plumb_bob", {0}, 0.02, 0, 0, "R turns by 1.15 degrees", RLF_DISTORTION_NONE},
        {"/d/image", "plumb_bob", {0}, 0, 90, 0, "P that differs from K", RLF_DISTORTION_NONE},
        {"/d/image_rect",
         "plumb_bob",
         {0.1},
         0.02,
         0,
         0,
         "turns the camera by 1.15 degrees",
         RLF_DISTORTION_NONE},
        {"/d/image_rect",
         "plumb_bob",
         {0.1},
         0,
         0,
         -5,
         "baseline in P (0.05 m)",
         RLF_DISTORTION_NONE},
        {"/d/image_rect", "plumb_bob", {0.1}, 0, 90, 0, NULL, RLF_DISTORTION_NONE},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        io_camera_info info = ros_lens("d", small, 100);
        const double angle = cases[i].r01;
        strcpy(info.model, cases[i].model);
        memcpy(info.d, cases[i].d, sizeof(info.d));
        info.d_count = 14;
        info.r[0] = info.r[4] = cos(angle);
        info.r[3] = sin(angle);
        info.r[1] = -sin(angle);
        info.p[0] = cases[i].p0 > 0 ? cases[i].p0 : info.p[0];
        info.p[3] = cases[i].p3;
        rlf_camera camera;
        memset(&told, 0, sizeof(told));
        assert_int_equal(io_camera_info_lens(&info, "a", cases[i].topic, &camera), RLF_OK);
        if (cases[i].text != NULL) {
            expect_told(cases[i].text);
            expect_told("?camera=FILE");
        }
        if (told.count != (cases[i].text != NULL) ||
            (int)camera.distortion_model != cases[i].distortion) {
            fail_msg("case %zu: %d lines, model %d: %s", i, told.count,
                     (int)camera.distortion_model, told.last);
        }
    }
}

/* Depth whose own lens is of `info`, and colour of its size. */
static void make_two(const char *stem, const io_camera_info *info)
{
    ros_file f = ros_file_open(stem);
    const uint16_t d = ros_topic(&f, IO_ROS_IMAGE, "/camera/depth/image_raw");
    const uint16_t c = ros_topic(&f, IO_ROS_IMAGE, "/camera/color/image_raw");
    const uint16_t ci = ros_topic(&f, IO_ROS_CAMERA_INFO, "/camera/color/camera_info");
    const io_camera_info color = ros_lens("c", small, 100);
    if (info != NULL) {
        ros_info(&f, ros_topic(&f, IO_ROS_CAMERA_INFO, "/camera/depth/camera_info"), info);
    }
    ros_info(&f, ci, &color);
    ros_image(&f, d, "d", "16UC1", small, depth_mm, sizeof(depth_mm));
    ros_image(&f, c, "c", "rgb8", small, rgb, sizeof(rgb));
    ros_file_close(&f, stem);
}

TEST_CASE(a_lens_of_another_size_is_never_taken)
{
    for (int kind = 0; kind < 2; kind++) {
        rlf_source *source = NULL;
        io_camera_info info = ros_lens("d", (uint32_t[2]){16, 12}, 112);
        info.window.binning_x = info.window.binning_y = 2;
        make_two("a", &info);
        assert_int_equal(open_one(kind, "", &source), RLF_OK);
        const rlf_rig *rig = &rlf_source_get_info(source)->rig;
        assert_true(rig->depth.fx == 56 && rig->depth.cx == 3.5 && rig->color.fx == 100);
        rlf_source_destroy(&source);
        /* Its own is of other pictures: no lens of the colour camera in its place. */
        info.window.binning_x = info.window.binning_y = 0;
        make_two("a", &info);
        test_expect_error(open_one(kind, "", &source), RLF_ERROR_FORMAT,
                          "/camera/depth/camera_info", "16 x 12, and these have 8 x 6",
                          "?camera=FILE");
        /* It has none: another's is told. */
        make_two("a", NULL);
        assert_int_equal(open_one(kind, "", &source), RLF_OK);
        expect_told("the lens of /camera/depth/image_raw is that of /camera/color/camera_info, "
                    "another camera with pictures of that size");
        rlf_source_destroy(&source);
    }
}

/* ---- the topics ----------------------------------------------------------------------------- */

/* As a RealSense driver writes them, with or without the tree of frames. */
static void make_aligned(const char *stem, bool has_tf)
{
    ros_file f = ros_file_open(stem);
    const uint16_t d = ros_topic(&f, IO_ROS_IMAGE, "/camera/depth/image_rect_raw");
    const uint16_t a = ros_topic(&f, IO_ROS_IMAGE, "/camera/aligned_depth_to_color/image_raw");
    const uint16_t c = ros_topic(&f, IO_ROS_IMAGE, "/camera/color/image_raw");
    const uint16_t di = ros_topic(&f, IO_ROS_CAMERA_INFO, "/camera/depth/camera_info");
    const uint16_t ai =
        ros_topic(&f, IO_ROS_CAMERA_INFO, "/camera/aligned_depth_to_color/camera_info");
    const uint16_t ci = ros_topic(&f, IO_ROS_CAMERA_INFO, "/camera/color/camera_info");
    const io_camera_info depth = ros_lens("d", small, 48), color = ros_lens("c", small, 56);
    ros_info(&f, di, &depth);
    ros_info(&f, ai, &color);
    ros_info(&f, ci, &color);
    if (has_tf) {
        const uint16_t tf = ros_topic(&f, IO_ROS_TF, "/tf_static");
        ros_transform(&f, tf, "c", "d", 0.25);
    }
    ros_image(&f, d, "d", "16UC1", small, depth_mm, sizeof(depth_mm));
    ros_image(&f, a, "c", "16UC1", small, depth_mm, sizeof(depth_mm));
    ros_image(&f, c, "c", "rgb8", small, rgb, sizeof(rgb));
    ros_file_close(&f, stem);
}

TEST_CASE(aligned_depth_serves_without_transforms)
{
    for (int kind = 0; kind < 2; kind++) {
        rlf_source *source = NULL;
        rlf_frame frame;
        make_aligned("a", false);
        assert_int_equal(open_one(kind, "", &source), RLF_OK);
        assert_true(rlf_source_get_info(source)->rig.depth.fx == 56);
        expect_told("no transform leads from d to c, so depth is that of "
                    "/camera/aligned_depth_to_color/image_raw");
        expect_told("?depth=TOPIC takes another: /camera/depth/image_rect_raw (16UC1)");
        assert_int_equal(told.count, 1);
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_true((frame.flags & RLF_FRAME_ALIGNED) != 0);
        rlf_source_destroy(&source);
        /* Named, it is taken; the sensor's own pixels are better where a transform leads on. */
        assert_int_equal(open_one(kind, "?depth=/camera/depth/image_rect_raw", &source), RLF_OK);
        assert_true(rlf_source_get_info(source)->rig.depth.fx == 48);
        rlf_source_destroy(&source);
        make_aligned("a", true);
        assert_int_equal(open_one(kind, "", &source), RLF_OK);
        assert_true(rlf_source_get_info(source)->rig.depth.fx == 48);
        assert_true(rlf_source_get_info(source)->rig.T_color_depth.p.x == 0.25);
        assert_int_equal(told.count, 0);
        rlf_source_destroy(&source);
    }
}

/* ---- PNG ------------------------------------------------------------------------------------ */

/* After `head` bytes of the caller's. */
static size_t make_png(uint8_t *out, size_t head, io_png_pixels pixels, const void *rows)
{
    const ptrdiff_t stride = pixels == IO_PNG_GREY_U16 ? 16 : 8;
    const io_png_def def = {"a", rows, 8, 6, stride, pixels, 1};
    io_byte_buffer buffer = {0};
    assert_int_equal(io_png_encode(&def, &buffer), RLF_OK);
    memset(out, 0, head);
    memcpy(out + head, buffer.data, buffer.size);
    const size_t size = head + buffer.size;
    io_byte_buffer_free(&buffer);
    return size;
}

static void make_coded(const char *stem, const char *format, const void *data, size_t size)
{
    ros_file f = ros_file_open(stem);
    const uint16_t d = ros_topic(&f, IO_ROS_COMPRESSED_IMAGE, "/d/image_raw/compressed");
    const uint16_t i = ros_topic(&f, IO_ROS_CAMERA_INFO, "/d/camera_info");
    const io_camera_info info = ros_lens("d", small, 10);
    ros_info(&f, i, &info);
    ros_image(&f, d, "d", format, coded, data, size);
    ros_file_close(&f, stem);
}

TEST_CASE(depth_in_a_png_is_read)
{
    static const char *const formats[] = {
        "png",  "16UC1; png compressed ", "mono16; png compressed ", "16UC1; compressedDepth png",
        ".png", "16UC1; compressedDepth"};
    uint8_t png[4096] = {0};
    for (size_t i = 0; i < 2 * sizeof(formats) / sizeof(formats[0]); i++) {
        const char *format = formats[i / 2];
        const size_t head = strstr(format, "compressedDepth") != NULL && i % 3 == 0 ? 12 : 0;
        const size_t size = make_png(png, head, IO_PNG_GREY_U16, depth_mm);
        rlf_source *source = NULL;
        rlf_frame frame;
        make_coded("a", format, png, size);
        const char *keys = i % 2 == 0 ? "" : "?depth=/d/image_raw/compressed";
        for (int kind = 0; kind < 2; kind++) {
            if (open_one(kind, keys, &source) != RLF_OK ||
                rlf_source_next(source, &frame) != RLF_OK) {
                fail_msg("%s: %s", format, rlf_error_text());
            }
            assert_memory_equal(frame.depth_u16, depth_mm, sizeof(depth_mm));
            assert_true(frame.depth_units_per_metre == 1000);
            rlf_source_destroy(&source);
        }
    }
    /* Eight bits are no depth, whatever the name says. */
    const size_t size = make_png(png, 0, IO_PNG_GREY_U8, rgb);
    rlf_source *source = NULL;
    make_coded("a", "16UC1; png compressed", png, size);
    for (int kind = 0; kind < 2; kind++) {
        test_expect_error(open_one(kind, "?depth=/d/image_raw/compressed", &source),
                          RLF_ERROR_INVALID, "depth=/d/image_raw/compressed",
                          "/d/image_raw/compressed (16UC1; png compressed)", "16-bit grey");
    }
}

/* ---- what other drivers and recorders write ------------------------------------------------- */

/* As a ZED driver does: depth in metres in the colour camera's pixels, and a map of confidence that
 * looks like depth and has more pictures. */
TEST_CASE(confidence_is_no_depth)
{
    float metres[48];
    uint8_t bgra[192] = {0};
    for (int i = 0; i < 48; i++) {
        metres[i] = 1.0f + 0.05f * (float)i;
    }
    ros_file f = ros_file_open("a");
    const uint16_t m = ros_topic(&f, IO_ROS_IMAGE, "/zed/zed_node/confidence/confidence_map");
    const uint16_t d = ros_topic(&f, IO_ROS_IMAGE, "/zed/zed_node/depth/depth_registered");
    const uint16_t c = ros_topic(&f, IO_ROS_IMAGE, "/zed/zed_node/rgb/image_rect_color");
    const uint16_t di = ros_topic(&f, IO_ROS_CAMERA_INFO, "/zed/zed_node/depth/camera_info");
    const uint16_t ci = ros_topic(&f, IO_ROS_CAMERA_INFO, "/zed/zed_node/rgb/camera_info");
    const io_camera_info info = ros_lens("zed_left", small, 7);
    ros_info(&f, di, &info);
    ros_info(&f, ci, &info);
    ros_image(&f, m, "zed_left", "32FC1", small, metres, sizeof(metres));
    f.ms = 33;
    ros_image(&f, m, "zed_left", "32FC1", small, metres, sizeof(metres));
    ros_image(&f, d, "zed_left", "32FC1", small, metres, sizeof(metres));
    ros_image(&f, c, "zed_left", "bgra8", small, bgra, sizeof(bgra));
    ros_file_close(&f, "a");
    for (int kind = 0; kind < 2; kind++) {
        rlf_source *source = NULL;
        rlf_frame frame;
        assert_int_equal(open_one(kind, "", &source), RLF_OK);
        assert_int_equal(rlf_source_get_info(source)->frame_count, 1);
        assert_true(rlf_source_get_info(source)->rig.has_color);
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_true((frame.flags & RLF_FRAME_ALIGNED) != 0 && frame.color.data != NULL);
        assert_int_equal(told.count, 0);
        rlf_source_destroy(&source);
    }
}

TEST_CASE(what_is_not_read_is_named)
{
    ros_file f = ros_file_open("a");
    const uint16_t g = ros_topic(&f, IO_ROS_IMAGE, "/stereo/disparity_raw");
    ros_image(&f, g, "d", "8UC1", small, rgb, 48);
    io_mcap_add_schema(f.mcap, "foxglove.CompressedImage", "");
    const uint16_t p = io_mcap_add_channel(f.mcap, "/cam/depth", "");
    io_mcap_begin(f.mcap, p, 0);
    io_mcap_end(f.mcap, true);
    io_mcap_add_schema(f.mcap, "stereo_msgs/msg/DisparityImage", "");
    io_mcap_add_channel(f.mcap, "/stereo/disparity", "");
    bag_file_connect(f.bag, 9, "/stereo/disparity", "stereo_msgs/DisparityImage");
    ros_file_close(&f, "a");
    rlf_source *source = NULL;
    for (int kind = 0; kind < 2; kind++) {
        test_expect_error(open_one(kind, "", &source), RLF_ERROR_FORMAT,
                          "its topics of pictures are: /stereo/disparity_raw (8UC1)",
                          kind == 0 ? "/stereo/disparity (stereo_msgs/msg/DisparityImage, cdr)"
                                    : "not read: /stereo/disparity (stereo_msgs/DisparityImage)",
                          kind == 0 ? "not read: /cam/depth (foxglove.CompressedImage" : NULL);
    }
}

/* ros2 bag record --compression-mode message. */
TEST_CASE(messages_packed_one_by_one_are_read)
{
    ros_file f = ros_file_open("plain");
    const uint16_t d = ros_topic(&f, IO_ROS_IMAGE, "/d/image");
    const uint16_t i = ros_topic(&f, IO_ROS_CAMERA_INFO, "/d/camera_info");
    const io_camera_info info = ros_lens("d", small, 5);
    ros_info(&f, i, &info);
    ros_image(&f, d, "d", "16UC1", small, depth_mm, sizeof(depth_mm));
    ros_file_close(&f, "plain");

    io_mcap_reader *reader = NULL;
    io_mcap_writer *writer = NULL;
    io_ros_log log = {.name = "plain.mcap"};
    assert_int_equal(io_mcap_reader_open(test_path("plain.mcap"), &log, &reader), RLF_OK);
    assert_int_equal(io_mcap_writer_create(test_path("a.mcap"), IO_PACKING_NONE, &writer), RLF_OK);
    for (int32_t c = 0; c < log.channel_count; c++) {
        const io_ros_channel *from = &log.channels[c];
        io_cdr_reader message;
        io_mcap_add_schema(writer, io_ros_type_name(from->type), io_ros_type_text(from->type));
        const uint16_t to = io_mcap_add_channel(writer, from->topic, "");
        assert_int_equal(io_ros_log_read(&log, c, 0, &message), RLF_OK);
        io_byte_buffer *out = io_mcap_begin(writer, to, 0);
        /* With the head of 4 bytes that a reader is behind. */
        assert_int_equal(io_mcap_compress(IO_PACKING_ZSTD, message.data - 4, message.size + 4, out),
                         RLF_OK);
        io_mcap_end(writer, true);
    }
    assert_int_equal(io_mcap_writer_close(&writer, NULL), RLF_OK);
    io_mcap_reader_close(&reader);
    io_ros_log_free(&log);

    rlf_source *source = NULL;
    rlf_frame frame;
    if (open_one(0, "", &source) != RLF_OK || rlf_source_next(source, &frame) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    assert_memory_equal(frame.depth_u16, depth_mm, sizeof(depth_mm));
    rlf_source_destroy(&source);
}

TEST_CASE(other_forms_of_recordings_are_named)
{
    rlf_source *source = NULL;
    test_write_text("a.db3", "SQLite format 3");
    test_expect_error(rlf_open_source(test_path("a.db3"), NULL, &source), RLF_ERROR_UNSUPPORTED,
                      "a.db3", "SQLite", "ros2 bag convert");
    test_write_text("a.mcap.zstd", "x");
    test_expect_error(rlf_open_source(test_path("a.mcap.zstd"), NULL, &source),
                      RLF_ERROR_UNSUPPORTED, "a.mcap.zstd", "packed", "zstd -d");
    /* The folder that holds them all, as `ros2 bag record` makes it. */
    test_write_text("metadata.yaml", "rosbag2_bagfile_information:\n");
    test_expect_error(rlf_open_source(test_folder, NULL, &source), RLF_ERROR_UNSUPPORTED, "folder",
                      "SQLite", "ros2 bag convert");
    test_write_text("a_1.mcap", "x");
    test_write_text("a_0.mcap", "x");
    test_expect_error(rlf_open_source(test_folder, NULL, &source), RLF_ERROR_UNSUPPORTED,
                      "is the folder of a ROS 2 recording", "2 files", "such as a_0.mcap");
}

TEST_EACH(set_up, tear_down)
