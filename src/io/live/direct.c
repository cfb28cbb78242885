/* A camera whose every frame is given in its turn: its driver is asked on a thread of its own. */
#define _POSIX_C_SOURCE 200809L
#include "io/live/live.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define SECOND_NS INT64_C(1000000000)
#define NEXT_NS (SECOND_NS / 2) /* so that Ctrl-C is looked at meanwhile */
#define END_NS SECOND_NS        /* for the driver to come back when the source ends */
#define TEXT 512

typedef struct direct {
    const rlf_backend *backend;
    const rlf_address *address; /* until it is open */
    rlf_opened device;
    char name[128];
    pthread_t thread;
    live_slot slot; /* what the program was given last */

    pthread_mutex_t mutex;
    pthread_cond_t news;
    bool is_asked, is_answered; /* for a frame; the driver is the thread's in between */
    bool is_open;               /* or could not be */
    bool is_ending, is_done, is_abandoned;
    rlf_frame frame;
    rlf_result result;
    char error[TEXT];
    rlf_source_status status;
} direct;

static void free_direct(direct *d)
{
    live_slot_destroy(&d->slot);
    pthread_cond_destroy(&d->news);
    pthread_mutex_destroy(&d->mutex);
    rlf_free(d);
}

/* With the mutex held. */
static void wait_until(direct *d, int64_t until_ns)
{
    const struct timespec until = {.tv_sec = (time_t)(until_ns / SECOND_NS),
                                   .tv_nsec = (long)(until_ns % SECOND_NS)};
    pthread_cond_timedwait(&d->news, &d->mutex, &until);
}

/* ---- the thread -------------------------------------------------------------------------------
 */

/* With the mutex held, which is let go while the driver works. */
static void answer(direct *d)
{
    rlf_frame frame;
    memset(&frame, 0, sizeof(frame));
    frame.rig = &d->device.info.rig;
    pthread_mutex_unlock(&d->mutex);
    const rlf_result result = d->device.methods.next(d->device.self, &frame);
    pthread_mutex_lock(&d->mutex);
    d->frame = frame;
    d->result = result;
    snprintf(d->error, sizeof(d->error), "%s", result < 0 ? rlf_error_text() : "");
    d->is_answered = true;
    pthread_cond_broadcast(&d->news);
}

static rlf_result open_device(direct *d)
{
    rlf_result result = d->backend->open(d->address, &d->device);
    if (result != RLF_OK) {
        memset(&d->device, 0, sizeof(d->device));
        return result;
    }
    const rlf_rig *rig = &d->device.info.rig;
    result = rlf_camera_check(&rig->depth, d->name);
    if (result == RLF_OK && rig->has_color) {
        result = rlf_camera_check(&rig->color, d->name);
    }
    return result == RLF_OK ? live_slot_create(rig, &d->slot) : result;
}

static void *serve(void *context)
{
    direct *d = context;
    const rlf_result result = open_device(d);
    pthread_mutex_lock(&d->mutex);
    d->result = result;
    snprintf(d->error, sizeof(d->error), "%s", result < 0 ? rlf_error_text() : "");
    d->is_open = true;
    pthread_cond_broadcast(&d->news);
    while (!d->is_ending) {
        if (d->is_asked && !d->is_answered) {
            answer(d);
        } else {
            pthread_cond_wait(&d->news, &d->mutex);
        }
    }
    pthread_mutex_unlock(&d->mutex);
    if (d->device.methods.destroy != NULL) {
        d->device.methods.destroy(d->device.self);
    }
    pthread_mutex_lock(&d->mutex);
    d->is_done = true;
    const bool is_abandoned = d->is_abandoned;
    pthread_cond_broadcast(&d->news);
    pthread_mutex_unlock(&d->mutex);
    if (is_abandoned) {
        free_direct(d);
    }
    return NULL;
}

/* ---- the program ------------------------------------------------------------------------------
 */

/* The frame that has come, copied: the driver's planes are its own again with the next one. */
static rlf_result take(direct *d, rlf_frame *out)
{
    const rlf_rig *rig = &d->device.info.rig;
    if (d->result < 0) {
        return rlf_fail(d->result, "%s", d->error);
    }
    rlf_result result = d->result;
    if (result == RLF_OK) {
        result = rlf_frame_check(rig, &d->frame, d->name);
    }
    if (result == RLF_OK) {
        live_slot_copy(&d->slot, rig, &d->frame);
        *out = d->slot.frame;
    }
    return result;
}

static rlf_result direct_next(void *self, rlf_frame *out)
{
    direct *d = self;
    const int64_t until_ns = rlf_clock_ns() + NEXT_NS;
    rlf_result result = RLF_NO_FRAME;
    pthread_mutex_lock(&d->mutex);
    if (!d->is_asked) {
        d->is_asked = true;
        pthread_cond_broadcast(&d->news);
    }
    while (!d->is_answered && rlf_clock_ns() < until_ns) {
        wait_until(d, until_ns);
    }
    if (d->is_answered) {
        result = take(d, out);
        d->is_asked = d->is_answered = false;
    }
    pthread_mutex_unlock(&d->mutex);
    return result;
}

/* While the driver is busy that of before. */
static void direct_status(void *self, rlf_source_status *out)
{
    direct *d = self;
    pthread_mutex_lock(&d->mutex);
    if (!d->is_asked || d->is_answered) {
        d->status = *out;
        d->device.methods.status(d->device.self, &d->status);
    }
    *out = d->status;
    pthread_mutex_unlock(&d->mutex);
}

/* A driver that does not come back keeps its thread, which frees the rest should it ever do. */
static void direct_destroy(void *self)
{
    direct *d = self;
    const int64_t until_ns = rlf_clock_ns() + END_NS;
    const pthread_t thread = d->thread;
    pthread_mutex_lock(&d->mutex);
    d->is_ending = true;
    pthread_cond_broadcast(&d->news);
    while (!d->is_done && rlf_clock_ns() < until_ns) {
        wait_until(d, until_ns);
    }
    const bool is_done = d->is_done;
    d->is_abandoned = !is_done;
    if (!is_done) {
        rlf_log(RLF_LOG_WARNING, "camera %s: its driver does not come back: left alone", d->name);
        pthread_detach(thread);
    }
    pthread_mutex_unlock(&d->mutex);
    if (is_done) {
        pthread_join(thread, NULL);
        free_direct(d);
    }
}

static rlf_result create(const rlf_backend *backend, const rlf_address *address, direct **out)
{
    pthread_condattr_t attributes;
    direct *d = rlf_alloc(sizeof(*d));
    if (d == NULL || pthread_condattr_init(&attributes) != 0) {
        rlf_free(d);
        return RLF_ERROR_MEMORY;
    }
    d->backend = backend;
    d->address = address;
    snprintf(d->name, sizeof(d->name), "%.127s", address->source);
    d->status.is_connected = true;
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_mutex_init(&d->mutex, NULL);
    pthread_cond_init(&d->news, &attributes);
    pthread_condattr_destroy(&attributes);
    if (pthread_create(&d->thread, NULL, serve, d) != 0) {
        free_direct(d);
        return rlf_fail(RLF_ERROR_MEMORY, "%s: no thread to be had for it", address->source);
    }
    *out = d;
    return RLF_OK;
}

rlf_result io_direct_open(const rlf_backend *backend, const rlf_address *address, rlf_opened *out)
{
    direct *d = NULL;
    rlf_result result = create(backend, address, &d);
    if (result != RLF_OK) {
        return result;
    }
    pthread_mutex_lock(&d->mutex);
    while (!d->is_open) {
        pthread_cond_wait(&d->news, &d->mutex);
    }
    pthread_mutex_unlock(&d->mutex);
    if (d->result != RLF_OK) {
        char error[TEXT];
        result = d->result;
        snprintf(error, sizeof(error), "%s", d->error);
        direct_destroy(d);
        return rlf_fail(result, "%s", error);
    }
    *out = d->device;
    out->methods =
        (rlf_source_methods){.next = direct_next,
                             .status = d->device.methods.status != NULL ? direct_status : NULL,
                             .destroy = direct_destroy};
    out->self = d;
    return RLF_OK;
}
