/* Frames that wait to be written. */
#define _POSIX_C_SOURCE 200809L
#include "record_queue.h"

#include <string.h>
#include <time.h>

#define NS_PER_S INT64_C(1000000000)

void record_queue_init(record_queue *queue, const rlf_rig *rig)
{
    memset(queue, 0, sizeof(*queue));
    pthread_mutex_init(&queue->lock, NULL);
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC); /* rlf_clock_ns's */
    pthread_cond_init(&queue->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    queue->rig = *rig;
    const size_t depth = (size_t)rig->depth.width * (size_t)rig->depth.height * 4;
    const size_t color =
        rig->has_color ? (size_t)rig->color.width * (size_t)rig->color.height * 4 : 0;
    const size_t fits = RECORD_QUEUE_BYTES / (depth + color + 1);
    queue->capacity = fits < 4 ? 4 : fits > RECORD_QUEUE_MAX ? RECORD_QUEUE_MAX : (int32_t)fits;
    queue->idle_count = queue->capacity;
    queue->reserved = -1;
    for (int32_t i = 0; i < queue->capacity; i++) {
        queue->idle[i] = i;
    }
}

void record_queue_free(record_queue *queue)
{
    for (int32_t i = 0; i < RECORD_QUEUE_MAX; i++) {
        rlf_free(queue->items[i].depth);
        rlf_free(queue->items[i].color);
        rlf_free(queue->items[i].bodies);
    }
    pthread_cond_destroy(&queue->changed);
    pthread_mutex_destroy(&queue->lock);
}

record_item *record_queue_reserve(record_queue *queue, bool waits)
{
    record_item *item = NULL;
    pthread_mutex_lock(&queue->lock);
    while (waits && !queue->is_closed && queue->reserved < 0 && queue->idle_count == 0) {
        pthread_cond_wait(&queue->changed, &queue->lock);
    }
    if (queue->reserved < 0 && queue->idle_count > 0) {
        queue->reserved = queue->idle[--queue->idle_count];
    }
    if (!queue->is_closed && queue->reserved >= 0) {
        item = &queue->items[queue->reserved];
    }
    pthread_mutex_unlock(&queue->lock);
    return item;
}

void record_queue_push(record_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->waiting[(queue->first + queue->count++) % queue->capacity] = queue->reserved;
    queue->reserved = -1;
    pthread_cond_broadcast(&queue->changed);
    pthread_mutex_unlock(&queue->lock);
}

record_item *record_queue_front(record_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    while (queue->count == 0 && !queue->is_closed) {
        pthread_cond_wait(&queue->changed, &queue->lock);
    }
    record_item *item = queue->count > 0 ? &queue->items[queue->waiting[queue->first]] : NULL;
    pthread_mutex_unlock(&queue->lock);
    return item;
}

void record_queue_pop(record_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->idle[queue->idle_count++] = queue->waiting[queue->first];
    queue->first = (queue->first + 1) % queue->capacity;
    queue->count--;
    pthread_cond_broadcast(&queue->changed);
    pthread_mutex_unlock(&queue->lock);
}

void record_queue_close(record_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->is_closed = true;
    pthread_cond_broadcast(&queue->changed);
    pthread_mutex_unlock(&queue->lock);
}

int32_t record_queue_drain(record_queue *queue, int64_t until_ns)
{
    const struct timespec until = {.tv_sec = (time_t)(until_ns / NS_PER_S),
                                   .tv_nsec = (long)(until_ns % NS_PER_S)};
    pthread_mutex_lock(&queue->lock);
    while (queue->count > 0 && rlf_clock_ns() < until_ns) {
        pthread_cond_timedwait(&queue->changed, &queue->lock, &until);
    }
    const int32_t count = queue->count;
    pthread_mutex_unlock(&queue->lock);
    return count;
}

static void copy_rows(void *to, const void *from, ptrdiff_t stride, size_t row, int32_t height)
{
    if ((size_t)stride == row) {
        memcpy(to, from, row * (size_t)height);
        return;
    }
    for (int32_t y = 0; y < height; y++) {
        memcpy((char *)to + (size_t)y * row, (const char *)from + (ptrdiff_t)y * stride, row);
    }
}

static bool copy_color(record_item *item, const rlf_rig *rig, const rlf_image_rgba8 *color)
{
    const size_t row = (size_t)color->width * 4;
    if (color->width != rig->color.width || color->height != rig->color.height) {
        return false;
    }
    if (item->color == NULL) {
        item->color = rlf_alloc_array((size_t)color->height, row);
    }
    if (item->color != NULL) {
        copy_rows(item->color, color->data, color->stride, row, color->height);
        item->frame.color.data = item->color;
        item->frame.color.stride = (ptrdiff_t)row;
    }
    return item->color != NULL;
}

bool record_item_set_frame(record_item *item, const rlf_rig *rig, const rlf_frame *frame)
{
    const bool is_float = frame->depth_f32 != NULL;
    const size_t row = (size_t)rig->depth.width * (is_float ? 4 : 2);
    if (item->depth == NULL) {
        item->depth = rlf_alloc_array((size_t)rig->depth.width * (size_t)rig->depth.height, 4);
    }
    if (item->depth == NULL) {
        return false;
    }
    item->is_bodies = false;
    item->frame = *frame;
    item->frame.rig = rig;
    item->frame.confidence = NULL;
    copy_rows(item->depth, is_float ? (const void *)frame->depth_f32 : frame->depth_u16,
              frame->depth_stride, row, rig->depth.height);
    item->frame.depth_f32 = is_float ? item->depth : NULL;
    item->frame.depth_u16 = is_float ? NULL : item->depth;
    item->frame.depth_stride = (ptrdiff_t)row;
    return !rig->has_color || frame->color.data == NULL || copy_color(item, rig, &frame->color);
}

bool record_item_set_bodies(record_item *item, int64_t time_ns, const rlf_snapshot *snapshot)
{
    const int32_t count = snapshot->body_count;
    if (count > item->body_capacity) {
        rlf_free(item->bodies);
        item->bodies = rlf_alloc_array((size_t)count * 2, sizeof(item->bodies[0]));
        item->body_capacity = item->bodies != NULL ? count * 2 : 0;
    }
    if (item->body_capacity < count || count == 0) {
        return false;
    }
    memcpy(item->bodies, snapshot->bodies, (size_t)count * sizeof(item->bodies[0]));
    item->is_bodies = true;
    item->frame.time_ns = time_ns;
    item->snapshot = (rlf_snapshot){.bodies = item->bodies, .body_count = count};
    return true;
}
