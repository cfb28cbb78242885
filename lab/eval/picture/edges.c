/* Errors of a matte against the truth: where its edges are, and what it shows and hides. */
#include "eval/picture/edges.h"

#include "eval/picture/truth.h"
#include "relief/synthetic.h"

#include <math.h>

#define REACH 16 /* pixels: edges farther apart count as this */
#define ORDER_M 0.05f
#define SILHOUETTE_M 0.03f /* nearer than this the body touches what hides it */

/* Where alpha crosses 1/2 between a pixel and its right (axis 0) or lower (axis 1) neighbour:
 * false when it does not. */
static bool crossing(const picture_truth *t, const float *alpha, int32_t i, int32_t axis,
                     double out[2])
{
    int32_t width = t->camera.width;
    int32_t x = i % width;
    int32_t y = i / width;
    if (axis == 0 ? x + 1 >= width : y + 1 >= t->camera.height) {
        return false;
    }
    int32_t j = axis == 0 ? i + 1 : i + width;
    if (t->alpha[i] < 0.0f || t->alpha[j] < 0.0f || (alpha[i] < 0.5f) == (alpha[j] < 0.5f)) {
        return false;
    }
    double at = (alpha[i] - 0.5) / ((double)alpha[i] - alpha[j]);
    out[0] = x + (axis == 0 ? at : 0.0);
    out[1] = y + (axis == 1 ? at : 0.0);
    return true;
}

/* What hides the body beside a crossing of the truth; 0 where body and thing touch. */
static int32_t occluder(const picture_truth *t, int32_t i, int32_t axis)
{
    int32_t j = axis == 0 ? i + 1 : i + t->camera.width;
    bool is_clear = (t->gap[i] > SILHOUETTE_M || t->gap[i] < -SILHOUETTE_M) &&
                    (t->gap[j] > SILHOUETTE_M || t->gap[j] < -SILHOUETTE_M);
    return is_clear ? (t->gap[i] > 0.0f ? t->label[i] : t->label[j]) : 0;
}

/* Distance from p to the nearest crossing of alpha; out_label is the truth's occluder there. */
static double nearest(const picture_truth *t, const float *alpha, const double p[2],
                      int32_t *out_label)
{
    int32_t cx = (int32_t)(p[0] + 0.5);
    int32_t cy = (int32_t)(p[1] + 0.5);
    double best = REACH;
    *out_label = 0;
    for (int32_t ring = 0; ring <= REACH && ring - 1.5 < best; ring++) {
        for (int32_t dy = -ring; dy <= ring; dy++) {
            bool is_side = dy == -ring || dy == ring;
            for (int32_t dx = -ring; dx <= ring; dx += is_side || ring == 0 ? 1 : 2 * ring) {
                int32_t x = cx + dx;
                int32_t y = cy + dy;
                if (x < 0 || y < 0 || x >= t->camera.width || y >= t->camera.height) {
                    continue;
                }
                int32_t i = y * t->camera.width + x;
                double q[2];
                for (int32_t axis = 0; axis < 2; axis++) {
                    if (crossing(t, alpha, i, axis, q)) {
                        double step[2] = {q[0] - p[0], q[1] - p[1]};
                        double distance = sqrt(step[0] * step[0] + step[1] * step[1]);
                        if (distance < best) {
                            best = distance;
                            *out_label = occluder(t, i, axis);
                        }
                    }
                }
            }
        }
    }
    return best;
}

static void add_distance(picture_errors *e, double distance, int32_t label)
{
    picture_distances *d = label == RLF_SYNTHETIC_LABEL_PERSON ? &e->person : &e->things;
    int32_t bin = (int32_t)(distance * PICTURE_BINS / REACH);
    d->bins[bin < PICTURE_BINS ? bin : PICTURE_BINS - 1]++;
    d->count++;
    d->sum += distance;
}

/* Both ways: a matte must not miss edges, nor have edges of its own. An edge that has no partner
 * is charged to what hides the body there. */
static void add_edges(picture_errors *e, const picture_truth *t, const float *alpha)
{
    for (int32_t k = 0; k < t->count; k++) {
        int32_t i = t->pixels[k];
        double p[2];
        for (int32_t axis = 0; axis < 2; axis++) {
            int32_t unused;
            int32_t label;
            if (!t->inner[i]) {
                continue;
            }
            if (crossing(t, t->alpha, i, axis, p)) {
                label = occluder(t, i, axis);
                double distance = nearest(t, alpha, p, &unused);
                if (label != 0) {
                    add_distance(e, distance, label);
                }
            }
            if (crossing(t, alpha, i, axis, p)) {
                double distance = nearest(t, t->alpha, p, &label);
                bool is_clear = t->gap[i] > SILHOUETTE_M || t->gap[i] < -SILHOUETTE_M;
                label = distance < REACH ? label : (is_clear ? t->label[i] : 0);
                if (label != 0) {
                    add_distance(e, distance, label);
                }
            }
        }
    }
}

void picture_errors_add(picture_errors *e, const picture_truth *t, const float *alpha,
                        const float *before)
{
    for (int32_t k = 0; k < t->count; k++) {
        int32_t i = t->pixels[k];
        bool is_hidden = alpha[i] < 0.5f;
        bool is_truly_hidden = t->alpha[i] < 0.5f;
        e->hidden += is_truly_hidden;
        e->both_hidden += is_hidden && is_truly_hidden;
        e->either_hidden += is_hidden || is_truly_hidden;
        bool is_whole = !(t->alpha[i] > 0.0f) || !(t->alpha[i] < 1.0f);
        bool is_far = t->gap[i] > ORDER_M || t->gap[i] < -ORDER_M;
        bool is_wrong = is_far && is_whole && is_hidden != is_truly_hidden;
        e->pixels++;
        e->order += is_wrong;
        e->order_far += is_wrong && !t->close[i];
        if (t->band[i]) {
            double error = (double)alpha[i] - t->alpha[i];
            e->band_sum += error < 0.0 ? -error : error;
            e->band_count++;
            double change = before != NULL ? (double)alpha[i] - before[i] : 0.0;
            e->flicker_sum += change < 0.0 ? -change : change;
            e->flicker_count += before != NULL;
        }
    }
    add_edges(e, t, alpha);
}

double picture_mean(const picture_distances *d)
{
    return d->count > 0 ? d->sum / (double)d->count : NAN;
}

double picture_percentile(const picture_distances *d, double percent)
{
    if (d->count == 0) {
        return NAN;
    }
    double left = 0.01 * percent * (double)d->count;
    for (int32_t i = 0; i < PICTURE_BINS; i++) {
        left -= (double)d->bins[i];
        if (left <= 0.0) {
            return (i + 0.5) * REACH / PICTURE_BINS;
        }
    }
    return REACH;
}
