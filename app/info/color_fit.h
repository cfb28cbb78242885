/* How well the colour picture fits the depth: depth edges, projected into the colour picture, are
 * looked for among its edges. */
#ifndef RELIEF_APP_INFO_COLOR_FIT_H
#define RELIEF_APP_INFO_COLOR_FIT_H

#include "relief/frame.h"

typedef struct color_fit color_fit;

/* One direction of the offset, colour pixels. */
typedef struct color_fit_axis {
    double
        offset; /* > 0: the colour picture is that far to the right (down) of where it should be */
    double error;    /* standard error of the offset */
    double widening; /* depth's edges lie that far outside those of colour, on each side */
} color_fit_axis;

typedef struct color_fit_result {
    int64_t edges; /* edge points used, both directions */
    int32_t frames;
    bool is_known; /* enough edges, and they agree */
    double pixel;  /* colour pixels that one depth pixel covers, at least 1 */
    color_fit_axis x, y;
    /* The same from the nearer and the farther half of the edges alone; a transform that is missing
     * or wrong makes them differ. NAN = not known. */
    double near_x, far_x, near_y, far_y;
} color_fit_result;

/* NULL without memory. The rig must have colour. */
color_fit *color_fit_create(const rlf_rig *rig);
void color_fit_destroy(color_fit **fit);
/* Adds one frame: depth in metres, 0 = missing, rows without padding. */
void color_fit_add(color_fit *fit, const float *depth, const rlf_image_rgba8 *color);
void color_fit_get(const color_fit *fit, color_fit_result *out);

/* Length of the offset, colour pixels. */
double color_fit_length(const color_fit_result *r);
/* Whether colour is off by more than a pixel of the coarser picture, beyond doubt. */
bool color_fit_is_off(const color_fit_result *r);

#endif
