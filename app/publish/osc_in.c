/* Commands as OSC messages: /relief/spawn sffff sphere 0.1 0 0 1. */
#include "publish/inside.h"

#include <lo/lo.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define ARGUMENTS_MAX 9
#define ELEMENTS_MAX PUBLISH_COMMANDS /* of a bundle */
static const char prefix[] = "/relief/";
static const char bundle[8] = "#bundle";

/* The arguments of a message: at most two texts, the others numbers. */
typedef struct arguments {
    double numbers[ARGUMENTS_MAX];
    const char *texts[2];
    int number_count, text_count;
} arguments;

static bool fail(char error[PUBLISH_ERROR_SIZE], const char *format, ...) RLF_PRINTF(2, 3);
static bool fail(char error[PUBLISH_ERROR_SIZE], const char *format, ...)
{
    va_list list;
    va_start(list, format);
    (void)vsnprintf(error, PUBLISH_ERROR_SIZE, format, list);
    va_end(list);
    return false;
}

/* Arguments lie at multiples of 4, so they are copied and not looked at in their place. */
static bool read_number(char type, const void *value, double *out)
{
    float f;
    double d;
    int32_t i;
    int64_t h;
    switch (type) {
    case 'f':
        memcpy(&f, value, sizeof f);
        *out = f;
        return true;
    case 'd':
        memcpy(&d, value, sizeof d);
        *out = d;
        return true;
    case 'i':
        memcpy(&i, value, sizeof i);
        *out = i;
        return true;
    case 'h':
        memcpy(&h, value, sizeof h);
        *out = (double)h;
        return true;
    case 'T': *out = 1.0; return true;
    case 'F': *out = 0.0; return true;
    default: return false;
    }
}

static bool read_arguments(lo_message message, arguments *out)
{
    const char *types = lo_message_get_types(message);
    lo_arg **values = lo_message_get_argv(message);
    const int count = lo_message_get_argc(message);
    memset(out, 0, sizeof *out);
    for (int i = 0; i < count; i++) {
        const bool is_text = types[i] == 's' || types[i] == 'S';
        const bool is_full = is_text ? out->text_count == 2 : out->number_count == ARGUMENTS_MAX;
        if (is_full) {
            return false;
        }
        if (is_text) {
            out->texts[out->text_count++] = (const char *)values[i];
        } else if (!read_number(types[i], values[i], &out->numbers[out->number_count++])) {
            return false;
        }
    }
    return true;
}

static rlf_vec3 vector(const double *n)
{
    return rlf_vec3_make(n[0], n[1], n[2]);
}

/* False for one that is too long. */
static bool copy_name(const char *text, char out[RLF_NAME_MAX])
{
    const bool is_short = strlen(text) < RLF_NAME_MAX;
    (void)snprintf(out, RLF_NAME_MAX, "%.63s", text);
    return is_short;
}

static bool read_body(const arguments *a, publish_command *c, char error[PUBLISH_ERROR_SIZE])
{
    const bool is_spawn = c->verb == PUBLISH_SPAWN;
    const bool is_right = is_spawn ? a->number_count == 4 || a->number_count == 7
                                   : a->number_count == 1 || a->number_count == 4;
    if (!is_right || a->text_count < 1) {
        return fail(error, is_spawn ? "spawn takes shape size x y z [vx vy vz] [name]"
                                    : "throw takes shape size [vx vy vz] [name]");
    }
    if (!publish_command_shape(c, a->texts[0], a->numbers[0])) {
        return fail(error, "shape '%.40s': use box, sphere, capsule or cylinder", a->texts[0]);
    }
    if (is_spawn) {
        c->body.position = vector(a->numbers + 1);
    }
    if (a->number_count > (is_spawn ? 4 : 1)) {
        c->body.velocity = vector(a->numbers + (is_spawn ? 4 : 1));
    }
    return a->text_count == 1 || copy_name(a->texts[1], c->body.name) ||
           fail(error, "name: at most 63 letters");
}

static bool read_others(const arguments *a, publish_command *c, char error[PUBLISH_ERROR_SIZE])
{
    const bool is_name = c->verb == PUBLISH_REMOVE || c->verb == PUBLISH_SCENE;
    const int numbers = c->verb == PUBLISH_GRAVITY ? 3 : c->verb == PUBLISH_RECORD ? 1 : 0;
    if (a->number_count != numbers || a->text_count != (is_name ? 1 : 0)) {
        return fail(error, "%s takes %s", publish_verb_name(c->verb),
                    is_name        ? "a name"
                    : numbers == 3 ? "x y z"
                    : numbers == 1 ? "0 or 1"
                                   : "nothing");
    }
    c->is_on = a->numbers[0] != 0.0;
    c->gravity = vector(a->numbers);
    return !is_name || copy_name(a->texts[0], c->name) || fail(error, "name: at most 63 letters");
}

static bool read_message(const char *path, lo_message message, publish_command *c,
                         char error[PUBLISH_ERROR_SIZE])
{
    arguments a;
    if (strncmp(path, prefix, strlen(prefix)) != 0 ||
        !publish_command_begin(path + strlen(prefix), c)) {
        return fail(error,
                    "'%.60s': use /relief/ and spawn, throw, remove, clear, gravity, record, "
                    "scene or hello",
                    path);
    }
    if (!read_arguments(message, &a)) {
        return fail(error, "%s takes at most 9 numbers and 2 texts", publish_verb_name(c->verb));
    }
    const bool is_body = c->verb == PUBLISH_SPAWN || c->verb == PUBLISH_THROW;
    return (is_body ? read_body(&a, c, error) : read_others(&a, c, error)) &&
           publish_command_check(c, error);
}

static void take_message(const char *bytes, size_t size, publish_take_fn take, void *context)
{
    publish_command command = {0};
    char error[PUBLISH_ERROR_SIZE] = "no OSC message";
    lo_message message = lo_message_deserialise((void *)(uintptr_t)bytes, size, NULL);
    const bool is_good = message != NULL && read_message(bytes, message, &command, error);
    take(context, &command, is_good ? NULL : error);
    if (message != NULL) {
        lo_message_free(message);
    }
}

static size_t big_endian(const unsigned char *b)
{
    return (size_t)b[0] << 24 | (size_t)b[1] << 16 | (size_t)b[2] << 8 | (size_t)b[3];
}

/* Its time tag counts as now: what waits could be made to wait without end. */
void publish_commands_from_osc(const void *packet, size_t size, publish_take_fn take, void *context)
{
    char bytes[PUBLISH_TEXT_MAX];
    publish_command none = {0};
    if (size == 0 || size > sizeof bytes) {
        take(context, &none, "no OSC message: 4 to 4096 bytes");
        return;
    }
    memcpy(bytes, packet, size);
    if (size < sizeof bundle || memcmp(bytes, bundle, sizeof bundle) != 0) {
        take_message(bytes, size, take, context);
        return;
    }
    size_t at = sizeof bundle + 8;
    for (int i = 0; i < ELEMENTS_MAX && at + 4 <= size; i++) {
        const size_t length = big_endian((const unsigned char *)bytes + at);
        at += 4;
        if (length == 0 || length > size - at) {
            take(context, &none, "half a bundle");
            return;
        }
        take_message(bytes + at, length, take, context);
        at += length;
    }
}
