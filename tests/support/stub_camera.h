/* What the stub driver libraries have in common: a synthetic scene whose every pixel a test can
 * foretell, and the faults of real cameras at chosen moments. */
#ifndef RLF_TEST_STUB_CAMERA_H
#define RLF_TEST_STUB_CAMERA_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

/* Numbers of waits count from 1; 0 = never. */
typedef struct stub_fault {
    int devices; /* that are plugged in */
    bool open_fails, start_fails;
    bool is_paced;             /* pictures come at their rate, else at once */
    int unplug_at;             /* from this wait on the camera is gone */
    int returns_after;         /* looks for the camera that is gone, until it is back; 0 = never */
    int stall_at, stall_count; /* waits in which nothing comes */
    int drop_at, drop_count;   /* pictures lost before this wait */
    int double_at;             /* the last picture comes again */
    int restart_at;            /* count and clock begin anew */
    int no_color_at;
    int damage_at;       /* the colour picture is not whole */
    int damage_depth_at; /* nor is the depth picture */
    int hang_at, hang_ms;
    /* Written by the stub. */
    int objects; /* that the user has and must give back */
    int waits;
} stub_fault;

typedef enum stub_event { STUB_FRAME, STUB_NONE, STUB_GONE } stub_event;

/* Pictures of one stream: the first has number 1 and comes at 1 s of the device's time. */
typedef struct stub_stream {
    uint64_t number;
    int64_t time_us;
} stub_stream;

#define STUB_INTERVAL_US 33333
#define STUB_COLOR_LATE_US 4000

static inline void stub_sleep_ms(int ms)
{
    struct timespec t = {ms / 1000, (long)(ms % 1000) * 1000000};
    nanosleep(&t, NULL);
}

static inline stub_event stub_wait(stub_fault *f, stub_stream *s, int timeout_ms)
{
    const int wait = ++f->waits;
    if (f->unplug_at > 0 && wait >= f->unplug_at) {
        return STUB_GONE;
    }
    if (wait == f->hang_at) {
        stub_sleep_ms(f->hang_ms);
        return STUB_NONE;
    }
    if (f->stall_at > 0 && wait >= f->stall_at && wait < f->stall_at + f->stall_count) {
        stub_sleep_ms(timeout_ms);
        return STUB_NONE;
    }
    if (f->is_paced) {
        stub_sleep_ms(STUB_INTERVAL_US / 1000);
    }
    if (wait == f->double_at && s->number > 0) {
        return STUB_FRAME;
    }
    if (wait == f->restart_at) {
        s->number = 0;
    }
    s->number += 1 + (uint64_t)(wait == f->drop_at ? f->drop_count : 0);
    s->time_us = 1000000 + (int64_t)(s->number - 1) * STUB_INTERVAL_US;
    return STUB_FRAME;
}

static inline uint16_t stub_depth_mm(int u, int v, uint64_t number)
{
    return (uint16_t)((u + v) % 97 == 0 ? 0 : 800 + u + 2 * v + (int)(number % 10));
}

static inline void stub_color(int u, int v, uint64_t number, uint8_t out_rgb[3])
{
    out_rgb[0] = (uint8_t)(u & 255);
    out_rgb[1] = (uint8_t)(v & 255);
    out_rgb[2] = (uint8_t)(number * 16 & 255);
}

/* Defaults: one camera without faults, paced. */
#define STUB_FAULT_NONE ((stub_fault){.devices = 1, .is_paced = true})

#endif
