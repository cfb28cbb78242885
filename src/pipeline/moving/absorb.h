/* What was put down becomes the room: foreground that has stood still for so long is fused. */
#ifndef RELIEF_PIPELINE_ABSORB_H
#define RELIEF_PIPELINE_ABSORB_H

#include "relief/surface.h"

enum { ABSORB_THINGS = 64, ABSORB_LABELS = 64 };

/* A region of the front sheet that stands still. */
typedef struct absorb_thing {
    rlf_vec3 place; /* of its centroid when it was first seen there; world, metres */
    double radius;  /* half of its box's diagonal */
    int64_t since_ns, seen_ns;
} absorb_thing;

/* A zeroed one is as at the start. */
typedef struct absorb {
    absorb_thing thing[ABSORB_THINGS];
    int32_t thing_count;
    int32_t label[ABSORB_LABELS]; /* of this frame's regions that are room now */
    int32_t label_count;
} absorb;

/* One frame: what has stood for after_s where it stands, and parts of that, is room. after_s <= 0:
 * nothing ever is. */
void absorb_update(absorb *a, const rlf_surface *surface, const rlf_pose *T_world_camera,
                   double after_s);
/* Whether region `label` of that frame is room now. */
bool absorb_is_room(const absorb *a, int32_t label);

#endif
