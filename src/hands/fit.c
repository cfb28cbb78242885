/* Gauss-Newton on surface points, free space and habits of hands (Melax, Keselman, Orsten 2013;
 * Tagliasacchi et al. 2015). */
#include "hands/fit.h"

#include <string.h>

#define SIGMA_M 0.004     /* of a model's skin beside a true one's, and of depth near by */
#define ROBUST_SIGMAS 3.0 /* Geman and McClure: what is farther pulls less */
#define INDEPENDENT 40.0  /* samples' worth: errors of neighbours are the same */
#define FOREARM_SHARE 0.3
#define WRIST_M 0.06     /* behind the middle of the palm */
#define AWAY_COS 0.3     /* of a hand that points away from the camera */
#define EMPTY_SHARE 0.25 /* of a ball's: two in a cone are one error */
#define EMPTY_MOST_M 0.03
#define BEND_SIGMA 1.5 /* rad: habits */
#define THUMB_SIGMA 0.5
#define ASIDE_SIGMA 0.2
#define WRIST_SIGMA 0.7
#define BESIDE_SIGMA 0.7 /* of neighbours' bends, and of a finger's first and middle joint */
#define FRAME_SIGMA 0.4  /* in one frame */
#define STEP_M 0.04
#define TURN_MOST 0.5 /* rad in a step */
#define BEND_MOST 0.35

enum { LANES = 24 }; /* cones, and room for one that is far away */

/* Cones as the search for the nearest reads them. */
typedef struct lanes {
    float ax[LANES], ay[LANES], az[LANES], dx[LANES], dy[LANES], dz[LANES];
    float inverse[LANES], radius[LANES], grow[LANES];
} lanes;

typedef struct equations {
    double a[MODEL_UNKNOWNS][MODEL_UNKNOWNS], b[MODEL_UNKNOWNS];
} equations;

/* What pulls: the residual along a direction at a point of a cone. */
typedef struct pull {
    rlf_vec3 at, direction;
    double off, weight;
    int32_t cone;
} pull;

static void set_lanes(lanes *l, const hand_model *m)
{
    for (int32_t k = 0; k < LANES; k++) {
        const int32_t i = k < MODEL_CONES ? k : 0;
        const rlf_vec3 d = rlf_sub(m->b[i], m->a[i]);
        l->ax[k] = k < MODEL_CONES ? (float)m->a[i].x : 1e3f;
        l->ay[k] = (float)m->a[i].y;
        l->az[k] = (float)m->a[i].z;
        l->dx[k] = (float)d.x;
        l->dy[k] = (float)d.y;
        l->dz[k] = (float)d.z;
        l->inverse[k] = (float)(1.0 / rlf_dot(d, d));
        l->radius[k] = (float)m->radius_a[i];
        l->grow[k] = (float)(m->radius_b[i] - m->radius_a[i]);
    }
}

/* How far sample i is from the side of each cone that faces the camera. */
static void measure(const lanes *l, const hand_crop *c, int32_t i, float off[LANES])
{
    const float x = c->x[i], y = c->y[i], z = c->p_z[i];
    const float wx = c->way_x[i], wy = c->way_y[i], wz = c->way_z[i];
    for (int32_t k = 0; k < LANES; k++) {
        const float px = x - l->ax[k], py = y - l->ay[k], pz = z - l->az[k];
        float t = (px * l->dx[k] + py * l->dy[k] + pz * l->dz[k]) * l->inverse[k];
        t = t < 0.0f ? 0.0f : t;
        t = t > 1.0f ? 1.0f : t;
        const float ux = px - t * l->dx[k], uy = py - t * l->dy[k], uz = pz - t * l->dz[k];
        const float r = l->radius[k] + t * l->grow[k];
        const float far2 = ux * ux + uy * uy + uz * uz, deep = ux * wx + uy * wy + uz * wz;
        float across2 = far2 - deep * deep;
        across2 = across2 > 0.0f ? across2 : 0.0f;
        float rest = r * r - across2;
        rest = rest > 0.0f ? rest : 0.0f;
        float beside = sqrtf(across2) - r;
        beside = beside > 0.0f ? beside : 0.0f;
        const float front = sqrtf(far2) - r;
        const float inside = deep + sqrtf(rest);
        const float behind = sqrtf(beside * beside + inside * inside);
        const float ahead = front < 0.0f ? -front : front;
        off[k] = deep > 0.0f ? behind : ahead;
    }
}

/* The pull of sample i on its nearest cone. */
static pull pull_of(const hand_model *m, const hand_crop *c, int32_t i, int32_t cone)
{
    const rlf_vec3 p = {(double)c->x[i], (double)c->y[i], (double)c->p_z[i]};
    const rlf_vec3 way = {(double)c->way_x[i], (double)c->way_y[i], (double)c->way_z[i]};
    const rlf_vec3 d = rlf_sub(m->b[cone], m->a[cone]);
    const double t = rlf_clamp(rlf_dot(rlf_sub(p, m->a[cone]), d) / rlf_dot(d, d), 0.0, 1.0);
    const rlf_vec3 q = rlf_mad(m->a[cone], d, t), u = rlf_sub(p, q);
    const double r = m->radius_a[cone] + t * (m->radius_b[cone] - m->radius_a[cone]);
    const double deep = rlf_dot(u, way), far = rlf_length(u);
    pull out = {.cone = cone, .direction = way};
    if (deep <= 0.0 && far > 1e-6) {
        out.direction = rlf_scale(u, 1.0 / far);
        out.off = far - r;
        out.at = rlf_mad(q, out.direction, r);
        return out;
    }
    const rlf_vec3 across = rlf_mad(u, way, -deep);
    const double wide = rlf_length(across);
    out.at = wide < r ? rlf_mad(rlf_add(q, across), way, -sqrt(r * r - wide * wide))
                      : rlf_mad(q, across, r / wide);
    const rlf_vec3 left = rlf_sub(p, out.at);
    out.off = rlf_length(left);
    out.direction = out.off > 1e-6 ? rlf_scale(left, 1.0 / out.off) : way;
    return out;
}

static void add(equations *e, const hand_model *m, const pull *p)
{
    int32_t unknown[6 + MODEL_CHAIN] = {0, 1, 2, 3, 4, 5}, n = 6, first;
    double slope[6 + MODEL_CHAIN];
    const rlf_vec3 turn = rlf_cross(rlf_sub(p->at, m->palm), p->direction);
    slope[0] = p->direction.x;
    slope[1] = p->direction.y;
    slope[2] = p->direction.z;
    slope[3] = turn.x;
    slope[4] = turn.y;
    slope[5] = turn.z;
    const int32_t count = hand_model_chain(p->cone, &first);
    for (int32_t k = 0; k < count; k++) {
        const hand_turn *t = &m->turn[first + k];
        const double s =
            t->share * rlf_dot(rlf_cross(t->axis, rlf_sub(p->at, t->centre)), p->direction);
        if (unknown[n - 1] == t->unknown) {
            slope[n - 1] += s;
        } else {
            unknown[n] = t->unknown;
            slope[n++] = s;
        }
    }
    for (int32_t i = 0; i < n; i++) {
        const double w = p->weight * slope[i];
        double *row = e->a[unknown[i]];
        e->b[unknown[i]] += w * p->off;
        for (int32_t j = 0; j <= i; j++) {
            row[unknown[j]] += w * slope[j];
        }
    }
}

/* Behind the wrist there are sleeves, the other arm and the body; so there are far behind a hand
 * that does not point away. */
static bool is_behind(const hand_model *m, const hand_crop *c, int32_t i)
{
    const rlf_vec3 p = {(double)c->x[i], (double)c->y[i], (double)c->p_z[i]};
    const rlf_vec3 way = {(double)c->way_x[i], (double)c->way_y[i], (double)c->way_z[i]};
    const rlf_vec3 off = rlf_sub(p, m->palm);
    return rlf_dot(off, m->y) < -WRIST_M ||
           (rlf_dot(m->y, way) < AWAY_COS && rlf_dot(off, way) > WRIST_M);
}

double hand_fit_robust(const hand_crop *c, double off, double *less)
{
    const double sigma2 = SIGMA_M * SIGMA_M + (double)c->noise * (double)c->noise;
    const double robust2 = ROBUST_SIGMAS * ROBUST_SIGMAS * sigma2, off2 = off * off;
    const double share = robust2 / (robust2 + off2);
    *less = share * share;
    return INDEPENDENT * off2 * share / sigma2;
}

/* Pixels: each to the nearest cone's side that faces the camera. */
static void add_pixels(equations *e, hand_fit *fit, const hand_model *m, const hand_crop *c,
                       int32_t stride)
{
    lanes l;
    float off[LANES];
    const double n = (c->count + stride - 1) / stride, noise = (double)c->noise;
    const double sigma2 = SIGMA_M * SIGMA_M + noise * noise;
    double sum = 0.0;
    set_lanes(&l, m);
    for (int32_t i = 0; i < c->count; i += stride) {
        measure(&l, c, i, off);
        int32_t best = 0;
        for (int32_t k = 1; k < LANES; k++) {
            best = off[k] < off[best] ? k : best;
        }
        const bool is_arm = best >= MODEL_HAND || is_behind(m, c, i);
        const double share = is_arm ? FOREARM_SHARE : (double)c->share[i];
        double less;
        sum += share * hand_fit_robust(c, (double)off[best], &less);
        if (e != NULL) {
            pull p = pull_of(m, c, i, best);
            p.weight = share * less * INDEPENDENT / (n * sigma2);
            add(e, m, &p);
        }
    }
    fit->seen = sum / n;
}

/* Where the camera sees farther than a ball of a cone, the ball goes back, or to the hand. */
static bool leaves_empty(const hand_crop *c, const rlf_vec3 middle, double radius, pull *out)
{
    const double u = c->fx * middle.x / middle.z + c->cx, v = c->fy * middle.y / middle.z + c->cy;
    if (!(middle.z > 0.05 && u > 0.0 && v > 0.0 && u < c->width - 1.0 && v < c->height - 1.0)) {
        return false;
    }
    const int32_t i = (int32_t)(v + 0.5) * c->width + (int32_t)(u + 0.5);
    const double seen = (double)c->z[i], front = middle.z - radius;
    out->at = middle;
    if (c->is_hand[i] != 0) {
        out->direction = rlf_vec3_make(0, 0, 1);
        out->off = seen - front;
        return out->off > SIGMA_M + 2.0 * (double)c->noise;
    }
    if (!(seen > front) || c->nearest[i] < 0) {
        return false;
    }
    const double dx = (c->nearest[i] % c->width - u) * middle.z / c->fx;
    const double dy = ((double)(c->nearest[i] / c->width) - v) * middle.z / c->fy;
    out->off = sqrt(dx * dx + dy * dy);
    out->direction = rlf_vec3_make(dx / out->off, dy / out->off, 0.0);
    return out->off > 1e-4;
}

static double add_empty(equations *e, const hand_model *m, const hand_crop *c)
{
    static const double places[2] = {0.45, 1.0};
    const double pixel = m->palm.z / c->fx;
    const double sigma2 = 4.0 * SIGMA_M * SIGMA_M + pixel * pixel;
    double energy = 0.0;
    for (int32_t k = 0; k < 2 * MODEL_HAND; k++) {
        const int32_t cone = k / 2;
        const double t = places[k % 2];
        const rlf_vec3 d = rlf_sub(m->b[cone], m->a[cone]);
        const double radius = m->radius_a[cone] + t * (m->radius_b[cone] - m->radius_a[cone]);
        pull p = {.cone = cone, .weight = EMPTY_SHARE / sigma2};
        if (leaves_empty(c, rlf_mad(m->a[cone], d, t), radius, &p)) {
            p.off = rlf_min(p.off, EMPTY_MOST_M);
            energy += p.weight * p.off * p.off;
            if (e != NULL) {
                add(e, m, &p);
            }
        }
    }
    return energy;
}

/* Two fingers beside each other are not in one place: ends of their bones push each other off. */
static double add_apart(equations *e, const hand_model *m)
{
    double energy = 0.0;
    for (int32_t k = MODEL_PALM + 3; k + 3 < MODEL_HAND; k++) {
        const rlf_vec3 way = rlf_sub(m->b[k + 3], m->b[k]);
        const double far = rlf_length(way);
        const double deep = m->radius_b[k] + m->radius_b[k + 3] - far;
        if (deep > 0.0 && far > 1e-6) {
            const double weight = 1.0 / (SIGMA_M * SIGMA_M);
            pull p = {m->b[k], rlf_scale(way, -1.0 / far), 0.5 * deep, weight, k};
            energy += 0.5 * weight * deep * deep;
            if (e != NULL) {
                add(e, m, &p);
                p = (pull){m->b[k + 3], rlf_neg(p.direction), p.off, weight, k + 3};
                add(e, m, &p);
            }
        }
    }
    return energy;
}

/* Pulls unknown i to `to`, and where j >= 0 the difference of both. */
static double add_habit(equations *e, const double *angle, int32_t i, int32_t j, double to,
                        double sigma)
{
    const double w = 1.0 / (sigma * sigma);
    const double off = to + (j >= 0 ? angle[j - MODEL_THUMB] : 0.0) - angle[i - MODEL_THUMB];
    if (e != NULL) {
        e->a[i][i] += w;
        e->b[i] += w * off;
        if (j >= 0) {
            e->a[j][j] += w;
            e->a[i > j ? i : j][i > j ? j : i] -= w;
            e->b[j] -= w * off;
        }
    }
    return w * off * off;
}

static double add_habits(equations *e, const hand_model_pose *pose)
{
    double energy = 0.0;
    for (int32_t i = MODEL_THUMB; i < MODEL_UNKNOWNS; i++) {
        const bool is_spread = i >= MODEL_FINGER && (i - MODEL_FINGER) % 3 == 0;
        const double sigma = i < MODEL_FINGER   ? THUMB_SIGMA
                             : i >= MODEL_WRIST ? WRIST_SIGMA
                             : is_spread        ? ASIDE_SIGMA
                                                : BEND_SIGMA;
        energy += add_habit(e, pose->angle, i, -1, hand_model_mean[i - MODEL_THUMB], sigma);
        if (i >= MODEL_FINGER + 3 && i < MODEL_WRIST && !is_spread) {
            const double sigma_beside = i < MODEL_FINGER + 6 ? 2.0 * BESIDE_SIGMA : BESIDE_SIGMA;
            energy += add_habit(e, pose->angle, i, i - 3, 0.0, sigma_beside);
        }
        if (i >= MODEL_FINGER && i < MODEL_WRIST && (i - MODEL_FINGER) % 3 == 2) {
            energy += add_habit(e, pose->angle, i, i - 1, 0.15, BESIDE_SIGMA);
        }
    }
    return energy;
}

/* Cholesky; what has hardly a pivot stays. */
static void solve(equations *e, double *x)
{
    for (int32_t i = 0; i < MODEL_UNKNOWNS; i++) {
        for (int32_t j = 0; j <= i; j++) {
            double sum = e->a[i][j];
            for (int32_t k = 0; k < j; k++) {
                sum -= e->a[i][k] * e->a[j][k];
            }
            e->a[i][j] = i == j ? sqrt(rlf_max(sum, 1e-3)) : sum / e->a[j][j];
        }
    }
    for (int32_t i = 0; i < MODEL_UNKNOWNS; i++) {
        double sum = e->b[i];
        for (int32_t k = 0; k < i; k++) {
            sum -= e->a[i][k] * x[k];
        }
        x[i] = sum / e->a[i][i];
    }
    for (int32_t i = MODEL_UNKNOWNS - 1; i >= 0; i--) {
        double sum = x[i];
        for (int32_t k = i + 1; k < MODEL_UNKNOWNS; k++) {
            sum -= e->a[k][i] * x[k];
        }
        x[i] = sum / e->a[i][i];
    }
}

static void bound(double *x, int32_t first, int32_t end, double most)
{
    for (int32_t i = first; i < end; i++) {
        x[i] = rlf_clamp(x[i], -most, most);
    }
}

static void gather(equations *e, hand_fit *fit, const hand_model *m, const hand_crop *c,
                   int32_t stride)
{
    add_pixels(e, fit, m, c, stride);
    fit->energy = fit->seen + add_empty(e, m, c) + add_apart(e, m) + add_habits(e, &fit->pose);
}

void hand_fit_improve(hand_fit *fit, const hand_crop *crop, const hand_model_pose *before,
                      int32_t steps, int32_t stride)
{
    hand_model m;
    equations e;
    double x[MODEL_UNKNOWNS];
    for (int32_t n = 0; n < steps; n++) {
        memset(&e, 0, sizeof(e));
        hand_model_build(&m, &fit->pose);
        gather(&e, fit, &m, crop, stride);
        for (int32_t i = 0; i < MODEL_UNKNOWNS; i++) {
            e.a[i][i] += i < 3 ? 1e4 : 10.0; /* a centimetre, a sixth of a turn */
            if (i >= MODEL_THUMB && before != NULL) {
                (void)add_habit(&e, fit->pose.angle, i, -1, before->angle[i - MODEL_THUMB],
                                FRAME_SIGMA);
            }
        }
        solve(&e, x);
        bound(x, 0, 3, STEP_M);
        bound(x, 3, 6, TURN_MOST);
        bound(x, 6, MODEL_UNKNOWNS, BEND_MOST);
        hand_model_step(&fit->pose, &m, x);
    }
}

void hand_fit_judge(hand_fit *fit, const hand_crop *crop, int32_t stride)
{
    hand_model m;
    hand_model_build(&m, &fit->pose);
    gather(NULL, fit, &m, crop, stride);
}
