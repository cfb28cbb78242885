/* A frame as one JSON object. */
#include "publish/inside.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- a text that grows ----------------------------------------------------------------------- */

#define FIRST_BYTES 4096

void publish_text_begin(publish_text *t, size_t before)
{
    t->before = before;
    t->length = 0;
    t->has_failed = false;
}

void publish_text_free(publish_text *t)
{
    free(t->data);
    *t = (publish_text){0};
}

/* Room for `more` bytes and an ending zero. */
static bool make_room(publish_text *t, size_t more)
{
    const size_t needed = t->before + t->length + more + 1;
    if (needed > t->capacity) {
        const size_t capacity = needed > FIRST_BYTES ? 2 * needed : FIRST_BYTES;
        char *data = realloc(t->data, capacity);
        if (data == NULL) {
            t->has_failed = true;
            return false;
        }
        t->data = data;
        t->capacity = capacity;
    }
    return true;
}

static void put(publish_text *t, const char *format, ...) RLF_PRINTF(2, 3);
static void put(publish_text *t, const char *format, ...)
{
    char part[256]; /* no piece below is longer */
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(part, sizeof part, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= sizeof part || !make_room(t, (size_t)length)) {
        t->has_failed = true;
        return;
    }
    memcpy(t->data + t->before + t->length, part, (size_t)length + 1);
    t->length += (size_t)length;
}

/* JSON has neither NaN nor infinity. */
static double finite(double x)
{
    return rlf_is_finite(x) ? x : 0.0;
}

static void put_vec3(publish_text *t, const char *key, rlf_vec3 v)
{
    put(t, "\"%s\":[%.6g,%.6g,%.6g]", key, finite(v.x), finite(v.y), finite(v.z));
}

static void put_quat(publish_text *t, const char *key, rlf_quat q)
{
    put(t, "\"%s\":[%.6g,%.6g,%.6g,%.6g]", key, finite(q.x), finite(q.y), finite(q.z), finite(q.w));
}

/* Bytes of the UTF-8 character at `c`; 0 where it is none, or a control character. */
static size_t character_size(const unsigned char *c)
{
    static const unsigned char most_two = 0xdf, most_three = 0xef, most = 0xf4;
    const bool has_second = c[0] != 0 && (c[1] & 0xc0) == 0x80;
    const bool has_third = has_second && (c[2] & 0xc0) == 0x80;
    if (c[0] < 0x80) {
        return c[0] >= 0x20 && c[0] != 0x7f ? 1 : 0;
    }
    if (c[0] < 0xc2 || !has_second) {
        return 0;
    }
    if (c[0] <= most_two) {
        return 2;
    }
    if (c[0] <= most_three) { /* not the long forms, and no halves of UTF-16 */
        const bool is_right = (c[0] != 0xe0 || c[1] >= 0xa0) && (c[0] != 0xed || c[1] < 0xa0);
        return has_third && is_right ? 3 : 0;
    }
    const bool is_right = (c[0] != 0xf0 || c[1] >= 0x90) && (c[0] != 0xf4 || c[1] < 0x90);
    return c[0] <= most && has_third && (c[3] & 0xc0) == 0x80 && is_right ? 4 : 0;
}

/* What is no character becomes a question mark: a WebSocket closes on wrong UTF-8. */
static void put_string(publish_text *t, const char *key, const char *text)
{
    put(t, "\"%s\":\"", key);
    for (const char *c = text; *c != '\0';) {
        const size_t size = character_size((const unsigned char *)c);
        if (size == 0) {
            put(t, "?");
        } else if (*c == '"' || *c == '\\') {
            put(t, "\\%c", *c);
        } else {
            put(t, "%.*s", (int)size, c);
        }
        c += size > 0 ? size : 1;
    }
    put(t, "\"");
}

/* ---- parts of a frame ------------------------------------------------------------------------ */

static const char *word(bool is)
{
    return is ? "true" : "false";
}

static void put_bodies(publish_text *t, const publish_moment *m)
{
    put(t, ",\"bodies\":[");
    for (int32_t i = 0; i < m->body_count; i++) {
        const publish_body *b = &m->bodies[i];
        put(t, "%s{", i > 0 ? "," : "");
        put_string(t, "name", b->name);
        put(t, ",");
        put_vec3(t, "position", b->T_world_body.p);
        put(t, ",");
        put_quat(t, "orientation", b->T_world_body.q);
        put(t, ",");
        put_vec3(t, "velocity", b->velocity);
        put(t, ",");
        put_vec3(t, "angular_velocity", b->angular_velocity);
        put(t, ",\"asleep\":%s,\"held\":%s}", word(b->is_asleep), word(b->is_grabbed));
    }
    put(t, "]");
}

static void put_hands(publish_text *t, const publish_moment *m)
{
    put(t, ",\"hands\":[");
    for (int32_t i = 0; i < m->hand_count; i++) {
        const rlf_hand *h = &m->hands[i];
        put(t, "%s{\"id\":%d,\"side\":\"%s\",\"gesture\":\"%s\",\"confidence\":%.3g,",
            i > 0 ? "," : "", (int)h->id, publish_side_name(h->side), rlf_gesture_name(h->gesture),
            finite(h->confidence));
        put_vec3(t, "palm", h->palm);
        put(t, ",");
        put_vec3(t, "velocity", h->velocity);
        put(t, ",");
        put_vec3(t, "normal", h->normal);
        put(t, ",");
        put_vec3(t, "direction", h->direction);
        put(t, ",\"pinch\":%.4g}", finite(h->pinch_width));
    }
    put(t, "]");
}

static void put_regions(publish_text *t, const publish_moment *m)
{
    put(t, ",\"regions\":[");
    for (int32_t i = 0; i < m->region_count; i++) {
        const publish_region *r = &m->regions[i];
        put(t, "%s{\"id\":%d,", i > 0 ? "," : "", (int)r->id);
        put_vec3(t, "min", r->box.min);
        put(t, ",");
        put_vec3(t, "max", r->box.max);
        put(t, ",");
        put_vec3(t, "centroid", r->centroid);
        put(t, ",");
        put_vec3(t, "velocity", r->velocity);
        put(t, "}");
    }
    put(t, "]");
}

static void put_contacts(publish_text *t, const publish_moment *m)
{
    put(t, ",\"contacts\":[");
    for (int32_t i = 0; i < m->contact_count; i++) {
        const publish_contact *c = &m->contacts[i];
        put(t, "%s{\"state\":\"%s\",", i > 0 ? "," : "", c->is_begin ? "begin" : "end");
        put_string(t, "body", c->body);
        put(t, ",\"with\":\"%s\",", c->with);
        put_string(t, "other", c->other);
        if (c->is_begin) {
            put(t, ",\"region\":%d,\"hand\":%d,", (int)c->region, (int)c->hand);
            put_vec3(t, "position", c->point);
            put(t, ",");
            put_vec3(t, "normal", c->normal);
            put(t, ",\"impulse\":%.6g,\"speed\":%.6g", finite(c->impulse), finite(c->speed));
        }
        put(t, "}");
    }
    put(t, "]");
}

static void put_gestures(publish_text *t, const publish_moment *m)
{
    put(t, ",\"gestures\":[");
    for (int32_t i = 0; i < m->gesture_count; i++) {
        const rlf_hand_event *e = &m->gestures[i];
        put(t, "%s{\"event\":\"%s\",\"hand\":%d,", i > 0 ? "," : "", rlf_hand_event_name(e->kind),
            (int)e->hand);
        put_vec3(t, "position", e->position);
        put(t, ",");
        put_vec3(t, "direction", e->direction);
        put(t, ",");
        put_vec3(t, "velocity", e->velocity);
        put(t, "}");
    }
    put(t, "]");
}

/* ---- messages -------------------------------------------------------------------------------- */

void publish_json_moment(publish_text *t, const publish_moment *m)
{
    put(t, "{\"type\":\"%s\",\"index\":%lld,\"time\":%.4f,\"time_ns\":%lld",
        m->is_whole ? "frame" : "events", (long long)m->index, finite(m->time_s),
        (long long)m->time_ns);
    if (m->is_whole) {
        put(t, ",");
        put_vec3(t, "gravity", m->gravity);
        put(t, ",\"camera\":{");
        put_vec3(t, "position", m->T_world_camera.p);
        put(t, ",");
        put_quat(t, "orientation", m->T_world_camera.q);
        put(t, "},\"left_out\":%d", (int)m->left_out);
        put_bodies(t, m);
        put_hands(t, m);
        put_regions(t, m);
    }
    put_contacts(t, m);
    put_gestures(t, m);
    put(t, "}");
}

void publish_json_hello(publish_text *t, const rlf_rig *rig, const char *source)
{
    put(t, "{\"type\":\"hello\",\"protocol\":\"relief\",\"version\":%d,", PUBLISH_VERSION);
    put_string(t, "source", source);
    put(t, ",\"width\":%d,\"height\":%d,", (int)rig->depth.width, (int)rig->depth.height);
    put(t, "\"units\":\"metres, seconds, kilograms, radians\","
           "\"axes\":\"x right, y down, z away from the camera\"}");
}

void publish_json_answer(publish_text *t, bool is_error, const char *words)
{
    put(t, "{\"type\":\"%s\",", is_error ? "error" : "done");
    put_string(t, "text", words);
    put(t, "}");
}
