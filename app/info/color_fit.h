/* How well the colour picture fits the depth: depth edges, projected into the colour picture, are
 * looked for among its edges. */
#ifndef RELIEF_APP_INFO_COLOR_FIT_H
#define RELIEF_APP_INFO_COLOR_FIT_H

#include "relief/frame.h"

/* How far off edges are looked for: pixels of the coarser picture. */
#define COLOR_FIT_REACH 16.0

typedef struct color_fit color_fit;

/* Lengths in colour pixels. */
typedef struct color_fit_result {
    int64_t edges; /* edge points used */
    int32_t frames;
    bool is_known;    /* enough edges, and they agree */
    bool is_far_only; /* the farther half of them alone does, and what follows is of it */
    double pixel;     /* what one depth pixel covers, at least 1 */
    double x, y;      /* the colour picture is that far right and down of where it should be */
    double error_x, error_y; /* standard errors of it */
    double widening;         /* depth's edges lie that far outside those of colour, on each side */
    /* The same from the nearer and the farther half of the edges alone; a transform that is missing
     * or wrong makes them differ. NAN = not known. */
    double near_x, near_y, far_x, far_y;
    double apart_x, apart_y; /* standard errors of near minus far */
} color_fit_result;

/* NULL without memory. The rig must have colour. */
color_fit *color_fit_create(const rlf_rig *rig);
void color_fit_destroy(color_fit **fit);
/* Adds one frame: depth in metres, 0 = missing, rows without padding. */
void color_fit_add(color_fit *fit, const float *depth, const rlf_image_rgba8 *color);
void color_fit_get(const color_fit *fit, color_fit_result *out);

/* Length of the offset and its error. */
double color_fit_length(const color_fit_result *r);
double color_fit_error(const color_fit_result *r);
/* Whether colour is off by more than a pixel of the coarser picture, beyond doubt. */
bool color_fit_is_off(const color_fit_result *r);
/* Near and far things are off by more than two pixels' difference, beyond doubt: the parallax is
 * not what the transform says. */
bool color_fit_is_parallax_wrong(const color_fit_result *r);

#endif
