/* From a mouse position to a body thrown into the scene. */
#ifndef RLF_VIEWER_THROW_H
#define RLF_VIEWER_THROW_H

#include "relief/compositor.h"
#include "relief/world.h"

#define VIEWER_THROW_SPEED 4.0     /* m/s of a click without a drag */
#define VIEWER_THROW_SPEED_MIN 1.0 /* m/s */
#define VIEWER_THROW_SPEED_MAX 12.0

/* A window and the picture shown in it with bars; sizes in pixels, all > 0. */
typedef struct viewer_fit {
    double window_width, window_height;
    int32_t picture_width, picture_height;
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

#endif
