/* Fits conics to chords, and paints what they say. */
#include "surface/thickness/thickness.h"

#include <math.h>

/* Neighbouring pixels share noise and shape error: two count as one. */
static const float correlated_samples = 2.0f;
/* Before anything is seen, bodies are taken for balls, give or take. */
static const float ratio_deviation = 0.6f, slope_deviation = 0.2f;
static const float straight_trust = 0.1f;
static const float trusted_rest_m = 0.003f; /* what a conic may leave and still be trusted */
/* What is wide is seldom flatter than a trunk, and what is as wide as trunk and arms together is as
 * deep as a trunk is: chest, waist and buttocks are 23 to 25 cm deep on average, by both sexes'
 * means in ANSUR II (Gordon et al. 2014, Natick/TR-15/007). */
static const float usual_ratio = 0.7f, flat_ratio = 0.15f, trunk_depth_m = 0.25f;
static const float wide_m = 0.12f, unlike_conic_m = 0.003f;
static const float covered_m = 0.085f;      /* half of an arm, and of its clothes */
static const float middle_error_m = 0.006f; /* of a conic that leaves nothing */

/* What a ball at the ray (x, y, 1) would show along the line: its middle is a plane square to the
 * ray r, and with t the line's direction and R its radius it is R / |r| deep along z, and R |r| /
 * sqrt(r^2 - (r.t)^2) wide. */
static void expect_ball(const rlf_chord_job *job, const rlf_line *line, ptrdiff_t i, rlf_chord *c)
{
    const image_grid *grid = &job->stage->grid;
    float tx = (float)line->dx / ((float)grid->camera.fx * line->angle);
    float ty = (float)line->dy / ((float)grid->camera.fy * line->angle);
    float x = grid->ray_x[i], y = grid->ray_y[i];
    float r2 = 1.0f + x * x + y * y, along = x * tx + y * ty;
    c->expected_slope = -along / r2;
    c->expected_ratio = sqrtf(r2 - along * along) / r2;
}

/* Plain sums over the samples of a chord. */
static rlf_kernel_chord_sums sum_samples(const rlf_chord_job *job, const rlf_line *line,
                                         const rlf_chord *c, float z)
{
    float sigma = rlf_kernel_sigma(job->noise, z);
    /* d sqrt(l r) / dl = sqrt(r / l) / 2: what an end that is not sharp is worth in depth */
    float v0 = 0.5f * c->blur[0] * c->metres, v1 = 0.5f * c->blur[1] * c->metres;
    const rlf_kernel_chord ends = {c->begin, c->end};
    float lines = 1.0f / (float)job->step; /* a line is worth those between it and the next */
    const rlf_kernel_chord_noise noise = {
        lines * (sigma * sigma + RLF_SHAPE_ERROR_M * RLF_SHAPE_ERROR_M),
        {lines * v0 * v0, lines * v1 * v1},
        c->metres,
        c->inverse,
        z};
    rlf_kernel_chord_sums sums = {0};
    for (int32_t i = 0; i < c->part_count; i++) {
        int32_t end = c->part[i].end;
        for (int32_t first = c->part[i].begin; first < end; first += RLF_CHORD_RUN) {
            float seen[RLF_CHORD_RUN];
            const float *from = job->inverse + line->base + first * line->stride;
            int32_t count = end - first < RLF_CHORD_RUN ? end - first : RLF_CHORD_RUN;
            for (int32_t k = 0; k < count; k++) {
                seen[k] = from[k * line->stride];
            }
            rlf_kernel_chord_sum(&ends, &noise, seen, first, count, &sums);
        }
    }
    return sums;
}

bool rlf_chord_measure(const rlf_chord_job *job, const rlf_line *line, rlf_chord *c)
{
    int32_t middle = (c->part[0].begin + c->part[0].end) / 2;
    float z = job->front[line->base + middle * line->stride];
    int32_t x = line->x + middle * line->dx, y = line->y + middle * line->dy;
    ptrdiff_t i = (ptrdiff_t)y * job->stage->grid.width + x;
    RLF_KERNEL_SOON(&job->stage->grid.ray_x[i]);
    RLF_KERNEL_SOON(&job->stage->grid.ray_y[i]);
    c->inverse = 1.0f / z;
    c->metres = z * line->angle;
    float sigma = rlf_kernel_sigma(job->noise, z);
    c->noise = sigma * sigma;
    c->beside = (rlf_chord_middle){0.0f, 0.0f};
    c->is_of_people = job->is_of_people;
    rlf_kernel_chord_sums t = sum_samples(job, line, c, z);
    expect_ball(job, line, i, c);
    if (!(t.n > 0.0f)) {
        return false;
    }
    c->weight = t.n;
    c->s = t.s / t.n;
    c->h = t.h / t.n;
    c->y = t.y / t.n;
    c->yy = t.yy - t.y * c->y;
    c->own = (rlf_chord_moments){t.ss - t.s * c->s, t.hh - t.h * c->h, t.sh - t.s * c->h,
                                 t.sy - t.s * c->y, t.hy - t.h * c->y};
    return true;
}

/* The normal equations: the samples, what bodies are usually like, and the middle that the lines
 * beside have, which is one more sample. */
static rlf_chord_moments equations(const rlf_chord *c, const rlf_chord_moments *m)
{
    const float slope_prior = correlated_samples / (slope_deviation * slope_deviation);
    const float ratio_prior = correlated_samples / (ratio_deviation * ratio_deviation);
    float weight = correlated_samples * c->beside.weight;
    float ws = weight * c->s, wh = weight * c->h;
    float y = c->y + 1.0f / c->inverse - c->beside.depth;
    return (rlf_chord_moments){m->ss + slope_prior + ws * c->s, m->hh + ratio_prior + wh * c->h,
                               m->sh + ws * c->h, m->sy + slope_prior * c->expected_slope + ws * y,
                               m->hy - ratio_prior * c->expected_ratio + wh * y};
}

/* Variance of what the conic leaves of the chord's own samples. */
static float left_over(const rlf_chord *c, const rlf_conic *f)
{
    const rlf_chord_moments *o = &c->own;
    float rest = c->yy - 2.0f * f->slope * o->sy + 2.0f * f->ratio * o->hy +
                 f->slope * f->slope * o->ss + f->ratio * f->ratio * o->hh -
                 2.0f * f->slope * f->ratio * o->sh;
    return rest > 0.0f ? rest / c->weight : 0.0f;
}

/* Solves the equations. */
static rlf_conic solve(const rlf_chord *c, const rlf_chord_moments *e)
{
    float det = e->ss * e->hh - e->sh * e->sh;
    rlf_conic f = {.slope = (e->sy * e->hh - e->hy * e->sh) / det,
                   .ratio = (e->sy * e->sh - e->hy * e->ss) / det};
    f.ratio = f.ratio > 0.0f ? f.ratio : 0.0f;
    f.variance = left_over(c, &f);
    f.middle = c->y - f.slope * c->s + f.ratio * c->h;
    return f;
}

rlf_conic rlf_chord_solve(const rlf_chord *c, const rlf_chord_moments *m)
{
    rlf_chord_moments e = equations(c, m);
    return solve(c, &e);
}

/* The conic of a chord with all that is known of it. The worse it fits, the more counts what bodies
 * are usually like. So it does where the front is flat, which says nothing about the back of what
 * is a part of a body: a bag, a stiff coat. */
static rlf_conic solve_body(const rlf_chord *c, const rlf_chord_moments *e)
{
    rlf_conic f = solve(c, e);
    float width = (c->end - c->begin) * c->metres, of_trunk = trunk_depth_m / width;
    bool is_broad = of_trunk < usual_ratio, is_flat = f.ratio <= flat_ratio;
    float usual = is_broad ? of_trunk : usual_ratio;
    bool is_conic = c->is_of_people && width > wide_m;
    if (is_conic && (f.ratio < usual || is_broad)) {
        float excess = f.variance > c->noise ? f.variance - c->noise : 0.0f;
        float share = is_flat ? 1.0f : excess / (excess + unlike_conic_m * unlike_conic_m);
        f.ratio += share * (usual - f.ratio);
        f.variance = is_flat ? f.variance : left_over(c, &f);
        f.middle = c->y - f.slope * c->s + f.ratio * c->h;
    }
    return f;
}

rlf_chord_middle rlf_chord_middle_seen(const rlf_chord *c)
{
    rlf_chord_moments e = equations(c, &c->pooled);
    rlf_conic f = solve_body(c, &e);
    float spread = (c->h * c->h * e.ss + c->s * c->s * e.hh) / (e.ss * e.hh - e.sh * e.sh);
    float variance = correlated_samples * (1.0f / c->weight + spread) +
                     middle_error_m * middle_error_m + f.variance;
    return (rlf_chord_middle){1.0f / c->inverse + f.middle, 1.0f / variance};
}

/* What is straight along the chord may be any depth (a cylinder cut lengthwise), and what is not a
 * conic has no back that we know. */
static float trust(const rlf_chord *c, const rlf_conic *f)
{
    float bent = f->ratio < 1.0f ? f->ratio : 1.0f;
    float excess = f->variance > c->noise ? f->variance - c->noise : 0.0f;
    float rest = 1.0f + excess / (trusted_rest_m * trusted_rest_m);
    return (bent * bent + straight_trust) / (rest * rest);
}

/* A chord whose solid is being painted. */
typedef struct painting {
    const rlf_chord_job *job;
    const rlf_line *line;
    rlf_kernel_chord chord;
    rlf_kernel_chord_solid solid;
} painting;

/* Adds to the knots among begin <= k < end; of what it hides, to those of the bodies. */
static void paint_run(const painting *p, const rlf_solid *to, bool is_hidden, int32_t begin,
                      int32_t end)
{
    const rlf_line *line = p->line;
    int32_t step = p->job->step, skipped = (begin - line->phase + step - 1) / step;
    ptrdiff_t i = line->knot + skipped * line->knot_stride;
    for (int32_t first = line->phase + skipped * step; first < end; first += RLF_CHORD_RUN * step) {
        float weight[RLF_CHORD_RUN], middle[RLF_CHORD_RUN], half[RLF_CHORD_RUN];
        int32_t count = (end - first + step - 1) / step;
        count = count < RLF_CHORD_RUN ? count : RLF_CHORD_RUN;
        rlf_kernel_chord_solid_run(&p->chord, &p->solid, first, step, count, weight, middle, half);
        for (int32_t k = 0; k < count; k++, i += line->knot_stride) {
            if (!is_hidden || p->job->knot[i] > 0.0f) {
                to->weight[i] += weight[k];
                to->middle[i] += middle[k];
                to->half[i] += half[k];
            }
        }
    }
}

/* Steps from an end of which something nearer has hidden a part, in which the body is taken to go
 * on: no more than are seen of it, and no more than an arm hides of the trunk beside it. */
static int32_t steps_behind(const rlf_chord *c, int32_t side)
{
    float steps = c->covered[side], seen = 0.0f;
    for (int32_t i = 0; i < c->part_count; i++) {
        seen += (float)(c->part[i].end - c->part[i].begin);
    }
    return steps < seen && steps * c->metres < covered_m ? (int32_t)steps : 0;
}

/* Short chords know best: weights are 1 / (l r). */
void rlf_chord_paint(const rlf_chord_job *job, const rlf_line *line, const rlf_chord *c)
{
    rlf_chord_moments e = equations(c, &c->pooled);
    rlf_conic f = solve_body(c, &e);
    float w2 = c->inverse * c->inverse;
    float slope = -w2 * f.slope * c->metres;
    const painting p = {
        .job = job,
        .line = line,
        .chord = {c->begin, c->end},
        .solid = {.share = trust(c, &f) / (c->metres * c->metres),
                  .middle = c->inverse - w2 * f.middle - slope * 0.5f * (c->begin + c->end),
                  .slope = slope,
                  .half = w2 * f.ratio * c->metres}};
    int32_t from = c->part[0].begin - steps_behind(c, 0);
    int32_t to = c->part[c->part_count - 1].end + steps_behind(c, 1);
    from = from > 0 ? from : 0;
    to = to < line->count ? to : line->count;
    for (int32_t i = 0; i < c->part_count; i++) {
        paint_run(&p, &job->hidden, true, from, c->part[i].begin);
        paint_run(&p, &job->own, false, c->part[i].begin, c->part[i].end);
        from = c->part[i].end;
    }
    paint_run(&p, &job->hidden, true, from, to);
}
