/* scene.json's known objects: models of real things, placed by a pose or by points. */
#include "io/scene/reader.h"

#define POSITION_MAX_M 1e6

static rlf_result read_model_point(const io_json_object *point, const rlf_shape *shape,
                                   rlf_vec3 *out)
{
    static const io_json_field numbers = {"model", "a point's name, or its x, y, z in metres",
                                          -POSITION_MAX_M, POSITION_MAX_M, true};
    const json_t *value = json_object_get(point->value, "model");
    if (!json_is_string(value)) {
        return io_json_get_vec3(point, &numbers, out);
    }
    if (!rlf_known_name_point(shape, json_string_value(value), out)) {
        return io_json_fail(point, "model",
                            "is \"%.30s\", which the shape does not have: use three letters like "
                            "\"ltn\" (a hull: \"v\" and a vertex), or x, y, z",
                            json_string_value(value));
    }
    return RLF_OK;
}

static rlf_result read_point(const io_json_object *point, const rlf_shape *shape,
                             rlf_known_point *out)
{
    static const char *const keys[] = {"model", "pixel", "world"};
    static const io_json_field pixel = {"pixel",
                                        "two numbers: right and down from the middle of "
                                        "the picture's first pixel",
                                        -POSITION_MAX_M, POSITION_MAX_M, true};
    static const io_json_field world = {"world", "three numbers of metres", -POSITION_MAX_M,
                                        POSITION_MAX_M, true};
    const char *unknown = io_json_unknown_key(point, keys, 3);
    if (unknown != NULL) {
        return io_json_fail(point, unknown,
                            "is not a known key: a point has \"model\" and \"pixel\" or \"world\"");
    }
    bool has_world = json_object_get(point->value, "world") != NULL;
    out->has_pixel = json_object_get(point->value, "pixel") != NULL;
    if (out->has_pixel == has_world) {
        return io_json_fail(point, "", "must have either \"pixel\" or \"world\"");
    }
    rlf_result result = read_model_point(point, shape, &out->model);
    if (result != RLF_OK) {
        return result;
    }
    return out->has_pixel ? io_json_get_numbers(point, &pixel, out->pixel, 2)
                          : io_json_get_vec3(point, &world, &out->world);
}

static rlf_result read_points(const io_json_object *object, rlf_known_def *def)
{
    const json_t *points = json_object_get(object->value, "points");
    size_t count = json_array_size(points);
    if (points == NULL) {
        return RLF_OK;
    }
    if (!json_is_array(points) || count < RLF_KNOWN_POINTS_MIN || count > RLF_KNOWN_POINTS_MAX) {
        return io_json_fail(object, "points", "must be an array of %d to %d objects",
                            RLF_KNOWN_POINTS_MIN, RLF_KNOWN_POINTS_MAX);
    }
    for (size_t i = 0; i < count; i++) {
        io_json_object point = {.file = object->file, .value = json_array_get(points, i)};
        snprintf(point.path, sizeof(point.path), "%.60s.points[%zu]", object->path, i);
        if (!json_is_object(point.value)) {
            return io_json_fail(&point, "", "must be an object {...}");
        }
        rlf_result result = read_point(&point, &def->shape, &def->points[i]);
        if (result != RLF_OK) {
            return result;
        }
    }
    def->point_count = (int32_t)count;
    return RLF_OK;
}

/* A pose, or points, or neither: then it waits to be placed. */
static rlf_result read_place(const io_json_object *object, rlf_known_def *def)
{
    static const io_json_field position = {"position", "three numbers of metres", -POSITION_MAX_M,
                                           POSITION_MAX_M, false};
    bool has_points = json_object_get(object->value, "points") != NULL;
    def->has_pose = json_object_get(object->value, "position") != NULL;
    if (has_points && def->has_pose) {
        return io_json_fail(object, "points", "and \"position\" exclude each other: take one out");
    }
    if (!def->has_pose && json_object_get(object->value, "orientation") != NULL) {
        return io_json_fail(object, "orientation", "needs a \"position\"");
    }
    rlf_result result = io_json_get_vec3(object, &position, &def->T_world_model.p);
    result = result == RLF_OK ? io_json_get_orientation(object, &def->T_world_model.q) : result;
    return result == RLF_OK ? read_points(object, def) : result;
}

static rlf_result read_known(const io_json_object *object, const io_scene_reader *reader,
                             rlf_known_def *def)
{
    static const char *const keys[] = {"name",     "shape",       "size",        "radius", "height",
                                       "model",    "position",    "orientation", "points", "refine",
                                       "collides", "restitution", "friction"};
    static const io_json_field refine = {"refine", "true or false", 0, 0, false};
    static const io_json_field collides = {"collides", "true or false", 0, 0, false};
    static const io_json_field restitution = {"restitution", "a number from 0 to 1", 0, 1, false};
    static const io_json_field friction = {"friction", "a number >= 0 and at most 1000", 0, 1000,
                                           false};
    const char *unknown = io_json_unknown_key(object, keys, sizeof(keys) / sizeof(keys[0]));
    if (unknown != NULL) {
        return io_json_fail(object, unknown, "is not a known key: see the list in docs/formats.md");
    }
    rlf_result result = io_scene_read_name(object, def->name);
    if (result == RLF_OK && def->name[0] == '\0') {
        result = io_json_fail(object, "name", "is missing: a known object needs one");
    }
    result = result == RLF_OK ? io_json_get_bool(object, &refine, &def->refine) : result;
    result = result == RLF_OK ? io_json_get_bool(object, &collides, &def->collides) : result;
    if (result == RLF_OK) {
        result = io_json_get_number(object, &restitution, &def->restitution);
    }
    result = result == RLF_OK ? io_json_get_number(object, &friction, &def->friction) : result;
    if (result == RLF_OK) {
        result = io_scene_read_shape(object, reader, &def->shape, &def->look);
    }
    return result == RLF_OK ? read_place(object, def) : result;
}

rlf_result io_known_read(const io_json_object *top, const io_scene_reader *reader)
{
    rlf_scene *scene = reader->scene;
    const json_t *list = json_object_get(top->value, "known_objects");
    if (list == NULL) {
        return RLF_OK;
    }
    size_t count = json_array_size(list);
    if (!json_is_array(list) || count > RLF_KNOWN_MAX) {
        return io_json_fail(top, "known_objects", "must be an array of at most %d objects",
                            RLF_KNOWN_MAX);
    }
    scene->known = rlf_alloc_array(count, sizeof(scene->known[0]));
    if (scene->known == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        io_json_object object = {.file = top->file, .value = json_array_get(list, i)};
        snprintf(object.path, sizeof(object.path), "known_objects[%zu]", i);
        if (!json_is_object(object.value)) {
            return io_json_fail(&object, "", "must be an object {...}");
        }
        rlf_known_def *def = &scene->known[i];
        *def = rlf_known_def_default();
        rlf_result result = read_known(&object, reader, def);
        result = result == RLF_OK ? io_scene_note_name(&object, reader, def->name) : result;
        scene->known_count++; /* also when it failed: its hull must be freed */
        if (result != RLF_OK) {
            return result;
        }
    }
    return RLF_OK;
}
