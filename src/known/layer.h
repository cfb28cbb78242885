/* Models of real things as depth: the pixels of a camera that they cover, and their rims. Made anew
 * only when a model or the camera moved. */
#ifndef RLF_KNOWN_LAYER_H
#define RLF_KNOWN_LAYER_H

#include "relief/camera.h"
#include "relief/frame.h"
#include "relief/snapshot.h"

/* A pixel that a model covers, or that is just outside its silhouette, where sensors still show it.
 * Metres along the camera's z. */
typedef struct known_pixel {
    int32_t index, model;
    float ray_x, ray_y;
    float near, far; /* where its ray enters and leaves, at a rim that of the nearest covered one */
    float front;     /* what is sensed nearer than this stands before the model */
    int32_t beyond;  /* of a rim: farther out, where sensors no longer show the model */
} known_pixel;

/* What is sensed at the camera's pixels; the normals may be NULL. */
typedef struct known_seen {
    const float *depth;
    const float *normal_x, *normal_y, *normal_z;
} known_seen;

typedef struct known_layer {
    known_pixel *pixels;
    int32_t count, capacity;
    known_pixel *rims;
    int32_t rim_count, rim_capacity;

    rlf_camera camera;
    rlf_depth_noise noise;
    int32_t reach;        /* pixels that a sensor may be off at an edge */
    uint8_t *shown;       /* width * height, 1 where the last cover left a model's own depth */
    uint8_t *mask;        /* width * height, 0 between calls; one model at a time */
    rlf_body_state *made; /* the models it shows */
    int32_t made_count, made_capacity;
    rlf_pose made_T; /* T_camera_world */
} known_layer;

/* `depth` is the camera that senses, `camera` the one whose pixels are covered. */
rlf_result known_layer_create(const rlf_camera *camera, const rlf_camera *depth,
                              const rlf_depth_noise *noise, known_layer *out);
void known_layer_destroy(known_layer *layer);

/* Takes the models of a snapshot (NULL = none). Allocates when they cover more than ever before;
 * RLF_ERROR_MEMORY leaves the layer empty. */
rlf_result known_layer_place(known_layer *layer, const rlf_snapshot *snapshot,
                             const rlf_pose *T_camera_world);

/* Puts the models into a depth image of the camera, metres, 0 = missing: in place of what is sensed
 * on them, behind them, or not at all; not of what is sensed in front. Sets `shown`. */
void known_layer_cover(known_layer *layer, float *z);

/* Clears pixels of a depth image (to 0), and of `mask`, that show a model in `seen`; either may be
 * NULL. A sensed point shows a model when it lies on or in it, or near one of its faces and facing
 * the same way: the floor beside it stays. */
void known_layer_clear(const known_layer *layer, const known_seen *seen, float *depth,
                       uint8_t *mask);

#endif
