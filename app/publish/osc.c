/* OSC over UDP. The sockets are ours: a library's own would listen to the whole network. */
#define _POSIX_C_SOURCE 200809L
#include "publish/inside.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

typedef struct osc {
    publish_channel *channel;
    int out, in; /* sockets; `in` -1 = no commands */
    int wake[2]; /* a pipe */
    struct sockaddr_in to;
    int32_t taken;  /* commands since the last frame */
    int32_t unsent; /* packets of this frame that the system had no room for */
} osc;

/* ---- opening --------------------------------------------------------------------------------- */

static rlf_result look_up(const char *host, int32_t port, struct sockaddr_in *out)
{
    const struct addrinfo hints = {.ai_family = AF_INET, .ai_socktype = SOCK_DGRAM};
    struct addrinfo *found = NULL;
    const int status = getaddrinfo(host, NULL, &hints, &found);
    if (status != 0 || found == NULL) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "--publish: '%s' is no host (%s): give its address, as "
                        "in osc:192.168.1.7:9000",
                        host, gai_strerror(status));
    }
    memcpy(out, found->ai_addr, sizeof *out);
    out->sin_port = htons((uint16_t)port);
    freeaddrinfo(found);
    return RLF_OK;
}

static rlf_result bind_commands(osc *o, publish_address *a)
{
    struct sockaddr_in at;
    socklen_t size = sizeof at;
    rlf_result result = look_up(a->listen_host, a->listen_port, &at);
    if (result != RLF_OK) {
        return result;
    }
    if (bind(o->in, (const struct sockaddr *)&at, sizeof at) != 0) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "--publish: commands cannot arrive at %s:%d (%s): choose "
                        "another port, or listen=0 for a free one",
                        a->listen_host, (int)a->listen_port, strerror(errno));
    }
    if (getsockname(o->in, (struct sockaddr *)&at, &size) == 0) {
        a->listen_port = ntohs(at.sin_port);
    }
    return RLF_OK;
}

static void free_osc(osc *o)
{
    const int files[4] = {o->out, o->in, o->wake[0], o->wake[1]};
    for (int i = 0; i < 4; i++) {
        if (files[i] >= 0) {
            (void)close(files[i]);
        }
    }
    rlf_free(o);
}

static void osc_close(publish_channel *c)
{
    free_osc(c->net);
    c->net = NULL;
}

/* Sockets that never wait. */
static bool open_files(osc *o, bool takes_commands)
{
    o->out = socket(AF_INET, SOCK_DGRAM, 0);
    o->in = takes_commands ? socket(AF_INET, SOCK_DGRAM, 0) : -1;
    if (o->out < 0 || (takes_commands && o->in < 0) || pipe(o->wake) != 0) {
        return false;
    }
    const int files[4] = {o->out, o->in, o->wake[0], o->wake[1]};
    for (int i = 0; i < 4; i++) {
        if (files[i] >= 0 && (fcntl(files[i], F_SETFL, O_NONBLOCK) != 0 ||
                              fcntl(files[i], F_SETFD, FD_CLOEXEC) != 0)) {
            return false;
        }
    }
    return true;
}

static rlf_result osc_open(publish_channel *c)
{
    publish_address *a = &c->address;
    osc *o = rlf_alloc(sizeof *o);
    if (o == NULL) {
        return RLF_ERROR_MEMORY;
    }
    *o = (osc){.channel = c, .out = -1, .in = -1, .wake = {-1, -1}};
    const bool takes_commands = a->listen_port >= 0;
    rlf_result result = look_up(a->host, a->port, &o->to);
    if (result == RLF_OK && !open_files(o, takes_commands)) {
        result = rlf_fail(RLF_ERROR_DEVICE, "--publish: no socket (%s)", strerror(errno));
    }
    if (result == RLF_OK && takes_commands) {
        result = bind_commands(o, a);
    }
    if (result != RLF_OK) {
        free_osc(o);
        return result;
    }
    c->net = o;
    return RLF_OK;
}

/* ---- the thread ------------------------------------------------------------------------------ */

static void send_packet(void *context, const void *packet, size_t size)
{
    osc *o = context;
    const ssize_t sent =
        sendto(o->out, packet, size, 0, (const struct sockaddr *)&o->to, sizeof o->to);
    o->unsent += sent < 0 ? 1 : 0;
}

static void send_moments(osc *o)
{
    const publish_moment *m;
    while ((m = publish_channel_next(o->channel)) != NULL) {
        o->unsent = 0;
        publish_osc_moment(m, send_packet, o);
        publish_channel_count(o->channel, o->unsent == 0, o->unsent > 0, 1);
    }
}

static void send_answers(osc *o)
{
    publish_answer answers[PUBLISH_ANSWERS];
    const int32_t count = publish_channel_take_answers(o->channel, answers);
    for (int32_t i = 0; i < count; i++) {
        publish_osc_answer(answers[i].is_error, answers[i].words, send_packet, o);
    }
}

static void refuse(osc *o, const char *error)
{
    publish_channel_refused(o->channel);
    publish_osc_answer(true, error, send_packet, o);
}

static void take_command(void *context, publish_command *command, const char *error)
{
    osc *o = context;
    char words[PUBLISH_ERROR_SIZE];
    o->taken++;
    if (error != NULL) {
        refuse(o, error);
    } else if (command->verb == PUBLISH_HELLO) {
        publish_osc_hello(&o->channel->rig, o->channel->source, send_packet, o);
    } else if (!publish_channel_command(o->channel, command, words)) {
        refuse(o, words);
    }
}

/* What a frame has no room for stays with the system, which drops what is too much for it. */
static void take_packets(osc *o)
{
    char packet[PUBLISH_TEXT_MAX + 1];
    while (o->in >= 0 && o->taken < PUBLISH_COMMANDS) {
        const ssize_t size = recv(o->in, packet, sizeof packet, 0);
        if (size < 0) {
            return;
        }
        publish_commands_from_osc(packet, (size_t)size, take_command, o);
    }
}

static void osc_run(publish_channel *c)
{
    osc *o = c->net;
    char bytes[64];
    publish_osc_hello(&c->rig, c->source, send_packet, o);
    while (!c->is_ending) {
        struct pollfd files[2] = {
            {.fd = o->wake[0], .events = POLLIN},
            {.fd = o->taken < PUBLISH_COMMANDS ? o->in : -1, .events = POLLIN}};
        (void)poll(files, 2, -1);
        if ((files[0].revents & POLLIN) != 0) {
            while (read(o->wake[0], bytes, sizeof bytes) > 0) {
            }
            o->taken = 0;
            send_moments(o);
            send_answers(o);
        }
        take_packets(o);
    }
    send_moments(o);
    send_answers(o);
}

/* A full pipe wakes as well. */
static void osc_wake(publish_channel *c)
{
    const osc *o = c->net;
    const ssize_t ignored = write(o->wake[1], "", 1);
    (void)ignored;
}

const publish_net publish_osc = {osc_open, osc_run, osc_wake, osc_close};
