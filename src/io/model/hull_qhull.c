/* Convex hulls by qhull (Barber, Dobkin, Huhdanpaa 1996). */
#include "io/model/hull.h"

#include <libqhull_r/qhull_ra.h>

/* A facet's corners, counter-clockwise seen from outside. */
static void take_facet(qhT *qh, const facetT *facet, int32_t out[3])
{
    vertexT *vertex;
    vertexT **vertexp;
    const double *p[3] = {NULL, NULL, NULL};
    int count = 0;
    FOREACHvertex_(facet->vertices)
    {
        if (count < 3) {
            p[count] = vertex->point;
            out[count++] = qh_pointid(qh, vertex->point);
        }
    }
    rlf_vec3 a = rlf_vec3_make(p[0][0], p[0][1], p[0][2]);
    rlf_vec3 ab = rlf_sub(rlf_vec3_make(p[1][0], p[1][1], p[1][2]), a);
    rlf_vec3 ac = rlf_sub(rlf_vec3_make(p[2][0], p[2][1], p[2][2]), a);
    rlf_vec3 outwards = rlf_vec3_make(facet->normal[0], facet->normal[1], facet->normal[2]);
    bool is_turned = rlf_dot(rlf_cross(ab, ac), outwards) < 0.0;
    int32_t second = out[1];
    out[1] = is_turned ? out[2] : second;
    out[2] = is_turned ? second : out[2];
}

static rlf_result take_facets(qhT *qh, const rlf_vec3 *points, int32_t count, io_mesh *out)
{
    facetT *facet;
    out->vertices = rlf_alloc_array((size_t)count, sizeof(*out->vertices));
    out->triangles = rlf_alloc_array((size_t)qh->num_facets, 3 * sizeof(*out->triangles));
    if (out->vertices == NULL || out->triangles == NULL) {
        io_mesh_free(out);
        return RLF_ERROR_MEMORY;
    }
    out->vertex_count = count;
    for (int32_t i = 0; i < count; i++) {
        out->vertices[i] = points[i];
    }
    FORALLfacets
    {
        if (facet->normal != NULL && facet->simplicial) {
            take_facet(qh, facet, &out->triangles[3 * (ptrdiff_t)out->triangle_count++]);
        }
    }
    return RLF_OK;
}

rlf_result io_hull_wrap(const char *name, const rlf_vec3 *points, int32_t count, io_mesh *out)
{
    *out = (io_mesh){0};
    char options[] = "qhull Qt"; /* triangles */
    qhT *qh = rlf_alloc(sizeof(*qh));
    coordT *copy = rlf_alloc_array((size_t)count, 3 * sizeof(*copy));
    FILE *silence = fopen("/dev/null", "w");
    rlf_result result = RLF_ERROR_MEMORY;
    if (qh != NULL && copy != NULL && silence != NULL) {
        for (int32_t i = 0; i < count; i++) {
            copy[3 * (ptrdiff_t)i] = points[i].x;
            copy[3 * (ptrdiff_t)i + 1] = points[i].y;
            copy[3 * (ptrdiff_t)i + 2] = points[i].z;
        }
        qh_zero(qh, silence);
        int status = qh_new_qhull(qh, 3, count, copy, False, options, NULL, silence);
        if (status == 0) {
            result = take_facets(qh, points, count, out);
        } else {
            result = rlf_fail(RLF_ERROR_INVALID,
                              "%s: its %d points span no solid: they lie in a plane, a line or a "
                              "point",
                              name, (int)count);
        }
        int left, total;
        qh_freeqhull(qh, !qh_ALL);
        qh_memfreeshort(qh, &left, &total);
    }
    if (silence != NULL) {
        fclose(silence);
    }
    rlf_free(copy);
    rlf_free(qh);
    return result;
}
