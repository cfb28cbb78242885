/* Direction of the light from shading.
 *
 * Under any distant light a matt surface is, to first order of spherical harmonics, as bright as
 * albedo (1 + bend . n), bend pointing to the light (Ramamoorthi and Hanrahan 2001). Of two
 * neighbours of the same chromaticity the albedo is mostly the same, and then the contrast of their
 * brightness, (I1 - I2) / (I1 + I2), is that of 1 + bend . n. Gauss and Newton's least squares find
 * bend. Shadows, and neighbours that are alike by chance, are outliers: weights fall with the
 * residual (Cauchy). A light's direction is known only when the pairs tell something about every
 * axis; what was given counts as a few of them. */
#include "environment/light.h"
#include "environment/depth_edge.h"

#define STEP 4            /* pixels between points, both ways */
#define SPANS 3           /* pairs are so many times STEP 1, 2, 4, .. apart */
#define EVERY 4           /* frames between those that are taken in */
#define FIRST_PASSES 6    /* of the first frame */
#define FORGET 0.9        /* of the sums, per frame taken in */
#define NEWEST 0.2        /* share of the newest direction in what is shown */
#define DARKEST 6         /* channels below are noise, */
#define BRIGHTEST 250     /* and above clipped */
#define CHROMA 0.02f      /* two chromaticities that are the same */
#define NEIGHBOUR_M 0.3   /* in depth */
#define TURN_COSINE 0.94f /* normals that differ by less tell nothing */
#define RESIDUAL 0.06     /* of the contrast: half the weight */
#define LEAST_LIGHT 0.15
#define BEND_MAX 0.85     /* light from one point alone would be 2 / 3 */
#define GIVEN_PAIRS 5.0   /* weight of what was given */
#define GIVEN_SHARE 0.005 /* the same, of all pairs */
#define GIVEN_BEND 0.5    /* length of the given bend */
#define LEAST_PAIRS 150.0 /* weight of all pairs below which nothing is known */
#define LEAST_SPREAD 0.02 /* of the pairs over the axes: 4 / 27 is even, 0 leaves one open */
#define LEAST_BEND 0.08   /* light that comes from everywhere has no direction */

typedef light_point point;

typedef struct picture {
    const rlf_frame *frame;
    const rlf_surface *surface;
    rlf_camera camera; /* of the colour image */
    rlf_pose T_color_depth;
} picture;

/* Sets light to 0 where there is no normal or no colour to trust. */
static void read_point(const picture *p, int32_t x, int32_t y, point *out)
{
    const rlf_surface *s = p->surface;
    int32_t i = y * s->width + x;
    *out = (point){.n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]}, .z = s->depth[i]};
    if (!(out->z > 0.0f) || (out->n[0] == 0.0f && out->n[1] == 0.0f && out->n[2] == 0.0f)) {
        return;
    }
    double u, v;
    rlf_vec3 at = rlf_transform(&p->T_color_depth, rlf_surface_point(s, i));
    if (!rlf_camera_project(&p->camera, at, &u, &v) || !(u > -0.5) || !(v > -0.5) ||
        !(u < p->camera.width - 0.5) || !(v < p->camera.height - 0.5)) {
        return;
    }
    const uint8_t *color =
        rlf_rgba8_row(&p->frame->color, (int32_t)(v + 0.5)) + 4 * (ptrdiff_t)(int32_t)(u + 0.5);
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) {
        if (color[k] < DARKEST || color[k] > BRIGHTEST) {
            return;
        }
        sum += srgb_to_linear(color[k]);
    }
    out->light = sum * (1.0f / 3.0f);
    out->red = srgb_to_linear(color[0]) / sum;
    out->green = srgb_to_linear(color[1]) / sum;
}

static float magnitude(float x)
{
    return x < 0.0f ? -x : x;
}

static bool is_pair(const point *a, const point *b)
{
    float cosine = a->n[0] * b->n[0] + a->n[1] * b->n[1] + a->n[2] * b->n[2];
    return cosine < TURN_COSINE && magnitude(a->red - b->red) < CHROMA &&
           magnitude(a->green - b->green) < CHROMA && magnitude(a->z - b->z) < (float)NEIGHBOUR_M;
}

static double light_on(const light_direction *l, const point *p)
{
    double light = 1.0 + l->bend.x * (double)p->n[0] + l->bend.y * (double)p->n[1] +
                   l->bend.z * (double)p->n[2];
    return rlf_max(light, LEAST_LIGHT);
}

/* Adds what a pair says: c . bend = d about the last estimate. */
static void add_pair(light_direction *l, const point *p, const point *q, bool is_weighted)
{
    const double e = light_on(l, p);
    const double f = light_on(l, q);
    const double per_sum = 1.0 / (e + f);
    const double seen = (double)(p->light - q->light) / (double)(p->light + q->light);
    const double off = seen - (e - f) * per_sum;
    double c[3];
    for (int i = 0; i < 3; i++) {
        c[i] = 2.0 * (f * (double)p->n[i] - e * (double)q->n[i]) * per_sum * per_sum;
    }
    double d = off + c[0] * l->bend.x + c[1] * l->bend.y + c[2] * l->bend.z;
    double relative = off * (1.0 / RESIDUAL);
    double w = is_weighted ? 1.0 / (1.0 + relative * relative) : 1.0;
    int at = 0;
    for (int i = 0; i < 3; i++) {
        for (int k = i; k < 3; k++) {
            l->a[at++] += w * c[i] * c[k];
        }
        l->b[i] += w * c[i] * d;
    }
}

static void read_points(light_direction *l, const picture *p)
{
    for (int32_t i = 0; i < l->columns * l->rows; i++) {
        read_point(p, i % l->columns * STEP, i / l->columns * STEP, &l->points[i]);
    }
}

static void add_pairs(light_direction *l, bool is_weighted)
{
    for (int32_t i = 0; i < l->columns * l->rows; i++) {
        const point *here = &l->points[i];
        for (int k = 0; here->light > 0.0f && k < 2 * SPANS; k++) {
            int32_t x = i % l->columns + (k % 2 == 0 ? 1 << k / 2 : 0);
            int32_t y = i / l->columns + (k % 2 == 0 ? 0 : 1 << k / 2);
            const point *other = &l->points[y * l->columns + x];
            if (x < l->columns && y < l->rows && other->light > 0.0f && is_pair(here, other)) {
                add_pair(l, here, other, is_weighted);
            }
        }
    }
}

/* bend from the sums and what was given, by Cramer's rule. */
static void solve(light_direction *l)
{
    const double *a = l->a;
    double trace = a[0] + a[3] + a[5];
    double volume = a[0] * (a[3] * a[5] - a[4] * a[4]) - a[1] * (a[1] * a[5] - a[4] * a[2]) +
                    a[2] * (a[1] * a[4] - a[3] * a[2]);
    double given = GIVEN_PAIRS + GIVEN_SHARE * trace;
    rlf_vec3 b = rlf_mad(rlf_vec3_make(l->b[0], l->b[1], l->b[2]), l->given, -given * GIVEN_BEND);
    rlf_vec3 c0 = {a[0] + given, a[1], a[2]};
    rlf_vec3 c1 = {a[1], a[3] + given, a[4]};
    rlf_vec3 c2 = {a[2], a[4], a[5] + given};
    double whole = rlf_dot(c0, rlf_cross(c1, c2));
    l->bend = rlf_scale(rlf_vec3_make(rlf_dot(b, rlf_cross(c1, c2)), rlf_dot(c0, rlf_cross(b, c2)),
                                      rlf_dot(c0, rlf_cross(c1, b))),
                        1.0 / whole);
    double length = rlf_length(l->bend);
    if (length > BEND_MAX) {
        l->bend = rlf_scale(l->bend, BEND_MAX / length);
        length = BEND_MAX;
    }
    l->is_known = trace > LEAST_PAIRS && length > LEAST_BEND &&
                  4.0 * volume > LEAST_SPREAD * trace * trace * trace;
    /* No jump when it becomes known, or is lost. */
    rlf_vec3 target = l->is_known ? rlf_scale(l->bend, -1.0 / length) : l->given;
    rlf_vec3 mixed = rlf_mad(rlf_scale(l->now, 1.0 - NEWEST), target, NEWEST);
    l->now = l->has_sums && rlf_length(mixed) > 0.1 ? rlf_normalize(mixed) : target;
}

static void clear_sums(light_direction *l, double keep)
{
    for (int i = 0; i < 6; i++) {
        l->a[i] *= keep;
    }
    for (int i = 0; i < 3; i++) {
        l->b[i] *= keep;
    }
}

rlf_result light_direction_create(rlf_vec3 given, bool is_estimated, const rlf_camera *grid,
                                  light_direction *out)
{
    *out = (light_direction){.given = rlf_normalize(given)};
    out->now = out->given;
    out->columns = (grid->width + STEP - 1) / STEP;
    out->rows = (grid->height + STEP - 1) / STEP;
    if (!is_estimated) {
        return RLF_OK;
    }
    out->points = rlf_alloc_array((size_t)out->columns * (size_t)out->rows, sizeof(point));
    return out->points != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void light_direction_destroy(light_direction *l)
{
    rlf_free(l->points);
    l->points = NULL;
}

void light_direction_update(light_direction *l, const rlf_rig *rig, const rlf_frame *frame,
                            const rlf_surface *surface)
{
    if (l->points == NULL || frame->color.data == NULL || surface->normal_x == NULL ||
        (l->has_sums && frame->sequence - l->sequence < EVERY)) {
        return;
    }
    const rlf_camera *camera = rig->has_color ? &rig->color : &rig->depth;
    const picture p = {frame, surface,
                       rlf_camera_resize(camera, frame->color.width, frame->color.height),
                       rig->has_color ? rig->T_color_depth : rlf_pose_identity()};
    read_points(l, &p);
    const int passes = l->has_sums ? 1 : FIRST_PASSES;
    for (int i = 0; i < passes; i++) {
        clear_sums(l, l->has_sums ? FORGET : 0.0);
        add_pairs(l, l->has_sums || i > 0);
        solve(l);
    }
    l->sequence = frame->sequence;
    l->has_sums = true;
}
