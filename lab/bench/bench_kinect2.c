/* Milliseconds of the Kinect v2's registration on one thread: least, median and 95th percentile of
 * whole pictures. */
#include "kinect2_sample.h"

#include <stdio.h>
#include <stdlib.h>

#define REPEATS 201

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(void)
{
    kinect2_registration *registration = NULL;
    float *depth = rlf_alloc_array(KINECT2_DEPTH_PIXELS, sizeof(*depth));
    uint32_t *color = rlf_alloc_array(KINECT2_COLOR_PIXELS, sizeof(*color));
    const kinect2_registered out = {rlf_alloc_array(KINECT2_DEPTH_PIXELS, sizeof(float)),
                                    rlf_alloc_array(KINECT2_DEPTH_PIXELS, sizeof(uint32_t)),
                                    rlf_alloc_array(KINECT2_DEPTH_PIXELS, sizeof(int32_t))};
    double times[REPEATS];
    if (depth == NULL || color == NULL || out.undistorted == NULL || out.color == NULL ||
        out.offset == NULL ||
        kinect2_registration_create(&kinect2_sample_ir, &kinect2_sample_color, &registration) !=
            RLF_OK) {
        fprintf(stderr, "bench_kinect2: out of memory\n");
        return 1;
    }
    kinect2_sample_depth(depth);
    kinect2_sample_colors(color);
    for (int i = 0; i < REPEATS; i++) {
        const int64_t start = rlf_clock_ns();
        kinect2_registration_apply(registration, depth, color, &out);
        times[i] = (double)(rlf_clock_ns() - start) / 1e6;
    }
    qsort(times, REPEATS, sizeof(times[0]), compare);
    printf("%-44s %8.3f %8.3f %8.3f\n", "kinect2: registration with hidden pixels", times[0],
           times[REPEATS / 2], times[(REPEATS - 1) * 95 / 100]);
    kinect2_registration_destroy(&registration);
    rlf_free(depth);
    rlf_free(color);
    rlf_free(out.undistorted);
    rlf_free(out.color);
    rlf_free(out.offset);
    return 0;
}
