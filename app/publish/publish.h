/* Events for other programs while a run goes on: contacts, gestures, poses and regions out; bodies,
 * gravity, scenes and recording in. By WebSocket (JSON) and by OSC; docs/events.md has the schema.
 * And pictures, depth and bodies by ROS 2, which takes no commands: docs/ros2.md.
 *
 * The frame loop copies what goes out and takes what came in, and waits for nobody: a thread for
 * each address does the rest. Who reads too slowly loses frames, which are counted. */
#ifndef RELIEF_APP_PUBLISH_PUBLISH_H
#define RELIEF_APP_PUBLISH_PUBLISH_H

#include "recorder.h"
#include "relief/pipeline.h"

#include <stdio.h>

#define PUBLISH_MAX 4 /* addresses of one run */
#define PUBLISH_HOST 64
#define PUBLISH_ROS2 320

typedef struct publish_address {
    bool is_osc;                    /* else WebSocket */
    char host[PUBLISH_HOST];        /* OSC: sent to; WebSocket: bound to */
    int32_t port;                   /* 0 = WebSocket chooses a free one */
    char listen_host[PUBLISH_HOST]; /* OSC: where commands arrive */
    int32_t listen_port;            /* -1 = OSC takes no commands; 0 = a free one */
    int32_t every;                  /* poses of every N-th frame; contacts and gestures always */
    const char *origin;             /* of one more web page that may connect; NULL = none */
    char ros2[PUBLISH_ROS2];        /* ROS 2: "ros2:/relief?profile=lan"; "" = another kind */
} publish_address;

typedef struct publish_list {
    publish_address items[PUBLISH_MAX];
    int32_t count;
} publish_list;

/* `take` of the option and of its keys, for the address given last. */
#define PUBLISH_CHOICES                                                                            \
    "give ws:PORT, osc:PORT, osc:HOST:PORT as in osc:192.168.1.7:9000, or ros2:/NAME; up to 4"
bool publish_take(const char *text, void *list);
bool publish_take_every(const char *text, void *list);
bool publish_take_listen(const char *text, void *list);
bool publish_take_origin(const char *text, void *list);
bool publish_take_profile(const char *text, void *list);
bool publish_take_domain(const char *text, void *list);

typedef struct publisher publisher;

/* Opens all addresses and tells where they are, and which of them others can reach. `scene_path`
 * may be NULL. RLF_ERROR_UNSUPPORTED where the build lacks the part, RLF_ERROR_DEVICE where a port
 * is taken. An empty list gives NULL, which all calls allow. */
rlf_result publisher_open(const publish_list *list, const rlf_source_info *info,
                          const char *scene_path, publisher **out);
/* One frame goes out. Allocates nothing and waits for nobody. */
void publisher_frame(publisher *p, const rlf_pipeline_output *frame);
/* Does what came in since the last call. Between two frames, as it changes the world. */
void publisher_apply(publisher *p, rlf_pipeline *pipeline, recorder *recorder);
/* Sends what is left, half a second at most, and closes the ports. */
void publisher_end(publisher *p);
/* A line for each address: what was sent, lost and refused. */
void publisher_print_summary(publisher *p, FILE *file);
/* After the pipeline, whose bodies borrow from its scenes. */
void publisher_destroy(publisher **p);

#endif
