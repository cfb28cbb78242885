/* Planes by their support among the points of a patch, refined by least squares. */
#include "physics/grid/ball/ball.h"

#define LIKE 0.85         /* cosine between normals of one face beside its edge */
#define LEAST_SUPPORT 6.0 /* samples */
#define REFINEMENTS 2

static bool is_on_plane(const patch_plane *plane, const patch_sample *s, double slack)
{
    double off = rlf_dot(plane->normal, rlf_sub(s->point, plane->point));
    return off < slack && off > -slack && rlf_dot(s->cell.normal, plane->normal) > LIKE;
}

/* A point of a plane is no farther off it: two sigma of what is a mean over time, metres. */
static double slack_at(double z)
{
    return 0.002 + 0.0003 * z * z;
}

/* Sums over the samples on a plane, of places (x, y) in it and heights h over it. */
typedef struct plane_sums {
    rlf_vec3 e, f; /* along x and y */
    double n, x, y, h, xx, xy, yy, xh, yh;
} plane_sums;

static plane_sums sums_of(const grid_patch *p, const patch_plane *plane)
{
    plane_sums sums = {.e = rlf_perpendicular(plane->normal)};
    sums.f = rlf_cross(plane->normal, sums.e);
    double slack = slack_at(plane->point.z);
    for (int32_t i = 0; i < p->count; i++) {
        if (!is_on_plane(plane, &p->samples[i], slack)) {
            continue;
        }
        rlf_vec3 d = rlf_sub(p->samples[i].point, plane->point);
        double x = rlf_dot(d, sums.e), y = rlf_dot(d, sums.f), h = rlf_dot(d, plane->normal);
        sums.n += 1.0;
        sums.x += x;
        sums.y += y;
        sums.h += h;
        sums.xx += x * x;
        sums.xy += x * y;
        sums.yy += y * y;
        sums.xh += x * h;
        sums.yh += y * h;
    }
    return sums;
}

/* Least squares for the height over the plane, and its support. */
static void refine_plane(const grid_patch *p, patch_plane *plane)
{
    plane_sums s = sums_of(p, plane);
    plane->support = s.n;
    if (s.n < LEAST_SUPPORT) {
        return;
    }
    double xx = s.xx - s.x * s.x / s.n, xy = s.xy - s.x * s.y / s.n, yy = s.yy - s.y * s.y / s.n;
    double xh = s.xh - s.x * s.h / s.n, yh = s.yh - s.y * s.h / s.n;
    double det = xx * yy - xy * xy;
    if (!(det > 0.01 * xx * yy)) {
        return; /* they are on a line */
    }
    double slope_x = (xh * yy - yh * xy) / det, slope_y = (yh * xx - xh * xy) / det;
    rlf_vec3 sum = rlf_mad(rlf_scale(s.e, s.x), s.f, s.y);
    sum = rlf_mad(sum, plane->normal, s.h);
    plane->point = rlf_add(plane->point, rlf_scale(sum, 1.0 / s.n));
    plane->normal = rlf_normalize(rlf_mad(rlf_mad(plane->normal, s.e, -slope_x), s.f, -slope_y));
}

/* Whether the plane may be the one that is sought: near q, and none of `others`. */
static bool is_sought(const patch_plane *plane, rlf_vec3 q, double near, const rlf_vec3 *others,
                      int32_t count)
{
    double off = rlf_dot(plane->normal, rlf_sub(q, plane->point));
    bool is_good = off < near && off > -near;
    for (int32_t i = 0; i < count; i++) {
        is_good = is_good && rlf_dot(plane->normal, others[i]) < SAME_FACE_COS;
    }
    return is_good;
}

bool plane_holds(const patch_plane *plane, const patch_sample *s)
{
    return is_on_plane(plane, s, slack_at(plane->point.z));
}

bool plane_find(const grid_patch *p, rlf_vec3 q, double near, const rlf_vec3 *others, int32_t count,
                patch_plane *out)
{
    *out = (patch_plane){.support = 0.0};
    for (int32_t i = 0; i < p->count; i += 2) { /* every second one is tried */
        const patch_sample *s = &p->samples[i];
        patch_plane plane = {s->cell.normal, s->point, 0.0};
        if (!is_sought(&plane, q, near, others, count)) {
            continue;
        }
        double slack = slack_at(s->point.z);
        for (int32_t k = 0; k < p->count; k++) {
            plane.support += is_on_plane(&plane, &p->samples[k], slack);
        }
        if (plane.support > out->support) {
            *out = plane;
        }
    }
    for (int32_t i = 0; i < REFINEMENTS && out->support >= LEAST_SUPPORT; i++) {
        refine_plane(p, out);
    }
    return out->support >= LEAST_SUPPORT;
}
