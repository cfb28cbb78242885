/* Surfaces as binary PLY (Turk 1994): points with normals, and triangles. */
#include "relief/io.h"
#include "io/file.h"
#include "io/little.h"

#include <string.h>

#define CHUNK 512 /* vertices or faces per write */

typedef struct ply_writer {
    const rlf_surface *surface;
    int32_t label; /* of the points; 0 = all */
    const uint32_t *indices;
    size_t triangle_count; /* in `indices` */
    int32_t *vertex_of;    /* pixel to vertex plus one; 0 = no point there */
    io_out_file file;
} ply_writer;

static int32_t number_vertices(ply_writer *w)
{
    int32_t pixels = w->surface->width * w->surface->height;
    int32_t count = 0;
    for (int32_t i = 0; i < pixels; i++) {
        bool own = w->label == 0 || w->surface->label[i] == w->label;
        w->vertex_of[i] = own && w->surface->depth[i] > 0.0F ? ++count : 0;
    }
    return count;
}

static bool is_whole(const ply_writer *w, size_t triangle)
{
    const uint32_t *t = &w->indices[triangle * 3];
    return w->vertex_of[t[0]] > 0 && w->vertex_of[t[1]] > 0 && w->vertex_of[t[2]] > 0;
}

static size_t count_faces(const ply_writer *w)
{
    size_t count = 0;
    for (size_t i = 0; i < w->triangle_count; i++) {
        count += is_whole(w, i) ? 1 : 0;
    }
    return count;
}

static rlf_result write_header(ply_writer *w, int32_t vertex_count, size_t face_count)
{
    char text[512];
    int length = snprintf(text, sizeof(text),
                          "ply\nformat binary_little_endian 1.0\n"
                          "comment camera frame, metres: x right, y down, z forward\n"
                          "element vertex %d\n"
                          "property float x\nproperty float y\nproperty float z\n"
                          "property float nx\nproperty float ny\nproperty float nz\n",
                          (int)vertex_count);
    if (w->triangle_count > 0) {
        length +=
            snprintf(text + length, sizeof(text) - (size_t)length,
                     "element face %zu\nproperty list uchar int vertex_indices\n", face_count);
    }
    length += snprintf(text + length, sizeof(text) - (size_t)length, "end_header\n");
    return io_out_write(&w->file, text, (size_t)length);
}

static rlf_result write_vertices(ply_writer *w)
{
    const rlf_surface *s = w->surface;
    int32_t pixels = s->width * s->height;
    float chunk[CHUNK][6];
    size_t filled = 0;
    for (int32_t i = 0; i < pixels; i++) {
        if (w->vertex_of[i] > 0) {
            rlf_vec3 p = rlf_surface_point(s, i);
            float values[6] = {(float)p.x,     (float)p.y,     (float)p.z,
                               s->normal_x[i], s->normal_y[i], s->normal_z[i]};
            io_little(values, 6, sizeof(values[0]));
            memcpy(chunk[filled++], values, sizeof(values));
        }
        if (filled == CHUNK || i + 1 == pixels) {
            rlf_result result = io_out_write(&w->file, chunk, filled * sizeof(chunk[0]));
            if (result != RLF_OK) {
                return result;
            }
            filled = 0;
        }
    }
    return RLF_OK;
}

static rlf_result write_faces(ply_writer *w)
{
    enum { FACE_SIZE = 13 }; /* a count byte and three integers, without padding */
    uint8_t chunk[CHUNK * FACE_SIZE];
    size_t filled = 0;
    for (size_t i = 0; i < w->triangle_count; i++) {
        if (is_whole(w, i)) {
            const uint32_t *t = &w->indices[i * 3];
            int32_t face[3] = {w->vertex_of[t[0]] - 1, w->vertex_of[t[1]] - 1,
                               w->vertex_of[t[2]] - 1};
            io_little(face, 3, sizeof(face[0]));
            chunk[filled * FACE_SIZE] = 3;
            memcpy(&chunk[filled * FACE_SIZE + 1], face, sizeof(face));
            filled++;
        }
        if (filled == CHUNK || i + 1 == w->triangle_count) {
            rlf_result result = io_out_write(&w->file, chunk, filled * FACE_SIZE);
            if (result != RLF_OK) {
                return result;
            }
            filled = 0;
        }
    }
    return RLF_OK;
}

static bool are_indices_valid(const rlf_surface *surface, const uint32_t *indices, size_t count)
{
    uint32_t pixels = (uint32_t)surface->width * (uint32_t)surface->height;
    for (size_t i = 0; i < count; i++) {
        if (indices[i] >= pixels) {
            return false;
        }
    }
    return count % 3 == 0;
}

static rlf_result write_ply(ply_writer *w, const char *path)
{
    int32_t vertex_count = number_vertices(w);
    size_t face_count = count_faces(w);
    rlf_result result = io_out_open(&w->file, path);
    if (result != RLF_OK) {
        return result;
    }
    result = write_header(w, vertex_count, face_count);
    if (result == RLF_OK) {
        result = write_vertices(w);
    }
    if (result == RLF_OK) {
        result = write_faces(w);
    }
    return io_out_close(&w->file, result);
}

static rlf_result write_points(const char *path, const rlf_surface *surface, int32_t label,
                               const uint32_t *indices, size_t index_count)
{
    if (!RLF_ASSERT(path != NULL && surface != NULL) ||
        !RLF_ASSERT(indices != NULL || index_count == 0) ||
        !RLF_ASSERT(are_indices_valid(surface, indices, index_count))) {
        return RLF_ERROR_INVALID;
    }
    ply_writer w = {
        .surface = surface, .label = label, .indices = indices, .triangle_count = index_count / 3};
    w.vertex_of =
        rlf_alloc_array((size_t)surface->width * (size_t)surface->height, sizeof(w.vertex_of[0]));
    if (w.vertex_of == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = write_ply(&w, path);
    rlf_free(w.vertex_of);
    return result;
}

rlf_result rlf_ply_write(const char *path, const rlf_surface *surface, const uint32_t *indices,
                         size_t index_count)
{
    return write_points(path, surface, 0, indices, index_count);
}

rlf_result rlf_ply_write_region(const char *path, const rlf_surface *surface,
                                const rlf_region *region, const uint32_t *indices,
                                size_t index_count)
{
    if (!RLF_ASSERT(region != NULL)) {
        return RLF_ERROR_INVALID;
    }
    return write_points(path, surface, region->label, indices, index_count);
}
