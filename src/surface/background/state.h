/* The background model and the images that are published of it. */
#ifndef RLF_SURFACE_BACKGROUND_STATE_H
#define RLF_SURFACE_BACKGROUND_STATE_H

#include "surface/thickness/state.h"

/* What starts to move out of the background: see background/depart.c; NULL planes when things are
 * not known. */
typedef struct rlf_depart {
    uint8_t *thing; /* plane: of which of the background's things; 0 = of none */
    float *depth;   /* plane: of it as it stood */
    uint8_t *left;  /* plane: 1, or RLF_LEFT_AWAY, where the mean is of something that moves: no
                        background */
    rlf_rect extent[RLF_PIECES + 1]; /* of each thing, from 1 ... */
    int32_t size[RLF_PIECES + 1];    /* ... and its pixels */
    bool is_urgent;                  /* something has left in this frame */
} rlf_depart;

enum {
    RLF_LEFT_AWAY = 2,  /* in rlf_depart.left: what goes away from the camera */
    RLF_LEFT_WEIGHT = 2 /* samples of its mean: a mean of one has just been replaced */
};

/* How much of the room the newest frame shows: see background/sight.c. */
typedef struct rlf_sight {
    int64_t first_ns; /* of the first frame with any depth, if has_depth */
    int32_t seen;     /* pixels with depth of the newest frame */
    bool has_depth;
    bool is_warm;    /* the sensor has given depth for long enough to have started */
    bool has_room;   /* a frame has shown the room */
    bool is_blind;   /* the newest shows nothing, or hardly anything: nothing is learnt of it */
    bool shows_more; /* it shows much that the background is not known of */
} rlf_sight;

/* The background model. AVERAGE: mean holds sums until it is ready. */
typedef struct rlf_background {
    float *mean;
    float *deviation;     /* ADAPTIVE: mean absolute difference from the mean */
    uint8_t *weight;      /* samples in the mean */
    uint8_t *beyond;      /* ADAPTIVE: frames in a row that saw past the mean */
    uint8_t *absent;      /* ADAPTIVE: share of the frames without depth, of 255 */
    uint8_t *unknown_age; /* ADAPTIVE: frames in a row that a hole had a background sample */
    float *still;         /* ADAPTIVE: depth of what stands in front */
    uint16_t *still_ms;   /* ADAPTIVE: how long it has not moved */
    float *beneath;       /* ADAPTIVE: the background that an absorbed thing hides; 0 = none */
    rlf_span *standing;   /* ADAPTIVE: per row, where still_ms is not 0 */
    int32_t frames;
    int32_t *row_changes; /* ADAPTIVE: pixels replaced in this frame, per row and tile column */
    int32_t *changes;     /* per tile: pixels replaced since it was made */
    int32_t changed;      /* their sum */
    uint8_t *age;         /* per tile: frames since it was made of new pixels */
    uint8_t *is_better;   /* per tile: 1 when its means are better than when it was made */
    int32_t *version;     /* per tile: of the image that it was made for */
    int32_t next_version; /* of the next image */
    int32_t image_age;    /* frames since the newest image was finished */
    bool is_drafting;     /* the next image is being made, */
    bool is_made;         /* every tile of it is, */
    int32_t object_steps; /* and so many steps to its regions are done */
    rlf_background_state state;
    background_image images[BACKGROUND_IMAGES];
    int32_t newest;       /* image; -1 = none */
    bool is_stale;        /* the newest image shows a room that is gone */
    int32_t other_frames; /* ADAPTIVE: frames in a row that showed another room */
    static_thickness thick;
    rlf_depart depart;
    uint8_t *seen;    /* plane, scratch of background/adaptive.c */
    int32_t *up;      /* plane, scratch of background/hidden.c */
    uint8_t *covered; /* plane: RLF_COVERED where a hole is hidden by a thing */
    float *crop[6];   /* of background/image.c */
} rlf_background;

void background_allocate(rlf_background *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                         const image_grid *grid);

#endif
