/* Inside registration: what creation, the warp and the filling of holes share. */
#ifndef RLF_CAMERA_REGISTER_H
#define RLF_CAMERA_REGISTER_H

#include "kernel/kernel.h"
#include "relief/camera.h"

struct rlf_registration {
    int32_t width, height; /* of the depth grid */
    rlf_camera color;
    float *a, *b, *c; /* see rlf_kernel_pinhole */
    rlf_kernel_pinhole pinhole;
    rlf_kernel_lens lens; /* du NULL = no distortion */
    float *size;          /* of each rectangle, over pinhole's; NULL = 1, lenses stretch nothing */
    float *row_top, *row_bottom; /* per depth row: nothing of it can land above or below these rows
                                    of the picture */
    int32_t *done; /* per depth row: rows of the picture before this one change no more after it */
    float shadow_px_m;  /* parallax along a fill line: pixels of shift times metres of depth */
    int32_t gap_px;     /* holes up to this are gaps between rectangles */
    bool fills_columns; /* the baseline is more vertical than horizontal */

    rlf_kernel_points points; /* work memory: one depth row */
    rlf_kernel_splat row;
    float *line; /* work memory: one picture row; RLF_KERNEL_NOTHING between uses */
};

/* register_lens.c: the distortion of r->color as a table; shift: least and greatest of dv. */
rlf_result registration_make_lens(rlf_registration *r, double shift[2]);

/* register_size.c: r->size. Tables and rectangles must be there. */
rlf_result registration_make_sizes(rlf_registration *r);

/* register_warp.c: colour pixels of row y of the depth grid, into r->points. */
void registration_project(rlf_registration *r, const float *depth, int32_t y);

/* Where pixel i of the depth grid is in the picture if it is `z` metres away: (u, v), or a place
 * far outside when it cannot be seen. */
void registration_pixel(const rlf_registration *r, int32_t i, float z, float out[2]);

/* register_fill.c: gaps and parallax shadows of rows [begin, end), which are all of them where
 * r->fills_columns, and their pixels' state. */
void registration_fill_holes(const rlf_registration *r, int32_t begin, int32_t end,
                             const rlf_plane_f32 *depth, const rlf_plane_u8 *state);

#endif
