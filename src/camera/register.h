/* Inside registration: what creation, the warp and the filling of holes share. */
#ifndef RLF_CAMERA_REGISTER_H
#define RLF_CAMERA_REGISTER_H

#include "camera/pixel_rect.h"
#include "kernel/kernel.h"
#include "relief/camera.h"

#define REGISTRATION_SHADOW 1.25f /* holes up to so many times the parallax are filled */

struct rlf_registration {
    int32_t width, height; /* of the depth grid */
    rlf_camera color;
    float *a, *b, *c;       /* see rlf_kernel_pinhole */
    ptrdiff_t row_a, row_c; /* from a row of a and of c to the next: 0 where all are alike, as with
                               cameras that look the same way; few tables are sooner read */
    rlf_kernel_pinhole pinhole;
    rlf_kernel_lens lens; /* du NULL = no distortion */
    float *size;          /* of each rectangle, over pinhole's; NULL = 1, lenses stretch nothing */
    float *row_top, *row_bottom; /* per depth row: nothing of it can land above or below these rows
                                    of the picture */
    float *column_low, *column_high; /* per depth column: columns of the picture that it lands
                                        between if it is endlessly far */
    double parallax_px_m;            /* pixels that things shift, times metres, at most */
    double least_c;                  /* 0: too little to tell how far anything shifts */
    double half_px;                  /* half the widest rectangle of what is endlessly far */
    int32_t *done; /* per depth row: rows of the picture before this one change no more after it */
    float shadow_px_m;  /* parallax along a fill line: pixels of shift times metres of depth */
    int32_t gap_px;     /* holes up to this are gaps between rectangles */
    bool fills_columns; /* the baseline is more vertical than horizontal */

    rlf_kernel_points points; /* work memory: one depth row */
    rlf_kernel_splat row;
    float *line; /* work memory: one picture row; RLF_KERNEL_NOTHING between uses */
};

/* Least and greatest offsets of a lens, pixels. */
typedef struct registration_shift {
    double u[2], v[2];
} registration_shift;

/* register_lens.c: the distortion of r->color as a table. */
rlf_result registration_make_lens(rlf_registration *r, registration_shift *shift);

/* register_size.c: r->size. Tables and rectangles must be there. */
rlf_result registration_make_sizes(rlf_registration *r);

/* register_window.c: column_low to half_px. Tables, rectangles and sizes must be there. */
void registration_make_columns(rlf_registration *r, const registration_shift *shift);
/* The part of the picture without which pixels of a window cannot be told: no depth is nearer than
 * `nearest` metres, 0 = not known. */
pixel_rect registration_widen(const rlf_registration *r, const pixel_rect *window, double nearest);
/* Columns [out[0], out[1]) of the depth grid, all that may land in columns x0 <= x < x1 of the
 * picture; out[1] <= out[0]: none. `nearest` as above. */
void registration_columns(const rlf_registration *r, int32_t x0, int32_t x1, double nearest,
                          int32_t out[2]);

/* register_warp.c: colour pixels of columns [x0, x1) of row y of the depth grid, into points, one
 * each from 0 on. */
void registration_project(const rlf_registration *r, const float *depth, int32_t y, int32_t x0,
                          int32_t x1, const rlf_kernel_points *points);

/* rlf_registration_apply for pixels in `wanted`: of the others nothing is known afterwards. No
 * depth is nearer than `nearest` metres; 0 = not known. */
void registration_apply_window(rlf_registration *r, const float *depth, const pixel_rect *wanted,
                               double nearest, const rlf_plane_f32 *out_depth,
                               const rlf_plane_u8 *out_state);

/* Where pixel i of the depth grid is in the picture if it is `z` metres away: (u, v), or a place
 * far outside when it cannot be seen. */
void registration_pixel(const rlf_registration *r, int32_t i, float z, float out[2]);

/* register_fill.c: gaps and parallax shadows, and their pixels' state, in a window that is all of
 * the picture where r->fills_columns. What is beyond its left and right ends is not looked at. */
void registration_fill_holes(const rlf_registration *r, const pixel_rect *window,
                             const rlf_plane_f32 *depth, const rlf_plane_u8 *state);

#endif
