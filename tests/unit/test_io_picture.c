/* PNG and JPEG: round trips, kinds, and every way in which a file can be damaged. */
#define _POSIX_C_SOURCE 200809L

#include "io/picture/picture.h"
#include "io_support.h"
#include "jpeg_sample.h"
#include "relief/io.h"
#include "test.h"

TEST_CASE(depth_png_round_trip)
{
    enum { W = 37, H = 11 };
    uint16_t depth[W * H];
    for (int i = 0; i < W * H; i++) {
        depth[i] = (uint16_t)(i * 2654435761u >> 7);
    }
    depth[0] = 0;
    depth[1] = 0xFFFF;
    depth[2] = 0x0102; /* would show swapped bytes */
    assert_int_equal(rlf_png_write_u16(test_path("d.png"), depth, W, H), RLF_OK);
    uint16_t *got = NULL;
    int32_t width = 0;
    int32_t height = 0;
    assert_int_equal(rlf_png_read_u16(test_path("d.png"), &got, &width, &height), RLF_OK);
    assert_int_equal(width, W);
    assert_int_equal(height, H);
    assert_memory_equal(got, depth, sizeof(depth));
    rlf_free(got);
}

TEST_CASE(color_png_round_trip_with_stride)
{
    enum { W = 9, H = 7, STRIDE = W * 4 + 12 };
    uint8_t data[STRIDE * H];
    for (int i = 0; i < STRIDE * H; i++) {
        data[i] = (uint8_t)(i * 37);
    }
    rlf_image_rgba8 image = {data, W, H, STRIDE};
    assert_int_equal(rlf_png_write_rgba(test_path("c.png"), &image), RLF_OK);
    rlf_image_rgba8 got;
    assert_int_equal(rlf_picture_read(test_path("c.png"), &got), RLF_OK);
    assert_int_equal(got.width, W);
    assert_int_equal(got.height, H);
    for (int y = 0; y < H; y++) {
        assert_memory_equal(rlf_rgba8_row(&got, y), rlf_rgba8_row(&image, y), W * 4);
    }
    rlf_free(got.data);
}

TEST_CASE(grey_png_becomes_opaque_rgba)
{
    uint8_t data[6] = {0, 1, 100, 200, 254, 255};
    rlf_plane_u8 plane = {data, 3, 2, 3};
    assert_int_equal(rlf_png_write_u8(test_path("g.png"), &plane), RLF_OK);
    rlf_image_rgba8 got;
    assert_int_equal(rlf_picture_read(test_path("g.png"), &got), RLF_OK);
    for (int i = 0; i < 6; i++) {
        const uint8_t expected[4] = {data[i], data[i], data[i], 255};
        assert_memory_equal(got.data + (ptrdiff_t)i * 4, expected, 4);
    }
    rlf_free(got.data);
}

/* 2 x 1 pixels: 0 1 0x0102 and 0xffff 0x8000 7. */
TEST_CASE(sixteen_bit_color_keeps_its_bits)
{
    static const uint8_t png[78] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49,
        0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x10, 0x02,
        0x00, 0x00, 0x00, 0x2b, 0xd0, 0x34, 0x9e, 0x00, 0x00, 0x00, 0x15, 0x49, 0x44,
        0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x60, 0x60, 0x60, 0x64, 0x64, 0xfa, 0xff,
        0xbf, 0x81, 0x81, 0x81, 0x1d, 0x00, 0x0d, 0x28, 0x02, 0x8a, 0x53, 0x12, 0x46,
        0x5a, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    const uint16_t expected[6] = {0, 1, 0x0102, 0xffff, 0x8000, 7};
    test_write("n.png", png, sizeof(png));
    uint16_t *got = NULL;
    int32_t width, height;
    assert_int_equal(rlf_png_read_rgb_u16(test_path("n.png"), &got, &width, &height), RLF_OK);
    assert_int_equal(width, 2);
    assert_int_equal(height, 1);
    assert_memory_equal(got, expected, sizeof(expected));
    rlf_free(got);
    test_expect_error(rlf_png_read_u16(test_path("n.png"), &got, &width, &height), RLF_ERROR_FORMAT,
                      "n.png", "16-bit colour", "16-bit grey PNG");
    assert_int_equal(rlf_png_write_u16(test_path("d.png"), expected, 2, 1), RLF_OK);
    test_expect_error(rlf_png_read_rgb_u16(test_path("d.png"), &got, &width, &height),
                      RLF_ERROR_FORMAT, "d.png", "16-bit grey", "16-bit colour PNG");
}

TEST_CASE(sixteen_bit_png_reads_as_picture)
{
    const uint16_t data[2] = {0x0000, 0xFFFF};
    assert_int_equal(rlf_png_write_u16(test_path("s.png"), data, 2, 1), RLF_OK);
    rlf_image_rgba8 got;
    assert_int_equal(rlf_picture_read(test_path("s.png"), &got), RLF_OK);
    const uint8_t expected[8] = {0, 0, 0, 255, 255, 255, 255, 255};
    assert_memory_equal(got.data, expected, 8);
    rlf_free(got.data);
}

TEST_CASE(jpeg_is_red_and_blue)
{
    test_write("a.jpg", jpeg_sample, sizeof(jpeg_sample));
    rlf_image_rgba8 got;
    assert_int_equal(rlf_picture_read(test_path("a.jpg"), &got), RLF_OK);
    assert_int_equal(got.width, 16);
    assert_int_equal(got.height, 8);
    const uint8_t *left = rlf_rgba8_row(&got, 4) + 3 * 4;
    const uint8_t *right = rlf_rgba8_row(&got, 4) + 12 * 4;
    assert_true(left[0] > 240 && left[1] < 15 && left[2] < 15 && left[3] == 255);
    assert_true(right[0] < 15 && right[1] < 15 && right[2] > 240 && right[3] == 255);
    rlf_free(got.data);
}

/* A PNG's colours are not multiplied by its alpha; what is clear or opaque stays as it is. */
TEST_CASE(premultiplied_colors_are_divided)
{
    uint8_t data[16] = {50, 20, 0, 100, 0, 0, 0, 0, 7, 8, 9, 255, 64, 128, 1, 128};
    const uint8_t expected[16] = {128, 51, 0, 100, 0, 0, 0, 0, 7, 8, 9, 255, 128, 255, 2, 128};
    const rlf_image_rgba8 image = {data, 4, 1, 16};
    rlf_image_rgba8 got;
    assert_int_equal(rlf_png_write_premultiplied(test_path("m.png"), &image), RLF_OK);
    assert_int_equal(data[0], 50);
    assert_int_equal(rlf_picture_read(test_path("m.png"), &got), RLF_OK);
    assert_memory_equal(got.data, expected, sizeof expected);
    rlf_free(got.data);
}

TEST_CASE(alpha_is_dropped_when_asked)
{
    uint8_t data[8] = {10, 20, 30, 0, 40, 50, 60, 128};
    rlf_image_rgba8 image = {data, 2, 1, 8};
    assert_int_equal(rlf_png_write_rgba(test_path("t.png"), &image), RLF_OK);
    size_t size;
    char *file = test_read(test_path("t.png"), &size);
    uint8_t got[8];
    io_bytes bytes = {"t.png", (const uint8_t *)file, size};
    io_picture picture = {.width = 2, .height = 1, .data = got, .is_opaque = true};
    assert_int_equal(io_picture_decode(&bytes, &picture), RLF_OK);
    const uint8_t expected[8] = {10, 20, 30, 255, 40, 50, 60, 255};
    assert_memory_equal(got, expected, 8);
    free(file);
}

/* Every proper beginning of a file is refused, and nothing leaks (seen by the sanitizer). */
static void check_all_prefixes(const char *name, const uint8_t *data, size_t size, bool is_depth)
{
    for (size_t length = 0; length < size; length++) {
        /* A copy of exactly this length, so that reading on is caught. */
        uint8_t *copy = malloc(length > 0 ? length : 1);
        assert_non_null(copy);
        memcpy(copy, data, length);
        io_bytes bytes = {name, copy, length};
        io_picture picture = {0};
        rlf_result result =
            is_depth ? io_png_decode_u16(&bytes, &picture) : io_picture_decode(&bytes, &picture);
        free(copy);
        if (result == RLF_OK) {
            fail_msg("%s: %zu of %zu bytes were accepted", name, length, size);
        }
        test_expect_error(result, RLF_ERROR_FORMAT, name, NULL, "");
        assert_null(picture.data);
    }
}

TEST_CASE(truncated_pictures_are_refused)
{
    uint16_t depth[20 * 10];
    for (int i = 0; i < 200; i++) {
        depth[i] = (uint16_t)(500 + i);
    }
    assert_int_equal(rlf_png_write_u16(test_path("d.png"), depth, 20, 10), RLF_OK);
    size_t size;
    char *file = test_read(test_path("d.png"), &size);
    check_all_prefixes("d.png", (const uint8_t *)file, size, true);
    check_all_prefixes("d.png", (const uint8_t *)file, size, false);
    free(file);
    check_all_prefixes("a.jpg", jpeg_sample, sizeof(jpeg_sample), false);
}

TEST_CASE(damaged_data_is_refused)
{
    uint16_t depth[64] = {1, 2, 3};
    assert_int_equal(rlf_png_write_u16(test_path("x.png"), depth, 8, 8), RLF_OK);
    size_t size;
    char *file = test_read(test_path("x.png"), &size);
    file[size - 20] ^= 0x55; /* in the checksum or the data of the only IDAT */
    test_write("x.png", file, size);
    free(file);
    uint16_t *got = NULL;
    int32_t width;
    int32_t height;
    test_expect_error(rlf_png_read_u16(test_path("x.png"), &got, &width, &height), RLF_ERROR_FORMAT,
                      "x.png", "damaged", "copy or record it again");
    assert_null(got);
}

TEST_CASE(stray_bytes_before_the_end_of_a_jpeg_are_harmless)
{
    uint8_t data[sizeof(jpeg_sample) + 3];
    size_t body = sizeof(jpeg_sample) - 2;
    memcpy(data, jpeg_sample, body);
    memset(data + body, 0x00, 3);
    memcpy(data + body + 3, jpeg_sample + body, 2);
    io_bytes bytes = {"stray.jpg", data, sizeof(data)};
    io_picture picture = {0};
    assert_int_equal(io_picture_decode(&bytes, &picture), RLF_OK);
    rlf_free(picture.data);
}

TEST_CASE(wrong_kinds_are_named)
{
    uint8_t pixels[16] = {0};
    rlf_plane_u8 plane = {pixels, 4, 2, 4};
    rlf_image_rgba8 image = {pixels, 2, 2, 8};
    assert_int_equal(rlf_png_write_u8(test_path("grey8.png"), &plane), RLF_OK);
    assert_int_equal(rlf_png_write_rgba(test_path("color.png"), &image), RLF_OK);
    test_write_text("text.png", "hello, this is text");
    test_write("empty.png", "", 0);
    uint16_t *depth = NULL;
    int32_t w;
    int32_t h;
    test_expect_error(rlf_png_read_u16(test_path("grey8.png"), &depth, &w, &h), RLF_ERROR_FORMAT,
                      "grey8.png", "8-bit grey", "16-bit grey PNG");
    test_expect_error(rlf_png_read_u16(test_path("color.png"), &depth, &w, &h), RLF_ERROR_FORMAT,
                      "color.png", "8-bit colour", "16-bit grey PNG");
    test_expect_error(rlf_png_read_u16(test_path("text.png"), &depth, &w, &h), RLF_ERROR_FORMAT,
                      "text.png", "not a PNG", "convert");
    test_expect_error(rlf_png_read_u16(test_path("empty.png"), &depth, &w, &h), RLF_ERROR_FORMAT,
                      "empty.png", "0 bytes", "again");
    test_expect_error(rlf_png_read_u16(test_path("none.png"), &depth, &w, &h), RLF_ERROR_IO,
                      "none.png", "No such file", "check the name");
    test_expect_error(rlf_png_read_u16(test_folder, &depth, &w, &h), RLF_ERROR_IO, test_folder,
                      "not a regular file", "give the name of a file");
    rlf_image_rgba8 got;
    test_expect_error(rlf_picture_read(test_path("text.png"), &got), RLF_ERROR_FORMAT, "text.png",
                      "neither PNG nor JPEG", "convert");
    test_expect_error(rlf_picture_read(test_path("empty.png"), &got), RLF_ERROR_FORMAT, "empty.png",
                      "0 bytes", "again");
    assert_null(got.data);
}

/* 16384 x 16384 in 70 bytes must not allocate a gigabyte; one pixel more is too large. */
TEST_CASE(absurd_sizes_cost_nothing)
{
    uint16_t pixel = 7;
    assert_int_equal(rlf_png_write_u16(test_path("big.png"), &pixel, 1, 1), RLF_OK);
    size_t size;
    char *file = test_read(test_path("big.png"), &size);
    static const uint8_t header[2][25] = {
        /* length IHDR width height 16-bit grey and its checksum */
        {0, 0,    0, 13, 'I', 'H', 'D', 'R', 0,    0,    0x40, 0,   0,
         0, 0x40, 0, 16, 0,   0,   0,   0,   0xDC, 0x33, 0x93, 0x1B},
        {0, 0,    0, 13, 'I', 'H', 'D', 'R', 0, 0, 0x40, 1, 0,
         0, 0x40, 1, 16, 0,   0,   0,   0,   0, 0, 0,    0}};
    uint64_t allocations = rlf_alloc_count();
    for (int i = 0; i < 2; i++) {
        memcpy(file + 8, header[i], sizeof(header[i]));
        io_bytes bytes = {"big.png", (const uint8_t *)file, size};
        io_picture picture = {0};
        test_expect_error(io_png_decode_u16(&bytes, &picture), RLF_ERROR_FORMAT, "big.png",
                          "cut short", "again");
    }
    assert_int_equal(rlf_alloc_count(), allocations);
    free(file);
}

TEST_CASE(decoding_into_given_memory_checks_the_size)
{
    io_bytes bytes = {"rgb/3.jpg", jpeg_sample, sizeof(jpeg_sample)};
    uint8_t pixels[16 * 8 * 4];
    io_picture fits = {.width = 16, .height = 8, .data = pixels};
    uint64_t allocations = rlf_alloc_count();
    assert_int_equal(io_picture_decode(&bytes, &fits), RLF_OK);
    assert_int_equal(rlf_alloc_count(), allocations);
    io_picture other = {.width = 8, .height = 8, .data = pixels};
    test_expect_error(io_picture_decode(&bytes, &other), RLF_ERROR_FORMAT, "rgb/3.jpg", "16 x 8",
                      "camera.json");
}

TEST_GROUP(test_folder_make, test_folder_remove)
