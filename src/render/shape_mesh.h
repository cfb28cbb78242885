/* Triangle meshes of body shapes, shared by both renderers.
 *
 * Box, sphere, capsule and cylinder are unit meshes that a shape's scale stretches to metres. A
 * capsule's caps must move apart without being stretched, so a vertex carries a shift of -1, 0 or 1
 * beside its position: p_body = scale * position + (0, shift * half_height, 0). Unit normals stay
 * right under these scales. Triangles are counter-clockwise seen from outside. */
#ifndef RLF_RENDER_SHAPE_MESH_H
#define RLF_RENDER_SHAPE_MESH_H

#include "base/inside.h"
#include "relief/snapshot.h"

enum {
    SHAPE_MESH_SLICES = 32, /* round the y axis */
    SHAPE_MESH_STACKS = 16, /* from pole to pole of a sphere */
    SHAPE_MESH_UNIT_COUNT = 4,
    SHAPE_MESH_VERTEX_MAX = 1400,
    SHAPE_MESH_INDEX_MAX = 6600
};

/* Nine floats without padding, so that it can be a vertex buffer's layout. */
typedef struct shape_vertex {
    float position[3];
    float shift; /* -1, 0, 1: moved by shift * half_height along y */
    float normal[3];
    float uv[2]; /* texture coordinates; repeat outside 0..1 */
} shape_vertex;

/* Where one shape's triangles lie in a shape_mesh_set. */
typedef struct shape_mesh_range {
    int32_t first_index, index_count;
    int32_t first_vertex, vertex_count;
} shape_mesh_range;

/* The four unit meshes in one vertex and one index list; `range` is indexed by rlf_shape_type (all
 * but the hull). Indices count from the start of `vertices`. */
typedef struct shape_mesh_set {
    shape_vertex vertices[SHAPE_MESH_VERTEX_MAX];
    uint16_t indices[SHAPE_MESH_INDEX_MAX];
    int32_t vertex_count, index_count;
    int32_t slices, stacks;
    shape_mesh_range range[SHAPE_MESH_UNIT_COUNT];
} shape_mesh_set;

/* Stretch of a unit mesh to a shape; the identity for a hull. */
typedef struct shape_mesh_scale {
    rlf_vec3 scale; /* metres; S of the model matrix, A.3 */
    double half_height;
} shape_mesh_scale;

void shape_mesh_set_build(shape_mesh_set *out) RLF_INSIDE(shape_mesh_set_build);
/* Half as many slices and stacks, for bodies that are small in the picture. */
void shape_mesh_set_build_coarse(shape_mesh_set *out);
shape_mesh_scale shape_mesh_scale_of(const rlf_shape *shape) RLF_INSIDE(shape_mesh_scale_of);

/* Corners of a hull's triangle in metres, flat shaded, with texture coordinates from the plane that
 * the triangle faces most (the texture spans the hull's diameter). `radius` is
 * rlf_shape_radius of the shape. False for a triangle without area. */
bool shape_mesh_hull_triangle(const rlf_hull *hull, int32_t triangle, double radius,
                              shape_vertex out[3]) RLF_INSIDE(shape_mesh_hull_triangle);

#endif
