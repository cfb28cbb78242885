/* wide_row.c: rows of half the resolution, and what planes found there say to the whole one. */
#ifndef RLF_KERNEL_WIDE_H
#define RLF_KERNEL_WIDE_H

#include "kernel/kernel.h"

/* Mean depth of each two pixels of two rows of 2 count; 0 where one is missing, or they are too far
 * apart for the noise. */
void rlf_kernel_halve_row(rlf_kernel_noise noise, const float *restrict upper,
                          const float *restrict lower, int32_t count, float *restrict out);
/* The fewest frames of each two pixels of two rows, as of rlf_kernel_steady_row. */
void rlf_kernel_halve_frames(const float *restrict upper, const float *restrict lower,
                             int32_t count, float *restrict out);

/* Normals, 0 where there is none, as planes of inverse depth: 1 / depth is x u + y v + z along the
 * ray (u, v, 1); 0 stays 0. */
void rlf_kernel_invert_planes(const float *restrict depth, const float *restrict ray_x,
                              const float *restrict ray_y, int32_t count, float *restrict x,
                              float *restrict y, float *restrict z);

/* A row of 2 half_width pixels, and rows of planes of inverse depth at half the resolution: that
 * which covers it and the next one above or below, the same where there is none. */
typedef struct rlf_kernel_wide {
    const float *depth, *ray_x, *ray_y;
    int32_t half_width;
    const float *frames, *half_frames; /* that depth is the mean of, and that of the half */
    const float *plane[3], *beside[3], *half_ray_x, *half_ray_y;
    rlf_kernel_noise noise;
    float lasting; /* error of inverse depth that stays in any mean, 1/m */
    float tilt;    /* radians that a pixel's own plane is off, per share that its depth is */
} rlf_kernel_wide;

/* Takes the normals of the wide planes where they agree with the pixel's own and its depth on its
 * own plane, and their depth where they are nearly the same. */
void rlf_kernel_wide_row(const rlf_kernel_wide *in, float *const normal[3], float *restrict smooth);

#endif
