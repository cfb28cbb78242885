/* A hand's own pixels, from where its palm is on: what the fit of its model sees. */
#ifndef RLF_HANDS_CROP_H
#define RLF_HANDS_CROP_H

#include "relief/surface.h"

#define CROP_SIDE 128
#define CROP_COUNT (CROP_SIDE * CROP_SIDE)
#define CROP_SAMPLES 224 /* at most */

/* Pixel (x, y) of the crop is (x0 + x * step, y0 + y * step) of the surface. */
typedef struct hand_crop {
    int32_t x0, y0, step, width, height;
    double fx, fy, cx, cy; /* of the crop's pixels */
    float noise;           /* sigma of depth at the palm, metres */
    float z[CROP_COUNT];   /* metres; 0 = missing */
    uint8_t is_hand[CROP_COUNT];
    int32_t nearest[CROP_COUNT]; /* pixel of the hand that is nearest in the picture */
    int32_t pixel[CROP_COUNT];   /* the hand's, in the order they were reached */
    int32_t pixel_count;
    /* Some of them, spread evenly: points, metres, and unit ways to them from the camera. */
    int32_t count;
    float x[CROP_SAMPLES], y[CROP_SAMPLES], p_z[CROP_SAMPLES];
    float way_x[CROP_SAMPLES], way_y[CROP_SAMPLES], way_z[CROP_SAMPLES];
    float share[CROP_SAMPLES]; /* what each counts: 1, and more at the fingers' ends */
} hand_crop;

/* Reads the hand whose palm's middle is seen at `palm` with its arm along the unit `arm`; `turn`
 * changes which pixels are sampled. False: hardly a pixel is its. */
bool hand_crop_read(hand_crop *c, const rlf_surface *s, rlf_vec3 palm, rlf_vec3 arm, uint32_t turn);

#endif
