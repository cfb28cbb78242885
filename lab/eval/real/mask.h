/* Masks compared: overlap, distances of outlines, blots. Planes have width * height bytes. */
#ifndef RELIEF_APP_EVAL_REAL_MASK_H
#define RELIEF_APP_EVAL_REAL_MASK_H

#include "eval/measures/foreground.h"

#define REAL_INSIDE 255
#define REAL_UNJUDGED 128
#define REAL_FAR_PX 100.0 /* distances of outlines are no more than this */
#define REAL_BLOT_PX 3    /* what is nearer to the true outline is an error of the outline */

/* Sums over pictures. */
typedef struct real_mask_errors {
    eval_confusion pixels;
    int64_t bins[(int)REAL_FAR_PX * 4 + 1]; /* distances, 1/4 pixel each */
    int64_t distance_count;
    double distance_sum;
    int64_t pictures;
    int64_t blot_inside_sum, blot_inside_max; /* pixels of each picture's largest */
    int64_t blot_outside_sum, blot_outside_max;
} real_mask_errors;

/* Work memory for one picture size. */
typedef struct real_mask_work {
    int32_t width, height;
    uint8_t *outline[2], *flag;
    int32_t *column[2]; /* rows to the nearest outline pixel of the same column */
    int32_t *stack;
} real_mask_work;

rlf_result real_mask_work_init(real_mask_work *w, int32_t width, int32_t height);
void real_mask_work_finish(real_mask_work *w);

/* `found` is a mask of 0 and 1; `truth` has REAL_INSIDE, 0, and REAL_UNJUDGED where nothing is
 * counted. Outlines are compared both ways, pixel by pixel: the nearest of the other one. */
void real_mask_add(real_mask_errors *e, real_mask_work *w, const uint8_t *found,
                   const uint8_t *truth);
double real_mask_iou(const real_mask_errors *e);
double real_mask_distance_mean(const real_mask_errors *e);
double real_mask_distance_p95(const real_mask_errors *e);

/* Grows the mask by 4 pixels every way, in place; `scratch` is a plane. */
void real_mask_grow(uint8_t *mask, int32_t width, int32_t height, uint8_t *scratch);
/* Square closing, 9 x 9, in place; `scratch` is a plane. */
void real_mask_close(uint8_t *mask, int32_t width, int32_t height, uint8_t *scratch);
/* Pixels of the largest 4-connected component of 1s; the mask is 0 afterwards. `stack` has an entry
 * per pixel. */
int64_t real_mask_largest(uint8_t *mask, int32_t width, int32_t height, int32_t *stack);

#endif
