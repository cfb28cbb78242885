/* Plots of a calibration as SVG inside a page. */
#ifndef RELIEF_APP_CALIBRATE_SVG_H
#define RELIEF_APP_CALIBRATE_SVG_H

#include "calibrate/calibrate.h"

#include <stdio.h>

/* Where one camera's picture has corners; empty cells are shaded. */
void svg_coverage(FILE *out, const calibration *c, int camera);
/* Each corner's error as a line, many times as long; and all errors about one point. */
void svg_residuals(FILE *out, const calibration *c, int camera);
void svg_scatter(FILE *out, const calibration *c, int camera);
/* Which way the boards faced: the tilt of each in degrees to the right and down. */
void svg_tilts(FILE *out, const calibration *c);

#endif
