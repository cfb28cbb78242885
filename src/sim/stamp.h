/* Draws the movers into a picture's depth buffer: each solid is cast only inside the rectangle it
 * projects to, row by row, in single precision, in loops without branches that compilers turn into
 * vector code. */
#ifndef RLF_SIM_STAMP_H
#define RLF_SIM_STAMP_H

#include "sim/scene.h"
#include "sim/view.h"

/* A mover prepared for one view. The solid is seen in coordinates q = A (p - p0) in which it is a
 * unit sphere (ellipsoid) or has its own size (box, cone, frustum). */
typedef struct synth_stamp {
    synth_shape_type type;
    synth_rect rect;
    double A[3][3];
    double offset[3]; /* A (p0 - view origin) */
    double z0;        /* a depth near the solid: rays are measured from there, for precision */
    float half[3];    /* box: half extents; ellipsoid: radii */
    float sine, cosine2, length, radius_a, radius_b; /* frustum: sine is its slope */
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

/* Pixels x0 <= x < x1 of a row that show one stamp. */
typedef struct synth_run {
    int32_t id, x0, x1;
} synth_run;

#define SYNTH_RUN_MOST 64 /* pixels */

/* The next run of row y from column x on, of SYNTH_RUN_MOST pixels at most; false when none is left
 * in `drawn`. */
bool synth_canvas_next_run(const synth_canvas *canvas, int32_t x, int32_t y, synth_run *out);

/* Points of a stamp's surface at the pixels of a run. Kernels work on whole lanes: what is beyond
 * the last pixel are numbers of no use. */
typedef struct synth_touches {
    float p[3][SYNTH_RUN_MOST];      /* camera frame of the depth camera */
    float normal[3][SYNTH_RUN_MOST]; /* outward, unit */
    float local[3][SYNTH_RUN_MOST];  /* in the shape's own frame */
} synth_touches;

/* touch.c: at the depths that the canvas has there. */
void synth_canvas_touch(const synth_canvas *canvas, const synth_run *run, int32_t y,
                        synth_touches *out);

/* ---- shadow.c: the movers' shadow on the floor: each solid as a few balls, each ball as a soft
 * ellipse. */

#define SYNTH_BLOB_MAX (6 * SYNTH_PART_MAX)

/* A soft ellipse on the floor, stretched away from the lamp. */
typedef struct synth_blob {
    float x, z;             /* centre, metres, depth camera frame */
    float along_x, along_z; /* unit vector of the long axis */
    float long_radius, short_radius;
    float strength;  /* share of the lamp that is hidden at the centre */
    synth_rect rect; /* pixels that may show it: tilted cameras */
} synth_blob;

typedef struct synth_shadow {
    synth_blob blobs[SYNTH_BLOB_MAX];
    int32_t blob_count;
    synth_rect rect; /* pixels that may be darker */
    bool is_tilted;  /* the camera of a random room: blobs are in its level frame */
    rlf_quat q_level_camera;
} synth_shadow;

/* Shadow of the scene's movers as seen by the view. */
void synth_shadow_place(synth_shadow *shadow, const synth_scene *scene, const synth_view *view);

/* shadow_tilted.c: the same for a camera that is not level. Pixels that may show the blob, and the
 * light that is left in row y, columns of shadow->rect. */
synth_rect synth_shadow_rect(const synth_shadow *shadow, const synth_blob *blob,
                             const synth_view *view, double floor_y);
void synth_shadow_dim(const synth_shadow *shadow, const synth_view *view, double floor_y, int32_t y,
                      float *light);

/* Multiplies row y of an RGBA picture, columns of `rect`; lamp is the plane of synth_color_planes.
 */
void synth_shadow_apply(const synth_shadow *shadow, const synth_view *view, double floor_y,
                        int32_t y, const uint8_t *lamp, uint8_t *rgba);

#endif
