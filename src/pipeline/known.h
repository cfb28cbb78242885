/* Models of real things in the frame loop: their poses, their bodies, and the grid without what
 * they stand for. */
#ifndef RLF_PIPELINE_KNOWN_H
#define RLF_PIPELINE_KNOWN_H

#include "known/layer.h"
#include "relief/pipeline.h"

typedef struct known_models {
    rlf_known_def *defs;            /* RLF_KNOWN_MAX of them */
    rlf_body_id ids[RLF_KNOWN_MAX]; /* null while it waits for its pose */
    int32_t count;
    known_layer layer; /* at the grid's camera */
    float *depth;      /* the background without what models stand for */
    uint8_t *mask;     /* the foreground, alike */
    bool has_layer;
} known_models;

rlf_result known_models_create(const rlf_scene *scene, known_models *out);
void known_models_destroy(known_models *models);

/* Adds a model, or puts it in place of the one with its name. */
rlf_result known_models_put(known_models *models, const rlf_known_def *def, rlf_world *world);
/* Adds the bodies of models that have poses to an empty world. */
rlf_result known_models_start(known_models *models, rlf_world *world);
/* Finds the poses that wait for a frame. */
rlf_result known_models_solve(known_models *models, const rlf_known_view *view, rlf_world *world);

/* Takes out of the grid what the models stand for: they collide in its place. */
rlf_result known_models_clear_grid(known_models *models, const rlf_surface *surface,
                                   const rlf_snapshot *snapshot, rlf_grid *grid);

#endif
