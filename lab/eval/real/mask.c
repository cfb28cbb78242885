/* Masks compared. */
#include "eval/real/mask.h"

#include "eval/measures/foreground.h"

#include <string.h>

#define CLOSE_PX 4    /* to each side: 9 x 9 */
#define NOWHERE 30000 /* rows; more than any picture has */

rlf_result real_mask_work_init(real_mask_work *w, int32_t width, int32_t height)
{
    size_t pixels = (size_t)width * (size_t)height;
    *w = (real_mask_work){.width = width, .height = height};
    w->flag = rlf_alloc_array(pixels, 1);
    w->stack = rlf_alloc_array(pixels, sizeof(int32_t));
    bool is_ready = w->flag != NULL && w->stack != NULL;
    for (int k = 0; k < 2; k++) {
        w->outline[k] = rlf_alloc_array(pixels, 1);
        w->column[k] = rlf_alloc_array(pixels, sizeof(int32_t));
        is_ready = is_ready && w->outline[k] != NULL && w->column[k] != NULL;
    }
    return is_ready ? RLF_OK : RLF_ERROR_MEMORY;
}

void real_mask_work_finish(real_mask_work *w)
{
    for (int k = 0; k < 2; k++) {
        rlf_free(w->outline[k]);
        rlf_free(w->column[k]);
    }
    rlf_free(w->flag);
    rlf_free(w->stack);
    memset(w, 0, sizeof(*w));
}

/* ---- outlines -------------------------------------------------------------------------------- */

/* Inside pixels with a judged neighbour outside. `inside` is what counts as in. */
static void find_outline(const real_mask_work *w, const uint8_t *mask, uint8_t inside,
                         const uint8_t *truth, uint8_t *out)
{
    const int32_t dx[4] = {1, -1, 0, 0}, dy[4] = {0, 0, 1, -1};
    for (int32_t i = 0; i < w->width * w->height; i++) {
        int32_t x = i % w->width, y = i / w->width;
        out[i] = 0;
        for (int k = 0; k < 4 && mask[i] == inside && truth[i] != REAL_UNJUDGED; k++) {
            int32_t nx = x + dx[k], ny = y + dy[k], n = ny * w->width + nx;
            bool is_in_picture = nx >= 0 && ny >= 0 && nx < w->width && ny < w->height;
            out[i] |= is_in_picture && truth[n] != REAL_UNJUDGED && mask[n] != inside;
        }
    }
}

static void find_columns(const real_mask_work *w, const uint8_t *outline, int32_t *out)
{
    for (int32_t x = 0; x < w->width; x++) {
        int32_t rows = NOWHERE;
        for (int32_t y = 0; y < w->height; y++) {
            rows = outline[y * w->width + x] ? 0 : rows + (rows < NOWHERE);
            out[y * w->width + x] = rows;
        }
        rows = NOWHERE;
        for (int32_t y = w->height - 1; y >= 0; y--) {
            int32_t i = y * w->width + x;
            rows = outline[i] ? 0 : rows + (rows < NOWHERE);
            out[i] = rows < out[i] ? rows : out[i];
        }
    }
}

/* To the nearest outline pixel; at most REAL_FAR_PX. */
static double distance_at(const real_mask_work *w, const int32_t *column, int32_t i)
{
    int32_t x = i % w->width, row = i - x;
    double best = REAL_FAR_PX * REAL_FAR_PX;
    for (int32_t k = 0; (double)k * k < best; k++) {
        int32_t left = x - k >= 0 ? column[row + x - k] : NOWHERE;
        int32_t right = x + k < w->width ? column[row + x + k] : NOWHERE;
        double rows = left < right ? left : right;
        best = rlf_min(best, (double)k * k + rows * rows);
    }
    return sqrt(best);
}

static void add_distances(real_mask_errors *e, const real_mask_work *w, const uint8_t *outline,
                          const int32_t *column)
{
    for (int32_t i = 0; i < w->width * w->height; i++) {
        if (outline[i]) {
            double d = distance_at(w, column, i);
            e->bins[(int)(d * 4.0)]++;
            e->distance_sum += d;
            e->distance_count++;
        }
    }
}

/* ---- blots ----------------------------------------------------------------------------------- */

int64_t real_mask_largest(uint8_t *mask, int32_t width, int32_t height, int32_t *stack)
{
    int64_t largest = 0;
    for (int32_t start = 0; start < width * height; start++) {
        int32_t top = 0;
        int64_t size = 0;
        if (mask[start]) {
            mask[start] = 0;
            stack[top++] = start;
        }
        while (top > 0) {
            int32_t i = stack[--top], x = i % width, y = i / width;
            const int32_t near[4] = {x > 0 ? i - 1 : i, x + 1 < width ? i + 1 : i,
                                     y > 0 ? i - width : i, y + 1 < height ? i + width : i};
            size++;
            for (int k = 0; k < 4; k++) {
                if (mask[near[k]]) {
                    mask[near[k]] = 0;
                    stack[top++] = near[k];
                }
            }
        }
        largest = size > largest ? size : largest;
    }
    return largest;
}

static int64_t largest_blot(real_mask_work *w, const uint8_t *found, const uint8_t *truth,
                            bool is_inside)
{
    for (int32_t i = 0; i < w->width * w->height; i++) {
        bool is_false =
            is_inside ? truth[i] == REAL_INSIDE && !found[i] : truth[i] == 0 && found[i];
        w->flag[i] = is_false && distance_at(w, w->column[1], i) > REAL_BLOT_PX;
    }
    return real_mask_largest(w->flag, w->width, w->height, w->stack);
}

/* ---- sums ------------------------------------------------------------------------------------ */

void real_mask_add(real_mask_errors *e, real_mask_work *w, const uint8_t *found,
                   const uint8_t *truth)
{
    for (int32_t i = 0; i < w->width * w->height; i++) {
        bool is_in = truth[i] == REAL_INSIDE, is_judged = is_in || truth[i] == 0;
        e->pixels.true_positive += is_judged && found[i] && is_in;
        e->pixels.false_positive += is_judged && found[i] && !is_in;
        e->pixels.false_negative += is_judged && !found[i] && is_in;
        e->pixels.true_negative += is_judged && !found[i] && !is_in;
    }
    find_outline(w, found, 1, truth, w->outline[0]);
    find_outline(w, truth, REAL_INSIDE, truth, w->outline[1]);
    find_columns(w, w->outline[0], w->column[0]);
    find_columns(w, w->outline[1], w->column[1]);
    add_distances(e, w, w->outline[0], w->column[1]);
    add_distances(e, w, w->outline[1], w->column[0]);
    int64_t inside = largest_blot(w, found, truth, true);
    int64_t outside = largest_blot(w, found, truth, false);
    e->blot_inside_sum += inside;
    e->blot_outside_sum += outside;
    e->blot_inside_max = inside > e->blot_inside_max ? inside : e->blot_inside_max;
    e->blot_outside_max = outside > e->blot_outside_max ? outside : e->blot_outside_max;
    e->pictures++;
}

double real_mask_iou(const real_mask_errors *e)
{
    const eval_confusion *c = &e->pixels;
    int64_t either = c->true_positive + c->false_positive + c->false_negative;
    return either > 0 ? (double)c->true_positive / (double)either : NAN;
}

double real_mask_distance_mean(const real_mask_errors *e)
{
    return e->distance_count > 0 ? e->distance_sum / (double)e->distance_count : NAN;
}

double real_mask_distance_p95(const real_mask_errors *e)
{
    int64_t seen = 0;
    for (int i = 0; i <= (int)REAL_FAR_PX * 4; i++) {
        seen += e->bins[i];
        if (e->distance_count > 0 && 100 * seen >= 95 * e->distance_count) {
            return i * 0.25;
        }
    }
    return NAN;
}

/* Most of (or, for erosion, least of) the pixels within CLOSE_PX along a line. */
static void spread_line(const uint8_t *in, uint8_t *out, int32_t count, int32_t step, uint8_t value)
{
    int32_t since = CLOSE_PX + 1; /* pixels since the last `value` */
    for (int32_t i = 0; i < count + CLOSE_PX; i++) {
        since = i < count && in[i * step] == value ? 0 : since + 1;
        if (i >= CLOSE_PX) {
            out[(i - CLOSE_PX) * step] = since <= 2 * CLOSE_PX ? value : !value;
        }
    }
}

static void spread(uint8_t *mask, int32_t width, int32_t height, uint8_t *scratch, uint8_t value)
{
    for (int32_t y = 0; y < height; y++) {
        spread_line(mask + y * width, scratch + y * width, width, 1, value);
    }
    for (int32_t x = 0; x < width; x++) {
        spread_line(scratch + x, mask + x, height, width, value);
    }
}

void real_mask_grow(uint8_t *mask, int32_t width, int32_t height, uint8_t *scratch)
{
    spread(mask, width, height, scratch, 1);
}

void real_mask_close(uint8_t *mask, int32_t width, int32_t height, uint8_t *scratch)
{
    spread(mask, width, height, scratch, 1);
    spread(mask, width, height, scratch, 0);
}
