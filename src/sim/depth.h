/* The depth camera: true depth of the room, the movers drawn into it, and the noise on top. */
#ifndef RLF_SIM_DEPTH_H
#define RLF_SIM_DEPTH_H

#include "sim/cast.h"
#include "sim/noise.h"
#include "sim/stamp.h"

/* Planes of one state of the room, or of the frame being made. The truth planes are NULL when no
 * truth is asked for. */
typedef struct synth_depth_planes {
    float *z;
    float *sigma;
    float *margin;
    uint8_t *jump;
    float *normal[3];
    float *thickness;
    int32_t *label;
} synth_depth_planes;

typedef struct synth_depth {
    synth_view view;
    synth_noise noise;
    rlf_pool *pool;
    float *vignette;
    synth_depth_planes room[2]; /* before and after something was taken away; [1] may be empty */
    int32_t room_index;         /* of the state that `now` shows; -1 = none yet */
    synth_depth_planes now;
    uint8_t *foreground; /* truth that only movers have; zero elsewhere */
    float *velocity[3];
    uint16_t *out; /* millimetres */
    synth_canvas canvas;
    synth_rect dirty;         /* where `now` differs from the room */
    bool has_truth;           /* the frame's truth planes are made */
    int32_t truth_room_index; /* of the state that they show; -1 = none yet */
    synth_rect truth_dirty;   /* where they differ from the room */
    const synth_scene *scene;
    uint32_t frame;
} synth_depth;

static inline bool synth_depth_is_stereo(const synth_depth *depth)
{
    return depth->noise.drawn != NULL && depth->noise.drawn->kind == SYNTH_STEREO;
}

/* `depth` is zeroed, with view, noise and pool set. Casts the room. */
rlf_result synth_depth_create(synth_depth *depth, const synth_scene *scene, bool enable_truth);
/* Casts that state of the room anew, for a camera that has moved. */
void synth_depth_cast_room(synth_depth *depth, int32_t state);
void synth_depth_destroy(synth_depth *depth);

/* Makes the frame of the scene as it stands now; room_index says which state of the room. */
void synth_depth_render(synth_depth *depth, uint32_t frame, int32_t room_index);

/* depth_truth.c: the truth planes of that frame, made when they are asked for: cameras know none.
 */
void synth_depth_find_truth(synth_depth *depth);

#endif
