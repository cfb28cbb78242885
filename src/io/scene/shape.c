/* What bodies and known objects of scene.json have in common: shapes and names. */
#include "io/scene/reader.h"

#include <string.h>

#define SIZE_MIN_M 1e-6 /* so that squares of squares stay numbers */
#define SIZE_MAX_M 100.0
#define SIZE_MEANING "metres, from 1e-6 to 100"

/* Name and keys of a shape; which of size, radius and height it takes. */
typedef struct shape_keys {
    const char *name;
    rlf_shape_type type;
    bool has_size, has_radius, has_height;
} shape_keys;

static const shape_keys shapes[] = {{"box", RLF_SHAPE_BOX, true, false, false},
                                    {"sphere", RLF_SHAPE_SPHERE, false, true, false},
                                    {"capsule", RLF_SHAPE_CAPSULE, false, true, true},
                                    {"cylinder", RLF_SHAPE_CYLINDER, false, true, true},
                                    {"hull", RLF_SHAPE_HULL, true, false, false}};

static rlf_result find_shape(const io_json_object *body, const shape_keys **out)
{
    static const io_json_field field = {
        "shape", "\"box\", \"sphere\", \"capsule\", \"cylinder\" or \"hull\"", 0, 0, false};
    const char *name = "box";
    rlf_result result = io_json_get_text(body, &field, &name);
    if (result != RLF_OK) {
        return result;
    }
    for (size_t i = 0; i < sizeof(shapes) / sizeof(shapes[0]); i++) {
        if (strcmp(name, shapes[i].name) == 0) {
            *out = &shapes[i];
            return RLF_OK;
        }
    }
    return io_json_fail(body, "shape", "is \"%.60s\": it must be %s", name, field.meaning);
}

/* A key that belongs to another shape would be ignored silently. */
static rlf_result check_shape_keys(const io_json_object *body, const shape_keys *shape)
{
    const struct {
        const char *key;
        bool is_used;
    } keys[4] = {{"size", shape->has_size},
                 {"radius", shape->has_radius},
                 {"height", shape->has_height},
                 {"vertices", shape->type == RLF_SHAPE_HULL}};
    for (int i = 0; i < 4; i++) {
        if (!keys[i].is_used && json_object_get(body->value, keys[i].key) != NULL) {
            return io_json_fail(body, keys[i].key,
                                "does not belong to the shape \"%s\": take it out", shape->name);
        }
    }
    return RLF_OK;
}

rlf_result io_scene_read_shape(const io_json_object *body, const io_scene_reader *reader,
                               rlf_shape *out, rlf_look *out_look)
{
    static const io_json_field size = {"size", "three full extents in " SIZE_MEANING, SIZE_MIN_M,
                                       SIZE_MAX_M, false};
    static const io_json_field radius = {"radius", "a number of " SIZE_MEANING, SIZE_MIN_M,
                                         SIZE_MAX_M, true};
    static const io_json_field height = {"height", "a number of " SIZE_MEANING, SIZE_MIN_M,
                                         SIZE_MAX_M, true};
    const shape_keys *shape = NULL;
    rlf_result result = find_shape(body, &shape);
    result = result == RLF_OK ? check_shape_keys(body, shape) : result;
    if (result != RLF_OK) {
        return result;
    }
    out->type = shape->type;
    rlf_vec3 extents = shape->type == RLF_SHAPE_HULL ? rlf_vec3_make(0, 0, 0) : out->size;
    if (shape->has_size) {
        result = io_json_get_vec3(body, &size, &extents);
    }
    if (result == RLF_OK && shape->has_radius) {
        result = io_json_get_number(body, &radius, &out->radius);
    }
    if (result == RLF_OK && shape->has_height) {
        result = io_json_get_number(body, &height, &out->height);
    }
    if (result == RLF_OK && shape->type == RLF_SHAPE_HULL) {
        return io_scene_read_hull(body, reader, extents, out, out_look);
    }
    out->size = extents;
    return result == RLF_OK ? io_scene_read_look(body, reader, out, out_look) : result;
}

/* ---- names ----------------------------------------------------------------------------------- */

static bool is_control(char c)
{
    return (unsigned char)c < 0x20 || c == 0x7f;
}

rlf_result io_scene_read_name(const io_json_object *body, char out[RLF_NAME_MAX])
{
    static const io_json_field field = {"name", "a text of 1 to 63 bytes", 0, 0, false};
    const char *name = NULL;
    rlf_result result = io_json_get_text(body, &field, &name);
    if (result != RLF_OK || name == NULL) {
        return result;
    }
    size_t length = strlen(name);
    if (length == 0 || length >= RLF_NAME_MAX) {
        return io_json_fail(body, "name", "has %zu bytes: it must be %s", length, field.meaning);
    }
    for (size_t i = 0; i < length; i++) {
        if (is_control(name[i])) {
            return io_json_fail(body, "name", "holds a control character: use printable text");
        }
    }
    if (strcmp(name, "background") == 0 || strcmp(name, "foreground") == 0) {
        return io_json_fail(body, "name",
                            "is \"%s\", which contacts.csv uses for the real surface: choose "
                            "another",
                            name);
    }
    memcpy(out, name, length + 1);
    return RLF_OK;
}
