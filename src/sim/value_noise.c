/* Value noise: random numbers at the corners of a grid, blended between. */
#include "sim/hash.h"
#include "sim/material.h"

static int32_t floor_of(double x)
{
    int32_t i = (int32_t)x;
    return x < i ? i - 1 : i;
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
    double top = synth_lattice(ix, iy) + (synth_lattice(ix + 1, iy) - synth_lattice(ix, iy)) * fx;
    double bottom = synth_lattice(ix, iy + 1) +
                    (synth_lattice(ix + 1, iy + 1) - synth_lattice(ix, iy + 1)) * fx;
    return top + (bottom - top) * fy;
}
