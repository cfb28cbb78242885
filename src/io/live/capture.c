/* The thread that talks to a camera's driver: opens, takes frames, closes, opens again. */
#include "io/live/live.h"

#include <stdio.h>
#include <string.h>

#define FIRST_FRAME_NS (5 * LIVE_SECOND_NS) /* what a camera may take to start */
#define RETRY_NS (LIVE_SECOND_NS / 2)       /* between two attempts to open it again */
#define BREATH_NS INT64_C(2000000)          /* when the driver comes back with nothing at once */

static bool is_over(io_live *l)
{
    pthread_mutex_lock(&l->mutex);
    const bool is_over = l->is_stopping || l->outcome != RLF_OK;
    pthread_mutex_unlock(&l->mutex);
    return is_over;
}

/* Wakes early when the source is to end. */
static void rest(io_live *l, int64_t time_ns)
{
    const int64_t until_ns = rlf_clock_ns() + time_ns;
    pthread_mutex_lock(&l->mutex);
    while (!l->is_stopping && rlf_clock_ns() < until_ns) {
        live_wait(l, until_ns);
    }
    pthread_mutex_unlock(&l->mutex);
}

/* ---- opening -------------------------------------------------------------------------------- */

static bool is_same_camera(const rlf_camera *a, const rlf_camera *b)
{
    return a->width == b->width && a->height == b->height && a->fx == b->fx && a->fy == b->fy &&
           a->cx == b->cx && a->cy == b->cy;
}

static bool is_same_rig(const rlf_rig *a, const rlf_rig *b)
{
    return is_same_camera(&a->depth, &b->depth) && a->has_color == b->has_color &&
           (!a->has_color || is_same_camera(&a->color, &b->color));
}

rlf_result live_describe(io_live *l)
{
    const rlf_rig *rig = &l->device.info.rig;
    rlf_result result = rlf_camera_check(&rig->depth, l->name);
    if (result == RLF_OK && rig->has_color) {
        result = rlf_camera_check(&rig->color, l->name);
    }
    for (int32_t i = 0; i < LIVE_SLOTS && result == RLF_OK; i++) {
        result = io_frame_copy_create(rig, &l->slots[i]);
    }
    if (result == RLF_OK) {
        pthread_mutex_lock(&l->mutex);
        l->info = l->device.info;
        l->is_described = true;
        pthread_mutex_unlock(&l->mutex);
    }
    return result;
}

void live_close_device(io_live *l)
{
    if (l->device.methods.destroy != NULL) {
        l->device.methods.destroy(l->device.self);
    }
    memset(&l->device, 0, sizeof(l->device));
    pthread_mutex_lock(&l->mutex);
    live_add_counts(&l->device_counts, &l->past_counts);
    l->device_counts = (rlf_source_status){.is_connected = false};
    pthread_mutex_unlock(&l->mutex);
}

static void finish_changed(io_live *l)
{
    const rlf_camera *now = &l->device.info.rig.depth;
    const rlf_camera *before = &l->info.rig.depth;
    char line[LIVE_TEXT];
    snprintf(line, sizeof(line),
             "%s: came back as another camera (depth %d x %d, fx %.2f; before %d x %d, fx %.2f): "
             "start again with this one",
             l->name, (int)now->width, (int)now->height, now->fx, (int)before->width,
             (int)before->height, before->fx);
    live_finish(l, RLF_ERROR_DEVICE, line);
}

/* False: there is no device, or it is of no use. The first attempt must succeed. */
static bool open_device(io_live *l)
{
    rlf_result result = l->backend->open(&l->address.address, &l->device);
    if (result != RLF_OK) {
        memset(&l->device, 0, sizeof(l->device));
        if (!l->is_described) {
            live_finish(l, result, rlf_error_text());
        }
        return false;
    }
    if (!l->is_described) {
        result = live_describe(l);
        if (result != RLF_OK) {
            live_finish(l, result, rlf_error_text());
        }
    } else if (!is_same_rig(&l->device.info.rig, &l->info.rig)) {
        finish_changed(l);
        result = RLF_ERROR_DEVICE;
    }
    if (result != RLF_OK) {
        live_close_device(l);
        return false;
    }
    live_follow_reconnect(&l->follow);
    l->device_frame_ns = rlf_clock_ns();
    l->has_device_frame = false;
    return true;
}

/* ---- frames --------------------------------------------------------------------------------- */

/* What the driver itself has counted. Gaps are counted here, by the frames' numbers. */
static void note_counts(io_live *l, rlf_result result)
{
    rlf_source_status now = {.damaged = l->device_counts.damaged};
    if (l->device.methods.status != NULL) {
        l->device.methods.status(l->device.self, &now);
    } else {
        now.damaged += result == RLF_ERROR_FORMAT ? 1 : 0;
    }
    pthread_mutex_lock(&l->mutex);
    l->device_counts = now;
    pthread_mutex_unlock(&l->mutex);
}

/* Hands the filled slot on; an older frame that nobody asked for makes room. */
static void publish(io_live *l, int64_t now_ns)
{
    const int32_t filled = l->filled;
    rlf_frame *frame = &l->slots[filled].frame;
    pthread_mutex_lock(&l->mutex);
    const bool was_told = l->is_told;
    const double silence_s = (double)(now_ns - l->last_frame_ns) / (double)LIVE_SECOND_NS;
    frame->flags |= was_told ? (uint32_t)RLF_FRAME_DISCONTINUITY : 0u;
    if (l->has_newest) {
        frame->flags |= l->slots[l->newest].frame.flags & RLF_FRAME_DISCONTINUITY;
        l->counts.late++;
    }
    l->filled = l->newest;
    l->newest = filled;
    l->has_newest = true;
    l->is_told = false;
    l->is_connected = true;
    l->last_frame_ns = now_ns;
    pthread_cond_broadcast(&l->news);
    pthread_mutex_unlock(&l->mutex);
    if (was_told) {
        rlf_log(RLF_LOG_WARNING, "camera %s: frames are back after %.1f s", l->name, silence_s);
    }
}

static void show(io_live *l, const rlf_frame *frame)
{
    pthread_mutex_lock(&l->observer_mutex);
    if (l->observer != NULL) {
        l->observer(l->observer_context, frame);
    }
    pthread_mutex_unlock(&l->observer_mutex);
}

static void take_frame(io_live *l, rlf_frame *frame)
{
    const int64_t now_ns = rlf_clock_ns();
    uint64_t lost;
    l->device_frame_ns = now_ns;
    l->has_device_frame = true;
    frame->host_time_ns = frame->host_time_ns != 0 ? frame->host_time_ns : now_ns;
    const bool is_new = live_follow_frame(&l->follow, now_ns, frame, &lost);
    const bool is_good = is_new && rlf_frame_check(&l->info.rig, frame, l->name) == RLF_OK;
    if (is_good) {
        io_frame_copy_set(&l->slots[l->filled], &l->info.rig, frame);
    }
    pthread_mutex_lock(&l->mutex);
    snprintf(l->refused, sizeof(l->refused), "%s", is_new && !is_good ? rlf_error_text() : "");
    l->counts.lost += lost;
    l->counts.doubled += is_new ? 0 : 1;
    l->counts.damaged += is_new && !is_good ? 1 : 0;
    pthread_mutex_unlock(&l->mutex);
    if (is_good) {
        show(l, &l->slots[l->filled].frame);
        publish(l, now_ns);
    }
}

/* One call of the driver. False: the device is gone. */
static bool capture_one(io_live *l)
{
    rlf_frame frame;
    memset(&frame, 0, sizeof(frame));
    frame.rig = &l->info.rig;
    const int64_t start_ns = rlf_clock_ns();
    const rlf_result result = l->device.methods.next(l->device.self, &frame);
    note_counts(l, result);
    if (result == RLF_OK) {
        take_frame(l, &frame);
        return true;
    }
    if (result == RLF_END) {
        live_finish(l, RLF_END, "");
        return false;
    }
    if (result != RLF_NO_FRAME && result != RLF_ERROR_FORMAT) {
        live_tell_silence(l, rlf_error_text());
        return false;
    }
    const int64_t now_ns = rlf_clock_ns();
    const int64_t silence_ns = now_ns - l->device_frame_ns;
    if (silence_ns >= LIVE_SILENCE_NS && l->follow.has_last) {
        live_tell_silence(l, NULL);
    }
    if (now_ns - start_ns < BREATH_NS) {
        rest(l, BREATH_NS);
    }
    return silence_ns < (l->has_device_frame ? LIVE_SILENCE_NS : FIRST_FRAME_NS);
}

void *live_capture(void *live)
{
    io_live *l = live;
    while (!is_over(l)) {
        if (open_device(l)) {
            while (!is_over(l) && capture_one(l)) {
            }
            live_close_device(l);
        }
        if (!is_over(l)) {
            rest(l, RETRY_NS);
        }
    }
    live_end_thread(l);
    return NULL;
}
