/* Recording beside a running loop. */
#define _POSIX_C_SOURCE 200809L
#include "recorder.h"

#include "command.h"
#include "record_queue.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#define TELL_NS INT64_C(300000000) /* after which it is told that there is more to be written */
#define END_NS INT64_C(1200000000) /* after which that is left out */

struct recorder {
    recorder_options options;
    rlf_source_info info;
    char path[4096];
    int64_t start_ns; /* of the running one */
    bool is_running;  /* set under `fills`; the rest is there while it is */
    bool is_ending;   /* no more comes; the thread still writes, until has_ended */
    _Atomic bool has_ended;
    rlf_recording *recording;
    record_queue queue;
    pthread_t thread;
    rlf_source *observed;  /* NULL = frames come by the tap */
    pthread_mutex_t fills; /* held while an item is filled */
    int64_t last_ns;       /* of the frames in the queue, for sources that start again */
    bool has_last;
    _Atomic uint64_t dropped;
    _Atomic bool leaves_rest; /* what waits is not written any more */
    uint64_t left;            /* frames that were not; the thread's own */
    /* What the thread says; under the queue's lock. */
    rlf_recording_status written;
    bool has_failed;
    char problem[1024];
    rlf_result result;
    double cpu_s;
};

recorder_options recorder_options_default(void)
{
    return (recorder_options){.def = rlf_recording_def_default()};
}

bool recorder_take_path(const char *text, void *out)
{
    struct stat status;
    const size_t length = strlen(text);
    const bool is_there = stat(text, &status) == 0 && S_ISDIR(status.st_mode);
    const bool is_folder = length > 0 && text[length - 1] == '/';
    ((recorder_options *)out)->path = text;
    return is_there || is_folder || output_name_has(text, ".mcap") ||
           strncmp(text, "ros2:/", 6) == 0;
}

bool recorder_take_codec(const char *text, void *out)
{
    recorder_options *o = out;
    o->def.depth_codec = strcmp(text, "png") == 0 ? RLF_DEPTH_PNG : RLF_DEPTH_RVL;
    return strcmp(text, "png") == 0 || strcmp(text, "rvl") == 0;
}

bool recorder_take_color(const char *text, void *out)
{
    ((recorder_options *)out)->def.jpeg_quality = 0;
    return strcmp(text, "color") == 0;
}

bool recorder_take_compression(const char *text, void *out)
{
    static const char *const names[3] = {"zstd", "lz4", "none"};
    for (int i = 0; i < 3; i++) {
        if (strcmp(text, names[i]) == 0) {
            ((recorder_options *)out)->def.compression = (rlf_compression)i;
            return true;
        }
    }
    return false;
}

/* ---- the thread -------------------------------------------------------------------------------
 */

static void note(recorder *r, rlf_result result)
{
    const rlf_recording_status written = rlf_recording_get_status(r->recording);
    pthread_mutex_lock(&r->queue.lock);
    r->written = written;
    const bool is_first = result != RLF_OK && !r->has_failed;
    if (is_first) {
        r->has_failed = true;
        r->result = result;
        snprintf(r->problem, sizeof(r->problem), "%s", rlf_error_text());
    }
    pthread_mutex_unlock(&r->queue.lock);
    if (is_first && r->options.is_beside_loop) {
        rlf_log(RLF_LOG_ERROR, "%s; the run goes on, unrecorded", r->problem);
    }
}

static void *write_all(void *context)
{
    recorder *r = context;
    bool is_good = true;
    record_item *item;
    while ((item = record_queue_front(&r->queue)) != NULL) {
        if (r->leaves_rest) {
            r->left += item->is_bodies ? 0 : 1;
        } else if (is_good) {
            const rlf_result result =
                item->is_bodies
                    ? rlf_recording_add_bodies(r->recording, item->frame.time_ns, &item->snapshot)
                    : rlf_recording_add(r->recording, &item->frame);
            note(r, result);
            is_good = result == RLF_OK;
        }
        record_queue_pop(&r->queue);
    }
    struct timespec cpu = {0};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &cpu);
    r->cpu_s = (double)cpu.tv_sec + 1e-9 * (double)cpu.tv_nsec;
    r->has_ended = true;
    return NULL;
}

/* The file and its thread; frames come from now on. */
static rlf_result start(recorder *r, const char *path)
{
    snprintf(r->path, sizeof(r->path), "%s", path);
    rlf_result result = rlf_recording_open(r->path, &r->info, &r->options.def, &r->recording);
    if (result != RLF_OK) {
        return result;
    }
    r->has_failed = r->has_last = r->has_ended = false;
    r->written = (rlf_recording_status){0};
    r->dropped = r->left = 0;
    r->leaves_rest = false;
    r->start_ns = rlf_clock_ns();
    record_queue_init(&r->queue, &r->info.rig);
    if (pthread_create(&r->thread, NULL, write_all, r) != 0) {
        rlf_recording_close(&r->recording, NULL);
        record_queue_free(&r->queue);
        return rlf_fail(RLF_ERROR_MEMORY, "no thread can be started to record: close something");
    }
    pthread_mutex_lock(&r->fills);
    r->is_running = true;
    pthread_mutex_unlock(&r->fills);
    return RLF_OK;
}

rlf_result recorder_create(const recorder_options *options, const rlf_source_info *info,
                           recorder **out)
{
    *out = NULL;
    recorder *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->options = *options;
    r->info = *info;
    pthread_mutex_init(&r->fills, NULL);
    const rlf_result result = options->path != NULL ? start(r, options->path) : RLF_OK;
    if (result != RLF_OK) {
        pthread_mutex_destroy(&r->fills);
        rlf_free(r);
        return result;
    }
    *out = r;
    return RLF_OK;
}

bool recorder_has_failed(recorder *r)
{
    pthread_mutex_lock(&r->queue.lock);
    const bool has_failed = r->has_failed;
    pthread_mutex_unlock(&r->queue.lock);
    return has_failed;
}

recorder_status recorder_get_status(recorder *r)
{
    pthread_mutex_lock(&r->queue.lock);
    const recorder_status status = {.written = r->written, .dropped = r->dropped};
    pthread_mutex_unlock(&r->queue.lock);
    return status;
}

/* After Ctrl-C a slow disk or processor does not keep the user for long. */
static void end_soon(recorder *r)
{
    const int64_t now_ns = rlf_clock_ns();
    const int32_t waiting = record_queue_drain(&r->queue, now_ns + TELL_NS);
    if (waiting > 0) {
        rlf_log(RLF_LOG_WARNING, "%s: stopped; %d frames are still to be written", r->path,
                (int)waiting);
        r->leaves_rest = record_queue_drain(&r->queue, now_ns + END_NS) > 0;
    }
}

static void tell_left(const recorder *r)
{
    if (r->left > 0) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the last %llu frames were left out: the disk or the processor was too slow "
                "for them",
                r->path, (unsigned long long)r->left);
    }
}

/* Nothing more comes in; what waits is still to be written. */
static void begin_end(recorder *r)
{
    pthread_mutex_lock(&r->fills);
    r->is_running = false;
    pthread_mutex_unlock(&r->fills);
    record_queue_close(&r->queue);
    r->is_ending = true;
}

/* Waits until all is written. */
static rlf_result finish_end(recorder *r, recorder_status *out)
{
    if (command_interrupted) {
        end_soon(r);
    }
    pthread_join(r->thread, NULL);
    r->is_ending = false;
    tell_left(r);
    rlf_recording_status written;
    rlf_result result = rlf_recording_close(&r->recording, &written);
    if (r->has_failed) {
        result = rlf_fail(r->result, "%s", r->problem);
    }
    *out = (recorder_status){written, r->dropped, r->cpu_s,
                             r->has_failed && r->options.is_beside_loop};
    record_queue_free(&r->queue);
    return result;
}

static rlf_result stop(recorder *r, recorder_status *out)
{
    if (!r->is_ending) {
        begin_end(r);
    }
    return finish_end(r, out);
}

rlf_result recorder_destroy(recorder **recorder_pointer, recorder_status *out)
{
    recorder *r = *recorder_pointer;
    recorder_status status = {0};
    *recorder_pointer = NULL;
    if (r == NULL) {
        return RLF_OK;
    }
    if (r->observed != NULL) {
        rlf_source_observe(r->observed, NULL, NULL);
    }
    const rlf_result result = r->is_running || r->is_ending ? stop(r, &status) : RLF_OK;
    if (out != NULL) {
        *out = status;
    }
    pthread_mutex_destroy(&r->fills);
    rlf_free(r);
    return result;
}

/* A name that no other recording has: the date and the time. */
static void name_file(char *out, size_t size)
{
    struct tm parts;
    const time_t now = time(NULL);
    if (localtime_r(&now, &parts) == NULL ||
        strftime(out, size, "relief-%Y%m%d-%H%M%S.mcap", &parts) == 0) {
        snprintf(out, size, "relief.mcap");
    }
}

rlf_result recorder_switch(recorder *r, bool is_on)
{
    char path[64];
    if (r == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "record: this run has no recorder");
    }
    if (is_on == r->is_running) {
        return RLF_OK;
    }
    if (!is_on) {
        begin_end(r);
        return RLF_OK;
    }
    if (r->is_ending) {
        return rlf_fail(RLF_ERROR_DEVICE, "record: the last recording is still being written");
    }
    name_file(path, sizeof(path));
    return start(r, path);
}

void recorder_settle(recorder *r)
{
    recorder_status status;
    if (r != NULL && r->is_ending && r->has_ended) {
        (void)finish_end(r, &status);
        rlf_log(RLF_LOG_INFO, "recorded %s: %llu frames, %llu dropped", r->path,
                (unsigned long long)status.written.frames, (unsigned long long)status.dropped);
    }
}

rlf_result recorder_toggle(recorder *r, char *out_message, size_t message_size)
{
    if (!r->is_running && !r->is_ending) {
        char path[64];
        name_file(path, sizeof(path));
        const rlf_result result = start(r, path);
        snprintf(out_message, message_size, "recording %s", path);
        return result;
    }
    recorder_status status;
    const rlf_result result = stop(r, &status);
    snprintf(out_message, message_size, "recorded %.200s: %llu frames, %llu dropped", r->path,
             (unsigned long long)status.written.frames, (unsigned long long)status.dropped);
    return result;
}

bool recorder_describe(recorder *r, char *out, size_t size)
{
    if (r == NULL || !r->is_running) {
        return false;
    }
    const recorder_status s = recorder_get_status(r);
    const int64_t seconds = (rlf_clock_ns() - r->start_ns) / INT64_C(1000000000);
    snprintf(out, size, "%d:%02d  %.60s  %llu frames, %.1f MB, %llu dropped%s", (int)(seconds / 60),
             (int)(seconds % 60), r->path, (unsigned long long)s.written.frames,
             1e-6 * (double)s.written.bytes, (unsigned long long)s.dropped,
             recorder_has_failed(r) ? "  FAILED" : "");
    return true;
}

void recorder_print_summary(FILE *file, const recorder_options *options,
                            const recorder_status *status)
{
    if (options->path != NULL) {
        fprintf(file,
                "recorded: %s: %llu frames, %.1f MB; %llu dropped since the disk or the processor "
                "was too slow\n",
                options->path, (unsigned long long)status->written.frames,
                1e-6 * (double)status->written.bytes, (unsigned long long)status->dropped);
    }
}

/* ---- the loop's side --------------------------------------------------------------------------
 */

static void fill_frame(recorder *r, const rlf_frame *frame)
{
    /* A clip that starts again was recorded already. */
    if (r->has_last && frame->time_ns <= r->last_ns) {
        return;
    }
    if (recorder_has_failed(r)) { /* which was told */
        return;
    }
    record_item *item = record_queue_reserve(&r->queue, !r->info.is_live);
    if (item == NULL || !record_item_set_frame(item, &r->queue.rig, frame)) {
        r->dropped++;
        return;
    }
    r->has_last = true;
    r->last_ns = frame->time_ns;
    record_queue_push(&r->queue);
}

static void add_frame(void *context, const rlf_frame *frame)
{
    recorder *r = context;
    pthread_mutex_lock(&r->fills);
    if (r->is_running) {
        fill_frame(r, frame);
    }
    pthread_mutex_unlock(&r->fills);
}

void recorder_add_bodies(recorder *r, int64_t time_ns, const rlf_snapshot *snapshot)
{
    if (r == NULL || !r->options.keeps_bodies || !r->is_running || recorder_has_failed(r)) {
        return;
    }
    pthread_mutex_lock(&r->fills);
    record_item *item = record_queue_reserve(&r->queue, !r->info.is_live);
    if (item != NULL && record_item_set_bodies(item, time_ns, snapshot)) {
        record_queue_push(&r->queue);
    }
    pthread_mutex_unlock(&r->fills);
}

typedef struct tap {
    recorder *recorder;
    rlf_source *source;
    bool is_observed;
} tap;

static rlf_result tap_next(void *self, rlf_frame *out)
{
    tap *t = self;
    const rlf_result result = rlf_source_next(t->source, out);
    if (result == RLF_OK && !t->is_observed) {
        add_frame(t->recorder, out);
    }
    return result;
}

static rlf_result tap_restart(void *self)
{
    return rlf_source_restart(((tap *)self)->source);
}

static rlf_result tap_seek(void *self, int64_t index)
{
    return rlf_source_seek(((tap *)self)->source, index);
}

static const rlf_truth *tap_truth(void *self)
{
    return rlf_source_get_truth(((tap *)self)->source);
}

static void tap_status(void *self, rlf_source_status *out)
{
    *out = rlf_source_get_status(((tap *)self)->source);
}

static void tap_destroy(void *self)
{
    tap *t = self;
    rlf_source_destroy(&t->source);
    rlf_free(t);
}

rlf_result recorder_tap(recorder *r, rlf_source **source)
{
    static const rlf_source_methods methods = {.next = tap_next,
                                               .restart = tap_restart,
                                               .seek = tap_seek,
                                               .truth = tap_truth,
                                               .status = tap_status,
                                               .destroy = tap_destroy};
    tap *t = rlf_alloc(sizeof(*t));
    if (t == NULL) {
        return RLF_ERROR_MEMORY;
    }
    *t = (tap){.recorder = r, .source = *source};
    rlf_source *tapped = NULL;
    rlf_source_info info = *rlf_source_get_info(*source);
    info.rig.depth_offset_m = 0.0; /* is taken away already */
    rlf_result result = rlf_source_create_custom(&methods, &info, t, &tapped);
    if (result != RLF_OK) {
        rlf_free(t);
        return result;
    }
    if (r->options.is_beside_loop && rlf_source_observe(t->source, add_frame, r)) {
        t->is_observed = true;
        r->observed = t->source;
    }
    rlf_source_expect_range(t->source, 0.0, 0.0); /* it is asked of what is tapped */
    *source = tapped;
    return RLF_OK;
}
