/* Folders that say little of themselves: a camera guessed by the pictures' size, pictures taken in
 * the order of their names. */
#define _POSIX_C_SOURCE 200809L

#include "io/folder/folder.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#define MOST (512 * 424)

static uint16_t pixels[MOST];

static void make_folder(const char *name)
{
    assert_int_equal(rlf_make_folder(test_path(name)), RLF_OK);
}

static void write_depth(const char *name, uint16_t value, int32_t width, int32_t height)
{
    for (int i = 0; i < width * height; i++) {
        pixels[i] = value;
    }
    assert_int_equal(rlf_png_write_u16(test_path(name), pixels, width, height), RLF_OK);
}

static void write_color(const char *name, uint8_t value, int32_t width, int32_t height)
{
    static uint8_t rgba[160 * 120 * 4];
    memset(rgba, value, sizeof(rgba));
    const rlf_image_rgba8 image = {rgba, width, height, (ptrdiff_t)width * 4};
    assert_int_equal(rlf_png_write_rgba(test_path(name), &image), RLF_OK);
}

typedef struct log_text {
    int count;
    char all[2048];
} log_text;

static log_text text;

static void keep(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    (void)level;
    text.count++;
    strncat(text.all, line, sizeof(text.all) - strlen(text.all) - 2);
    strcat(text.all, "\n");
}

static rlf_source *open_folder(const char *sub)
{
    rlf_source *source = NULL;
    text = (log_text){0};
    rlf_set_log(keep, NULL);
    const rlf_result result = rlf_open_source(test_path(sub), NULL, &source);
    if (result != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return source;
}

static void says(const char *part)
{
    if (strstr(text.all, part) == NULL) {
        fail_msg("\"%s\" does not mention \"%s\"", text.all, part);
    }
}

/* Depth of the first pixel, and of colour (-1 = none), of each frame to the end. */
static void expect_frames(rlf_source *source, const int *depth, const int *color, int count)
{
    rlf_frame frame;
    for (int i = 0; i < count; i++) {
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_int_equal(frame.depth_u16[0], depth[i]);
        assert_int_equal(frame.color.data != NULL ? frame.color.data[0] : -1, color[i]);
    }
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
}

TEST_CASE(the_size_tells_the_camera)
{
    const struct {
        int32_t width, height;
        double fx;
        const char *name;
    } sizes[] = {
        {640, 480, 525, "Kinect v1"},      {512, 424, 365.5, "Kinect v2"},
        {848, 480, 424, "RealSense"},      {1280, 720, 640, "RealSense"},
        {640, 576, 504, "Azure Kinect"},   {320, 288, 252, "Azure Kinect"},
        {512, 512, 252, "Azure Kinect"},   {1024, 1024, 504, "Azure Kinect"},
        {256, 192, 213, "iPhone or iPad"}, {160, 120, 121, "ARCore"},
    };
    for (size_t i = 0; i < sizeof(sizes) / sizeof(sizes[0]); i++) {
        rlf_camera camera;
        const char *name = io_guess_camera(sizes[i].width, sizes[i].height, &camera);
        assert_non_null(name);
        assert_non_null(strstr(name, sizes[i].name));
        assert_true(camera.fx >= sizes[i].fx && camera.fx <= sizes[i].fx);
        assert_int_equal(rlf_camera_check(&camera, "guess"), RLF_OK);
    }
    rlf_camera camera;
    assert_null(io_guess_camera(641, 480, &camera));
}

TEST_CASE_WITH(a_clip_without_a_camera_gets_a_guess_and_a_line, test_folder_make,
               test_folder_remove)
{
    make_folder("clip");
    write_depth("clip/a.png", 2000, 512, 424);
    test_write_text("clip/depth.txt", "0.0 a.png\n");
    rlf_source *source = open_folder("clip");
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    assert_true(rig->depth.fx > 365.0 && rig->depth.fx < 366.0);
    assert_false(rig->has_color);
    says("a guess by the pictures' size, those of a Kinect v2");
    says("?camera=FILE");
    says("1000 counts a metre");
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_true(frame.depth_units_per_metre == 1000);
    rlf_source_destroy(&source);
    write_depth("clip/a.png", 15000, 512, 424); /* 15 m in millimetres, 3 m in TUM's counts */
    source = open_folder("clip");
    says("5000 counts a metre");
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
}

TEST_CASE_WITH(a_camera_that_is_given_is_taken, test_folder_make, test_folder_remove)
{
    make_folder("clip");
    write_depth("clip/a.png", 2000, 160, 120);
    test_write_text("clip/depth.txt", "0.0 a.png\n");
    test_write_text("mine.json", "{\"depth\":{\"width\":160,\"height\":120,\"fx\":70,\"fy\":70,"
                                 "\"cx\":80,\"cy\":60,\"units_per_metre\":2000}}");
    char address[2048];
    (void)snprintf(address, sizeof(address), "%s?camera=", test_path("clip"));
    strcat(address, test_path("mine.json"));
    rlf_source *source = NULL;
    text = (log_text){0};
    rlf_set_log(keep, NULL);
    assert_int_equal(rlf_open_source(address, NULL, &source), RLF_OK);
    assert_int_equal(text.count, 0);
    assert_true(rlf_source_get_info(source)->rig.depth.fx == 70);
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
}

TEST_CASE_WITH(names_in_their_order_are_frames, test_folder_make, test_folder_remove)
{
    make_folder("clip");
    make_folder("clip/depth");
    make_folder("clip/rgb");
    write_depth("clip/depth/frame-2.png", 1002, 160, 120);
    write_depth("clip/depth/frame-10.png", 1010, 160, 120);
    write_depth("clip/depth/frame-3.png", 1003, 160, 120);
    write_color("clip/rgb/img_3.png", 33, 160, 120);
    write_color("clip/rgb/img_10.png", 110, 160, 120);
    rlf_source *source = open_folder("clip");
    says("3 depth pictures are taken in the order of their names (depth/frame-2.png first), 30 a "
         "second");
    says("ARCore");
    const int depth[3] = {1002, 1003, 1010}, color[3] = {33, 33, 110}; /* 33 ms is near enough */
    expect_frames(source, depth, color, 3);
}

/* Times in the names are no numbers that count frames. */
TEST_CASE_WITH(pictures_go_together_one_by_one_or_not_at_all, test_folder_make, test_folder_remove)
{
    make_folder("clip");
    make_folder("clip/depth");
    make_folder("clip/color");
    write_depth("clip/depth/1305031102.160407.png", 1001, 160, 120);
    write_depth("clip/depth/1305031103.060407.png", 1002, 160, 120);
    write_color("clip/color/1305031102.175304.png", 11, 160, 120);
    write_color("clip/color/1305031103.075304.png", 22, 160, 120);
    const int depth[2] = {1001, 1002}, color[2] = {11, 22}, none[2] = {-1, -1};
    expect_frames(open_folder("clip"), depth, color, 2);
    write_color("clip/color/1305031104.075304.png", 33, 160, 120);
    rlf_source *source = open_folder("clip");
    says("nothing tells which go together");
    expect_frames(source, depth, none, 2);
}

TEST_CASE_WITH(depth_alone_in_a_folder_is_a_clip, test_folder_make, test_folder_remove)
{
    make_folder("clip");
    write_depth("clip/000000.png", 1000, 160, 120);
    write_depth("clip/000001.png", 1001, 160, 120);
    const int depth[2] = {1000, 1001}, none[2] = {-1, -1};
    expect_frames(open_folder("clip"), depth, none, 2);
    write_color("clip/000002.png", 1, 160, 120); /* which are depth, nobody knows */
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source(test_path("clip"), NULL, &source), RLF_ERROR_IO, "depth.txt",
                      "No such file", NULL);
    make_folder("named");
    write_depth("named/depth_1.png", 1000, 160, 120);
    write_depth("named/depth_2.png", 1001, 160, 120);
    write_color("named/color_1.png", 11, 160, 120);
    write_color("named/color_2.png", 22, 160, 120);
    const int color[2] = {11, 22};
    expect_frames(open_folder("named"), depth, color, 2);
}

TEST_CASE_WITH(color_of_another_shape_is_left_out, test_folder_make, test_folder_remove)
{
    make_folder("clip");
    make_folder("clip/depth");
    make_folder("clip/rgb");
    write_depth("clip/depth/0.png", 1000, 160, 120);
    write_color("clip/rgb/0.png", 1, 160, 90);
    rlf_source *source = open_folder("clip");
    says("colour is left out: its pictures of 160 x 90");
    const int depth[1] = {1000}, none[1] = {-1};
    expect_frames(source, depth, none, 1);
}
