/* MP4 with H.264 through libavcodec and libavformat (FFmpeg 5.1 or later). */
#include "io/video/video.h"

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>

#include <string.h>

typedef struct io_mp4 {
    io_out_file file; /* names and an empty file, which libav opens itself */
    AVFormatContext *format;
    AVCodecContext *codec;
    AVStream *stream;
    AVFrame *frame;
    AVPacket *packet;
} io_mp4;

static rlf_result fail_av(const io_mp4 *mp4, const char *what, int code)
{
    char text[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(code, text, sizeof(text));
    return rlf_fail(RLF_ERROR_IO, "%s: %s: %s: check the disk, or write a .y4m file",
                    mp4->file.path, what, text);
}

static rlf_result fail_memory(const io_mp4 *mp4)
{
    return rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory for the video", mp4->file.path);
}

/* H.264 by x264, else whatever encodes H.264 in software, else MPEG-4 part 2, which every libav
 * has. Hardware encoders are not asked: they take other pixel formats. */
static const AVCodec *find_codec(void)
{
    static const char *const names[] = {"libx264", "libopenh264", "mpeg4"};
    const AVCodec *codec = NULL;
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]) && codec == NULL; i++) {
        codec = avcodec_find_encoder_by_name(names[i]);
    }
    return codec;
}

/* Options that an encoder does not know are refused and change nothing, which is what is wanted. */
static void set_quality(AVCodecContext *codec)
{
    if (strcmp(codec->codec->name, "libx264") == 0) {
        av_opt_set(codec->priv_data, "preset", "veryfast", 0);
        av_opt_set(codec->priv_data, "crf", "20", 0);
        av_opt_set(codec->priv_data, "x264-params", "log=-1", 0);
        return;
    }
    /* Others aim at a bit rate: a quarter bit per pixel is ample for camera pictures. */
    codec->bit_rate =
        (int64_t)codec->width * codec->height * codec->framerate.num / codec->framerate.den / 4;
}

static rlf_result open_codec(io_mp4 *mp4, const io_video_format *format)
{
    const AVCodec *encoder = find_codec();
    if (encoder == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: the installed libavcodec has no H.264 or MPEG-4 encoder: write a "
                        ".y4m file",
                        mp4->file.path);
    }
    mp4->codec = avcodec_alloc_context3(encoder);
    if (mp4->codec == NULL) {
        return fail_memory(mp4);
    }
    AVCodecContext *codec = mp4->codec;
    codec->width = format->width;
    codec->height = format->height;
    codec->pix_fmt = AV_PIX_FMT_YUV420P;
    codec->framerate = (AVRational){format->rate.numerator, format->rate.denominator};
    codec->time_base = (AVRational){format->rate.denominator, format->rate.numerator};
    codec->color_range = AVCOL_RANGE_MPEG;
    codec->colorspace = AVCOL_SPC_SMPTE170M;
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_IEC61966_2_1;
    codec->chroma_sample_location = AVCHROMA_LOC_CENTER;
    if ((mp4->format->oformat->flags & AVFMT_GLOBALHEADER) != 0) {
        codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    }
    set_quality(codec);
    int code = avcodec_open2(codec, encoder, NULL);
    return code < 0 ? fail_av(mp4, "the video encoder cannot start", code) : RLF_OK;
}

static rlf_result open_stream(io_mp4 *mp4)
{
    mp4->stream = avformat_new_stream(mp4->format, NULL);
    mp4->frame = av_frame_alloc();
    mp4->packet = av_packet_alloc();
    if (mp4->stream == NULL || mp4->frame == NULL || mp4->packet == NULL) {
        return fail_memory(mp4);
    }
    mp4->stream->time_base = mp4->codec->time_base;
    mp4->stream->avg_frame_rate = mp4->codec->framerate;
    int code = avcodec_parameters_from_context(mp4->stream->codecpar, mp4->codec);
    mp4->frame->format = mp4->codec->pix_fmt;
    mp4->frame->width = mp4->codec->width;
    mp4->frame->height = mp4->codec->height;
    mp4->frame->pts = 0;
    if (code >= 0) {
        code = av_frame_get_buffer(mp4->frame, 0);
    }
    return code < 0 ? fail_av(mp4, "the video cannot be set up", code) : RLF_OK;
}

static rlf_result open_file(io_mp4 *mp4)
{
    int code = avio_open(&mp4->format->pb, mp4->format->url, AVIO_FLAG_WRITE);
    if (code < 0) {
        return fail_av(mp4, "cannot be created", code);
    }
    AVDictionary *options = NULL;
    av_dict_set(&options, "movflags", "+faststart", 0);
    code = avformat_write_header(mp4->format, &options);
    av_dict_free(&options);
    return code < 0 ? fail_av(mp4, "cannot be written", code) : RLF_OK;
}

static rlf_result open_all(io_mp4 *mp4, const char *path, const io_video_format *format)
{
    rlf_result result = io_out_finish(&mp4->file, io_out_open(&mp4->file, path));
    if (result != RLF_OK) {
        return result;
    }
    if (mp4->file.is_direct) {
        return rlf_fail(RLF_ERROR_IO, "%s: MP4 needs a regular file: write .y4m into a pipe", path);
    }
    /* "file:" keeps libav from taking a colon in the name for a protocol. */
    char url[IO_PATH_MAX + 5];
    snprintf(url, sizeof(url), "file:%s", mp4->file.part);
    int code = avformat_alloc_output_context2(&mp4->format, NULL, "mp4", url);
    if (code < 0) {
        return fail_av(mp4, "the installed libavformat cannot write MP4", code);
    }
    result = open_codec(mp4, format);
    result = result == RLF_OK ? open_stream(mp4) : result;
    return result == RLF_OK ? open_file(mp4) : result;
}

/* Sends a picture (NULL: the end) and writes what the encoder has ready. */
static rlf_result encode(io_mp4 *mp4, const AVFrame *frame)
{
    int code = avcodec_send_frame(mp4->codec, frame);
    while (code >= 0) {
        code = avcodec_receive_packet(mp4->codec, mp4->packet);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) {
            return RLF_OK;
        }
        if (code >= 0) {
            mp4->packet->stream_index = mp4->stream->index;
            mp4->packet->duration = 1; /* in frames, the encoder's time base */
            av_packet_rescale_ts(mp4->packet, mp4->codec->time_base, mp4->stream->time_base);
            code = av_interleaved_write_frame(mp4->format, mp4->packet);
        }
        /* The muxer does not report every failed write of its buffer. */
        if (code >= 0 && mp4->format->pb->error < 0) {
            code = mp4->format->pb->error;
        }
    }
    return fail_av(mp4, "cannot be written", code);
}

static void copy_plane(const uint8_t *from, int32_t width, int32_t height, uint8_t *to,
                       ptrdiff_t stride)
{
    for (int32_t y = 0; y < height; y++) {
        memcpy(to + y * stride, from + (ptrdiff_t)y * width, (size_t)width);
    }
}

static rlf_result mp4_write(void *self, const io_yuv *picture, const rlf_image_rgba8 *image)
{
    (void)image;
    io_mp4 *mp4 = self;
    AVFrame *frame = mp4->frame;
    /* The encoder may still hold the last picture's buffer. */
    int code = av_frame_make_writable(frame);
    if (code < 0) {
        return fail_av(mp4, "cannot be encoded", code);
    }
    int32_t w = picture->width;
    int32_t h = picture->height;
    copy_plane(picture->y, w, h, frame->data[0], frame->linesize[0]);
    copy_plane(picture->u, w / 2, h / 2, frame->data[1], frame->linesize[1]);
    copy_plane(picture->v, w / 2, h / 2, frame->data[2], frame->linesize[2]);
    rlf_result result = encode(mp4, frame);
    frame->pts++;
    return result;
}

/* Empties the encoder and completes the file. */
static rlf_result finish_file(io_mp4 *mp4)
{
    rlf_result result = encode(mp4, NULL);
    if (result != RLF_OK) {
        return result;
    }
    int code = av_write_trailer(mp4->format);
    return code < 0 ? fail_av(mp4, "cannot be finished", code) : RLF_OK;
}

static rlf_result close_file(io_mp4 *mp4, rlf_result result)
{
    result = result == RLF_OK ? finish_file(mp4) : result;
    if (mp4->format != NULL && mp4->format->pb != NULL) {
        int code = avio_closep(&mp4->format->pb);
        if (code < 0 && result == RLF_OK) {
            result = fail_av(mp4, "cannot be finished", code);
        }
    }
    return io_out_settle(&mp4->file, result);
}

static rlf_result mp4_close(void *self, rlf_result result)
{
    io_mp4 *mp4 = self;
    result = close_file(mp4, result);
    av_packet_free(&mp4->packet);
    av_frame_free(&mp4->frame);
    avcodec_free_context(&mp4->codec);
    avformat_free_context(mp4->format);
    rlf_free(mp4);
    return result;
}

rlf_result io_mp4_open(const char *path, const io_video_format *format, io_video_sink *out)
{
    io_mp4 *mp4 = rlf_alloc(sizeof(*mp4));
    if (mp4 == NULL) {
        return RLF_ERROR_MEMORY;
    }
    /* Encoders and muxers chat at the default level; a level that the program chose stays. */
    if (av_log_get_level() == AV_LOG_INFO) {
        av_log_set_level(AV_LOG_FATAL);
    }
    rlf_result result = open_all(mp4, path, format);
    if (result != RLF_OK) {
        return mp4_close(mp4, result);
    }
    *out = (io_video_sink){.write = mp4_write, .close = mp4_close, .self = mp4};
    return RLF_OK;
}
