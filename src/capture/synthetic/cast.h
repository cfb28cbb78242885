/* Casts rays at the static room, with a short list of candidates per tile of the picture. */
#ifndef RLF_CAPTURE_SYNTHETIC_CAST_H
#define RLF_CAPTURE_SYNTHETIC_CAST_H

#include "capture/synthetic/scene.h"
#include "capture/synthetic/view.h"

#define SYNTH_TILE 16 /* pixels */

/* Indices of the parts that some rays may hit. */
typedef struct synth_candidates {
    int32_t index[SYNTH_PART_MAX];
    int32_t count;
} synth_candidates;

/* What a ray hits first. */
typedef struct synth_hit {
    int32_t part; /* index into scene->statics; -1 = nothing */
    double t;
} synth_hit;

/* Candidates among the first `count` static parts for the tile whose first pixel is (x, y). */
void synth_tile_candidates(const synth_scene *scene, int32_t count, const synth_view *view,
                           synth_rect tile, synth_candidates *out);

synth_hit synth_cast(const synth_scene *scene, const synth_candidates *candidates,
                     const synth_ray *ray);

/* Where the ray leaves the object with this label that it entered at t: the end of the chain of
 * overlapping intervals of its parts, of which the candidates name those that the ray may hit. */
double synth_exit(const synth_part *parts, const synth_candidates *candidates, int32_t label,
                  const synth_ray *ray, double t);

#endif
