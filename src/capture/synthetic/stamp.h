/* Draws the movers into a picture's depth buffer: each solid is cast only inside the rectangle it
 * projects to, row by row, in single precision, in loops without branches that compilers turn into
 * vector code. */
#ifndef RLF_CAPTURE_SYNTHETIC_STAMP_H
#define RLF_CAPTURE_SYNTHETIC_STAMP_H

#include "capture/synthetic/scene.h"
#include "capture/synthetic/view.h"

/* A mover prepared for one view. The solid is seen in coordinates q = A (p - p0) in which it is a
 * unit sphere (ellipsoid) or has its own size (box, cone). */
typedef struct synth_stamp {
    synth_shape_type type;
    synth_rect rect;
    double A[3][3];
    double offset[3]; /* A (p0 - view origin) */
    double z0;        /* a depth near the solid: rays are measured from there, for precision */
    float half[3];    /* box: half extents; ellipsoid: radii */
    float sine, cosine2, length, radius_a, radius_b;
} synth_stamp;

typedef struct synth_canvas {
    synth_view view;
    float *z;      /* depth of the nearest surface; valid inside `drawn` */
    int32_t *part; /* index of the mover seen, or -1; valid inside `drawn` */
    synth_stamp stamps[SYNTH_PART_MAX];
    int32_t stamp_count;
    synth_rect drawn; /* union of all rectangles */
} synth_canvas;

rlf_result synth_canvas_create(synth_canvas *canvas, const synth_view *view);
void synth_canvas_destroy(synth_canvas *canvas);

/* Prepares the scene's movers: rectangles and coordinates. */
void synth_canvas_place(synth_canvas *canvas, const synth_scene *scene);

/* Draws row y inside `drawn`, in front of the static room's depth (a whole picture). */
void synth_canvas_draw_row(synth_canvas *canvas, const float *static_z, int32_t y);

/* Point of a stamp's surface at pixel (x, y) and depth z. */
typedef struct synth_touch {
    float p[3];      /* camera frame of the depth camera */
    float normal[3]; /* outward, unit */
    float local[3];  /* in the shape's own frame */
} synth_touch;

synth_touch synth_stamp_touch(const synth_stamp *stamp, const synth_view *view, int32_t x,
                              int32_t y, float z);

#endif
