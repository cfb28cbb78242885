/* glTF 2.0 and OBJ by assimp. */
#include "io/model/import.h"
#include "base/checks.h"
#include "io/model/files.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <pthread.h>
#include <string.h>

/* Corners that turn by more keep their edge when a file has no normals. */
#define SMOOTH_MAX_DEG 50.0f
#define NUMBER_MAX 1e6f

/* Assimp keeps the last error in a global of its own. */
static pthread_mutex_t assimp_lock = PTHREAD_MUTEX_INITIALIZER;

/* What went wrong beside assimp comes first: it saw only what followed from that. */
static rlf_result fail_import(const io_model_files *files, const char *name)
{
    if (files->result != RLF_OK) {
        return rlf_fail(files->result, "%s", files->problem);
    }
    if (strstr(aiGetErrorString(), "bad_alloc") != NULL) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: not enough memory for the model", name);
    }
    return rlf_fail(
        RLF_ERROR_FORMAT,
        "%s: cannot be read as a model (%.200s%s%.200s): export it again as glTF 2.0 or "
        "OBJ",
        name, aiGetErrorString(), files->last[0] != '\0' ? "; it names " : "", files->last);
}

static bool is_usable(const struct aiVector3D *v)
{
    return v->x >= -NUMBER_MAX && v->x <= NUMBER_MAX && v->y >= -NUMBER_MAX && v->y <= NUMBER_MAX &&
           v->z >= -NUMBER_MAX && v->z <= NUMBER_MAX;
}

/* Assimp's later steps bear neither NaN nor infinity. */
static rlf_result check_mesh(const char *name, const struct aiMesh *mesh)
{
    const struct aiVector3D *const lists[3] = {mesh->mVertices, mesh->mNormals,
                                               mesh->mTextureCoords[0]};
    static const char *const meanings[3] = {"position", "normal", "texture coordinate"};
    for (int k = 0; k < 3; k++) {
        for (unsigned i = 0; lists[k] != NULL && i < mesh->mNumVertices; i++) {
            if (!is_usable(&lists[k][i])) {
                return rlf_fail(RLF_ERROR_FORMAT,
                                "%s: the %s of vertex %u is not a number that can be used: export "
                                "the model again",
                                name, meanings[k], i);
            }
        }
    }
    return RLF_OK;
}

static rlf_result check_scene(const char *name, const struct aiScene *scene)
{
    int64_t faces = 0;
    rlf_result result = RLF_OK;
    for (unsigned i = 0; i < scene->mNumMeshes && result == RLF_OK; i++) {
        faces += scene->mMeshes[i]->mNumFaces;
        result = check_mesh(name, scene->mMeshes[i]);
    }
    if (result == RLF_OK && faces > RLF_MODEL_TRIANGLES_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the model has %lld faces, at most %d are drawn: simplify it", name,
                        (long long)faces, RLF_MODEL_TRIANGLES_MAX);
    }
    return result;
}

/* Joins and smooths what is known to be sound and small enough. */
static rlf_result prepare(io_model_draft *d, const io_model_files *files,
                          const struct aiScene **scene)
{
    rlf_result result = check_scene(d->name, *scene);
    if (result != RLF_OK) {
        return result;
    }
    const struct aiScene *prepared = aiApplyPostProcessing(
        *scene, aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                    aiProcess_FlipUVs | aiProcess_TransformUVCoords |
                    aiProcess_JoinIdenticalVertices);
    if (prepared == NULL) {
        *scene = NULL; /* it is gone */
        return fail_import(files, d->name);
    }
    *scene = prepared;
    return RLF_OK;
}

static rlf_result build(io_model_draft *d, rlf_model **out)
{
    rlf_result result = d->scene->mRootNode != NULL ? io_model_collect(d) : RLF_OK;
    if (result == RLF_OK) {
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
        result = rlf_model_create(&def, out);
    }
    for (int32_t i = 0; i < d->image_count; i++) {
        rlf_free(d->images[i].data);
    }
    rlf_free(d->instances);
    rlf_free(d->vertices);
    rlf_free(d->triangles);
    return result;
}

static const struct aiScene *import(io_model_files *files)
{
    struct aiPropertyStore *settings = aiCreatePropertyStore();
    if (settings == NULL) {
        files->result =
            rlf_fail(RLF_ERROR_MEMORY, "%s: not enough memory for the model", files->main->name);
        (void)snprintf(files->problem, sizeof(files->problem), "%s", rlf_error_text());
        return NULL;
    }
    aiSetImportPropertyFloat(settings, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, SMOOTH_MAX_DEG);
    const struct aiScene *scene = aiImportFileExWithProperties(
        files->main->name, aiProcess_ValidateDataStructure, &files->hooks, settings);
    aiReleasePropertyStore(settings);
    return scene;
}

static rlf_result import_locked(const io_bytes *file, io_model_draft *d, rlf_model **out)
{
    io_model_files files;
    io_model_files_init(&files, file, d->is_alone, d->format == IO_MODEL_OBJ);
    const struct aiScene *scene = import(&files);
    if (scene == NULL) {
        return fail_import(&files, file->name);
    }
    if (files.result != RLF_OK) {
        aiReleaseImport(scene);
        return fail_import(&files, file->name);
    }
    if (files.missing[0] != '\0') {
        rlf_log(RLF_LOG_WARNING, "%s: names %s, which cannot be read: drawn without it", file->name,
                files.missing);
    }
    rlf_result result = prepare(d, &files, &scene);
    if (result == RLF_OK) {
        d->scene = scene;
        result = build(d, out);
    }
    if (scene != NULL) {
        aiReleaseImport(scene);
    }
    return result;
}

static rlf_result import_checked(const io_bytes *file, io_model_format format, bool is_alone,
                                 rlf_model **out)
{
    io_model_draft *draft = rlf_alloc(sizeof(*draft));
    if (draft == NULL) {
        return RLF_ERROR_MEMORY;
    }
    draft->name = file->name;
    draft->format = format;
    draft->is_alone = is_alone;
    (void)pthread_mutex_lock(&assimp_lock);
    rlf_result result = import_locked(file, draft, out);
    (void)pthread_mutex_unlock(&assimp_lock);
    rlf_free(draft);
    return result;
}

rlf_result io_model_import(const io_bytes *file, io_model_format format, bool is_alone,
                           rlf_model **out)
{
    *out = NULL;
    if (file->size == 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is empty (0 bytes): export the model again",
                        file->name);
    }
    io_buffer buffer = {0};
    io_bytes reduced = *file;
    rlf_result result = format == IO_MODEL_OBJ ? io_model_check_obj(file)
                                               : io_model_reduce_gltf(file, &buffer, &reduced);
    if (result == RLF_OK) {
        result = import_checked(&reduced, format, is_alone, out);
    }
    io_buffer_free(&buffer);
    return result;
}
