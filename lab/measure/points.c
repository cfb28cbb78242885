/* Counting missing points and wrong normals per frame. */
#include "measure/points.h"

#include <math.h>

/* A frame has a moving object when this share of its points is foreground: fewer is noise. */
#define MOVING_SHARE 0.003
#define WRONG_COSINE 0.86602540378443864676 /* cos 30 degrees */

const char *measure_case_name(measure_case c)
{
    static const char *const names[MEASURE_CASE_COUNT] = {"a", "b", "c", "d"};
    return names[c];
}

/* The thesis's centre is 56 x 47 of 64 x 53: 4 columns and 3 rows off each side. */
static bool is_in_centre(const rlf_surface *s, int32_t x, int32_t y)
{
    int32_t margin_x = (s->width * 4 + 32) / 64;
    int32_t margin_y = (s->height * 3 + 26) / 53;
    return x >= margin_x && x < s->width - margin_x && y >= margin_y && y < s->height - margin_y;
}

static bool is_bad_normal(const rlf_surface *s, int32_t i, const rlf_truth *truth, int32_t t)
{
    double dot = (double)s->normal_x[i] * truth->normal_x[t] +
                 (double)s->normal_y[i] * truth->normal_y[t] +
                 (double)s->normal_z[i] * truth->normal_z[t];
    return !(dot >= WRONG_COSINE); /* a missing normal is 0 */
}

static void count_point(measure_counts *c, const rlf_surface *s, int32_t i)
{
    c->points++;
    c->reasons[s->reason[i]]++;
}

static void count_normal(measure_counts *c, bool is_bad)
{
    c->true_points++;
    c->bad_normals += is_bad;
}

void measure_points_add(measure_points *m, const rlf_surface *s, const rlf_truth *truth,
                        const rlf_rig *rig)
{
    if (s->background_state != RLF_BACKGROUND_READY) {
        return;
    }
    m->width = s->width;
    m->height = s->height;
    bool is_moving = s->foreground_count > MOVING_SHARE * s->width * s->height;
    measure_counts *full = &m->cases[is_moving ? MEASURE_MOVING_FULL : MEASURE_STILL_FULL];
    measure_counts *centre = &m->cases[is_moving ? MEASURE_MOVING_CENTRE : MEASURE_STILL_CENTRE];
    full->frames++;
    centre->frames++;
    full->points = centre->points = 0;
    for (int32_t i = 0; i < s->width * s->height; i++) {
        int32_t x = i % s->width;
        int32_t y = i / s->width;
        bool is_centre = is_in_centre(s, x, y);
        count_point(full, s, i);
        if (is_centre) {
            count_point(centre, s, i);
        }
        int32_t t = y * s->scale_factor * rig->depth.width + x * s->scale_factor;
        if (truth != NULL && truth->depth[t] > 0.0f) {
            bool is_bad = is_bad_normal(s, i, truth, t);
            count_normal(full, is_bad);
            if (is_centre) {
                count_normal(centre, is_bad);
            }
        }
    }
}

double measure_missing(const measure_counts *c)
{
    int64_t missing = 0;
    for (int r = 0; r < RLF_REASON_COUNT; r++) {
        missing += r == RLF_REASON_OK ? 0 : c->reasons[r];
    }
    return c->frames > 0 ? (double)missing / (double)c->frames : 0.0;
}

double measure_missing_percent(const measure_counts *c)
{
    return c->points > 0 ? 100.0 * measure_missing(c) / (double)c->points : 0.0;
}

double measure_estimated_percent(const measure_counts *c)
{
    return rlf_min(4.0 * measure_missing_percent(c), 100.0);
}

double measure_counted_percent(const measure_counts *c)
{
    return c->true_points > 0 ? 100.0 * (double)c->bad_normals / (double)c->true_points : NAN;
}

double measure_published(const measure_points *m, measure_case c)
{
    static const double published[MEASURE_CASE_COUNT] = {165.468, 15.548, 188.573, 57.113};
    return m->width == 64 && m->height == 53 ? published[c] : NAN;
}

double measure_published_off_percent(const measure_points *m, measure_case c)
{
    const measure_counts *counts = &m->cases[c];
    double published = measure_published(m, c);
    return counts->frames > 0 ? 100.0 * (measure_missing(counts) / published - 1.0) : NAN;
}
