/* The synthetic chair as a known thing. */
#ifndef RELIEF_APP_EVAL_KNOWN_CHAIR_H
#define RELIEF_APP_EVAL_KNOWN_CHAIR_H

#include "relief/known.h"
#include "relief/model.h"

#define KNOWN_CHAIR_BODIES 4

/* The chair's triangles, in its true pose; rlf_model_destroy the model. */
rlf_result known_chair_create(rlf_model **out_model, rlf_known_def *out);
/* Bodies between its legs and slats and the wall. Returns their number. */
int32_t known_chair_place(rlf_body_state *bodies);

#endif
