/* Casts rays at the static room, with a short list of candidates per tile of the picture. */
#ifndef RLF_SIM_CAST_H
#define RLF_SIM_CAST_H

#include "sim/scene.h"
#include "sim/view.h"

#define SYNTH_TILE 16 /* pixels */

/* A part as it is seen from where all rays of a view begin. */
typedef struct synth_candidate {
    int32_t part;    /* index into scene->statics */
    bool is_plane;   /* a half space, which has no ball about it */
    rlf_vec3 origin; /* of the rays, in the shape's frame */
    rlf_vec3 centre; /* of the ball about the part, from the rays' origin; a plane's way in */
    double beyond2;  /* squared distance of the ball's outline; < 0: the rays begin within */
    double reach;    /* radius of the ball times the longest direction of the tile */
} synth_candidate;

/* The parts that some rays may hit, in the order of their indices. */
typedef struct synth_candidates {
    synth_candidate of[SYNTH_PART_MAX];
    int32_t count;
    int32_t last; /* the one that was hit last: likely the next one, too */
} synth_candidates;

/* What a ray hits first. */
typedef struct synth_hit {
    int32_t part; /* index into scene->statics; -1 = nothing */
    double t;
} synth_hit;

/* Candidates among the first `count` static parts for the tile whose first pixel is (x, y). */
void synth_tile_candidates(const synth_scene *scene, int32_t count, const synth_view *view,
                           synth_rect tile, synth_candidates *out);

/* The ray begins at the view's origin. */
synth_hit synth_cast(const synth_scene *scene, synth_candidates *candidates, const synth_ray *ray);

/* Where the ray leaves the object with this label that it entered at t: the end of the chain of
 * overlapping intervals of its parts, of which the candidates name those that the ray may hit. */
double synth_exit(const synth_part *parts, const synth_candidates *candidates, int32_t label,
                  const synth_ray *ray, double t);

#endif
