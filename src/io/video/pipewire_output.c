/* The composited picture as a video source of the desktop, through PipeWire: programs that ask for
 * a camera there see Relief. Relief drives the stream: a picture goes out when it is made. */
#define _POSIX_C_SOURCE 200809L
#include "io/video/video.h"

#include "io/picture/picture.h"

#include <pipewire/pipewire.h>
#include <spa/param/video/format-utils.h>

#include <string.h>

#define START_TIMEOUT_S 3

typedef struct pipewire_output {
    char name[64];
    int32_t width, height;
    struct pw_thread_loop *loop;
    struct pw_stream *stream;
    struct spa_hook listener;
    uint8_t *picture; /* BGRx or BGRA, width x height; under the loop's lock */
    bool has_alpha;   /* the reader asks for BGRA, whose colours are not multiplied by alpha */
    enum pw_stream_state state;
    char error[256];
} pipewire_output;

static rlf_result fail_start(const pipewire_output *o, const char *why)
{
    return rlf_fail(RLF_ERROR_DEVICE,
                    "pipewire:%s: the video source cannot be started: %s: is PipeWire running?",
                    o->name, why);
}

static void on_state(void *self, enum pw_stream_state old, enum pw_stream_state state,
                     const char *error)
{
    (void)old;
    pipewire_output *o = self;
    o->state = state;
    if (state == PW_STREAM_STATE_ERROR) {
        snprintf(o->error, sizeof(o->error), "%s", error != NULL ? error : "unknown error");
    }
    pw_thread_loop_signal(o->loop, false);
}

/* Once the reader has agreed to the format: how large a buffer is. */
static void on_param(void *self, uint32_t id, const struct spa_pod *param)
{
    pipewire_output *o = self;
    struct spa_video_info_raw format;
    if (param == NULL || id != SPA_PARAM_Format) {
        return;
    }
    memset(&format, 0, sizeof(format));
    o->has_alpha =
        spa_format_video_raw_parse(param, &format) >= 0 && format.format == SPA_VIDEO_FORMAT_BGRA;
    uint8_t memory[512];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(memory, sizeof(memory));
    const struct spa_pod *params[1] = {spa_pod_builder_add_object(
        &builder, SPA_TYPE_OBJECT_ParamBuffers, SPA_PARAM_Buffers, SPA_PARAM_BUFFERS_buffers,
        SPA_POD_CHOICE_RANGE_Int(4, 2, 8), SPA_PARAM_BUFFERS_blocks, SPA_POD_Int(1),
        SPA_PARAM_BUFFERS_size, SPA_POD_Int(o->width * o->height * 4), SPA_PARAM_BUFFERS_stride,
        SPA_POD_Int(o->width * 4))};
    pw_stream_update_params(o->stream, params, 1);
}

static void on_process(void *self)
{
    pipewire_output *o = self;
    struct pw_buffer *buffer = pw_stream_dequeue_buffer(o->stream);
    if (buffer == NULL) {
        return;
    }
    struct spa_data *data = &buffer->buffer->datas[0];
    const size_t size = (size_t)o->width * (size_t)o->height * 4;
    const bool fits = data->data != NULL && data->maxsize >= size;
    if (fits) {
        memcpy(data->data, o->picture, size);
    }
    data->chunk->offset = 0;
    data->chunk->stride = o->width * 4;
    data->chunk->size = fits ? (uint32_t)size : 0;
    pw_stream_queue_buffer(o->stream, buffer);
}

static const struct pw_stream_events events = {
    .version = PW_VERSION_STREAM_EVENTS,
    .state_changed = on_state,
    .param_changed = on_param,
    .process = on_process,
};

/* BGRx for who wants a picture, BGRA for a mixer that lays it over its own. */
static const struct spa_pod *offer(const pipewire_output *o, io_rate rate,
                                   struct spa_pod_builder *builder)
{
    const struct spa_rectangle size = {(uint32_t)o->width, (uint32_t)o->height};
    const struct spa_fraction pace = {(uint32_t)rate.numerator, (uint32_t)rate.denominator};
    return spa_pod_builder_add_object(
        builder, SPA_TYPE_OBJECT_Format, SPA_PARAM_EnumFormat, SPA_FORMAT_mediaType,
        SPA_POD_Id(SPA_MEDIA_TYPE_video), SPA_FORMAT_mediaSubtype,
        SPA_POD_Id(SPA_MEDIA_SUBTYPE_raw), SPA_FORMAT_VIDEO_format,
        SPA_POD_CHOICE_ENUM_Id(3, SPA_VIDEO_FORMAT_BGRx, SPA_VIDEO_FORMAT_BGRx,
                               SPA_VIDEO_FORMAT_BGRA),
        SPA_FORMAT_VIDEO_size, SPA_POD_Rectangle(&size), SPA_FORMAT_VIDEO_framerate,
        SPA_POD_Fraction(&pace));
}

static rlf_result connect_stream(pipewire_output *o, io_rate rate)
{
    uint8_t memory[1024];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(memory, sizeof(memory));
    const struct spa_pod *params[1] = {offer(o, rate, &builder)};
    int code = pw_stream_connect(o->stream, PW_DIRECTION_OUTPUT, PW_ID_ANY,
                                 PW_STREAM_FLAG_DRIVER | PW_STREAM_FLAG_MAP_BUFFERS, params, 1);
    if (code < 0) {
        return fail_start(o, strerror(-code));
    }
    while (o->state == PW_STREAM_STATE_UNCONNECTED || o->state == PW_STREAM_STATE_CONNECTING) {
        if (pw_thread_loop_timed_wait(o->loop, START_TIMEOUT_S) != 0) {
            return fail_start(o, "no answer");
        }
    }
    return o->state == PW_STREAM_STATE_ERROR ? fail_start(o, o->error) : RLF_OK;
}

static rlf_result start(pipewire_output *o, io_rate rate)
{
    o->loop = pw_thread_loop_new("relief-video", NULL);
    if (o->loop == NULL || pw_thread_loop_start(o->loop) != 0) {
        return fail_start(o, "its thread cannot be made");
    }
    pw_thread_loop_lock(o->loop);
    struct pw_properties *properties =
        pw_properties_new(PW_KEY_MEDIA_TYPE, "Video", PW_KEY_MEDIA_CATEGORY, "Capture",
                          PW_KEY_MEDIA_ROLE, "Camera", PW_KEY_MEDIA_CLASS, "Video/Source",
                          PW_KEY_NODE_NAME, o->name, PW_KEY_NODE_DESCRIPTION, o->name, NULL);
    o->stream =
        pw_stream_new_simple(pw_thread_loop_get_loop(o->loop), o->name, properties, &events, o);
    rlf_result result =
        o->stream != NULL ? connect_stream(o, rate) : fail_start(o, "no connection");
    pw_thread_loop_unlock(o->loop);
    return result;
}

static rlf_result pipewire_close(void *self, rlf_result result)
{
    pipewire_output *o = self;
    if (o->loop != NULL) {
        pw_thread_loop_stop(o->loop);
    }
    if (o->stream != NULL) {
        pw_stream_destroy(o->stream);
    }
    if (o->loop != NULL) {
        pw_thread_loop_destroy(o->loop);
    }
    rlf_free(o->picture);
    rlf_free(o);
    return result;
}

static rlf_result pipewire_write(void *self, const io_yuv *yuv, const rlf_image_rgba8 *image)
{
    (void)yuv;
    pipewire_output *o = self;
    pw_thread_loop_lock(o->loop);
    for (int32_t y = 0; y < o->height; y++) {
        const uint8_t *from = image->data + y * image->stride;
        uint8_t *to = o->picture + (size_t)y * (size_t)o->width * 4;
        for (int32_t x = 0; x < o->width; x++) {
            to[x * 4] = from[x * 4 + 2];
            to[x * 4 + 1] = from[x * 4 + 1];
            to[x * 4 + 2] = from[x * 4];
            to[x * 4 + 3] = o->has_alpha ? from[x * 4 + 3] : 255;
        }
    }
    if (o->has_alpha) {
        io_rgba_straighten(o->picture, (size_t)o->width * (size_t)o->height);
    }
    const bool has_failed = o->state == PW_STREAM_STATE_ERROR;
    if (o->state == PW_STREAM_STATE_STREAMING && pw_stream_is_driving(o->stream)) {
        pw_stream_trigger_process(o->stream);
    }
    pw_thread_loop_unlock(o->loop);
    return has_failed ? rlf_fail(RLF_ERROR_DEVICE, "pipewire:%s: the video source stopped: %s",
                                 o->name, o->error)
                      : RLF_OK;
}

rlf_result io_pipewire_open(const char *name, const io_video_format *format, io_video_sink *out)
{
    pipewire_output *o = rlf_alloc(sizeof(*o));
    if (o == NULL) {
        return RLF_ERROR_MEMORY;
    }
    snprintf(o->name, sizeof(o->name), "%s", name[0] != '\0' ? name : "Relief");
    o->width = format->width;
    o->height = format->height;
    o->picture = rlf_alloc_array((size_t)o->width * (size_t)o->height, 4);
    if (o->picture == NULL) {
        return pipewire_close(o, RLF_ERROR_MEMORY);
    }
    pw_init(NULL, NULL);
    rlf_result result = start(o, format->rate);
    if (result != RLF_OK) {
        return pipewire_close(o, result);
    }
    *out = (io_video_sink){.write = pipewire_write,
                           .close = pipewire_close,
                           .self = o,
                           .takes_rgba = true,
                           .is_camera = true};
    return RLF_OK;
}
