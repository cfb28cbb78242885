/* Recordings of other ROS 2 recorders: which topics are taken, and every kind of picture. */
#define _POSIX_C_SOURCE 200809L

#include "io/mcap/mcap.h"
#include "io/ros/messages.h"
#include "recording_sample.h"
#include "test.h"

#define W 6
#define H 4
#define T0 INT64_C(1700000000000000000)

typedef struct bag {
    io_mcap_writer *writer;
} bag;

static bag bag_open(const char *name)
{
    bag b = {0};
    assert_int_equal(io_mcap_writer_create(test_path(name), IO_PACKING_LZ4, &b.writer), RLF_OK);
    return b;
}

static void bag_close(bag *b)
{
    assert_int_equal(io_mcap_writer_close(&b->writer, NULL), RLF_OK);
}

static uint16_t add_topic(bag *b, io_ros_type type, const char *topic)
{
    io_mcap_add_schema(b->writer, io_ros_type_name(type), io_ros_type_text(type));
    return io_mcap_add_channel(b->writer, topic, "");
}

/* A picture that was taken at T0 + ms and arrived `late_ms` afterwards. */
typedef struct shot {
    const char *frame_id, *encoding;
    int32_t ms, late_ms;
    uint32_t step;
    const void *data;
    size_t size;
} shot;

static void add_image(bag *b, uint16_t topic, const shot *s)
{
    io_ros_image image = {.width = W, .height = H, .step = s->step};
    image.header.stamp_ns = T0 + s->ms * INT64_C(1000000);
    strcpy(image.header.frame_id, s->frame_id);
    strcpy(image.encoding, s->encoding);
    const int64_t log_ns = image.header.stamp_ns + s->late_ms * INT64_C(1000000);
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(b->writer, topic, log_ns));
    const bool is_compressed = s->step == 0;
    const size_t begin =
        is_compressed ? io_ros_begin_compressed(&cdr, &image) : io_ros_begin_image(&cdr, &image);
    io_byte_buffer_add(cdr.buffer, s->data, s->size);
    io_cdr_end_bytes(&cdr, begin);
    io_mcap_end(b->writer, true);
}

static void add_info(bag *b, uint16_t topic, const char *frame_id, double fx)
{
    io_ros_header header = {.stamp_ns = T0};
    strcpy(header.frame_id, frame_id);
    const rlf_camera camera = {.width = W, .height = H, .fx = fx, .fy = fx, .cx = 2.5, .cy = 1.5};
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(b->writer, topic, T0));
    io_ros_write_camera_info(&cdr, &header, &camera);
    io_mcap_end(b->writer, true);
}

static void add_tf(bag *b, uint16_t topic, const char *parent, const char *child, double x)
{
    io_ros_transform t = {.stamp_ns = T0, .T_parent_child = rlf_pose_identity()};
    strcpy(t.parent, parent);
    strcpy(t.child, child);
    t.T_parent_child.p.x = x;
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(b->writer, topic, T0));
    io_ros_write_tf(&cdr, &t, 1);
    io_mcap_end(b->writer, true);
}

static uint16_t depth_mm[W * H];
static uint8_t rgb[W * H * 3];

static void draw(void)
{
    for (int i = 0; i < W * H; i++) {
        depth_mm[i] = (uint16_t)(1000 + i);
        rgb[3 * i] = (uint8_t)i;
        rgb[3 * i + 1] = 100;
        rgb[3 * i + 2] = 200;
    }
}

static shot raw_depth(int32_t ms, int32_t late_ms)
{
    return (shot){"depth_frame", "16UC1", ms, late_ms, W * 2, depth_mm, sizeof(depth_mm)};
}

static shot raw_color(int32_t ms, int32_t late_ms, const char *encoding)
{
    return (shot){"color_frame", encoding, ms, late_ms, W * 3, rgb, sizeof(rgb)};
}

/* As a RealSense driver publishes: infrared first, then depth and colour with their calibration,
 * and a tree of frames. Colour arrives 40 ms late. */
static void make_realsense(const char *name)
{
    draw();
    bag b = bag_open(name);
    const uint16_t infra = add_topic(&b, IO_ROS_IMAGE, "/camera/infra1/image_rect_raw");
    const uint16_t depth = add_topic(&b, IO_ROS_IMAGE, "/camera/depth/image_rect_raw");
    const uint16_t color = add_topic(&b, IO_ROS_IMAGE, "/camera/color/image_raw");
    const uint16_t color_info = add_topic(&b, IO_ROS_CAMERA_INFO, "/camera/color/camera_info");
    const uint16_t depth_info = add_topic(&b, IO_ROS_CAMERA_INFO, "/camera/depth/camera_info");
    const uint16_t tf = add_topic(&b, IO_ROS_TF, "/tf_static");
    add_info(&b, color_info, "color_frame", 7.0);
    add_info(&b, depth_info, "depth_frame", 5.0);
    add_tf(&b, tf, "link", "depth_frame", 0.25);
    add_tf(&b, tf, "link", "color_frame", 0.75);
    for (int32_t i = 0; i < 4; i++) {
        const shot grey = {"infra", "mono8", 33 * i, 0, W, rgb, W * H};
        const shot d = raw_depth(33 * i, 1);
        const shot c = raw_color(33 * i, 40, "bgr8");
        add_image(&b, infra, &grey);
        add_image(&b, depth, &d);
        rgb[0] = (uint8_t)(50 + i);
        add_image(&b, color, &c);
    }
    bag_close(&b);
}

TEST_CASE_WITH(a_realsense_recording_is_understood, test_folder_make, test_folder_remove)
{
    make_realsense("a.mcap");
    rlf_source *source = NULL;
    assert_int_equal(rlf_open_source(test_path("a.mcap"), NULL, &source), RLF_OK);
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_non_null(strstr(info->device, "/camera/depth/image_rect_raw"));
    assert_non_null(strstr(info->device, "/camera/color/image_raw"));
    assert_true(info->rig.depth.fx == 5.0 && info->rig.color.fx == 7.0);
    assert_true(info->rig.T_color_depth.p.x == -0.5);
    for (int32_t i = 0; i < 4; i++) {
        rlf_frame frame;
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_true(frame.time_ns == T0 + 33 * i * INT64_C(1000000));
        assert_true(frame.color_time_ns == frame.time_ns); /* though it arrived late */
        assert_true(frame.depth_units_per_metre == 1000);
        assert_memory_equal(frame.depth_u16, depth_mm, sizeof(depth_mm));
        const uint8_t first[4] = {200, 100, (uint8_t)(50 + i), 255};
        assert_memory_equal(frame.color.data, first, 4);
    }
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(topics_can_be_chosen, test_folder_make, test_folder_remove)
{
    make_realsense("a.mcap");
    char address[TEST_PATH_MAX + 64];
    rlf_source *source = NULL;
    snprintf(address, sizeof(address), "mcap:%s?color=/camera/infra1/image_rect_raw",
             test_path("a.mcap"));
    rlf_set_log(NULL, NULL);
    assert_int_equal(rlf_open_source(address, NULL, &source), RLF_OK);
    assert_non_null(strstr(rlf_source_get_info(source)->device, "infra1"));
    rlf_source_destroy(&source);
    snprintf(address, sizeof(address), "mcap:%s?depth=/nothing", test_path("a.mcap"));
    test_expect_error(rlf_open_source(address, NULL, &source), RLF_ERROR_INVALID, "a.mcap",
                      "/nothing", "/camera/depth/image_rect_raw");
    snprintf(address, sizeof(address), "mcap:%s?color=/nothing", test_path("a.mcap"));
    test_expect_error(rlf_open_source(address, NULL, &source), RLF_ERROR_INVALID, "a.mcap",
                      "/nothing", "/camera/color/image_raw");
}

/* One picture of a kind; gives its first frame. */
static rlf_source *open_one(const shot *depth, const shot *color, rlf_frame *frame)
{
    bag b = bag_open("one.mcap");
    const io_ros_type depth_type = depth->step > 0 ? IO_ROS_IMAGE : IO_ROS_COMPRESSED_IMAGE;
    const uint16_t d = add_topic(&b, depth_type, "/d/image");
    const uint16_t i = add_topic(&b, IO_ROS_CAMERA_INFO, "/d/camera_info");
    add_info(&b, i, depth->frame_id, 5.0);
    add_image(&b, d, depth);
    if (color != NULL) {
        const uint16_t c = add_topic(&b, IO_ROS_IMAGE, "/c/image");
        add_image(&b, c, color);
    }
    bag_close(&b);
    rlf_source *source = NULL;
    if (rlf_open_source(test_path("one.mcap"), NULL, &source) != RLF_OK ||
        rlf_source_next(source, frame) != RLF_OK) {
        fail_msg("%s: %s", depth->encoding, rlf_error_text());
    }
    return source;
}

TEST_CASE_WITH(every_kind_of_picture_is_read, test_folder_make, test_folder_remove)
{
    draw();
    static const struct {
        const char *name;
        size_t bytes, red, green, blue;
    } kinds[] = {{"rgb8", 3, 0, 1, 2},
                 {"bgr8", 3, 2, 1, 0},
                 {"rgba8", 4, 0, 1, 2},
                 {"bgra8", 4, 2, 1, 0},
                 {"mono8", 1, 0, 0, 0}};
    uint8_t bytes[(W * 4 + 5) * H]; /* rows with padding */
    for (size_t i = 0; i < sizeof(bytes); i++) {
        bytes[i] = (uint8_t)(i * 7);
    }
    for (size_t k = 0; k < sizeof(kinds) / sizeof(kinds[0]); k++) {
        const uint32_t step = (uint32_t)(W * kinds[k].bytes + 5);
        const shot d = raw_depth(0, 0);
        const shot c = {"depth_frame", kinds[k].name, 0, 0, step, bytes, step * H};
        rlf_frame frame;
        rlf_source *source = open_one(&d, &c, &frame);
        assert_true((frame.flags & RLF_FRAME_ALIGNED) != 0); /* of one frame_id */
        for (size_t p = 0; p < W * H; p++) {
            const uint8_t *from = bytes + p / W * step + p % W * kinds[k].bytes;
            const uint8_t want[4] = {from[kinds[k].red], from[kinds[k].green], from[kinds[k].blue],
                                     255};
            assert_memory_equal(frame.color.data + 4 * p, want, 4);
        }
        rlf_source_destroy(&source);
    }
}

TEST_CASE_WITH(metres_are_read, test_folder_make, test_folder_remove)
{
    float metres[W * H];
    for (int i = 0; i < W * H; i++) {
        metres[i] = i == 0 ? 0.0f : 1.0f + (float)i / 7.0f;
    }
    const shot raw = {"depth_frame", "32FC1", 0, 0, W * 4, metres, sizeof(metres)};
    rlf_frame frame;
    rlf_source *source = open_one(&raw, NULL, &frame);
    assert_memory_equal(frame.depth_f32, metres, sizeof(metres));
    rlf_source_destroy(&source);

    /* Inverse depth: 100 / (count + 0.5), as RVL. */
    uint8_t bytes[512] = {0};
    const float parameters[2] = {100.0f, -0.5f};
    const uint32_t size[2] = {W, H};
    memcpy(bytes + 4, parameters, 8);
    memcpy(bytes + 12, size, 8);
    /* Nibbles: 23 = 15 2 (7 + 16: 7|8, 2), 1 measured, 200 = 0|8 1|8 3: 0xF2189300 as a word. */
    const uint32_t word = 0xF2189300u;
    memcpy(bytes + 20, &word, 4);
    const shot coded_shot = {"depth_frame", "32FC1; compressedDepth rvl", 0, 0, 0, bytes, 24};
    source = open_one(&coded_shot, NULL, &frame);
    assert_true(frame.depth_f32[0] == 0.0f);
    assert_true(frame.depth_f32[W * H - 1] == 100.0f / 100.5f);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(without_calibration_it_says_what_to_do, test_folder_make, test_folder_remove)
{
    draw();
    bag b = bag_open("a.mcap");
    const uint16_t d = add_topic(&b, IO_ROS_IMAGE, "/d/image");
    const shot s = raw_depth(0, 0);
    add_image(&b, d, &s);
    bag_close(&b);
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source(test_path("a.mcap"), NULL, &source), RLF_ERROR_FORMAT,
                      "a.mcap", "CameraInfo", "?camera=FILE");
    test_write_text("a.json", "{\"depth\":{\"width\":6,\"height\":4,\"fx\":5,\"fy\":5,\"cx\":2.5,"
                              "\"cy\":1.5,\"units_per_metre\":2000}}");
    assert_int_equal(rlf_open_source(test_path("a.mcap"), NULL, &source), RLF_OK);
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_true(frame.depth_units_per_metre == 2000);
    rlf_source_destroy(&source);
    test_write_text("a.json", "{\"depth\":{\"width\":7,\"height\":4,\"fx\":5,\"fy\":5,\"cx\":2.5,"
                              "\"cy\":1.5,\"units_per_metre\":2000}}");
    test_expect_error(rlf_open_source(test_path("a.mcap"), NULL, &source), RLF_ERROR_INVALID,
                      "a.mcap", "7 x 4", "?camera=FILE");
}

TEST_CASE(numbers_are_aligned_as_cdr_wants)
{
    io_byte_buffer buffer = {0};
    io_cdr_writer w = io_cdr_begin(&buffer);
    const double number = 0.1;
    io_cdr_put_text(&w, "ab"); /* 4 + 3 bytes */
    io_cdr_put_doubles(&w, &number, 1);
    io_cdr_put_u8(&w, 7);
    io_cdr_put_u32(&w, 9);
    const uint8_t want[] = {0, 1, 0, 0, 3, 0, 0, 0, 'a', 'b', 0, 0};
    assert_int_equal(buffer.size, 4 + 8 + 8 + 8);
    assert_memory_equal(buffer.data, want, sizeof(want));
    for (size_t size = 0; size <= buffer.size; size++) {
        io_cdr_reader r = io_cdr_open(buffer.data, size);
        char text[8];
        double got;
        io_cdr_get_text(&r, text, sizeof(text));
        io_cdr_get_doubles(&r, &got, 1);
        const uint8_t seven = io_cdr_get_u8(&r);
        const uint32_t nine = io_cdr_get_u32(&r);
        assert_true(r.is_bad == (size < buffer.size));
        assert_true(size < buffer.size ||
                    (strcmp(text, "ab") == 0 && got == number && seven == 7 && nine == 9));
    }
    /* The same from a big-endian machine. */
    const uint8_t big[] = {0, 0, 0, 0, 0, 0, 0, 5};
    io_cdr_reader r = io_cdr_open(big, sizeof(big));
    assert_int_equal(io_cdr_get_u32(&r), 5);
    io_byte_buffer_free(&buffer);
}
