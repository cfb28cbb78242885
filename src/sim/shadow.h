/* The movers' shadow on the floor: each solid as a few balls, each ball as a soft ellipse. */
#ifndef RLF_SIM_SHADOW_H
#define RLF_SIM_SHADOW_H

#include "sim/scene.h"
#include "sim/view.h"

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
