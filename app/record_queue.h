/* Frames that wait to be written. */
#ifndef RELIEF_APP_RECORD_QUEUE_H
#define RELIEF_APP_RECORD_QUEUE_H

#include "relief/pipeline.h"

#include <pthread.h>

#define RECORD_QUEUE_MAX 60
#define RECORD_QUEUE_BYTES ((size_t)256 << 20) /* of the frames that may wait */

/* A frame, or the bodies at its time. */
typedef struct record_item {
    bool is_bodies;
    rlf_frame frame; /* its planes are the item's */
    void *depth;
    uint8_t *color;
    rlf_snapshot snapshot;
    rlf_body_state *bodies;
    int32_t body_capacity;
} record_item;

/* One thread fills, one empties. */
typedef struct record_queue {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    rlf_rig rig;
    record_item items[RECORD_QUEUE_MAX];
    int32_t waiting[RECORD_QUEUE_MAX]; /* a ring of items */
    int32_t idle[RECORD_QUEUE_MAX];    /* a stack of the others: what was used last is used first,
                                          so that memory is touched only when the queue is long */
    int32_t capacity, first, count, idle_count;
    int32_t reserved; /* the item being filled; -1 = none */
    bool is_closed;
} record_queue;

void record_queue_init(record_queue *queue, const rlf_rig *rig);
void record_queue_free(record_queue *queue);

/* An item to fill, or NULL: there is no room, and `waits` is false, or the queue is closed. Then
 * record_queue_push makes it the last. */
record_item *record_queue_reserve(record_queue *queue, bool waits);
void record_queue_push(record_queue *queue);
/* The oldest item, waiting for one; NULL once the queue is closed and empty. It stays in its place
 * until record_queue_pop. */
record_item *record_queue_front(record_queue *queue);
void record_queue_pop(record_queue *queue);
/* Nothing more comes in. */
void record_queue_close(record_queue *queue);
/* Waits until the queue is empty, at most until that time of rlf_clock_ns; returns how many items
 * there are still. */
int32_t record_queue_drain(record_queue *queue, int64_t until_ns);

/* Copies into an item; false when memory is short or the planes are not what the rig says. */
bool record_item_set_frame(record_item *item, const rlf_rig *rig, const rlf_frame *frame);
bool record_item_set_bodies(record_item *item, int64_t time_ns, const rlf_snapshot *snapshot);

#endif
