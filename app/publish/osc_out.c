/* A frame as OSC messages, in bundles that fit a packet. */
#include "publish/inside.h"

#include <lo/lo.h>
#include <stdlib.h>

/* A bundle that grows until it is sent; it owns its messages. */
typedef struct packer {
    lo_bundle bundle;
    int count;
    publish_send_fn send;
    void *context;
} packer;

static void flush(packer *p)
{
    if (p->bundle == NULL || p->count == 0) {
        return;
    }
    size_t size = 0;
    void *bytes = lo_bundle_serialise(p->bundle, NULL, &size);
    if (bytes != NULL) {
        p->send(p->context, bytes, size);
        free(bytes);
    }
    lo_bundle_free_recursive(p->bundle);
    p->bundle = NULL;
    p->count = 0;
}

static void add(packer *p, const char *path, lo_message message)
{
    if (message == NULL) {
        return;
    }
    const size_t length = lo_message_length(message, path) + 4;
    if (p->bundle != NULL && lo_bundle_length(p->bundle) + length > PUBLISH_PACKET) {
        flush(p);
    }
    if (p->bundle == NULL) {
        p->bundle = lo_bundle_new(LO_TT_IMMEDIATE);
    }
    if (p->bundle == NULL || lo_bundle_add_message(p->bundle, path, message) != 0) {
        lo_message_free(message);
        return;
    }
    p->count++;
}

static float finite(double x)
{
    return rlf_is_finite(x) ? (float)x : 0.0f;
}

static void put_vec3(lo_message m, rlf_vec3 v)
{
    lo_message_add_float(m, finite(v.x));
    lo_message_add_float(m, finite(v.y));
    lo_message_add_float(m, finite(v.z));
}

static void put_quat(lo_message m, rlf_quat q)
{
    put_vec3(m, rlf_vec3_make(q.x, q.y, q.z));
    lo_message_add_float(m, finite(q.w));
}

/* ---- messages -------------------------------------------------------------------------------- */

static lo_message of_frame(const publish_moment *m)
{
    lo_message out = lo_message_new();
    if (out != NULL) {
        lo_message_add_int32(out, (int32_t)m->index);
        lo_message_add_float(out, finite(m->time_s));
        put_vec3(out, m->gravity);
        put_vec3(out, m->T_world_camera.p);
        put_quat(out, m->T_world_camera.q);
    }
    return out;
}

static lo_message of_body(const publish_body *b)
{
    lo_message out = lo_message_new();
    if (out != NULL) {
        lo_message_add_string(out, b->name);
        put_vec3(out, b->T_world_body.p);
        put_quat(out, b->T_world_body.q);
        put_vec3(out, b->velocity);
        put_vec3(out, b->angular_velocity);
    }
    return out;
}

static lo_message of_contact(const publish_contact *c)
{
    lo_message out = lo_message_new();
    if (out != NULL) {
        lo_message_add_string(out, c->is_begin ? "begin" : "end");
        lo_message_add_string(out, c->body);
        lo_message_add_string(out, c->with);
        lo_message_add_string(out, c->other);
        lo_message_add_int32(out, c->region);
        lo_message_add_int32(out, c->hand);
        put_vec3(out, c->point);
        put_vec3(out, c->normal);
        lo_message_add_float(out, finite(c->impulse));
        lo_message_add_float(out, finite(c->speed));
    }
    return out;
}

static lo_message of_hand(const rlf_hand *h)
{
    lo_message out = lo_message_new();
    if (out != NULL) {
        lo_message_add_int32(out, h->id);
        lo_message_add_string(out, publish_side_name(h->side));
        lo_message_add_string(out, rlf_gesture_name(h->gesture));
        lo_message_add_float(out, finite(h->confidence));
        put_vec3(out, h->palm);
        put_vec3(out, h->velocity);
        put_vec3(out, h->normal);
        put_vec3(out, h->direction);
        lo_message_add_float(out, finite(h->pinch_width));
    }
    return out;
}

static lo_message of_gesture(const rlf_hand_event *e)
{
    lo_message out = lo_message_new();
    if (out != NULL) {
        lo_message_add_string(out, rlf_hand_event_name(e->kind));
        lo_message_add_int32(out, e->hand);
        put_vec3(out, e->position);
        put_vec3(out, e->direction);
        put_vec3(out, e->velocity);
    }
    return out;
}

static lo_message of_region(const publish_region *r)
{
    lo_message out = lo_message_new();
    if (out != NULL) {
        lo_message_add_int32(out, r->id);
        put_vec3(out, r->box.min);
        put_vec3(out, r->box.max);
        put_vec3(out, r->centroid);
        put_vec3(out, r->velocity);
    }
    return out;
}

void publish_osc_moment(const publish_moment *m, publish_send_fn send, void *context)
{
    packer p = {.send = send, .context = context};
    if (m->is_whole) {
        add(&p, "/relief/frame", of_frame(m));
    }
    for (int32_t i = 0; i < m->contact_count; i++) {
        add(&p, "/relief/contact", of_contact(&m->contacts[i]));
    }
    for (int32_t i = 0; i < m->gesture_count; i++) {
        add(&p, "/relief/gesture", of_gesture(&m->gestures[i]));
    }
    for (int32_t i = 0; i < m->body_count; i++) {
        add(&p, "/relief/body", of_body(&m->bodies[i]));
    }
    for (int32_t i = 0; i < m->hand_count; i++) {
        add(&p, "/relief/hand", of_hand(&m->hands[i]));
    }
    for (int32_t i = 0; i < m->region_count; i++) {
        add(&p, "/relief/region", of_region(&m->regions[i]));
    }
    flush(&p);
}

void publish_osc_hello(const rlf_rig *rig, const char *source, publish_send_fn send, void *context)
{
    packer p = {.send = send, .context = context};
    lo_message out = lo_message_new();
    if (out != NULL) {
        lo_message_add_int32(out, PUBLISH_VERSION);
        lo_message_add_string(out, source);
        lo_message_add_int32(out, rig->depth.width);
        lo_message_add_int32(out, rig->depth.height);
    }
    add(&p, "/relief/hello", out);
    flush(&p);
}

void publish_osc_answer(bool is_error, const char *words, publish_send_fn send, void *context)
{
    packer p = {.send = send, .context = context};
    lo_message out = lo_message_new();
    if (out != NULL) {
        lo_message_add_string(out, words);
    }
    add(&p, is_error ? "/relief/error" : "/relief/done", out);
    flush(&p);
}
