/* WebSocket: a server for programs on this machine, each message a JSON object. */
#define _POSIX_C_SOURCE 200809L
#include "publish/inside.h"

#include <libwebsockets.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#define CLIENTS_MAX 16
#define TEXTS 8      /* frames that a client may be behind before it loses some */
#define ANSWERS 16   /* that wait for a client */
#define FILES_MAX 64 /* sockets, those of clients that have not yet said hello included */
#define HELLO_S 5    /* for a client to say what it wants */
#define PING_S 10    /* of silence, before it is asked whether it is there */
#define HANGUP_S 30
#define END_NS INT64_C(500000000) /* for what is left when the run ends */

typedef struct client {
    struct lws *wsi; /* NULL = free */
    uint64_t number; /* never used again */
    uint64_t next;   /* the frame that it gets next */
    bool is_greeted, is_flooding;
    int32_t taken; /* commands since the last frame */
    char in[PUBLISH_TEXT_MAX];
    size_t in_length;
    publish_answer answers[ANSWERS];
    int32_t answer_count;
} client;

typedef struct server {
    publish_channel *channel;
    struct lws_context *context;
    publish_text texts[TEXTS]; /* frame n is in n % TEXTS */
    uint64_t end;              /* number of frames so far */
    publish_text answer;
    client clients[CLIENTS_MAX];
    int32_t client_count;
    uint64_t next_number;
    bool is_ending;
} server;

/* ---- clients --------------------------------------------------------------------------------- */

static client *client_of(server *s, const struct lws *wsi)
{
    for (int i = 0; i < CLIENTS_MAX; i++) {
        if (s->clients[i].wsi == wsi) {
            return &s->clients[i];
        }
    }
    return NULL;
}

static int add_client(server *s, struct lws *wsi)
{
    client *c = client_of(s, NULL);
    if (c == NULL) {
        return -1;
    }
    memset(c, 0, sizeof *c);
    c->wsi = wsi;
    c->number = ++s->next_number;
    c->next = s->end;
    s->client_count++;
    publish_channel_count(s->channel, 0, 0, s->client_count);
    lws_callback_on_writable(wsi);
    return 0;
}

static void remove_client(server *s, const struct lws *wsi)
{
    client *c = client_of(s, wsi);
    if (c != NULL) {
        c->wsi = NULL;
        s->client_count--;
    }
}

/* What has no room is lost: who asks so much does not read. */
static void answer(client *c, bool is_error, const char *words)
{
    if (c->answer_count < ANSWERS) {
        publish_answer *a = &c->answers[c->answer_count++];
        a->is_error = is_error;
        (void)snprintf(a->words, sizeof a->words, "%s", words);
    }
    lws_callback_on_writable(c->wsi);
}

/* Before the upgrade: who comes from a web page of somebody else, or is one too many. */
static int filter(const server *s, struct lws *wsi)
{
    char origin[256] = "";
    const int length = lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN);
    if (length > 0 && lws_hdr_copy(wsi, origin, sizeof origin, WSI_TOKEN_ORIGIN) < 0) {
        return -1;
    }
    if (!publish_origin_is_right(origin, s->channel->address.origin)) {
        publish_channel_refused(s->channel);
        return -1;
    }
    return s->client_count < CLIENTS_MAX && !s->is_ending ? 0 : -1;
}

/* ---- out ------------------------------------------------------------------------------------- */

static void take_moments(server *s)
{
    const publish_moment *m;
    while ((m = publish_channel_next(s->channel)) != NULL) {
        publish_text *t = &s->texts[s->end % TEXTS];
        if (s->client_count == 0) {
            continue;
        }
        publish_text_begin(t, LWS_PRE);
        publish_json_moment(t, m);
        s->end += t->has_failed ? 0 : 1;
    }
}

static void take_answers(server *s)
{
    publish_answer answers[PUBLISH_ANSWERS];
    const int32_t count = publish_channel_take_answers(s->channel, answers);
    for (int32_t i = 0; i < count; i++) {
        for (int k = 0; k < CLIENTS_MAX; k++) {
            client *c = &s->clients[k];
            if (c->wsi != NULL && c->number == answers[i].client) {
                answer(c, answers[i].is_error, answers[i].words);
            }
        }
    }
}

/* A new frame, an answer, or the end. */
static void wake_clients(server *s)
{
    take_moments(s);
    take_answers(s);
    for (int i = 0; i < CLIENTS_MAX; i++) {
        client *c = &s->clients[i];
        if (c->wsi == NULL) {
            continue;
        }
        c->taken = 0;
        if (c->is_flooding) {
            c->is_flooding = false;
            (void)lws_rx_flow_control(c->wsi, 1);
        }
        lws_callback_on_writable(c->wsi);
    }
}

static int write_text(struct lws *wsi, const publish_text *t)
{
    unsigned char *text = (unsigned char *)t->data + t->before;
    return lws_write(wsi, text, t->length, LWS_WRITE_TEXT) < (int)t->length ? -1 : 0;
}

static int write_answer(server *s, client *c)
{
    publish_text_begin(&s->answer, LWS_PRE);
    if (!c->is_greeted) {
        c->is_greeted = true;
        publish_json_hello(&s->answer, &s->channel->rig, s->channel->source);
    } else {
        publish_json_answer(&s->answer, c->answers[0].is_error, c->answers[0].words);
        c->answer_count--;
        memmove(c->answers, c->answers + 1, (size_t)c->answer_count * sizeof c->answers[0]);
    }
    return s->answer.has_failed ? -1 : write_text(c->wsi, &s->answer);
}

static int write_frame(server *s, client *c)
{
    const uint64_t oldest = s->end > TEXTS ? s->end - TEXTS : 0;
    if (c->next < oldest) {
        publish_channel_count(s->channel, 0, oldest - c->next, 0);
        c->next = oldest;
    }
    publish_channel_count(s->channel, 1, 0, 0);
    return write_text(c->wsi, &s->texts[c->next++ % TEXTS]);
}

static int write_next(server *s, struct lws *wsi)
{
    client *c = client_of(s, wsi);
    int status = 0;
    if (c == NULL) {
        return 0;
    }
    if (!c->is_greeted || c->answer_count > 0) {
        status = write_answer(s, c);
    } else if (c->next < s->end) {
        status = write_frame(s, c);
    } else if (s->is_ending) {
        lws_close_reason(wsi, LWS_CLOSE_STATUS_GOINGAWAY, NULL, 0);
        return -1;
    }
    if (c->answer_count > 0 || c->next < s->end || s->is_ending) {
        lws_callback_on_writable(wsi);
    }
    return status;
}

/* ---- in -------------------------------------------------------------------------------------- */

static void take_command(server *s, client *c)
{
    char error[PUBLISH_ERROR_SIZE];
    publish_command command;
    const bool is_read = publish_command_from_json(c->in, c->in_length, &command, error);
    command.client = c->number;
    c->in_length = 0;
    if (is_read && command.verb == PUBLISH_HELLO) {
        c->is_greeted = false;
        lws_callback_on_writable(c->wsi);
    } else if (!is_read || !publish_channel_command(s->channel, &command, error)) {
        publish_channel_refused(s->channel);
        answer(c, true, error);
    }
    if (++c->taken >= PUBLISH_COMMANDS) { /* the rest waits for the next frame */
        c->is_flooding = true;
        (void)lws_rx_flow_control(c->wsi, 0);
    }
}

static int receive(server *s, struct lws *wsi, const void *bytes, size_t length)
{
    client *c = client_of(s, wsi);
    if (c == NULL) {
        return 0;
    }
    if (length > sizeof c->in - c->in_length || lws_frame_is_binary(wsi)) {
        publish_channel_refused(s->channel);
        lws_close_reason(wsi, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE, NULL, 0);
        return -1;
    }
    memcpy(c->in + c->in_length, bytes, length);
    c->in_length += length;
    if (lws_is_final_fragment(wsi) && lws_remaining_packet_payload(wsi) == 0) {
        take_command(s, c);
    }
    return 0;
}

static int on_event(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                    size_t length)
{
    server *s = lws_context_user(lws_get_context(wsi));
    (void)user;
    switch ((int)reason) {
    case LWS_CALLBACK_HTTP: return lws_return_http_status(wsi, HTTP_STATUS_NOT_FOUND, NULL) | 1;
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION: return filter(s, wsi);
    case LWS_CALLBACK_ESTABLISHED: return add_client(s, wsi);
    case LWS_CALLBACK_CLOSED: remove_client(s, wsi); return 0;
    case LWS_CALLBACK_RECEIVE: return receive(s, wsi, in, length);
    case LWS_CALLBACK_SERVER_WRITEABLE: return write_next(s, wsi);
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED: wake_clients(s); return 0;
    default: return 0;
    }
}

/* ---- the server ------------------------------------------------------------------------------ */

static void websocket_close(publish_channel *c)
{
    server *s = c->net;
    if (s->context != NULL) {
        lws_context_destroy(s->context);
    }
    for (int i = 0; i < TEXTS; i++) {
        publish_text_free(&s->texts[i]);
    }
    publish_text_free(&s->answer);
    rlf_free(s);
    c->net = NULL;
}

/* The library's own answer to a broken pipe is for the whole program: the program's is kept. */
static struct lws_context *create_context(server *s)
{
    static const struct lws_protocols protocols[] = {
        {.name = "relief", .callback = on_event, .rx_buffer_size = PUBLISH_TEXT_MAX}, {0}};
    static const lws_retry_bo_t alive = {.secs_since_valid_ping = PING_S,
                                         .secs_since_valid_hangup = HANGUP_S};
    const publish_address *a = &s->channel->address;
    struct sigaction before;
    const struct lws_context_creation_info info = {
        .port = a->port,
        .iface = a->host,
        .protocols = protocols,
        .user = s,
        .gid = (gid_t)-1,
        .uid = (uid_t)-1,
        .timeout_secs = HELLO_S,
        .fd_limit_per_thread = FILES_MAX,
        .retry_and_idle_policy = &alive,
        .vhost_name = "relief",
        .options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND | LWS_SERVER_OPTION_DISABLE_IPV6 |
                   LWS_SERVER_OPTION_EXPLICIT_VHOSTS};
    (void)sigaction(SIGPIPE, NULL, &before);
    lws_set_log_level(0, NULL);
    struct lws_context *context = lws_create_context(&info);
    struct lws_vhost *vhost = context != NULL ? lws_create_vhost(context, &info) : NULL;
    (void)sigaction(SIGPIPE, &before, NULL);
    if (vhost == NULL && context != NULL) {
        lws_context_destroy(context);
        context = NULL;
    }
    s->channel->address.port = vhost != NULL ? lws_get_vhost_listen_port(vhost) : a->port;
    return context;
}

static rlf_result websocket_open(publish_channel *c)
{
    server *s = rlf_alloc(sizeof *s);
    if (s == NULL) {
        return RLF_ERROR_MEMORY;
    }
    s->channel = c;
    c->net = s;
    s->context = create_context(s);
    if (s->context == NULL) {
        websocket_close(c);
        return rlf_fail(RLF_ERROR_DEVICE,
                        "--publish: nothing can listen at %s:%d: another program has the port, or "
                        "the address is none of this machine's; choose another, or ws:0 for a free "
                        "port",
                        c->address.host, (int)c->address.port);
    }
    return RLF_OK;
}

static void websocket_run(publish_channel *c)
{
    server *s = c->net;
    while (!c->is_ending) {
        (void)lws_service(s->context, 0);
    }
    s->is_ending = true;
    wake_clients(s);
    const int64_t until_ns = rlf_clock_ns() + END_NS;
    while (s->client_count > 0 && rlf_clock_ns() < until_ns) {
        lws_cancel_service(s->context); /* so that it looks at the clock */
        (void)lws_service(s->context, 0);
    }
}

static void websocket_wake(publish_channel *c)
{
    lws_cancel_service(((server *)c->net)->context);
}

const publish_net publish_websocket = {websocket_open, websocket_run, websocket_wake,
                                       websocket_close};
