/* Meshes of rooms as binary glTF 2.0. */
#include "io/map/mesh_file.h"
#include "io/little.h"

#include <string.h>

enum {
    GLB_MAGIC = 0x46546c67,
    GLB_JSON = 0x4e4f534a,
    GLB_BINARY = 0x004e4942,
    CHUNK = 1024 /* vertices per write */
};

typedef struct glb_sizes {
    size_t place, normal, color, index, all; /* bytes; place and normal are alike */
} glb_sizes;

static glb_sizes sizes_of(const rlf_map_mesh *mesh)
{
    glb_sizes s;
    s.place = mesh->vertex_count * 3 * sizeof(float);
    s.normal = s.place;
    s.color = mesh->rgba != NULL ? mesh->vertex_count * 4 : 0;
    s.index = mesh->triangle_count * 3 * sizeof(uint32_t);
    s.all = s.place + s.normal + s.color + s.index;
    return s;
}

/* Corners of the box about all, y and z turned round; glTF wants them. */
static void bounds(const rlf_map_mesh *mesh, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = mesh->vertex_count > 0 ? 1e30 : 0.0;
        high[k] = mesh->vertex_count > 0 ? -1e30 : 0.0;
    }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        for (int k = 0; k < 3; k++) {
            const double x = (k == 0 ? 1.0 : -1.0) * (double)mesh->position[3 * i + (size_t)k];
            low[k] = rlf_min(x, low[k]);
            high[k] = rlf_max(x, high[k]);
        }
    }
}

static int write_json(const rlf_map_mesh *mesh, const glb_sizes *s, char *text, size_t size)
{
    double low[3], high[3];
    bounds(mesh, low, high);
    const bool has_color = mesh->rgba != NULL;
    const size_t n = mesh->vertex_count, color_at = s->place + s->normal;
    char view[160] = "", accessor[160] = "";
    if (has_color) {
        (void)snprintf(view, sizeof(view), ",{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
                       color_at, s->color);
        (void)snprintf(accessor, sizeof(accessor),
                       ",{\"bufferView\":3,\"componentType\":5121,\"normalized\":true,"
                       "\"count\":%zu,\"type\":\"VEC4\"}",
                       n);
    }
    return snprintf(
        text, size,
        "{\"asset\":{\"version\":\"2.0\",\"generator\":\"relief\"},\"scene\":0,"
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"name\":\"room\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1%s},"
        "\"indices\":2}]}],\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":["
        "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%zu},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}%s],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\","
        "\"min\":[%.6g,%.6g,%.6g],\"max\":[%.6g,%.6g,%.6g]},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\"},"
        "{\"bufferView\":2,\"componentType\":5125,\"count\":%zu,\"type\":\"SCALAR\"}%s]}",
        has_color ? ",\"COLOR_0\":3" : "", s->all, s->place, s->place, s->normal,
        color_at + s->color, s->index, view, n, low[0], low[1], low[2], high[0], high[1], high[2],
        n, mesh->triangle_count * 3, accessor);
}

/* x, -y, -z of three numbers a vertex. */
static rlf_result write_turned(io_out_file *file, const float *vectors, size_t count)
{
    float chunk[CHUNK][3];
    rlf_result result = RLF_OK;
    for (size_t i = 0; result == RLF_OK && i < count; i += CHUNK) {
        const size_t part = count - i < CHUNK ? count - i : CHUNK;
        for (size_t k = 0; k < part; k++) {
            const float *v = &vectors[3 * (i + k)];
            chunk[k][0] = v[0];
            chunk[k][1] = -v[1];
            chunk[k][2] = -v[2];
        }
        io_little(chunk, 3 * part, sizeof(float));
        result = io_out_write(file, chunk, part * sizeof(chunk[0]));
    }
    return result;
}

static rlf_result write_head(io_out_file *file, char *json, size_t length, size_t binary)
{
    while (length % 4 != 0) {
        json[length++] = ' ';
    }
    const size_t all = 12 + 8 + length + 8 + binary;
    if (all > UINT32_MAX) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: a .glb holds at most 4 GB; write a .ply",
                        file->path);
    }
    uint32_t head[5] = {GLB_MAGIC, 2, (uint32_t)all, (uint32_t)length, GLB_JSON};
    uint32_t next[2] = {(uint32_t)binary, GLB_BINARY};
    io_little(head, 5, sizeof(head[0]));
    io_little(next, 2, sizeof(next[0]));
    rlf_result result = io_out_write(file, head, sizeof(head));
    result = result == RLF_OK ? io_out_write(file, json, length) : result;
    return result == RLF_OK ? io_out_write(file, next, sizeof(next)) : result;
}

rlf_result io_mesh_write_glb(io_out_file *file, const rlf_map_mesh *mesh)
{
    char json[2048];
    const glb_sizes s = sizes_of(mesh);
    const int length = write_json(mesh, &s, json, sizeof(json) - 4);
    rlf_result result = write_head(file, json, (size_t)length, s.all);
    result = result == RLF_OK ? write_turned(file, mesh->position, mesh->vertex_count) : result;
    result = result == RLF_OK ? write_turned(file, mesh->normal, mesh->vertex_count) : result;
    if (result == RLF_OK && s.color > 0) {
        result = io_out_write(file, mesh->rgba, s.color);
    }
    return result == RLF_OK ? io_out_write_numbers(file, mesh->index, 3 * mesh->triangle_count, 4)
                            : result;
}
