/* What the mouse does to bodies and models: throw, hold, place. */
#ifndef RLF_VIEWER_MOUSE_H
#define RLF_VIEWER_MOUSE_H

#include "relief/compositor.h"
#include "relief/pipeline.h"
#include "relief/query.h"
#include "relief/world.h"

/* ---- throw.c: from a mouse position to a body thrown into the scene. */

#define VIEWER_THROW_SPEED 4.0     /* m/s of a click without a drag */
#define VIEWER_THROW_SPEED_MIN 1.0 /* m/s */
#define VIEWER_THROW_SPEED_MAX 12.0

/* A window and the picture shown in it; sizes in pixels, all > 0. */
typedef struct viewer_fit {
    double window_width, window_height;
    int32_t picture_width, picture_height;
    bool fills;          /* cut; else with bars */
    const rlf_mat3 *map; /* as rlf_gl_presenter_set_place takes it; NULL = none */
} viewer_fit;

/* Window position to picture pixel; false on the bars or outside. */
bool viewer_fit_pick(const viewer_fit *fit, double window_x, double window_y, double *out_u,
                     double *out_v);

/* Ray in the world through a pixel of the picture: from the picture's camera, unit direction. */
typedef struct viewer_ray {
    rlf_vec3 origin, direction;
} viewer_ray;
viewer_ray viewer_ray_make(const rlf_compositor_def *def, const rlf_pose *T_world_camera, double u,
                           double v);

/* m/s of a drag over a part of the window's height; a click (under 2 %) has VIEWER_THROW_SPEED. */
double viewer_throw_speed(double drag_fraction);

typedef enum viewer_throw_kind {
    VIEWER_THROW_CUBE,
    VIEWER_THROW_BALL,
    VIEWER_THROW_CAPSULE,
    VIEWER_THROW_CYLINDER,
    VIEWER_THROW_MODEL,
    VIEWER_THROW_KINDS
} viewer_throw_kind;

/* What is thrown. */
typedef struct viewer_throw_def {
    viewer_throw_kind kind;
    double size_m; /* along its longest side */
    double restitution;
    char model[1024]; /* its file; "" = none, and then no body is a model */
    rlf_shape shape;  /* of a model */
    rlf_look look;
} viewer_throw_def;

#define VIEWER_THROW_SIZE_MIN 0.03
#define VIEWER_THROW_SIZE_MAX 0.6

viewer_throw_def viewer_throw_def_default(void);
const char *viewer_throw_name(viewer_throw_kind kind);

/* A spinning body that starts on the ray; `index` varies its colour. As heavy as light wood. */
rlf_body_def viewer_throw_body(const viewer_throw_def *thrown, const viewer_ray *ray, double speed,
                               int32_t index);

/* ---- grab.c: A body held by the mouse: a spring draws it to the ray through the cursor. */

#define VIEWER_GRAB_REACH_M 20.0

typedef struct viewer_grab {
    bool is_on;
    rlf_body_id id;
    double distance; /* along the ray, metres, of the point that was picked */
    rlf_vec3 offset; /* from that point to the body's centre, world */
    viewer_ray ray;  /* through the cursor, now */
} viewer_grab;

/* The first body on the ray, in front of the real surface or behind it; false when there is none.
 */
bool viewer_grab_find(const rlf_world *world, const viewer_ray *ray, rlf_ray_hit *out);
/* Takes hold of what a ray met. */
void viewer_grab_begin(viewer_grab *grab, const rlf_world *world, const viewer_ray *ray,
                       const rlf_ray_hit *hit);
/* Nearer or further, by steps of the wheel, > 0: nearer. */
void viewer_grab_reach(viewer_grab *grab, double steps);
/* Forces for the next advance, of dt seconds. Lets go when the body is gone. Never more than 20 g,
 * so that what is between body and cursor stays in the way. */
void viewer_grab_pull(viewer_grab *grab, rlf_world *world, double dt);

/* ---- place.c: placing models over real things in the window: points picked one after the
 * other, a pose from them, and nudges. Knows no window, so that tests can drive it. */

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
