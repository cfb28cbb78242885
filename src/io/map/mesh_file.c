/* Meshes and points as PLY (Turk 1994), OBJ and binary glTF 2.0. */
#include "relief/io.h"
#include "io/file.h"
#include "io/little.h"

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

/* `frame`: what its axes are. */
static rlf_result write_ply_as(io_out_file *file, const rlf_map_mesh *mesh, const char *frame,
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
            result = write_ply_as(&file, &mesh, "camera frame, metres: x right, y down, z forward",
                                  index_count > 0);
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

/* ---- rooms ---------------------------------------------------------------------------------- */

static rlf_result write_ply(io_out_file *file, const rlf_map_mesh *mesh)
{
    return write_ply_as(
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

enum {
    GLB_MAGIC = 0x46546c67,
    GLB_JSON = 0x4e4f534a,
    GLB_BINARY = 0x004e4942,
    GLB_CHUNK = 1024 /* vertices per write */
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
    float chunk[GLB_CHUNK][3];
    rlf_result result = RLF_OK;
    for (size_t i = 0; result == RLF_OK && i < count; i += GLB_CHUNK) {
        const size_t part = count - i < GLB_CHUNK ? count - i : GLB_CHUNK;
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

static rlf_result write_glb(io_out_file *file, const rlf_map_mesh *mesh)
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

typedef struct mesh_kind {
    const char *extension;
    rlf_result (*write)(io_out_file *file, const rlf_map_mesh *mesh);
} mesh_kind;

static const mesh_kind kinds[] = {{".ply", write_ply}, {".obj", write_obj}, {".glb", write_glb}};

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
