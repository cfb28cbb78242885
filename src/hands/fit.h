/* The model of a hand, fitted to its pixels. */
#ifndef RLF_HANDS_FIT_H
#define RLF_HANDS_FIT_H

#include "hands/model.h"
#include "relief/surface.h"

/* ---- crop.c: a hand's own pixels, from where its palm is on: what the fit of its model sees */

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

/* ---- fit.c */

/* A pose and how ill it fits. */
typedef struct hand_fit {
    hand_model_pose pose;
    double energy; /* of its pixels, of what must be empty, and of odd poses; 0 is perfect */
    double seen;   /* the part of the pixels alone */
} hand_fit;

/* Improves a fit by Gauss-Newton steps with every `stride`-th sample; `before`, which may be NULL,
 * is the pose of the frame before. Energy is that of the last step's beginning. */
void hand_fit_improve(hand_fit *fit, const hand_crop *crop, const hand_model_pose *before,
                      int32_t steps, int32_t stride);

/* Energy of one of the crop's samples that is `off` metres off, where all are; *less: how much of
 * its pull is left. */
double hand_fit_robust(const hand_crop *crop, double off, double *less);

/* The energy alone. */
void hand_fit_judge(hand_fit *fit, const hand_crop *crop, int32_t stride);

#endif
