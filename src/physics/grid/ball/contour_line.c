/* Where a face ends.
 *
 * Between a pixel on the face and one beside it that is off it, the edge is somewhere, at half way
 * on average; where the face bends to one that is seen, too, it is above the points of that one.
 * The line on which most such places agree is better: an edge that runs slantwise to the pixels is
 * placed to a part of one, and another edge that is near does not bend it (as in RANSAC, Fischler
 * and Bolles 1981, with every place tried). */
#include "physics/grid/ball/boundary.h"

#define TRIALS 64     /* lines that are tried for one edge */
#define REACH_PX 7.0  /* about the nearest place, in steps */
#define AGREEMENT 0.8 /* of places on one line, in steps */
#define CREASE 1.5    /* pitches: neighbours on two faces that meet are no farther apart */

static double off_face(const patch_mean *mean, rlf_vec3 p)
{
    return rlf_dot(mean->normal, rlf_sub(p, mean->point));
}

rlf_vec3 face_contour_on_face(const grid_patch *p, const patch_mean *mean, double u, double v)
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
    if (slope < -GRAZING_COS) {
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

/* How far apart neighbouring pixels' points are at most on the cell's plane, metres. */
static double pitch_of(const grid_patch *p, const field_cell *cell)
{
    double cosine = -rlf_dot(cell->normal, cell->point) / rlf_length(cell->point);
    return p->step * cell->point.z * p->job->query->grid->pixel_angle / rlf_max(cosine, 0.1);
}

static bool is_step(const grid_patch *p, const patch_sample *s, const patch_sample *next)
{
    rlf_vec3 d = rlf_sub(next->point, s->point);
    double limit = CREASE * (pitch_of(p, &s->cell) + pitch_of(p, &next->cell));
    return rlf_dot(d, d) > limit * limit;
}

/* Where the face bends away to another one that is seen, too, the first point of that one stands
 * under the edge: pixels are far apart on a face seen at a low angle, but not along its normal.
 * False where there is a step. */
static bool find_crease(const grid_patch *p, const patch_mean *mean, const patch_sample *next,
                        const patch_sample *s, double out[2])
{
    const rlf_grid *grid = p->job->query->grid;
    if (next == NULL || is_step(p, s, next)) {
        return false;
    }
    double tau = p->job->query->tau + rlf_max(0.0, p->time);
    rlf_vec3 edge = rlf_mad(next->point, mean->normal, -off_face(mean, next->point));
    edge = rlf_mad(edge, mean->velocity, -tau); /* as it was seen */
    return edge.z > 0.0 && grid->project(grid->project_context, edge, &out[0], &out[1]);
}

/* Notes the edge's place between the sample and its free neighbour: half way, if nothing is known.
 */
static void add_point(const grid_patch *p, const patch_mean *mean, const patch_sample *s,
                      const patch_sample *next, const int32_t step[2], face_contour *contour)
{
    double at[2];
    bool is_crease = find_crease(p, mean, next, s, at);
    if (!is_crease) {
        at[0] = s->cell.x + 0.5 * step[0] * p->step;
        at[1] = s->cell.y + 0.5 * step[1] * p->step;
    }
    contour->points[contour->count++] =
        (contour_point){.u = at[0],
                        .v = at[1],
                        .point = face_contour_on_face(p, mean, at[0], at[1]),
                        .next = is_crease ? next : NULL};
}

static bool is_on_face(const patch_mean *mean, const patch_sample *s)
{
    double off = off_face(mean, s->point);
    return off < GRID_NOISE_M && off > -GRID_NOISE_M &&
           patch_is_of_face(s->cell.normal, mean->normal);
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
    return off < -GRID_NOISE_M ||
           (off < 0.3 * GRID_NOISE_M && !patch_is_of_face(s->cell.normal, mean->normal));
}

void face_contour_find(const grid_patch *p, const patch_mean *mean, face_contour *contour)
{
    const int32_t STEPS[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    contour->count = 0;
    for (int32_t v = 0; v < PATCH_SIDE; v++) {
        for (int32_t u = 0; u < PATCH_SIDE; u++) {
            const patch_sample *s = sample_at(p, u, v);
            bool is_on = s != NULL && is_on_face(mean, s);
            for (int32_t k = 0; k < 4 && is_on; k++) {
                int32_t x = u + STEPS[k][0], y = v + STEPS[k][1];
                if (is_free(p, mean, x, y)) {
                    add_point(p, mean, s, sample_at(p, x, y), STEPS[k], contour);
                }
            }
        }
    }
}

double face_contour_weight(const grid_patch *p, const contour_point *point,
                           const contour_point *centre, const image_line *line)
{
    double reach = REACH_PX * p->step, off = AGREEMENT * p->step;
    double du = point->u - centre->u, dv = point->v - centre->v;
    double lu = point->u - line->u, lv = point->v - line->v;
    double aside = lu * line->dv - lv * line->du;
    bool is_on = aside < off && aside > -off;
    return is_on ? rlf_max(0.0, 1.0 - (du * du + dv * dv) / (reach * reach)) : 0.0;
}

/* The line through `centre` and another place on which most others are. */
static bool choose_line(const grid_patch *p, const face_contour *contour,
                        const contour_point *centre, image_line *out)
{
    double best = 0.0;
    int32_t stride = contour->count / TRIALS + 1;
    for (int32_t i = 0; i < contour->count; i += stride) {
        double du = contour->points[i].u - centre->u, dv = contour->points[i].v - centre->v;
        double length = sqrt(du * du + dv * dv);
        if (length < 1.5 * p->step) {
            continue;
        }
        image_line line = {centre->u, centre->v, du / length, dv / length, 0.0, 0.0};
        double support = 0.0;
        for (int32_t k = 0; k < contour->count; k++) {
            support += face_contour_weight(p, &contour->points[k], centre, &line);
        }
        if (support > best) {
            best = support;
            *out = line;
        }
    }
    return best > 0.0;
}

/* Whether the line's place at t is at the patch's rim, so that nobody knows how far it goes on. */
static bool is_at_rim(const grid_patch *p, const image_line *line, double t)
{
    double u = line->u + t * line->du - p->x, v = line->v + t * line->dv - p->y;
    double rim = (PATCH_PX - 1.0) * p->step;
    return u < -rim || u > rim || v < -rim || v > rim;
}

/* How far the places on the line go. */
static void find_ends(const grid_patch *p, const face_contour *contour, const contour_point *centre,
                      image_line *line)
{
    double begin = 0.0, end = 0.0, half = 0.5 * p->step, far = REACH_PX * p->step;
    for (int32_t i = 0; i < contour->count; i++) {
        const contour_point *c = &contour->points[i];
        if (face_contour_weight(p, c, centre, line) > 0.0) {
            double t = (c->u - line->u) * line->du + (c->v - line->v) * line->dv;
            begin = rlf_min(begin, t);
            end = rlf_max(end, t);
        }
    }
    line->begin = begin - (is_at_rim(p, line, begin) ? far : half);
    line->end = end + (is_at_rim(p, line, end) ? far : half);
}

/* Weighted sums over the places on a line, about its centre. */
typedef struct line_sums {
    double n, u, v, uu, uv, vv;
} line_sums;

static line_sums sums_of(const grid_patch *p, const face_contour *contour,
                         const contour_point *centre, const image_line *line)
{
    line_sums s = {0};
    for (int32_t i = 0; i < contour->count; i++) {
        const contour_point *c = &contour->points[i];
        double weight = face_contour_weight(p, c, centre, line);
        double du = c->u - centre->u, dv = c->v - centre->v;
        s.n += weight;
        s.u += weight * du;
        s.v += weight * dv;
        s.uu += weight * du * du;
        s.uv += weight * du * dv;
        s.vv += weight * dv * dv;
    }
    return s;
}

/* Least squares through the places on the line. */
static void refine_line(const grid_patch *p, const face_contour *contour,
                        const contour_point *centre, image_line *line)
{
    line_sums s = sums_of(p, contour, centre, line);
    double u = s.u / s.n, v = s.v / s.n;
    double uu = s.uu / s.n - u * u, uv = s.uv / s.n - u * v, vv = s.vv / s.n - v * v;
    double root = sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
    if (root > 0.0) {
        /* the larger spread is along (cos t, sin t) with tan 2 t = 2 uv / (uu - vv) */
        double cosine = sqrt(0.5 + 0.25 * (uu - vv) / root);
        double sine = sqrt(rlf_max(0.0, 1.0 - cosine * cosine));
        *line =
            (image_line){centre->u + u, centre->v + v, cosine, uv < 0.0 ? -sine : sine, 0.0, 0.0};
    }
}

bool face_contour_fit_line(const grid_patch *p, const face_contour *contour,
                           const contour_point *centre, image_line *out)
{
    if (!choose_line(p, contour, centre, out)) {
        return false;
    }
    refine_line(p, contour, centre, out);
    find_ends(p, contour, centre, out);
    return true;
}

int32_t face_contour_nearest(const face_contour *contour, rlf_vec3 p)
{
    int32_t best = -1;
    double best2 = 1e30;
    for (int32_t i = 0; i < contour->count; i++) {
        rlf_vec3 d = rlf_sub(contour->points[i].point, p);
        if (rlf_dot(d, d) < best2) {
            best2 = rlf_dot(d, d);
            best = i;
        }
    }
    return best;
}
