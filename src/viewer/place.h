/* Placing models over real things in the window: points picked one after the other, a pose from
 * them, and nudges. Knows no window, so that tests can drive it. */
#ifndef RLF_VIEWER_PLACE_H
#define RLF_VIEWER_PLACE_H

#include "relief/pipeline.h"

#define VIEWER_PLACE_TEXT 160

typedef struct viewer_place {
    bool is_on;
    int32_t object;    /* of the pipeline's list */
    int32_t next;      /* point to pick now, in the order of the shape's points */
    rlf_known_def def; /* that object, with the points picked so far */
} viewer_place;

/* What the user did. */
typedef enum viewer_place_action {
    VIEWER_PLACE_NEXT_OBJECT,
    VIEWER_PLACE_SKIP, /* the point cannot be seen */
    VIEWER_PLACE_UNDO, /* the last pick, or skip, again */
    VIEWER_PLACE_SOLVE
} viewer_place_action;

/* Turns the mode on, with the first object, or off. False with a text when the scene has no known
 * object. */
bool viewer_place_toggle(viewer_place *place, const rlf_pipeline *pipeline,
                         char text[VIEWER_PLACE_TEXT]);
/* Takes the pixel as the next point; solves after the last. `text` says what came of it. */
void viewer_place_pick(viewer_place *place, rlf_pipeline *pipeline, double u, double v,
                       char text[VIEWER_PLACE_TEXT]);
void viewer_place_act(viewer_place *place, rlf_pipeline *pipeline, viewer_place_action action,
                      char text[VIEWER_PLACE_TEXT]);
/* Moves the placed model by `shift` (metres) and turns it by `turn` (radians) about the vertical,
 * in the camera's frame. */
void viewer_place_nudge(viewer_place *place, rlf_pipeline *pipeline, const rlf_pose *T_world_camera,
                        rlf_vec3 shift, double turn, char text[VIEWER_PLACE_TEXT]);
/* The line that says what to do now. */
void viewer_place_hint(const viewer_place *place, char text[VIEWER_PLACE_TEXT]);
/* Crosses at the picked pixels. */
void viewer_place_draw(const viewer_place *place, const rlf_image_rgba8 *image);

#endif
