/* Models and hulls of scene.json's bodies. */
#include "relief/io.h"
#include "io/model/hull.h"
#include "io/model/model.h"
#include "io/scene/reader.h"
#include "io/scene/pattern.h"

#include <string.h>

#define POINTS_MAX 4096
#define POINT_MAX_M 100.0

static rlf_result get_name(const io_json_object *body, const char **out)
{
    static const io_json_field field = {"model", "the name of a .gltf, .glb or .obj file", 0, 0,
                                        false};
    *out = NULL;
    return io_json_get_text(body, &field, out);
}

/* The error of a file, with where it was named before it. */
static rlf_result fail_key(const io_json_object *body, const char *key, rlf_result result)
{
    return rlf_fail(result, "%s: %s.%s: %.760s", body->file, body->path, key, rlf_error_text());
}

/* The last body before this one that has the same model, and is a hull of the same size when
 * `is_hull`; NULL = none. */
static const rlf_body_def *find_alike(const io_json_object *body, const io_scene_reader *reader,
                                      bool is_hull)
{
    const json_t *name = json_object_get(body->value, "model");
    const json_t *size = json_object_get(body->value, "size");
    for (int32_t i = reader->scene->body_count - 1; i >= 0; i--) {
        const json_t *other = json_array_get(reader->bodies, (size_t)i);
        const rlf_body_def *def = &reader->scene->bodies[i];
        bool is_same = json_equal(name, json_object_get(other, "model")) != 0 &&
                       (is_hull || def->look.model != NULL);
        if (is_same && is_hull) {
            const json_t *other_size = json_object_get(other, "size");
            is_same = def->shape.type == RLF_SHAPE_HULL &&
                      (size == other_size || json_equal(size, other_size) != 0);
        }
        if (is_same) {
            return def;
        }
    }
    return NULL;
}

/* The scene's from now on; room for 1, 2, 4, 8 ... models is made when it is needed. */
static rlf_result keep_model(rlf_scene *scene, rlf_model *model)
{
    int32_t count = scene->model_count;
    if ((count & (count - 1)) == 0) {
        size_t room = count > 0 ? 2 * (size_t)count : 1;
        rlf_model **models = rlf_alloc_array(room, sizeof(*models));
        if (models == NULL) {
            rlf_model_destroy(&model);
            return RLF_ERROR_MEMORY;
        }
        for (int32_t i = 0; i < count; i++) {
            models[i] = scene->models[i];
        }
        rlf_free(scene->models);
        scene->models = models;
    }
    scene->models[scene->model_count++] = model;
    return RLF_OK;
}

/* The model of the body's key, from an earlier body or from its file. */
static rlf_result find_model(const io_json_object *body, const io_scene_reader *reader,
                             const char *path, const rlf_model **out)
{
    const rlf_body_def *alike = find_alike(body, reader, false);
    if (alike != NULL) {
        *out = alike->look.model;
        return RLF_OK;
    }
    rlf_model *model = NULL;
    rlf_result result = rlf_model_load(path, &model);
    result = result == RLF_OK ? keep_model(reader->scene, model) : result;
    *out = result == RLF_OK ? model : NULL;
    return result;
}

static rlf_result fail_extent(const char *path)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s: all its vertices are in one place: export it again",
                    path);
}

/* ---- looks ---------------------------------------------------------------------------------- */

/* Extents of the box about a shape. */
static rlf_vec3 extents_of(const rlf_shape *shape)
{
    double width = 2.0 * shape->radius;
    switch (shape->type) {
    case RLF_SHAPE_BOX: return shape->size;
    case RLF_SHAPE_CAPSULE: return rlf_vec3_make(width, shape->height + width, width);
    case RLF_SHAPE_CYLINDER: return rlf_vec3_make(width, shape->height, width);
    case RLF_SHAPE_SPHERE:
    case RLF_SHAPE_HULL: break;
    }
    return rlf_vec3_make(width, width, width);
}

rlf_result io_scene_read_look(const io_json_object *body, const io_scene_reader *reader,
                              const rlf_shape *shape, rlf_look *out)
{
    const char *name = NULL;
    char path[IO_PATH_MAX];
    const rlf_model *model = NULL;
    rlf_result result = get_name(body, &name);
    if (result != RLF_OK || name == NULL) {
        return result;
    }
    double scale = 0.0;
    result = io_path_join(reader->folder, name, path);
    result = result == RLF_OK ? find_model(body, reader, path, &model) : result;
    if (result == RLF_OK) {
        scale = io_model_fit(&model->box, extents_of(shape));
        result = scale > 0.0 ? RLF_OK : fail_extent(path);
    }
    if (result != RLF_OK) {
        return fail_key(body, "model", result);
    }
    rlf_vec3 middle = rlf_scale(rlf_add(model->box.min, model->box.max), 0.5);
    *out = (rlf_look){model, scale, rlf_scale(middle, -scale)};
    return RLF_OK;
}

/* ---- hulls ---------------------------------------------------------------------------------- */

static double fit_hull(const rlf_hull *hull, rlf_vec3 size)
{
    rlf_aabb box = rlf_aabb_empty();
    for (int32_t i = 0; i < hull->vertex_count; i++) {
        rlf_aabb_extend(&box, hull->vertices[i]);
    }
    return size.x > 0.0 ? io_model_fit(&box, size) : 1.0;
}

typedef struct hull_and_look {
    rlf_hull *hull;
    rlf_look look;
} hull_and_look;

/* A hull around any model. */
static rlf_result wrap_model(const io_json_object *body, const io_scene_reader *reader,
                             const char *path, rlf_vec3 size, hull_and_look *out)
{
    const rlf_model *model = NULL;
    rlf_result result = find_model(body, reader, path, &model);
    if (result != RLF_OK) {
        return result;
    }
    double scale = size.x > 0.0 ? io_model_fit(&model->box, size) : 1.0;
    return scale > 0.0 ? io_model_hull(path, model, scale, &out->hull, &out->look)
                       : fail_extent(path);
}

/* An OBJ that is closed and convex is its own hull, drawn in the body's colour unless it has
 * materials; around anything else one is made. */
static rlf_result read_hull_file(const io_json_object *body, const io_scene_reader *reader,
                                 const char *path, rlf_vec3 size, hull_and_look *out)
{
    if (io_model_format_of(path) != IO_MODEL_OBJ) {
        return wrap_model(body, reader, path, size, out);
    }
    io_obj_facts facts;
    rlf_result result = io_hull_load(path, &out->hull, &facts);
    if (result == RLF_ERROR_FORMAT && IO_WRAPS_MODELS) {
        return wrap_model(body, reader, path, size, out);
    }
    if (result != RLF_OK) {
        return result;
    }
    double scale = fit_hull(out->hull, size);
    io_hull_scale(out->hull, scale);
    if (facts.has_materials) {
        const rlf_model *model = NULL;
        result = find_model(body, reader, path, &model);
        out->look = (rlf_look){model, scale, rlf_scale(facts.centre, -scale)};
    }
    return result;
}

static rlf_result read_vertices(const io_json_object *body, rlf_vec3 size, rlf_hull **out)
{
    const json_t *list = json_object_get(body->value, "vertices");
    size_t count = json_array_size(list);
    if (count < 4 || count > POINTS_MAX) {
        return io_json_fail(body, "vertices", "must be an array of 4 to %d points [x, y, z]",
                            POINTS_MAX);
    }
    rlf_vec3 *points = rlf_alloc_array(count, sizeof(*points));
    rlf_result result = points != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (size_t i = 0; i < count && result == RLF_OK; i++) {
        const json_t *p = json_array_get(list, i);
        double v[3] = {0, 0, 0};
        bool is_point = json_array_size(p) == 3;
        for (size_t k = 0; k < 3 && is_point; k++) {
            const json_t *number = json_array_get(p, k);
            v[k] = json_number_value(number);
            is_point = json_is_number(number) && v[k] >= -POINT_MAX_M && v[k] <= POINT_MAX_M;
        }
        points[i] = rlf_vec3_make(v[0], v[1], v[2]);
        if (!is_point) {
            result = io_json_fail(body, "vertices",
                                  "[%zu] must be three numbers of metres, each "
                                  "within 100",
                                  i);
        }
    }
    rlf_hull *hull = NULL;
    if (result == RLF_OK) {
        result = io_hull_of_points("vertices", points, (int32_t)count, IO_MODEL_HULL_VERTICES,
                                   &hull, NULL);
        result = result == RLF_OK ? RLF_OK : fail_key(body, "vertices", result);
    }
    rlf_free(points);
    if (result == RLF_OK) {
        io_hull_scale(hull, fit_hull(hull, size));
        *out = hull;
    }
    return result;
}

/* From an earlier body, a file or a list. */
static rlf_result make_hull(const io_json_object *body, const io_scene_reader *reader,
                            const char *name, rlf_vec3 size, hull_and_look *out)
{
    if (name == NULL) {
        return read_vertices(body, size, &out->hull);
    }
    const rlf_body_def *alike = find_alike(body, reader, true);
    if (alike != NULL) {
        out->hull = io_hull_copy(alike->shape.hull);
        out->look = alike->look;
        return out->hull != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(reader->folder, name, path);
    result = result == RLF_OK ? read_hull_file(body, reader, path, size, out) : result;
    return result == RLF_OK ? RLF_OK : fail_key(body, "model", result);
}

rlf_result io_scene_read_hull(const io_json_object *body, const io_scene_reader *reader,
                              rlf_vec3 size, rlf_shape *out, rlf_look *out_look)
{
    const char *name = NULL;
    hull_and_look made = {NULL, {NULL, 1.0, {0, 0, 0}}};
    rlf_result result = get_name(body, &name);
    bool has_vertices = json_object_get(body->value, "vertices") != NULL;
    if (result == RLF_OK && (name != NULL) == has_vertices) {
        return io_json_fail(body, "model",
                            "is %s: a hull takes its form from a \"model\", a glTF or OBJ file, or "
                            "from \"vertices\"",
                            has_vertices ? "there beside \"vertices\"" : "missing");
    }
    result = result == RLF_OK ? make_hull(body, reader, name, size, &made) : result;
    out->hull = made.hull; /* the scene's also when its look failed */
    *out_look = made.look;
    return result;
}
