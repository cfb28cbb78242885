/* Models of real things as depth: the pixels of a camera that they cover, and their rims. Made anew
 * only when a model or the camera moved. */
#ifndef RLF_KNOWN_LAYER_H
#define RLF_KNOWN_LAYER_H

#include "camera/pixel_rect.h"
#include "known/mesh.h"
#include "relief/camera.h"
#include "relief/frame.h"
#include "relief/snapshot.h"

/* A pixel that a model covers. Metres along the camera's z. */
typedef struct known_pixel {
    int32_t index, model;
    float ray_x, ray_y;
    float near, far; /* where its ray enters and leaves */
    float front;     /* what is sensed nearer than this stands before the model */
    float tolerance; /* what is sensed so near to the model is the model */
} known_pixel;

/* A pixel just outside a model's silhouette, where sensors still show it, or its last one. */
typedef struct known_rim {
    known_pixel pixel;       /* depths are those of the nearest covered one */
    int32_t beyond, farther; /* pixels farther out, where sensors no longer show the model */
    float steps;             /* from beyond back to it, of those from farther to beyond */
} known_rim;

/* A pixel that a model's silhouette cuts. */
typedef struct known_edge {
    int32_t index;
    int32_t outside;   /* itself or one next to it, whose middle the model does not cover */
    float near, front; /* as a pixel's */
    uint8_t share;     /* that the model covers, 255 = all */
} known_edge;

/* What is sensed at the camera's pixels; the normals may be NULL. */
typedef struct known_seen {
    const float *depth;
    const float *normal_x, *normal_y, *normal_z;
} known_seen;

typedef struct known_layer {
    known_pixel *pixels;
    int32_t count, capacity;
    known_rim *rims;
    int32_t rim_count, rim_capacity;
    known_edge *edges;
    int32_t edge_count, edge_capacity;

    rlf_camera camera;
    rlf_depth_noise noise;
    int32_t reach;       /* pixels that a sensor may be off at an edge */
    uint8_t *shown;      /* width * height, 1 where the last cover left a model's own depth */
    int32_t *at;         /* width * height, 0 between calls: one model's pixels, counted from 1 */
    float *nearest;      /* width * height, metres: the nearest model's front, 0 = none */
    known_mesh **meshes; /* of all models that it ever showed, by their ids */
    int32_t mesh_count, mesh_capacity;
    rlf_body_state *made; /* the models it shows */
    int32_t made_count, made_capacity;
    rlf_pose made_T; /* T_camera_world */
    int64_t version; /* counts up when it is made anew */
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

/* Puts the models into a depth image where nothing is sensed. */
void known_layer_fill(const known_layer *layer, float *z);

/* Clears pixels of a depth image (to 0), and of `mask`, that show a model in `seen`; either may be
 * NULL. A sensed point shows a model when it lies on or in it, or near one of its faces and facing
 * the same way: the floor beside it stays. */
void known_layer_clear(const known_layer *layer, const known_seen *seen, float *depth,
                       uint8_t *mask);

/* ---- silhouette.c: parts of making a layer: what is beside a model's silhouette, and how much
 * of a pixel it covers. */

/* The array with room for `more` further entries: it may move. NULL when there is no memory; the
 * old one is then still there. */
void *known_reserve(void *array, int32_t count, int32_t more, int32_t *capacity, size_t size);

/* Both of the model whose pixels are in `at`, all of them within the rectangle. False when there is
 * no memory. */
bool known_add_rims(known_layer *layer, pixel_rect r);
bool known_add_edges(known_layer *layer, const known_form *form, pixel_rect r);

#endif
