/* What glTF and OBJ share: growing lists of vertices, made-up normals, textures, files beside. */
#define _XOPEN_SOURCE 700
#include "io/model/model.h"
#include "io/model/obj.h"
#include "io/picture/picture.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Of all textures before they are made smaller: 32 of the largest size that is kept. */
#define PIXELS_MAX ((int64_t)32 * RLF_MODEL_TEXTURE_MAX * RLF_MODEL_TEXTURE_MAX)
#define NUMBER_MAX 1e6f
/* Cosine of 50 degrees: corners that turn by more keep their edge. */
#define SMOOTH_MIN_COS 0.64278760968653933
/* Faces around one place that are looked at: more make no smoother normal. */
#define AROUND_MAX 256

#ifndef PATH_MAX
#define PATH_MAX 4096
#endif

/* ---- lists ---------------------------------------------------------------------------------- */

rlf_result io_model_reserve(io_model_draft *d, int64_t vertices, int64_t triangles)
{
    if (vertices + d->vertex_count > RLF_MODEL_VERTICES_MAX ||
        triangles + d->triangle_count > RLF_MODEL_TRIANGLES_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the model has more than %d triangles or %d vertices: simplify it",
                        d->name, RLF_MODEL_TRIANGLES_MAX, RLF_MODEL_VERTICES_MAX);
    }
    rlf_result result = io_list_grow((void **)(void *)&d->vertices, d->vertex_count, vertices,
                                     &d->vertex_room, sizeof(d->vertices[0]));
    return result == RLF_OK
               ? io_list_grow((void **)(void *)&d->triangles, d->triangle_count, triangles,
                              &d->triangle_room, 3 * sizeof(d->triangles[0]))
               : result;
}

rlf_result io_model_check_vertices(const io_model_draft *d, int32_t first_vertex)
{
    for (int32_t i = first_vertex; i < d->vertex_count; i++) {
        const rlf_model_vertex *v = &d->vertices[i];
        const float numbers[8] = {v->position[0], v->position[1], v->position[2], v->normal[0],
                                  v->normal[1],   v->normal[2],   v->uv[0],       v->uv[1]};
        for (int k = 0; k < 8; k++) {
            if (!(numbers[k] >= -NUMBER_MAX && numbers[k] <= NUMBER_MAX)) {
                return rlf_fail(RLF_ERROR_FORMAT,
                                "%s: the %s of vertex %d is not a number that can be used: export "
                                "the model again",
                                d->name,
                                k < 3   ? "position"
                                : k < 6 ? "normal"
                                        : "texture coordinate",
                                (int)(i - first_vertex));
            }
        }
    }
    return RLF_OK;
}

/* ---- normals -------------------------------------------------------------------------------- */

/* A vertex to be sorted, with where it was. */
typedef struct place {
    rlf_model_vertex vertex;
    int32_t index;
} place;

static int compare_index(const place *a, const place *b)
{
    return (a->index > b->index) - (a->index < b->index);
}

static int compare_positions(const void *a, const void *b)
{
    const int order = memcmp(a, b, sizeof(((place *)0)->vertex.position));
    return order != 0 ? order : compare_index(a, b);
}

static int compare_vertices(const void *a, const void *b)
{
    const int order = memcmp(a, b, sizeof(rlf_model_vertex));
    return order != 0 ? order : compare_index(a, b);
}

static rlf_vec3 face_normal(const io_model_draft *d, const int32_t *triangle)
{
    rlf_vec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *at = d->vertices[triangle[k]].position;
        p[k] = rlf_vec3_make((double)at[0], (double)at[1], (double)at[2]);
    }
    return rlf_normalize(rlf_cross(rlf_sub(p[1], p[0]), rlf_sub(p[2], p[0])));
}

/* The mean of the normals around that turn by less than an edge does. places[begin .. end - 1] are
 * corners at one place. */
static void smooth_place(io_model_draft *d, const rlf_vec3 *faces, const place *places,
                         int32_t begin, int32_t end)
{
    end = end - begin > AROUND_MAX ? begin + AROUND_MAX : end;
    for (int32_t i = begin; i < end; i++) {
        const rlf_vec3 own = faces[places[i].index / 3];
        rlf_vec3 sum = rlf_vec3_make(0, 0, 0);
        for (int32_t k = begin; k < end; k++) {
            const rlf_vec3 other = faces[places[k].index / 3];
            sum = rlf_dot(own, other) >= SMOOTH_MIN_COS ? rlf_add(sum, other) : sum;
        }
        sum = rlf_normalize(sum);
        float *normal = d->vertices[places[i].index].normal;
        if (normal[0] == 0.0f && normal[1] == 0.0f && normal[2] == 0.0f) {
            normal[0] = (float)sum.x;
            normal[1] = (float)sum.y;
            normal[2] = (float)sum.z;
        }
    }
}

static void make_normals(io_model_draft *d, int32_t first_vertex, int32_t first_triangle,
                         rlf_vec3 *faces, place *places)
{
    const int32_t count = d->vertex_count - first_vertex;
    io_model_draft part = *d;
    part.vertices += first_vertex;
    for (int32_t t = 0; 3 * t < count; t++) {
        faces[t] = face_normal(d, d->triangles + 3 * (ptrdiff_t)(first_triangle + t));
    }
    qsort(places, (size_t)count, sizeof(places[0]), compare_positions);
    for (int32_t begin = 0, end = 1; begin < count; begin = end++) {
        while (end < count && memcmp(places[begin].vertex.position, places[end].vertex.position,
                                     sizeof(places[0].vertex.position)) == 0) {
            end++;
        }
        smooth_place(&part, faces, places, begin, end);
    }
}

static void list_places(const io_model_draft *d, int32_t first_vertex, place *out)
{
    for (int32_t i = first_vertex; i < d->vertex_count; i++) {
        rlf_model_vertex *v = &d->vertices[i];
        for (int k = 0; k < 3; k++) {
            v->position[k] += 0.0f; /* -0 is 0 */
        }
        out[i - first_vertex] = (place){*v, i - first_vertex};
    }
}

/* Of vertices that are alike the first stays, in its order. `names` has room for one each. */
static void join(io_model_draft *d, int32_t first_vertex, int32_t first_triangle, place *places,
                 int32_t *names)
{
    const int32_t count = d->vertex_count - first_vertex;
    qsort(places, (size_t)count, sizeof(places[0]), compare_vertices);
    for (int32_t i = 0, first = 0; i < count; i++) {
        first = memcmp(&places[i].vertex, &places[first].vertex, sizeof(places[0].vertex)) == 0
                    ? first
                    : i;
        names[places[i].index] = places[first].index;
    }
    int32_t kept = first_vertex;
    for (int32_t i = 0; i < count; i++) {
        if (names[i] == i) {
            d->vertices[kept] = d->vertices[first_vertex + i];
            names[i] = kept++;
        } else {
            names[i] = names[names[i]];
        }
    }
    for (int32_t i = 3 * first_triangle; i < 3 * d->triangle_count; i++) {
        d->triangles[i] = names[d->triangles[i] - first_vertex];
    }
    d->vertex_count = kept;
}

rlf_result io_model_smooth(io_model_draft *d, int32_t first_vertex, int32_t first_triangle)
{
    const size_t count = (size_t)(d->vertex_count - first_vertex);
    rlf_vec3 *faces = rlf_alloc_array(count, sizeof(*faces));
    place *places = rlf_alloc_array(count, sizeof(*places));
    int32_t *names = rlf_alloc_array(count, sizeof(*names));
    const bool has_room = faces != NULL && places != NULL && names != NULL;
    if (has_room) {
        list_places(d, first_vertex, places);
        make_normals(d, first_vertex, first_triangle, faces, places);
        list_places(d, first_vertex, places);
        join(d, first_vertex, first_triangle, places, names);
    }
    rlf_free(faces);
    rlf_free(places);
    rlf_free(names);
    return has_room ? RLF_OK : RLF_ERROR_MEMORY;
}

/* ---- files beside --------------------------------------------------------------------------- */

/* The folder of a path; false when it is too long. */
static bool folder_of(const char *path, char out[IO_PATH_MAX])
{
    const char *slash = strrchr(path, '/');
    const size_t length = slash != NULL ? (size_t)(slash - path) + 1 : 0;
    if (length >= IO_PATH_MAX) {
        return false;
    }
    (void)snprintf(out, IO_PATH_MAX, "%.*s", length > 0 ? (int)length : 1, length > 0 ? path : ".");
    return true;
}

static bool is_below(const char *folder, const char *path)
{
    const size_t length = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
    return strncmp(folder, path, length) == 0 && path[length] == '/';
}

rlf_result io_model_read_beside(io_model_draft *d, const char *name, io_buffer *buffer,
                                io_bytes *out)
{
    char folder[IO_PATH_MAX], path[IO_PATH_MAX], real_folder[PATH_MAX], real[PATH_MAX];
    if (d->is_alone || !folder_of(d->name, folder)) {
        return rlf_fail(RLF_ERROR_IO, "%s: other files are not read", name);
    }
    rlf_result result = io_path_join(folder, name, path);
    if (result != RLF_OK) {
        return result;
    }
    const bool is_there = realpath(path, real) != NULL;
    if (is_there && (realpath(folder, real_folder) == NULL || !is_below(real_folder, real))) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: names %s, which is outside of the model's folder and is not read: put "
                        "it beside the model",
                        d->name, path);
    }
    result = io_file_read(is_there ? real : path, d->left, "put it beside the model", buffer, out);
    d->left -= result == RLF_OK ? out->size : 0;
    return result;
}

/* ---- textures ------------------------------------------------------------------------------- */

static rlf_result decode(io_model_draft *d, const char *name, const io_bytes *embedded,
                         io_picture *picture)
{
    io_buffer buffer = {0};
    io_bytes bytes;
    if (embedded != NULL) {
        return io_picture_decode(embedded, picture);
    }
    rlf_result result = io_model_read_beside(d, name, &buffer, &bytes);
    result = result == RLF_OK ? io_picture_decode(&bytes, picture) : result;
    io_buffer_free(&buffer);
    return result;
}

rlf_result io_model_texture(io_model_draft *d, const char *name, const io_bytes *embedded,
                            int32_t *out)
{
    *out = -1;
    for (int32_t i = 0; i < d->texture_count; i++) {
        if (strcmp(d->textures[i].name, name) == 0) {
            *out = d->textures[i].image;
            return RLF_OK;
        }
    }
    if (d->texture_count == RLF_MODEL_TEXTURES_MAX || strlen(name) >= sizeof(d->textures[0].name)) {
        rlf_log(RLF_LOG_WARNING, "%s: more than %d textures: the others are left out", d->name,
                RLF_MODEL_TEXTURES_MAX);
        return RLF_OK;
    }
    int32_t *image = &d->textures[d->texture_count].image;
    (void)snprintf(d->textures[d->texture_count++].name, sizeof(d->textures[0].name), "%s", name);
    *image = -1;
    io_picture picture = {.size_max = RLF_MODEL_IMAGE_MAX,
                          .pixels_max = PIXELS_MAX + 1 - d->pixels};
    rlf_result result = decode(d, name, embedded, &picture);
    if (result == RLF_ERROR_MEMORY) {
        return result;
    }
    if (result != RLF_OK) {
        rlf_log(RLF_LOG_WARNING, "%s: its texture is left out: %s", d->name, rlf_error_text());
        return RLF_OK;
    }
    d->pixels += (int64_t)picture.width * picture.height;
    d->images[d->image_count] = (rlf_image_rgba8){picture.data, picture.width, picture.height,
                                                  4 * (ptrdiff_t)picture.width};
    *out = *image = d->image_count++;
    return RLF_OK;
}
