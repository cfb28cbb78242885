/* A live source as its reader sees it: the newest frame, counts, and an end within two seconds. */
#include "io/live/live.h"

#include <stdio.h>
#include <string.h>

#define OPEN_NS (5 * LIVE_SECOND_NS)  /* for the driver to open and to give its first frame */
#define NEXT_NS (LIVE_SECOND_NS / 20) /* so that windows and Ctrl-C are looked at meanwhile */

static rlf_result live_next(void *self, rlf_frame *out)
{
    io_live *l = self;
    const int64_t until_ns = rlf_clock_ns() + NEXT_NS;
    rlf_result result = RLF_NO_FRAME;
    pthread_mutex_lock(&l->mutex);
    while (!l->has_newest && l->outcome == RLF_OK && rlf_clock_ns() < until_ns) {
        live_wait(l, until_ns);
    }
    if (l->has_newest) {
        const int32_t newest = l->newest;
        l->newest = l->given;
        l->given = newest;
        l->has_newest = false;
        *out = l->slots[newest].frame;
        result = RLF_OK;
    } else if (l->outcome != RLF_OK) {
        result = l->outcome;
    }
    const bool is_silent = rlf_clock_ns() - l->last_frame_ns >= LIVE_SILENCE_NS;
    pthread_mutex_unlock(&l->mutex);
    if (result == RLF_NO_FRAME && is_silent) {
        live_tell_silence(l, NULL); /* the thread may be stuck in the driver */
    }
    return result < 0 ? rlf_fail(result, "%s", l->error) : result;
}

static void live_status(void *self, rlf_source_status *out)
{
    io_live *l = self;
    pthread_mutex_lock(&l->mutex);
    *out = l->counts;
    live_add_counts(&l->device_counts, out);
    live_add_counts(&l->past_counts, out);
    out->silence_s = (double)(rlf_clock_ns() - l->last_frame_ns) / (double)LIVE_SECOND_NS;
    out->is_connected = l->is_connected;
    pthread_mutex_unlock(&l->mutex);
}

static void live_observe(void *self, rlf_frame_fn fn, void *context)
{
    io_live *l = self;
    pthread_mutex_lock(&l->observer_mutex);
    l->observer = fn;
    l->observer_context = context;
    pthread_mutex_unlock(&l->observer_mutex);
}

/* There is no first frame to go back to: what comes next is as good. */
static rlf_result live_restart(void *self)
{
    (void)self;
    return RLF_OK;
}

static rlf_result wait_for_frame(io_live *l)
{
    const int64_t until_ns = rlf_clock_ns() + OPEN_NS;
    pthread_mutex_lock(&l->mutex);
    while (!l->has_newest && l->outcome == RLF_OK && rlf_clock_ns() < until_ns) {
        live_wait(l, until_ns);
    }
    const bool has_frame = l->has_newest;
    const rlf_result outcome = l->outcome;
    const bool is_described = l->is_described;
    char refused[LIVE_TEXT];
    memcpy(refused, l->refused, sizeof(refused));
    pthread_mutex_unlock(&l->mutex);
    if (!has_frame && outcome == RLF_OK && refused[0] != '\0') {
        return rlf_fail(RLF_ERROR_DEVICE, "%s", refused);
    }
    if (has_frame) {
        return RLF_OK;
    }
    if (outcome < 0) {
        return rlf_fail(outcome, "%s", l->error);
    }
    return rlf_fail(RLF_ERROR_DEVICE,
                    "%s: %s within %d s: is another program using it? unplug it and plug it in "
                    "again",
                    l->name, is_described ? "gave no frame" : "its driver did not open it",
                    (int)(OPEN_NS / LIVE_SECOND_NS));
}

rlf_result io_live_open(const rlf_backend *backend, const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {.next = live_next,
                                               .restart = live_restart,
                                               .status = live_status,
                                               .destroy = live_destroy,
                                               .observe = live_observe};
    io_live *l = NULL;
    rlf_result result = live_create(backend, address, live_capture, &l);
    if (result != RLF_OK) {
        return result;
    }
    result = wait_for_frame(l);
    if (result != RLF_OK) {
        return live_give_up(l, result, rlf_error_text());
    }
    memset(out, 0, sizeof(*out));
    out->methods = methods;
    out->info = l->info;
    out->info.is_live = true;
    out->info.frame_count = -1;
    out->self = l;
    return RLF_OK;
}
