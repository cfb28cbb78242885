/* A Kinect v2's calibration with numbers as the factory gives them, and a synthetic picture that
 * has steps, holes and noise in every part. */
#ifndef RLF_TEST_KINECT2_SAMPLE_H
#define RLF_TEST_KINECT2_SAMPLE_H

#include "io/freenect2/freenect2.h"

static const kinect2_ir kinect2_sample_ir = {365.5F,  365.5F,  254.9F,  205.4F,  0.0905F,
                                             -0.268F, 0.0951F, 0.0008F, -0.0006F};

static const kinect2_color kinect2_sample_color = {
    1081.37F,
    1081.37F,
    959.5F,
    539.5F,
    863.0F,
    52.0F,
    {0.0005F, 0.00003F, 0.00005F, 0.00037F, 0.0001F, -0.00001F, 0.0001F, 0.64F, 0.004F, 0.15F},
    {0.00001F, 0.0007F, 0.00045F, 0.00003F, -0.0001F, 0.0002F, 0.0001F, -0.004F, 0.64F, 0.02F}};

/* Millimetres, exact in float on every machine. */
static inline void kinect2_sample_depth(float *out)
{
    uint32_t noise = 12345;
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
        const int u = i % KINECT2_DEPTH_WIDTH;
        const int v = i / KINECT2_DEPTH_WIDTH;
        noise = noise * 1664525u + 1013904223u;
        const bool is_near = (u / 64 + v / 53) % 3 == 0;
        out[i] = is_near ? 900.0F + (float)u * 0.5F : 2500.0F + (float)(2 * v - u);
        out[i] += (float)(noise >> 24) * 0.0625F;
        out[i] = (noise & 0xff00u) == 0 ? 0.0F : out[i];
    }
}

/* Each pixel another, none 0. */
static inline void kinect2_sample_colors(uint32_t *out)
{
    for (uint32_t i = 0; i < KINECT2_COLOR_PIXELS; i++) {
        out[i] = (i * 2654435761u) | 1u;
    }
}

#endif
