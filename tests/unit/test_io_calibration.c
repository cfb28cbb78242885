/* Calibration files of other programs: round trips, their own texts, and what is refused. */
#define _POSIX_C_SOURCE 200809L

#include "io/calibration/calibration.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>

static rlf_rig a_rig(bool has_color)
{
    rlf_rig rig = {.depth = {512,
                             424,
                             365.4,
                             365.3,
                             255.1234567890123,
                             211.5,
                             RLF_DISTORTION_PLUMB_BOB,
                             {0.09, -0.27, 1e-3, -2e-3, 0.09}},
                   .has_color = has_color,
                   .T_color_depth = rlf_pose_identity()};
    if (has_color) {
        rig.color = (rlf_camera){1920,
                                 1080,
                                 1060.1,
                                 1061.2,
                                 959.5,
                                 539.25,
                                 RLF_DISTORTION_RATIONAL_POLYNOMIAL,
                                 {0.1, -0.2, 1e-3, 2e-3, 0.01, 0.05, -0.1, 0.002}};
        rig.T_color_depth.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.01, -0.02, 0.3));
        rig.T_color_depth.p = rlf_vec3_make(0.052, 0.001, -0.002);
    }
    return rig;
}

static void assert_same_lens(const rlf_camera *a, const rlf_camera *b, bool has_distortion)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_true(a->fx == b->fx && a->fy == b->fy && a->cx == b->cx && a->cy == b->cy);
    for (int i = 0; i < 8; i++) {
        assert_true(b->distortion[i] == (has_distortion ? a->distortion[i] : 0.0));
    }
    assert_int_equal(b->distortion_model,
                     has_distortion ? a->distortion_model : RLF_DISTORTION_NONE);
}

static const struct {
    const char *save, *load, *load_one;
} files[] = {{"c.json", "c.json", "c.json"},
             {"ros.yaml", "ros_depth.yaml,%s/ros_color.yaml", "ros.yaml"},
             {"cv.yml", "cv.yml", "cv.yml"},
             {"o3d.json", "o3d_depth.json,%s/o3d_color.json", "o3d.json"},
             {"m.cameramodel", "m_depth.cameramodel,%s/m_color.cameramodel", "m.cameramodel"}};

TEST_CASE(every_format_comes_back)
{
    for (int pair = 0; pair < 2; pair++) {
        for (int f = RLF_RIG_RELIEF; f <= RLF_RIG_MRCAL; f++) {
            const rlf_rig rig = a_rig(pair == 1);
            rlf_rig back;
            double units = 0.0;
            char name[256];
            assert_int_equal(
                rlf_rig_save(test_path(files[f].save), (rlf_rig_format)f, &rig, 5000.0, "note"),
                RLF_OK);
            snprintf(name, sizeof(name), pair == 1 ? files[f].load : files[f].load_one,
                     test_folder);
            if (rlf_rig_load(test_path(name), &back, &units) != RLF_OK) {
                fail_msg("%s", rlf_error_text());
            }
            assert_true(units == (f == RLF_RIG_RELIEF ? 5000.0 : 1000.0));
            assert_int_equal(back.has_color, pair == 1);
            assert_same_lens(&rig.depth, &back.depth, f != RLF_RIG_OPEN3D);
            if (pair == 1) {
                assert_same_lens(&rig.color, &back.color, f != RLF_RIG_OPEN3D);
            }
            const rlf_vec3 p = rlf_vec3_make(0.3, -0.4, 2.0);
            const rlf_vec3 moved = rlf_sub(rlf_transform(&rig.T_color_depth, p),
                                           rlf_transform(&back.T_color_depth, p));
            assert_true(rlf_length(moved) < 1e-12);
        }
    }
}

static rlf_result load_text(const char *name, const char *text, rlf_rig *rig)
{
    double units;
    test_write_text(name, text);
    return rlf_rig_load(test_path(name), rig, &units);
}

/* As `ros2 topic echo` prints a message. */
static const char echo[] = "header:\n  stamp:\n    sec: 12\n  frame_id: camera\nheight: 480\n"
                           "width: 640\ndistortion_model: plumb_bob\nd:\n- 0.1\n- -0.2\n- 0.0\n"
                           "- 0.0\n- 0.05\nk:\n- 525.0\n- 0.0\n- 319.5\n- 0.0\n- 525.0\n- 239.5\n"
                           "- 0.0\n- 0.0\n- 1.0\nroi:\n  do_rectify: false\n---\nheight: 1\n";
/* As OpenCV's sample of calibration writes it. */
static const char opencv[] =
    "%YAML:1.0\r\n---\r\ncalibration_time: \"Wed 25 Nov\"\r\nimage_width: 640\r\n"
    "image_height: 480\r\nflags: 2 # fixed\r\ncamera_matrix: !!opencv-matrix\r\n   rows: 3\r\n"
    "   cols: 3\r\n   dt: d\r\n   data: [ 5.2500000000000000e+02, 0., 3.1950000000000000e+02, "
    "0.,\r\n"
    "       525., 2.3950000000000000e+02, 0., 0., 1. ]\r\n"
    "distortion_coefficients: !!opencv-matrix\r\n   rows: 5\r\n   cols: 1\r\n   dt: d\r\n"
    "   data: [ 0.1, -0.2, 0., 0., 0.05 ]\r\n";
static const char mrcal[] =
    "# made by a program\n{\n    'lensmodel':  'LENSMODEL_OPENCV8',\n\n    # fx,fy,cx,cy\n"
    "    'intrinsics': [ 525, 525, 319.5, 239.5, 0.1, -0.2, 0, 0, 0.05, 0, 0, 0,],\n"
    "    'valid_intrinsics_region': [ [ 1, 2 ], [ 3, 4 ], ],\n"
    "    'extrinsics': [ 0., 0., 0., 0., 0., 0.,],\n    'imagersize': [ 640, 480,],\n"
    "    'icam_intrinsics': 0,\n    'optimization_inputs': b'P~J(u0#2',\n}\n";

/* As OpenCV writes it by the name of the file, with what its sample of calibration adds. */
static const char xml[] =
    "<?xml version=\"1.0\"?>\n<!-- made > by -->\n<opencv_storage>\n"
    "<calibration_time>\"Wed 25 Nov\"</calibration_time>\n<image_width>640</image_width>\n"
    "<image_height>480</image_height>\n<flags>2</flags>\n"
    "<camera_matrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  <cols>3</cols>\n"
    "  <dt>d</dt>\n  <data>\n    5.25e+002 0. 3.195e+02 0. 525.\n    239.5 0. 0. 1.</data>"
    "</camera_matrix>\n<distortion_coefficients type_id=\"opencv-matrix\"><rows>5</rows>"
    "<data>0.1 -0.2 0. 0. 0.05</data></distortion_coefficients>\n<image_points><_>1. 2.</_>"
    "<_>3. 4.</_></image_points>\n</opencv_storage>\n";

TEST_CASE(texts_of_other_programs_are_read)
{
    const char *const texts[] = {echo, opencv, mrcal, xml};
    for (int i = 0; i < 4; i++) {
        rlf_rig rig;
        if (load_text("camera.txt", texts[i], &rig) != RLF_OK) {
            fail_msg("%s", rlf_error_text());
        }
        assert_int_equal(rig.depth.width, 640);
        assert_int_equal(rig.depth.height, 480);
        assert_true(rig.depth.fx == 525.0 && rig.depth.cx == 319.5 && rig.depth.cy == 239.5);
        assert_int_equal(rig.depth.distortion_model, RLF_DISTORTION_PLUMB_BOB);
        assert_true(rig.depth.distortion[1] == -0.2 && rig.depth.distortion[4] == 0.05);
    }
}

#define CAM(name, model, lens, more)                                                               \
    name ":\n  camera_model: pinhole\n  distortion_model: " model "\n  distortion_coeffs: " lens   \
         "\n  intrinsics: [461.5, 460.25, 362.5, 246.0]\n  resolution: [752, 480]\n"               \
         "  rostopic: /" name "/image_raw\n  cam_overlaps: [1]\n" more
#define CHAIN                                                                                      \
    "  T_cn_cnm1:\n  - [0.0, -1.0, 0.0, -0.11]\n  - [1.0, 0.0, 0.0, 0.02]\n"                       \
    "  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n"

TEST_CASE(a_chain_of_kalibr_is_read)
{
    rlf_rig rig;
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    assert_int_equal(
        load_text("chain.yaml", CAM("cam0", "radtan", "[0.01, -0.02, 1e-4, 2e-4]", ""), &rig),
        RLF_OK);
    assert_true(!rig.has_color && rig.depth.width == 752 && rig.depth.height == 480);
    assert_true(rig.depth.fx == 461.5 && rig.depth.fy == 460.25);
    assert_true(rig.depth.cx == 362.5 && rig.depth.cy == 246.0);
    assert_true(rig.depth.distortion[1] == -0.02 && rig.depth.distortion[3] == 2e-4);
    assert_int_equal(rig.depth.distortion_model, RLF_DISTORTION_PLUMB_BOB);
    const char two[] =
        CAM("cam0", "radtan", "[0.01, -0.02, 1e-4, 2e-4]", "") CAM("cam1", "none", "[]", CHAIN);
    assert_int_equal(load_text("chain.yaml", two, &rig), RLF_OK);
    assert_true(rig.has_color && rig.color.distortion_model == RLF_DISTORTION_NONE);
    const rlf_vec3 p = rlf_transform(&rig.T_color_depth, rlf_vec3_make(1.0, 2.0, 3.0));
    assert_true(fabs(p.x + 2.11) < 1e-12 && fabs(p.y - 1.02) < 1e-12 && fabs(p.z - 3.0) < 1e-12);
    assert_int_equal(log.count, 0);
    const char three[] = CAM("cam0", "none", "[]", "") CAM("cam1", "none", "[]", CHAIN)
        CAM("cam2", "none", "[]", CHAIN);
    assert_int_equal(load_text("chain.yaml", three, &rig), RLF_OK);
    assert_non_null(strstr(log.last, "more than two cameras"));
    rlf_set_log(NULL, NULL);
}

/* K is of the whole picture. */
TEST_CASE(a_window_of_ros_is_applied)
{
    rlf_rig rig;
    const char text[] = "height: 480\nwidth: 640\nk: [525, 0, 319.5, 0, 525, 239.5, 0, 0, 1]\n"
                        "d: []\nbinning_x: 2\nbinning_y: 2\nroi:\n  x_offset: 64\n  y_offset: 0\n"
                        "  height: 480\n  width: 512\n  do_rectify: false\n";
    assert_int_equal(load_text("a.yaml", text, &rig), RLF_OK);
    assert_true(rig.depth.width == 256 && rig.depth.height == 240 && rig.depth.fx == 262.5);
    assert_true(rig.depth.cx == 127.5 && rig.depth.cy == 119.5);
}

/* ROS tells the baseline of a rectified pair in P. */
TEST_CASE(a_rectified_pair_of_ros_has_its_baseline)
{
    static const char text[] =
        "image_width: 64\nimage_height: 48\nK: [60, 0, 31, 0, 60, 23, 0, 0, 1]\n"
        "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nP: [50, 0, 31, %s, 0, 50, 23, 0, 0, 0, 1, 0]\n";
    char left[512], right[512], name[256];
    rlf_rig rig;
    double units;
    snprintf(left, sizeof(left), text, "0");
    snprintf(right, sizeof(right), text, "-5");
    test_write_text("l.yaml", left);
    test_write_text("r.yaml", right);
    snprintf(name, sizeof(name), "l.yaml,%s/r.yaml", test_folder);
    assert_int_equal(rlf_rig_load(test_path(name), &rig, &units), RLF_OK);
    assert_true(fabs(rig.T_color_depth.p.x + 0.1) < 1e-12);
    snprintf(name, sizeof(name), "l.yaml,%s/l.yaml", test_folder);
    test_expect_error(rlf_rig_load(test_path(name), &rig, &units), RLF_ERROR_INVALID, "l.yaml",
                      "where the second camera is", "depth_to_color");
}

#define K_LINE "K: [60, 0, 31, 0, 60, 23, 0, 0, 1]\n"
#define SIZE_LINES "width: 64\nheight: 48\n"
static const struct {
    const char *name, *text;
    rlf_result result;
    const char *part;
} refused[] = {
    {"a.yaml", "", RLF_ERROR_FORMAT, "is empty"},
    {"a.yaml", "a cat\n", RLF_ERROR_FORMAT, "a key with a colon is missing"},
    {"a.yaml", SIZE_LINES, RLF_ERROR_INVALID, "camera_matrix must be 9 numbers"},
    {"a.yaml", K_LINE, RLF_ERROR_INVALID, "image_width and image_height are missing"},
    {"a.yaml", "width: 64\nheight: 0\n" K_LINE, RLF_ERROR_INVALID, "picture size 64 x 0"},
    {"a.yaml", SIZE_LINES "K: [60, 0, 31, 0, 60, 23, 0, 0, 1", RLF_ERROR_FORMAT,
     "a comma or ] is missing"},
    {"a.yaml", SIZE_LINES "K: [0.9, 0, 31, 0, 0.9, 23, 0, 0, 1]\nD: []\n", RLF_OK, NULL},
    {"a.yaml", SIZE_LINES "K: [0.1, 0, 31, 0, 0.1, 23, 0, 0, 1]\n", RLF_ERROR_INVALID, "in pixels"},
    {"a.yaml", SIZE_LINES "K: [60, 1, 31, 0, 60, 23, 0, 0, 1]\n", RLF_ERROR_INVALID, "fx 0 cx"},
    {"a.yaml", SIZE_LINES K_LINE "D: [1, x]\n", RLF_ERROR_INVALID, "D is a string"},
    {"a.yaml", SIZE_LINES K_LINE "distortion_model: equidistant\n", RLF_ERROR_INVALID,
     "only plumb"},
    {"a.yaml", SIZE_LINES K_LINE "D: [0,0,0,0,0,0,0,0,0.1]\n", RLF_ERROR_INVALID, "thin prism"},
    {"a.yaml", SIZE_LINES K_LINE K_LINE, RLF_ERROR_FORMAT, "given twice"},
    {"a.yaml", "a: &x 1\n", RLF_ERROR_FORMAT, "not read"},
    {"a.yaml", "a: 1\n  b: 2\n", RLF_ERROR_FORMAT, "further in"},
    {"a.yaml", "  a: 1\nb: 2\n", RLF_ERROR_FORMAT, "further out"},
    {"a.yaml", "a: \"x\n", RLF_ERROR_FORMAT, "does not end"},
    {"a.yaml", "a: \xff\n", RLF_ERROR_FORMAT, "UTF-8"},
    {"a.yaml", "a: [[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]]\n", RLF_ERROR_FORMAT, "deeper"},
    {"a.yaml",
     SIZE_LINES "M1: [60, 0, 31, 0, 60, 23, 0, 0, 1]\nM2: [60, 0, 31, 0, 60, 23, 0, 0, 1]\n",
     RLF_ERROR_INVALID, "R and T are missing"},
    {"a.cameramodel", "{'lensmodel': 'LENSMODEL_SPLINED_STEREOGRAPHIC', }", RLF_ERROR_INVALID,
     "only LENSMODEL_PINHOLE"},
    {"a.cameramodel", "{'lensmodel': 'LENSMODEL_PINHOLE', 'intrinsics': [1, 2]}", RLF_ERROR_INVALID,
     "intrinsics has 2 numbers"},
    {"a.yaml", CAM("cam0", "equidistant", "[0, 0, 0, 0]", ""), RLF_ERROR_INVALID,
     "cam0.distortion_model is \"equidistant\": only radtan"},
    {"a.yaml", "cam0:\n  camera_model: omni\n", RLF_ERROR_INVALID, "only pinhole is read"},
    {"a.yaml", CAM("cam0", "none", "[]", "") CAM("cam1", "none", "[]", ""), RLF_ERROR_INVALID,
     "cam1.T_cn_cnm1 must be four rows"},
    {"a.yaml", "parameters:\n  rate: 30\n", RLF_ERROR_INVALID, "settings of a camera's driver"},
    {"a.yaml", SIZE_LINES K_LINE "fisheye_model: 1\n", RLF_ERROR_INVALID, "fisheye_model is set"},
    {"a.yaml", SIZE_LINES K_LINE "roi: {x_offset: 60, width: 8, height: 8}\n", RLF_ERROR_INVALID,
     "leaves no part of the picture"},
    {"a.yaml", SIZE_LINES K_LINE "binning_x: 0.5\n", RLF_ERROR_INVALID, "whole number"},
    {"a.xml", "<mesh></mesh>", RLF_ERROR_FORMAT, "of XML only OpenCV's FileStorage is read"},
    {"a.xml", "<opencv_storage><a>1</b></opencv_storage>", RLF_ERROR_FORMAT, "does not end"},
    {"a.xml", "<opencv_storage><rate>1</rate></opencv_storage>", RLF_ERROR_INVALID,
     "its first key is rate"},
    {"a.json", "", RLF_ERROR_FORMAT, "is empty"},
    {"a.yaml", " \n\t", RLF_ERROR_FORMAT, "is empty"},
    {"a.json", "\x89PNG\r\n", RLF_ERROR_FORMAT, "looks like a PNG picture"},
    {"a.yaml", "\x89MCAP0\r\n", RLF_ERROR_FORMAT, "an MCAP recording: give it as the SOURCE"},
    {"a.json", "{\"bodies\": []}", RLF_ERROR_INVALID, "a scene of Relief"},
    {"a.json", "{\"mass\": 1}", RLF_ERROR_INVALID, "its first key is mass"},
    {"a.json", "{\"intrinsic_matrix\": [1, 2]}", RLF_ERROR_INVALID, "intrinsic_matrix has 2"},
};

TEST_CASE(what_does_not_fit_is_refused_with_a_reason)
{
    for (size_t i = 0; i < sizeof(refused) / sizeof(refused[0]); i++) {
        rlf_rig rig;
        const rlf_result result = load_text(refused[i].name, refused[i].text, &rig);
        if (result != refused[i].result ||
            (result != RLF_OK && strstr(rlf_error_text(), refused[i].part) == NULL)) {
            fail_msg("%zu: %s", i, rlf_error_text());
        }
    }
}

/* Cut anywhere, and with any byte in any place: a value or an error, never a crash. */
TEST_CASE(damaged_texts_do_no_harm)
{
    static const char bytes[] = "\0[]{}:,'\"#-!\n &\xff";
    const char *const texts[] = {echo, opencv, mrcal, xml};
    for (int t = 0; t < 4; t++) {
        const size_t length = strlen(texts[t]);
        char *copy = malloc(length);
        assert_non_null(copy);
        for (size_t cut = 0; cut < length; cut++) {
            for (size_t b = 0; b < sizeof(bytes); b++) {
                memcpy(copy, texts[t], length);
                copy[cut] = bytes[b];
                const io_bytes file = {"x", (const uint8_t *)copy, b == 0 ? cut : length};
                json_t *value = NULL;
                const rlf_result result = t == 3 ? io_calibration_xml_parse(&file, &value)
                                                 : io_calibration_text_parse(&file, &value);
                if (result == RLF_OK) {
                    assert_non_null(value);
                    json_decref(value);
                }
            }
        }
        free(copy);
    }
}

TEST_GROUP(test_folder_make, test_folder_remove)
