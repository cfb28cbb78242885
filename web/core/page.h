/* What the files behind a page's calls share. */
#ifndef RELIEF_WEB_PAGE_H
#define RELIEF_WEB_PAGE_H

#include "relief/pipeline.h"
#include "relief/synthetic.h"

#define EXPORT(name) __attribute__((export_name(#name))) name

/* Which bodies a room starts with. */
typedef enum page_scene {
    PAGE_SCENE_NONE = 0,
    PAGE_SCENE_CUBES = 1,
    PAGE_SCENE_OWN = 2
} page_scene;

/* scene.c: the scene that the page wrote, a scene of the page's choice (to be destroyed), and a
 * body as the page wrote it. */
rlf_result page_scene_make(page_scene kind, rlf_scene *out);
rlf_body_def page_body_read(void);

/* absent.c: whether this build has the room. */
rlf_result page_room_check(const rlf_synthetic_def *def);

/* rig.c: the cameras that the page wrote. */
rlf_rig page_rig_read(void);

/* api.c: NULL while no room is open. */
rlf_pipeline *page_pipeline(void);
const rlf_pipeline_output *page_output(void);

/* hand.c: before a step of dt seconds, and when the room closes. */
void page_hand_pull(double dt);
void page_hand_forget(void);

/* api.c: closes what is open; opens a room of such a def for frames that are pushed, after that;
 * and pushes one. */
void relief_close(void);
rlf_result page_open(const rlf_pipeline_def *def);
rlf_result page_push(const rlf_frame *frame);
rlf_world *page_world(void); /* NULL while no room is open */

/* see_through.c: when the room has closed. */
void page_see_forget(void);

/* touch.c: before a step of dt seconds, and before the room closes. */
void page_touch_move(double dt);
void page_touch_forget(void);
/* The pose that the page wrote; false, with a line, when it is none. */
bool page_pose_read(rlf_pose *out);
/* stand.c: before the room closes. */
void page_stand_forget(void);

#endif
