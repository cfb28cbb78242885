/* The sides of edges by a colour picture: see surface/depth/color_guide.c. Batches as in batch.h.
 */
#ifndef RLF_KERNEL_COLOR_H
#define RLF_KERNEL_COLOR_H

#include "kernel/batch.h"

/* Pixels whose colours are read: about one, and the two ends of its gap. */
enum { RLF_COLOR_ABOUT = 12, RLF_COLOR_SAMPLES = RLF_COLOR_ABOUT + 2 };

typedef struct rlf_color_places {
    float u[RLF_BATCH], v[RLF_BATCH]; /* in the picture; 0 = it is not asked */
    float line[2][RLF_BATCH];         /* columns and rows from pixel to pixel along the line */
    float step[2][2];                 /* colour pixels, of u and of v, per column and row */
    int32_t stride;                   /* bytes, of the picture's rows */
} rlf_color_places;

/* Bytes from the picture's first to those of each sample. */
void rlf_kernel_color_offsets(const rlf_color_places *restrict places,
                              const rlf_gap_ends *restrict ends,
                              int32_t offset[restrict RLF_COLOR_SAMPLES][RLF_BATCH]);

/* red | green << 8 | blue << 16 | any << 24 of each sample, and the colours at the places
 * themselves. */
typedef struct rlf_color_samples {
    uint32_t sample[RLF_COLOR_SAMPLES][RLF_BATCH];
    float color[3][RLF_BATCH];
} rlf_color_samples;

/* Share of the nearer side in a pixel's colour, 0..1, and what that is worth, 0..1; the sum of the
 * ways from the pixel to those of the nearer side about it, less those to the farther. */
typedef struct rlf_color_shares {
    float share[RLF_BATCH], worth[RLF_BATCH], way[2][RLF_BATCH];
} rlf_color_shares;

void rlf_kernel_color_shares(const rlf_windows *restrict depth, const rlf_gap_ends *restrict ends,
                             const rlf_color_samples *restrict seen,
                             rlf_color_shares *restrict out);

#endif
