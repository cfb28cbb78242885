/* The movers' shadow on the floor: each solid as a few balls, each ball as a soft ellipse. */
#ifndef RLF_CAPTURE_SYNTHETIC_SHADOW_H
#define RLF_CAPTURE_SYNTHETIC_SHADOW_H

#include "capture/synthetic/scene.h"
#include "capture/synthetic/view.h"

#define SYNTH_BLOB_MAX (6 * SYNTH_PART_MAX)

/* A soft ellipse on the floor, stretched away from the lamp. */
typedef struct synth_blob {
    float x, z;             /* centre, metres, depth camera frame */
    float along_x, along_z; /* unit vector of the long axis */
    float long_radius, short_radius;
    float strength; /* share of the lamp that is hidden at the centre */
} synth_blob;

typedef struct synth_shadow {
    synth_blob blobs[SYNTH_BLOB_MAX];
    int32_t blob_count;
    synth_rect rect; /* pixels that may be darker */
} synth_shadow;

/* Shadow of the scene's movers as seen by the view. */
void synth_shadow_place(synth_shadow *shadow, const synth_scene *scene, const synth_view *view);

/* Multiplies row y of an RGBA picture, columns of `rect`; lamp is the plane of synth_color_planes.
 */
void synth_shadow_apply(const synth_shadow *shadow, const synth_view *view, double floor_y,
                        int32_t y, const uint8_t *lamp, uint8_t *rgba);

#endif
