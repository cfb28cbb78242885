/* Hulls of points with few vertices: those that stand out most are kept, one after the other. */
#include "relief/io.h"
#include "io/model/hull.h"

#include <string.h>

/* What stands out by less of the size is left out. */
#define ENOUGH 2e-3

/* Corners of the full hull, and those of them that are kept. */
typedef struct choice {
    rlf_vec3 *corners, *kept;
    int32_t corner_count, kept_count;
    double size; /* largest extent */
} choice;

/* The points that triangles use. */
static rlf_result gather(const io_mesh *mesh, choice *c)
{
    uint8_t *is_used = rlf_alloc((size_t)mesh->vertex_count);
    c->corners = rlf_alloc_array((size_t)mesh->vertex_count, sizeof(*c->corners));
    if (is_used == NULL || c->corners == NULL) {
        rlf_free(is_used);
        return RLF_ERROR_MEMORY;
    }
    rlf_aabb box = rlf_aabb_empty();
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        is_used[mesh->triangles[i]] = 1;
    }
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        if (is_used[i] != 0) {
            c->corners[c->corner_count++] = mesh->vertices[i];
            rlf_aabb_extend(&box, mesh->vertices[i]);
        }
    }
    rlf_free(is_used);
    rlf_vec3 extent = rlf_sub(box.max, box.min);
    c->size = rlf_max(extent.x, rlf_max(extent.y, extent.z));
    return RLF_OK;
}

/* How far p is from a point, a line or a plane through the `count` kept points. */
static double distance_to_kept(const choice *c, int count, rlf_vec3 p)
{
    rlf_vec3 from = rlf_sub(p, c->kept[0]);
    if (count == 1) {
        return rlf_length(from);
    }
    rlf_vec3 along = rlf_normalize(rlf_sub(c->kept[1], c->kept[0]));
    if (count == 2) {
        return rlf_length(rlf_cross(along, from));
    }
    rlf_vec3 normal = rlf_normalize(rlf_cross(along, rlf_sub(c->kept[2], c->kept[0])));
    double d = rlf_dot(normal, from);
    return d < 0.0 ? -d : d;
}

/* A large tetrahedron to begin with. */
static void begin(choice *c)
{
    c->kept[0] = c->corners[0];
    for (int32_t i = 1; i < c->corner_count; i++) {
        c->kept[0] = c->corners[i].x < c->kept[0].x ? c->corners[i] : c->kept[0];
    }
    for (c->kept_count = 1; c->kept_count < 4; c->kept_count++) {
        double most = -1.0;
        for (int32_t i = 0; i < c->corner_count; i++) {
            double d = distance_to_kept(c, c->kept_count, c->corners[i]);
            if (d > most) {
                most = d;
                c->kept[c->kept_count] = c->corners[i];
            }
        }
    }
}

/* Largest distance of p to the planes of the mesh, > 0 outside. */
static double outside(const io_mesh *mesh, const rlf_vec3 *normals, rlf_vec3 p)
{
    double most = -1e300;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        rlf_vec3 a = mesh->vertices[mesh->triangles[3 * (ptrdiff_t)t]];
        most = rlf_max(most, rlf_dot(normals[t], rlf_sub(p, a)));
    }
    return most;
}

/* Keeps the corner that is farthest outside of the hull of those kept; false when none is. */
static rlf_result keep_farthest(choice *c, const char *name, bool *out_is_kept)
{
    io_mesh mesh;
    *out_is_kept = false;
    rlf_result result = io_hull_wrap(name, c->kept, c->kept_count, &mesh);
    if (result != RLF_OK) {
        return result;
    }
    rlf_vec3 *normals = rlf_alloc_array((size_t)mesh.triangle_count, sizeof(*normals));
    double most = ENOUGH * c->size;
    for (int32_t t = 0; normals != NULL && t < mesh.triangle_count; t++) {
        const int32_t *corner = &mesh.triangles[3 * (ptrdiff_t)t];
        rlf_vec3 a = mesh.vertices[corner[0]];
        normals[t] = rlf_normalize(
            rlf_cross(rlf_sub(mesh.vertices[corner[1]], a), rlf_sub(mesh.vertices[corner[2]], a)));
    }
    for (int32_t i = 0; normals != NULL && i < c->corner_count; i++) {
        double d = outside(&mesh, normals, c->corners[i]);
        if (d > most) {
            most = d;
            c->kept[c->kept_count] = c->corners[i];
            *out_is_kept = true;
        }
    }
    c->kept_count += *out_is_kept ? 1 : 0;
    result = normals != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    rlf_free(normals);
    io_mesh_free(&mesh);
    return result;
}

/* The mesh around at most `limit` of its own corners. */
static rlf_result reduce(const char *name, io_mesh *mesh, int32_t limit)
{
    choice c = {.kept = rlf_alloc_array((size_t)limit, sizeof(rlf_vec3))};
    rlf_result result = c.kept != NULL ? gather(mesh, &c) : RLF_ERROR_MEMORY;
    if (result == RLF_OK && c.corner_count > limit) {
        begin(&c);
        bool goes_on = true;
        while (result == RLF_OK && goes_on && c.kept_count < limit) {
            result = keep_farthest(&c, name, &goes_on);
        }
        if (result == RLF_OK) {
            io_mesh_free(mesh);
            result = io_hull_wrap(name, c.kept, c.kept_count, mesh);
        }
    }
    rlf_free(c.corners);
    rlf_free(c.kept);
    return result;
}

rlf_result io_hull_of_points(const char *name, const rlf_vec3 *points, int32_t count,
                             int32_t vertex_limit, rlf_hull **out, rlf_vec3 *out_centre)
{
    *out = NULL;
    if (count < 4) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: has %d points: a solid needs at least 4", name,
                        (int)count);
    }
    for (int32_t i = 0; i < count; i++) {
        if (!rlf_vec3_is_finite(points[i]) || !(rlf_length(points[i]) < 1e6)) {
            return rlf_fail(RLF_ERROR_INVALID, "%s: point %d is not finite or far beyond any room",
                            name, (int)i);
        }
    }
    io_mesh mesh;
    rlf_result result = io_hull_wrap(name, points, count, &mesh);
    result = result == RLF_OK ? reduce(name, &mesh, vertex_limit) : result;
    result = result == RLF_OK ? io_hull_from_mesh(name, &mesh, out, out_centre) : result;
    io_mesh_free(&mesh);
    return result;
}

rlf_result rlf_hull_create(const rlf_vec3 *points, int32_t point_count, int32_t vertex_limit,
                           rlf_hull **out, rlf_vec3 *out_centre)
{
    if (!RLF_ASSERT(points != NULL && out != NULL && vertex_limit >= 4)) {
        return RLF_ERROR_INVALID;
    }
    return io_hull_of_points("hull", points, point_count, vertex_limit, out, out_centre);
}
