/* What a person's own body hides: the mirror image of what it shows. */
#include "pipeline/far_side.h"

#include "relief/base.h"

#include <string.h>

#define BINS 64
#define BIN_M 0.01
#define STRIDE 2           /* of the pixels that tell where the trunk is */
#define THICKEST 0.05      /* share of the pixels that are thicker than the trunk is taken to be */
#define RATHER_THICK 0.6   /* share of that thickness which no limb has */
#define TRUNK_M2 0.05      /* what is seen of a trunk at least */
#define TRUNK_HIGH_M 0.15  /* the same of each of its columns */
#define TRUNK_DEEP_M 0.1   /* RMS distance of the middles of one trunk from their plane */
#define BESIDE_M 0.05      /* an arm hangs no farther beside the trunk's outline */
#define HALF_BREADTH_M 0.3 /* people are some 0.55 m wide from elbow to elbow */
#define FACING 0.3 /* cosine between the ray and the trunk's plane: more is seen from above */

/* The trunk of one region. Its middles lie in the upright plane forward . p = offset. */
typedef struct trunk {
    const rlf_region *region;
    rlf_vec3 forward;
    double least_m; /* what is thinner is a limb */
    double offset;
} trunk;

rlf_result far_side_create(int32_t width, int32_t height, far_side *out)
{
    out->thickness = rlf_alloc_array((size_t)width * (size_t)height, sizeof(float));
    out->column = rlf_alloc_array((size_t)width, sizeof(int32_t));
    return out->thickness != NULL && out->column != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void far_side_destroy(far_side *far)
{
    rlf_free(far->thickness);
    rlf_free(far->column);
    *far = (far_side){NULL, NULL};
}

/* The way the camera looks, along the ground. False when it looks up or down. */
static bool find_forward(rlf_vec3 down, rlf_vec3 *out)
{
    const rlf_vec3 axis = {0, 0, 1}, level = {0, 1, 0};
    rlf_vec3 d = rlf_dot(down, down) > 0.0 ? rlf_normalize(down) : level;
    rlf_vec3 along = rlf_mad(axis, d, -d.z);
    *out = rlf_normalize(along);
    return rlf_length(along) > FACING;
}

static double toward(const trunk *t, const rlf_surface *s, ptrdiff_t i)
{
    return t->forward.x * (double)s->ray_x[i] + t->forward.y * (double)s->ray_y[i] + t->forward.z;
}

/* How thick its pixels are that are not limbs. */
static void measure(const rlf_surface *s, trunk *t)
{
    int32_t bins[BINS] = {0}, count = 0, bin = BINS - 1;
    const rlf_region *r = t->region;
    for (int32_t y = r->y0; y < r->y1; y += STRIDE) {
        for (int32_t x = r->x0; x < r->x1; x += STRIDE) {
            ptrdiff_t i = (ptrdiff_t)y * s->width + x;
            if (s->label[i] == r->label) {
                bins[(int32_t)rlf_clamp(s->thickness[i] / BIN_M, 0.0, BINS - 1.0)]++;
                count++;
            }
        }
    }
    for (double thicker = bins[bin]; bin > 0 && thicker <= THICKEST * count; bin--) {
        thicker += bins[bin - 1];
    }
    t->least_m = RATHER_THICK * bin * BIN_M;
}

/* False when the region shows no trunk, or more than one. Counts the trunk's pixels by columns. */
static bool find_trunk(far_side *far, const rlf_surface *s, trunk *t)
{
    const rlf_region *r = t->region;
    double sum = 0.0, square = 0.0, area = 0.0;
    int64_t count = 0;
    memset(far->column, 0, (size_t)s->width * sizeof(*far->column));
    measure(s, t);
    for (int32_t y = r->y0; y < r->y1; y += STRIDE) {
        for (int32_t x = r->x0; x < r->x1; x += STRIDE) {
            ptrdiff_t i = (ptrdiff_t)y * s->width + x;
            if (s->label[i] != r->label || (double)s->thickness[i] < t->least_m) {
                continue;
            }
            double z = s->depth[i], middle = (z + 0.5 * (double)s->thickness[i]) * toward(t, s, i);
            double side = STRIDE * z / s->camera.fx;
            sum += middle;
            square += middle * middle;
            area += side * side;
            far->column[x]++;
            count++;
        }
    }
    t->offset = sum / rlf_max(1.0, (double)count);
    double variance = square / rlf_max(1.0, (double)count) - t->offset * t->offset;
    return area > TRUNK_M2 && variance < TRUNK_DEEP_M * TRUNK_DEEP_M;
}

/* Leaves in `column` whether the trunk is in a column or close beside it. */
static void widen(far_side *far, const rlf_surface *s, const trunk *t)
{
    const rlf_region *r = t->region;
    double pixel = t->offset / s->camera.fx;
    int32_t high = (int32_t)(TRUNK_HIGH_M / (STRIDE * pixel)), last = -s->width;
    int32_t beside = (int32_t)(BESIDE_M / pixel) + STRIDE - 1;
    for (int32_t x = r->x0; x < r->x1; x++) {
        last = far->column[x] > high ? x : last;
        far->column[x] = far->column[x] > high ? 1 : x - last <= beside ? 2 : 0;
    }
    for (int32_t x = r->x1 - 1, next = 2 * s->width; x >= r->x0; x--) {
        next = far->column[x] == 1 ? x : next;
        far->column[x] = far->column[x] != 0 || next - x <= beside;
    }
}

static void mirror(far_side *far, const rlf_surface *s, const trunk *t)
{
    const rlf_region *r = t->region;
    for (int32_t y = r->y0; y < r->y1; y++) {
        for (int32_t x = r->x0; x < r->x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * s->width + x;
            double z = s->depth[i], way = toward(t, s, i);
            if (far->column[x] == 0 || s->label[i] != r->label || way < FACING) {
                continue;
            }
            double half = t->offset - z * way, room = (double)s->background_depth[i] - z;
            double full = rlf_min(2.0 * half / way, room > 0.0 ? room : 2.0 * half / way);
            if (half < HALF_BREADTH_M && full > (double)s->thickness[i]) {
                far->thickness[i] = (float)full;
            }
        }
    }
}

const float *far_side_thicken(far_side *far, const rlf_surface *s, rlf_vec3 down)
{
    trunk t;
    bool is_own = false;
    if (s->thickness == NULL || s->label == NULL || s->background_depth == NULL ||
        !find_forward(down, &t.forward)) {
        return s->thickness;
    }
    for (int32_t k = 0; k < s->region_count; k++) {
        t.region = &s->regions[k];
        if (t.region->layer != RLF_LAYER_FOREGROUND || !find_trunk(far, s, &t)) {
            continue;
        }
        if (!is_own) {
            memcpy(far->thickness, s->thickness,
                   (size_t)s->width * (size_t)s->height * sizeof(float));
            is_own = true;
        }
        widen(far, s, &t);
        mirror(far, s, &t);
    }
    return is_own ? far->thickness : s->thickness;
}
