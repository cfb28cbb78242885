/* A file that lists cameras of one room, and where they stand. */
#include "relief/io.h"

#include "io/json.h"

#include <string.h>

static const char *const top_keys[] = {"about", "cameras"};
static const char *const camera_keys[] = {"source", "position", "orientation", "calibration"};

/* A path is meant from where the list lies; everything else is an address. */
static rlf_result place_source(const io_json_object *object, const char *source, char out[1024])
{
    const char *slash = strrchr(object->file, '/');
    const bool is_beside = strchr(source, ':') == NULL && source[0] != '/' && slash != NULL;
    const int folder = is_beside ? (int)(slash - object->file) + 1 : 0;
    const int length = snprintf(out, 1024, "%.*s%s", folder, object->file, source);
    return length > 0 && length < 1024
               ? RLF_OK
               : io_json_fail(object, "source", "is too long: it must have up to 1000 letters");
}

static rlf_result read_pose(const io_json_object *object, rlf_pose *out)
{
    static const io_json_field position_field = {
        "position", "three numbers: metres to the right, down and ahead, in the world", -1e3, 1e3,
        false};
    *out = rlf_pose_identity();
    rlf_result result = io_json_get_vec3(object, &position_field, &out->p);
    return result == RLF_OK ? io_json_get_orientation(object, &out->q) : result;
}

/* A calibration of the first camera, left, and this one, right, says p_right = T p_left. */
static rlf_result read_calibration(const io_json_object *object, const char *name,
                                   const rlf_pose *T_world_first, rlf_pose *out)
{
    char path[1024];
    double units;
    rlf_rig rig;
    if (json_object_get(object->value, "position") != NULL ||
        json_object_get(object->value, "orientation") != NULL) {
        return io_json_fail(object, "calibration",
                            "says the pose: it must be alone, without "
                            "position and orientation");
    }
    rlf_result result = place_source(object, name, path);
    if (result == RLF_OK) {
        result = rlf_rig_load(path, &rig, &units);
    }
    if (result == RLF_OK && !rig.has_color) {
        return io_json_fail(object, "calibration",
                            "is of one camera: it must be that of the first "
                            "camera, --left, and this one, --right");
    }
    if (result == RLF_OK) {
        const rlf_pose T_first_this = rlf_pose_invert(&rig.T_color_depth);
        *out = rlf_pose_mul(T_world_first, &T_first_this);
    }
    return result;
}

static rlf_result read_one(const io_json_object *object, const rlf_pose *T_world_first,
                           rlf_placed_camera *out)
{
    static const io_json_field calibration_field = {
        "calibration", "the file of `relief calibrate`, in quotes", 0, 0, false};
    const char *calibration = NULL;
    static const io_json_field source_field = {
        "source", "a SOURCE as `relief list sources` tells them, in quotes", 0, 0, true};
    const char *source = NULL;
    const char *key = io_json_unknown_key(object, camera_keys, 4);
    if (key != NULL) {
        return io_json_fail(object, key,
                            "is no key of a camera: these are source, position, "
                            "orientation, calibration");
    }
    rlf_result result = io_json_get_text(object, &source_field, &source);
    if (result == RLF_OK) {
        result = place_source(object, source, out->source);
    }
    if (result == RLF_OK) {
        result = io_json_get_text(object, &calibration_field, &calibration);
    }
    if (result != RLF_OK) {
        return result;
    }
    return calibration != NULL
               ? read_calibration(object, calibration, T_world_first, &out->T_world_camera)
               : read_pose(object, &out->T_world_camera);
}

static rlf_result read_cameras(const io_json_object *top, rlf_placed_camera *out, int32_t *count)
{
    json_t *list = json_object_get(top->value, "cameras");
    const char *key = io_json_unknown_key(top, top_keys, 2);
    const size_t size = json_array_size(list);
    if (key != NULL) {
        return io_json_fail(top, key, "is no key of a list of cameras: these are about, cameras");
    }
    if (!json_is_array(list) || size < 1 || size > RLF_WORLD_CAMERAS_MAX) {
        return io_json_fail(top, "cameras", "must be a list of 1 to %d cameras",
                            RLF_WORLD_CAMERAS_MAX);
    }
    for (size_t i = 0; i < size; i++) {
        io_json_object one = {.file = top->file, .value = json_array_get(list, i)};
        (void)snprintf(one.path, sizeof(one.path), "cameras[%d]", (int)i);
        if (!json_is_object(one.value)) {
            return io_json_fail(&one, "source", "is missing: a camera must be an object");
        }
        rlf_result result = read_one(&one, &out[0].T_world_camera, &out[i]);
        if (result != RLF_OK) {
            return result;
        }
    }
    *count = (int32_t)size;
    return RLF_OK;
}

rlf_result rlf_cameras_load(const char *path, rlf_placed_camera *out, int32_t *out_count)
{
    if (!RLF_ASSERT(path != NULL && out != NULL && out_count != NULL)) {
        return RLF_ERROR_INVALID;
    }
    io_buffer buffer = {NULL, 0};
    io_bytes file;
    json_t *document = NULL;
    *out_count = 0;
    rlf_result result =
        io_file_read(path, IO_JSON_FILE_MAX, "check the name of the list", &buffer, &file);
    if (result == RLF_OK) {
        result = io_json_parse(&file, &document);
    }
    if (result == RLF_OK) {
        const io_json_object top = io_json_top(&file, document);
        result = read_cameras(&top, out, out_count);
    }
    json_decref(document);
    io_buffer_free(&buffer);
    return result;
}
