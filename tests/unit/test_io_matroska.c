/* Recordings of Azure Kinect and Femto cameras: tracks, calibration, times, damage. */
#define _POSIX_C_SOURCE 200809L
#include "io_support.h"
#include "mkv_sample.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>
#ifdef RLF_HAVE_LIBAV
#include <libavformat/avformat.h>
#endif

static const uint32_t nfov_binned[2] = {320, 288};
static const uint32_t tiny[2] = {4, 3};

static rlf_source *open_clip(const char *keys)
{
    char source[TEST_PATH_MAX];
    snprintf(source, sizeof(source), "k4a-mkv:%s%s", test_path("clip.mkv"), keys);
    rlf_source *opened = NULL;
    if (rlf_open_source(source, NULL, &opened) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return opened;
}

static void save(byte_file *b)
{
    test_write("clip.mkv", b->data, b->size);
    free(b);
}

static void expect_near(double got, double wanted)
{
    if (fabs(got - wanted) > 1e-9) {
        fail_msg("%.12g is not %.12g", got, wanted);
    }
}

static void expect_frame(rlf_source *source, int i)
{
    rlf_frame frame;
    if (rlf_source_next(source, &frame) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    assert_int_equal(frame.time_ns, 5000000 + 32000000 * (int64_t)i);
    assert_int_equal(frame.depth_u16[0], 1000 + 100 * i);
    assert_int_equal(frame.depth_u16[5], 1005 + 100 * i);
    assert_true(frame.depth_units_per_metre == 1000.0);
    assert_non_null(frame.color.data);
    assert_int_equal(frame.color_time_ns, 7000000 + 32000000 * (int64_t)i);
    assert_true(frame.color.data[0] > 200 && frame.color.data[2] < 50);
    assert_true(frame.color.data[4 * 15] < 50 && frame.color.data[4 * 15 + 2] > 200);
}

static void check_calibration(const rlf_rig *rig)
{
    assert_int_equal(rig->depth.width, 320);
    expect_near(rig->depth.fx, 252.0);
    expect_near(rig->depth.cx, 159.5); /* 256 - 96 - 0.5 */
    expect_near(rig->depth.cy, 165.5); /* 256 - 90 - 0.5 */
    assert_int_equal(rig->depth.distortion_model, RLF_DISTORTION_RATIONAL_POLYNOMIAL);
    const double distortion[8] = {0.5, -0.02, 2e-05, -7e-05, -0.003, 0.9, 0.09, -0.01};
    for (int i = 0; i < 8; i++) {
        expect_near(rig->depth.distortion[i], distortion[i]);
    }
    /* 16 x 8 of 16 x 12: two rows are left out above. */
    assert_int_equal(rig->color.width, 16);
    expect_near(rig->color.fx, 0.478 * 16);
    expect_near(rig->color.fy, 0.637 * 12);
    expect_near(rig->color.cx, 7.5);
    expect_near(rig->color.cy, 3.5);
    expect_near(rig->T_color_depth.p.x, -0.032);
    expect_near(rig->T_color_depth.p.z, 0.004);
    const rlf_mat3 rotation = rlf_quat_to_mat3(rig->T_color_depth.q);
    assert_true(fabs(rotation.m[1][2] - 0.0871) < 1e-4);
}

TEST_CASE(recordings_of_k4arecorder_are_read)
{
    save(mkv_sample_make(nfov_binned, true));
    rlf_source *source = open_clip("");
    const rlf_source_info *info = rlf_source_get_info(source);
    check_calibration(&info->rig);
    assert_int_equal(info->frame_count, MKV_SAMPLE_FRAMES);
    assert_true(fabs(info->frames_per_second - 31.25) < 1e-6);
    assert_non_null(strstr(info->device, "NFOV_2X2BINNED"));
    assert_non_null(strstr(info->device, "000123"));
    for (int i = 0; i < MKV_SAMPLE_FRAMES; i++) {
        expect_frame(source, i);
    }
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    assert_int_equal(rlf_source_seek(source, 1), RLF_OK);
    expect_frame(source, 1);
    rlf_source_destroy(&source);
}

/* A mode that the camera does not have needs a calibration of the user's. */
static void write_rig(const char *name, int width, int height)
{
    char text[512];
    snprintf(text, sizeof(text),
             "{\"depth\": {\"width\": %d, \"height\": %d, \"fx\": 5, \"fy\": 5, \"cx\": 2, "
             "\"cy\": 1, \"units_per_metre\": 1000}, \"color\": {\"width\": 16, \"height\": 8, "
             "\"fx\": 9, \"fy\": 9, \"cx\": 8, \"cy\": 4}}",
             width, height);
    test_write_text(name, text);
}

TEST_CASE(calibrations_are_asked_for)
{
    rlf_source *source = NULL;
    save(mkv_sample_make(tiny, true));
    test_expect_error(rlf_open_source(test_path("clip.mkv"), NULL, &source), RLF_ERROR_UNSUPPORTED,
                      "clip.mkv", "4 x 3", "?camera=FILE");
    save(mkv_sample_make(tiny, false));
    test_expect_error(rlf_open_source(test_path("clip.mkv"), NULL, &source), RLF_ERROR_FORMAT,
                      "clip.mkv", "calibration.json", "?camera=FILE");
    write_rig("clip.json", 4, 3);
    source = open_clip("");
    expect_frame(source, 0);
    rlf_source_destroy(&source);
    write_rig("clip.json", 8, 6);
    test_expect_error(rlf_open_source(test_path("clip.mkv"), NULL, &source), RLF_ERROR_INVALID,
                      "clip.mkv", "8 x 6", "?camera=FILE");
}

TEST_CASE(every_prefix_gives_whole_frames)
{
    rlf_set_log(NULL, NULL);
    write_rig("clip.json", 4, 3);
    byte_file *b = mkv_sample_make(tiny, false);
    int most = 0;
    for (size_t size = 0; size <= b->size; size++) {
        test_write("clip.mkv", b->data, size);
        rlf_source *source = NULL;
        if (rlf_open_source(test_path("clip.mkv"), NULL, &source) != RLF_OK) {
            assert_null(strchr(rlf_error_text(), '\n'));
            continue;
        }
        rlf_frame frame;
        int count = 0;
        while (rlf_source_next(source, &frame) == RLF_OK) {
            assert_int_equal(frame.depth_u16[5], 1005 + 100 * count);
            count++;
        }
        assert_true(count >= most);
        most = count;
        rlf_source_destroy(&source);
    }
    assert_int_equal(most, MKV_SAMPLE_FRAMES);
    free(b);
}

TEST_CASE(damaged_pictures_are_passed_over)
{
    rlf_set_log(NULL, NULL);
    write_rig("clip.json", 4, 3);
    byte_file *b = mkv_sample_make(tiny, false);
    /* Spoils the second JPEG. */
    size_t count = 0;
    for (size_t i = 0; i + 4 < b->size; i++) {
        if (memcmp(b->data + i, jpeg_sample, 4) == 0 && ++count == 2) {
            memset(b->data + i, 0, 8);
        }
    }
    save(b);
    rlf_source *source = open_clip("");
    expect_frame(source, 0);
    rlf_frame frame; /* depth counts: it goes without colour */
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_null(frame.color.data);
    expect_frame(source, 2);
    assert_int_equal(rlf_source_get_status(source).damaged, 1);
    rlf_source_destroy(&source);
    test_write_text("clip.mkv", "no Matroska");
    test_expect_error(rlf_open_source(test_path("clip.mkv"), NULL, &source), RLF_ERROR_FORMAT,
                      "clip.mkv", "no Matroska file", "right file");
}

#ifdef RLF_HAVE_LIBAV
static AVStream *add_stream(AVFormatContext *format, const char *name, const uint32_t size[2])
{
    AVStream *stream = avformat_new_stream(format, NULL);
    assert_non_null(stream);
    stream->codecpar->codec_type = AVMEDIA_TYPE_VIDEO;
    stream->codecpar->width = (int)size[0];
    stream->codecpar->height = (int)size[1];
    stream->time_base = (AVRational){1, 1000};
    av_dict_set(&stream->metadata, "title", name, 0);
    return stream;
}

static void add_calibration(AVFormatContext *format)
{
    AVStream *stream = avformat_new_stream(format, NULL);
    AVCodecParameters *p = stream->codecpar;
    p->codec_type = AVMEDIA_TYPE_ATTACHMENT;
    p->extradata_size = (int)sizeof(mkv_calibration) - 1;
    p->extradata = av_mallocz((size_t)p->extradata_size + AV_INPUT_BUFFER_PADDING_SIZE);
    memcpy(p->extradata, mkv_calibration, (size_t)p->extradata_size);
    av_dict_set(&stream->metadata, "filename", "calibration.json", 0);
    av_dict_set(&stream->metadata, "mimetype", "application/octet-stream", 0);
}

static void write_packet(AVFormatContext *format, int stream, int64_t ms, const void *data,
                         size_t size)
{
    AVPacket *packet = av_packet_alloc();
    assert_int_equal(av_new_packet(packet, (int)size), 0);
    memcpy(packet->data, data, size);
    packet->stream_index = stream;
    packet->pts = packet->dts = ms;
    packet->flags = AV_PKT_FLAG_KEY;
    assert_int_equal(av_interleaved_write_frame(format, packet), 0);
    av_packet_free(&packet);
}

static void write_frames(AVFormatContext *format)
{
    const size_t pixels = (size_t)nfov_binned[0] * nfov_binned[1];
    uint8_t *depth = calloc(pixels, 2);
    for (int i = 0; i < MKV_SAMPLE_FRAMES; i++) {
        for (size_t p = 0; p < pixels; p++) {
            const size_t value = 1000 + 100 * (size_t)i + p % 64;
            depth[2 * p] = (uint8_t)(value >> 8);
            depth[2 * p + 1] = (uint8_t)value;
        }
        write_packet(format, 1, 5 + 32 * i, depth, 2 * pixels);
        write_packet(format, 0, 7 + 32 * i, jpeg_sample, sizeof(jpeg_sample));
    }
    free(depth);
}

/* The same content as libav's muxer writes it: known sizes, lace bits, cues, tags at the end. */
static void write_with_libav(void)
{
    const uint32_t color_size[2] = {16, 8};
    AVFormatContext *format = NULL;
    avformat_alloc_output_context2(&format, NULL, "matroska", test_path("clip.mkv"));
    assert_non_null(format);
    add_stream(format, "COLOR", color_size)->codecpar->codec_id = AV_CODEC_ID_MJPEG;
    AVCodecParameters *depth = add_stream(format, "DEPTH", nfov_binned)->codecpar;
    depth->codec_id = AV_CODEC_ID_RAWVIDEO;
    depth->format = AV_PIX_FMT_GRAY16BE;
    add_calibration(format);
    AVDictionary *options = NULL;
    av_dict_set(&format->metadata, "K4A_DEPTH_MODE", "NFOV_2X2BINNED", 0);
    av_dict_set_int(&options, "allow_raw_vfw", 1, 0);
    assert_int_equal(avio_open(&format->pb, test_path("clip.mkv"), AVIO_FLAG_WRITE), 0);
    assert_true(avformat_write_header(format, &options) >= 0);
    av_dict_free(&options);
    write_frames(format);
    assert_int_equal(av_write_trailer(format), 0);
    avio_closep(&format->pb);
    avformat_free_context(format);
}

/* That muxer names no format of raw pictures; k4arecorder's four letters are put in. */
static void name_the_format(void)
{
    size_t size;
    char *data = test_read(test_path("clip.mkv"), &size);
    const char private_of_40[3] = {0x63, (char)0xA2, (char)0xA8};
    size_t at = 0;
    while (at + 64 < size && memcmp(data + at, private_of_40, 3) != 0) {
        at++;
    }
    memcpy(data + at + 3 + 16, "b16g", 4);
    test_write("clip.mkv", data, size);
    free(data);
}
#endif

TEST_CASE(recordings_of_another_muxer_are_read)
{
#ifdef RLF_HAVE_LIBAV
    av_log_set_level(AV_LOG_FATAL);
    write_with_libav();
    name_the_format();
    rlf_source *source = open_clip("");
    check_calibration(&rlf_source_get_info(source)->rig);
    assert_non_null(strstr(rlf_source_get_info(source)->device, "NFOV_2X2BINNED"));
    for (int i = 0; i < MKV_SAMPLE_FRAMES; i++) {
        expect_frame(source, i);
    }
    rlf_source_destroy(&source);
#else
    print_message("SKIPPED: built without libav\n");
    skip();
#endif
}

TEST_EACH(test_folder_make, test_folder_remove)
