/* Y4M and MP4: headers, colours, odd sizes, and files that are whole after an early close. */
#define _POSIX_C_SOURCE 200809L

#include "io/video/video.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

static rlf_image_rgba8 flat(uint8_t *pixels, int32_t w, int32_t h, uint32_t rgb)
{
    for (int32_t i = 0; i < w * h; i++) {
        pixels[i * 4] = (uint8_t)(rgb >> 16);
        pixels[i * 4 + 1] = (uint8_t)(rgb >> 8);
        pixels[i * 4 + 2] = (uint8_t)rgb;
        pixels[i * 4 + 3] = 255;
    }
    rlf_image_rgba8 image = {pixels, w, h, (ptrdiff_t)w * 4};
    return image;
}

/* Colour bars as BT.601 prints them for 8 bits. */
TEST_CASE(known_colors_convert_exactly)
{
    static const struct {
        uint32_t rgb;
        uint8_t yuv[3];
    } bars[] = {{0x000000, {16, 128, 128}}, {0xFFFFFF, {235, 128, 128}}, {0xFF0000, {81, 90, 240}},
                {0x00FF00, {145, 54, 34}},  {0x0000FF, {41, 240, 110}},  {0xFFFF00, {210, 16, 146}},
                {0x808080, {126, 128, 128}}};
    for (size_t i = 0; i < sizeof(bars) / sizeof(bars[0]); i++) {
        uint8_t pixels[3 * 3 * 4];
        rlf_image_rgba8 image = flat(pixels, 3, 3, bars[i].rgb);
        io_yuv yuv;
        assert_int_equal(io_yuv_create(3, 3, &yuv), RLF_OK);
        assert_int_equal(yuv.width, 4);
        assert_int_equal(yuv.height, 4);
        io_yuv_from_rgba(&image, &yuv);
        for (int p = 0; p < 16; p++) {
            assert_int_equal(yuv.y[p], bars[i].yuv[0]);
        }
        for (int p = 0; p < 4; p++) {
            assert_int_equal(yuv.u[p], bars[i].yuv[1]);
            assert_int_equal(yuv.v[p], bars[i].yuv[2]);
        }
        io_yuv_destroy(&yuv);
    }
}

TEST_CASE(rates_are_exact_fractions)
{
    const struct {
        double rate;
        int numerator, denominator;
    } rates[] = {{30, 30, 1},   {29.97, 30000, 1001}, {23.976, 24000, 1001}, {59.94, 60000, 1001},
                 {12.5, 25, 2}, {0.001, 1, 1000},     {1000, 1000, 1},       {29.9997, 30, 1}};
    for (size_t i = 0; i < sizeof(rates) / sizeof(rates[0]); i++) {
        io_rate rate = io_rate_from(rates[i].rate);
        assert_int_equal(rate.numerator, rates[i].numerator);
        assert_int_equal(rate.denominator, rates[i].denominator);
    }
}

static void write_frames(const char *path, int32_t w, int32_t h, int count)
{
    uint8_t *pixels = malloc((size_t)w * (size_t)h * 4);
    assert_non_null(pixels);
    rlf_video *video = NULL;
    if (rlf_video_open(path, w, h, 30, &video) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    for (int i = 0; i < count; i++) {
        rlf_image_rgba8 image = flat(pixels, w, h, i % 2 == 0 ? 0xFF0000 : 0x0000FF);
        assert_int_equal(rlf_video_write(video, &image), RLF_OK);
    }
    if (rlf_video_close(&video) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    assert_null(video);
    free(pixels);
}

TEST_CASE(y4m_is_a_header_and_frames)
{
    write_frames(test_path("v.y4m"), 5, 3, 2);
    size_t size;
    char *file = test_read(test_path("v.y4m"), &size);
    const char *header = "YUV4MPEG2 W6 H4 F30:1 Ip A1:1 C420jpeg XYSCSS=420JPEG "
                         "XCOLORRANGE=LIMITED\n";
    size_t start = strlen(header);
    assert_memory_equal(file, header, start);
    size_t frame = 6 + 24 + 12;
    assert_int_equal(size, start + 2 * frame);
    assert_memory_equal(file + start, "FRAME\n\x51\x51", 8);
    assert_memory_equal(file + start + frame, "FRAME\n\x29\x29", 8);
    assert_int_equal((uint8_t)file[start + frame + 6 + 24], 240);
    free(file);
}

#ifdef RLF_HAVE_LIBAV
/* Place of a four-letter box name, or 0. */
static size_t find(const char *file, size_t size, const char *name)
{
    for (size_t i = 0; i + 16 < size; i++) {
        if (memcmp(file + i, name, 4) == 0) {
            return i;
        }
    }
    return 0;
}

TEST_CASE(mp4_is_whole_and_starts_fast)
{
    const struct {
        int width, height, count;
    } films[3] = {{64, 48, 10}, {63, 47, 1}, {64, 48, 0}};
    for (int i = 0; i < 3; i++) {
        const char *path = test_path("v: 1.mp4"); /* libav would take "v:" for a protocol */
        write_frames(path, films[i].width, films[i].height, films[i].count);
        size_t size;
        char *file = test_read(path, &size);
        assert_memory_equal(file + 4, "ftyp", 4);
        size_t sizes = find(file, size, "stsz");
        if (films[i].count > 0) {
            assert_true(find(file, size, "moov") < find(file, size, "mdat"));
            assert_true(find(file, size, "avc1") > 0 || find(file, size, "mp4v") > 0);
            assert_true(sizes > 0);
            assert_int_equal((uint8_t)file[sizes + 15], films[i].count);
        }
        free(file);
    }
}
#else
TEST_CASE(mp4_is_whole_and_starts_fast)
{
    rlf_video *video = NULL;
    test_expect_error(rlf_video_open(test_path("v.mp4"), 64, 48, 30, &video), RLF_ERROR_UNSUPPORTED,
                      "v.mp4", "cannot write MP4", ".y4m");
    assert_null(video);
}
#endif

TEST_GROUP(test_folder_make, test_folder_remove)
