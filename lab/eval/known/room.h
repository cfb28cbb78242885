/* Models of known objects in the synthetic room: its three boxes. */
#ifndef RELIEF_APP_EVAL_KNOWN_ROOM_H
#define RELIEF_APP_EVAL_KNOWN_ROOM_H

#include "relief/io.h"

#define KNOWN_MODELS 3 /* the large box, the one on top of it, the small one */

/* The model over a box of the room, in its true pose. */
rlf_known_def known_true_model(int32_t index);

/* The empty room; is_lost: the sensor has no depth on the boxes, as on glass or black plastic.
 * Destroying the source destroys *out_room too, the synthetic source for questions about the truth.
 */
rlf_result known_open_room(int64_t seed, bool is_lost, rlf_source **out, rlf_source **out_room);

#endif
