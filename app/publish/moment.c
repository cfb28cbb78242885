/* What of a frame goes out, copied within the frame loop. */
#include "publish/inside.h"

#include "relief/camera.h"

#include <string.h>

static bool is_same(rlf_body_id a, rlf_body_id b)
{
    return a.index1 == b.index1 && a.generation == b.generation;
}

/* States are in the order of their slots. NULL = it is gone. */
static const rlf_body_state *find(const rlf_body_state *states, int32_t count, rlf_body_id id)
{
    int32_t low = 0, high = count;
    while (low < high) {
        const int32_t middle = low + (high - low) / 2;
        if (states[middle].id.index1 < id.index1) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < count && is_same(states[low].id, id) ? &states[low] : NULL;
}

static void copy_name(const rlf_snapshot *s, rlf_body_id id, char out[RLF_NAME_MAX])
{
    const rlf_body_state *state = find(s->bodies, s->body_count, id);
    state = state != NULL ? state : find(s->known, s->known_count, id);
    memset(out, 0, RLF_NAME_MAX);
    if (state != NULL) {
        memcpy(out, state->name, RLF_NAME_MAX);
    }
}

static void copy_bodies(publish_moment *m, const rlf_snapshot *s)
{
    m->body_count = s->body_count < PUBLISH_BODIES ? s->body_count : PUBLISH_BODIES;
    m->left_out += s->body_count - m->body_count;
    for (int32_t i = 0; i < m->body_count; i++) {
        const rlf_body_state *from = &s->bodies[i];
        publish_body *to = &m->bodies[i];
        memcpy(to->name, from->name, sizeof to->name);
        to->T_world_body = from->T_world_body;
        to->velocity = from->velocity;
        to->angular_velocity = from->angular_velocity;
        to->is_asleep = from->is_asleep;
        to->is_grabbed = from->is_grabbed;
    }
}

/* ---- contacts -------------------------------------------------------------------------------- */

/* Id of the hand whose pixel the point is at; 0 = none. */
static int32_t hand_at(const rlf_pipeline_output *frame, rlf_vec3 point)
{
    const rlf_hands *hands = frame->hands;
    const rlf_vec3 p = rlf_transform_inverse(&frame->T_world_camera, point);
    double u, v;
    if (hands == NULL || hands->owner == NULL || hands->count == 0 ||
        !rlf_camera_project(&frame->surface->camera, p, &u, &v)) {
        return 0;
    }
    const int32_t x = (int32_t)(u + 0.5), y = (int32_t)(v + 0.5);
    if (!(u > -0.5 && v > -0.5) || x >= hands->width || y >= hands->height) {
        return 0;
    }
    const uint8_t owner = hands->owner[(size_t)y * (size_t)hands->width + (size_t)x];
    return owner > 0 && owner <= hands->count ? hands->hand[owner - 1].id : 0;
}

/* The strongest point of a touch; NULL = none. */
static const rlf_contact *strongest(const rlf_snapshot *s, const rlf_contact_event *event)
{
    const rlf_contact *best = NULL;
    for (int32_t i = 0; i < s->contact_count; i++) {
        const rlf_contact *c = &s->contacts[i];
        if (c->other == event->other && is_same(c->body, event->body) &&
            is_same(c->other_body, event->other_body) &&
            (best == NULL || c->impulse > best->impulse)) {
            best = c;
        }
    }
    return best;
}

static void copy_contact(publish_contact *to, const rlf_pipeline_output *frame,
                         const rlf_contact_event *event)
{
    static const char *const names[3] = {"body", "background", "foreground"};
    const rlf_snapshot *s = frame->snapshot;
    memset(to, 0, sizeof *to);
    to->is_begin = event->is_begin;
    to->with = names[event->other];
    copy_name(s, event->body, to->body);
    copy_name(s, event->other_body, to->other);
    const rlf_contact *c = event->is_begin ? strongest(s, event) : NULL;
    if (c == NULL) {
        return;
    }
    to->region = c->region_label;
    to->point = c->point;
    to->normal = c->normal;
    to->impulse = c->impulse;
    to->speed = c->approach_speed;
    to->hand = event->other == RLF_CONTACT_FOREGROUND ? hand_at(frame, c->point) : 0;
    to->with = to->hand > 0 ? "hand" : to->with;
}

static void copy_contacts(publish_moment *m, const rlf_pipeline_output *frame)
{
    const int32_t all = frame->snapshot->event_count;
    m->contact_count = all < PUBLISH_CONTACTS ? all : PUBLISH_CONTACTS;
    m->left_out += all - m->contact_count;
    for (int32_t i = 0; i < m->contact_count; i++) {
        copy_contact(&m->contacts[i], frame, &frame->snapshot->events[i]);
    }
}

/* ---- regions and hands ----------------------------------------------------------------------- */

static rlf_aabb box_in_world(const rlf_pose *T_world_camera, const rlf_aabb *box)
{
    rlf_aabb out = rlf_aabb_empty();
    for (int i = 0; i < 8; i++) {
        const rlf_vec3 corner = {(i & 1) != 0 ? box->max.x : box->min.x,
                                 (i & 2) != 0 ? box->max.y : box->min.y,
                                 (i & 4) != 0 ? box->max.z : box->min.z};
        rlf_aabb_extend(&out, rlf_transform(T_world_camera, corner));
    }
    return out;
}

/* Those of the foreground: what moves. */
static void copy_regions(publish_moment *m, const rlf_pipeline_output *frame)
{
    const rlf_pose *T = &frame->T_world_camera;
    for (int32_t i = 0; i < frame->surface->region_count; i++) {
        const rlf_region *from = &frame->surface->regions[i];
        if (from->layer != RLF_LAYER_FOREGROUND) {
            continue;
        }
        if (m->region_count == PUBLISH_REGIONS) {
            m->left_out++;
            continue;
        }
        m->regions[m->region_count++] =
            (publish_region){.id = from->label,
                             .box = box_in_world(T, &from->box),
                             .centroid = rlf_transform(T, from->centroid),
                             .velocity = rlf_rotate(T->q, from->linear_velocity)};
    }
}

static void copy_hands(publish_moment *m, const rlf_pipeline_output *frame)
{
    const rlf_pose *T = &frame->T_world_camera;
    m->hand_count = frame->hands->count;
    for (int32_t i = 0; i < m->hand_count; i++) {
        rlf_hand *h = &m->hands[i];
        *h = frame->hands->hand[i];
        h->palm = rlf_transform(T, h->palm);
        h->velocity = rlf_rotate(T->q, h->velocity);
        h->normal = rlf_rotate(T->q, h->normal);
        h->direction = rlf_rotate(T->q, h->direction);
    }
}

static void copy_gestures(publish_moment *m, const rlf_pipeline_output *frame)
{
    const rlf_pose *T = &frame->T_world_camera;
    m->gesture_count = frame->hands->event_count;
    for (int32_t i = 0; i < m->gesture_count; i++) {
        rlf_hand_event *e = &m->gestures[i];
        *e = frame->hands->event[i];
        e->position = rlf_transform(T, e->position);
        e->direction = rlf_rotate(T->q, e->direction);
        e->velocity = rlf_rotate(T->q, e->velocity);
    }
}

const char *publish_side_name(rlf_hand_side side)
{
    return side == RLF_HAND_LEFT ? "left" : side == RLF_HAND_RIGHT ? "right" : "unknown";
}

bool publish_moment_fill(publish_moment *m, const rlf_pipeline_output *frame, bool is_whole)
{
    m->index = frame->frame_index;
    m->time_ns = frame->frame.time_ns;
    m->time_s = frame->time_s;
    m->is_whole = is_whole;
    m->gravity = frame->snapshot->gravity;
    m->T_world_camera = frame->T_world_camera;
    m->body_count = m->region_count = m->hand_count = m->gesture_count = m->left_out = 0;
    copy_contacts(m, frame);
    if (frame->hands != NULL) {
        copy_gestures(m, frame);
    }
    if (is_whole) {
        copy_bodies(m, frame->snapshot);
        copy_regions(m, frame);
        if (frame->hands != NULL) {
            copy_hands(m, frame);
        }
    }
    return is_whole || m->contact_count > 0 || m->gesture_count > 0;
}
