/* Convex hulls: from Wavefront OBJ files and around points. */
#ifndef RLF_IO_MODEL_HULL_H
#define RLF_IO_MODEL_HULL_H

#include "relief/snapshot.h"

/* Limits of a hull that bodies collide with. */
#define IO_HULL_VERTICES_MAX 4096
#define IO_HULL_TRIANGLES_MAX 8192

/* A mesh while it is being made; both arrays are rlf_alloc'ed. */
typedef struct io_mesh {
    rlf_vec3 *vertices;
    int32_t vertex_count;
    int32_t *triangles;
    int32_t triangle_count;
} io_mesh;

void io_mesh_free(io_mesh *mesh);

/* Turns a closed convex mesh into a hull with its origin at the centre of mass, which goes to
 * *out_centre (NULL is allowed), and triangles counter-clockwise seen from outside. The hull and
 * its arrays are one rlf_alloc block. Vertices that no triangle uses are left out. RLF_ERROR_FORMAT
 * when it is open or not convex. */
rlf_result io_hull_from_mesh(const char *name, const io_mesh *mesh, rlf_hull **out,
                             rlf_vec3 *out_centre);

/* What a file says beside its mesh. */
typedef struct io_obj_facts {
    rlf_vec3 centre;    /* of mass, in the file's frame */
    bool has_materials; /* names a library of materials */
} io_obj_facts;

/* A closed convex OBJ; out_facts may be NULL. */
rlf_result io_hull_load(const char *path, rlf_hull **out, io_obj_facts *out_facts);
/* Grows a hull that io_hull_from_mesh made, about its centre. */
void io_hull_scale(rlf_hull *hull, double scale);
/* A copy in one rlf_alloc block; NULL when memory is short. */
rlf_hull *io_hull_copy(const rlf_hull *hull);

/* Triangles around all points, outward, between those points that are its corners; io_mesh_free it.
 * hull_qhull.c, or hull_absent.c where RELIEF_WITH_QHULL is off. */
rlf_result io_hull_wrap(const char *name, const rlf_vec3 *points, int32_t count, io_mesh *out);

/* rlf_hull_create with a name for error lines. */
rlf_result io_hull_of_points(const char *name, const rlf_vec3 *points, int32_t count,
                             int32_t vertex_limit, rlf_hull **out, rlf_vec3 *out_centre);

#endif
