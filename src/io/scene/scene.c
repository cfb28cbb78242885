/* scene.json: gravity, border, and what else there is to start with. */
#include "relief/io.h"
#include "io/scene/reader.h"

#include <string.h>

/* ---- "on": what events of hands do ------------------------------------------------------- */

static const char *const action_names[RLF_HAND_ACTION_COUNT] = {"none", "spawn", "throw", "remove",
                                                                "reset"};

static rlf_result read_action(const io_json_object *on, const char *key, rlf_scene *scene)
{
    const io_json_field field = {key, "none, spawn, throw, remove or reset", 0, 0, true};
    rlf_hand_event_kind kind;
    if (!rlf_hand_event_parse(key, &kind)) {
        return io_json_fail(on, key,
                            "is not an event of a hand: use pinch, pinch_end, open, fist, point, "
                            "point_end, push, swipe_left, swipe_right or wave");
    }
    const char *name = NULL;
    rlf_result result = io_json_get_text(on, &field, &name);
    if (result != RLF_OK) {
        return result;
    }
    for (int k = 0; k < RLF_HAND_ACTION_COUNT; k++) {
        if (strcmp(name, action_names[k]) == 0) {
            scene->on[kind] = (rlf_hand_action)k;
            return RLF_OK;
        }
    }
    return io_json_fail(on, key, "is \"%.60s\": it must be %s", name, field.meaning);
}

/* on.c: the object "on". */
static rlf_result read_on(const io_json_object *top, rlf_scene *scene)
{
    static const io_json_field field = {"on", "an object of events and actions", 0, 0, false};
    io_json_object on;
    rlf_result result = io_json_get_object(top, &field, &on);
    if (result != RLF_OK || on.value == NULL) {
        return result;
    }
    const char *key;
    json_t *value;
    json_object_foreach(on.value, key, value)
    {
        result = result == RLF_OK ? read_action(&on, key, scene) : result;
    }
    return result;
}

static rlf_result read_border(const io_json_object *top, rlf_border *out)
{
    static const io_json_field field = {"border", "\"open\" or \"extend\"", 0, 0, false};
    const char *name = "extend";
    rlf_result result = io_json_get_text(top, &field, &name);
    if (result != RLF_OK) {
        return result;
    }
    bool is_extended = strcmp(name, "extend") == 0;
    if (!is_extended && strcmp(name, "open") != 0) {
        return io_json_fail(top, "border", "is \"%.60s\": it must be %s", name, field.meaning);
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
    return scene->finds_gravity ? RLF_OK : io_json_get_vec3(top, &field, &scene->gravity);
}

/* Bodies, patterns of them, known objects. */
static rlf_result read_objects(const io_json_object *top, const char *folder, rlf_scene *scene)
{
    io_scene_reader reader = {
        .folder = folder, .bodies = json_array(), .names = json_object(), .scene = scene};
    rlf_result result = RLF_ERROR_MEMORY;
    if (reader.bodies != NULL && reader.names != NULL) {
        result = io_scene_read_bodies(top, &reader);
    }
    result = result == RLF_OK ? io_spawn_read(top, &reader) : result;
    result = result == RLF_OK ? io_known_read(top, &reader) : result;
    json_decref(reader.bodies);
    json_decref(reader.names);
    return result;
}

/* What lists of scenes show: nothing happens by it. */
static rlf_result check_words(const io_json_object *top)
{
    static const io_json_field about = {"about", "a line of text", 0, 0, false};
    static const io_json_field source = {"source", "a SOURCE, e.g. \"synthetic:room\"", 0, 0,
                                         false};
    const char *text = NULL;
    rlf_result result = io_json_get_text(top, &about, &text);
    return result == RLF_OK ? io_json_get_text(top, &source, &text) : result;
}

static rlf_result read_scene(const io_json_object *top, const char *folder, rlf_scene *scene)
{
    static const char *const known[] = {"about",  "source", "gravity",       "border",
                                        "bodies", "spawn",  "known_objects", "on"};
    const char *unknown = io_json_unknown_key(top, known, 8);
    if (unknown != NULL) {
        return io_json_fail(top, unknown,
                            "is not a known key: a scene has \"about\", \"source\", \"gravity\", "
                            "\"border\", \"bodies\", \"spawn\", \"known_objects\" and \"on\"");
    }
    rlf_result result = check_words(top);
    result = result == RLF_OK ? read_gravity(top, scene) : result;
    result = result == RLF_OK ? read_border(top, &scene->border) : result;
    result = result == RLF_OK ? read_objects(top, folder, scene) : result;
    return result == RLF_OK ? read_on(top, scene) : result;
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
