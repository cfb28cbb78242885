/* Relief: models of known real things, the model-based way of Breen et al. 1996.
 *
 * A model with the pose of a real thing hides and collides in its place: with its whole shape, its
 * unseen back too, and where the sensor has no depth. Here is how its pose is found from points
 * that somebody picked, and refined on the surface that the camera sees.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_KNOWN_H
#define RELIEF_KNOWN_H

#include "relief/snapshot.h"
#include "relief/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How many points give a pose: three fix it, more average what picking by hand is off. */
#define RLF_KNOWN_POINTS_MIN 3
/* Most points of one model. */
#define RLF_KNOWN_POINTS_MAX 6

/* A point of the model and where it is in the real world. */
typedef struct rlf_known_point {
    rlf_vec3 model;  /* the shape's frame, metres */
    bool has_pixel;  /* true: `pixel`, with the camera's own depth there; false: `world` */
    double pixel[2]; /* of the picture: the colour camera's or, without one, the depth camera's */
    rlf_vec3 world;  /* metres */
} rlf_known_point;

/* A model and its pose, or the points that give it. */
typedef struct rlf_known_def {
    uint32_t cookie;         /* from rlf_known_def_default */
    char name[RLF_NAME_MAX]; /* ends with a zero; found by it */
    rlf_shape shape;         /* what it collides as; default box 0.1 m */
    rlf_look look;          /* a model in the shape's frame: its triangles hide; NULL = the shape */
    rlf_pose T_world_model; /* default identity; used when there are no points */
    bool has_pose;          /* false: it waits to be placed; points count instead. default true */
    rlf_known_point points[RLF_KNOWN_POINTS_MAX]; /* the first point_count count */
    int32_t point_count; /* 0, or RLF_KNOWN_POINTS_MIN to RLF_KNOWN_POINTS_MAX */
    bool refine;         /* on the surface, after the points; default true */
    bool collides;       /* false: it hides, and others collide for it; default true */
    double restitution;  /* 0..1, default 0: that of what meets it */
    double friction;     /* >= 0, default 0.5 */
} rlf_known_def;

/* A box of 0.1 m at the origin, placed, without points. Thread-safety of all here: safe, the calls
 * keep nothing. */
RLF_API rlf_known_def rlf_known_def_default(void);

/* A point of a shape by name: three letters for left, centre or right (l, c, r), top, centre or
 * bottom (t, c, b), near, centre or far (n, c, f) of the box around it, -x, -y and -z being left,
 * top and near: "ltn" is a box's first corner, "ctc" the middle of its top. Of a hull "v" and the
 * number of a vertex, from 0. False when the shape has no such point. */
RLF_API bool rlf_known_name_point(const rlf_shape *shape, const char *name, rlf_vec3 *out);

/* The rigid motion that maps `model` points onto `world` points with the least sum of squares
 * (Horn 1987, unit quaternions). out_rms (may be NULL): root mean square distance left, metres.
 * RLF_ERROR_INVALID with a line for fewer than three points, values that are not finite, and points
 * on a line. */
RLF_API rlf_result rlf_align_points(const rlf_vec3 *model, const rlf_vec3 *world, int32_t count,
                                    rlf_pose *out_T_world_model, double *out_rms);

/* What the camera sees, for picks and refinement; all borrowed for the call. */
typedef struct rlf_known_view {
    const rlf_surface *surface; /* of the last frame */
    const rlf_rig *rig;         /* cameras of the picked pixels */
    rlf_pose T_world_camera;    /* depth camera in the world */
} rlf_known_view;

/* A pose and how well it fits. */
typedef struct rlf_known_fit {
    rlf_pose T_world_model; /* the model in the world */
    int32_t depth_count;    /* picks with depth */
    double pick_rms;        /* metres: between the points with depth and the model's */
    double pick_rms_px;    /* pixels: between the picked pixels and the model's; 0 without pixels */
    int32_t surface_count; /* surface points on the model; 0 = not refined */
    double surface_rms;    /* metres: their distance to it */
} rlf_known_fit;

/* Pose of a def: from its points when it has some, refined on the surface when it asks for that.
 * `view` may be NULL when there is no pixel, then nothing is refined. Errors, each one line with
 * the def's name: RLF_ERROR_INVALID for picks outside the picture, on missing depth (fewer than
 * three with depth), on a line, or that do not fit the model. Allocates. Source: Horn 1987 for the
 * start, Gauss-Newton on pixels and depths each with its own noise, then rlf_known_refine. */
RLF_API rlf_result rlf_known_solve(const rlf_known_def *def, const rlf_known_view *view,
                                   rlf_known_fit *out);

/* Moves a pose onto the surface near the model: point-to-plane (Chen and Medioni 1992), a fixed
 * number of rounds, points gated by distance and by normal. What the surface does not tell (a
 * sideways move along a single face) stays as it was. fit->T_world_model is where it starts and
 * ends. Fewer than 30 points: it is left alone, with surface_count 0. */
RLF_API void rlf_known_refine(const rlf_shape *shape, const rlf_known_view *view,
                              rlf_known_fit *fit);

#ifdef __cplusplus
}
#endif
#endif
