/* One surface against a clip's truth, by the measures that the peers' harness has. */
#include "bench/peers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REACH 3       /* pixels about an edge */
#define CREASE 0.9f   /* cosine between normals of one face */
#define FLYING_M 0.05 /* raw depth farther off has no truth */
#define JUMP_M 0.04f
#define WRONG_M 0.04
#define WRONG_DEG 30.0
#define BIG_SHARE 0.0005 /* of the pixels, and 4 at least */

static double percent(int64_t part, int64_t whole)
{
    return whole > 0 ? 100.0 * (double)part / (double)whole : NAN;
}

/* One frame's truth. */
typedef struct frame_truth {
    const uint16_t *depth;
    const float *z, *normal;
    const uint8_t *label;
    int32_t width, height;
} frame_truth;

static bool is_other_face(const frame_truth *t, int32_t i, int32_t k)
{
    const float *a = t->normal + 3 * (ptrdiff_t)i, *b = t->normal + 3 * (ptrdiff_t)k;
    return t->label[i] != t->label[k] || a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < CREASE;
}

static bool is_other_depth(const frame_truth *t, int32_t i, int32_t k)
{
    float step = t->z[k] - t->z[i];
    return step > JUMP_M || step < -JUMP_M;
}

typedef bool (*differs_fn)(const frame_truth *t, int32_t i, int32_t k);

/* Whether anything within REACH pixels differs; (x, y) is REACH away from the border at least. */
static bool is_edge(const frame_truth *t, int32_t x, int32_t y, differs_fn differs)
{
    for (int32_t dy = -REACH; dy <= REACH; dy++) {
        for (int32_t dx = -REACH; dx <= REACH; dx++) {
            if (differs(t, y * t->width + x, (y + dy) * t->width + x + dx)) {
                return true;
            }
        }
    }
    return false;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int64_t count)
{
    if (count == 0) {
        return NAN;
    }
    qsort(values, (size_t)count, sizeof(*values), compare_doubles);
    return values[count / 2];
}

static void measure_normals(const frame_truth *t, const rlf_surface *s, double *errors,
                            bench_quality *out)
{
    int64_t seen[2] = {0, 0}, found[2] = {0, 0}, wrong[2] = {0, 0}; /* interior, edge */
    for (int32_t y = REACH; y < t->height - REACH; y++) {
        for (int32_t x = REACH; x < t->width - REACH; x++) {
            int32_t i = y * t->width + x;
            double off = t->depth[i] * 1e-3 - (double)t->z[i];
            if (t->depth[i] == 0 || t->label[i] == CLIP_LABEL_NOTHING || off > FLYING_M ||
                off < -FLYING_M) {
                continue;
            }
            int edge = is_edge(t, x, y, is_other_face);
            rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
            seen[edge]++;
            if (!(rlf_length(n) > 0.5)) {
                continue;
            }
            const float *real = t->normal + 3 * (ptrdiff_t)i;
            double cosine = fabs(n.x * real[0] + n.y * real[1] + n.z * real[2]);
            double error = rlf_acos(rlf_min(cosine, 1.0)) * 180.0 / RLF_PI;
            wrong[edge] += error > WRONG_DEG;
            if (edge == 0) {
                errors[found[0]] = error;
            }
            found[edge]++;
        }
    }
    out->interior_normals = percent(found[0], seen[0]);
    out->interior_median_deg = median(errors, found[0]);
    out->interior_wrong = percent(wrong[0], found[0]);
    out->edge_normals = percent(found[1], seen[1]);
    out->edge_wrong = percent(wrong[1], found[1]);
}

static void measure_depth(const frame_truth *t, const rlf_surface *s, bench_quality *out)
{
    int64_t count = 0, edges = 0, wrong = 0, holes = 0, filled = 0;
    double square_sum = 0.0;
    for (int32_t y = REACH; y < t->height - REACH; y++) {
        for (int32_t x = REACH; x < t->width - REACH; x++) {
            int32_t i = y * t->width + x;
            bool is_there = s->depth[i] > 0.0f;
            if (t->label[i] == CLIP_LABEL_NOTHING) {
                continue;
            }
            if (t->depth[i] == 0) {
                holes++;
                filled += is_there;
                continue;
            }
            double error = (double)s->depth[i] - t->z[i];
            if (is_there && is_edge(t, x, y, is_other_depth)) {
                edges++;
                wrong += error > WRONG_M || error < -WRONG_M;
            } else if (is_there) {
                count++;
                square_sum += error * error;
            }
        }
    }
    out->interior_rmse_mm = count > 0 ? 1000.0 * sqrt(square_sum / (double)count) : NAN;
    out->edge_wrong_40_mm = percent(wrong, edges);
    out->holes_filled = percent(filled, holes);
}

static void measure_foreground(const frame_truth *t, const rlf_surface *s, bench_quality *out)
{
    int64_t hit = 0, invented = 0, missed = 0;
    for (int32_t i = 0; i < t->width * t->height; i++) {
        bool is_person = t->label[i] == CLIP_LABEL_PERSON;
        bool is_found = s->foreground[i] != 0;
        if (t->depth[i] > 0) {
            hit += is_found && is_person;
            invented += is_found && !is_person;
            missed += !is_found && is_person;
        }
    }
    out->recall = percent(hit, hit + missed);
    out->precision = percent(hit, hit + invented);
}

static void measure_regions(const frame_truth *t, const rlf_surface *s, bench_quality *out)
{
    int64_t big = 0, inside = 0, valid = 0, count = 0;
    int64_t least = (int64_t)(BIG_SHARE * t->width * t->height);
    for (int32_t r = 0; r < s->region_count; r++) {
        int64_t pixels = 0; /* of the label plane: the background's hidden ones do not count */
        for (int32_t i = 0; i < t->width * t->height; i++) {
            pixels += s->label[i] == s->regions[r].label;
        }
        count += pixels > 0;
        bool is_big = pixels >= least && pixels >= 4;
        big += is_big;
        inside += is_big ? pixels : 0;
    }
    for (int32_t i = 0; i < t->width * t->height; i++) {
        valid += s->depth[i] > 0.0f;
    }
    out->regions = (double)count;
    out->big_regions = (double)big;
    out->in_big_regions = percent(inside, valid);
}

void bench_quality_measure(const bench_clip *clip, int32_t frame, const rlf_surface *s,
                           bench_quality *out)
{
    size_t first = clip->pixels * (size_t)frame;
    frame_truth t = {clip->depth + first, clip->z + first,       clip->normal + 3 * first,
                     clip->label + first, clip->rig.depth.width, clip->rig.depth.height};
    double *errors = rlf_alloc_array(clip->pixels, sizeof(*errors));
    if (errors == NULL) {
        return;
    }
    measure_normals(&t, s, errors, out);
    measure_depth(&t, s, out);
    measure_foreground(&t, s, out);
    measure_regions(&t, s, out);
    rlf_free(errors);
}
