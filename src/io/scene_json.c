/* scene.json: gravity and the bodies to start with. */
#include "relief/io.h"
#include "io/scene_json.h"

#include <string.h>

#define BODIES_MAX 65536
#define FINITE_MAX 1e6 /* metres, m/s, rad/s: far beyond any scene, and squares stay finite */

static rlf_result read_motion(const io_json_object *body, rlf_body_def *def)
{
    static const io_json_field position = {"position", "three numbers of metres", -FINITE_MAX,
                                           FINITE_MAX, false};
    static const io_json_field velocity = {"velocity", "three numbers of m/s", -FINITE_MAX,
                                           FINITE_MAX, false};
    static const io_json_field spin = {"angular_velocity", "three numbers of rad/s", -FINITE_MAX,
                                       FINITE_MAX, false};
    rlf_result result = io_scene_read_vec3(body, &position, &def->position);
    if (result == RLF_OK) {
        result = io_scene_read_orientation(body, &def->orientation);
    }
    if (result == RLF_OK) {
        result = io_scene_read_vec3(body, &velocity, &def->velocity);
    }
    if (result == RLF_OK) {
        result = io_scene_read_vec3(body, &spin, &def->angular_velocity);
    }
    return result;
}

static rlf_result read_material(const io_json_object *body, rlf_body_def *def)
{
    static const io_json_field fields[8] = {
        {"mass", "a number of kg, > 0 and at most 1e6", IO_POSITIVE, 1e6, false},
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
    if (result == RLF_OK) {
        result = io_json_get_bool(body, &kinematic, &def->is_kinematic);
    }
    double c[3] = {def->color[0], def->color[1], def->color[2]};
    if (result == RLF_OK) {
        result = io_json_get_numbers(body, &color, c, 3);
    }
    for (int i = 0; i < 3; i++) {
        def->color[i] = (float)c[i];
    }
    return result;
}

static rlf_result read_body(const io_json_object *body, const io_scene_reader *reader)
{
    rlf_body_def *def = &reader->scene->bodies[reader->scene->body_count];
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
    if (result == RLF_OK) {
        result = read_motion(body, def);
    }
    if (result == RLF_OK) {
        result = read_material(body, def);
    }
    if (result == RLF_OK) {
        result = io_scene_read_shape(body, reader, &def->shape, &def->look);
    }
    /* A model has colours of its own: a body's colour tints it only when it is given. */
    if (def->look.model != NULL && json_object_get(body->value, "color") == NULL) {
        def->color[0] = def->color[1] = def->color[2] = 1.0f;
    }
    return result;
}

/* Logs tell bodies apart by their names. */
static rlf_result check_name_is_new(const io_json_object *body, const rlf_scene *scene,
                                    const char *name)
{
    for (int32_t i = 0; i < scene->body_count && name[0] != '\0'; i++) {
        if (strcmp(scene->bodies[i].name, name) == 0) {
            return io_json_fail(body, "name", "is \"%s\" like that of bodies[%d]: choose another",
                                name, (int)i);
        }
    }
    return RLF_OK;
}

static rlf_result read_bodies(const io_json_object *top, const char *folder, rlf_scene *scene)
{
    const json_t *bodies = json_object_get(top->value, "bodies");
    if (bodies == NULL) {
        return RLF_OK;
    }
    size_t count = json_array_size(bodies);
    if (!json_is_array(bodies) || count > BODIES_MAX) {
        return io_json_fail(top, "bodies", "must be an array of at most %d objects", BODIES_MAX);
    }
    scene->bodies = rlf_alloc_array(count, sizeof(scene->bodies[0]));
    if (scene->bodies == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const io_scene_reader reader = {folder, bodies, scene};
    for (size_t i = 0; i < count; i++) {
        io_json_object body = {.file = top->file, .value = json_array_get(bodies, i)};
        snprintf(body.path, sizeof(body.path), "bodies[%zu]", i);
        if (!json_is_object(body.value)) {
            return io_json_fail(&body, "", "must be an object {...}");
        }
        rlf_body_def *def = &scene->bodies[i];
        *def = rlf_body_def_default();
        rlf_result result = read_body(&body, &reader);
        if (result == RLF_OK) {
            result = check_name_is_new(&body, scene, def->name);
        }
        scene->body_count++; /* also when it failed: its hull must be freed */
        if (result != RLF_OK) {
            return result;
        }
    }
    return RLF_OK;
}

static rlf_result read_border(const io_json_object *top, rlf_border *out)
{
    static const io_json_field field = {"border", "\"open\" or \"extend\"", 0, 0, false};
    const char *name = "open";
    rlf_result result = io_json_get_text(top, &field, &name);
    if (result != RLF_OK) {
        return result;
    }
    bool is_extended = strcmp(name, "extend") == 0;
    if (!is_extended && strcmp(name, "open") != 0) {
        char printable[64];
        io_json_printable(name, printable, sizeof(printable));
        return io_json_fail(top, "border", "is \"%s\": it must be %s", printable, field.meaning);
    }
    *out = is_extended ? RLF_BORDER_EXTEND : RLF_BORDER_OPEN;
    return RLF_OK;
}

/* Three numbers, or "floor". */
static rlf_result read_gravity(const io_json_object *top, rlf_scene *scene)
{
    static const io_json_field field = {
        "gravity", "three numbers of m/s^2, each from -1000 to 1000, or \"floor\"", -1000, 1000,
        false};
    const json_t *value = json_object_get(top->value, "gravity");
    scene->gravity = rlf_world_def_default().gravity;
    scene->is_gravity_given = value != NULL;
    scene->finds_gravity = json_is_string(value) && strcmp(json_string_value(value), "floor") == 0;
    return scene->finds_gravity ? RLF_OK : io_scene_read_vec3(top, &field, &scene->gravity);
}

static rlf_result read_scene(const io_json_object *top, const char *folder, rlf_scene *scene)
{
    static const char *const known[] = {"gravity", "border", "bodies", "known_objects"};
    const char *unknown = io_json_unknown_key(top, known, 4);
    if (unknown != NULL) {
        return io_json_fail(top, unknown,
                            "is not a known key: a scene has \"gravity\", \"border\", \"bodies\" "
                            "and \"known_objects\"");
    }
    rlf_result result = read_gravity(top, scene);
    if (result == RLF_OK) {
        result = read_border(top, &scene->border);
    }
    if (result == RLF_OK) {
        result = read_bodies(top, folder, scene);
    }
    return result == RLF_OK ? io_known_read(top, folder, scene) : result;
}

rlf_result io_scene_parse(const io_bytes *file, const char *folder, rlf_scene *out)
{
    memset(out, 0, sizeof(*out));
    json_t *document = NULL;
    rlf_result result = io_json_parse(file, &document);
    if (result != RLF_OK) {
        return result;
    }
    io_json_object top = io_json_top(file, document);
    result = read_scene(&top, folder, out);
    json_decref(document);
    if (result != RLF_OK) {
        rlf_scene_destroy(out);
    }
    return result;
}

rlf_result rlf_scene_load(const char *path, rlf_scene *out)
{
    if (!RLF_ASSERT(path != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    memset(out, 0, sizeof(*out));
    io_buffer buffer = {0};
    io_bytes file;
    rlf_result result =
        io_file_read(path, IO_JSON_FILE_MAX,
                     "check the name of the scene, docs/formats.md shows one", &buffer, &file);
    if (result == RLF_OK) {
        char folder[IO_PATH_MAX] = ".";
        const char *slash = strrchr(path, '/');
        if (slash != NULL && (size_t)(slash - path) + 1 < IO_PATH_MAX) {
            size_t length = (size_t)(slash - path) + 1;
            memcpy(folder, path, length);
            folder[length] = '\0';
        }
        result = io_scene_parse(&file, folder, out);
    }
    io_buffer_free(&buffer);
    return result;
}
