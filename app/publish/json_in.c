/* Commands as JSON objects: {"type":"spawn","shape":"sphere","radius":0.1,"position":[0,0,1]}. */
#include "publish/inside.h"

#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool fail(char error[PUBLISH_ERROR_SIZE], const char *format, ...) RLF_PRINTF(2, 3);
static bool fail(char error[PUBLISH_ERROR_SIZE], const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(error, PUBLISH_ERROR_SIZE, format, arguments);
    va_end(arguments);
    return false;
}

/* ---- values ---------------------------------------------------------------------------------- */

static bool take_number(const json_t *value, void *out)
{
    *(double *)out = json_number_value(value);
    return json_is_number(value);
}

static bool take_vec3(const json_t *value, void *out)
{
    rlf_vec3 *v = out;
    return json_array_size(value) == 3 && take_number(json_array_get(value, 0), &v->x) &&
           take_number(json_array_get(value, 1), &v->y) &&
           take_number(json_array_get(value, 2), &v->z);
}

static bool take_color(const json_t *value, void *out)
{
    rlf_vec3 v = {0};
    float *color = out;
    const bool is_good = take_vec3(value, &v);
    color[0] = (float)v.x;
    color[1] = (float)v.y;
    color[2] = (float)v.z;
    return is_good;
}

static bool take_name(const json_t *value, void *out)
{
    const char *text = json_string_value(value);
    const size_t length = json_string_length(value);
    memset(out, 0, RLF_NAME_MAX);
    if (text == NULL || length >= RLF_NAME_MAX || strlen(text) != length) {
        return false;
    }
    memcpy(out, text, length);
    return true;
}

static bool take_bool(const json_t *value, void *out)
{
    *(bool *)out = json_is_true(value);
    return json_is_boolean(value);
}

/* An edge of all sides, or three of them. */
static bool take_size(const json_t *value, void *out)
{
    rlf_vec3 *size = out;
    if (json_is_number(value)) {
        const double edge = json_number_value(value);
        *size = rlf_vec3_make(edge, edge, edge);
        return true;
    }
    return take_vec3(value, out);
}

/* ---- keys ------------------------------------------------------------------------------------ */

typedef struct field {
    const char *key;
    bool (*take)(const json_t *value, void *out);
    void *out;
    const char *form;
} field;

#define NUMBER "a number"
#define VECTOR "three numbers"
#define NAME "a text of 1 to 63 letters"

static bool take_field(const field *fields, const char *verb, const char *key, const json_t *value,
                       char error[PUBLISH_ERROR_SIZE])
{
    for (const field *f = fields; f->key != NULL; f++) {
        if (strcmp(f->key, key) == 0) {
            return f->take(value, f->out) ||
                   fail(error, "%s: %s must be %s", verb, f->key, f->form);
        }
    }
    return strcmp(key, "type") == 0 || fail(error, "%s has no key '%.40s'", verb, key);
}

static bool take_fields(const json_t *top, const field *fields, const char *verb,
                        char error[PUBLISH_ERROR_SIZE])
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)top, key, value)
    {
        if (!take_field(fields, verb, key, value, error)) {
            return false;
        }
    }
    return true;
}

/* ---- verbs ----------------------------------------------------------------------------------- */

static bool read_body(const json_t *top, publish_command *c, char error[PUBLISH_ERROR_SIZE])
{
    const char *verb = publish_verb_name(c->verb);
    const char *shape = json_string_value(json_object_get(top, "shape"));
    rlf_body_def *b = &c->body;
    char name[RLF_NAME_MAX];
    const field fields[] = {{"shape", take_name, name, "a text"},
                            {"size", take_size, &b->shape.size, "a number, or three"},
                            {"radius", take_number, &b->shape.radius, NUMBER},
                            {"height", take_number, &b->shape.height, NUMBER},
                            {"position", take_vec3, &b->position, VECTOR},
                            {"velocity", take_vec3, &b->velocity, VECTOR},
                            {"angular_velocity", take_vec3, &b->angular_velocity, VECTOR},
                            {"mass", take_number, &b->mass, NUMBER},
                            {"restitution", take_number, &b->restitution, NUMBER},
                            {"friction", take_number, &b->friction, NUMBER},
                            {"color", take_color, b->color, VECTOR},
                            {"name", take_name, b->name, NAME},
                            {0}};
    const json_t *size = json_object_get(top, "size");
    const double edge = json_is_number(size) ? json_number_value(size) : b->shape.size.x;
    if (!publish_command_shape(c, shape != NULL ? shape : "box", edge)) {
        return fail(error, "%s: shape '%.40s': use box, sphere, capsule or cylinder", verb, shape);
    }
    if (json_is_array(size) && b->shape.type != RLF_SHAPE_BOX) {
        return fail(error, "%s: a %s has one size, or radius and height", verb, shape);
    }
    return take_fields(top, fields, verb, error);
}

static bool read_fields(const json_t *top, publish_command *c, char error[PUBLISH_ERROR_SIZE])
{
    const char *verb = publish_verb_name(c->verb);
    const field gravity[] = {{"value", take_vec3, &c->gravity, VECTOR}, {0}};
    const field record[] = {{"on", take_bool, &c->is_on, "true or false"}, {0}};
    const field name[] = {{"name", take_name, c->name, NAME}, {0}};
    const field none[] = {{0}};
    const field *const fields[PUBLISH_VERB_COUNT] = {
        [PUBLISH_REMOVE] = name,   [PUBLISH_CLEAR] = none, [PUBLISH_GRAVITY] = gravity,
        [PUBLISH_RECORD] = record, [PUBLISH_SCENE] = name, [PUBLISH_HELLO] = none};
    if (c->verb == PUBLISH_SPAWN || c->verb == PUBLISH_THROW) {
        return read_body(top, c, error);
    }
    const char *needed = fields[c->verb]->key;
    if (needed != NULL && json_object_get(top, needed) == NULL) {
        return fail(error, "%s needs '%s'", verb, needed);
    }
    return take_fields(top, fields[c->verb], verb, error);
}

static bool read_object(const json_t *top, publish_command *c, char error[PUBLISH_ERROR_SIZE])
{
    const char *type = json_string_value(json_object_get(top, "type"));
    if (type == NULL) {
        return fail(error, "a command is an object with a \"type\", as in {\"type\":\"hello\"}");
    }
    if (!publish_command_begin(type, c)) {
        return fail(error,
                    "type '%.40s': use spawn, throw, remove, clear, gravity, record, scene "
                    "or hello",
                    type);
    }
    return read_fields(top, c, error) && publish_command_check(c, error);
}

bool publish_command_from_json(const char *text, size_t length, publish_command *out,
                               char error[PUBLISH_ERROR_SIZE])
{
    json_error_t at;
    memset(out, 0, sizeof *out);
    if (length > PUBLISH_TEXT_MAX) {
        return fail(error, "more than %d bytes", PUBLISH_TEXT_MAX);
    }
    json_t *top = json_loadb(text, length, JSON_REJECT_DUPLICATES, &at);
    if (top == NULL) {
        return fail(error, "no JSON: %.120s", at.text);
    }
    const bool is_good = read_object(top, out, error);
    json_decref(top);
    return is_good;
}
