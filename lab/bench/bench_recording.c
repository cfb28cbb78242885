/* Depth codecs on real pictures, recording beside the live loop, and playback:
 * bench_recording [SOURCE [SECONDS]]. Codecs are measured on the first frames of SOURCE, default
 * synthetic:room; recording and playback on 512 x 424 depth and 1920 x 1080 colour. */
#define _POSIX_C_SOURCE 200809L
#include "io/picture/picture.h"
#include "io/picture/pixels.h"
#include "recorder.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <zstd.h>

#define REPEATS 15
#define CODEC_FRAMES 10
#define CLIP_FRAMES 12 /* played to and fro */
#define FRAME_NS 33333333

static double now_ms(void)
{
    return 1e-6 * (double)rlf_clock_ns();
}

static double cpu_s(clockid_t clock)
{
    struct timespec t = {0};
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- codecs -----------------------------------------------------------------------------------
 */

typedef struct codec_times {
    double encode_ms, decode_ms, bytes; /* sums over the frames, of the fastest repeat each */
} codec_times;

static io_rvl rvl;

static size_t encode(int codec, const uint16_t *depth, int32_t width, int32_t height,
                     io_byte_buffer *out)
{
    const size_t pixels = (size_t)width * (size_t)height;
    out->size = 0;
    if (codec == 0) {
        io_byte_buffer_grow(out, io_rvl_encode(&rvl, depth, pixels,
                                               io_byte_buffer_reserve(out, io_rvl_bound(pixels))));
    } else if (codec == 1) {
        const io_png_def def = {"", depth, width, height, (ptrdiff_t)width * 2, IO_PNG_GREY_U16, 1};
        (void)io_png_encode(&def, out);
    } else {
        const size_t bound = ZSTD_compressBound(pixels * 2);
        io_byte_buffer_grow(
            out, ZSTD_compress(io_byte_buffer_reserve(out, bound), bound, depth, pixels * 2, 1));
    }
    return out->size;
}

static bool decode(int codec, const io_byte_buffer *in, int32_t width, int32_t height,
                   uint16_t *out)
{
    const size_t pixels = (size_t)width * (size_t)height;
    if (codec == 0) {
        return io_rvl_decode(&rvl, in->data, in->size, out, pixels);
    }
    if (codec == 1) {
        const io_bytes file = {"", in->data, in->size};
        io_picture picture = {.width = width, .height = height, .data = out};
        return io_png_decode_u16(&file, &picture) == RLF_OK;
    }
    return ZSTD_decompress(out, pixels * 2, in->data, in->size) == pixels * 2;
}

static bool time_codec(int codec, const uint16_t *depth, int32_t width, int32_t height,
                       codec_times *times)
{
    const size_t pixels = (size_t)width * (size_t)height;
    io_byte_buffer buffer = {0};
    uint16_t *out = malloc(pixels * 2);
    double best[2] = {1e9, 1e9};
    bool is_same = out != NULL;
    for (int r = 0; r < REPEATS && is_same; r++) {
        const double start = now_ms();
        encode(codec, depth, width, height, &buffer);
        const double middle = now_ms();
        is_same = decode(codec, &buffer, width, height, out);
        const double end = now_ms();
        is_same = is_same && memcmp(out, depth, pixels * 2) == 0;
        best[0] = middle - start < best[0] ? middle - start : best[0];
        best[1] = end - middle < best[1] ? end - middle : best[1];
    }
    times->encode_ms += best[0];
    times->decode_ms += best[1];
    times->bytes += (double)buffer.size;
    io_byte_buffer_free(&buffer);
    free(out);
    return is_same;
}

static bool bench_codecs(const char *name)
{
    static const char *const names[3] = {"rvl", "png level 1", "zstd level 1"};
    codec_times times[3] = {{0}};
    rlf_source *source = NULL;
    if (rlf_open_source(name, NULL, &source) != RLF_OK) {
        return false;
    }
    const rlf_camera *c = &rlf_source_get_info(source)->rig.depth;
    int frames = 0;
    bool is_good = true;
    rlf_frame frame;
    while (frames < CODEC_FRAMES && is_good && rlf_source_next(source, &frame) == RLF_OK &&
           frame.depth_u16 != NULL) {
        for (int i = 0; i < 3 && is_good; i++) {
            is_good = time_codec(i, frame.depth_u16, c->width, c->height, &times[i]);
        }
        frames++;
    }
    printf("%s: %d frames of %d x %d, lossless, one thread, fastest of %d\n", name, frames,
           (int)c->width, (int)c->height, REPEATS);
    printf("  %-14s %9s %9s %9s\n", "codec", "encode ms", "decode ms", "ratio");
    for (int i = 0; i < 3 && frames > 0; i++) {
        printf("  %-14s %9.2f %9.2f %7.2f:1\n", names[i], times[i].encode_ms / frames,
               times[i].decode_ms / frames, 2.0 * c->width * c->height * frames / times[i].bytes);
    }
    rlf_source_destroy(&source);
    return is_good && frames > 0;
}

/* ---- a camera ---------------------------------------------------------------------------------
 */

/* A second of the synthetic room in memory, given again and again at 30 frames per second. */
typedef struct camera {
    rlf_source_info info;
    uint16_t *depth[CLIP_FRAMES];
    uint8_t *color[CLIP_FRAMES];
    int64_t next, count, start_ns;
} camera;

static rlf_result camera_next(void *self, rlf_frame *out)
{
    camera *c = self;
    const rlf_rig *r = &c->info.rig;
    if (c->next >= c->count) {
        return RLF_END;
    }
    const int64_t wait_ns = c->start_ns + c->next * FRAME_NS - rlf_clock_ns();
    if (wait_ns > 0) {
        nanosleep(&(struct timespec){wait_ns / 1000000000, (long)(wait_ns % 1000000000)}, NULL);
    }
    const int64_t turn = c->next % (2 * CLIP_FRAMES - 2);
    const int64_t at = turn < CLIP_FRAMES ? turn : 2 * CLIP_FRAMES - 2 - turn;
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)c->next;
    out->time_ns = INT64_C(1000000000) + c->next++ * FRAME_NS;
    out->depth_u16 = c->depth[at];
    out->depth_stride = (ptrdiff_t)r->depth.width * 2;
    out->depth_units_per_metre = 1000;
    out->color = (rlf_image_rgba8){c->color[at], r->color.width, r->color.height,
                                   (ptrdiff_t)r->color.width * 4};
    return RLF_OK;
}

/* Twice as wide and high, with the noise of a sensor, which is what costs when it is encoded. */
static void enlarge(const rlf_image_rgba8 *from, const rlf_camera *to, uint8_t *out)
{
    uint32_t random = 1;
    for (int32_t y = 0; y < to->height; y++) {
        const uint8_t *row = from->data + (ptrdiff_t)(y / 2) * from->stride;
        for (int32_t x = 0; x < to->width; x++, out += 4) {
            random = random * 1664525u + 1013904223u;
            const int32_t noise = (int32_t)(random >> 30) + (int32_t)(random >> 28 & 3) - 3;
            for (int i = 0; i < 4; i++) {
                const int32_t value = row[(ptrdiff_t)(x / 2) * 4 + i] + noise;
                out[i] = (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
            }
        }
    }
}

static bool camera_fill(camera *c)
{
    rlf_source *source = NULL;
    if (rlf_open_source("synthetic:room?frames=-1", NULL, &source) != RLF_OK) {
        return false;
    }
    c->info = *rlf_source_get_info(source);
    c->info.rig.color = rlf_camera_resize(&c->info.rig.color, c->info.rig.color.width * 2,
                                          c->info.rig.color.height * 2);
    c->info.is_live = true;
    c->info.frames_per_second = 30;
    c->info.frame_count = -1;
    const rlf_rig *r = &c->info.rig;
    const size_t depth = (size_t)r->depth.width * (size_t)r->depth.height * 2;
    const size_t color = (size_t)r->color.width * (size_t)r->color.height * 4;
    bool is_good = true;
    for (int i = 0; i < CLIP_FRAMES && is_good; i++) {
        rlf_frame f;
        c->depth[i] = malloc(depth);
        c->color[i] = malloc(color);
        is_good =
            c->depth[i] != NULL && c->color[i] != NULL && rlf_source_next(source, &f) == RLF_OK;
        if (is_good) {
            memcpy(c->depth[i], f.depth_u16, depth);
            enlarge(&f.color, &r->color, c->color[i]);
        }
    }
    rlf_source_destroy(&source);
    return is_good;
}

/* ---- recording --------------------------------------------------------------------------------
 */

static rlf_source *make_source(camera *c, int64_t frames)
{
    static const rlf_source_methods methods = {.next = camera_next};
    rlf_source *source = NULL;
    c->next = 0;
    c->count = frames;
    c->start_ns = rlf_clock_ns();
    return rlf_source_create_custom(&methods, &c->info, c, &source) == RLF_OK ? source : NULL;
}

static double capture_cpu_s;

/* The camera's thread: hands every frame to the recorder. */
static void *capture(void *context)
{
    rlf_frame frame;
    while (rlf_source_next(context, &frame) == RLF_OK) {
    }
    capture_cpu_s = cpu_s(CLOCK_THREAD_CPUTIME_ID);
    return NULL;
}

/* The loop of `relief run` on the same frames, at most 30 per second, for as long. */
static int64_t run_loop(const camera *c, int64_t frames)
{
    camera own = *c;
    rlf_source *source = make_source(&own, frames);
    rlf_pool *pool = NULL;
    rlf_pipeline *pipeline = NULL;
    rlf_pool_create(2, &pool);
    const rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, pool);
    int64_t done = 0;
    if (rlf_pipeline_create(&def, &pipeline) == RLF_OK) {
        rlf_pipeline_output output;
        const int64_t end_ns = rlf_clock_ns() + frames * FRAME_NS;
        while (rlf_clock_ns() < end_ns && rlf_pipeline_step(pipeline, &output) == RLF_OK) {
            done++;
        }
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
    return done;
}

static double jpeg_cpu_ms(const camera *c, int32_t quality)
{
    io_jpeg_encoder *jpeg = NULL;
    io_byte_buffer buffer = {0};
    const rlf_camera *color = &c->info.rig.color;
    if (io_jpeg_encoder_create(&jpeg) != RLF_OK) {
        return 0.0;
    }
    const double start = cpu_s(CLOCK_THREAD_CPUTIME_ID);
    for (int i = 0; i < 3 * CLIP_FRAMES; i++) {
        const rlf_image_rgba8 image = {c->color[i % CLIP_FRAMES], color->width, color->height,
                                       (ptrdiff_t)color->width * 4};
        buffer.size = 0;
        (void)io_jpeg_encode(jpeg, &image, quality, &buffer);
    }
    const double ms = 1e3 * (cpu_s(CLOCK_THREAD_CPUTIME_ID) - start) / (3 * CLIP_FRAMES);
    io_byte_buffer_free(&buffer);
    io_jpeg_encoder_destroy(&jpeg);
    return ms;
}

static bool bench_record(camera *c, const char *path, int64_t frames)
{
    recorder_options options = recorder_options_default();
    options.path = path;
    const double jpeg_ms = jpeg_cpu_ms(c, options.def.jpeg_quality);
    recorder *r = NULL;
    rlf_source *source = make_source(c, frames);
    if (source == NULL || recorder_create(&options, &c->info, &r) != RLF_OK ||
        recorder_tap(r, &source) != RLF_OK) {
        return false;
    }
    pthread_t thread;
    pthread_create(&thread, NULL, capture, source);
    const int64_t looped = run_loop(c, frames);
    pthread_join(thread, NULL);
    recorder_status status;
    const bool is_good = recorder_destroy(&r, &status) == RLF_OK;
    rlf_source_destroy(&source);
    const double seconds = 1e-9 * (double)(frames * FRAME_NS);
    const double all = 100.0 * (status.cpu_s + capture_cpu_s) / seconds;
    const double jpeg = 100.0 * 1e-3 * jpeg_ms * (double)status.written.frames / seconds;
    printf("recording %d x %d depth and %d x %d colour for %.0f s beside a loop of %.1f frames "
           "per second\n",
           (int)c->info.rig.depth.width, (int)c->info.rig.depth.height,
           (int)c->info.rig.color.width, (int)c->info.rig.color.height, seconds,
           (double)looped / seconds);
    printf("  frames  %llu recorded of %lld, %llu lost\n",
           (unsigned long long)status.written.frames, (long long)frames,
           (unsigned long long)status.dropped);
    printf("  CPU     %.1f %% of a core, %.1f %% of it JPEG (%.1f ms a picture): %.1f %% above\n",
           all, jpeg, jpeg_ms, all - jpeg);
    printf("  file    %.1f MB/s\n", 1e-6 * (double)status.written.bytes / seconds);
    return is_good;
}

/* ---- playback ---------------------------------------------------------------------------------
 */

static bool bench_playback(const char *path)
{
    rlf_source *source = NULL;
    const double start = now_ms();
    const double start_cpu = cpu_s(CLOCK_THREAD_CPUTIME_ID);
    if (rlf_open_source(path, NULL, &source) != RLF_OK) {
        return false;
    }
    int64_t frames = 0;
    rlf_frame frame;
    while (rlf_source_next(source, &frame) == RLF_OK) {
        frames++;
    }
    const double seconds = 1e-3 * (now_ms() - start);
    const double cpu = cpu_s(CLOCK_THREAD_CPUTIME_ID) - start_cpu;
    const double real = 1e-9 * (double)(frames * FRAME_NS);
    printf("playback, decoded, one thread: %lld frames, %.1f times real time (%.1f by CPU time)\n",
           (long long)frames, real / seconds, real / cpu);
    rlf_source_destroy(&source);
    return frames > 0;
}

int main(int argc, char **argv)
{
    static camera c;
    static const char path[] = "bench-recording.mcap";
    const int64_t seconds = argc > 2 ? strtol(argv[2], NULL, 10) : 10;
    io_rvl_init(&rvl);
    bool is_good = bench_codecs(argc > 1 ? argv[1] : "synthetic:room") && camera_fill(&c) &&
                   bench_record(&c, path, 30 * seconds) && bench_playback(path);
    if (!is_good) {
        fprintf(stderr, "bench_recording: %s\n", rlf_error_text());
    }
    if (getenv("KEEP") == NULL) {
        remove(path);
    }
    for (int i = 0; i < CLIP_FRAMES; i++) {
        free(c.depth[i]);
        free(c.color[i]);
    }
    return is_good ? 0 : 1;
}
