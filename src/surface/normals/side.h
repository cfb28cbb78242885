/* Narrow faces beside outlines: see normals/side.c. */
#ifndef RLF_SURFACE_NORMALS_SIDE_H
#define RLF_SURFACE_NORMALS_SIDE_H

#include "kernel/kernel.h"
#include "surface/steps.h"

typedef struct rlf_side_job {
    const rlf_reconstruct *stage;
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const uint8_t *known; /* 1 where depth was not filled */
    const float *mean,
        *frames; /* of inverse depth over time; NULL = not kept: there are no sides */
    float *const *normal;
    uint8_t *mark; /* plane; 0 but where a side was found */
    rlf_kernel_noise noise;
} rlf_side_job;

rlf_side_job rlf_side_job_make(const rlf_reconstruct *stage, const rlf_slot *slot);

/* Whether the filled pixel (x, y) is on a narrow face: then it has its normal and a mark. (out_x,
 * out_y): unit, outwards across the outline that it is at. Reads normals of known pixels only. */
bool rlf_side_find(const rlf_side_job *job, int32_t x, int32_t y, float out_x, float out_y);
/* Gives what lies between marked pixels and the fronts of their things the same normals. */
void rlf_side_spread(const rlf_side_job *job);

#endif
