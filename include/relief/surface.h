/* Relief: the reconstructed surface, the value that flows from surface to physics and render.
 *
 * An organised grid: one sample per kept depth pixel, row-major, index = y * width + x. Planes are
 * separate arrays (structure of arrays), 64-byte aligned, without padding between rows. Points are
 * p = depth * (ray_x, ray_y, 1), in the depth camera's frame, metres. There is no NaN in any plane.
 *
 *      camera            front        back        background
 *        o- - - - - - - - |############| - - - - - - - |          along one pixel's ray
 *                       depth   depth+thickness    background_depth
 *
 * A surface is complete when published and never changes while it is published.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_SURFACE_H
#define RELIEF_SURFACE_H

#include "relief/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Why a pixel has (or has not) a depth. Codes 0 and 7 have depth > 0, all others depth 0. */
typedef enum rlf_reason {
    RLF_REASON_OK = 0,
    RLF_REASON_TOO_NEAR = 1,
    RLF_REASON_TOO_FAR = 2,
    RLF_REASON_NO_RETURN = 3,       /* the sensor gave nothing */
    RLF_REASON_FLYING = 4,          /* mixed pixel at a depth edge, removed */
    RLF_REASON_PARALLAX_SHADOW = 5, /* structured light: the projector cannot see it */
    RLF_REASON_OUTSIDE_LENS = 6,    /* no ray: outside the valid part of the lens model */
    RLF_REASON_FILLED = 7,          /* estimated from neighbours or earlier frames */
    RLF_REASON_COUNT = 8
} rlf_reason;

/* Name of a reason code, e.g. "no return". */
RLF_API const char *rlf_reason_name(rlf_reason reason);

/* Which of the two sheets a region belongs to. */
typedef enum rlf_layer {
    RLF_LAYER_BACKGROUND = 0, /* what stays: planes background_* */
    RLF_LAYER_FOREGROUND = 1  /* what moves in front of it: planes depth, normal_*, ... */
} rlf_layer;

/* A connected piece of one layer. Its mask is `label plane == label` inside the rectangle. */
typedef struct rlf_region {
    int32_t label;             /* > 0, unique among both layers of one surface */
    rlf_layer layer;           /* the sheet that it is a piece of */
    int32_t point_count;       /* pixels */
    int32_t first_point;       /* into rlf_surface.region_points; -1 when lists are not kept */
    int32_t x0, y0, x1, y1;    /* rectangle in grid pixels: x0 <= x < x1, y0 <= y < y1 */
    rlf_aabb box;              /* metres, camera frame */
    rlf_vec3 centroid;         /* metres, camera frame */
    rlf_vec3 linear_velocity;  /* m/s of the centroid; 0 when not significant or unknown */
    rlf_vec3 angular_velocity; /* rad/s */
    double plane_residual;     /* RMS distance to its best plane, metres; < 0 = not computed */
    rlf_pose oriented_pose;    /* oriented box: centre and axes */
    rlf_vec3 oriented_half;    /* half extents, metres; 0 when not computed */
    int64_t age_ns;            /* how long the label has been followed */
} rlf_region;

/* Where the background model stands. */
typedef enum rlf_background_state {
    RLF_BACKGROUND_NONE = 0,     /* the method keeps none */
    RLF_BACKGROUND_LEARNING = 1, /* the first frames are being averaged */
    RLF_BACKGROUND_READY = 2
} rlf_background_state;

/* What the camera sees now, and the room behind it. All planes are width * height values, row by
 * row, in the camera's frame, and hold until the stage's next frame. */
typedef struct rlf_surface {
    uint64_t sequence;          /* of the frame it was made from */
    int64_t time_ns;            /* device time of the frame */
    int32_t width, height;      /* of all planes, pixels */
    int32_t scale_factor;       /* every scale_factor-th depth pixel is kept */
    rlf_camera camera;          /* of the grid (decimated depth camera) */
    rlf_depth_noise noise;      /* of the raw depth */
    const float *ray_x, *ray_y; /* rays per pixel; constant for a source. Outside the lens: 0, 0 */

    /* Front sheet: what the camera sees now. */
    const float *depth;                          /* z, metres; 0 = missing */
    const float *normal_x, *normal_y, *normal_z; /* unit and towards the camera, or 0 = missing */
    const float *velocity_x, *velocity_y, *velocity_z; /* m/s; 0 = still or not significant */
    const float *thickness;    /* solid behind depth, metres along z; 0 = a sheet */
    const int32_t *label;      /* region label; 0 = none */
    const uint8_t *reason;     /* rlf_reason */
    const uint8_t *foreground; /* 1 = in front of the background, else 0 */

    /* Back sheet: the background behind (or at) each pixel. All 0 where unknown. */
    const float *background_depth;
    /* Unit and towards the camera, or 0. */
    const float *background_normal_x, *background_normal_y, *background_normal_z;
    /* Solid behind background_depth, metres along z; 0 = not known: bodies then take it to be
     * RLF_BACKGROUND_GUESS_M thick, square to its face. */
    const float *background_thickness;
    const int32_t *background_label; /* region label; 0 = none */
    /* While it and background_depth stay the same, so do the planes above; 0 = not known. */
    int64_t background_version;
    rlf_background_state background_state; /* whether it is known yet */
    /* No depth, or hardly any: the sensor warms up, or its lens is covered. Nothing is learnt of
     * such a frame, nothing of it is foreground, and a pipeline's bodies wait. Hardly any: less
     * than a tenth of the background that is known; before there is any, less than a tenth of the
     * picture, for at most 3 s. */
    bool is_blind;
    /* The camera itself moves, or did within the last 12 frames; told within 10 frames. With the
     * adaptive background all is one sheet at rest then, and nothing is foreground: the background
     * is learnt anew when it stands. Always false with a background neither adaptive nor given. */
    bool camera_moves;
    /* The view as a whole seems to have moved, and it is not sure yet that the camera did. */
    bool camera_may_move;
    /* At least a third of the picture's parts are where they were up to 16 frames ago, and the view
     * as a whole has not moved. */
    bool camera_rests;
    /* When camera_moves begins: the camera as it was up to 16 frames ago, in this frame's camera.
     */
    rlf_pose T_now_before;

    /* Regions of both layers; region_points lists pixel indices region by region when kept. */
    const rlf_region *regions;
    int32_t region_count;         /* of both layers */
    const int32_t *region_points; /* NULL when lists are not kept */

    int32_t valid_count;      /* pixels with depth > 0 */
    int32_t foreground_count; /* pixels with foreground == 1 */
} rlf_surface;

/* What is behind a background's front that nobody has seen is taken to be this thick, metres.
 * Endless matter would fill the space behind a table or a box, and bodies would bounce in mid-air;
 * this much holds any body at a wall (it moves 4 cm in a 240 Hz step at 10 m/s), and leaves the air
 * behind furniture free. */
#define RLF_BACKGROUND_GUESS_M 0.15

/* Point of the front sheet at pixel index i; (0,0,0) where missing. */
static inline rlf_vec3 rlf_surface_point(const rlf_surface *s, int32_t i)
{
    if (!RLF_ASSERT(s != NULL)) {
        return rlf_vec3_make(0, 0, 0);
    }
    double z = s->depth[i];
    return rlf_vec3_make(z * s->ray_x[i], z * s->ray_y[i], z);
}
/* Point of the background sheet at pixel index i; (0,0,0) where unknown. */
static inline rlf_vec3 rlf_surface_background_point(const rlf_surface *s, int32_t i)
{
    if (!RLF_ASSERT(s != NULL)) {
        return rlf_vec3_make(0, 0, 0);
    }
    double z = s->background_depth[i];
    return rlf_vec3_make(z * s->ray_x[i], z * s->ray_y[i], z);
}

/* ---- the organised triangle mesh (thesis fig. 4.3) ----------------------------------------------
 */

/* Number of indices of the full mesh of a w x h grid: (w-1)(h-1)*6; 0 when w or h < 2. */
RLF_API size_t rlf_mesh_index_count(int32_t width, int32_t height);

/* Writes the index list, square by square, left to right, top to bottom:
 * T1 = {n, n+1, n+w}, T2 = {n+1, n+w+1, n+w} (clockwise as seen by the camera).
 * `out` has rlf_mesh_index_count entries. */
RLF_API void rlf_mesh_indices(int32_t width, int32_t height, uint32_t *out);

/* As above, but leaves out triangles with a missing corner or whose corners' depths differ by more
 * than max_jump (relative to the nearest corner, e.g. 0.05). Returns the number of indices written.
 */
RLF_API size_t rlf_mesh_indices_valid(const rlf_surface *surface, double max_jump, uint32_t *out);

/* As above, of the triangles within one region of the front sheet: all corners have its label.
 * Needs room for rlf_mesh_index_count of the region's rectangle. */
RLF_API size_t rlf_mesh_indices_region(const rlf_surface *surface, const rlf_region *region,
                                       double max_jump, uint32_t *out);

/* ---- which way is up ----------------------------------------------------------------------------
 */

/* Which way is up, in the camera's frame, for any roll of the camera, and how sure that is: 0..1, 0
 * where no pixel tells. Below RLF_UP_SURE the answer is a guess, and whoever lets bodies fall by it
 * ought to say so.
 *
 * The directions that most normals are along (floors and tables) or across (walls) are the axes
 * (Gupta, Arbelaez, Malik 2013). Which end of which axis is up is weighed: how many normals it
 * explains, how many faces look up rather than down, how much stands on the largest of those, and,
 * weakly, that cameras are seldom rolled and look down rather than up. A camera that looks
 * straight at a bare wall, or straight down on a bare floor, cannot know. Thread-safe. */
#define RLF_UP_SURE 0.7
/* Confidence, 0..1; *out_up is unit. See above. */
RLF_API double rlf_surface_find_up(const rlf_surface *surface, rlf_vec3 *out_up);

#ifdef __cplusplus
}
#endif
#endif
