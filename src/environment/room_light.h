/* How bright the bodies are beside the camera's picture. */
#ifndef RLF_ENVIRONMENT_ROOM_LIGHT_H
#define RLF_ENVIRONMENT_ROOM_LIGHT_H

#include "base/inside.h"
#include "relief/frame.h"

typedef struct room_light {
    float level[3];    /* mean of the picture over that of a well lit room, per channel; smoothed */
    uint64_t sequence; /* of the last frame taken in */
    bool is_known;
    float color[3]; /* of the bodies: the one that is given, and the level when it is estimated */
} room_light;

/* Takes a frame in, and sets color. Frames without colour, and one that was taken in already,
 * change no level. */
void room_light_update(room_light *l, const float given[3], bool is_estimated,
                       const rlf_frame *frame) RLF_INSIDE(room_light_update);

#endif
