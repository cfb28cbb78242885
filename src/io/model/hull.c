/* Checks that a mesh is a closed convex solid and makes it a hull about its centre of mass. */
#include "io/model/hull.h"
#include "io/model/obj.h"

#include <stdlib.h>
#include <string.h>

/* Share of the hull's size by which a vertex may stand out of a face's plane: coordinates written
 * with five digits round that much. */
#define CONVEX_TOLERANCE 1e-4

#define PLACE_MAX_M 100.0 /* of a vertex, on each axis */

typedef struct edge {
    int32_t low, high; /* vertices in order of index */
    int32_t direction; /* +1 when walked from low to high, else -1 */
} edge;

static int compare_edges(const void *a, const void *b)
{
    const edge *x = a;
    const edge *y = b;
    if (x->low != y->low) {
        return x->low < y->low ? -1 : 1;
    }
    return (x->high > y->high) - (x->high < y->high);
}

/* Closed and consistently wound: every edge belongs to two triangles that walk it in opposite
 * directions. */
static rlf_result check_closed(const char *name, const io_mesh *mesh)
{
    int32_t count = mesh->triangle_count * 3;
    edge *edges = rlf_alloc_array((size_t)count, sizeof(edges[0]));
    if (edges == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t from = mesh->triangles[i];
        int32_t to = mesh->triangles[i % 3 == 2 ? i - 2 : i + 1];
        edges[i] = from < to ? (edge){from, to, 1} : (edge){to, from, -1};
    }
    qsort(edges, (size_t)count, sizeof(edges[0]), compare_edges);
    bool is_closed = count % 2 == 0;
    for (int32_t i = 0; i + 1 < count && is_closed; i += 2) {
        bool is_last_pair = i + 2 >= count;
        is_closed = compare_edges(&edges[i], &edges[i + 1]) == 0 &&
                    edges[i].direction + edges[i + 1].direction == 0 &&
                    (is_last_pair || compare_edges(&edges[i + 1], &edges[i + 2]) != 0);
    }
    rlf_free(edges);
    if (!is_closed) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the mesh is not closed, or its faces are not wound the same way: "
                        "close its holes and recalculate its normals",
                        name);
    }
    return RLF_OK;
}

static rlf_vec3 corner(const io_mesh *mesh, int32_t triangle, int32_t which)
{
    return mesh->vertices[mesh->triangles[(ptrdiff_t)triangle * 3 + which]];
}

/* Signed volume and centre of mass as sums over tetrahedra from the first vertex. */
static double measure(const io_mesh *mesh, rlf_vec3 *out_centre)
{
    rlf_vec3 origin = corner(mesh, 0, 0);
    double volume6 = 0.0;
    rlf_vec3 moment = rlf_vec3_make(0, 0, 0);
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        rlf_vec3 a = rlf_sub(corner(mesh, t, 0), origin);
        rlf_vec3 b = rlf_sub(corner(mesh, t, 1), origin);
        rlf_vec3 c = rlf_sub(corner(mesh, t, 2), origin);
        double v = rlf_dot(a, rlf_cross(b, c));
        volume6 += v;
        moment = rlf_mad(moment, rlf_add(a, rlf_add(b, c)), v * 0.25);
    }
    *out_centre = origin;
    if (volume6 != 0.0) {
        *out_centre = rlf_mad(origin, moment, 1.0 / volume6);
    }
    return volume6 / 6.0;
}

static double largest_extent(const io_mesh *mesh)
{
    rlf_aabb box = rlf_aabb_empty();
    for (int32_t i = 0; i < mesh->triangle_count * 3; i++) {
        rlf_aabb_extend(&box, mesh->vertices[mesh->triangles[i]]);
    }
    rlf_vec3 size = rlf_sub(box.max, box.min);
    return rlf_max(size.x, rlf_max(size.y, size.z));
}

/* No used vertex stands out of any face; `sign` is -1 when the faces look inwards. */
static rlf_result check_convex(const char *name, const io_mesh *mesh, double sign)
{
    double tolerance = CONVEX_TOLERANCE * largest_extent(mesh);
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        rlf_vec3 a = corner(mesh, t, 0);
        rlf_vec3 n = rlf_cross(rlf_sub(corner(mesh, t, 1), a), rlf_sub(corner(mesh, t, 2), a));
        n = rlf_scale(rlf_normalize(n), sign);
        for (int32_t i = 0; i < mesh->triangle_count * 3; i++) {
            rlf_vec3 v = mesh->vertices[mesh->triangles[i]];
            if (rlf_dot(n, rlf_sub(v, a)) > tolerance) {
                return rlf_fail(RLF_ERROR_FORMAT,
                                "%s: the mesh is not convex: give its convex hull, or split it "
                                "into bodies",
                                name);
            }
        }
    }
    return RLF_OK;
}

/* One block: the hull, then its vertices, then its triangles. */
static rlf_hull *allocate(int32_t vertex_count, int32_t triangle_count)
{
    size_t head = (sizeof(rlf_hull) + 63) / 64 * 64;
    size_t vertices_size = (size_t)vertex_count * sizeof(rlf_vec3);
    size_t triangles_size = (size_t)triangle_count * 3 * sizeof(int32_t);
    char *block = rlf_alloc(head + vertices_size + triangles_size);
    rlf_hull *hull = (rlf_hull *)(void *)block;
    if (hull != NULL) {
        *hull = (rlf_hull){(rlf_vec3 *)(void *)(block + head), vertex_count,
                           (int32_t *)(void *)(block + head + vertices_size), triangle_count};
    }
    return hull;
}

/* The hull's own arrays, which it shows as read only. */
static rlf_vec3 *vertices_of(rlf_hull *hull)
{
    return (rlf_vec3 *)(uintptr_t)hull->vertices;
}

static int32_t *triangles_of(rlf_hull *hull)
{
    return (int32_t *)(uintptr_t)hull->triangles;
}

void io_hull_scale(rlf_hull *hull, double scale)
{
    rlf_vec3 *vertices = vertices_of(hull);
    for (int32_t i = 0; i < hull->vertex_count; i++) {
        vertices[i] = rlf_scale(vertices[i], scale);
    }
}

rlf_hull *io_hull_copy(const rlf_hull *hull)
{
    rlf_hull *copy = allocate(hull->vertex_count, hull->triangle_count);
    if (copy != NULL) {
        memcpy(vertices_of(copy), hull->vertices,
               (size_t)hull->vertex_count * sizeof(*hull->vertices));
        memcpy(triangles_of(copy), hull->triangles,
               3 * (size_t)hull->triangle_count * sizeof(*hull->triangles));
    }
    return copy;
}

static rlf_hull *pack(const io_mesh *mesh, rlf_vec3 centre, bool is_inside_out)
{
    int32_t *renamed = rlf_alloc_array((size_t)mesh->vertex_count, sizeof(renamed[0]));
    rlf_hull *hull = allocate(mesh->vertex_count, mesh->triangle_count);
    if (renamed == NULL || hull == NULL) {
        rlf_free(renamed);
        rlf_free(hull);
        return NULL;
    }
    rlf_vec3 *vertices = vertices_of(hull);
    int32_t *triangles = triangles_of(hull);
    int32_t vertex_count = 0;
    for (int32_t i = 0; i < mesh->triangle_count * 3; i++) {
        int32_t old = mesh->triangles[i];
        if (renamed[old] == 0) {
            vertices[vertex_count++] = rlf_sub(mesh->vertices[old], centre);
            renamed[old] = vertex_count; /* plus one, so that 0 means none yet */
        }
        int32_t slot = is_inside_out ? i / 3 * 3 + 2 - i % 3 : i;
        triangles[slot] = renamed[old] - 1;
    }
    rlf_free(renamed);
    hull->vertex_count = vertex_count;
    return hull;
}

rlf_result io_hull_from_mesh(const char *name, const io_mesh *mesh, rlf_hull **out,
                             rlf_vec3 *out_centre)
{
    *out = NULL;
    if (mesh->triangle_count < 4) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: has %d triangles: a solid needs at least 4: export the whole mesh",
                        name, (int)mesh->triangle_count);
    }
    rlf_result result = check_closed(name, mesh);
    if (result != RLF_OK) {
        return result;
    }
    rlf_vec3 centre;
    double volume = measure(mesh, &centre);
    double extent = largest_extent(mesh);
    if (!(volume * volume > 1e-12 * extent * extent * extent * extent * extent * extent)) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: the mesh is flat: a body needs a volume", name);
    }
    result = check_convex(name, mesh, volume > 0.0 ? 1.0 : -1.0);
    if (result != RLF_OK) {
        return result;
    }
    *out = pack(mesh, centre, volume < 0.0);
    if (out_centre != NULL) {
        *out_centre = centre;
    }
    return *out != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void io_mesh_free(io_mesh *mesh)
{
    rlf_free(mesh->vertices);
    rlf_free(mesh->triangles);
    memset(mesh, 0, sizeof(*mesh));
}

/* The places of an OBJ; takes its list of them. */
static rlf_result take_mesh(const char *name, io_obj *obj, io_mesh *out)
{
    if (obj->position_count > IO_HULL_VERTICES_MAX || obj->triangle_count > IO_HULL_TRIANGLES_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the hull has more than %d vertices or %d triangles: simplify it", name,
                        IO_HULL_VERTICES_MAX, IO_HULL_TRIANGLES_MAX);
    }
    for (int32_t i = 0; i < obj->position_count; i++) {
        const rlf_vec3 p = obj->positions[i];
        if (rlf_max(rlf_max(p.x * p.x, p.y * p.y), p.z * p.z) > PLACE_MAX_M * PLACE_MAX_M) {
            return rlf_fail(RLF_ERROR_FORMAT,
                            "%s: vertex %d: a hull's vertices must be in metres, each within 100",
                            name, (int)i + 1);
        }
    }
    *out = (io_mesh){obj->positions, obj->position_count,
                     rlf_alloc_array((size_t)obj->triangle_count, 3 * sizeof(out->triangles[0])),
                     obj->triangle_count};
    obj->positions = NULL;
    for (int32_t i = 0; out->triangles != NULL && i < 3 * obj->triangle_count; i++) {
        out->triangles[i] = obj->corners[i][0];
    }
    return out->triangles != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

rlf_result io_hull_load(const char *path, rlf_hull **out, io_obj_facts *out_facts)
{
    *out = NULL;
    io_obj_facts facts = {{0, 0, 0}, false};
    io_buffer buffer = {0};
    io_bytes file;
    io_obj obj = {0};
    io_mesh mesh = {0};
    rlf_result result =
        io_file_read(path, IO_OBJ_FILE_MAX, "check the name of the model", &buffer, &file);
    result = result == RLF_OK ? io_obj_parse(&file, &obj) : result;
    if (result == RLF_OK) {
        facts.has_materials = obj.library_count > 0;
        result = take_mesh(path, &obj, &mesh);
    }
    result = result == RLF_OK ? io_hull_from_mesh(path, &mesh, out, &facts.centre) : result;
    io_mesh_free(&mesh);
    io_obj_free(&obj);
    io_buffer_free(&buffer);
    if (out_facts != NULL) {
        *out_facts = facts;
    }
    return result;
}
