/* Where a depth camera's pixels are missing: each run of missing pixels of a row is told apart by
 * what stands at its two ends. */
#include "info/info.h"

#include <math.h>

/* A row or column of the rim has fewer pixels than this share: noise gives a few. */
#define RIM_SHARE 0.05

/* Columns begin <= x < end and rows top <= y < bottom are inside the rim. */
typedef struct inner_part {
    int32_t begin, end, top, bottom;
} inner_part;

static bool is_empty(const float *first, int32_t count, ptrdiff_t step)
{
    int32_t there = 0;
    for (int32_t i = 0; i < count; i++) {
        there += first[i * step] > 0.0f ? 1 : 0;
    }
    return there < RIM_SHARE * count;
}

static inner_part find_inner(const float *depth, int32_t width, int32_t height)
{
    inner_part p = {0, width, 0, height};
    while (p.top < p.bottom && is_empty(depth + (ptrdiff_t)p.top * width, width, 1)) {
        p.top++;
    }
    while (p.bottom > p.top && is_empty(depth + (ptrdiff_t)(p.bottom - 1) * width, width, 1)) {
        p.bottom--;
    }
    const float *first = depth + (ptrdiff_t)p.top * width;
    const int32_t rows = p.bottom - p.top;
    while (p.begin < p.end && is_empty(first + p.begin, rows, width)) {
        p.begin++;
    }
    while (p.end > p.begin && is_empty(first + p.end - 1, rows, width)) {
        p.end--;
    }
    return p;
}

/* Adds the run of missing pixels begin <= x < end. */
static void add_run(missing_counts *counts, const rlf_rig *rig, const float *row,
                    const inner_part *inner, int32_t begin, int32_t end)
{
    missing_kind kind = MISSING_BORDER;
    if (begin > inner->begin && end < inner->end) {
        const double left = row[begin - 1];
        const double right = row[end];
        const double step = info_step(rig, fmax(left, right), end - begin + 1);
        kind = fabs(left - right) > step ? MISSING_STEP : MISSING_INSIDE;
    }
    counts->kinds[kind] += end - begin;
}

static void add_row(missing_counts *counts, const rlf_rig *rig, const float *row,
                    const inner_part *inner)
{
    for (int32_t x = inner->begin; x < inner->end; x++) {
        if (row[x] > 0.0f) {
            counts->kinds[MISSING_NEAR] += row[x] < rig->depth_min_m ? 1 : 0;
            counts->kinds[MISSING_FAR] += row[x] > rig->depth_max_m ? 1 : 0;
            continue;
        }
        const int32_t begin = x;
        while (x < inner->end && row[x] <= 0.0f) {
            x++;
        }
        add_run(counts, rig, row, inner, begin, x);
        x--;
    }
}

static int64_t count_missing(const float *depth, int64_t count)
{
    int64_t missing = 0;
    for (int64_t i = 0; i < count; i++) {
        missing += depth[i] <= 0.0f ? 1 : 0;
    }
    return missing;
}

void missing_add(missing_counts *counts, const rlf_rig *rig, const float *depth)
{
    const int32_t width = rig->depth.width;
    const int32_t height = rig->depth.height;
    const inner_part inner = find_inner(depth, width, height);
    int64_t inside = 0;
    for (int32_t y = inner.top; y < inner.bottom; y++) {
        const float *row = depth + (ptrdiff_t)y * width;
        inside += count_missing(row + inner.begin, inner.end - inner.begin);
        add_row(counts, rig, row, &inner);
    }
    counts->kinds[MISSING_RIM] += count_missing(depth, (int64_t)width * height) - inside;
    counts->pixels += (int64_t)width * height;
    counts->frames++;
}

double missing_percent(const missing_counts *counts, missing_kind kind)
{
    return counts->pixels > 0 ? 100.0 * (double)counts->kinds[kind] / (double)counts->pixels : 0.0;
}

double missing_percent_all(const missing_counts *counts)
{
    double sum = 0.0;
    for (int k = 0; k < MISSING_KIND_COUNT; k++) {
        sum += missing_percent(counts, (missing_kind)k);
    }
    return sum;
}

const char *missing_name(missing_kind kind)
{
    static const char *const names[MISSING_KIND_COUNT] = {
        "rim",    "at the border",         "beside depth steps",
        "inside", "nearer than the range", "beyond the range"};
    return names[kind];
}
