/* Organised point clouds: three ways of writing them, the camera they tell, damaged files. */
#define _POSIX_C_SOURCE 200809L

#include "io/formats/pcd.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>

#define W 8
#define H 6
#define FX 9.0
#define FY 10.0
#define CX 3.25
#define CY 2.5

typedef struct cloud_point {
    float x, y, z;
    uint32_t rgb;
} cloud_point;

/* A tilted plane; point (2, 1) is missing. */
static cloud_point point_at(int u, int v)
{
    const float z = 1.0f + 0.1f * (float)u + 0.05f * (float)v;
    const uint32_t rgb = (uint32_t)(u * 30) << 16 | (uint32_t)(v * 40) << 8 | 7;
    if (u == 2 && v == 1) {
        return (cloud_point){NAN, NAN, NAN, rgb};
    }
    return (cloud_point){(float)((u - CX) / FX) * z, (float)((v - CY) / FY) * z, z, rgb};
}

#define HEADER(fields, sizes, types, counts, data)                                                 \
    "# .PCD v0.7\nVERSION 0.7\nFIELDS " fields "\nSIZE " sizes "\nTYPE " types "\nCOUNT " counts   \
    "\nWIDTH 8\nHEIGHT 6\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 48\nDATA " data "\n"

static uint8_t file_data[16384];
static size_t file_size;

static void append(const void *data, size_t size)
{
    assert_true(file_size + size <= sizeof(file_data));
    memcpy(file_data + file_size, data, size);
    file_size += size;
}

static void make_ascii(void)
{
    const char *header = HEADER("x y z rgb", "4 4 4 4", "F F F U", "1 1 1 1", "ascii");
    file_size = 0;
    append(header, strlen(header));
    for (int i = 0; i < W * H; i++) {
        const cloud_point p = point_at(i % W, i / W);
        char line[128];
        if (isnan(p.z)) {
            snprintf(line, sizeof(line), "nan nan nan %u\n", (unsigned)p.rgb);
        } else {
            snprintf(line, sizeof(line), "%.9g %.9g %.9g %u\n", (double)p.x, (double)p.y,
                     (double)p.z, (unsigned)p.rgb);
        }
        append(line, strlen(line));
    }
}

/* With fields that nobody needs before and after. */
static void make_binary(void)
{
    const char *header =
        HEADER("label x y z rgb normal", "2 4 4 4 4 8", "U F F F F F", "1 1 1 1 1 2", "binary");
    file_size = 0;
    append(header, strlen(header));
    for (int i = 0; i < W * H; i++) {
        const cloud_point p = point_at(i % W, i / W);
        const uint16_t label = 9;
        const double normal[2] = {1, 2};
        append(&label, sizeof(label));
        append(&p, sizeof(p));
        append(normal, sizeof(normal));
    }
}

/* Field by field in literal runs, and the last one as references: rgb twice the same. */
static void make_compressed(void)
{
    const char *header = HEADER("x y z rgb", "4 4 4 4", "F F F F", "1 1 1 1", "binary_compressed");
    static uint8_t planes[4 * 4 * W * H];
    for (int i = 0; i < W * H; i++) {
        const cloud_point p = point_at(i % W, i / W);
        memcpy(planes + 4 * i, &p.x, 4);
        memcpy(planes + 4 * (W * H + i), &p.y, 4);
        memcpy(planes + 4 * (2 * W * H + i), &p.z, 4);
        memcpy(planes + 4 * (3 * W * H + i), &p.rgb, 4);
    }
    static uint8_t packed[2048];
    size_t size = 0;
    for (size_t at = 0; at < sizeof(planes); at += 32) {
        packed[size++] = 31;
        memcpy(packed + size, planes + at, 32);
        size += 32;
    }
    const uint32_t sizes[2] = {(uint32_t)size, sizeof(planes)};
    file_size = 0;
    append(header, strlen(header));
    append(sizes, sizeof(sizes));
    append(packed, size);
}

static void (*const makers[3])(void) = {make_ascii, make_binary, make_compressed};

TEST_CASE_WITH(all_three_ways_give_the_same_frame, test_folder_make, test_folder_remove)
{
    for (int k = 0; k < 3; k++) {
        makers[k]();
        test_write("cloud.pcd", file_data, file_size);
        rlf_source *source = NULL;
        if (rlf_open_source(test_path("cloud.pcd"), NULL, &source) != RLF_OK) {
            fail_msg("%d: %s", k, rlf_error_text());
        }
        const rlf_source_info *info = rlf_source_get_info(source);
        const rlf_camera *c = &info->rig.depth;
        assert_true(fabs(c->fx - FX) < 1e-3 && fabs(c->fy - FY) < 1e-3);
        assert_true(fabs(c->cx - CX) < 1e-3 && fabs(c->cy - CY) < 1e-3);
        assert_int_equal(info->frame_count, 1);
        rlf_frame frame;
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_int_equal(frame.flags, RLF_FRAME_ALIGNED);
        for (int i = 0; i < W * H; i++) {
            const cloud_point p = point_at(i % W, i / W);
            assert_true(isnan(p.z) ? isnan(frame.depth_f32[i]) : frame.depth_f32[i] == p.z);
            const uint8_t *rgba = frame.color.data + (size_t)i * 4;
            assert_int_equal(rgba[0], i % W * 30);
            assert_int_equal(rgba[1], i / W * 40);
            assert_int_equal(rgba[2], 7);
            assert_int_equal(rgba[3], 255);
        }
        assert_int_equal(rlf_source_next(source, &frame), RLF_END);
        rlf_source_destroy(&source);
    }
}

TEST_CASE(references_of_lzf_may_overlap)
{
    /* "ab", then 10 bytes from 2 back; then the long form: 7 + 3 + 2 bytes from 1 back. */
    const uint8_t in[] = {1, 'a', 'b', 7 << 5, 1, 1, 7 << 5, 3, 0};
    uint8_t out[24];
    assert_true(io_lzf_decode(in, sizeof(in), out, 24));
    assert_memory_equal(out, "abababababab", 12);
    assert_int_equal(out[23], 'b');
    assert_false(io_lzf_decode(in, sizeof(in), out, 23));
    assert_false(io_lzf_decode(in, sizeof(in) - 1, out, 24));
    const uint8_t before[] = {0, 'a', 1 << 5, 1}; /* two back, and there is one */
    assert_false(io_lzf_decode(before, sizeof(before), out, 4));
}

static rlf_result read_points(const uint8_t *data, size_t size)
{
    const io_bytes file = {"cloud.pcd", data, size};
    io_pcd_header header;
    io_pcd_points points;
    rlf_result result = io_pcd_header_parse(&file, &header);
    if (result == RLF_OK) {
        result = io_pcd_points_read(&file, &header, &points);
    }
    if (result == RLF_OK) {
        rlf_camera camera;
        io_pcd_lens_fit(&header, &points, &camera);
        io_pcd_points_free(&points);
    }
    return result;
}

TEST_CASE(every_prefix_is_refused)
{
    for (int k = 0; k < 3; k++) {
        makers[k]();
        assert_int_equal(read_points(file_data, file_size), RLF_OK);
        const size_t last = k == 0 ? file_size - 10 : file_size; /* text may lack its last digits */
        for (size_t size = 0; size < last; size++) {
            uint8_t *copy = malloc(size + 1); /* of exactly this size, for the sanitizer */
            memcpy(copy, file_data, size);
            assert_int_equal(read_points(copy, size), RLF_ERROR_FORMAT);
            free(copy);
        }
    }
}

TEST_CASE(claims_are_not_believed)
{
    const struct {
        const char *text;
        rlf_result result;
        const char *part;
    } cases[] = {
        {"WIDTH 16384\nHEIGHT 16384\nFIELDS x y z\nDATA binary\nabc", RLF_ERROR_FORMAT,
         "cut short"},
        {"WIDTH 16384\nHEIGHT 16384\nFIELDS x y z\nDATA ascii\n1 1 1", RLF_ERROR_FORMAT,
         "cut short"},
        {"WIDTH 9999\nHEIGHT 9999\nFIELDS x y z\nDATA binary_compressed\n\xff\xff\xff\xff\xff\xff"
         "\xff\xff",
         RLF_ERROR_FORMAT, "cut short"},
        {"WIDTH 4294967299\nHEIGHT 2\nFIELDS x y z\nDATA ascii\n", RLF_ERROR_FORMAT, "WIDTH"},
        {"WIDTH 1000000\nHEIGHT 2\nFIELDS x y z\nDATA ascii\n", RLF_ERROR_FORMAT, "too large"},
        {"WIDTH 48\nHEIGHT 1\nFIELDS x y z\nDATA ascii\n", RLF_ERROR_UNSUPPORTED,
         "organised cloud"},
        {"WIDTH 2\nHEIGHT 2\nPOINTS 5\nFIELDS x y z\nDATA ascii\n", RLF_ERROR_FORMAT, "POINTS"},
        {"WIDTH 2\nHEIGHT 2\nFIELDS x y\nDATA ascii\n", RLF_ERROR_FORMAT, "no x, y and z"},
        {"WIDTH 2\nHEIGHT 2\nFIELDS x y z\nSIZE 4 4 3\nDATA ascii\n", RLF_ERROR_FORMAT, "SIZE"},
        {"WIDTH 2\nHEIGHT 2\nFIELDS x y z\nTYPE F F\nDATA ascii\n", RLF_ERROR_FORMAT, "TYPE"},
        {"WIDTH 2\nHEIGHT 2\nFIELDS x y z\nCOUNT 1 1 0\nDATA ascii\n", RLF_ERROR_FORMAT, "COUNT"},
        {"WIDTH 2\nHEIGHT 2\nFIELDS x y z\nDATA zip\n", RLF_ERROR_FORMAT, "DATA"},
        {"WIDTH -2\nHEIGHT 2\nFIELDS x y z\nDATA ascii\n", RLF_ERROR_FORMAT, "WIDTH"},
        {"", RLF_ERROR_FORMAT, "no end"},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        const uint64_t before = rlf_alloc_count();
        test_expect_error(read_points((const uint8_t *)cases[i].text, strlen(cases[i].text)),
                          cases[i].result, "cloud.pcd", cases[i].part, NULL);
        assert_int_equal(rlf_alloc_count(), before);
    }
}

TEST_CASE_WITH(without_a_pinhole_a_calibration_is_asked_for, test_folder_make, test_folder_remove)
{
    make_binary();
    const char *names[] = {"FIELDS label x y z", "FIELDS label y x z"}; /* not the camera's axes */
    char *at = strstr((char *)file_data, names[0]);
    memcpy(at, names[1], strlen(names[1]));
    test_write("cloud.pcd", file_data, file_size);
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source(test_path("cloud.pcd"), NULL, &source), RLF_ERROR_INVALID,
                      "cloud.pcd", "pinhole", "?camera=FILE");
    test_write_text("small.json", "{\"depth\":{\"width\":8,\"height\":6,\"fx\":9,\"fy\":9,\"cx\":4,"
                                  "\"cy\":3,\"units_per_metre\":1000}}");
    char text[TEST_PATH_MAX * 2];
    snprintf(text, sizeof(text), "%s?camera=%s", test_path("cloud.pcd"), test_path("small.json"));
    assert_int_equal(rlf_open_source(text, NULL, &source), RLF_OK);
    assert_true(rlf_source_get_info(source)->rig.depth.fx == 9);
    rlf_source_destroy(&source);
    test_write_text("small.json", "{\"depth\":{\"width\":9,\"height\":6,\"fx\":9,\"fy\":9,\"cx\":4,"
                                  "\"cy\":3,\"units_per_metre\":1000}}");
    test_expect_error(rlf_open_source(text, NULL, &source), RLF_ERROR_INVALID, "8 x 6", "9 x 6",
                      NULL);
}

TEST_CASE(a_real_cloud_is_read)
{
    const char *path = RLF_TEST_SHARED "/data/labelled/mOSD_learn13/cloud.pcd";
    if (!test_exists(path)) {
        print_message("SKIPPED: no %s\n", path);
        skip();
    }
    rlf_source *source = NULL;
    assert_int_equal(rlf_open_source(path, NULL, &source), RLF_OK);
    const rlf_camera *c = &rlf_source_get_info(source)->rig.depth;
    assert_true(fabs(c->fx - 525.0) < 0.01 && fabs(c->fy - 525.0) < 0.01);
    assert_true(fabs(c->cx - 319.5) < 0.01 && fabs(c->cy - 239.5) < 0.01);
    rlf_source_destroy(&source);
}
