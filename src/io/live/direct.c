/* A camera whose every frame is given in its turn: its driver is asked on a thread of its own. */
#include "io/live/live.h"

#include <stdio.h>
#include <string.h>

#define NEXT_NS (LIVE_SECOND_NS / 2) /* so that Ctrl-C is looked at meanwhile */

/* With the mutex held, which is let go while the driver works. */
static void answer(io_live *l)
{
    rlf_frame frame;
    memset(&frame, 0, sizeof(frame));
    frame.rig = &l->info.rig;
    pthread_mutex_unlock(&l->mutex);
    const rlf_result result = l->device.methods.next(l->device.self, &frame);
    pthread_mutex_lock(&l->mutex);
    l->answer = frame;
    l->outcome = result;
    snprintf(l->error, sizeof(l->error), "%s", result < 0 ? rlf_error_text() : "");
    l->is_answered = true;
    pthread_cond_broadcast(&l->news);
}

static void *serve(void *live)
{
    io_live *l = live;
    rlf_result result = l->backend->open(&l->address.address, &l->device);
    if (result != RLF_OK) {
        memset(&l->device, 0, sizeof(l->device));
    }
    result = result == RLF_OK ? live_describe(l) : result;
    live_finish(l, result, result < 0 ? rlf_error_text() : "");
    pthread_mutex_lock(&l->mutex);
    l->is_open = true;
    pthread_cond_broadcast(&l->news);
    while (!l->is_stopping) {
        if (l->is_asked && !l->is_answered) {
            answer(l);
        } else {
            pthread_cond_wait(&l->news, &l->mutex);
        }
    }
    pthread_mutex_unlock(&l->mutex);
    live_close_device(l);
    live_end_thread(l);
    return NULL;
}

/* The frame that has come, copied: the driver's planes are its own again with the next one. */
static rlf_result take(io_live *l, rlf_frame *out)
{
    if (l->outcome < 0) {
        return rlf_fail(l->outcome, "%s", l->error);
    }
    rlf_result result = l->outcome;
    result = result == RLF_OK ? rlf_frame_check(&l->info.rig, &l->answer, l->name) : result;
    if (result == RLF_OK) {
        io_frame_copy_set(&l->slots[0], &l->info.rig, &l->answer);
        *out = l->slots[0].frame;
    }
    return result;
}

static rlf_result direct_next(void *self, rlf_frame *out)
{
    io_live *l = self;
    const int64_t until_ns = rlf_clock_ns() + NEXT_NS;
    rlf_result result = RLF_NO_FRAME;
    pthread_mutex_lock(&l->mutex);
    if (!l->is_asked) {
        l->is_asked = true;
        pthread_cond_broadcast(&l->news);
    }
    while (!l->is_answered && rlf_clock_ns() < until_ns) {
        live_wait(l, until_ns);
    }
    if (l->is_answered) {
        result = take(l, out);
        l->is_asked = l->is_answered = false;
    }
    pthread_mutex_unlock(&l->mutex);
    return result;
}

/* While the driver is busy that of before. */
static void direct_status(void *self, rlf_source_status *out)
{
    io_live *l = self;
    pthread_mutex_lock(&l->mutex);
    if (!l->is_asked || l->is_answered) {
        l->device_counts = *out;
        l->device.methods.status(l->device.self, &l->device_counts);
    }
    *out = l->device_counts;
    pthread_mutex_unlock(&l->mutex);
}

rlf_result io_direct_open(const rlf_backend *backend, const rlf_address *address, rlf_opened *out)
{
    io_live *l = NULL;
    rlf_result result = live_create(backend, address, serve, &l);
    if (result != RLF_OK) {
        return result;
    }
    pthread_mutex_lock(&l->mutex);
    l->device_counts.is_connected = true;
    while (!l->is_open) {
        pthread_cond_wait(&l->news, &l->mutex);
    }
    pthread_mutex_unlock(&l->mutex);
    if (l->outcome != RLF_OK) {
        return live_give_up(l, l->outcome, l->error);
    }
    *out = l->device;
    out->methods =
        (rlf_source_methods){.next = direct_next,
                             .status = l->device.methods.status != NULL ? direct_status : NULL,
                             .destroy = live_destroy};
    out->self = l;
    return RLF_OK;
}
