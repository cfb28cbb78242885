/* Reads a video source of PipeWire as a desktop program does: pipewire_reader FRAMES FILE [alpha].
 * Waits at most ten seconds for so many pictures and writes the last one, BGRx or BGRA, to FILE.
 * Its node is called reader. */
#include <pipewire/pipewire.h>
#include <spa/param/video/format-utils.h>

#include <stdio.h>
#include <stdlib.h>

#define TIMEOUT_S 10

typedef struct reader {
    struct pw_main_loop *loop;
    struct pw_stream *stream;
    int wanted, count;
    const char *path;
    int status;
} reader;

static void save(reader *r, const struct spa_data *data)
{
    FILE *file = fopen(r->path, "wb");
    if (file != NULL) {
        const size_t size = data->chunk->size;
        r->status = fwrite(data->data, 1, size, file) == size && size > 0 ? 0 : 1;
        fclose(file);
    }
    pw_main_loop_quit(r->loop);
}

static void on_process(void *self)
{
    reader *r = self;
    struct pw_buffer *buffer = pw_stream_dequeue_buffer(r->stream);
    if (buffer == NULL) {
        return;
    }
    if (++r->count == r->wanted) {
        save(r, &buffer->buffer->datas[0]);
    }
    pw_stream_queue_buffer(r->stream, buffer);
}

static void on_timeout(void *self, uint64_t expirations)
{
    (void)expirations;
    reader *r = self;
    fprintf(stderr, "pipewire_reader: %d of %d pictures in %d s\n", r->count, r->wanted, TIMEOUT_S);
    pw_main_loop_quit(r->loop);
}

static const struct pw_stream_events events = {.version = PW_VERSION_STREAM_EVENTS,
                                               .process = on_process};

int main(int argc, char **argv)
{
    if (argc != 3 && argc != 4) {
        return 2;
    }
    reader r = {.wanted = atoi(argv[1]), .path = argv[2], .status = 1};
    pw_init(&argc, &argv);
    r.loop = pw_main_loop_new(NULL);
    struct pw_loop *loop = pw_main_loop_get_loop(r.loop);
    struct timespec timeout = {.tv_sec = TIMEOUT_S};
    struct spa_source *timer = pw_loop_add_timer(loop, on_timeout, &r);
    pw_loop_update_timer(loop, timer, &timeout, NULL, false);
    r.stream =
        pw_stream_new_simple(loop, "reader",
                             pw_properties_new(PW_KEY_MEDIA_TYPE, "Video", PW_KEY_MEDIA_CATEGORY,
                                               "Capture", PW_KEY_NODE_NAME, "reader", NULL),
                             &events, &r);
    uint8_t memory[1024];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(memory, sizeof(memory));
    const struct spa_pod *params[1] = {spa_pod_builder_add_object(
        &builder, SPA_TYPE_OBJECT_Format, SPA_PARAM_EnumFormat, SPA_FORMAT_mediaType,
        SPA_POD_Id(SPA_MEDIA_TYPE_video), SPA_FORMAT_mediaSubtype,
        SPA_POD_Id(SPA_MEDIA_SUBTYPE_raw), SPA_FORMAT_VIDEO_format,
        SPA_POD_Id(argc == 4 ? SPA_VIDEO_FORMAT_BGRA : SPA_VIDEO_FORMAT_BGRx))};
    if (pw_stream_connect(r.stream, PW_DIRECTION_INPUT, PW_ID_ANY, PW_STREAM_FLAG_MAP_BUFFERS,
                          params, 1) == 0) {
        pw_main_loop_run(r.loop);
    }
    pw_stream_destroy(r.stream);
    pw_main_loop_destroy(r.loop);
    return r.status;
}
