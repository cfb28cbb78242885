/* Where depth jumps from one surface to another. */
#ifndef RLF_ENVIRONMENT_DEPTH_EDGE_H
#define RLF_ENVIRONMENT_DEPTH_EDGE_H

#include "kernel/kernel.h"

/* True when depth jumps from `a` to its neighbour `b`. */
RLF_KERNEL_PART bool depth_steps(float a, float b)
{
    float nearer = a < b ? a : b;
    float step = a < b ? b - a : a - b;
    return step > 0.02f + 0.012f * nearer;
}

#endif
