/* camera.json: what is read, what is assumed, and what is refused. */
#define _POSIX_C_SOURCE 200809L

#include "io/calibration/calibration.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#define SIZE "\"width\":64,\"height\":48,"
#define LENS "\"fx\":60,\"fy\":61,\"cx\":31.5,\"cy\":23.5"
#define DEPTH "{" SIZE LENS ",\"units_per_metre\":5000}"
#define COLOR "\"color\":{" SIZE LENS "}"
#define ROTATION_90 "\"rotation\":[[0,-1,0],[1,0,0],[0,0,1]]"

static rlf_result parse(const char *text, rlf_rig *rig, double *units)
{
    io_bytes file = {"camera.json", (const uint8_t *)text, strlen(text)};
    return io_rig_parse(&file, rig, units);
}

TEST_CASE(smallest_file_gets_the_defaults)
{
    rlf_rig rig;
    double units = 0;
    assert_int_equal(parse("{\"depth\":" DEPTH "}", &rig, &units), RLF_OK);
    assert_true(units == 5000);
    assert_int_equal(rig.depth.width, 64);
    assert_int_equal(rig.depth.height, 48);
    assert_true(rig.depth.fx == 60 && rig.depth.fy == 61);
    assert_true(rig.depth.cx == 31.5 && rig.depth.cy == 23.5);
    assert_int_equal(rig.depth.distortion_model, RLF_DISTORTION_NONE);
    assert_false(rig.has_color);
    assert_true(rig.T_color_depth.q.w == 1 && rig.T_color_depth.p.x == 0);
    assert_true(rig.depth_min_m == 0.1 && rig.depth_max_m == 8.0);
    double sigma = rlf_depth_noise_sigma(&rig.noise, 2.0);
    assert_true(sigma > 0.003 && sigma < 0.008);
}

/* What may be said of a camera gives settings that may be used. */
TEST_CASE(the_farthest_range_can_be_run)
{
    rlf_rig rig;
    double units = 0;
    assert_int_equal(parse("{\"depth\":{" SIZE LENS
                           ",\"units_per_metre\":1000,\"depth_max_m\":1000}}",
                           &rig, &units),
                     RLF_OK);
    for (int profile = 0; profile < 2; profile++) {
        const rlf_reconstruct_def def = rlf_reconstruct_def_default((rlf_profile)profile, &rig);
        rlf_reconstruct *reconstruct = NULL;
        if (rlf_reconstruct_create(&def, &reconstruct) != RLF_OK) {
            fail_msg("%s", rlf_error_text());
        }
        rlf_reconstruct_destroy(&reconstruct);
    }
}

TEST_CASE(every_key_is_read)
{
    rlf_rig rig;
    double units = 0;
    assert_int_equal(
        parse("\xEF\xBB\xBF{\"depth\":{" SIZE LENS ",\"units_per_metre\":1000,\"depth_min_m\":0.5,"
              "\"depth_max_m\":4.5,\"noise\":[0.001,0.002,0.003],"
              "\"distortion_model\":\"plumb_bob\",\"distortion\":[1,2,3,4,5]},"
              "\"color\":{" SIZE LENS ",\"distortion_model\":\"rational_polynomial\","
              "\"distortion\":[1,2,3,4,5,6,7,8]},"
              "\"depth_to_color\":{" ROTATION_90 ",\"translation\":[0.1,0.2,0.3]},\"note\":\"n\"}",
              &rig, &units),
        RLF_OK);
    assert_int_equal(rig.depth.distortion_model, RLF_DISTORTION_PLUMB_BOB);
    assert_int_equal(rig.color.distortion_model, RLF_DISTORTION_RATIONAL_POLYNOMIAL);
    for (int i = 0; i < 8; i++) {
        assert_true(rig.depth.distortion[i] == (i < 5 ? i + 1 : 0));
        assert_true(rig.color.distortion[i] == i + 1);
    }
    assert_true(rig.has_color && rig.depth_min_m == 0.5 && rig.depth_max_m == 4.5);
    assert_true(rig.noise.c0 == 0.001 && rig.noise.c1 == 0.002 && rig.noise.c2 == 0.003);
    /* p_color = R p_depth + t by hand: (1, 2, 3) -> (-2, 1, 3) + t */
    rlf_vec3 p = rlf_transform(&rig.T_color_depth, rlf_vec3_make(1, 2, 3));
    rlf_vec3 error = rlf_sub(p, rlf_vec3_make(-1.9, 1.2, 3.3));
    assert_true(rlf_length(error) < 1e-12);
}

typedef struct broken {
    const char *text;
    rlf_result result;
    const char *part, *cure;
} broken;

static const broken broken_files[] = {
    {"", RLF_ERROR_FORMAT, "is empty", "docs/formats.md"},
    {"{", RLF_ERROR_FORMAT, "camera.json:1:", "docs/formats.md"},
    {"[1]", RLF_ERROR_FORMAT, "must be an object", "docs/formats.md"},
    {"{}", RLF_ERROR_INVALID, "depth is missing", "object"},
    {"{\"depth\":3}", RLF_ERROR_INVALID, "depth is a number", "must be an object"},
    {"{\"depth\":{\"height\":48," LENS "}}", RLF_ERROR_INVALID, "depth.width is missing",
     "whole number"},
    {"{\"depth\":{" SIZE "\"fy\":61,\"cx\":31.5,\"cy\":23.5,\"units_per_metre\":1000}}",
     RLF_ERROR_INVALID, "depth.fx is missing", "focal length in pixels"},
    {"{\"depth\":{" SIZE "\"fx\":60,\"fy\":61,\"cx\":31.5,\"units_per_metre\":1000}}",
     RLF_ERROR_INVALID, "depth.cy is missing", "principal point"},
    {"{\"depth\":{" SIZE LENS "}}", RLF_ERROR_INVALID, "depth.units_per_metre is missing",
     "1000 for millimetres"},
    {"{\"depth\":{" SIZE "\"fx\":\"60\",\"fy\":61,\"cx\":31.5,\"cy\":23.5,\"units_per_metre\":1}}",
     RLF_ERROR_INVALID, "depth.fx is a string", "focal length in pixels"},
    {"{\"depth\":{" SIZE "\"fx\":NaN,\"fy\":61,\"cx\":31.5,\"cy\":23.5,\"units_per_metre\":1}}",
     RLF_ERROR_FORMAT, "not valid JSON", "correct it"},
    {"{\"depth\":{" SIZE "\"fx\":1e999,\"fy\":61,\"cx\":31.5,\"cy\":23.5,\"units_per_metre\":1}}",
     RLF_ERROR_FORMAT, "not valid JSON", "correct it"},
    {"{\"depth\":{" SIZE "\"fx\":0,\"fy\":61,\"cx\":31.5,\"cy\":23.5,\"units_per_metre\":1}}",
     RLF_ERROR_INVALID, "depth.fx is 0", "focal length in pixels"},
    {"{\"depth\":{" SIZE "\"fx\":60,\"fy\":-61,\"cx\":31.5,\"cy\":23.5,\"units_per_metre\":1}}",
     RLF_ERROR_INVALID, "depth.fy is -61", "focal length in pixels"},
    {"{\"depth\":{" SIZE "\"fx\":60,\"fy\":61,\"cx\":1e6,\"cy\":23.5,\"units_per_metre\":1}}",
     RLF_ERROR_INVALID, "depth.cx is 1e+06", "principal point"},
    {"{\"depth\":{\"width\":0,\"height\":48," LENS ",\"units_per_metre\":1}}", RLF_ERROR_INVALID,
     "depth.width is 0", "1 to 16384"},
    {"{\"depth\":{\"width\":64,\"height\":999999999999," LENS ",\"units_per_metre\":1}}",
     RLF_ERROR_INVALID, "depth.height is 1e+12", "1 to 16384"},
    {"{\"depth\":{\"width\":64.5,\"height\":48," LENS ",\"units_per_metre\":1}}", RLF_ERROR_INVALID,
     "depth.width is 64.5", "whole number"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":0}}", RLF_ERROR_INVALID,
     "depth.units_per_metre is 0", "1000 for millimetres"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"depth_min_m\":9}}", RLF_ERROR_INVALID,
     "depth.depth_max_m is 8", "> depth_min_m"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"noise\":[1,2]}}", RLF_ERROR_INVALID,
     "depth.noise has 2 numbers", "c0"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"distortion_model\":\"fisheye\"}}",
     RLF_ERROR_INVALID, "depth.distortion_model is \"fisheye\"", "plumb_bob"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"distortion_model\":\"none\","
     "\"distortion\":[0.1,0]}}",
     RLF_ERROR_INVALID, "depth.distortion has numbers other than 0", "leave them out"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"distortion\":[1,2,3,4,5]}}",
     RLF_ERROR_INVALID, "depth.distortion_model is missing", "plumb_bob"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"distortion_model\":\"plumb_bob\"}}",
     RLF_ERROR_INVALID, "depth.distortion is missing", "5 numbers"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"distortion_model\":\"plumb_bob\","
     "\"distortion\":[1,2,3,4]}}",
     RLF_ERROR_INVALID, "depth.distortion has 4 numbers", "5 numbers"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"distortion_model\":\"rational_polynomial\","
     "\"distortion\":[1,2,3,4,5]}}",
     RLF_ERROR_INVALID, "depth.distortion has 5 numbers", "8 numbers"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"distortion_model\":\"plumb_bob\","
     "\"distortion\":[1,2,\"3\",4,5]}}",
     RLF_ERROR_INVALID, "depth.distortion is a string", "5 numbers"},
    {"{\"depth\":{" SIZE LENS ",\"units_per_metre\":1,\"units_per_metre\":2}}", RLF_ERROR_FORMAT,
     "duplicate", "correct it"},
    {"{\"depth\":" DEPTH ",\"color\":{\"width\":64,\"height\":48}}", RLF_ERROR_INVALID,
     "color.fx is missing", "focal length"},
    {"{\"depth\":" DEPTH ",\"depth_to_color\":{\"translation\":[0,0,0]}}", RLF_ERROR_INVALID,
     "depth_to_color.rotation is missing", "rotation"},
    {"{\"depth\":" DEPTH ",\"depth_to_color\":{\"rotation\":[[1,0,0],[0,1,0]],"
     "\"translation\":[0,0,0]}}",
     RLF_ERROR_INVALID, "depth_to_color.rotation is not complete", "three rows"},
    {"{\"depth\":" DEPTH ",\"depth_to_color\":{\"rotation\":[[2,0,0],[0,1,0],[0,0,1]],"
     "\"translation\":[0,0,0]}}",
     RLF_ERROR_INVALID, "not a rotation", "orthogonal"},
    {"{\"depth\":" DEPTH ",\"depth_to_color\":{\"rotation\":[[-1,0,0],[0,1,0],[0,0,1]],"
     "\"translation\":[0,0,0]}}",
     RLF_ERROR_INVALID, "determinant -1", "orthogonal"},
    {"{\"depth\":" DEPTH ",\"depth_to_color\":{" ROTATION_90 "}}", RLF_ERROR_INVALID,
     "depth_to_color.translation is missing", "metres"},
    {"{\"depth\":" DEPTH ",\"depth_to_color\":{" ROTATION_90 ",\"translation\":[-52,0,0]}}",
     RLF_ERROR_INVALID, "depth_to_color.translation is -52", "not millimetres"},
};

TEST_CASE(broken_files_are_refused_with_one_clear_line)
{
    for (size_t i = 0; i < sizeof(broken_files) / sizeof(broken_files[0]); i++) {
        rlf_rig rig = {.depth_min_m = -7};
        double units = -7;
        const broken *b = &broken_files[i];
        test_expect_error(parse(b->text, &rig, &units), b->result, "camera.json", b->part, b->cure);
        assert_true(rig.depth_min_m == -7 && units == -7);
    }
}

TEST_CASE(misspelt_keys_are_told)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rlf_rig rig;
    double units;
    assert_int_equal(parse("{\"depth\":" DEPTH "," COLOR ",\"depth_to_colour\":{}}", &rig, &units),
                     RLF_OK);
    rlf_set_log(NULL, NULL);
    assert_int_equal(log.count, 1);
    assert_non_null(strstr(log.last, "depth_to_colour"));
}

TEST_CASE(load_reads_the_file_and_names_it)
{
    rlf_rig rig;
    double units;
    test_write_text("camera.json", "{\"depth\":" DEPTH "}");
    assert_int_equal(rlf_rig_load(test_path("camera.json"), &rig, &units), RLF_OK);
    assert_true(units == 5000);
    test_expect_error(rlf_rig_load(test_path("none.json"), &rig, &units), RLF_ERROR_IO, "none.json",
                      "No such file", "docs/formats.md");
    test_expect_error(rlf_rig_load(test_folder, &rig, &units), RLF_ERROR_IO, test_folder,
                      "not a regular file", "file");
}

TEST_GROUP(test_folder_make, test_folder_remove)
