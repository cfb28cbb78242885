/* The colour camera: a picture of the room, lit once, and the movers painted into it. */
#ifndef RLF_SIM_COLOR_H
#define RLF_SIM_COLOR_H

#include "sim/cast.h"
#include "sim/material.h"
#include "sim/stamp.h"

/* One state of the room. */
typedef struct synth_color_planes {
    uint8_t *rgba;
    uint8_t *front; /* RGBA of what the pixel's middle sees, without what an edge mixes in */
    float *z;
    uint8_t *lamp; /* floor: share of its light that comes from the lamp, 255 = all; else 0 */
} synth_color_planes;

typedef struct synth_color {
    synth_view view;
    rlf_pool *pool;
    uint8_t gamma[SYNTH_GAMMA_SIZE];
    synth_color_planes room[2];
    int32_t room_index; /* of the state that `out` shows; -1 = none yet */
    uint8_t *paint;     /* RGBA of the movers inside the canvas's rectangle */
    uint8_t *out;
    synth_canvas canvas;
    synth_shadow shadow;
    synth_rect dirty; /* where `out` differs from the room */
    const synth_scene *scene;
    bool is_coarse;     /* what is cast is */
    int32_t right_rows; /* of tiles, from above: as they should be */
} synth_color;

/* `color` is zeroed, with view, pool and is_coarse set. Casts and lights the room. */
rlf_result synth_color_create(synth_color *color, const synth_scene *scene);
/* Casts that state of the room anew, for a camera that has moved. */
void synth_color_cast_room(synth_color *color, int32_t state);
/* Makes a row of tiles right that is coarse yet, if there is one: before a frame. */
void synth_color_sharpen(synth_color *color);
void synth_color_destroy(synth_color *color);

/* Paints the scene as it stands now; room_index says which state of the room. */
void synth_color_render(synth_color *color, int32_t room_index);

#endif
