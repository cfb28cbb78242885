/* A camera without hardware: plays any source in real time, over and over, with faults. */
#define _POSIX_C_SOURCE 200809L
#include "io/source/backends.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* ---- what goes wrong with a simulated camera, and when ----------------------------------- */

/* Times are seconds since the camera was opened first; < 0 = never. */
typedef struct simulated_faults {
    double unplug_s, replug_s;    /* pulled out; put back in that long after */
    double stall_s, stall_from_s; /* no frames for stall_s; stall_s 0 = never */
    double hang_s;                /* from then on its driver does not return */
    double time_back_s;           /* its clock starts again from zero */
    double jitter_s;              /* frames come up to that much late */
    int32_t drop, doubled;        /* every n-th frame is lost, comes twice; 0 = none */
} simulated_faults;

#define NUMBER_MAX 1e6

static rlf_result fail_key(const rlf_address *address, const char *key, const char *cure)
{
    return rlf_fail(RLF_ERROR_INVALID, "%s: %s=%.40s: use %s", address->source, key,
                    rlf_address_get(address, key), cure);
}

static rlf_result parse_stall(const rlf_address *address, simulated_faults *out)
{
    const char *text = rlf_address_get(address, "stall");
    char rest;
    if (text == NULL) {
        return RLF_OK;
    }
    const bool is_good = sscanf(text, "%lf@%lf%c", &out->stall_s, &out->stall_from_s, &rest) == 2 &&
                         out->stall_s > 0.0 && out->stall_s <= NUMBER_MAX &&
                         out->stall_from_s >= 0.0 && out->stall_from_s <= NUMBER_MAX;
    return is_good ? RLF_OK : fail_key(address, "stall", "SECONDS@WHEN, e.g. 2@10");
}

static rlf_result parse_faults(const rlf_address *address, simulated_faults *out)
{
    static const char seconds[] = "seconds, 0 to 1000000";
    static const char frames[] = "a number of frames, 2 to 1000000";
    *out = (simulated_faults){.unplug_s = -1, .replug_s = -1, .hang_s = -1, .time_back_s = -1};
    double jitter_ms = 0.0, drop = 0.0, doubled = 0.0;
    const struct {
        const char *key;
        double low;
        const char *cure;
        double *out;
    } keys[] = {{"unplug_after", 0, seconds, &out->unplug_s},
                {"replug_after", 0, seconds, &out->replug_s},
                {"hang", 0, seconds, &out->hang_s},
                {"time_back", 0, seconds, &out->time_back_s},
                {"jitter", 0, seconds, &jitter_ms},
                {"drop", 2, frames, &drop},
                {"doubled", 2, frames, &doubled}};
    for (size_t i = 0; i < sizeof(keys) / sizeof(keys[0]); i++) {
        const char *text = rlf_address_get(address, keys[i].key);
        char rest;
        if (text != NULL && (sscanf(text, "%lf%c", keys[i].out, &rest) != 1 ||
                             !(*keys[i].out >= keys[i].low) || *keys[i].out > NUMBER_MAX)) {
            return fail_key(address, keys[i].key, keys[i].cure);
        }
    }
    out->jitter_s = jitter_ms * 1e-3;
    out->drop = (int32_t)drop;
    out->doubled = (int32_t)doubled;
    return parse_stall(address, out);
}

static bool is_plugged(const simulated_faults *f, double time_s)
{
    const bool is_pulled = f->unplug_s >= 0.0 && time_s >= f->unplug_s;
    return !is_pulled || (f->replug_s >= 0.0 && time_s >= f->unplug_s + f->replug_s);
}

static bool is_stalled(const simulated_faults *f, double time_s)
{
    return f->stall_s > 0.0 && time_s >= f->stall_from_s && time_s < f->stall_from_s + f->stall_s;
}

/* ---- cameras stay plugged in while programs open and close them -------------------------- */

#define NAME_SIZE 64
#define DEVICES_MAX 64

typedef struct device {
    char name[NAME_SIZE];
    int64_t start_ns;
} device;

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static device devices[DEVICES_MAX];
static int32_t device_count;

static device *find(const char *name)
{
    for (int32_t i = 0; i < device_count; i++) {
        if (strcmp(devices[i].name, name) == 0) {
            return &devices[i];
        }
    }
    return NULL;
}

/* When the camera of that name was opened first (rlf_clock_ns), from when its faults are counted;
 * now, if it never was. Both calls are thread-safe. */
static int64_t device_start(const char *name)
{
    pthread_mutex_lock(&mutex);
    const device *d = find(name);
    const int64_t start_ns = d != NULL ? d->start_ns : rlf_clock_ns();
    pthread_mutex_unlock(&mutex);
    return start_ns;
}

/* It was opened; the first time counts. */
static rlf_result note_device(const char *name)
{
    if (strlen(name) >= NAME_SIZE) {
        return rlf_fail(RLF_ERROR_INVALID, "simulated:%.20s...: the name is longer than %d bytes",
                        name, NAME_SIZE - 1);
    }
    pthread_mutex_lock(&mutex);
    const bool is_known = find(name) != NULL;
    const bool has_room = device_count < DEVICES_MAX;
    if (!is_known && has_room) {
        device *d = &devices[device_count++];
        (void)snprintf(d->name, sizeof(d->name), "%s", name);
        d->start_ns = rlf_clock_ns();
    }
    pthread_mutex_unlock(&mutex);
    return is_known || has_room ? RLF_OK
                                : rlf_fail(RLF_ERROR_CAPACITY, "simulated:%s: more than %d of them",
                                           name, DEVICES_MAX);
}

#define NS_PER_S 1e9
#define WAIT_MAX_S 0.05 /* of one call, as drivers do */
#define RATE 30.0       /* where the source does not say */

typedef struct simulated {
    simulated_faults faults;
    rlf_source *played;
    double period_s;
    double start_s; /* the clock when it was opened first */
    double due_s;   /* since then: when the frame that is ready leaves the camera */
    rlf_frame frame;
    bool is_ready, is_again; /* again: the frame comes twice */
    uint64_t made;           /* frames, with the lost ones */
    double epoch_s;          /* of the camera's clock */
} simulated;

static _Atomic(io_open_fn) open_source;

void io_simulated_lend_open(io_open_fn opener)
{
    atomic_store(&open_source, opener);
}

static double clock_s(void)
{
    return (double)rlf_clock_ns() / NS_PER_S;
}

static void sleep_s(double time_s)
{
    const struct timespec t = {(time_t)time_s,
                               (long)((time_s - (double)(time_t)time_s) * NS_PER_S)};
    nanosleep(&t, NULL);
}

/* Fetches the next frame; the played source starts again at its end. */
static rlf_result make_ready(simulated *s)
{
    rlf_result result = rlf_source_next(s->played, &s->frame);
    uint32_t flags = 0;
    if (result == RLF_END) {
        result = rlf_source_restart(s->played);
        result = result == RLF_OK ? rlf_source_next(s->played, &s->frame) : RLF_END;
        flags = RLF_FRAME_DISCONTINUITY;
    }
    if (result == RLF_OK) {
        s->frame.flags |= flags;
        s->is_ready = true;
    }
    return result;
}

/* 0..1, another for each frame; any fixed sequence would do. */
static double draw(uint64_t number)
{
    const uint32_t mixed = (uint32_t)(number * UINT64_C(2654435761)) ^ (uint32_t)(number >> 7);
    return (double)(mixed % 1000) / 1000.0;
}

/* A machine too slow for the rate gets a slower camera, no lost frames. */
static void schedule(simulated *s, double now_s)
{
    s->due_s += s->period_s;
    s->due_s = s->due_s > now_s - s->period_s ? s->due_s : now_s;
}

/* The frame has left the camera; what of it is lost never arrives. */
static bool send(simulated *s, double now_s, rlf_frame *out)
{
    const simulated_faults *f = &s->faults;
    const uint64_t number = s->made++;
    const double clock = s->due_s - s->epoch_s;
    const bool is_lost = f->drop > 0 && s->made % (uint64_t)f->drop == 0;
    s->frame.sequence = number;
    s->frame.time_ns = (int64_t)(clock * NS_PER_S);
    s->frame.color_time_ns = 0;
    s->frame.host_time_ns = 0;
    schedule(s, now_s);
    s->is_ready = false;
    s->is_again = !is_lost && f->doubled > 0 && s->made % (uint64_t)f->doubled == 0;
    *out = s->frame;
    return !is_lost;
}

static rlf_result simulated_next(void *self, rlf_frame *out)
{
    simulated *s = self;
    const simulated_faults *f = &s->faults;
    double now_s = clock_s() - s->start_s;
    while (f->hang_s >= 0.0 && now_s >= f->hang_s) {
        sleep_s(1.0);
    }
    if (!is_plugged(f, now_s)) {
        return rlf_fail(RLF_ERROR_DEVICE, "the simulated camera was pulled out");
    }
    if (is_stalled(f, now_s)) {
        sleep_s(WAIT_MAX_S);
        return RLF_NO_FRAME;
    }
    if (s->is_again) {
        s->is_again = false;
        *out = s->frame;
        return RLF_OK;
    }
    rlf_result result = s->is_ready ? RLF_OK : make_ready(s);
    if (result != RLF_OK) {
        return result;
    }
    if (f->time_back_s >= 0.0 && s->due_s >= f->time_back_s) {
        s->epoch_s = f->time_back_s;
    }
    now_s = clock_s() - s->start_s;
    const double wait_s = s->due_s + f->jitter_s * draw(s->made) - now_s;
    if (wait_s > 0.0) {
        sleep_s(wait_s < WAIT_MAX_S ? wait_s : WAIT_MAX_S);
    }
    return wait_s <= WAIT_MAX_S && send(s, now_s, out) ? RLF_OK : RLF_NO_FRAME;
}

static void simulated_destroy(void *self)
{
    simulated *s = self;
    rlf_source_destroy(&s->played);
    rlf_free(s);
}

static rlf_result open_played(const rlf_address *address, simulated *s)
{
    const char *of = rlf_address_get(address, "of");
    of = of != NULL ? of : "synthetic:room";
    if (strncmp(of, "simulated:", strlen("simulated:")) == 0) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: cannot play a simulated camera", address->source);
    }
    rlf_result result = atomic_load(&open_source)(of, NULL, &s->played);
    if (result == RLF_OK && rlf_source_get_info(s->played)->is_live) {
        result = rlf_fail(RLF_ERROR_INVALID,
                          "%s: of=%s is a camera itself: open it without "
                          "simulated:",
                          address->source, of);
    }
    return result;
}

static rlf_result describe(const rlf_address *address, simulated *s, rlf_source_info *out)
{
    const rlf_source_info *info = rlf_source_get_info(s->played);
    const double rate = info->frames_per_second > 0.0 ? info->frames_per_second : RATE;
    s->period_s = 1.0 / rate;
    memset(out, 0, sizeof(*out));
    snprintf(out->name, sizeof(out->name), "%.127s", address->source);
    snprintf(out->device, sizeof(out->device), "simulated camera that plays %.80s", info->name);
    out->rig = info->rig;
    out->gravity = info->gravity;
    out->is_simulated = info->is_simulated;
    out->frame_count = -1;
    out->frames_per_second = rate;
    out->is_live = true;
    if (address->rig != NULL) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: camera= belongs to what is played: use of=SOURCE?camera=FILE",
                        address->source);
    }
    return RLF_OK;
}

static double start_of(const rlf_address *address)
{
    return (double)device_start(address->place) / NS_PER_S;
}

static rlf_result simulated_open(const rlf_address *address, rlf_opened *out)
{
    simulated_faults faults;
    rlf_result result = parse_faults(address, &faults);
    if (result != RLF_OK) {
        return result;
    }
    const double start_s = start_of(address);
    if (!is_plugged(&faults, clock_s() - start_s)) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: is not plugged in", address->source);
    }
    simulated *s = rlf_alloc(sizeof(*s));
    if (s == NULL) {
        return RLF_ERROR_MEMORY;
    }
    s->faults = faults;
    memset(out, 0, sizeof(*out));
    result = open_played(address, s);
    result = result == RLF_OK ? describe(address, s, &out->info) : result;
    result = result == RLF_OK ? make_ready(s) : result;
    if (result > RLF_OK) {
        result = rlf_fail(RLF_ERROR_IO, "%s: what it plays has no frame", address->source);
    }
    result = result == RLF_OK ? note_device(address->place) : result;
    if (result != RLF_OK) {
        simulated_destroy(s);
        return result;
    }
    s->start_s = start_of(address);
    s->due_s = clock_s() - s->start_s;
    out->methods = (rlf_source_methods){.next = simulated_next, .destroy = simulated_destroy};
    out->self = s;
    return RLF_OK;
}

const rlf_backend io_backend_simulated = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "simulated",
    .keys = "of unplug_after replug_after stall hang time_back jitter drop doubled",
    .summary = "a camera without hardware: plays of=SOURCE (synthetic:room) in real time; faults: "
               "unplug_after=S replug_after=S stall=S@T hang=T time_back=T jitter=MS drop=N "
               "doubled=N",
    .is_live = true,
    .open = simulated_open,
};
