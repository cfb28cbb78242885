/* What a file of messages holds: its topics, its messages in order, and chunks of it, unpacked. */
#include "io/ros/log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHANNELS_MAX 1024
#define MESSAGES_MAX (1 << 24) /* three days of a camera's pictures */

int32_t io_ros_log_find(const io_ros_log *log, uint32_t id)
{
    for (int32_t i = 0; i < log->channel_count; i++) {
        if (log->channels[i].id == id) {
            return i;
        }
    }
    return -1;
}

void io_ros_log_add_channel(io_ros_log *log, uint32_t id, io_ros_type type, const char *topic,
                            int32_t limit)
{
    if (io_ros_log_find(log, id) >= 0 || log->channel_count >= CHANNELS_MAX) {
        return;
    }
    if (io_list_grow((void **)(void *)&log->channels, log->channel_count, 1, &log->channel_room,
                     sizeof(log->channels[0])) != RLF_OK) {
        log->lacks_memory = true;
        return;
    }
    io_ros_channel *c = &log->channels[log->channel_count++];
    *c = (io_ros_channel){.id = id, .type = type, .limit = limit};
    snprintf(c->topic, sizeof(c->topic), "%s", topic);
}

void io_ros_log_add_message(io_ros_log *log, uint32_t id, int64_t time_ns, int32_t chunk,
                            uint64_t offset)
{
    const int32_t channel = io_ros_log_find(log, id);
    if (channel < 0 || log->channels[channel].count >= log->channels[channel].limit) {
        return;
    }
    if (log->message_count >= MESSAGES_MAX) {
        log->is_full = true;
        return;
    }
    if (io_list_grow((void **)(void *)&log->messages, log->message_count, 1, &log->message_room,
                     sizeof(log->messages[0])) != RLF_OK) {
        log->lacks_memory = true;
        return;
    }
    log->messages[log->message_count++] = (io_ros_message){time_ns, offset, chunk, channel};
    log->channels[channel].count++;
}

void io_ros_log_cut(io_ros_log *log, int32_t message_count)
{
    while (log->message_count > message_count) {
        log->channels[log->messages[--log->message_count].channel].count--;
    }
}

static int compare(const void *a, const void *b)
{
    const io_ros_message *x = a;
    const io_ros_message *y = b;
    if (x->channel != y->channel) {
        return x->channel < y->channel ? -1 : 1;
    }
    if (x->time_ns != y->time_ns) {
        return x->time_ns < y->time_ns ? -1 : 1;
    }
    if (x->chunk != y->chunk) {
        return x->chunk < y->chunk ? -1 : 1;
    }
    return (x->offset > y->offset) - (x->offset < y->offset);
}

rlf_result io_ros_log_sort(io_ros_log *log)
{
    if (log->is_full) {
        rlf_log(RLF_LOG_WARNING, "%s: has more than %d messages: the rest is left out", log->name,
                MESSAGES_MAX);
    }
    if (log->message_count > 0) {
        qsort(log->messages, (size_t)log->message_count, sizeof(log->messages[0]), compare);
    }
    for (int32_t i = log->message_count - 1; i >= 0; i--) {
        log->channels[log->messages[i].channel].first = i;
    }
    return log->lacks_memory
               ? rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory for its index", log->name)
               : RLF_OK;
}

void io_ros_log_free(io_ros_log *log)
{
    rlf_free(log->channels);
    rlf_free(log->messages);
    log->channels = NULL;
    log->messages = NULL;
    log->channel_count = log->message_count = 0;
}

/* ---- pictures that are not read: named, so that nobody looks for the fault elsewhere ----- */

bool io_ros_is_stranger(const char *type)
{
    static const char *const words[] = {"Image", "Disparity", "PointCloud", "RGBD",
                                        "Depth", "FFMPEG",    "Video",      "theora"};
    for (size_t i = 0; i < sizeof(words) / sizeof(words[0]); i++) {
        if (strstr(type, words[i]) != NULL) {
            return true;
        }
    }
    return false;
}

void io_ros_log_add_stranger(io_ros_log *log, const char *topic, const char *type,
                             const char *encoding)
{
    char text[256];
    const size_t size = sizeof(log->strangers), length = strlen(log->strangers);
    snprintf(text, sizeof(text), " %.120s (%.60s%s%.20s)", topic, type,
             encoding[0] != '\0' ? ", " : "", encoding);
    if (io_ros_is_stranger(type) && strstr(log->strangers, text) == NULL &&
        length + strlen(text) + 2 < size) {
        snprintf(log->strangers + length, size - length, "%s%s", length > 0 ? "," : "", text);
    }
}

/* ---- chunks --------------------------------------------------------------------------------- */

io_ros_unpacked *io_ros_cache_find(io_ros_cache *cache, int32_t chunk)
{
    io_ros_unpacked *found = &cache->slots[0];
    for (int i = 0; i < 2; i++) {
        io_ros_unpacked *slot = &cache->slots[i];
        if (slot->chunk1 == chunk + 1) {
            found = slot;
            break;
        }
        found = slot->used < found->used ? slot : found;
    }
    found->used = ++cache->clock;
    found->chunk1 = found->chunk1 == chunk + 1 ? found->chunk1 : 0;
    return found;
}

void io_ros_cache_free(io_ros_cache *cache)
{
    io_buffer_free(&cache->slots[0].bytes);
    io_buffer_free(&cache->slots[1].bytes);
}
