/* Queues between the frame loop and a network thread. */
#include "publish/inside.h"

#include <stdio.h>
#include <string.h>

rlf_result publish_channel_init(publish_channel *c)
{
    pthread_mutex_init(&c->lock, NULL);
    c->reading = -1;
    c->moments = rlf_alloc(PUBLISH_SLOTS * sizeof c->moments[0]);
    return c->moments != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void publish_channel_free(publish_channel *c)
{
    rlf_free(c->moments);
    c->moments = NULL;
    pthread_mutex_destroy(&c->lock);
}

/* ---- frames ---------------------------------------------------------------------------------- */

static bool is_waiting(const publish_channel *c, int32_t slot)
{
    for (int32_t i = 0; i < c->waiting_count; i++) {
        if (c->waiting[i] == slot) {
            return true;
        }
    }
    return false;
}

static int32_t pop_waiting(publish_channel *c)
{
    const int32_t slot = c->waiting[0];
    c->waiting_count--;
    memmove(c->waiting, c->waiting + 1, (size_t)c->waiting_count * sizeof c->waiting[0]);
    return slot;
}

/* A slot that nobody looks at: the oldest gives way to the newest. */
static int32_t reserve(publish_channel *c)
{
    for (int32_t i = 0; i < PUBLISH_SLOTS; i++) {
        if (i != c->reading && !is_waiting(c, i)) {
            return i;
        }
    }
    c->counts.dropped++;
    return pop_waiting(c);
}

void publish_channel_add(publish_channel *c, const rlf_pipeline_output *frame)
{
    const bool is_whole = c->frame++ % c->address.every == 0;
    pthread_mutex_lock(&c->lock);
    const int32_t slot = reserve(c);
    pthread_mutex_unlock(&c->lock);
    if (!publish_moment_fill(&c->moments[slot], frame, is_whole)) {
        return; /* the slot is as free as before */
    }
    pthread_mutex_lock(&c->lock);
    c->waiting[c->waiting_count++] = slot;
    pthread_mutex_unlock(&c->lock);
}

const publish_moment *publish_channel_next(publish_channel *c)
{
    pthread_mutex_lock(&c->lock);
    c->reading = c->waiting_count > 0 ? pop_waiting(c) : -1;
    const int32_t slot = c->reading;
    pthread_mutex_unlock(&c->lock);
    return slot >= 0 ? &c->moments[slot] : NULL;
}

/* ---- commands and answers -------------------------------------------------------------------- */

bool publish_channel_command(publish_channel *c, publish_command *command,
                             char error[PUBLISH_ERROR_SIZE])
{
    if (command->verb == PUBLISH_SCENE) { /* read here: the frame loop would wait for the disk */
        command->scene = publish_scenes_find(c->scenes, command->name, error);
        if (command->scene == NULL) {
            return false;
        }
    }
    pthread_mutex_lock(&c->lock);
    const bool has_room = c->command_count < PUBLISH_COMMANDS;
    if (has_room) {
        c->commands[c->command_count++] = *command;
    }
    pthread_mutex_unlock(&c->lock);
    if (!has_room) {
        (void)snprintf(error, PUBLISH_ERROR_SIZE, "more than %d commands in one frame",
                       PUBLISH_COMMANDS);
    }
    return has_room;
}

int32_t publish_channel_take(publish_channel *c, publish_command out[PUBLISH_COMMANDS])
{
    pthread_mutex_lock(&c->lock);
    const int32_t count = c->command_count;
    memcpy(out, c->commands, (size_t)count * sizeof out[0]);
    c->command_count = 0;
    pthread_mutex_unlock(&c->lock);
    return count;
}

void publish_channel_answer(publish_channel *c, const publish_command *to, bool is_error,
                            const char *words)
{
    pthread_mutex_lock(&c->lock);
    if (c->answer_count < PUBLISH_ANSWERS) {
        publish_answer *a = &c->answers[c->answer_count++];
        a->client = to->client;
        a->is_error = is_error;
        (void)snprintf(a->words, sizeof a->words, "%.250s", words);
    }
    c->counts.done += is_error ? 0 : 1;
    c->counts.refused += is_error ? 1 : 0;
    pthread_mutex_unlock(&c->lock);
}

int32_t publish_channel_take_answers(publish_channel *c, publish_answer out[PUBLISH_ANSWERS])
{
    pthread_mutex_lock(&c->lock);
    const int32_t count = c->answer_count;
    memcpy(out, c->answers, (size_t)count * sizeof out[0]);
    c->answer_count = 0;
    pthread_mutex_unlock(&c->lock);
    return count;
}

/* ---- figures --------------------------------------------------------------------------------- */

void publish_channel_count(publish_channel *c, uint64_t frames, uint64_t dropped, int32_t clients)
{
    pthread_mutex_lock(&c->lock);
    c->counts.frames += frames;
    c->counts.dropped += dropped;
    c->counts.clients = clients > c->counts.clients ? clients : c->counts.clients;
    pthread_mutex_unlock(&c->lock);
}

void publish_channel_refused(publish_channel *c)
{
    pthread_mutex_lock(&c->lock);
    c->counts.refused++;
    pthread_mutex_unlock(&c->lock);
}
