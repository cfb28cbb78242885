/* The real depth that a picture's bodies are compared with, seen from the picture's camera. */
#ifndef RLF_ENVIRONMENT_REAL_DEPTH_H
#define RLF_ENVIRONMENT_REAL_DEPTH_H

#include "base/inside.h"
#include "known/layer.h"
#include "environment/lost_depth.h"
#include "environment/depth_tiles.h"
#include "environment/real_windows.h"
#include "environment/sight_change.h"

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

    sight_change sight; /* of what is remembered pixel by pixel while bodies are in the picture */
    bool has_moved;     /* by that: it is forgotten */

    depth_tiles seen; /* of the surface, as it was last read */
    lost_depth lost;  /* not uses_frame only */
    rlf_pool *pool;

    known_layer known;  /* models of real things: they are put into z, */
    known_layer sensed; /* and into input where nothing is sensed */
    rlf_pose T_picture_depth;
} real_depth;

/* What there is of the real room at a time; all is borrowed. */
typedef struct observation {
    const rlf_frame *frame;
    const rlf_surface *surface;
    const rlf_snapshot *snapshot; /* for models of real things; NULL = none */
    rlf_pose T_world_camera;
} observation;

typedef struct real_depth_def {
    const rlf_rig *rig;
    rlf_camera grid;            /* of the surface */
    const float *ray_x, *ray_y; /* as rlf_surface has them */
    rlf_camera picture;
    rlf_pose T_picture_depth;
    rlf_pool *pool; /* borrowed; NULL = none */
} real_depth_def;

/* Allocates everything. RLF_ERROR_MEMORY. */
rlf_result real_depth_create(const real_depth_def *def, real_depth *out)
    RLF_INSIDE(real_depth_create);
/* As edge_matte_update's `known`. */
const known_layer *real_depth_known(const real_depth *real) RLF_INSIDE(real_depth_known);
void real_depth_destroy(real_depth *real) RLF_INSIDE(real_depth_destroy);
/* Reads the depth that is to be registered, and fills `seen`. */
void real_depth_read(real_depth *real, const observation *now) RLF_INSIDE(real_depth_read);
/* Fills windows of z with what was read last; of other pixels nothing is known. Pixels without
 * depth take the background's, when the surface knows it; with `bodies` what is around them and
 * what the picture shows decides (lost_depth.h), and has_moved says whether the matte is to forget.
 * Models of real things take their place. RLF_ERROR_MEMORY as known_layer_place. */
rlf_result real_depth_update(real_depth *real, const observation *now, const edge_matte *bodies,
                             const real_windows *needed) RLF_INSIDE(real_depth_update);

#endif
