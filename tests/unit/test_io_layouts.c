/* Folders as data sets arrange them: what is recognised, cameras, times, poses, missing depth. */
#define _POSIX_C_SOURCE 200809L

#include "io/folder/folder.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>

#define W 64
#define H 48

static void make_folder(const char *name)
{
    assert_int_equal(rlf_make_folder(test_path(name)), RLF_OK);
}

/* `value` everywhere but in the first pixel, which is `first`. */
static void write_depth(const char *name, uint16_t value, uint16_t first)
{
    uint16_t pixels[W * H];
    for (int i = 0; i < W * H; i++) {
        pixels[i] = value;
    }
    pixels[0] = first;
    assert_int_equal(rlf_png_write_u16(test_path(name), pixels, W, H), RLF_OK);
}

static void write_color(const char *name, int32_t width, int32_t height)
{
    uint8_t pixels[2 * W * 2 * H * 4];
    memset(pixels, 77, sizeof(pixels));
    const rlf_image_rgba8 image = {pixels, width, height, (ptrdiff_t)width * 4};
    assert_int_equal(rlf_png_write_rgba(test_path(name), &image), RLF_OK);
}

/* Opens; counts warnings. */
static rlf_source *open_folder(const char *sub, int warnings, const char *part)
{
    rlf_source *source = NULL;
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    const rlf_result result = rlf_open_source(test_path(sub), NULL, &source);
    rlf_set_log(NULL, NULL);
    if (result != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    assert_int_equal(log.count, warnings);
    if (part != NULL && strstr(log.last, part) == NULL) {
        fail_msg("\"%s\" does not mention \"%s\"", log.last, part);
    }
    return source;
}

static rlf_frame next(rlf_source *source)
{
    rlf_frame frame;
    if (rlf_source_next(source, &frame) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return frame;
}

static void expect_near(double got, double wanted)
{
    if (fabs(got - wanted) > 1e-4) {
        fail_msg("%g, not %g", got, wanted);
    }
}

/* ---- TUM ----------------------------------------------------------------------------------------
 */

TEST_CASE_WITH(tum_has_poses_and_a_known_camera, test_folder_make, test_folder_remove)
{
    make_folder("rgbd_freiburg1_desk");
    for (int i = 0; i < 5; i++) {
        char name[64];
        snprintf(name, sizeof(name), "rgbd_freiburg1_desk/d%d.png", i);
        write_depth(name, 5000, 65535);
    }
    write_color("rgbd_freiburg1_desk/c.png", W, H);
    test_write_text("rgbd_freiburg1_desk/depth.txt", "10.00 d0.png\n10.03 d1.png\n10.06 d2.png\n"
                                                     "10.09 d3.png\n10.12 d4.png\n");
    test_write_text("rgbd_freiburg1_desk/rgb.txt", "10.01 c.png\n");
    test_write_text("rgbd_freiburg1_desk/groundtruth.txt", "# timestamp tx ty tz qx qy qz qw\n"
                                                           "10.005 1 2 3 0 0 0.70711 0.70711\n"
                                                           "10.032 4 5 6 0 0 0 1\n"
                                                           "10.036 7 8 9 0 0 0 1\n"
                                                           "10.061 nan nan nan nan nan nan nan\n"
                                                           "10.12 1 1 1 0 0 0 0\n"
                                                           "half a line 1 2\n");
    rlf_source *source = open_folder("rgbd_freiburg1_desk", 1, "freiburg1");
    const rlf_source_info *info = rlf_source_get_info(source);
    expect_near(info->rig.depth.fx, 51.7306408);
    expect_near(info->rig.depth.cx, (318.643040 + 0.5) / 10 - 0.5);
    expect_near(info->rig.depth.distortion[0], 0.262383);
    assert_true(info->rig.has_color);
    rlf_frame frame = next(source);
    assert_true(frame.depth_units_per_metre == 5000);
    assert_int_equal(frame.depth_u16[0], 65535); /* farther than 13 m, not missing */
    assert_int_equal(frame.flags, RLF_FRAME_ALIGNED);
    assert_true(frame.has_pose);
    expect_near(frame.T_world_camera.p.y, 2);
    expect_near(frame.T_world_camera.q.z, sqrt(0.5));
    frame = next(source);
    assert_true(frame.has_pose); /* the nearer of two */
    expect_near(frame.T_world_camera.p.x, 4);
    for (int i = 2; i < 5; i++) { /* NaN, none within 20 ms, a zero quaternion */
        assert_false(next(source).has_pose);
    }
    rlf_source_destroy(&source);
    remove(test_path("rgbd_freiburg1_desk/groundtruth.txt"));
    source = open_folder("rgbd_freiburg1_desk", 1, "freiburg1");
    assert_false(next(source).has_pose);
    rlf_source_destroy(&source);
}

TEST_CASE(associations_come_in_either_order)
{
    const char text[] = "# rgb depth\n1.25 rgb/a.png 1.26 depth/a.png\r\n\n"
                        "1.50 depth/b.png 1.49 rgb/b.png\n";
    const io_bytes file = {"associations.txt", (const uint8_t *)text, sizeof(text) - 1};
    io_frame_list depth, color;
    bool has_numbers = true;
    assert_int_equal(io_associations_parse(&file, &depth, &color, &has_numbers), RLF_OK);
    assert_false(has_numbers);
    assert_int_equal(depth.count, 2);
    assert_string_equal(depth.entries[0].name, "depth/a.png");
    assert_string_equal(color.entries[1].name, "rgb/b.png");
    assert_true(depth.entries[1].time_ns == 1500000000);
    io_frame_list_free(&depth);
    io_frame_list_free(&color);
    const char bad[] = "1 a 2 b\n1 a 2\n";
    const io_bytes wrong = {"associations.txt", (const uint8_t *)bad, sizeof(bad) - 1};
    test_expect_error(io_associations_parse(&wrong, &depth, &color, &has_numbers), RLF_ERROR_FORMAT,
                      "associations.txt:2", "TIME FILE TIME FILE", NULL);
}

/* ---- ICL-NUIM -----------------------------------------------------------------------------------
 */

/* Its y is up. Here y is down: what turns about x or z turns the other way, and up is -y. */
TEST_CASE_WITH(icl_is_turned_to_y_down, test_folder_make, test_folder_remove)
{
    make_folder("traj0/depth");
    make_folder("traj0/rgb");
    for (int i = 0; i < 3; i++) {
        char name[32];
        snprintf(name, sizeof(name), "traj0/depth/%d.png", i);
        write_depth(name, 10000, 0);
        snprintf(name, sizeof(name), "traj0/rgb/%d.png", i);
        write_color(name, W, H);
    }
    test_write_text("traj0/associations.txt", "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 "
                                              "rgb/1.png\n2 depth/2.png 2 rgb/2.png\n");
    test_write_text("traj0/livingRoom0.gt.freiburg",
                    "1 1.0 2.0 3.0 0.6 0 0 0.8\n2 0 0 -2.25 0 0.6 0 0.8\n");
    rlf_source *source = open_folder("traj0", 1, "ICL-NUIM");
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_true(fabs(info->frames_per_second - 30.0) < 0.01);
    expect_near(info->rig.depth.fy, 48.0); /* + 480: down */
    assert_non_null(strstr(info->device, "ICL"));
    assert_false(next(source).has_pose);
    rlf_frame frame = next(source);
    assert_true(frame.time_ns == 33333333 && frame.has_pose && frame.color.data != NULL);
    expect_near(frame.T_world_camera.p.y, -2.0);
    expect_near(frame.T_world_camera.p.z, 3.0);
    expect_near(frame.T_world_camera.q.x, -0.6);
    /* A point 1 m above the axis, in both ways of counting y, ends at the same place. */
    const rlf_pose theirs = {rlf_vec3_make(1, 2, 3), {0.6, 0, 0, 0.8}};
    const rlf_vec3 up = rlf_transform(&theirs, rlf_vec3_make(0.5, 1, 2));
    const rlf_vec3 ours = rlf_transform(&frame.T_world_camera, rlf_vec3_make(0.5, -1, 2));
    expect_near(ours.x, up.x);
    expect_near(ours.y, -up.y);
    expect_near(ours.z, up.z);
    expect_near(next(source).T_world_camera.q.y, 0.6);
    rlf_source_destroy(&source);
}

/* ---- 7-Scenes -----------------------------------------------------------------------------------
 */

TEST_CASE_WITH(scenes7_says_65535_for_missing, test_folder_make, test_folder_remove)
{
    make_folder("seq-01");
    for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof(name), "seq-01/frame-%06d.depth.png", i);
        write_depth(name, (uint16_t)(1000 + i), 65535);
        snprintf(name, sizeof(name), "seq-01/frame-%06d.color.png", i);
        write_color(name, W, H);
    }
    test_write_text("seq-01/frame-000000.pose.txt",
                    " 1.0e+00\t0 0 0.5\t\n0 1 0 0.25\n0 0 1 -1\n0 0 0 1\n");
    test_write_text("seq-01/frame-000001.pose.txt", "nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    rlf_source *source = open_folder("seq-01", 1, "7-Scenes");
    expect_near(rlf_source_get_info(source)->rig.depth.fx, 58.5);
    rlf_frame frame = next(source);
    assert_int_equal(frame.depth_u16[0], 0);
    assert_int_equal(frame.depth_u16[1], 1000);
    assert_true(frame.depth_units_per_metre == 1000);
    assert_true(frame.has_pose);
    expect_near(frame.T_world_camera.p.z, -1);
    assert_false(next(source).has_pose); /* NaN */
    assert_false(next(source).has_pose); /* no file */
    rlf_source_destroy(&source);
}

/* ---- Open3D and Redwood -------------------------------------------------------------------------
 */

static void make_redwood(const char *color_folder)
{
    char name[64];
    make_folder("scene/depth");
    snprintf(name, sizeof(name), "scene/%s", color_folder);
    make_folder(name);
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof(name), "scene/depth/%06d.png", i);
        write_depth(name, 1500, 0);
        snprintf(name, sizeof(name), "scene/%s/%06d.png", color_folder, i);
        write_color(name, 2 * W, 2 * H);
    }
}

TEST_CASE_WITH(redwood_reads_intrinsics_and_trajectory, test_folder_make, test_folder_remove)
{
    make_redwood("color");
    rlf_source *source = open_folder("scene", 1, "PrimeSense");
    expect_near(rlf_source_get_info(source)->rig.depth.fx, 52.5);
    expect_near(rlf_source_get_info(source)->rig.color.fx, 105.0);
    rlf_source_destroy(&source);
    test_write_text("scene/intrinsic.json",
                    "{\"width\":64,\"height\":48,\"intrinsic_matrix\":[60,0,0,0,61,0,31,23,1]}");
    test_write_text("scene/trajectory.log", "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
                                            "1 1 2\n0 -1 0 3\n1 0 0 4\n0 0 1 5\n0 0 0 1\n");
    source = open_folder("scene", 1, "2 poses for 3");
    expect_near(rlf_source_get_info(source)->rig.depth.fy, 61);
    assert_true(next(source).has_pose);
    const rlf_frame frame = next(source);
    assert_int_equal(frame.time_ns, 33333333);
    expect_near(frame.T_world_camera.p.y, 4);
    expect_near(fabs(frame.T_world_camera.q.z), sqrt(0.5));
    assert_false(next(source).has_pose);
    rlf_source_destroy(&source);
    test_write_text("scene/intrinsic.json",
                    "{\"width\":640,\"height\":48,\"intrinsic_matrix\":[60,0,0,0,61,0,31,23,1]}");
    test_expect_error(rlf_open_source(test_path("scene"), NULL, &source), RLF_ERROR_INVALID,
                      "intrinsic.json", "64 x 48", NULL);
}

TEST_CASE_WITH(names_may_hold_microseconds, test_folder_make, test_folder_remove)
{
    make_folder("scene/depth");
    make_folder("scene/image");
    write_depth("scene/depth/000001-000000000000.png", 1, 1);
    write_depth("scene/depth/000002-000000040000.png", 2, 2);
    write_color("scene/image/000001-000000001000.jpg", W, H);
    write_color("scene/image/000003-000000052000.jpg", W, H);
    test_write_text("scene/depth/readme.txt", "no picture");
    rlf_source *source = open_folder("scene", 1, NULL);
    rlf_frame frame = next(source);
    assert_int_equal(frame.time_ns, 0);
    frame = next(source);
    assert_int_equal(frame.time_ns, 40000000);
    assert_int_equal(frame.color_time_ns, 52000000);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(a_camera_json_goes_before_what_is_known, test_folder_make, test_folder_remove)
{
    make_redwood("image");
    test_write_text("scene/camera.json",
                    "{\"depth\":{\"width\":64,\"height\":48,\"fx\":70,\"fy\":70,\"cx\":32,"
                    "\"cy\":24,\"units_per_metre\":2000}}");
    rlf_source *source = open_folder("scene", 1, "not used");
    assert_true(rlf_source_get_info(source)->rig.depth.fx == 70);
    assert_true(next(source).depth_units_per_metre == 2000);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(odd_shapes_have_no_known_camera, test_folder_make, test_folder_remove)
{
    make_folder("scene/depth");
    uint16_t pixels[50 * 48] = {0};
    assert_int_equal(rlf_png_write_u16(test_path("scene/depth/0.png"), pixels, 50, 48), RLF_OK);
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source(test_path("scene"), NULL, &source), RLF_ERROR_INVALID,
                      "camera.json", "50 x 48", "docs/formats.md");
    make_folder("empty");
    test_expect_error(rlf_open_source(test_path("empty"), NULL, &source), RLF_ERROR_IO, "depth.txt",
                      NULL, NULL);
}

/* Every prefix of the text files is read or refused, never more. */
TEST_CASE(every_prefix_of_the_poses_is_safe)
{
    const char text[] = "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 1 2\n1 0 0 3\n";
    for (size_t size = 0; size < sizeof(text); size++) {
        const io_bytes file = {"x", (const uint8_t *)text, size};
        io_pose_list list;
        assert_int_equal(io_pose_list_log(&file, &list), RLF_OK);
        assert_true(list.count <= 1);
        io_pose_list_free(&list);
        assert_int_equal(io_pose_list_tum(&file, 0.0, 1.0, &list), RLF_OK);
        io_pose_list_free(&list);
        (void)io_pose_matrix(&file);
    }
}

/* Poses go with the pictures' times, which tell their unit. */
TEST_CASE(poses_in_other_units_are_understood)
{
    static const struct {
        const char *first, *last;
        double first_s, last_s; /* of the pictures */
        int64_t last_ns;        /* of the poses */
        const char *told;       /* NULL = nothing */
    } cases[] = {
        {"0.5", "9.5", 0.0, 10.0, INT64_C(9500000000), NULL},
        {"0", "10000", 0.0, 10.0, INT64_C(10000000000), "milliseconds"},
        {"100", "300000", 0.1, 290.0, INT64_C(300000000000), "milliseconds"},
        {"0", "120", 0.0, 121.0, INT64_C(120000000000), NULL}, /* one a minute */
        {"0", "99", 0.0, 3.3, INT64_C(99000000000), NULL},     /* numbers of pictures */
        {"1700000000000000000", "1700000200000000000", 1700000050.0, 1700000060.0,
         INT64_C(1700000200000000000), "nanoseconds"},
        {"1700000000000000", "1700000200000000", 1700000050.0, 1700000050.0,
         INT64_C(1700000200000000000), "microseconds"},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        char text[256];
        snprintf(text, sizeof(text), "%s 0 0 0 0 0 0 1\n%s 1 0 0 0 0 0 1\n", cases[i].first,
                 cases[i].last);
        const io_bytes file = {"groundtruth.txt", (const uint8_t *)text, strlen(text)};
        io_pose_list list;
        test_log log = {0};
        rlf_set_log(test_log_line, &log);
        assert_int_equal(io_pose_list_tum(&file, cases[i].first_s, cases[i].last_s, &list), RLF_OK);
        rlf_set_log(NULL, NULL);
        assert_int_equal(list.count, 2);
        if (list.times[1] != cases[i].last_ns || log.count != (cases[i].told != NULL ? 1 : 0)) {
            fail_msg("%zu: %lld, %s", i, (long long)list.times[1], log.last);
        }
        assert_true(cases[i].told == NULL || strstr(log.last, cases[i].told) != NULL);
        io_pose_list_free(&list);
    }
}
