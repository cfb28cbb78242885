/* A scene file with models of real things put elsewhere. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "relief/io.h"
#include "io/json.h"

#include <stdlib.h>
#include <string.h>

/* Length of the folder's name with its last slash; 0 = the current folder. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? (size_t)(slash - path) + 1 : 0;
}

/* Names of models start at the scene's folder; in another one they get whole paths. */
static rlf_result move_model(json_t *object, const char *from, const char *to)
{
    json_t *model = json_object_get(object, "model");
    size_t length = folder_length(from);
    if (!json_is_string(model) || json_string_value(model)[0] == '/' ||
        (length == folder_length(to) && memcmp(from, to, length) == 0)) {
        return RLF_OK;
    }
    char folder[IO_PATH_MAX] = ".";
    char path[IO_PATH_MAX];
    if (length > 0 && length < sizeof(folder)) {
        memcpy(folder, from, length);
        folder[length] = '\0';
    }
    rlf_result result = io_path_join(folder, json_string_value(model), path);
    char *whole = result == RLF_OK ? realpath(path, NULL) : NULL;
    if (whole != NULL) {
        json_string_set(model, whole);
        free(whole);
    }
    return result;
}

static rlf_result move_models(json_t *list, const char *from, const char *to)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < json_array_size(list) && result == RLF_OK; i++) {
        result = move_model(json_array_get(list, i), from, to);
    }
    return result;
}

/* A pattern's model is named in its body. */
static rlf_result move_spawn_models(json_t *list, const char *from, const char *to)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < json_array_size(list) && result == RLF_OK; i++) {
        result = move_model(json_object_get(json_array_get(list, i), "body"), from, to);
    }
    return result;
}

static void set_pose(json_t *object, const rlf_pose *T)
{
    json_object_del(object, "points");
    json_object_set_new(object, "position", json_pack("[fff]", T->p.x, T->p.y, T->p.z));
    json_object_set_new(object, "orientation", json_pack("[ffff]", T->q.x, T->q.y, T->q.z, T->q.w));
}

static rlf_result set_poses(json_t *document, const rlf_known_def *known, int32_t count)
{
    json_t *list = json_object_get(document, "known_objects");
    for (int32_t i = 0; i < count; i++) {
        json_t *object = NULL;
        for (size_t k = 0; k < json_array_size(list) && object == NULL; k++) {
            json_t *entry = json_array_get(list, k);
            const char *name = json_string_value(json_object_get(entry, "name"));
            object = name != NULL && strcmp(name, known[i].name) == 0 ? entry : NULL;
        }
        if (object == NULL) {
            return rlf_fail(RLF_ERROR_INVALID, "the scene has no known object \"%s\"",
                            known[i].name);
        }
        if (known[i].has_pose) {
            set_pose(object, &known[i].T_world_model);
        }
    }
    return RLF_OK;
}

rlf_result rlf_scene_save_known(const char *scene_path, const rlf_known_def *known, int32_t count,
                                const char *out_path)
{
    if (!RLF_ASSERT(scene_path != NULL && out_path != NULL && (known != NULL || count == 0))) {
        return RLF_ERROR_INVALID;
    }
    io_buffer buffer = {0};
    io_bytes file;
    json_t *document = NULL;
    rlf_result result =
        io_file_read(scene_path, IO_JSON_FILE_MAX, "check the name of the scene", &buffer, &file);
    result = result == RLF_OK ? io_json_parse(&file, &document) : result;
    result = result == RLF_OK ? set_poses(document, known, count) : result;
    if (result == RLF_OK) {
        result = move_models(json_object_get(document, "bodies"), scene_path, out_path);
    }
    if (result == RLF_OK) {
        result = move_spawn_models(json_object_get(document, "spawn"), scene_path, out_path);
    }
    if (result == RLF_OK) {
        result = move_models(json_object_get(document, "known_objects"), scene_path, out_path);
    }
    if (result == RLF_OK) {
        result = io_json_write(out_path, json_incref(document), 9);
    }
    json_decref(document);
    io_buffer_free(&buffer);
    return result;
}
