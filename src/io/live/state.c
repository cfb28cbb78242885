/* What a live source's reader and its capture thread share. */
#define _POSIX_C_SOURCE 200809L
#include "io/live/live.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

/* ---- an address that lives longer than the call that gave it ----------------------------- */

static size_t text_size(const rlf_address *a)
{
    size_t size = strlen(a->source) + strlen(a->place) + 2;
    for (int32_t i = 0; i < a->key_count; i++) {
        size += strlen(a->keys[i]) + strlen(a->values[i]) + 2;
    }
    return size;
}

static const char *put(char **end, const char *text)
{
    char *copy = *end;
    const size_t size = strlen(text) + 1;
    memcpy(copy, text, size);
    *end += size;
    return copy;
}

/* Do not move *out afterwards. */
static rlf_result copy_address(const rlf_address *address, live_address *out)
{
    memset(out, 0, sizeof(*out));
    out->text = rlf_alloc(text_size(address));
    if (out->text == NULL) {
        return RLF_ERROR_MEMORY;
    }
    char *end = out->text;
    out->address = *address;
    out->address.source = put(&end, address->source);
    out->address.place = put(&end, address->place);
    for (int32_t i = 0; i < address->key_count; i++) {
        out->address.keys[i] = put(&end, address->keys[i]);
        out->address.values[i] = put(&end, address->values[i]);
    }
    if (address->rig != NULL) {
        out->rig = *address->rig;
        out->address.rig = &out->rig;
    }
    return RLF_OK;
}

static void free_address(live_address *address)
{
    rlf_free(address->text);
    address->text = NULL;
}

#define END_NS (LIVE_SECOND_NS * 3 / 2) /* for the driver to come back when the source ends */

static rlf_result create_lock(io_live *l)
{
    pthread_condattr_t attributes;
    if (pthread_condattr_init(&attributes) != 0) {
        return RLF_ERROR_MEMORY;
    }
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    const bool is_good = pthread_mutex_init(&l->mutex, NULL) == 0 &&
                         pthread_mutex_init(&l->observer_mutex, NULL) == 0 &&
                         pthread_cond_init(&l->news, &attributes) == 0;
    pthread_condattr_destroy(&attributes);
    return is_good ? RLF_OK : RLF_ERROR_MEMORY;
}

void live_wait(io_live *l, int64_t until_ns)
{
    const struct timespec until = {.tv_sec = (time_t)(until_ns / LIVE_SECOND_NS),
                                   .tv_nsec = (long)(until_ns % LIVE_SECOND_NS)};
    pthread_cond_timedwait(&l->news, &l->mutex, &until);
}

static void free_live(io_live *l)
{
    for (int32_t i = 0; i < LIVE_SLOTS; i++) {
        io_frame_copy_destroy(&l->slots[i]);
    }
    free_address(&l->address);
    pthread_cond_destroy(&l->news);
    pthread_mutex_destroy(&l->mutex);
    pthread_mutex_destroy(&l->observer_mutex);
    rlf_free(l);
}

rlf_result live_create(const rlf_backend *backend, const rlf_address *address,
                       void *(*thread)(void *), io_live **out)
{
    io_live *l = rlf_alloc(sizeof(*l));
    if (l == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = create_lock(l);
    result = result == RLF_OK ? copy_address(address, &l->address) : result;
    if (result != RLF_OK) {
        rlf_free(l);
        return result;
    }
    l->backend = backend;
    snprintf(l->name, sizeof(l->name), "%.127s", address->source);
    l->newest = 1;
    l->given = 2;
    l->is_connected = true;
    l->last_frame_ns = rlf_clock_ns();
    if (pthread_create(&l->thread, NULL, thread, l) != 0) {
        free_live(l);
        return rlf_fail(RLF_ERROR_MEMORY, "%s: no thread to be had for it", address->source);
    }
    *out = l;
    return RLF_OK;
}

/* A driver that does not come back keeps its thread, which frees the rest should it ever do. */
void live_destroy(void *live)
{
    io_live *l = live;
    const int64_t until_ns = rlf_clock_ns() + END_NS;
    const pthread_t thread = l->thread;
    pthread_mutex_lock(&l->mutex);
    l->is_stopping = true;
    pthread_cond_broadcast(&l->news);
    while (!l->is_done && rlf_clock_ns() < until_ns) {
        live_wait(l, until_ns);
    }
    const bool is_done = l->is_done;
    l->is_abandoned = !is_done;
    if (!is_done) {
        rlf_log(RLF_LOG_WARNING, "camera %s: its driver does not come back: left alone", l->name);
        pthread_detach(thread);
    }
    pthread_mutex_unlock(&l->mutex);
    if (is_done) {
        pthread_join(thread, NULL);
        free_live(l);
    }
}

rlf_result live_give_up(io_live *l, rlf_result result, const char *line)
{
    char error[LIVE_TEXT];
    snprintf(error, sizeof(error), "%s", line);
    live_destroy(l);
    return rlf_fail(result, "%s", error);
}

void live_end_thread(io_live *l)
{
    pthread_mutex_lock(&l->mutex);
    l->is_done = true;
    const bool is_abandoned = l->is_abandoned;
    pthread_cond_broadcast(&l->news);
    pthread_mutex_unlock(&l->mutex);
    if (is_abandoned) {
        free_live(l);
    }
}

void live_add_counts(const rlf_source_status *from, rlf_source_status *sum)
{
    sum->late += from->late;
    sum->doubled += from->doubled;
    sum->unpaired += from->unpaired;
    sum->damaged += from->damaged;
}

void live_tell_silence(io_live *l, const char *reason)
{
    pthread_mutex_lock(&l->mutex);
    const bool is_new = !l->is_told && !l->is_stopping;
    l->is_told = l->is_told || is_new;
    l->is_connected = false;
    char refused[LIVE_TEXT];
    memcpy(refused, l->refused, sizeof(refused));
    pthread_mutex_unlock(&l->mutex);
    reason = reason == NULL && refused[0] != '\0' ? refused : reason;
    if (is_new && reason == NULL) {
        rlf_log(RLF_LOG_WARNING, "camera %s: no frame for 1 s: is it unplugged? trying again",
                l->name);
    } else if (is_new) { /* a back end's lines begin with its source */
        const size_t length = strlen(l->name);
        const bool is_named = strncmp(reason, l->name, length) == 0 && reason[length] == ':';
        rlf_log(RLF_LOG_WARNING, "camera %s%s%s; trying again", is_named ? "" : l->name,
                is_named ? "" : ": ", reason);
    }
}

void live_finish(io_live *l, rlf_result outcome, const char *line)
{
    pthread_mutex_lock(&l->mutex);
    l->outcome = outcome;
    snprintf(l->error, sizeof(l->error), "%s", line);
    pthread_cond_broadcast(&l->news);
    pthread_mutex_unlock(&l->mutex);
}
