/* What a live source's reader and its capture thread share. */
#ifndef RLF_IO_LIVE_STATE_H
#define RLF_IO_LIVE_STATE_H

#include "io/live/address_copy.h"
#include "io/live/follow.h"
#include "io/live/slot.h"

#include <pthread.h>

#define LIVE_SECOND_NS INT64_C(1000000000)
/* Without a frame: something is wrong. A second, less what the threads take to notice. */
#define LIVE_SILENCE_NS (LIVE_SECOND_NS * 19 / 20)
#define LIVE_SLOTS 3 /* one being filled, the newest, one that the reader has */
#define LIVE_TEXT 512

typedef struct io_live {
    /* Constant once the thread runs. */
    const rlf_backend *backend;
    live_address address;
    char name[128];
    pthread_t thread;

    /* The capture thread's own. */
    rlf_opened device;
    live_follow follow;
    int32_t filled;          /* slot that it may write */
    int64_t device_frame_ns; /* when this connection's last frame came, or when it was opened */
    bool has_device_frame;

    /* Who is shown every frame; the lock is held while it is. */
    pthread_mutex_t observer_mutex;
    rlf_frame_fn observer;
    void *observer_context;

    /* Shared, guarded by the mutex; a slot belongs to who has its index. */
    pthread_mutex_t mutex;
    pthread_cond_t news;
    live_slot slots[LIVE_SLOTS];
    int32_t newest, given; /* the other two slots */
    bool has_newest;       /* the reader has not had it */
    bool is_described;     /* methods' info is known, the slots are there: constant from then on */
    rlf_source_info info;
    rlf_source_status counts; /* made here */
    rlf_source_status device_counts,
        past_counts; /* by this connection's driver, by earlier ones' */
    int64_t last_frame_ns;
    bool is_connected, is_told; /* told: that there are no frames */
    char refused[LIVE_TEXT];    /* why the last frame was not taken; "" = it was */
    bool is_stopping, is_done, is_abandoned;
    rlf_result outcome; /* RLF_OK while it runs; RLF_END or an error: it is over */
    char error[LIVE_TEXT];
} io_live;

/* state.c */
rlf_result live_create(const rlf_backend *backend, const rlf_address *address, io_live **out);
void live_free(io_live *live);
/* Adds late, doubled, unpaired and damaged frames. */
void live_add_counts(const rlf_source_status *from, rlf_source_status *sum);
/* Waits for news at most until this time; call with the mutex held. */
void live_wait(io_live *live, int64_t until_ns);
/* Says once that there are no frames, and why (NULL = none came for a second, or none that could be
 * taken); the next frame says that they are back. Call without the mutex. */
void live_tell_silence(io_live *live, const char *reason);
/* Ends the source: RLF_END, or an error with its line. */
void live_finish(io_live *live, rlf_result outcome, const char *line);

/* capture.c: the thread. It frees *live itself once it is abandoned. */
void *live_capture(void *live);

#endif
