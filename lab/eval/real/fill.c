/* Filled pixels, left out on purpose: what a still camera sees beside depth steps is hidden in
 * every frame, and what is filled in is compared with it. */
#include "command.h"
#include "eval/measures/depth.h"
#include "eval/measures/percent.h"
#include "eval/real/clip.h"
#include "eval/real/parts.h"
#include "eval/real/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BAND 3       /* pixels hidden beside a step */
#define GAP 12       /* a step may have that many pixels without depth */
#define JUMP 0.04    /* share of the nearer depth */
#define WRONG_M 0.04 /* the other side of the step */
#define FRAMES 40

typedef struct fill_clip {
    const char *name, *part;
} fill_clip;

static const fill_clip clips[] = {
    {"hands_toys", "hands_toys, still 0-39"},
    {"room_still", "room_still, 12 frames"},
};

typedef struct fill_run {
    int32_t width, height, pixels, last;
    bool is_far; /* the far side of the steps is hidden, else the near side */
    float *mean; /* of frames with depth; 0 where fewer than eight of ten have any */
    uint8_t *is_hidden;
    float *error[2]; /* of the hidden pixels: Relief, baseline; metres */
    int32_t count, wrong[2], missing[2], got[2];
} fill_run;

static rlf_result allocate(fill_run *r, const real_clip *clip, bool is_far)
{
    size_t n = (size_t)real_clip_pixels(clip);
    *r = (fill_run){.width = clip->rig.depth.width,
                    .height = clip->rig.depth.height,
                    .pixels = (int32_t)n,
                    .last = clip->count - 1,
                    .is_far = is_far};
    r->mean = rlf_alloc_array(n, sizeof(float));
    r->is_hidden = rlf_alloc_array(n, 1);
    r->error[0] = rlf_alloc_array(n, sizeof(float));
    r->error[1] = rlf_alloc_array(n, sizeof(float));
    bool is_ready =
        r->mean != NULL && r->is_hidden != NULL && r->error[0] != NULL && r->error[1] != NULL;
    return is_ready ? RLF_OK : RLF_ERROR_MEMORY;
}

static void release(fill_run *r)
{
    rlf_free(r->mean);
    rlf_free(r->is_hidden);
    rlf_free(r->error[0]);
    rlf_free(r->error[1]);
}

static void find_mean(fill_run *r, const real_clip *clip)
{
    for (int32_t i = 0; i < r->pixels; i++) {
        int64_t sum = 0, seen = 0;
        for (int32_t f = 0; f < clip->count; f++) {
            sum += real_clip_depth(clip, f)[i];
            seen += real_clip_depth(clip, f)[i] > 0;
        }
        bool is_steady = 10 * seen >= 8 * clip->count;
        r->mean[i] = is_steady ? (float)((double)sum / (double)seen / clip->units_per_metre) : 0.0f;
    }
}

/* Marks BAND pixels from index i on in the direction of `step`, as far as they are one surface. */
static void mark_from(fill_run *r, const float *line, uint8_t *mark, int32_t i, int32_t end,
                      int32_t step, int32_t stride)
{
    float first = line[i * stride];
    for (int32_t k = 0; k < BAND && i >= 0 && i < end; k++, i += step) {
        float z = line[i * stride], off = z - first, most = (float)JUMP * first;
        if (!(z > 0.0f) || off > most || off < -most) {
            return;
        }
        mark[i * stride] = 1;
    }
    (void)r;
}

/* Steps along a row or a column, over gaps. */
static void mark_line(fill_run *r, int32_t start, int32_t count, int32_t stride)
{
    const float *line = r->mean + start;
    uint8_t *mark = r->is_hidden + start;
    int32_t before = -1;
    for (int32_t i = 0; i < count; i++) {
        float z = line[i * stride];
        if (!(z > 0.0f)) {
            continue;
        }
        if (before >= 0 && i - before <= GAP) {
            float other = line[before * stride], near = z < other ? z : other;
            float off = z < other ? other - z : z - other;
            bool is_here = r->is_far ? z > other : z < other;
            if (off > (float)JUMP * near) {
                mark_from(r, line, mark, is_here ? i : before, count, is_here ? 1 : -1, stride);
            }
        }
        before = i;
    }
}

static void hide(fill_run *r, real_clip *clip)
{
    for (int32_t y = 0; y < r->height; y++) {
        mark_line(r, y * r->width, r->width, 1);
    }
    for (int32_t x = 0; x < r->width; x++) {
        mark_line(r, x, r->height, r->width);
    }
    for (int32_t f = 0; f < clip->count; f++) {
        uint16_t *depth = real_clip_depth(clip, f);
        for (int32_t i = 0; i < r->pixels; i++) {
            depth[i] = r->is_hidden[i] ? 0 : depth[i];
        }
    }
}

/* The next pixel with depth to the left and to the right; of the two the farther for the far side,
 * the nearer for the near side: a baseline that knows which side it is. */
static float from_neighbours(const fill_run *r, const rlf_frame *frame, int32_t i)
{
    int32_t x = i % r->width, y = i / r->width;
    float side[2] = {0.0f, 0.0f};
    for (int k = 0; k < 2; k++) {
        int32_t step = k == 0 ? -1 : 1;
        for (int32_t at = x + step; at >= 0 && at < r->width && !(side[k] > 0.0f); at += step) {
            side[k] = eval_raw_depth(frame, at, y);
        }
    }
    if (!(side[0] > 0.0f) || !(side[1] > 0.0f)) {
        return side[0] > 0.0f ? side[0] : side[1];
    }
    return (side[0] > side[1]) == r->is_far ? side[0] : side[1];
}

static void add(fill_run *r, int method, float found, float truth)
{
    float off = found > truth ? found - truth : truth - found;
    if (found > 0.0f) {
        r->error[method][r->got[method]++] = off;
        r->wrong[method] += off > (float)WRONG_M;
    } else {
        r->missing[method]++;
    }
}

static rlf_result take_surface(void *context, const rlf_frame *frame, const rlf_surface *s,
                               int32_t index)
{
    fill_run *r = context;
    for (int32_t i = 0; i < r->pixels && index == r->last; i++) {
        if (r->is_hidden[i]) {
            r->count++;
            add(r, 0, s->depth[i], r->mean[i]);
            add(r, 1, from_neighbours(r, frame, i), r->mean[i]);
        }
    }
    return RLF_OK;
}

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void add_row(real_table *table, const fill_run *r, const char *part, const char *key,
                    const char *title, const double value[2])
{
    const real_row row = {.key = key,
                          .title = title,
                          .relation = '<',
                          .goal = NAN,
                          .relief = value[0],
                          .baseline = value[1],
                          .baseline_name = r->is_far ? "left or right neighbour, the farther"
                                                     : "left or right neighbour, the nearer"};
    real_add(table, part, &row);
}

static void add_rows(real_table *table, fill_run *r, const char *part)
{
    static const char *const keys[2][4] = {{"fill_near_median_mm", "fill_near_rmse_mm",
                                            "fill_near_wrong_percent", "fill_near_missing_percent"},
                                           {"fill_far_median_mm", "fill_far_rmse_mm",
                                            "fill_far_wrong_percent", "fill_far_missing_percent"}};
    double median[2], rmse[2], wrong[2], missing[2];
    for (int k = 0; k < 2; k++) {
        double sum = 0.0;
        for (int32_t i = 0; i < r->got[k]; i++) {
            sum += (double)r->error[k][i] * r->error[k][i];
        }
        qsort(r->error[k], (size_t)r->got[k], sizeof(float), compare_floats);
        median[k] = r->got[k] > 0 ? 1000.0 * r->error[k][r->got[k] / 2] : NAN;
        rmse[k] = r->got[k] > 0 ? 1000.0 * sqrt(sum / r->got[k]) : NAN;
        wrong[k] = eval_percent(r->wrong[k], r->count);
        missing[k] = eval_percent(r->missing[k], r->count);
    }
    add_row(table, r, part, keys[r->is_far][0],
            r->is_far ? "hidden, far side of steps: filled, median, mm"
                      : "hidden, near side of steps: filled, median, mm",
            median);
    add_row(table, r, part, keys[r->is_far][1], "  RMSE, mm", rmse);
    add_row(table, r, part, keys[r->is_far][2], "  wrong by > 4 cm, % of the hidden", wrong);
    add_row(table, r, part, keys[r->is_far][3], "  not filled, %", missing);
}

static rlf_result run_side(real_table *table, const char *folder, const char *part, bool is_far)
{
    real_clip clip;
    fill_run run = {0};
    rlf_result result = real_clip_load(folder, 0, FRAMES, &clip);
    result = result == RLF_OK ? allocate(&run, &clip, is_far) : result;
    if (result == RLF_OK) {
        find_mean(&run, &clip);
        hide(&run, &clip);
        result = real_clip_surfaces(&clip, 1, take_surface, &run);
    }
    if (result == RLF_OK && !command_interrupted) {
        add_rows(table, &run, part);
    }
    release(&run);
    real_clip_free(&clip);
    return result;
}

rlf_result real_fill_run(real_table *table, const real_options *options)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]); i++) {
        char folder[REAL_PATH_SIZE];
        bool is_there = real_join(folder, options->folder, clips[i].name) && real_is_there(folder);
        for (int far = 1; far >= 0 && is_there && result == RLF_OK && !command_interrupted; far--) {
            result = run_side(table, folder, clips[i].part, far != 0);
        }
    }
    return result;
}
