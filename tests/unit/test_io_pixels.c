/* Raw pictures of messages and recordings: every encoding, sizes that lie. */
#define _POSIX_C_SOURCE 200809L
#include "io/picture/pixels.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>

typedef struct sample {
    const char *encoding;
    int width, height, step;
    const uint8_t bytes[16];
    size_t size;
    uint8_t first[3], last[3]; /* pixels that must come out, each channel within 2 */
} sample;

static const sample samples[] = {
    {"rgb8", 2, 1, 6, {10, 20, 30, 40, 50, 60}, 6, {10, 20, 30}, {40, 50, 60}},
    {"rgba8", 1, 1, 4, {10, 20, 30, 7}, 4, {10, 20, 30}, {10, 20, 30}},
    {"bgr8", 2, 1, 6, {30, 20, 10, 60, 50, 40}, 6, {10, 20, 30}, {40, 50, 60}},
    {"bgra8", 1, 1, 4, {30, 20, 10, 7}, 4, {10, 20, 30}, {10, 20, 30}},
    {"mono8", 2, 1, 2, {9, 200}, 2, {9, 9, 9}, {200, 200, 200}},
    {"mono16", 2, 1, 4, {1, 9, 1, 200}, 4, {9, 9, 9}, {200, 200, 200}},
    /* Rows with a gap between them. */
    {"mono8", 1, 2, 3, {9, 0, 0, 200}, 4, {9, 9, 9}, {200, 200, 200}},
    {"mono8", 2, 1, 0, {9, 200}, 2, {9, 9, 9}, {200, 200, 200}},
    /* White is 235, black is 16; red is (81, 90, 240) by ITU-R BT.601. */
    {"yuv422", 2, 1, 4, {128, 235, 128, 16}, 4, {255, 255, 255}, {0, 0, 0}},
    {"yuv422_yuy2", 2, 1, 4, {81, 90, 81, 240}, 4, {255, 0, 0}, {255, 0, 0}},
    {"nv12", 2, 2, 2, {81, 81, 81, 81, 90, 240}, 6, {255, 0, 0}, {255, 0, 0}},
    {"nv21", 2, 2, 2, {81, 81, 81, 81, 240, 90}, 6, {255, 0, 0}, {255, 0, 0}},
    {"bayer_rggb8", 2, 2, 2, {90, 50, 50, 20}, 4, {90, 50, 20}, {90, 50, 20}},
    {"bayer_bggr8", 2, 2, 2, {20, 50, 50, 90}, 4, {90, 50, 20}, {90, 50, 20}},
    {"bayer_grbg8", 2, 2, 2, {50, 90, 20, 50}, 4, {90, 50, 20}, {90, 50, 20}},
    {"bayer_gbrg8", 2, 2, 2, {50, 20, 90, 50}, 4, {90, 50, 20}, {90, 50, 20}},
};

static io_pixels pixels_of(const sample *s)
{
    const io_pixels in = {.name = "topic",
                          .encoding = s->encoding,
                          .width = s->width,
                          .height = s->height,
                          .step = s->step,
                          .data = s->bytes,
                          .size = s->size};
    return in;
}

static void expect_pixel(const sample *s, const uint8_t *got, const uint8_t *wanted)
{
    for (int i = 0; i < 3; i++) {
        if (abs(got[i] - wanted[i]) > 2) {
            fail_msg("%s: channel %d is %d, not %d", s->encoding, i, got[i], wanted[i]);
        }
    }
    assert_int_equal(got[3], 255);
}

TEST_CASE(colors_of_every_encoding)
{
    for (size_t i = 0; i < sizeof(samples) / sizeof(samples[0]); i++) {
        const sample *s = &samples[i];
        const io_pixels in = pixels_of(s);
        uint8_t data[4 * 4] = {0};
        const rlf_image_rgba8 out = {data, s->width, s->height, 4 * s->width};
        if (io_pixels_to_rgba(&in, &out) != RLF_OK) {
            fail_msg("%s: %s", s->encoding, rlf_error_text());
        }
        expect_pixel(s, data, s->first);
        expect_pixel(s, data + 4 * (s->width * s->height - 1), s->last);
    }
}

TEST_CASE(pictures_cut_anywhere_are_refused)
{
    for (size_t i = 0; i < sizeof(samples) / sizeof(samples[0]); i++) {
        io_pixels in = pixels_of(&samples[i]);
        for (in.size = 0; in.size < samples[i].size; in.size++) {
            /* Exactly so many bytes, so that a sanitizer sees the first one too many. */
            uint8_t *copy = malloc(in.size + 1);
            memcpy(copy, samples[i].bytes, in.size);
            in.data = copy;
            uint8_t data[4 * 4];
            const rlf_image_rgba8 out = {data, samples[i].width, samples[i].height,
                                         4 * samples[i].width};
            test_expect_error(io_pixels_to_rgba(&in, &out), RLF_ERROR_FORMAT, "topic", "cut short",
                              "record it again");
            free(copy);
        }
    }
}

TEST_CASE(sizes_that_lie_are_refused)
{
    uint8_t data[16] = {0};
    uint16_t depth[4];
    double units;
    const int64_t sizes[] = {0, -1, RLF_IMAGE_SIZE_MAX + 1, UINT32_MAX, INT64_MAX};
    for (size_t i = 0; i < 5; i++) {
        io_pixels in = {"topic", "16UC1", sizes[i], 1, 2 * 4, false, data, sizeof(data)};
        assert_int_equal(io_pixels_to_depth(&in, depth, &units), RLF_ERROR_FORMAT);
        in = (io_pixels){"topic", "16UC1", 1, sizes[i], 2, false, data, sizeof(data)};
        assert_int_equal(io_pixels_to_depth(&in, depth, &units), RLF_ERROR_FORMAT);
        if (sizes[i] == 0) {
            continue; /* no gap */
        }
        in = (io_pixels){"topic", "16UC1", 2, 2, sizes[i], false, data, sizeof(data)};
        assert_int_equal(io_pixels_to_depth(&in, depth, &units), RLF_ERROR_FORMAT);
    }
    io_pixels in = {"topic", "jpeg2000", 2, 1, 2, false, data, sizeof(data)};
    const rlf_image_rgba8 out = {data, 2, 1, 8};
    test_expect_error(io_pixels_to_rgba(&in, &out), RLF_ERROR_UNSUPPORTED, "topic", "jpeg2000",
                      "rgb8");
    assert_int_equal(io_pixels_to_depth(&in, depth, &units), RLF_ERROR_UNSUPPORTED);
    in.encoding = "mono8";
    in.width = 3;
    test_expect_error(io_pixels_to_rgba(&in, &out), RLF_ERROR_FORMAT, "topic", "3 x 1 ", "2 x 1");
}

TEST_CASE(counts_are_taken_as_they_are)
{
    const uint8_t data[] = {0x34, 0x12, 0xFF, 0xFF, 9, 9, 1, 0, 0, 0};
    io_pixels in = {"topic", "16UC1", 2, 2, 6, false, data, sizeof(data)};
    uint16_t depth[4];
    double units;
    assert_int_equal(io_pixels_to_depth(&in, depth, &units), RLF_OK);
    assert_true(units == 1000.0);
    const uint16_t wanted[4] = {0x1234, 0xFFFF, 1, 0};
    assert_memory_equal(depth, wanted, sizeof(wanted));
    in.encoding = "mono16";
    in.is_bigendian = true;
    assert_int_equal(io_pixels_to_depth(&in, depth, &units), RLF_OK);
    assert_int_equal(depth[0], 0x3412);
}

TEST_CASE(metres_become_counts)
{
    const float metres[8] = {1.5f, 0.0f, -1.0f, NAN, INFINITY, 13.2f, 0.00011f, 13.1f};
    const io_pixels in = {"topic", "32FC1", 8, 1, 32, false, (const uint8_t *)metres, 32};
    uint16_t depth[8];
    double units;
    assert_int_equal(io_pixels_to_depth(&in, depth, &units), RLF_OK);
    assert_true(units == IO_PIXELS_FLOAT_UNITS);
    const uint16_t wanted[8] = {7500, 0, 0, 0, 0, 0, 1, 65500};
    assert_memory_equal(depth, wanted, sizeof(wanted));
}

/* A message's data: the header, then a PNG of the counts. */
static uint8_t *compressed(const uint16_t *counts, float a, float b, size_t *out_size)
{
    assert_int_equal(rlf_png_write_u16(test_path("depth.png"), counts, 2, 2), RLF_OK);
    size_t size;
    char *png = test_read(test_path("depth.png"), &size);
    uint8_t *data = calloc(1, size + 12);
    memcpy(data + 4, &a, 4);
    memcpy(data + 8, &b, 4);
    memcpy(data + 12, png, size);
    free(png);
    *out_size = size + 12;
    return data;
}

TEST_CASE_WITH(compressed_depth_is_read, test_folder_make, test_folder_remove)
{
    /* 1/z = (n - b) / a: with a = 100 and b = 0.5, n = 50 is 100 / 49.5 = 2.0202 m. */
    const uint16_t counts[4] = {50, 0, 100, 65535};
    static io_rvl rvl;
    io_rvl_init(&rvl);
    size_t size;
    uint8_t *data = compressed(counts, 100.0f, 0.5f, &size);
    const io_bytes file = {"topic", data, size};
    uint16_t depth[4];
    double units;
    assert_int_equal(
        io_compressed_depth_decode(&rvl, &file, "16UC1; compressedDepth", 2, 2, depth, &units),
        RLF_OK);
    assert_true(units == 1000.0);
    assert_memory_equal(depth, counts, sizeof(counts));
    assert_int_equal(
        io_compressed_depth_decode(&rvl, &file, "32FC1; compressedDepth png", 2, 2, depth, &units),
        RLF_OK);
    assert_true(units == IO_PIXELS_FLOAT_UNITS);
    const uint16_t wanted[4] = {10101, 0, 5025, 8};
    assert_memory_equal(depth, wanted, sizeof(wanted));
    for (size_t cut = 0; cut < size; cut++) {
        const io_bytes part = {"topic", data, cut};
        assert_int_equal(
            io_compressed_depth_decode(&rvl, &part, "16UC1; compressedDepth", 2, 2, depth, &units),
            RLF_ERROR_FORMAT);
    }
    free(data);
}

TEST_CASE(rvl_depth_is_read)
{
    static io_rvl rvl;
    io_rvl_init(&rvl);
    const uint16_t counts[4] = {1500, 0, 1501, 900};
    const int32_t head[5] = {0, 0, 0, 2, 2};
    uint8_t data[128];
    memcpy(data, head, sizeof(head));
    const size_t size = sizeof(head) + io_rvl_encode(&rvl, counts, 4, data + sizeof(head));
    const char *format = "16UC1; compressedDepth rvl";
    const io_bytes file = {"topic", data, size};
    uint16_t depth[4];
    double units;
    assert_int_equal(io_compressed_depth_decode(&rvl, &file, format, 2, 2, depth, &units), RLF_OK);
    assert_memory_equal(depth, counts, sizeof(counts));
    test_expect_error(io_compressed_depth_decode(&rvl, &file, format, 4, 1, depth, &units),
                      RLF_ERROR_FORMAT, "topic", "2 x 2", "camera=FILE");
    for (size_t cut = 0; cut + 4 < size; cut++) {
        const io_bytes part = {"topic", data, cut};
        assert_int_equal(io_compressed_depth_decode(&rvl, &part, format, 2, 2, depth, &units),
                         RLF_ERROR_FORMAT);
    }
}
