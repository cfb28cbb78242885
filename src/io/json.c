/* Typed access to JSON objects. */
#include "io/json.h"

#include <stdarg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *type_name(const json_t *value)
{
    switch (json_typeof(value)) {
    case JSON_OBJECT: return "an object";
    case JSON_ARRAY: return "an array";
    case JSON_STRING: return "a string";
    case JSON_INTEGER:
    case JSON_REAL: return "a number";
    case JSON_TRUE:
    case JSON_FALSE: return "true or false";
    case JSON_NULL: return "null";
    }
    return "unknown";
}

rlf_result io_json_fail(const io_json_object *object, const char *key, const char *format, ...)
{
    char problem[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(problem, sizeof(problem), format, arguments);
    va_end(arguments);
    const char *dot = object->path[0] != '\0' && key[0] != '\0' ? "." : "";
    return rlf_fail(RLF_ERROR_INVALID, "%s: %s%s%.60s %s", object->file, object->path, dot, key,
                    problem);
}

rlf_result io_json_parse(const io_bytes *file, json_t **out)
{
    const io_bytes text = io_bytes_unmarked(file);
    if (text.size == 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is empty: write a JSON object as in docs/formats.md",
                        file->name);
    }
    json_error_t error;
    json_t *document =
        json_loadb((const char *)text.data, text.size, JSON_REJECT_DUPLICATES, &error);
    if (document == NULL) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s:%d:%d: is not valid JSON: %s: correct it as in docs/formats.md",
                        file->name, error.line, error.column, error.text);
    }
    if (!json_is_object(document)) {
        json_decref(document);
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the top of the file must be an object {...}: see docs/formats.md",
                        file->name);
    }
    *out = document;
    return RLF_OK;
}

io_json_object io_json_top(const io_bytes *file, json_t *document)
{
    io_json_object top = {.file = file->name, .value = document};
    return top;
}

/* The member, or NULL when it is absent; *out_result tells whether that is an error. */
static json_t *find(const io_json_object *object, const io_json_field *field,
                    rlf_result *out_result)
{
    json_t *value = json_object_get(object->value, field->key);
    *out_result = RLF_OK;
    if (value == NULL && field->is_required) {
        *out_result = io_json_fail(object, field->key, "is missing: it must be %s", field->meaning);
    }
    return value;
}

static rlf_result fail_type(const io_json_object *object, const io_json_field *field,
                            const json_t *value)
{
    return io_json_fail(object, field->key, "is %s: it must be %s", type_name(value),
                        field->meaning);
}

rlf_result io_json_get_object(const io_json_object *object, const io_json_field *field,
                              io_json_object *out)
{
    rlf_result result;
    json_t *value = find(object, field, &result);
    *out = (io_json_object){.file = object->file, .value = value};
    if (value == NULL) {
        return result;
    }
    if (!json_is_object(value)) {
        return fail_type(object, field, value);
    }
    snprintf(out->path, sizeof(out->path), "%.40s%s%.40s", object->path,
             object->path[0] != '\0' ? "." : "", field->key);
    return RLF_OK;
}

static rlf_result check_range(const io_json_object *object, const io_json_field *field, double x)
{
    /* Written so that a NaN would fail too. */
    if (x >= field->min && x <= field->max) {
        return RLF_OK;
    }
    return io_json_fail(object, field->key, "is %g: it must be %s", x, field->meaning);
}

rlf_result io_json_get_number(const io_json_object *object, const io_json_field *field, double *out)
{
    rlf_result result;
    json_t *value = find(object, field, &result);
    if (value == NULL) {
        return result;
    }
    if (!json_is_number(value)) {
        return fail_type(object, field, value);
    }
    double x = json_number_value(value);
    result = check_range(object, field, x);
    if (result == RLF_OK) {
        *out = x;
    }
    return result;
}

rlf_result io_json_get_integer(const io_json_object *object, const io_json_field *field,
                               int32_t *out)
{
    double x = *out;
    rlf_result result = io_json_get_number(object, field, &x);
    if (result == RLF_OK && x != (double)(int32_t)x) {
        return io_json_fail(object, field->key, "is %g: it must be %s", x, field->meaning);
    }
    if (result == RLF_OK) {
        *out = (int32_t)x;
    }
    return result;
}

rlf_result io_json_get_numbers(const io_json_object *object, const io_json_field *field,
                               double *out, size_t count)
{
    rlf_result result;
    json_t *value = find(object, field, &result);
    if (value == NULL) {
        return result;
    }
    if (!json_is_array(value)) {
        return fail_type(object, field, value);
    }
    if (json_array_size(value) != count) {
        return io_json_fail(object, field->key, "has %zu numbers: it must be %s",
                            json_array_size(value), field->meaning);
    }
    for (size_t i = 0; i < count; i++) {
        json_t *item = json_array_get(value, i);
        if (!json_is_number(item)) {
            return fail_type(object, field, item);
        }
        out[i] = json_number_value(item);
        result = check_range(object, field, out[i]);
        if (result != RLF_OK) {
            return result;
        }
    }
    return RLF_OK;
}

rlf_result io_json_get_vec3(const io_json_object *object, const io_json_field *field, rlf_vec3 *out)
{
    double v[3] = {out->x, out->y, out->z};
    rlf_result result = io_json_get_numbers(object, field, v, 3);
    *out = rlf_vec3_make(v[0], v[1], v[2]);
    return result;
}

rlf_result io_json_get_orientation(const io_json_object *object, rlf_quat *out)
{
    static const io_json_field field = {
        "orientation", "a quaternion [x, y, z, w] of about unit length", -1e3, 1e3, false};
    double q[4] = {out->x, out->y, out->z, out->w};
    rlf_result result = io_json_get_numbers(object, &field, q, 4);
    if (result != RLF_OK) {
        return result;
    }
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(norm > 0.9 && norm < 1.1)) {
        return io_json_fail(object, "orientation", "has the length %g: it must be %s", norm,
                            field.meaning);
    }
    rlf_quat quaternion = {q[0], q[1], q[2], q[3]};
    *out = rlf_quat_normalize(quaternion);
    return RLF_OK;
}

rlf_result io_json_get_bool(const io_json_object *object, const io_json_field *field, bool *out)
{
    rlf_result result;
    json_t *value = find(object, field, &result);
    if (value == NULL) {
        return result;
    }
    if (!json_is_boolean(value)) {
        return fail_type(object, field, value);
    }
    *out = json_is_true(value);
    return RLF_OK;
}

rlf_result io_json_get_text(const io_json_object *object, const io_json_field *field,
                            const char **out)
{
    rlf_result result;
    json_t *value = find(object, field, &result);
    if (value == NULL) {
        return result;
    }
    if (!json_is_string(value)) {
        return fail_type(object, field, value);
    }
    *out = json_string_value(value);
    return RLF_OK;
}

const char *io_json_unknown_key(const io_json_object *object, const char *const *known,
                                size_t count)
{
    const char *key;
    json_t *value;
    json_object_foreach(object->value, key, value)
    {
        size_t i = 0;
        while (i < count && strcmp(key, known[i]) != 0) {
            i++;
        }
        if (i == count) {
            return key;
        }
    }
    return NULL;
}

rlf_result io_json_write(const char *path, json_t *document, size_t digits)
{
    char *text = document != NULL
                     ? json_dumps(document, JSON_INDENT(2) | JSON_REAL_PRECISION(digits))
                     : NULL;
    json_decref(document);
    io_out_file file;
    rlf_result result = text != NULL
                            ? io_out_open(&file, path)
                            : rlf_fail(RLF_ERROR_MEMORY, "%s: not enough memory for it", path);
    if (result == RLF_OK) {
        result = io_out_write(&file, text, strlen(text));
        result = result == RLF_OK ? io_out_write(&file, "\n", 1) : result;
        result = io_out_close(&file, result);
    }
    free(text);
    return result;
}
