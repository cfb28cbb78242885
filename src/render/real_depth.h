/* The real depth that a picture's bodies are compared with, seen from the picture's camera. */
#ifndef RLF_RENDER_REAL_DEPTH_H
#define RLF_RENDER_REAL_DEPTH_H

#include "base/inside.h"
#include "known/layer.h"
#include "relief/compositor.h"
#include "render/lost_depth.h"
#include "render/real_shade.h"
#include "render/real_windows.h"

typedef struct real_depth {
    rlf_registration *registration;
    float *input;    /* what is registered: the surface's size, or the frame's for coarse ones */
    float nearest;   /* no depth of it is nearer, metres; 0 = not known */
    rlf_plane_f32 z; /* metres along the picture camera's z; 0 = unknown */

    /* A surface that keeps every n-th pixel is too coarse to cut bodies along a silhouette; then
     * the frame's own depth is registered, as in the thesis (4.2.2). */
    bool uses_frame;
    int32_t width, height; /* of input */
    float *ray_x, *ray_y;  /* uses_frame only */
    uint8_t *is_in_lens;   /* uses_frame only */

    real_shade_grid seen; /* of the surface, as it was last read */
    lost_depth lost;      /* not uses_frame only */
    rlf_pool *pool;

    known_layer known;  /* models of real things: they are put into z, */
    known_layer sensed; /* and into input where nothing is sensed */
    rlf_pose T_picture_depth;
} real_depth;

/* Camera that a def's picture is drawn with, and its pose: the colour camera's or, without one, the
 * depth camera's, resized to the def's picture. */
rlf_camera real_depth_picture_camera(const rlf_compositor_def *def)
    RLF_INSIDE(real_depth_picture_camera);
rlf_pose real_depth_picture_pose(const rlf_compositor_def *def)
    RLF_INSIDE(real_depth_picture_pose); /* T_picture_depth */

/* `camera` is the picture's. Allocates everything. */
rlf_result real_depth_create(const rlf_compositor_def *def, const rlf_camera *camera,
                             real_depth *out) RLF_INSIDE(real_depth_create);
/* As silhouette_update's `known`. */
const known_layer *real_depth_known(const real_depth *real) RLF_INSIDE(real_depth_known);
void real_depth_destroy(real_depth *real) RLF_INSIDE(real_depth_destroy);
/* Reads the depth that is to be registered, and fills `seen`. */
void real_depth_read(real_depth *real, const rlf_render_input *input) RLF_INSIDE(real_depth_read);
/* Fills windows of z with what was read last; of other pixels nothing is known. Pixels without
 * depth take the background's, when the surface knows it; `settles`: what is around them and what
 * the picture shows decides (lost_depth.h). Models of real things take their place.
 * RLF_ERROR_MEMORY as known_layer_place. */
rlf_result real_depth_update(real_depth *real, const rlf_render_input *input,
                             const silhouette *bodies, const real_windows *needed)
    RLF_INSIDE(real_depth_update);

#endif
