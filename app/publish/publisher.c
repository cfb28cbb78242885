/* The frame loop's side: what goes out, what comes in, and the lines for the user. */
#define _POSIX_C_SOURCE 200809L
#include "publish/publish.h"

#include "command.h"
#include "parts.h"
#include "publish/inside.h"

#include <signal.h>
#include <string.h>

/* That commands may have in the room at a time: more would slow the frames. */
#define BODIES_MAX 256

struct publisher {
    publish_channel channels[PUBLISH_MAX];
    int32_t count;
    rlf_ros2_publisher *ros2[PUBLISH_MAX];
    rlf_ros2_status ros2_status[PUBLISH_MAX]; /* at the end */
    int32_t ros2_count;
    publish_scenes *scenes;
    publish_command taken[PUBLISH_COMMANDS];
    rlf_pose T_world_camera; /* of the last frame */
    const rlf_world *world;  /* whose bodies these are */
    uint64_t world_frame;
    rlf_body_id made[BODIES_MAX];
    int32_t made_count;
};

static const publish_net *net_of(const publish_channel *c)
{
#ifdef RLF_HAVE_OSC
    if (c->address.is_osc) {
        return &publish_osc;
    }
#endif
#ifdef RLF_HAVE_WEBSOCKET
    if (!c->address.is_osc) {
        return &publish_websocket;
    }
#endif
    (void)c;
    return NULL;
}

/* ---- opening --------------------------------------------------------------------------------- */

static void *run_thread(void *context)
{
    publish_channel *c = context;
    net_of(c)->run(c);
    return NULL;
}

/* Ctrl-C is the frame loop's, and a client that goes away is no signal. */
static bool start_thread(publish_channel *c)
{
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    c->is_running = pthread_create(&c->thread, NULL, run_thread, c) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return c->is_running;
}

static bool is_loopback(const char *host)
{
    return strncmp(host, "127.", 4) == 0 || strcmp(host, "localhost") == 0;
}

/* Where it is, and who can see it. */
static void tell(const publish_channel *c)
{
    const publish_address *a = &c->address;
    if (!a->is_osc) {
        (void)fprintf(stderr, "relief run: events at ws://%s:%d\n", a->host, (int)a->port);
    } else if (a->listen_port < 0) {
        (void)fprintf(stderr, "relief run: events to osc://%s:%d\n", a->host, (int)a->port);
    } else {
        (void)fprintf(stderr, "relief run: events to osc://%s:%d, commands at osc://%s:%d\n",
                      a->host, (int)a->port, a->listen_host, (int)a->listen_port);
    }
    if (!is_loopback(a->host) || (a->listen_port >= 0 && !is_loopback(a->listen_host))) {
        rlf_log(RLF_LOG_WARNING, "--publish %s: others on the network can see it%s", a->host,
                a->is_osc && a->listen_port < 0 ? ""
                                                : ", and send commands: nothing asks who "
                                                  "they are");
    }
}

static rlf_result open_channel(publisher *p, const publish_address *address,
                               const rlf_source_info *info)
{
    publish_channel *c = &p->channels[p->count];
    c->address = *address;
    c->rig = info->rig;
    c->scenes = p->scenes;
    memcpy(c->source, info->name, sizeof c->source);
    const publish_net *net = net_of(c);
    if (net == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "--publish: this build has no %s: %s",
                        address->is_osc ? "OSC" : "WebSocket",
                        part_cure(address->is_osc ? PART_OSC : PART_WEBSOCKET));
    }
    rlf_result result = publish_channel_init(c);
    if (result == RLF_OK) {
        result = net->open(c);
    }
    if (result == RLF_OK && !start_thread(c)) {
        net->close(c);
        result = rlf_fail(RLF_ERROR_MEMORY, "--publish: no thread can be started: close something");
    }
    if (result != RLF_OK) {
        publish_channel_free(c);
        return result;
    }
    p->count++;
    tell(c);
    return RLF_OK;
}

static rlf_result open_ros2(publisher *p, const publish_address *address,
                            const rlf_source_info *info)
{
    rlf_result result = rlf_ros2_publisher_open(address->ros2, info, &p->ros2[p->ros2_count]);
    if (result == RLF_OK) {
        p->ros2_count++;
        (void)fprintf(stderr, "relief run: topics below %s\n", address->ros2);
    }
    return result;
}

rlf_result publisher_open(const publish_list *list, const rlf_source_info *info,
                          const char *scene_path, publisher **out)
{
    *out = NULL;
    if (list->count == 0) {
        return RLF_OK;
    }
    publisher *p = rlf_alloc(sizeof *p);
    if (p == NULL) {
        return RLF_ERROR_MEMORY;
    }
    p->T_world_camera = rlf_pose_identity();
    rlf_result result = publish_scenes_create(scene_path, &p->scenes);
    for (int32_t i = 0; i < list->count && result == RLF_OK; i++) {
        const publish_address *a = &list->items[i];
        result = a->ros2[0] != '\0' ? open_ros2(p, a, info) : open_channel(p, a, info);
    }
    if (result != RLF_OK) {
        publisher_end(p);
        publisher_destroy(&p);
        return result;
    }
    *out = p;
    return RLF_OK;
}

void publisher_end(publisher *p)
{
    for (int32_t i = 0; p != NULL && i < p->count; i++) {
        publish_channel *c = &p->channels[i];
        c->is_ending = true;
        net_of(c)->wake(c);
    }
    for (int32_t i = 0; p != NULL && i < p->count; i++) {
        publish_channel *c = &p->channels[i];
        if (c->is_running) {
            pthread_join(c->thread, NULL);
            c->is_running = false;
            net_of(c)->close(c);
        }
    }
    for (int32_t i = 0; p != NULL && i < p->ros2_count; i++) {
        if (p->ros2[i] != NULL) {
            p->ros2_status[i] = rlf_ros2_publisher_get_status(p->ros2[i]);
            rlf_ros2_publisher_close(&p->ros2[i]);
        }
    }
}

void publisher_destroy(publisher **publisher_pointer)
{
    publisher *p = *publisher_pointer;
    *publisher_pointer = NULL;
    if (p == NULL) {
        return;
    }
    for (int32_t i = 0; i < p->count; i++) {
        publish_channel_free(&p->channels[i]);
    }
    publish_scenes_destroy(&p->scenes);
    rlf_free(p);
}

void publisher_print_summary(publisher *p, FILE *file)
{
    for (int32_t i = 0; p != NULL && i < p->count; i++) {
        const publish_channel *c = &p->channels[i];
        const publish_counts *n = &c->counts;
        (void)fprintf(file,
                      "events:   %s: %llu messages, %llu dropped since somebody was too slow; "
                      "%llu commands done, %llu refused\n",
                      c->address.is_osc ? "osc" : "ws", (unsigned long long)n->frames,
                      (unsigned long long)n->dropped, (unsigned long long)n->done,
                      (unsigned long long)n->refused);
    }
    for (int32_t i = 0; p != NULL && i < p->ros2_count; i++) {
        const rlf_ros2_status *n = &p->ros2_status[i];
        (void)fprintf(file,
                      "ros2:     %llu frames published, %llu left out, %llu messages that a reader "
                      "was too slow for\n",
                      (unsigned long long)n->frames, (unsigned long long)n->dropped,
                      (unsigned long long)n->unsent);
    }
}

void publisher_frame(publisher *p, const rlf_pipeline_output *frame)
{
    for (int32_t i = 0; p != NULL && i < p->count; i++) {
        publish_channel_add(&p->channels[i], frame);
        net_of(&p->channels[i])->wake(&p->channels[i]);
    }
    for (int32_t i = 0; p != NULL && i < p->ros2_count; i++) {
        rlf_ros2_publisher_add(p->ros2[i], frame);
    }
    if (p != NULL) {
        p->T_world_camera = frame->T_world_camera;
    }
}

/* ---- commands -------------------------------------------------------------------------------- */

/* Another pipeline, or the same one from the start, has none of the bodies that were made. */
static void note_world(publisher *p, const rlf_world *world)
{
    const uint64_t frame = rlf_world_get_snapshot(world)->frame;
    if (world != p->world || frame < p->world_frame) {
        p->made_count = 0;
    }
    p->world = world;
    p->world_frame = frame;
}

/* Forgets those that are gone. */
static int32_t count_made(publisher *p, const rlf_world *world)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < p->made_count; i++) {
        if (rlf_world_has_body(world, p->made[i])) {
            p->made[kept++] = p->made[i];
        }
    }
    p->made_count = kept;
    return kept;
}

static rlf_result add_body(publisher *p, rlf_world *world, const publish_command *c)
{
    const rlf_pose *T = &p->T_world_camera;
    rlf_body_def body = c->body;
    if (count_made(p, world) == BODIES_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY, "%d bodies were made already: remove some", BODIES_MAX);
    }
    if (c->verb == PUBLISH_THROW) {
        body.position = rlf_transform(T, body.position);
        body.velocity = rlf_rotate(T->q, body.velocity);
        body.angular_velocity = rlf_rotate(T->q, body.angular_velocity);
    }
    const rlf_result result = rlf_world_add_body(world, &body, &p->made[p->made_count]);
    p->made_count += result == RLF_OK ? 1 : 0;
    return result;
}

/* All of that name, or all where it is NULL; their count. */
static int32_t remove_bodies(rlf_world *world, const char *name)
{
    int32_t removed = 0;
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    for (int32_t i = s->body_count - 1; i >= 0; i--) {
        if (name == NULL || strcmp(s->bodies[i].name, name) == 0) {
            rlf_world_remove_body(world, s->bodies[i].id);
            s = rlf_world_get_snapshot(world);
            removed++;
        }
    }
    return removed;
}

static rlf_result remove_named(rlf_world *world, const char *name)
{
    return remove_bodies(world, name) > 0
               ? RLF_OK
               : rlf_fail(RLF_ERROR_INVALID, "remove: there is no body '%s'", name);
}

/* Its bodies and its gravity in place of those that are there; what the camera has learnt stays. */
static rlf_result open_scene(rlf_world *world, const rlf_scene *scene)
{
    const double now_s = 1e-9 * (double)rlf_world_get_snapshot(world)->time_ns;
    rlf_result result = RLF_OK;
    (void)remove_bodies(world, NULL);
    if (scene->is_gravity_given) {
        (void)rlf_world_set_gravity(world, scene->gravity);
    }
    for (int32_t i = 0; i < scene->body_count && result == RLF_OK; i++) {
        rlf_body_def body = scene->bodies[i];
        body.release_time += body.release_time > 0.0 ? now_s : 0.0;
        result = rlf_world_add_body(world, &body, NULL);
    }
    return result;
}

/* One in a frame: each may have a thousand bodies. */
static rlf_result open_first_scene(rlf_world *world, const rlf_scene *scene, int32_t *opened)
{
    return (*opened)++ == 0 ? open_scene(world, scene)
                            : rlf_fail(RLF_ERROR_CAPACITY, "scene: one in a frame");
}

static rlf_result do_command(publisher *p, rlf_world *world, recorder *r, const publish_command *c,
                             int32_t *scenes)
{
    switch (c->verb) {
    case PUBLISH_SPAWN:
    case PUBLISH_THROW: return add_body(p, world, c);
    case PUBLISH_REMOVE: return remove_named(world, c->name);
    case PUBLISH_CLEAR: (void)remove_bodies(world, NULL); return RLF_OK;
    case PUBLISH_GRAVITY: (void)rlf_world_set_gravity(world, c->gravity); return RLF_OK;
    case PUBLISH_RECORD: return recorder_switch(r, c->is_on);
    case PUBLISH_SCENE: return open_first_scene(world, c->scene, scenes);
    case PUBLISH_HELLO:
    case PUBLISH_VERB_COUNT: break;
    }
    return RLF_OK;
}

void publisher_apply(publisher *p, rlf_pipeline *pipeline, recorder *r)
{
    if (p == NULL) {
        return;
    }
    rlf_world *world = rlf_pipeline_get_world(pipeline);
    note_world(p, world);
    recorder_settle(r);
    int32_t scenes = 0;
    for (int32_t i = 0; i < p->count; i++) {
        publish_channel *c = &p->channels[i];
        const int32_t count = publish_channel_take(c, p->taken);
        for (int32_t k = 0; k < count; k++) {
            const rlf_result result = do_command(p, world, r, &p->taken[k], &scenes);
            publish_channel_answer(c, &p->taken[k], result != RLF_OK,
                                   result == RLF_OK ? publish_verb_name(p->taken[k].verb)
                                                    : rlf_error_text());
        }
        if (count > 0) {
            net_of(c)->wake(c);
        }
    }
}
