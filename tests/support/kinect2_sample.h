/* A Kinect v2's calibration with numbers as the factory gives them. */
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

#endif
