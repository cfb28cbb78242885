/* Value noise: random numbers at the corners of a grid, blended between. */
#include "sim/hash.h"
#include "sim/material.h"

static int32_t floor_of(double x)
{
    int32_t i = (int32_t)x;
    return x < i ? i - 1 : i;
}

static double lattice(uint32_t row, int32_t x)
{
    return synth_uniform(synth_hash((uint32_t)x ^ row));
}

double synth_lattice(int32_t x, int32_t y)
{
    return synth_uniform(synth_hash2((uint32_t)x, (uint32_t)y));
}

double synth_value_noise(double x, double y)
{
    int32_t ix = floor_of(x);
    int32_t iy = floor_of(y);
    double fx = x - ix;
    double fy = y - iy;
    fx = fx * fx * (3.0 - 2.0 * fx);
    fy = fy * fy * (3.0 - 2.0 * fy);
    const uint32_t upper = synth_hash_row((uint32_t)iy);
    const uint32_t lower = synth_hash_row((uint32_t)(iy + 1));
    const double corner = lattice(upper, ix), below = lattice(lower, ix);
    double top = corner + (lattice(upper, ix + 1) - corner) * fx;
    double bottom = below + (lattice(lower, ix + 1) - below) * fx;
    return top + (bottom - top) * fy;
}
