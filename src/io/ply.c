/* Meshes and points as binary PLY (Turk 1994). */
#include "relief/io.h"
#include "io/file.h"
#include "io/little.h"
#include "io/map/mesh_file.h"

#include <string.h>

#define CHUNK 512 /* vertices or faces per write */

static rlf_result write_vertices(io_out_file *file, const rlf_map_mesh *mesh)
{
    enum { PLACE = 6 * sizeof(float), VERTEX = PLACE + 3 };
    uint8_t chunk[CHUNK * VERTEX];
    const size_t size = mesh->rgba != NULL ? VERTEX : PLACE;
    rlf_result result = RLF_OK;
    for (size_t i = 0, filled = 0; i < mesh->vertex_count && result == RLF_OK; i++) {
        uint8_t *out = &chunk[filled++ * size];
        memcpy(out, &mesh->position[3 * i], 3 * sizeof(float));
        memcpy(out + 3 * sizeof(float), &mesh->normal[3 * i], 3 * sizeof(float));
        io_little(out, 6, sizeof(float));
        if (mesh->rgba != NULL) {
            memcpy(out + PLACE, &mesh->rgba[4 * i], 3);
        }
        if (filled == CHUNK || i + 1 == mesh->vertex_count) {
            result = io_out_write(file, chunk, filled * size);
            filled = 0;
        }
    }
    return result;
}

static rlf_result write_faces(io_out_file *file, const rlf_map_mesh *mesh)
{
    enum { FACE = 13 }; /* a count byte and three integers, without padding */
    uint8_t chunk[CHUNK * FACE];
    rlf_result result = RLF_OK;
    for (size_t i = 0, filled = 0; i < mesh->triangle_count && result == RLF_OK; i++) {
        uint8_t *out = &chunk[filled++ * FACE];
        out[0] = 3;
        memcpy(out + 1, &mesh->index[3 * i], 3 * sizeof(uint32_t));
        io_little(out + 1, 3, sizeof(uint32_t));
        if (filled == CHUNK || i + 1 == mesh->triangle_count) {
            result = io_out_write(file, chunk, filled * FACE);
            filled = 0;
        }
    }
    return result;
}

rlf_result io_mesh_write_ply(io_out_file *file, const rlf_map_mesh *mesh, const char *frame,
                             bool has_faces)
{
    char text[640], faces[128] = "";
    const char *colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    snprintf(faces, sizeof(faces), "element face %zu\nproperty list uchar int vertex_indices\n",
             mesh->triangle_count);
    const int length = snprintf(text, sizeof(text),
                                "ply\nformat binary_little_endian 1.0\ncomment %s\n"
                                "element vertex %zu\n"
                                "property float x\nproperty float y\nproperty float z\n"
                                "property float nx\nproperty float ny\nproperty float nz\n%s%s"
                                "end_header\n",
                                frame, mesh->vertex_count, mesh->rgba != NULL ? colors : "",
                                has_faces ? faces : "");
    rlf_result result = io_out_write(file, text, (size_t)length);
    result = result == RLF_OK ? write_vertices(file, mesh) : result;
    return result == RLF_OK ? write_faces(file, mesh) : result;
}

/* ---- surfaces ------------------------------------------------------------------------------- */

/* Points of a region, 0 = of all. `vertex_of`: of each pixel, plus one; 0 = it has no point. */
static void gather_points(const rlf_surface *s, int32_t label, uint32_t *vertex_of, rlf_map_mesh *m)
{
    for (int32_t i = 0; i < s->width * s->height; i++) {
        if (!(s->depth[i] > 0.0F) || (label != 0 && s->label[i] != label)) {
            continue;
        }
        const rlf_vec3 p = rlf_surface_point(s, i);
        const float place[3] = {(float)p.x, (float)p.y, (float)p.z};
        const float normal[3] = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
        memcpy(&m->position[3 * m->vertex_count], place, sizeof(place));
        memcpy(&m->normal[3 * m->vertex_count], normal, sizeof(normal));
        vertex_of[i] = (uint32_t)++m->vertex_count;
    }
}

/* Triangles of which all corners are there. */
static void gather_triangles(const uint32_t *indices, size_t count, const uint32_t *vertex_of,
                             rlf_map_mesh *m)
{
    for (size_t i = 0; i < count; i += 3) {
        const uint32_t *t = &indices[i];
        const uint32_t corners[3] = {vertex_of[t[0]], vertex_of[t[1]], vertex_of[t[2]]};
        for (int k = 0; k < 3; k++) {
            m->index[3 * m->triangle_count + (size_t)k] = corners[k] - 1;
        }
        m->triangle_count += corners[0] > 0 && corners[1] > 0 && corners[2] > 0 ? 1 : 0;
    }
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

static rlf_result write_points(const char *path, const rlf_surface *surface, int32_t label,
                               const uint32_t *indices, size_t index_count)
{
    if (!RLF_ASSERT(path != NULL && surface != NULL) ||
        !RLF_ASSERT(indices != NULL || index_count == 0) ||
        !RLF_ASSERT(are_indices_valid(surface, indices, index_count))) {
        return RLF_ERROR_INVALID;
    }
    const size_t pixels = (size_t)surface->width * (size_t)surface->height;
    uint32_t *vertex_of = rlf_alloc_array(pixels, sizeof(vertex_of[0]));
    rlf_map_mesh mesh = {.position = rlf_alloc_array(pixels, 3 * sizeof(float)),
                         .normal = rlf_alloc_array(pixels, 3 * sizeof(float)),
                         .index = rlf_alloc_array(index_count + 3, sizeof(uint32_t))};
    rlf_result result = RLF_ERROR_MEMORY;
    if (vertex_of != NULL && mesh.position != NULL && mesh.normal != NULL && mesh.index != NULL) {
        io_out_file file;
        gather_points(surface, label, vertex_of, &mesh);
        gather_triangles(indices, index_count, vertex_of, &mesh);
        result = io_out_open(&file, path);
        if (result == RLF_OK) {
            result = io_mesh_write_ply(
                &file, &mesh, "camera frame, metres: x right, y down, z forward", index_count > 0);
            result = io_out_close(&file, result);
        }
    }
    rlf_free(vertex_of);
    rlf_map_mesh_destroy(&mesh);
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
