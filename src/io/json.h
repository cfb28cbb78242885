/* Typed access to JSON objects with error lines that name the file, the path and the cure. */
#ifndef RLF_IO_JSON_H
#define RLF_IO_JSON_H

#include "io/file.h"
#include "relief/math.h"

#include <float.h>
#include <jansson.h>

#define IO_JSON_FILE_MAX ((size_t)16 << 20)
#define IO_JSON_PATH_MAX 96
#define IO_POSITIVE DBL_MIN /* `min` of a field that must be > 0 */

/* An object and where it is; borrowed from the parsed document. */
typedef struct io_json_object {
    const char *file;
    char path[IO_JSON_PATH_MAX]; /* "" for the top, else like "bodies[2]" */
    json_t *value;
} io_json_object;

/* What one key may hold. `meaning` completes "it must be ...". */
typedef struct io_json_field {
    const char *key;
    const char *meaning;
    double min, max;
    bool is_required;
} io_json_field;

/* Parses a document whose top is an object; duplicate keys are an error. json_decref(*out). */
rlf_result io_json_parse(const io_bytes *file, json_t **out);
io_json_object io_json_top(const io_bytes *file, json_t *document);

/* Member object. Absent and not required: RLF_OK and out->value NULL. */
rlf_result io_json_get_object(const io_json_object *object, const io_json_field *field,
                              io_json_object *out);
/* Numbers within min..max; *out keeps its value when the key is absent and not required. */
rlf_result io_json_get_number(const io_json_object *object, const io_json_field *field,
                              double *out);
rlf_result io_json_get_integer(const io_json_object *object, const io_json_field *field,
                               int32_t *out);
/* Array of exactly `count` numbers. */
rlf_result io_json_get_numbers(const io_json_object *object, const io_json_field *field,
                               double *out, size_t count);
rlf_result io_json_get_vec3(const io_json_object *object, const io_json_field *field,
                            rlf_vec3 *out);
/* A key "orientation": a quaternion x, y, z, w of about unit length. */
rlf_result io_json_get_orientation(const io_json_object *object, rlf_quat *out);
rlf_result io_json_get_bool(const io_json_object *object, const io_json_field *field, bool *out);
/* The string stays the document's. */
rlf_result io_json_get_text(const io_json_object *object, const io_json_field *field,
                            const char **out);

/* First key that is not in the list (count strings), or NULL. */
const char *io_json_unknown_key(const io_json_object *object, const char *const *known,
                                size_t count);

/* Writes a document, which it takes; NULL = memory ran out while it was made. `digits` of numbers;
 * 0 = as many as keep every bit. */
rlf_result io_json_write(const char *path, json_t *document, size_t digits);

/* Fails with "FILE: PATH.KEY PROBLEM". */
rlf_result io_json_fail(const io_json_object *object, const char *key, const char *format, ...)
    RLF_PRINTF(3, 4);

#endif
