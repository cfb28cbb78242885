/* Models by the names of their files, and the hulls around them. */
#include "relief/io.h"
#include "io/model/model.h"
#include "io/model/hull.h"

#include <string.h>

static bool ends_with(const char *name, const char *ending)
{
    size_t length = strlen(name);
    size_t count = strlen(ending);
    if (length < count) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        char c = name[length - count + i];
        c = c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
        if (c != ending[i]) {
            return false;
        }
    }
    return true;
}

io_model_format io_model_format_of(const char *name)
{
    if (ends_with(name, ".obj")) {
        return IO_MODEL_OBJ;
    }
    if (ends_with(name, ".gltf")) {
        return IO_MODEL_GLTF;
    }
    return ends_with(name, ".glb") ? IO_MODEL_GLB : IO_MODEL_UNKNOWN;
}

static rlf_result build(io_model_draft *d, rlf_model **out)
{
    rlf_model_def def = rlf_model_def_default();
    def.name = d->name;
    def.vertices = d->vertices;
    def.vertex_count = d->vertex_count;
    def.triangles = d->triangles;
    def.triangle_count = d->triangle_count;
    def.parts = d->parts;
    def.part_count = d->part_count;
    def.images = d->images;
    def.image_count = d->image_count;
    return rlf_model_create(&def, out);
}

rlf_result io_model_import(const io_bytes *file, io_model_format format, bool is_alone,
                           rlf_model **out)
{
    *out = NULL;
    if (file->size == 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is empty (0 bytes): export the model again",
                        file->name);
    }
    io_model_draft *d = rlf_alloc(sizeof(*d));
    if (d == NULL) {
        return RLF_ERROR_MEMORY;
    }
    d->name = file->name;
    d->is_alone = is_alone;
    d->left = IO_MODEL_FILE_MAX;
    rlf_result result =
        format == IO_MODEL_OBJ ? io_model_read_obj(d, file) : io_model_read_gltf(d, file);
    result = result == RLF_OK ? build(d, out) : result;
    for (int32_t i = 0; i < d->image_count; i++) {
        rlf_free(d->images[i].data);
    }
    rlf_free(d->vertices);
    rlf_free(d->triangles);
    rlf_free(d);
    return result;
}

rlf_result rlf_model_load(const char *path, rlf_model **out)
{
    if (!RLF_ASSERT(path != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    io_model_format format = io_model_format_of(path);
    if (format == IO_MODEL_UNKNOWN) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: is no model that can be read: export it as .gltf, .glb or .obj", path);
    }
    io_buffer buffer = {0};
    io_bytes file;
    rlf_result result =
        io_file_read(path, IO_MODEL_FILE_MAX, "check the name of the model", &buffer, &file);
    result = result == RLF_OK ? io_model_import(&file, format, false, out) : result;
    io_buffer_free(&buffer);
    return result;
}

double io_model_fit(const rlf_aabb *box, rlf_vec3 size)
{
    rlf_vec3 extent = rlf_sub(box->max, box->min);
    double scale = 0.0;
    const double sides[3][2] = {{extent.x, size.x}, {extent.y, size.y}, {extent.z, size.z}};
    for (int i = 0; i < 3; i++) {
        double share = sides[i][0] > 0.0 ? sides[i][1] / sides[i][0] : 0.0;
        scale = share > 0.0 && (scale == 0.0 || share < scale) ? share : scale;
    }
    return rlf_is_finite(scale) ? scale : 0.0;
}

rlf_result io_model_hull(const char *name, const rlf_model *model, double scale, rlf_hull **out,
                         rlf_look *out_look)
{
    *out = NULL;
    rlf_vec3 *points = rlf_alloc_array((size_t)model->vertex_count, sizeof(*points));
    if (points == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < model->vertex_count; i++) {
        const float *p = model->vertices[i].position;
        points[i] = rlf_scale(rlf_vec3_make((double)p[0], (double)p[1], (double)p[2]), scale);
    }
    rlf_vec3 centre;
    rlf_result result =
        io_hull_of_points(name, points, model->vertex_count, IO_MODEL_HULL_VERTICES, out, &centre);
    rlf_free(points);
    *out_look = (rlf_look){model, scale, rlf_neg(centre)};
    return result;
}
