/* Patches: sixteen pixels of a row and two about them, copied out of a plane.
 *
 * What has to be found for few pixels only, those that a sensor drops, is found for a patch at a
 * time: such pixels come in runs, loops of a known length need no remainder, and no branch depends
 * on a pixel. Outside the image all is 0. */
#ifndef RLF_KERNEL_PATCH_H
#define RLF_KERNEL_PATCH_H

#include "kernel/kernel.h"

#define RLF_PATCH 16      /* pixels that are looked at */
#define RLF_PATCH_ABOUT 2 /* to each side of them */
#define RLF_PATCH_WIDTH (RLF_PATCH + 2 * RLF_PATCH_ABOUT)
#define RLF_PATCH_HEIGHT (1 + 2 * RLF_PATCH_ABOUT)

typedef struct rlf_patch {
    float at[RLF_PATCH_HEIGHT][RLF_PATCH_WIDTH];
} rlf_patch;

typedef struct rlf_byte_patch {
    uint8_t at[RLF_PATCH_HEIGHT][RLF_PATCH_WIDTH];
} rlf_byte_patch;

/* Copies bytes first .. first + count - 1 of a row of `size` bytes, 0 where it has none. */
static inline void rlf_patch_copy(const void *row, int32_t size, int32_t first, int32_t count,
                                  void *out)
{
    int32_t begin = first < 0 ? -first : 0, end = size - first < count ? size - first : count;
    memset(out, 0, (size_t)count);
    memcpy((uint8_t *)out + begin, (const uint8_t *)row + first + begin, (size_t)(end - begin));
}

/* The patch whose first pixel is (x, y), of a plane of that many pixels. */
static inline void rlf_patch_read(const float *plane, int32_t width, int32_t height, int32_t x,
                                  int32_t y, rlf_patch *restrict out)
{
    enum { ABOUT = RLF_PATCH_ABOUT, SIZE = sizeof(float) };
    bool inside = x >= ABOUT && x + RLF_PATCH + ABOUT <= width;
    for (int32_t k = 0; k < RLF_PATCH_HEIGHT; k++) {
        int32_t row = y - ABOUT + k;
        const float *from = plane + (ptrdiff_t)row * width;
        if (row < 0 || row >= height) {
            memset(out->at[k], 0, sizeof out->at[k]);
        } else if (inside) {
            memcpy(out->at[k], from + x - ABOUT, sizeof out->at[k]);
        } else {
            rlf_patch_copy(from, width * SIZE, (x - ABOUT) * SIZE, (int32_t)sizeof out->at[k],
                           out->at[k]);
        }
    }
}

static inline void rlf_byte_patch_read(const uint8_t *plane, int32_t width, int32_t height,
                                       int32_t x, int32_t y, rlf_byte_patch *restrict out)
{
    enum { ABOUT = RLF_PATCH_ABOUT };
    bool inside = x >= ABOUT && x + RLF_PATCH + ABOUT <= width;
    for (int32_t k = 0; k < RLF_PATCH_HEIGHT; k++) {
        int32_t row = y - ABOUT + k;
        const uint8_t *from = plane + (ptrdiff_t)row * width;
        if (row < 0 || row >= height) {
            memset(out->at[k], 0, sizeof out->at[k]);
        } else if (inside) {
            memcpy(out->at[k], from + x - ABOUT, sizeof out->at[k]);
        } else {
            rlf_patch_copy(from, width, x - ABOUT, RLF_PATCH_WIDTH, out->at[k]);
        }
    }
}

/* ---- recall_patch.c: what is about pixels that were dropped ---- */

/* Bits: something moved within two pixels; a pixel that is seen there continues what is remembered
 * at the pixel. */
enum { RLF_ABOUT_MOVED = 1, RLF_ABOUT_CONTINUED = 2 };

/* `change` is of RLF_CHANGE_; depth counts where it is not UNSEEN. `inverse` is what is remembered.
 */
void rlf_kernel_recall_patch(const rlf_patch *restrict depth, const rlf_byte_patch *restrict change,
                             const float *restrict inverse, uint8_t *restrict out);

/* ---- fill_patch.c: depth of holes ---- */

#define RLF_FILL_GAP 8 /* most pixels from end to end of what is filled, less one */
#define RLF_GAP_WIDTH (RLF_PATCH + 2 * RLF_FILL_GAP)
#define RLF_GAP_HEIGHT (1 + 2 * RLF_FILL_GAP)

/* 1 where there is a depth, else 0; as a patch, but with RLF_FILL_GAP pixels about. */
typedef struct rlf_gap_patch {
    uint8_t has[RLF_GAP_HEIGHT][RLF_GAP_WIDTH];
} rlf_gap_patch;

void rlf_kernel_has_row(const float *restrict depth, int32_t count, uint8_t *restrict has);
void rlf_gap_patch_read(const uint8_t *plane, int32_t width, int32_t height, int32_t x, int32_t y,
                        rlf_gap_patch *restrict out);

/* Lines through a pixel, and the step along each of them. */
enum { RLF_LINE_ROW, RLF_LINE_COLUMN, RLF_LINE_DOWN, RLF_LINE_UP, RLF_LINE_NONE };

/* Of each pixel the line whose next pixels with depth on both sides are nearest to each other; a
 * diagonal where neither its row nor its column has them. */
typedef struct rlf_gaps {
    uint8_t line[RLF_PATCH];
    uint8_t to_before[RLF_PATCH], to_after[RLF_PATCH]; /* steps, > 0 unless NONE */
} rlf_gaps;

void rlf_kernel_gap_patch(const rlf_gap_patch *restrict patch, rlf_gaps *restrict out);

/* Depths at the ends of the pixels' gaps; 0 = it has none. */
typedef struct rlf_gap_ends {
    float before[RLF_PATCH], after[RLF_PATCH];
} rlf_gap_ends;

/* What a depth is: between two ends of one surface, or that of the nearer or the farther side of an
 * edge. */
enum { RLF_FILL_BETWEEN, RLF_FILL_NEAR, RLF_FILL_FAR };

void rlf_kernel_fill_patch(const rlf_patch *restrict depth, const rlf_gaps *restrict gaps,
                           const rlf_gap_ends *restrict ends, float *restrict out,
                           uint8_t *restrict kind);

#endif
