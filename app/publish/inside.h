/* What the files of this folder share. Frame loop and network thread meet in publish_channel. */
#ifndef RELIEF_APP_PUBLISH_INSIDE_H
#define RELIEF_APP_PUBLISH_INSIDE_H

#include "publish/publish.h"

#include <pthread.h>

#define PUBLISH_VERSION 1      /* of the schema */
#define PUBLISH_TEXT_MAX 4096  /* bytes of a message that comes in */
#define PUBLISH_ERROR_SIZE 256 /* bytes of an answer */
#define PUBLISH_COMMANDS 64    /* that wait for the next frame, and that a client may send in one */

/* ---- what goes out --------------------------------------------------------------------------- */

#define PUBLISH_BODIES 1024 /* a world's default capacity */
#define PUBLISH_CONTACTS 256
#define PUBLISH_REGIONS 64

typedef struct publish_body {
    char name[RLF_NAME_MAX];
    rlf_pose T_world_body;
    rlf_vec3 velocity, angular_velocity;
    bool is_asleep, is_grabbed;
} publish_body;

/* The begin or the end of a touch; place and strength are those of its strongest point. */
typedef struct publish_contact {
    bool is_begin;
    char body[RLF_NAME_MAX], other[RLF_NAME_MAX]; /* names; other "" unless a body */
    const char *with;                             /* background, foreground, body or hand */
    int32_t region, hand;                         /* 0 = none */
    rlf_vec3 point, normal;                       /* 0 at the end of a touch */
    double impulse, speed;
} publish_contact;

typedef struct publish_region {
    int32_t id;
    rlf_aabb box; /* around its camera's box */
    rlf_vec3 centroid, velocity;
} publish_region;

/* One frame, in the world frame. */
typedef struct publish_moment {
    int64_t index, time_ns;
    double time_s;
    bool is_whole; /* else contacts and gestures alone */
    rlf_vec3 gravity;
    rlf_pose T_world_camera;
    int32_t body_count, contact_count, region_count, hand_count, gesture_count;
    int32_t left_out; /* bodies, contacts and regions that had no room */
    publish_body bodies[PUBLISH_BODIES];
    publish_contact contacts[PUBLISH_CONTACTS];
    publish_region regions[PUBLISH_REGIONS];
    rlf_hand hands[RLF_HANDS_MAX];
    rlf_hand_event gestures[RLF_HAND_EVENTS_MAX];
} publish_moment;

/* False when it has nothing to tell: neither whole nor any event. */
bool publish_moment_fill(publish_moment *m, const rlf_pipeline_output *frame, bool is_whole);
const char *publish_side_name(rlf_hand_side side);

/* A text that grows; the network thread's. */
typedef struct publish_text {
    char *data;
    size_t before;           /* bytes that are kept free before the text */
    size_t length, capacity; /* without and with those */
    bool has_failed;         /* out of memory: it is not whole */
} publish_text;

void publish_text_begin(publish_text *t, size_t before);
void publish_text_free(publish_text *t);
void publish_json_moment(publish_text *t, const publish_moment *m);
void publish_json_hello(publish_text *t, const rlf_rig *rig, const char *source);
/* {"type":"done"} or {"type":"error"}. */
void publish_json_answer(publish_text *t, bool is_error, const char *words);

/* ---- what comes in --------------------------------------------------------------------------- */

typedef enum publish_verb {
    PUBLISH_SPAWN = 0, /* a body, in the world frame */
    PUBLISH_THROW = 1, /* a body, in the camera's frame */
    PUBLISH_REMOVE = 2,
    PUBLISH_CLEAR = 3,
    PUBLISH_GRAVITY = 4,
    PUBLISH_RECORD = 5,
    PUBLISH_SCENE = 6,
    PUBLISH_HELLO = 7, /* answered by the network thread */
    PUBLISH_VERB_COUNT = 8
} publish_verb;

typedef struct publish_command {
    publish_verb verb;
    uint64_t client;         /* that gets the answer */
    rlf_body_def body;       /* spawn, throw; its look is its shape */
    rlf_vec3 gravity;        /* m/s^2 */
    bool is_on;              /* record */
    char name[RLF_NAME_MAX]; /* remove, scene */
    const rlf_scene *scene;  /* read by the network thread; the publisher's */
} publish_command;

const char *publish_verb_name(publish_verb verb);
/* A command with the defaults of its verb. False for a name that is none. */
bool publish_command_begin(const char *name, publish_command *out);
/* Shape of one size, an edge or a diameter, metres. False for an unknown name. */
bool publish_command_shape(publish_command *c, const char *shape, double size_m);
/* Fills in the mass where it is 0 (balsa) and checks that all numbers are finite and within their
 * bounds, and names short and printable. False with one line. */
bool publish_command_check(publish_command *c, char error[PUBLISH_ERROR_SIZE]);
/* Reads one message. False with one line that says what is wrong. */
bool publish_command_from_json(const char *text, size_t length, publish_command *out,
                               char error[PUBLISH_ERROR_SIZE]);
/* Calls `take` for the packet's message, or for each one of its bundle; `error` is NULL where the
 * message is a command. */
typedef void (*publish_take_fn)(void *context, publish_command *command, const char *error);
void publish_commands_from_osc(const void *packet, size_t size, publish_take_fn take,
                               void *context);
/* Packets of at most PUBLISH_PACKET bytes are given to `send`. */
#define PUBLISH_PACKET 1400 /* fits an Ethernet frame */
typedef void (*publish_send_fn)(void *context, const void *packet, size_t size);
void publish_osc_moment(const publish_moment *m, publish_send_fn send, void *context);
void publish_osc_hello(const rlf_rig *rig, const char *source, publish_send_fn send, void *context);
void publish_osc_answer(bool is_error, const char *words, publish_send_fn send, void *context);

/* ---- scenes by name -------------------------------------------------------------------------- */

typedef struct publish_scenes publish_scenes;

/* `scene_path` of the run; NULL = none. RLF_ERROR_MEMORY. */
rlf_result publish_scenes_create(const char *scene_path, publish_scenes **out);
/* The scene of that name: one that comes with Relief, or a file beside the run's own. Each is read
 * once and kept. NULL with one line. Thread-safety: any. */
const rlf_scene *publish_scenes_find(publish_scenes *s, const char *name,
                                     char error[PUBLISH_ERROR_SIZE]);
void publish_scenes_destroy(publish_scenes **s);

/* ---- where frame loop and network meet ------------------------------------------------------- */

#define PUBLISH_SLOTS 4 /* one is written, one is read, two wait */
#define PUBLISH_ANSWERS 64

typedef struct publish_answer {
    uint64_t client;
    bool is_error;
    char words[PUBLISH_ERROR_SIZE];
} publish_answer;

typedef struct publish_counts {
    uint64_t frames;        /* that went out, to whom ever */
    uint64_t dropped;       /* that a client, or the network thread, was too slow for */
    uint64_t done, refused; /* commands */
    int32_t clients;        /* WebSocket: most at a time */
} publish_counts;

typedef struct publish_channel {
    publish_address address;
    rlf_rig rig;
    char source[128];
    publish_scenes *scenes;
    int64_t frame;           /* the frame loop's own count */
    pthread_mutex_t lock;    /* of all that follows up to `counts`; held for a few copies */
    publish_moment *moments; /* PUBLISH_SLOTS */
    int32_t waiting[PUBLISH_SLOTS], waiting_count, reading; /* slots; reading -1 = none */
    publish_command commands[PUBLISH_COMMANDS];
    int32_t command_count;
    publish_answer answers[PUBLISH_ANSWERS];
    int32_t answer_count;
    publish_counts counts;
    _Atomic bool is_ending;
    bool is_running;
    pthread_t thread;
    void *net; /* WebSocket's or OSC's own */
} publish_channel;

rlf_result publish_channel_init(publish_channel *c);
void publish_channel_free(publish_channel *c);
/* The frame loop's side. */
void publish_channel_add(publish_channel *c, const rlf_pipeline_output *frame);
int32_t publish_channel_take(publish_channel *c, publish_command out[PUBLISH_COMMANDS]);
void publish_channel_answer(publish_channel *c, const publish_command *to, bool is_error,
                            const char *words);
/* The network's side. The oldest moment, which is its own until the next call; NULL = none. */
const publish_moment *publish_channel_next(publish_channel *c);
/* False, with one line, when too many wait. */
bool publish_channel_command(publish_channel *c, publish_command *command,
                             char error[PUBLISH_ERROR_SIZE]);
int32_t publish_channel_take_answers(publish_channel *c, publish_answer out[PUBLISH_ANSWERS]);
void publish_channel_count(publish_channel *c, uint64_t frames, uint64_t dropped, int32_t clients);
void publish_channel_refused(publish_channel *c);

/* ---- the two networks ------------------------------------------------------------------------ */

/* Opens and closes its ports; `run` is the thread, until is_ending; `wake` is called by the frame
 * loop. */
typedef struct publish_net {
    rlf_result (*open)(publish_channel *c);
    void (*run)(publish_channel *c);
    void (*wake)(publish_channel *c);
    void (*close)(publish_channel *c);
} publish_net;

#ifdef RLF_HAVE_WEBSOCKET
extern const publish_net publish_websocket;
#endif
#ifdef RLF_HAVE_OSC
extern const publish_net publish_osc;
#endif
/* An origin that a browser may connect from: this machine's own pages, or `origin`. Browsers give
 * "null" for pages of any site in a sandboxed frame, so that counts only where it is `origin`. */
bool publish_origin_is_right(const char *text, const char *origin);

#endif
