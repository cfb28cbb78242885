/* Cameras made safe for a loop that must not stop. */
#ifndef RLF_IO_LIVE_LIVE_H
#define RLF_IO_LIVE_LIVE_H

#include "io/clip/clip.h"
#include "relief/backend.h"
#include "relief/frame.h"

#include <pthread.h>

/* A camera that frames come from by themselves, made safe for a loop that must not stop: captured
 * in a thread of its own, newest frame first, watched, and opened again when it was gone. */

/* Opens the back end's address in a new thread and waits for the first frame. The source gives
 * RLF_NO_FRAME after a twentieth of a second without one. All calls of the back end come from that
 * thread. */
rlf_result io_live_open(const rlf_backend *backend, const rlf_address *address, rlf_opened *out);

/* A camera whose every frame is given in its turn, none overtaken and nothing tried again, for
 * tests and measurements. */

/* Opens the back end's address in a new thread, which all its calls come from, so that a driver
 * that hangs later does not keep the program: next gives RLF_NO_FRAME meanwhile. */
rlf_result io_direct_open(const rlf_backend *backend, const rlf_address *address, rlf_opened *out);

/* ---- An address that lives longer than the call that gave it ---- */

typedef struct live_address {
    rlf_address address;
    rlf_rig rig;
    char *text; /* owned: all strings */
} live_address;

/* Times and counts of a camera's frames, kept going when its own clock or counter starts anew. */

typedef struct live_follow {
    bool has_last, is_connection_new;
    uint64_t device_sequence; /* of the last frame, as the device said */
    int64_t device_time_ns;
    int64_t host_ns;   /* when it came */
    uint64_t sequence; /* of the last frame, as given on */
    int64_t time_ns;
} live_follow;

/* The next frame comes from a device that was opened again. */
void live_follow_reconnect(live_follow *follow);

/* Sets the frame's count and times so that both go on from the last frame. False for a frame that
 * came twice. *out_lost: frames that the device made since the last one and nobody got. */
bool live_follow_frame(live_follow *follow, int64_t host_ns, rlf_frame *frame, uint64_t *out_lost);

/* ---- What a live source's reader and its capture thread share ---- */

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
    io_frame_copy slots[LIVE_SLOTS];
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
    /* Of a direct camera alone; the driver is the thread's between the two. */
    bool is_open, is_asked, is_answered;
    rlf_frame answer; /* with outcome and error */
} io_live;

/* state.c */
/* With the thread started, which frees it itself once it is abandoned. */
rlf_result live_create(const rlf_backend *backend, const rlf_address *address,
                       void *(*thread)(void *), io_live **out);
/* A source's `destroy`. A driver that does not come back keeps its thread. */
void live_destroy(void *live);
/* The same, with the error line that is left. */
rlf_result live_give_up(io_live *live, rlf_result result, const char *line);
/* What each thread ends with. */
void live_end_thread(io_live *live);
/* Adds late, doubled, unpaired and damaged frames. */
void live_add_counts(const rlf_source_status *from, rlf_source_status *sum);
/* Waits for news at most until this time; call with the mutex held. */
void live_wait(io_live *live, int64_t until_ns);
/* Says once that there are no frames, and why (NULL = none came for a second, or none that could be
 * taken); the next frame says that they are back. Call without the mutex. */
void live_tell_silence(io_live *live, const char *reason);
/* Ends the source: RLF_END, or an error with its line. */
void live_finish(io_live *live, rlf_result outcome, const char *line);

/* capture.c: the thread, and what it does with its device. */
void *live_capture(void *live);
/* Checks the cameras and makes the slots, for the first frame ever. */
rlf_result live_describe(io_live *live);
void live_close_device(io_live *live);

#endif
