/* Where a body is that is drawn as a model, for both renderers. */
#ifndef RLF_RENDER_BODY_LOOK_H
#define RLF_RENDER_BODY_LOOK_H

#include "relief/model.h"
#include "relief/snapshot.h"

/* Body frame, metres. */
static inline rlf_vec3 body_look_point(const rlf_look *look, const rlf_model_vertex *v)
{
    rlf_vec3 p = {(double)v->position[0], (double)v->position[1], (double)v->position[2]};
    return rlf_mad(look->offset, p, look->scale);
}

/* Largest distance from the body's origin to what is drawn of it. */
static inline double body_look_radius(const rlf_body_state *body)
{
    const rlf_look *look = &body->look;
    return look->model != NULL ? look->scale * look->model->radius + rlf_length(look->offset)
                               : rlf_shape_radius(&body->shape);
}

#endif
