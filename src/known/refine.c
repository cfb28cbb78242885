/* A pose moved onto the surface near it: point-to-plane (Chen and Medioni 1992), the model's own
 * distance field in place of a search for the nearest point. */
#include "known/align.h"

#define ROUNDS 12
/* Distance from the model of the points that count, first and last. Picks may be so far off that
 * hardly any of the surface is within the first gate: a wider one counts when it ends with so many
 * times more of it. */
#define GATES 2
static const double gates_first[GATES] = {0.04, 0.12};
#define GATE_WIDEST_M 0.12
#define GATE_LAST_M 0.015
#define MORE 1.5
#define SAME_NORMAL 0.75 /* cosine */
#define POINTS_MIN 30
/* Neighbouring pixels err alike, and sensors are off by some millimetres: so many points of so much
 * noise are all that a surface is worth. */
#define WORTH_POINTS 200.0
#define WORTH_SIGMA_M 0.004
/* Of a pose that nobody picked. */
#define START_SIGMA_M 0.02
#define START_SIGMA_RAD 0.05

typedef struct search {
    const rlf_shape *shape;
    const rlf_surface *surface;
    rlf_pose T_world_camera;
} search;

/* Grid pixels that the model may cover, with a margin. */
static void bound(const search *s, const rlf_pose *T_world_model, int32_t out[4])
{
    const rlf_camera *camera = &s->surface->camera;
    rlf_vec3 c = rlf_transform_inverse(&s->T_world_camera, T_world_model->p);
    double radius = rlf_shape_radius(s->shape) + GATE_WIDEST_M;
    double u, v;
    out[0] = out[1] = 0;
    out[2] = camera->width;
    out[3] = camera->height;
    if (c.z > 1.5 * radius && rlf_camera_project(camera, c, &u, &v)) {
        double half = 1.3 * camera->fx * radius / (c.z - radius) + 2.0;
        out[0] = (int32_t)rlf_clamp(u - half, 0, camera->width);
        out[1] = (int32_t)rlf_clamp(v - half, 0, camera->height);
        out[2] = (int32_t)rlf_clamp(u + half, 0, camera->width);
        out[3] = (int32_t)rlf_clamp(v + half, 0, camera->height);
    }
}

/* What the points within `gate` of the model say. */
typedef struct findings {
    math_rigid_sums sums;
    double square_sum;
    int32_t count;
} findings;

static void add_point(const search *s, const rlf_pose *T, int32_t i, double gate, findings *f)
{
    const rlf_surface *surface = s->surface;
    rlf_vec3 normal =
        rlf_vec3_make(surface->normal_x[i], surface->normal_y[i], surface->normal_z[i]);
    rlf_vec3 p = rlf_transform(&s->T_world_camera, rlf_surface_point(surface, i));
    rlf_vec3 gradient;
    double d = rlf_shape_distance(s->shape, rlf_transform_inverse(T, p), &gradient);
    if (!(d < gate && d > -gate)) {
        return;
    }
    gradient = rlf_rotate(T->q, gradient);
    normal = rlf_rotate(s->T_world_camera.q, normal);
    if (!(rlf_dot(normal, gradient) > SAME_NORMAL)) {
        return;
    }
    double share = d / gate;
    double weight = (1.0 - share * share) * (1.0 - share * share); /* Tukey's biweight */
    /* The model moves, the point stays: d shrinks by gradient . (turn x arm + shift). */
    rlf_vec3 turn = rlf_cross(rlf_sub(p, T->p), gradient);
    math_rigid_add(&f->sums, rlf_scale(gradient, -1.0), rlf_scale(turn, -1.0), -d, weight);
    f->square_sum += d * d;
    f->count++;
}

static findings look(const search *s, const rlf_pose *T, double gate)
{
    findings f = {.count = 0};
    int32_t r[4];
    bound(s, T, r);
    for (int32_t y = r[1]; y < r[3]; y++) {
        for (int32_t x = r[0]; x < r[2]; x++) {
            int32_t i = y * s->surface->width + x;
            if (s->surface->depth[i] > 0.0f && s->surface->reason[i] == RLF_REASON_OK) {
                add_point(s, T, i, gate, &f);
            }
        }
    }
    return f;
}

/* Pulls the pose back to where it started, as firmly as the prior says. */
static void add_prior(math_rigid_sums *n, const math_rigid_sums *prior, const rlf_pose *from,
                      const rlf_pose *T)
{
    const rlf_vec3 turn = math_rotation_vector(rlf_quat_mul(T->q, rlf_quat_conjugate(from->q)));
    const rlf_vec3 p = rlf_sub(T->p, from->p);
    const double d[6] = {p.x, p.y, p.z, turn.x, turn.y, turn.z};
    for (int32_t i = 0; i < 6; i++) {
        for (int32_t k = 0; k < 6; k++) {
            double a = i >= k ? prior->a[i][k] : prior->a[k][i];
            n->b[i] -= a * d[k];
            n->a[i][k] += i >= k ? a : 0.0;
        }
    }
}

static void scale(math_rigid_sums *n, double by)
{
    for (int32_t i = 0; i < 6; i++) {
        for (int32_t k = 0; k < 6; k++) {
            n->a[i][k] *= by;
        }
        n->b[i] *= by;
    }
}

/* Rounds from the fit's pose, with points up to `gate` away at first; false when few are so near or
 * they leave the pose open. */
static bool run_rounds(const search *s, const math_rigid_sums *prior, double gate,
                       rlf_known_fit *fit)
{
    rlf_pose T = fit->T_world_model;
    for (int32_t i = 0; i < ROUNDS; i++) {
        findings f = look(s, &T, gate);
        if (f.count < POINTS_MIN) {
            return false;
        }
        double worth = rlf_min(f.sums.weight, WORTH_POINTS) / f.sums.weight;
        scale(&f.sums, worth / (WORTH_SIGMA_M * WORTH_SIGMA_M));
        add_prior(&f.sums, prior, &fit->T_world_model, &T);
        if (!known_step(&f.sums, &T)) {
            return false;
        }
        gate = rlf_max(GATE_LAST_M, 0.8 * gate);
    }
    findings f = look(s, &T, gate);
    fit->T_world_model = T;
    fit->surface_count = f.count;
    fit->surface_rms = f.count > 0 ? sqrt(f.square_sum / f.count) : 0.0;
    return true;
}

void known_refine(const rlf_shape *shape, const rlf_known_view *view, const math_rigid_sums *prior,
                  rlf_known_fit *fit)
{
    const search s = {shape, view->surface, view->T_world_camera};
    const rlf_known_fit start = *fit;
    for (int32_t i = 0; i < GATES; i++) {
        rlf_known_fit tried = start;
        if (run_rounds(&s, prior, gates_first[i], &tried) &&
            tried.surface_count > MORE * fit->surface_count) {
            *fit = tried;
        }
    }
}

void rlf_known_refine(const rlf_shape *shape, const rlf_known_view *view, rlf_known_fit *fit)
{
    if (!RLF_ASSERT(shape != NULL && view != NULL && view->surface != NULL && fit != NULL)) {
        return;
    }
    math_rigid_sums prior = {.weight = 0.0};
    for (int32_t i = 0; i < 6; i++) {
        double sigma = i < 3 ? START_SIGMA_M : START_SIGMA_RAD;
        prior.a[i][i] = 1.0 / (sigma * sigma);
    }
    fit->surface_count = 0;
    known_refine(shape, view, &prior, fit);
}
