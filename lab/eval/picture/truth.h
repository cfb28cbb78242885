/* What the colour camera ought to see. */
#ifndef RELIEF_APP_EVAL_PICTURE_TRUTH_H
#define RELIEF_APP_EVAL_PICTURE_TRUTH_H

#include "relief/io.h"

#define PICTURE_BODIES 20
#define PICTURE_SAMPLES 16 /* per pixel, in as many rows and columns */

/* Pixels that bodies cover whole, and what hides them. */
typedef struct picture_truth {
    rlf_camera camera;
    rlf_vec3 origin; /* of the colour camera in the depth camera's frame */
    int32_t *pixels; /* those measured */
    int32_t count;
    float *body_z;  /* [pixel][sample]; the last sample is the middle; 0 = no body */
    float *alpha;   /* [pixel] share of the body that shows, 0..1; -1 = not measured */
    float *gap;     /* [pixel] body's z minus the real one's in the middle, metres */
    uint8_t *label; /* [pixel] of what is there in the middle */
    uint8_t *band;  /* [pixel] 1 = within 9 pixels of an edge of alpha */
    uint8_t *close; /* [pixel] 1 = within 3 pixels */
    uint8_t *inner; /* [pixel] 1 = no pixel within 8 is unmeasured */
} picture_truth;

/* Boxes and balls all over the room that touch nothing that stands there now, every second one
 * partly hidden by it. */
rlf_result picture_place_bodies(uint64_t seed, rlf_source *source,
                                rlf_body_state bodies[PICTURE_BODIES], int32_t *out_count);
/* Somewhere in the room; advances *random. */
rlf_body_state picture_random_body(uint64_t *random);
/* True when it touches neither what stands there now nor one of the bodies. */
rlf_result picture_is_free(rlf_source *source, const rlf_body_state *bodies, int32_t count,
                           const rlf_body_state *body, bool *out);
/* t > 0 at which the ray origin + t d enters such a body; 0 = it does not. */
double picture_enter_body(const rlf_body_state *body, rlf_vec3 origin, rlf_vec3 d);
/* Unit, outward, at a point on its surface. */
rlf_vec3 picture_normal_of_body(const rlf_body_state *body, rlf_vec3 p);
rlf_result picture_truth_init(picture_truth *t, const rlf_rig *rig, const rlf_body_state *bodies,
                              int32_t body_count);
void picture_truth_finish(picture_truth *t);
/* The truth of the source's last frame. */
rlf_result picture_truth_update(picture_truth *t, rlf_source *source);

#endif
