/* Models of known objects in the synthetic room: its three boxes. */
#ifndef RELIEF_APP_EVAL_KNOWN_H
#define RELIEF_APP_EVAL_KNOWN_H

#include "eval/table.h"
#include "relief/io.h"
#include "relief/model.h"

#define KNOWN_MODELS 3 /* the large box, the one on top of it, the small one */
#define KNOWN_CHAIR_BODIES 4

/* known_room.c: the model over a box of the room, in its true pose. */
rlf_known_def known_true_model(int32_t index);

/* The empty room; is_lost: the sensor has no depth on the boxes, as on glass or black plastic.
 * Destroying the source destroys *out_room too, the synthetic source for questions about the truth.
 */
rlf_result known_open_room(int64_t seed, bool is_lost, rlf_source **out, rlf_source **out_room);

/* known_picture.c: bodies behind the boxes, with and without models. */
rlf_result known_run_picture(eval_table *table, int64_t seed,
                             const rlf_known_def models[KNOWN_MODELS]);
/* known_bounce.c: bodies thrown at the boxes from all around. */
rlf_result known_run_bounce(eval_table *table, int64_t seed,
                            const rlf_known_def models[KNOWN_MODELS]);

/* known_chair.c: the chair's triangles, in its true pose; rlf_model_destroy the model. */
rlf_result known_chair_create(rlf_model **out_model, rlf_known_def *out);
/* Bodies between its legs and slats and the wall. Returns their number. */
int32_t known_chair_place(rlf_body_state *bodies);

#endif
