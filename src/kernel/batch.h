/* Batches: sixteen pixels of an image and the windows of 5x5 about them.
 *
 * What has to be found for few pixels only, those that a sensor drops, is found for a batch at a
 * time: they are gathered one by one, and no loop over a batch has a remainder or a branch that
 * depends on a pixel. */
#ifndef RLF_KERNEL_BATCH_H
#define RLF_KERNEL_BATCH_H

#include "kernel/kernel.h"

#define RLF_BATCH 16
#define RLF_WINDOW_ABOUT 2 /* pixels to each side */
#define RLF_WINDOW_SIDE (1 + 2 * RLF_WINDOW_ABOUT)
#define RLF_WINDOW_SIZE (RLF_WINDOW_SIDE * RLF_WINDOW_SIDE)

/* A value at each place of the windows, row by row. */
typedef struct rlf_windows {
    float at[RLF_WINDOW_SIZE][RLF_BATCH];
} rlf_windows;

/* Offsets of a window's pixels from its middle in a plane of that width, and whether they are
 * inside the image: 1 or 0; outside the offset is 0. */
typedef struct rlf_window_places {
    int32_t column[RLF_WINDOW_SIDE], row[RLF_WINDOW_SIDE];
    float column_inside[RLF_WINDOW_SIDE], row_inside[RLF_WINDOW_SIDE];
} rlf_window_places;

static inline rlf_window_places rlf_window_places_make(int32_t width, int32_t height, int32_t x,
                                                       int32_t y)
{
    rlf_window_places p;
    for (int32_t k = 0; k < RLF_WINDOW_SIDE; k++) {
        int32_t off = k - RLF_WINDOW_ABOUT;
        bool has_column = (x + off >= 0) & (x + off < width);
        bool has_row = (y + off >= 0) & (y + off < height);
        p.column[k] = has_column ? off : 0;
        p.row[k] = has_row ? off * width : 0;
        p.column_inside[k] = has_column ? 1.0f : 0.0f;
        p.row_inside[k] = has_row ? 1.0f : 0.0f;
    }
    return p;
}

/* Copies the window about (x, y) of a plane into place `lane` of a batch; 0 outside the image. */
static inline void rlf_windows_read(const float *plane, int32_t width, int32_t height, int32_t x,
                                    int32_t y, int32_t lane, rlf_windows *restrict out)
{
    enum { ABOUT = RLF_WINDOW_ABOUT, SIDE = RLF_WINDOW_SIDE };
    const float *middle = plane + (ptrdiff_t)y * width + x;
    if (x >= ABOUT && y >= ABOUT && x + ABOUT < width && y + ABOUT < height) {
        for (int32_t r = 0; r < SIDE; r++) {
            const float *row = middle + (ptrdiff_t)(r - ABOUT) * width - ABOUT;
            for (int32_t c = 0; c < SIDE; c++) {
                out->at[r * SIDE + c][lane] = row[c];
            }
        }
        return;
    }
    const rlf_window_places p = rlf_window_places_make(width, height, x, y);
    for (int32_t r = 0; r < SIDE; r++) {
        for (int32_t c = 0; c < SIDE; c++) {
            float inside = p.row_inside[r] * p.column_inside[c];
            out->at[r * SIDE + c][lane] = inside * middle[p.row[r] + p.column[c]];
        }
    }
}

/* ---- recall_batch.c: what is about pixels that were dropped ---- */

/* Bits: something moved within two pixels; a pixel that is seen there continues what is remembered
 * at the pixel. */
enum { RLF_ABOUT_MOVED = 1, RLF_ABOUT_CONTINUED = 2 };

/* `seen` is depth, negative where that moved, 0 where it was not seen; `inverse` is what is
 * remembered. */
void rlf_kernel_recall_batch(const rlf_windows *restrict seen, const float *restrict inverse,
                             uint8_t *restrict out);

/* ---- gap_patch.c: which pixels of a row are between others ---- */

#define RLF_FILL_GAP 8 /* most pixels from end to end of what is filled, less one */
#define RLF_GAP_WIDTH (RLF_BATCH + 2 * RLF_FILL_GAP)
#define RLF_GAP_HEIGHT (1 + 2 * RLF_FILL_GAP)

/* 1 where there is a depth, else 0: about sixteen pixels of a row. */
typedef struct rlf_gap_patch {
    uint8_t has[RLF_GAP_HEIGHT][RLF_GAP_WIDTH];
} rlf_gap_patch;

void rlf_kernel_has_row(const float *restrict depth, int32_t count, uint8_t *restrict has);
/* Those about the pixels from (x, y) on; 0 outside the image. */
void rlf_gap_patch_read(const uint8_t *plane, int32_t width, int32_t height, int32_t x, int32_t y,
                        rlf_gap_patch *restrict out);

/* Lines through a pixel, and the step along each of them. */
enum { RLF_LINE_ROW, RLF_LINE_COLUMN, RLF_LINE_DOWN, RLF_LINE_UP, RLF_LINE_NONE };

/* Of each pixel the line whose next pixels with depth on both sides are nearest to each other; a
 * diagonal where neither its row nor its column has them. */
typedef struct rlf_gaps {
    uint8_t line[RLF_BATCH];
    uint8_t to_before[RLF_BATCH], to_after[RLF_BATCH]; /* steps, > 0 unless NONE */
} rlf_gaps;

void rlf_kernel_gap_patch(const rlf_gap_patch *restrict patch, rlf_gaps *restrict out);

/* ---- fill_batch.c: depth of holes ---- */

/* The two ends of each pixel's gap: their depths, the steps to them, and the share of its depth by
 * which what is about the pixel may differ from an end to be of its side. */
typedef struct rlf_gap_ends {
    float before[RLF_BATCH], after[RLF_BATCH];
    float to_before[RLF_BATCH], to_after[RLF_BATCH];
    float most_apart[RLF_BATCH];
} rlf_gap_ends;

/* What a depth is: between two ends of one surface, or that of the nearer or the farther side of an
 * edge. */
enum { RLF_FILL_BETWEEN, RLF_FILL_NEAR, RLF_FILL_FAR };

/* Inverse depth half way between the two sides. */
static inline float rlf_gap_middle(float before, float after)
{
    return 2.0f / (1.0f / before + 1.0f / after);
}

/* `span`: steps from one to the other. */
static inline bool rlf_gap_is_edge(float before, float after, float span)
{
    float nearest = before < after ? before : after;
    return rlf_kernel_abs(before - after) > (0.01f * span + 0.01f) * nearest;
}

/* Votes of the pixels about each for the nearer side of its gap, less those for the farther one. */
void rlf_kernel_fill_votes(const rlf_windows *restrict depth, const rlf_gap_ends *restrict ends,
                           float *restrict votes);
void rlf_kernel_fill_batch(const rlf_windows *restrict depth, const rlf_gap_ends *restrict ends,
                           const float *restrict votes, float *restrict out,
                           uint8_t *restrict kind);

#endif
