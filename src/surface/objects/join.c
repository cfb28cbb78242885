/* Which neighbouring things are one: those that are parted along less than half of their border,
 * and a hollow one with what it is the inside of.
 *
 * Only what is hollow shows a surface whose normals converge: the inside of a cup, which a depth
 * step or a concave edge parts from its outside. */
#include "surface/objects/objects.h"

#include <math.h>
#include <string.h>

static const double LEAST_OPEN = 0.5;   /* of a border, where nothing parts two that are one */
static const double LEAST_SHARE = 0.25; /* of what is about a hollow thing, its outside's */
/* Convexity of an outside, and of an inside below 0: of one that was parted from its outside twice
 * as much. It is 0.6 of half a ball. */
static const double CURVED = 0.1;

/* The entry of things a < b; NULL = there is no room. Open addressing. */
static rlf_border *find_border(rlf_objects *o, int32_t a, int32_t b)
{
    uint32_t at = ((uint32_t)a * 2654435769u + (uint32_t)b * 2246822519u) >> 20;
    for (int32_t tries = 0; tries < 64; tries++, at++) {
        rlf_border *border = &o->border[at % RLF_BORDERS];
        if (border->a == 0) {
            border->a = a;
            border->b = b;
        }
        if (border->a == a && border->b == b) {
            return border;
        }
    }
    return NULL;
}

static void add_border(rlf_reconstruct *stage, const rlf_layer_in *in, int32_t i, int32_t j,
                       int32_t bit)
{
    rlf_objects *o = stage->objects;
    int32_t a = stage->work.component[i], b = stage->work.component[j];
    rlf_border *border = a > 0 && b > 0 ? find_border(o, a < b ? a : b, a < b ? b : a) : NULL;
    if (border != NULL) {
        bool is_cut = ((o->links[i] | o->links[j]) & RLF_OBJECT_CUT) != 0;
        border->pixels++;
        border->open += (o->links[i] & bit) != 0 && !is_cut ? 1 : 0;
        border->was_one +=
            in->previous_label != NULL && in->previous_label[i] == in->previous_label[j] ? 1 : 0;
    }
}

static void find_borders(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    const int32_t *number = stage->work.component;
    int32_t width = stage->grid.width;
    memset(stage->objects->border, 0, RLF_BORDERS * sizeof *stage->objects->border);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t i = y * width; i < (y + 1) * width; i++) {
            if (i > y * width && number[i] != number[i - 1]) {
                add_border(stage, in, i, i - 1, RLF_LINK_LEFT);
            }
            if (y > 0 && number[i] != number[i - width]) {
                add_border(stage, in, i, i - width, RLF_LINK_UP);
            }
        }
    }
}

/* Pixels take the numbers that theirs are mapped to. */
static void renumber(rlf_reconstruct *stage, int32_t components)
{
    int32_t *map = stage->work.map;
    for (int32_t c = 1; c <= components; c++) {
        map[c] = rlf_component_root(map, c);
    }
    for (int32_t i = 0; i < stage->grid.count; i++) {
        stage->work.component[i] = map[stage->work.component[i]];
    }
}

static void join_open(rlf_reconstruct *stage, int32_t components)
{
    const rlf_objects *o = stage->objects;
    int32_t *map = stage->work.map;
    for (int32_t c = 0; c <= components; c++) {
        map[c] = c;
    }
    for (int32_t k = 0; k < RLF_BORDERS; k++) {
        const rlf_border *border = &o->border[k];
        if (border->a > o->count && border->open > LEAST_OPEN * border->pixels) {
            int32_t a = rlf_component_root(map, border->a), b = rlf_component_root(map, border->b);
            map[a < b ? b : a] = a < b ? a : b;
        }
    }
    renumber(stage, components);
}

static void add_point(rlf_reconstruct *stage, const rlf_layer_in *in, int32_t i)
{
    int32_t c = stage->work.component[i];
    if (c <= stage->objects->count || c >= RLF_OBJECTS_SUMMED) {
        return;
    }
    rlf_object_sum *s = &stage->objects->sum[c];
    double z = in->depth[i];
    const double p[3] = {z * stage->grid.ray_x[i], z * stage->grid.ray_y[i], z};
    s->count += 1.0;
    for (int k = 0; k < 3; k++) {
        double n = in->normal[k][i];
        s->p[k] += p[k];
        s->n[k] += n;
        s->along += p[k] * n;
        s->square += p[k] * p[k];
    }
}

static void add_points(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    int32_t stride = stage->objects->stride;
    memset(stage->objects->sum, 0, RLF_OBJECTS_SUMMED * sizeof *stage->objects->sum);
    for (int32_t y = 0; y < stage->grid.height; y += stride) {
        for (int32_t x = 0; x < stage->grid.width; x += stride) {
            add_point(stage, in, y * stage->grid.width + x);
        }
    }
}

/* Covariance of points and normals, per spread of the points: > 0 of what is convex. */
static double convexity(const rlf_object_sum *s)
{
    double inv = s->count > 0.0 ? 1.0 / s->count : 0.0;
    double along = s->along * inv, spread = s->square * inv;
    for (int k = 0; k < 3; k++) {
        along -= s->p[k] * s->n[k] * inv * inv;
        spread -= s->p[k] * s->p[k] * inv * inv;
    }
    return spread > 0.0 ? along / sqrt(spread) : 0.0;
}

/* The border counts for its thing `own`. */
static void meet(rlf_objects *o, const rlf_border *border, int32_t own, int32_t other)
{
    if (own > o->count && own < RLF_OBJECTS_SUMMED) {
        rlf_object_sum *s = &o->sum[own];
        s->border += border->pixels;
        if (other > o->count && border->pixels + border->was_one > s->shared + s->was_one) {
            s->shared = border->pixels;
            s->was_one = border->was_one;
            s->neighbour = other;
        }
    }
}

static void join_hollow(rlf_reconstruct *stage, int32_t components)
{
    rlf_objects *o = stage->objects;
    for (int32_t k = 0; k < RLF_BORDERS; k++) {
        const rlf_border *border = &o->border[k];
        if (border->a > 0) {
            meet(o, border, border->a, border->b);
            meet(o, border, border->b, border->a);
        }
    }
    for (int32_t c = 0; c <= components; c++) {
        const rlf_object_sum *s = c < RLF_OBJECTS_SUMMED ? &o->sum[c] : &o->sum[0];
        bool has_outside = s->shared > 0 && s->neighbour < RLF_OBJECTS_SUMMED &&
                           s->shared >= LEAST_SHARE * s->border &&
                           convexity(&o->sum[s->neighbour]) > CURVED;
        bool was_one = 2 * s->was_one > s->shared;
        bool is_inside = has_outside && convexity(s) < (was_one ? -CURVED : -2.0 * CURVED);
        stage->work.map[c] = is_inside ? s->neighbour : c;
    }
    renumber(stage, components);
}

void rlf_objects_join(rlf_reconstruct *stage, const rlf_layer_in *in, int32_t components)
{
    find_borders(stage, in);
    join_open(stage, components);
    find_borders(stage, in);
    add_points(stage, in);
    join_hollow(stage, components);
}
