/* Meshes of rooms as PLY (Turk 1994) and OBJ. */
#include "io/map/mesh_file.h"
#include "relief/io.h"

#include <string.h>

static rlf_result write_ply(io_out_file *file, const rlf_map_mesh *mesh)
{
    return io_mesh_write_ply(
        file, mesh, "world frame, metres: x right, y down, z forward of the first camera", true);
}

static int obj_vertex(const rlf_map_mesh *mesh, size_t i, char *text, size_t size)
{
    const float *p = &mesh->position[3 * i], *n = &mesh->normal[3 * i];
    char color[64] = "";
    if (mesh->rgba != NULL) {
        const uint8_t *c = &mesh->rgba[4 * i];
        (void)snprintf(color, sizeof(color), " %.3f %.3f %.3f", c[0] / 255.0, c[1] / 255.0,
                       c[2] / 255.0);
    }
    return snprintf(text, size, "v %.5f %.5f %.5f%s\nvn %.4f %.4f %.4f\n", (double)p[0],
                    (double)p[1], (double)p[2], color, (double)n[0], (double)n[1], (double)n[2]);
}

static rlf_result write_obj(io_out_file *file, const rlf_map_mesh *mesh)
{
    char text[256];
    rlf_result result = RLF_OK;
    for (size_t i = 0; result == RLF_OK && i < mesh->vertex_count; i++) {
        const int length = obj_vertex(mesh, i, text, sizeof(text));
        result = io_out_write(file, text, (size_t)length);
    }
    for (size_t i = 0; result == RLF_OK && i < mesh->triangle_count; i++) {
        const uint32_t *t = &mesh->index[3 * i];
        const unsigned long a = t[0] + 1ul, b = t[1] + 1ul, c = t[2] + 1ul;
        const int length =
            snprintf(text, sizeof(text), "f %lu//%lu %lu//%lu %lu//%lu\n", a, a, b, b, c, c);
        result = io_out_write(file, text, (size_t)length);
    }
    return result;
}

typedef struct mesh_kind {
    const char *extension;
    rlf_result (*write)(io_out_file *file, const rlf_map_mesh *mesh);
} mesh_kind;

static const mesh_kind kinds[] = {
    {".ply", write_ply}, {".obj", write_obj}, {".glb", io_mesh_write_glb}};

static const mesh_kind *find_kind(const char *path)
{
    const size_t length = strlen(path);
    for (size_t i = 0; i < sizeof(kinds) / sizeof(kinds[0]); i++) {
        if (length > 4 && strcmp(path + length - 4, kinds[i].extension) == 0) {
            return &kinds[i];
        }
    }
    return NULL;
}

rlf_result rlf_map_mesh_check_name(const char *path)
{
    if (!RLF_ASSERT(path != NULL)) {
        return RLF_ERROR_INVALID;
    }
    return find_kind(path) != NULL
               ? RLF_OK
               : rlf_fail(RLF_ERROR_INVALID, "%s: a mesh's name ends with .ply, .obj or .glb",
                          path);
}

rlf_result rlf_map_mesh_write(const char *path, const rlf_map_mesh *mesh)
{
    if (!RLF_ASSERT(path != NULL && mesh != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = rlf_map_mesh_check_name(path);
    io_out_file file;
    result = result == RLF_OK ? io_out_open(&file, path) : result;
    if (result != RLF_OK) {
        return result;
    }
    return io_out_close(&file, find_kind(path)->write(&file, mesh));
}
