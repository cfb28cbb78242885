/* Bodies of scene.json: one at a time, and the list "bodies". */
#include "io/scene/reader.h"

#include <string.h>

#define FINITE_MAX 1e6 /* metres, m/s, rad/s: far beyond any scene, and squares stay finite */

static rlf_result read_motion(const io_json_object *body, rlf_body_def *def)
{
    static const io_json_field position = {"position", "three numbers of metres", -FINITE_MAX,
                                           FINITE_MAX, false};
    static const io_json_field velocity = {"velocity", "three numbers of m/s", -FINITE_MAX,
                                           FINITE_MAX, false};
    static const io_json_field spin = {"angular_velocity", "three numbers of rad/s", -FINITE_MAX,
                                       FINITE_MAX, false};
    rlf_result result = io_json_get_vec3(body, &position, &def->position);
    result = result == RLF_OK ? io_json_get_orientation(body, &def->orientation) : result;
    result = result == RLF_OK ? io_json_get_vec3(body, &velocity, &def->velocity) : result;
    result = result == RLF_OK ? io_json_get_vec3(body, &spin, &def->angular_velocity) : result;
    return result;
}

static rlf_result read_material(const io_json_object *body, rlf_body_def *def)
{
    static const io_json_field fields[8] = {
        {"mass", "a number of kg, from 1e-6 to 1e6", 1e-6, 1e6, false},
        {"restitution", "a number from 0 to 1", 0, 1, false},
        {"friction", "a number >= 0 and at most 1000", 0, 1000, false},
        {"rolling_resistance", "a number >= 0 and at most 1000", 0, 1000, false},
        {"gravity_scale", "a number from -1000 to 1000", -1000, 1000, false},
        {"release_time", "a number of seconds, >= 0 and at most 1e6", 0, 1e6, false},
        {"linear_damping", "a number per second, >= 0 and at most 1000", 0, 1000, false},
        {"angular_damping", "a number per second, >= 0 and at most 1000", 0, 1000, false}};
    static const io_json_field collides = {"collides_with_bodies", "true or false", 0, 0, false};
    static const io_json_field kinematic = {"kinematic", "true or false", 0, 0, false};
    static const io_json_field color = {"color", "three numbers from 0 to 1 (red, green, blue)", 0,
                                        1, false};
    double *const targets[8] = {
        &def->mass,          &def->restitution,  &def->friction,       &def->rolling_resistance,
        &def->gravity_scale, &def->release_time, &def->linear_damping, &def->angular_damping};
    for (int i = 0; i < 8; i++) {
        rlf_result result = io_json_get_number(body, &fields[i], targets[i]);
        if (result != RLF_OK) {
            return result;
        }
    }
    rlf_result result = io_json_get_bool(body, &collides, &def->collides_with_bodies);
    result = result == RLF_OK ? io_json_get_bool(body, &kinematic, &def->is_kinematic) : result;
    double c[3] = {def->color[0], def->color[1], def->color[2]};
    result = result == RLF_OK ? io_json_get_numbers(body, &color, c, 3) : result;
    for (int i = 0; i < 3; i++) {
        def->color[i] = (float)c[i];
    }
    return result;
}

static rlf_result read_body(const io_json_object *body, const io_scene_reader *reader,
                            rlf_body_def *def)
{
    static const char *const known[] = {"name",           "shape",
                                        "size",           "radius",
                                        "height",         "model",
                                        "vertices",       "mass",
                                        "position",       "orientation",
                                        "velocity",       "angular_velocity",
                                        "restitution",    "friction",
                                        "gravity_scale",  "rolling_resistance",
                                        "linear_damping", "angular_damping",
                                        "release_time",   "collides_with_bodies",
                                        "kinematic",      "color"};
    const char *unknown = io_json_unknown_key(body, known, sizeof(known) / sizeof(known[0]));
    if (unknown != NULL) {
        return io_json_fail(body, unknown, "is not a known key: see the list in docs/formats.md");
    }
    rlf_result result = io_scene_read_name(body, def->name);
    result = result == RLF_OK ? read_motion(body, def) : result;
    result = result == RLF_OK ? read_material(body, def) : result;
    result = result == RLF_OK ? io_scene_read_shape(body, reader, &def->shape, &def->look) : result;
    /* A model has colours of its own: a body's colour tints it only when it is given. */
    if (def->look.model != NULL && json_object_get(body->value, "color") == NULL) {
        def->color[0] = def->color[1] = def->color[2] = 1.0f;
    }
    return result;
}

rlf_result io_scene_note_name(const io_json_object *body, const io_scene_reader *reader,
                              const char *name)
{
    if (name[0] == '\0') {
        return RLF_OK;
    }
    const json_t *other = json_object_get(reader->names, name);
    if (other != NULL) {
        return io_json_fail(body, "name", "is \"%s\" like that of %s: choose another", name,
                            json_string_value(other));
    }
    bool is_noted = json_object_set_new(reader->names, name, json_string(body->path)) == 0;
    return is_noted ? RLF_OK : RLF_ERROR_MEMORY;
}

rlf_result io_scene_note_body(const io_json_object *body, const io_scene_reader *reader)
{
    const rlf_body_def *def = &reader->scene->bodies[reader->scene->body_count - 1];
    bool is_noted = json_array_append(reader->bodies, body->value) == 0;
    return is_noted ? io_scene_note_name(body, reader, def->name) : RLF_ERROR_MEMORY;
}

rlf_result io_scene_reserve(io_scene_reader *reader, int32_t count)
{
    rlf_scene *scene = reader->scene;
    return io_list_grow((void **)(void *)&scene->bodies, scene->body_count, count,
                        &reader->capacity, sizeof(scene->bodies[0]));
}

rlf_result io_scene_read_body(const io_json_object *body, const io_scene_reader *reader)
{
    rlf_body_def *def = &reader->scene->bodies[reader->scene->body_count];
    *def = rlf_body_def_default();
    rlf_result result = read_body(body, reader, def);
    reader->scene->body_count++; /* also when it failed: its hull must be freed */
    return result;
}

rlf_result io_scene_read_bodies(const io_json_object *top, io_scene_reader *reader)
{
    const json_t *bodies = json_object_get(top->value, "bodies");
    if (bodies == NULL) {
        return RLF_OK;
    }
    size_t count = json_array_size(bodies);
    if (!json_is_array(bodies) || count > IO_SCENE_BODIES_MAX) {
        return io_json_fail(top, "bodies", "must be an array of at most %d objects",
                            IO_SCENE_BODIES_MAX);
    }
    rlf_result result = io_scene_reserve(reader, (int32_t)count);
    for (size_t i = 0; i < count && result == RLF_OK; i++) {
        io_json_object body = {.file = top->file, .value = json_array_get(bodies, i)};
        snprintf(body.path, sizeof(body.path), "bodies[%zu]", i);
        if (!json_is_object(body.value)) {
            return io_json_fail(&body, "", "must be an object {...}");
        }
        result = io_scene_read_body(&body, reader);
        result = result == RLF_OK ? io_scene_note_body(&body, reader) : result;
    }
    return result;
}
