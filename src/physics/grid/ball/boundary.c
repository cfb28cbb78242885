/* The line where a face ends, and the corners where the line does.
 *
 * Where another face begins there, the two planes meet on it: that is known to a fraction of a
 * pixel. Else the line is that of the outline in the image. */
#include "physics/grid/ball/boundary.h"
#include "physics/grid/ball/patch.h"

/* A line at which the face ends, and the face beyond. */
typedef struct face_line {
    face_boundary end;
    rlf_vec3 normals[2]; /* of the face itself and, if there is one, of the other */
    int32_t count;
} face_line;

void patch_find_face(const grid_patch *p, patch_mean *mean)
{
    const rlf_vec3 none = {0, 0, 0};
    patch_plane plane;
    if (plane_find(p, p->samples[p->nearest].point, PLANE_NEAR, NULL, 0, none, &plane)) {
        mean->normal = plane.normal;
        mean->point = plane.point;
    }
}

/* Whether another face begins on the line at most of its places. */
static bool is_crease(const grid_patch *p, const face_contour *contour, const contour_point *centre,
                      const image_line *line)
{
    double all = 0.0, bent = 0.0;
    for (int32_t i = 0; i < contour->count; i++) {
        const contour_point *c = &contour->points[i];
        double weight = face_contour_weight(p, c, centre, line);
        all += weight;
        bent += c->next != NULL ? weight : 0.0;
    }
    return bent > 0.5 * all;
}

/* Puts the edge where the two faces meet, unless they hardly bend. */
static void intersect(const patch_mean *mean, const patch_plane *other, face_boundary *end)
{
    rlf_vec3 along = rlf_cross(mean->normal, other->normal);
    double sine2 = rlf_dot(along, along);
    if (sine2 < 0.04) {
        return;
    }
    /* from the edge's place on the face, square to the edge, to the other face */
    rlf_vec3 across = rlf_cross(along, mean->normal);
    double way =
        rlf_dot(other->normal, rlf_sub(other->point, end->point)) / rlf_dot(other->normal, across);
    end->point = rlf_mad(end->point, across, way);
    along = rlf_scale(along, 1.0 / sqrt(sine2));
    end->along = rlf_dot(along, end->along) < 0.0 ? rlf_neg(along) : along;
}

/* Forgets the points on the line. */
static void drop_line(const grid_patch *p, face_contour *contour, const contour_point *centre,
                      const image_line *line)
{
    int32_t left = 0;
    for (int32_t i = 0; i < contour->count; i++) {
        if (!(face_contour_weight(p, &contour->points[i], centre, line) > 0.0)) {
            contour->points[left++] = contour->points[i];
        }
    }
    contour->count = left;
}

/* The image's line on the face, about the point that is nearest to q. */
static face_boundary end_on_face(const grid_patch *p, const patch_mean *mean,
                                 const image_line *line, rlf_vec3 q)
{
    rlf_vec3 from = face_contour_on_face(p, mean, line->u + line->begin * line->du,
                                         line->v + line->begin * line->dv);
    rlf_vec3 to = face_contour_on_face(p, mean, line->u + line->end * line->du,
                                       line->v + line->end * line->dv);
    rlf_vec3 way = rlf_sub(to, from);
    double length = rlf_length(way);
    rlf_vec3 along = rlf_scale(way, 1.0 / rlf_max(length, 1e-9));
    double t = rlf_clamp(rlf_dot(rlf_sub(q, from), along), 0.0, length);
    return (face_boundary){
        .point = rlf_mad(from, along, t), .along = along, .begin = -t, .end = length - t};
}

/* Fits the line about the point nearest to q, and takes its points away. */
static bool find_line(const grid_patch *p, const patch_mean *mean, face_contour *contour,
                      rlf_vec3 q, face_line *out)
{
    int32_t nearest = face_contour_nearest(contour, q);
    if (nearest < 0) {
        return false;
    }
    const contour_point centre = contour->points[nearest];
    image_line line = {0};
    *out = (face_line){.end = {.point = centre.point}, .normals = {mean->normal}, .count = 1};
    if (!face_contour_fit_line(p, contour, &centre, &line)) {
        return false;
    }
    out->end = end_on_face(p, mean, &line, q);
    patch_plane other;
    if (is_crease(p, contour, &centre, &line) &&
        plane_find(p, out->end.point, PLANE_NEAR, out->normals, 1, out->end.along, &other)) {
        intersect(mean, &other, &out->end);
        out->normals[out->count++] = other.normal;
    }
    drop_line(p, contour, &centre, &line);
    return true;
}

/* The line ends where it leaves through the plane. */
static void cut(face_boundary *end, rlf_vec3 normal, rlf_vec3 point)
{
    double slope = rlf_dot(normal, end->along);
    double t = rlf_dot(normal, rlf_sub(point, end->point)) / slope;
    if (slope > 0.2) {
        end->end = t;
        end->begin = rlf_min(end->begin, t);
    } else if (slope < -0.2) {
        end->begin = t;
        end->end = rlf_max(end->end, t);
    }
}

/* The corner: the line ends at the nearest third face that is seen or, for want of one, at the
 * nearest other line at which the face ends. */
static void find_corner(const grid_patch *p, const patch_mean *mean, face_contour *contour,
                        rlf_vec3 foot, face_line *line)
{
    const rlf_vec3 any = {0, 0, 0};
    rlf_vec3 near = patch_boundary_nearest(&line->end, foot);
    int32_t nearest = face_contour_nearest(contour, near);
    patch_plane third;
    face_line next;
    if (nearest >= 0 && contour->points[nearest].next != NULL &&
        plane_find(p, contour->points[nearest].point, PLANE_NEAR, line->normals, line->count, any,
                   &third)) {
        cut(&line->end, third.normal, third.point);
    } else if (find_line(p, mean, contour, near, &next)) {
        rlf_vec3 out = rlf_cross(next.end.along, mean->normal); /* of the face, in its plane */
        bool is_inward = rlf_dot(out, rlf_sub(mean->point, next.end.point)) > 0.0;
        cut(&line->end, is_inward ? rlf_neg(out) : out, next.end.point);
    }
}

/* By the image's lines. */
static void find_by_lines(const grid_patch *p, const patch_mean *mean, face_boundary *out)
{
    face_contour contour;
    face_line line;
    rlf_vec3 foot = patch_foot(p, mean), sample = p->samples[p->nearest].point;
    face_contour_find(p, mean, &contour);
    if (!find_line(p, mean, &contour, foot, &line)) {
        *out = contour.count > 0 ? line.end : (face_boundary){.point = sample};
        return;
    }
    find_corner(p, mean, &contour, foot, &line);
    *out = line.end;
    /* where the face is seen its edge goes on */
    double seen = rlf_dot(rlf_sub(sample, out->point), out->along);
    out->begin = rlf_min(out->begin, seen);
    out->end = rlf_max(out->end, seen);
}

void patch_find_boundary(const grid_patch *p, const patch_mean *mean, bool is_averaged,
                         face_boundary *out)
{
    if (!is_averaged || !corner_find(p, mean, &out->corner)) {
        find_by_lines(p, mean, out);
    }
}

rlf_vec3 patch_boundary_nearest(const face_boundary *end, rlf_vec3 centre)
{
    if (end->corner.count > 1) {
        return corner_nearest(&end->corner, centre);
    }
    double t = rlf_dot(rlf_sub(centre, end->point), end->along);
    return rlf_mad(end->point, end->along, rlf_clamp(t, end->begin, end->end));
}
