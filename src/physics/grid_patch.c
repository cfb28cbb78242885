/* Where a face ends.
 *
 * Between a pixel on the face and one beside it that is off it, the edge is somewhere, at half way
 * on average; where the face bends to one that is seen, too, it is above the points of that one.
 * A line through such places is better: an edge that runs slantwise to the pixels is
 * placed to a part of one. */
#include "physics/grid_patch.h"

#define PATCH_SIDE (2 * PATCH_PX + 1)
#define MOST_CRACKS (4 * PATCH_SIDE * PATCH_SIDE)
#define FITS 2       /* the second one is centred on what the first one found */
#define REACH_PX 5.0 /* about the nearest place, in steps */
#define OFF 0.01     /* farther below the face is off it, metres */
#define CREASE 0.03  /* a neighbouring pixel no farther behind is no step, metres per step */

/* The point of the face under the ball's centre. */
rlf_vec3 patch_foot(const grid_patch *p, const patch_mean *mean)
{
    double height = rlf_dot(mean->normal, rlf_sub(p->centre, mean->point));
    return rlf_mad(p->centre, mean->normal, -height);
}

/* Places of the edge, in the image: that is where their errors are alike. */
typedef struct edge_fit {
    double u[MOST_CRACKS], v[MOST_CRACKS];
    rlf_vec3 point[MOST_CRACKS]; /* on the face */
    int32_t count;
} edge_fit;

static double off_face(const patch_mean *mean, rlf_vec3 p)
{
    return rlf_dot(mean->normal, rlf_sub(p, mean->point));
}

/* Where the ray through the image's place (u, v) meets the face, that has moved since it was seen.
 */
static rlf_vec3 on_face(const grid_patch *p, const patch_mean *mean, double u, double v)
{
    const rlf_grid *grid = p->job->query->grid;
    int32_t x = (int32_t)rlf_clamp(u + 0.5, 0.0, grid->width - 1.0);
    int32_t y = (int32_t)rlf_clamp(v + 0.5, 0.0, grid->height - 1.0);
    int32_t i = y * grid->width + x;
    rlf_vec3 ray = {grid->ray_x[i] + (u - x) * grid->pixel_angle,
                    grid->ray_y[i] + (v - y) * grid->pixel_angle, 1.0};
    double tau = p->job->query->tau + rlf_max(0.0, p->time);
    rlf_vec3 shift = rlf_scale(mean->velocity, tau);
    rlf_vec3 point = rlf_sub(mean->point, shift);
    double slope = rlf_dot(mean->normal, ray), z = point.z;
    if (slope < -0.02) {
        z = rlf_clamp(rlf_dot(mean->normal, point) / slope, 0.9 * z, 1.1 * z);
    }
    return rlf_mad(shift, ray, z);
}

/* The sample at column u and row v, or NULL. */
static const patch_sample *sample_at(const grid_patch *p, int32_t u, int32_t v)
{
    bool is_in = u >= 0 && v >= 0 && u < PATCH_SIDE && v < PATCH_SIDE;
    int32_t index = is_in ? p->index[v * PATCH_SIDE + u] : 0;
    return index > 0 ? &p->samples[index - 1] : NULL;
}

/* Where the face bends away to another one that is seen, too, the first point of that one stands
 * under the edge: pixels are far apart on a face seen at a low angle, but not along its normal.
 * False where there is a step. */
static bool find_crease(const grid_patch *p, const patch_mean *mean, const patch_sample *next,
                        const patch_sample *s, double out[2])
{
    const rlf_grid *grid = p->job->query->grid;
    if (next == NULL || next->cell.point.z - s->cell.point.z > CREASE * p->step) {
        return false;
    }
    double tau = p->job->query->tau + rlf_max(0.0, p->time);
    rlf_vec3 edge = rlf_mad(next->point, mean->normal, -off_face(mean, next->point));
    edge = rlf_mad(edge, mean->velocity, -tau); /* as it was seen */
    return edge.z > 0.0 && grid->project(grid->project_context, edge, &out[0], &out[1]);
}

/* Notes the edge's place between the sample and its free neighbour: half way, if nothing is known.
 */
static void add_crack(const grid_patch *p, const patch_mean *mean, const patch_sample *s,
                      const patch_sample *next, const int32_t step[2], edge_fit *fit)
{
    double at[2];
    if (!find_crease(p, mean, next, s, at)) {
        at[0] = s->cell.x + 0.5 * step[0] * p->step;
        at[1] = s->cell.y + 0.5 * step[1] * p->step;
    }
    fit->u[fit->count] = at[0];
    fit->v[fit->count] = at[1];
    fit->point[fit->count++] = on_face(p, mean, at[0], at[1]);
}

static bool is_on_face(const patch_mean *mean, const patch_sample *s)
{
    double off = off_face(mean, s->point);
    return off < OFF && off > -OFF && patch_is_of_face(s->cell.normal, mean->normal);
}

/* Whether the patch's pixel at column u and row v is off the face. */
static bool is_free(const grid_patch *p, const patch_mean *mean, int32_t u, int32_t v)
{
    if (u < 0 || v < 0 || u >= PATCH_SIDE || v >= PATCH_SIDE) {
        return false; /* who knows */
    }
    const patch_sample *s = sample_at(p, u, v);
    if (s == NULL) {
        return true;
    }
    double off = off_face(mean, s->point);
    return off < -OFF || (off < 0.3 * OFF && !patch_is_of_face(s->cell.normal, mean->normal));
}

static void find_cracks(const grid_patch *p, const patch_mean *mean, edge_fit *fit)
{
    const int32_t STEPS[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (int32_t v = 0; v < PATCH_SIDE; v++) {
        for (int32_t u = 0; u < PATCH_SIDE; u++) {
            const patch_sample *s = sample_at(p, u, v);
            bool is_on = s != NULL && is_on_face(mean, s);
            for (int32_t k = 0; k < 4 && is_on; k++) {
                int32_t x = u + STEPS[k][0], y = v + STEPS[k][1];
                if (is_free(p, mean, x, y)) {
                    add_crack(p, mean, s, sample_at(p, x, y), STEPS[k], fit);
                }
            }
        }
    }
}

/* Ends of the line through the places near the one at `centre`; false when they are on no line. */
static bool fit_line(const edge_fit *fit, int32_t centre, double reach, double a[2], double b[2])
{
    double cu = fit->u[centre], cv = fit->v[centre];
    double sum = 0.0, su = 0.0, sv = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;
    for (int32_t i = 0; i < fit->count; i++) {
        double du = fit->u[i] - cu, dv = fit->v[i] - cv;
        double weight = rlf_max(0.0, 1.0 - (du * du + dv * dv) / (reach * reach));
        sum += weight;
        su += weight * du;
        sv += weight * dv;
        uu += weight * du * du;
        uv += weight * du * dv;
        vv += weight * dv * dv;
    }
    su /= sum;
    sv /= sum;
    uu = uu / sum - su * su;
    uv = uv / sum - su * sv;
    vv = vv / sum - sv * sv;
    double half = 0.5 * (uu + vv), root = sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
    if (!(root > 0.6 * half)) {
        return false;
    }
    /* the larger spread is along (cos t, sin t) with tan 2 t = 2 uv / (uu - vv) */
    double c = sqrt(0.5 + 0.25 * (uu - vv) / root), s = sqrt(rlf_max(0.0, 1.0 - c * c));
    double limit = 1.7 * sqrt(half + root); /* as far as the places go, if they are even */
    s = uv < 0.0 ? -s : s;
    a[0] = cu + su - limit * c;
    a[1] = cv + sv - limit * s;
    b[0] = cu + su + limit * c;
    b[1] = cv + sv + limit * s;
    return true;
}

static int32_t nearest_to(const edge_fit *fit, rlf_vec3 p)
{
    int32_t best = 0;
    double best2 = 1e30;
    for (int32_t i = 0; i < fit->count; i++) {
        rlf_vec3 d = rlf_sub(fit->point[i], p);
        if (rlf_dot(d, d) < best2) {
            best2 = rlf_dot(d, d);
            best = i;
        }
    }
    return best;
}

rlf_vec3 patch_edge(const grid_patch *p, const patch_mean *mean)
{
    edge_fit fit;
    rlf_vec3 foot = patch_foot(p, mean), edge = foot;
    double a[2], b[2];
    fit.count = 0;
    find_cracks(p, mean, &fit);
    if (fit.count == 0) {
        return p->samples[p->nearest].point;
    }
    for (int32_t i = 0; i < FITS; i++) {
        int32_t centre = nearest_to(&fit, edge);
        if (!fit_line(&fit, centre, REACH_PX * p->step, a, b)) {
            return fit.point[centre];
        }
        rlf_vec3 from = on_face(p, mean, a[0], a[1]);
        rlf_vec3 along = rlf_sub(on_face(p, mean, b[0], b[1]), from);
        double share = rlf_dot(rlf_sub(foot, from), along) / rlf_max(rlf_dot(along, along), 1e-12);
        edge = rlf_mad(from, along, rlf_clamp(share, 0.0, 1.0));
    }
    return edge;
}
