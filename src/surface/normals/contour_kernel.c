/* Sixteen pixels at depth contours at a time: where the contour is, what is known on the way in,
 * and what normal the surface has at the pixel.
 *
 * Where a smooth surface turns out of sight its normal is square to the ray and points across the
 * contour in the image (Koenderink 1984). On the way out the outward component of the normal of a
 * circle or ball grows linearly with the place in the image, up to 1 at the contour. */
#include "surface/normals/contour.h"

#include <math.h>

/* Share of a rounded surface's turn that must be seen: what stands mostly has faces, and a crease
 * beside a contour looks like a little of a turn. */
static const float least_turn_still = 0.5f, least_turn_moving = 0.04f;
/* RMS of the outward component about a steady turn: less is flat, more is a crease. */
static const float least_bend = 0.02f, most_bend = 0.125f;
static const float crease = 0.95f;     /* cosine between two faces */
static const float most_aside = 0.98f; /* sine of the steepest normal that is given */
/* Pixels that a plane's window looks farther in than its pixel lies: it may not reach across the
 * contour. */
static const float window_inside = 0.8f;
/* Tangent by which rounded things lean farther out than what is known of them. */
static const float lean = 0.45f;
static const float beside =
    2.0f; /* pixels from the contour: what turns no more than it does, leans */

/* ---- where the contour is ---- */

/* Offsets of what is behind each pixel and of what is not, summed. */
typedef struct sides {
    float far_x[RLF_BATCH], far_y[RLF_BATCH], far_n[RLF_BATCH];
    float near_x[RLF_BATCH], near_y[RLF_BATCH], near_n[RLF_BATCH];
    float nearest[RLF_BATCH]; /* squared distance of what is behind */
} sides;

/* What lies farther than `behind` is behind a pixel, what lies farther than `before` is not. */
typedef struct limits {
    float behind[RLF_BATCH], before[RLF_BATCH];
} limits;

/* A pixel's own surface is taken to go on as near as anything of it in the window. */
RLF_KERNEL_PART void find_limits(const depth_step *step, const contour_batch *restrict b,
                                 limits *restrict out)
{
    const float(*restrict at)[RLF_BATCH] = b->depth.at;
    const float *restrict own = at[RLF_WINDOW_SIZE / 2];
    float least[RLF_BATCH], nearest[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float pixels = RLF_WINDOW_ABOUT * b->spacing[i];
        least[i] = own[i] - depth_step_most(step, own[i], DEPTH_STEP_STEEPEST, pixels);
        nearest[i] = own[i];
    }
    for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float z = at[k][i] > least[i] ? at[k][i] : own[i];
            nearest[i] = z < nearest[i] ? z : nearest[i];
        }
    }
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float pixels = RLF_WINDOW_ABOUT * b->spacing[i];
        out->behind[i] = contour_behind(step, own[i], own[i] - nearest[i], pixels);
        out->before[i] = own[i] - depth_step_most(step, own[i], 0.0f, 0.0f);
    }
}

/* A row of the windows, dy pixels below the middle. */
RLF_KERNEL_PART void add_row(const float (*restrict row)[RLF_BATCH], float dy,
                             const limits *restrict limit, sides *restrict s)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float far_n = 0.0f, far_x = 0.0f, near_n = 0.0f, near_x = 0.0f, nearest = s->nearest[i];
        for (int32_t k = 0; k < RLF_WINDOW_SIDE; k++) {
            float z = row[k][i], dx = (float)(k - RLF_WINDOW_ABOUT), square = dx * dx + dy * dy;
            bool is_far = z > limit->behind[i], is_near = (z > limit->before[i]) & !is_far;
            float far = is_far ? 1.0f : 0.0f, near = is_near ? 1.0f : 0.0f;
            float to_far = is_far ? square : nearest;
            far_n += far;
            far_x += far * dx;
            near_n += near;
            near_x += near * dx;
            nearest = to_far < nearest ? to_far : nearest;
        }
        s->far_n[i] += far_n;
        s->far_x[i] += far_x;
        s->far_y[i] += far_n * dy;
        s->near_n[i] += near_n;
        s->near_x[i] += near_x;
        s->near_y[i] += near_n * dy;
        s->nearest[i] = nearest;
    }
}

RLF_KERNEL void contour_find(const depth_step *step, contour_batch *restrict b)
{
    limits limit;
    sides s;
    find_limits(step, b, &limit);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        s.far_x[i] = s.far_y[i] = s.far_n[i] = s.near_x[i] = s.near_y[i] = s.near_n[i] = 0.0f;
        s.nearest[i] = 99.0f;
    }
    for (int32_t k = 0; k < RLF_WINDOW_SIDE; k++) {
        add_row((const float(*)[RLF_BATCH]) & b->depth.at[k * RLF_WINDOW_SIDE],
                (float)(k - RLF_WINDOW_ABOUT), &limit, &s);
    }
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float far_n = s.far_n[i] > 1.0f ? s.far_n[i] : 1.0f;
        float near_n = s.near_n[i] > 1.0f ? s.near_n[i] : 1.0f;
        float x = s.far_x[i] / far_n - s.near_x[i] / near_n;
        float y = s.far_y[i] / far_n - s.near_y[i] / near_n;
        float length = sqrtf(x * x + y * y);
        bool is_sure = (s.far_n[i] > 1.5f) & (length >= 0.5f);
        float whole = is_sure ? length : 1.0f;
        b->out_x[i] = x / whole;
        b->out_y[i] = y / whole;
        b->distance[i] = is_sure ? b->spacing[i] * (sqrtf(s.nearest[i]) - 0.5f) : 0.0f;
    }
}

RLF_KERNEL void contour_mark_row(const float *depth, const uint8_t *front, const uint8_t *known,
                                 const depth_step *step, ptrdiff_t width, int32_t begin,
                                 int32_t end, uint8_t *restrict mark)
{
    enum { APART = CONTOUR_REACH };
    const float *restrict z = depth, *restrict up = z - APART * width;
    const float *restrict down = z + APART * width;
    const uint8_t *restrict above = front - APART * width, *restrict below = front + APART * width;
    for (int32_t i = begin; i < end; i++) {
        int32_t was = front[i] | front[i - APART] | front[i + APART] | above[i] | below[i];
        int32_t across = contour_is_behind(step, z[i], z[i - APART], z[i + APART], APART);
        int32_t along = contour_is_behind(step, z[i], up[i], down[i], APART);
        mark[i] = (uint8_t)(known[i] & (was != 0) & (z[i] > 0.0f) & (across | along));
    }
}

/* ---- the way in ---- */

RLF_KERNEL void contour_walk_in(const contour_planes *planes, const depth_step *step,
                                const contour_batch *restrict b, contour_way *restrict way)
{
    const float *depth = planes->depth;
    const uint8_t *known = planes->known;
    float z[RLF_BATCH], most[RLF_BATCH], goes_on[RLF_BATCH];
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        int32_t i = way->inner[k] = b->y[k] * planes->width + b->x[k];
        z[k] = depth[i];
        most[k] = depth_step_most(step, z[k], DEPTH_STEP_STEEPEST, (float)(CONTOUR_WAY / 2));
        way->ray_x[k] = planes->ray_x[i];
        way->ray_y[k] = planes->ray_y[i];
        goes_on[k] = 1.0f;
    }
    for (int32_t n = 0; n < CONTOUR_WAY; n++) {
        contour_normals *restrict normal = &way->normal[n];
        for (int32_t k = 0; k < RLF_BATCH; k++) {
            float x = (float)b->x[k], y = (float)b->y[k];
            int32_t sx = (int32_t)(x - (float)n * b->out_x[k] + 0.5f);
            int32_t sy = (int32_t)(y - (float)n * b->out_y[k] + 0.5f);
            int32_t i = sy * planes->width + sx;
            goes_on[k] *= rlf_kernel_abs(depth[i] - z[k]) <= most[k] ? 1.0f : 0.0f;
            way->inner[k] = goes_on[k] > 0.0f ? i : way->inner[k];
            way->s[n][k] =
                b->distance[k] + (x - (float)sx) * b->out_x[k] + (y - (float)sy) * b->out_y[k];
            float weight = known[i] != 0 ? goes_on[k] : 0.0f;
            normal->x[k] = weight * planes->normal[0][i];
            normal->y[k] = weight * planes->normal[1][i];
            normal->z[k] = weight * planes->normal[2][i];
        }
    }
}

/* ---- the normal ---- */

typedef struct vector {
    float x, y, z;
} vector;

RLF_KERNEL_PART float dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

RLF_KERNEL_PART vector add(vector a, vector b, float times)
{
    return (vector){a.x + times * b.x, a.y + times * b.y, a.z + times * b.z};
}

RLF_KERNEL_PART vector unit(vector a)
{
    float square = dot(a, a), scale = 1.0f / sqrtf(square > 0.0f ? square : 1.0f);
    return (vector){a.x * scale, a.y * scale, a.z * scale};
}

/* Axes at a pixel: along its ray, outwards across the contour, and along it. */
typedef struct axes {
    vector ray, out, along;
} axes;

RLF_KERNEL_PART axes make_axes(float ray_x, float ray_y, float x, float y)
{
    axes a;
    a.ray = unit((vector){ray_x, ray_y, 1.0f});
    vector out = {x, y, 0.0f};
    a.out = unit(add(out, a.ray, -dot(out, a.ray)));
    a.along = (vector){a.ray.y * a.out.z - a.ray.z * a.out.y, a.ray.z * a.out.x - a.ray.x * a.out.z,
                       a.ray.x * a.out.y - a.ray.y * a.out.x};
    return a;
}

/* What the samples of a way say. */
typedef struct way_fit {
    float n, s, out;          /* how many; means of the place and of the component outwards */
    float spread, turn, bend; /* of the places; outwards along it; mean square about a steady turn,
                                 times the spread */
    vector first, sum;        /* the outermost normal, and all of them */
    float first_s;
} way_fit;

RLF_KERNEL_PART way_fit fit_way(const contour_way *restrict way, int32_t i, const axes *restrict a)
{
    float n = 0.0f, s1 = 0.0f, ss = 0.0f, o1 = 0.0f, oo = 0.0f, so = 0.0f, first_s = 0.0f;
    vector first = {0.0f, 0.0f, 0.0f}, sum = first;
    for (int32_t k = 0; k < CONTOUR_WAY; k++) {
        vector normal = {way->normal[k].x[i], way->normal[k].y[i], way->normal[k].z[i]};
        float has = dot(normal, normal) > 0.0f ? 1.0f : 0.0f, s = way->s[k][i];
        float out = dot(normal, a->out), is_first = n > 0.0f ? 0.0f : has;
        first = add(first, normal, is_first);
        first_s += is_first * s;
        sum = add(sum, normal, 1.0f);
        n += has;
        s1 += has * s;
        ss += has * s * s;
        o1 += has * out;
        oo += has * out * out;
        so += has * s * out;
    }
    float count = n > 1.0f ? n : 1.0f, s = s1 / count, out = o1 / count;
    float spread = (ss - s1 * s) / count, turn = (s1 * out - so) / count;
    float bend = ((oo - o1 * out) / count) * spread - turn * turn;
    return (way_fit){n, s, out, spread, turn, bend, first, sum, first_s};
}

/* The samples turn steadily outwards. */
RLF_KERNEL_PART bool turns(const way_fit *restrict f, bool moves)
{
    float least = moves ? least_turn_moving : least_turn_still;
    bool is_steady = f->bend <= most_bend * most_bend * f->spread;
    return (f->n > 1.5f) & is_steady & (f->turn * f->s > least * f->spread * (1.0f - f->out));
}

/* The outward component goes on growing, from what the outermost window saw to 1 at the contour. */
RLF_KERNEL_PART vector turned(const way_fit *restrict f, float distance, const axes *restrict a)
{
    float t = distance / (f->first_s + window_inside); /* 0 at the contour, 1 where that looked */
    float out = 1.0f - t * (1.0f - dot(f->first, a->out)), along = dot(f->first, a->along);
    float aside = sqrtf(out * out + along * along);
    float scale = aside > most_aside ? most_aside / aside : 1.0f, sine = aside * scale;
    const vector zero = {0.0f, 0.0f, 0.0f};
    vector normal = add(add(zero, a->out, out * scale), a->along, along * scale);
    return add(normal, a->ray, -sqrtf(1.0f - sine * sine));
}

RLF_KERNEL void contour_lean_out(const contour_batch *restrict b, const contour_way *restrict way,
                                 contour_normals *restrict out)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        axes a = make_axes(way->ray_x[i], way->ray_y[i], b->out_x[i], b->out_y[i]);
        way_fit f = fit_way(way, i, &a);
        vector mean = unit(f.sum), round = turned(&f, b->distance[i], &a);
        vector leant = unit(add(f.first, a.out, lean));
        bool is_turned = turns(&f, way->moves[i] > 0.5f);
        bool is_face = (dot(f.first, mean) < crease) & (dot(f.first, a.out) > dot(mean, a.out));
        bool is_uneven = f.bend > least_bend * least_bend * f.spread;
        bool leans = (way->is_round[i] > 0.5f) & is_uneven & (b->distance[i] < beside);
        float x = is_face ? f.first.x : (leans ? leant.x : 0.0f);
        float y = is_face ? f.first.y : (leans ? leant.y : 0.0f);
        float z = is_face ? f.first.z : (leans ? leant.z : 0.0f);
        bool any = f.n > 0.5f;
        out->x[i] = any ? (is_turned ? round.x : x) : 0.0f;
        out->y[i] = any ? (is_turned ? round.y : y) : 0.0f;
        out->z[i] = any ? (is_turned ? round.z : z) : 0.0f;
    }
}
