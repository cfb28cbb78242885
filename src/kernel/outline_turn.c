/* Normals at outlines: of what is rounded, and of what has faces. */
#include "kernel/outline.h"

#include <math.h>

/* Share of a rounded surface's turn that must be seen, and RMS of the samples about a steady turn
 * (a crease bends): people and what else moves are rounded, what stands in a room mostly has faces,
 * and a crease beside an outline looks like a little of a turn. What moves may be so thin that most
 * of the samples are beyond its middle, where it turns to the other side. */
static const float least_turn_still = 0.5f, least_turn_moving = 0.04f;
static const float most_bend_still = 0.1f, most_bend_moving = 0.15f;
static const float least_out_still = 0.0f, least_out_moving = -1.0f;
static const float most_aside = 0.98f; /* sine of the steepest normal that is given */
/* Pixels: the middle of what a plane window sees lies so much farther in than a pixel near an
 * outline. Windows are ten pixels wide or six, and the sensor drops the outermost two. */
static const float window_inside = 1.2f;
static const float crease = 0.95f; /* cosine between two faces */
/* Tangent, at most: what is known lies one or two pixels farther in than what was filled, on limbs
 * of some eight pixels in radius. */
static const float lean_out = 0.5f;
/* The same of what was seen within so many pixels of an outline that it does not steadily turn to.
 * The planes of a flat thing are a tenth of a degree to one off: what is uneven by more (a sine,
 * RMS about a steady turn) is not flat. */
static const float lean_seen = 0.4f, most_beside = 2.0f, least_uneven = 0.02f;

typedef struct vector {
    float x, y, z;
} vector;

RLF_KERNEL_PART float dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

RLF_KERNEL_PART vector scaled(vector a, float s)
{
    return (vector){a.x * s, a.y * s, a.z * s};
}

RLF_KERNEL_PART vector add(vector a, vector b)
{
    return (vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

RLF_KERNEL_PART vector unit(vector a)
{
    return scaled(a, 1.0f / sqrtf(dot(a, a)));
}

RLF_KERNEL_PART vector get(const rlf_normals *restrict n, int32_t i)
{
    return (vector){n->x[i], n->y[i], n->z[i]};
}

RLF_KERNEL_PART void set(rlf_normals *restrict n, int32_t i, vector v)
{
    n->x[i] = v.x;
    n->y[i] = v.y;
    n->z[i] = v.z;
}

/* ---- rounded ---- */

/* Axes at a pixel: along its ray, outwards across the outline, and along it. */
typedef struct axes {
    vector ray, out, along;
} axes;

RLF_KERNEL_PART axes make_axes(float ray_x, float ray_y, float x, float y)
{
    axes a;
    a.ray = unit((vector){ray_x, ray_y, 1.0f});
    vector out = {x, y, 0.0f};
    a.out = unit(add(out, scaled(a.ray, -dot(out, a.ray))));
    a.along = (vector){a.ray.y * a.out.z - a.ray.z * a.out.y, a.ray.z * a.out.x - a.ray.x * a.out.z,
                       a.ray.x * a.out.y - a.ray.y * a.out.x};
    return a;
}

/* Sums over the samples on the way in; s = pixels from the outline, out = outward component. */
typedef struct way_sum {
    float n, s, ss, out, oo, s_out, along;
} way_sum;

RLF_KERNEL_PART way_sum sum_way(const rlf_way_in *restrict in, int32_t i, const axes *restrict a)
{
    way_sum sum = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    for (int32_t k = 0; k < RLF_OUTLINE_STEPS; k++) {
        vector n = get(&in->normal[k], i);
        float has = dot(n, n) > 0.0f ? 1.0f : 0.0f, s = in->s[k][i], out = dot(n, a->out);
        sum.n += has;
        sum.s += has * s;
        sum.ss += has * s * s;
        sum.out += has * out;
        sum.oo += has * out * out;
        sum.s_out += has * s * out;
        sum.along += has * dot(n, a->along);
    }
    return sum;
}

/* Of the samples of a way: spread of their places, turn outwards along it, and how they bend about
 * a steady turn, as its mean square times count and spread. */
typedef struct way_fit {
    float spread, turn, bend;
} way_fit;

RLF_KERNEL_PART way_fit fit_way(const way_sum *restrict in, float n)
{
    float s = in->s / n, out = in->out / n;
    float spread = in->ss - in->s * s, turn = in->out * s - in->s_out;
    return (way_fit){spread, turn, (in->oo - in->out * out) * spread - turn * turn};
}

/* 1 when the samples turn steadily outwards, else 0. */
RLF_KERNEL_PART float is_rounded(const way_sum *restrict in, const way_fit *restrict fit, float n,
                                 float distance, bool moves)
{
    float least_turn = moves ? least_turn_moving : least_turn_still;
    float most_bend = moves ? most_bend_moving : most_bend_still;
    float least_out = moves ? least_out_moving : least_out_still;
    float s = in->s / n, out = in->out / n;
    float steady = fit->bend <= n * most_bend * most_bend * fit->spread ? 1.0f : 0.0f;
    float turns = fit->turn * s > least_turn * fit->spread * (1.0f - out) ? steady : 0.0f;
    float inwards = s > distance ? turns : 0.0f;
    float outwards = out >= least_out ? inwards : 0.0f;
    return in->n < 1.5f ? 0.0f : outwards;
}

/* The normal with these components outwards and along the outline. */
RLF_KERNEL_PART vector turned_normal(float out, float along, const axes *restrict a)
{
    float aside = sqrtf(out * out + along * along);
    float scale = aside > most_aside ? most_aside / aside : 1.0f;
    aside *= scale;
    vector normal = add(scaled(a->out, out * scale), scaled(a->along, along * scale));
    return add(normal, scaled(a->ray, -sqrtf(1.0f - aside * aside)));
}

RLF_KERNEL_PART vector rounded_normal(const way_sum *restrict in, float n, float distance,
                                      const axes *restrict a)
{
    float t = distance * n / in->s; /* 0 at the outline, 1 at the samples' mean */
    return turned_normal(1.0f - t * (1.0f - in->out / n), t * in->along / n, a);
}

RLF_KERNEL void rlf_kernel_outline_round(const rlf_outlines *restrict at,
                                         const rlf_way_in *restrict in, rlf_normals *restrict out,
                                         rlf_normals *restrict aside)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        axes a = make_axes(in->ray_x[i], in->ray_y[i], at->x[i], at->y[i]);
        way_sum sum = sum_way(in, i, &a);
        float count = sum.n > 1.0f ? sum.n : 1.0f, distance = at->distance[i];
        way_fit fit = fit_way(&sum, count);
        bool rounded = is_rounded(&sum, &fit, count, distance, in->moves[i] > 0.5f) > 0.0f;
        vector n = rounded_normal(&sum, count, distance, &a);
        vector result = {rounded ? n.x : 0.0f, rounded ? n.y : 0.0f, rounded ? n.z : 0.0f};
        set(out, i, result);
        set(aside, i, a.out);
    }
}

/* ---- seen near the outline ---- */

/* 1 right beside the outline of what is not flat, else 0. */
RLF_KERNEL_PART float is_uneven_beside(const way_fit *restrict fit, float n, float distance)
{
    float uneven = fit->bend > n * least_uneven * least_uneven * fit->spread ? 1.0f : 0.0f;
    return distance < most_beside ? uneven : 0.0f;
}

RLF_KERNEL void rlf_kernel_outline_near(const rlf_outlines *restrict at,
                                        const rlf_way_in *restrict in, rlf_normals *restrict out)
{
    float found[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        axes a = make_axes(in->ray_x[i], in->ray_y[i], at->x[i], at->y[i]);
        way_sum sum = sum_way(in, i, &a);
        float count = sum.n > 1.0f ? sum.n : 1.0f, distance = at->distance[i];
        way_fit fit = fit_way(&sum, count);
        bool turns = is_rounded(&sum, &fit, count, distance, in->moves[i] > 0.5f) > 0.0f;
        float leans = is_uneven_beside(&fit, count, distance);
        found[i] = sum.n > 2.5f ? (turns ? 1.0f : leans) : 0.0f;
        vector own = get(&in->normal[0], i);
        float share = distance / (distance + window_inside); /* of the way from outline to window */
        vector turned =
            turned_normal(1.0f - share * (1.0f - dot(own, a.out)), dot(own, a.along), &a);
        vector leant = unit(add(own, scaled(a.out, lean_seen)));
        set(out, i,
            (vector){turns ? turned.x : leant.x, turns ? turned.y : leant.y,
                     turns ? turned.z : leant.z});
    }
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        vector n = get(out, i);
        bool is_kept = found[i] > 0.0f;
        set(out, i, (vector){is_kept ? n.x : 0.0f, is_kept ? n.y : 0.0f, is_kept ? n.z : 0.0f});
    }
}

/* ---- faces ---- */

/* Of the normals so far: their mean, weighted by nearness, and the outermost. */
typedef struct face_sum {
    rlf_normals mean, last;
    float best[RLF_BATCH];
} face_sum;

RLF_KERNEL_PART void offer(const rlf_outlines *restrict at, const rlf_normals *restrict normal,
                           float dx, float dy, face_sum *restrict sum)
{
    float square = dx * dx + dy * dy, weight = square > 0.0f ? 1.0f / square : 0.0f;
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        vector n = get(normal, i), mean = get(&sum->mean, i), last = get(&sum->last, i);
        float out = at->x[i] * dx + at->y[i] * dy;
        float along = rlf_kernel_abs(at->x[i] * dy - at->y[i] * dx);
        float place = dot(n, n) > 0.0f ? out - 0.2f * along : -1e9f, best = sum->best[i];
        bool better = place > best;
        set(&sum->mean, i, add(mean, scaled(n, weight)));
        sum->last.x[i] = better ? n.x : last.x;
        sum->last.y[i] = better ? n.y : last.y;
        sum->last.z[i] = better ? n.z : last.z;
        sum->best[i] = better ? place : best;
    }
}

RLF_KERNEL void rlf_kernel_outline_face(const rlf_outlines *restrict at,
                                        const rlf_normals *restrict aside,
                                        const rlf_normals *restrict window,
                                        const float *restrict rounded, rlf_normals *restrict out)
{
    face_sum sum;
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        set(&sum.mean, i, (vector){0.0f, 0.0f, 0.0f});
        set(&sum.last, i, (vector){0.0f, 0.0f, 0.0f});
        sum.best[i] = -1e9f;
    }
    for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
        offer(at, &window[k], (float)(k % RLF_WINDOW_SIDE - RLF_WINDOW_ABOUT),
              (float)(k / RLF_WINDOW_SIDE - RLF_WINDOW_ABOUT), &sum);
    }
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        vector mean = get(&sum.mean, i), last = get(&sum.last, i), outwards = get(aside, i);
        float length = sqrtf(dot(mean, mean));
        float creased = dot(last, mean) < crease * length ? 1.0f : 0.0f;
        bool turned = dot(last, outwards) * length > dot(mean, outwards);
        float taken = turned ? creased : 0.0f;
        float seen = length > 0.0f ? 1.0f : 0.0f, leans = (1.0f - taken) * seen * rounded[i];
        vector lean =
            unit(add(scaled(mean, seen / (length + 1.0f - seen)), scaled(outwards, lean_out)));
        set(out, i, add(scaled(last, taken), scaled(lean, leans)));
    }
}
