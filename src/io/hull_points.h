/* Convex hulls of point clouds. */
#ifndef RLF_IO_HULL_POINTS_H
#define RLF_IO_HULL_POINTS_H

#include "io/hull_obj.h"

/* Triangles around all points, outward, between those points that are its corners; io_mesh_free it.
 * hull_qhull.c, or hull_absent.c where RELIEF_WITH_QHULL is off. */
rlf_result io_hull_wrap(const char *name, const rlf_vec3 *points, int32_t count, io_mesh *out);

/* rlf_hull_create with a name for error lines. */
rlf_result io_hull_of_points(const char *name, const rlf_vec3 *points, int32_t count,
                             int32_t vertex_limit, rlf_hull **out, rlf_vec3 *out_centre);

#endif
