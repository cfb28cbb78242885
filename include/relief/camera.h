/* Relief: the lens model, projection, unprojection, and registration of depth to colour.
 *
 * Pixel centres are at integer coordinates. The camera frame is x right, y down, z forward.
 * All functions are pure: thread-safe.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_CAMERA_H
#define RELIEF_CAMERA_H

#include "relief/image.h"
#include "relief/math.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Names as in camera.json and ROS: plumb_bob is Brown-Conrady (Brown 1971). */
typedef enum rlf_distortion_model {
    RLF_DISTORTION_NONE = 0,
    RLF_DISTORTION_PLUMB_BOB = 1,          /* k1 k2 p1 p2 k3 */
    RLF_DISTORTION_RATIONAL_POLYNOMIAL = 2 /* k1 k2 p1 p2 k3 k4 k5 k6 */
} rlf_distortion_model;

/* One pinhole camera with lens distortion. */
typedef struct rlf_camera {
    int32_t width, height;                 /* pixels, 1..RLF_IMAGE_SIZE_MAX */
    double fx, fy;                         /* focal lengths, pixels, finite and > 0 */
    double cx, cy;                         /* principal point, pixels, finite */
    rlf_distortion_model distortion_model; /* which of the numbers below count, and how */
    double distortion[8];                  /* k1 k2 p1 p2 k3 k4 k5 k6; unused ones are 0 */
} rlf_camera;

/* RLF_OK, or RLF_ERROR_INVALID with a line that names the field (`who` is put in front of it). */
RLF_API rlf_result rlf_camera_check(const rlf_camera *camera, const char *who);

/* Pinhole projection with distortion of a point with z > 0: out pixel (u, v). False when z <= 0, or
 * when the ray lies outside the part of the field where the distortion polynomial is monotonic. */
RLF_API bool rlf_camera_project(const rlf_camera *camera, rlf_vec3 p, double *out_u, double *out_v);

/* Undistorted ray m = (x, y, 1) through pixel (u, v), eq. 4.1 without the factor z: the point at
 * depth z is z m. Newton iteration on the distortion, residual below 1e-9 px; false (and the best
 * ray) where it does not converge, i.e. outside the lens model. */
RLF_API bool rlf_camera_unproject(const rlf_camera *camera, double u, double v, rlf_vec3 *out_ray);

/* Camera of the image that keeps every `factor`-th pixel, starting with pixel (0, 0): size
 * ceil(width / factor) x ceil(height / factor), and f / factor, c / factor. */
RLF_API rlf_camera rlf_camera_decimate(const rlf_camera *camera, int32_t factor);

/* Camera of the image resized to width x height (pixel areas scale, so centres shift by half a
 * pixel: c' = (c + 0.5) s - 0.5). */
RLF_API rlf_camera rlf_camera_resize(const rlf_camera *camera, int32_t width, int32_t height);

/* Projection matrix to clip space (OpenGL: -1..1 in x, y, z) from fx, fy, cx, cy: A.1 as corrected
 * (errata 4), without distortion. It takes points of the camera frame (y down, z forward) directly.
 * Row 0 of the image comes out at y = +1. near and far are distances along z, 0 < near < far. */
RLF_API rlf_mat4 rlf_camera_projection(const rlf_camera *camera, double near_z, double far_z);

/* A.1 as the thesis prints it, from a vertical field of view in radians and an aspect ratio, for a
 * camera frame with y up that looks along -z. */
RLF_API rlf_mat4 rlf_projection_from_fov(double fov_y, double aspect, double near_z, double far_z);

/* What a pixel of a registered depth image, or of the depth image itself, knows. */
typedef enum rlf_registered {
    RLF_REGISTERED_EMPTY = 0,   /* no depth (lands) here, and none near enough to fill from */
    RLF_REGISTERED_VISIBLE = 1, /* seen by both cameras */
    RLF_REGISTERED_FILLED = 2,  /* hidden from depth: parallax shadow, filled from the far side; or
                                   a gap between depth pixels */
    RLF_REGISTERED_HIDDEN = 3,  /* depth image only: hidden from colour by something nearer */
    RLF_REGISTERED_OUTSIDE = 4  /* depth image only: beyond the colour image */
} rlf_registered;

/* Work memory and tables for one pair of cameras. Thread-safety: one call at a time per object. */
typedef struct rlf_registration rlf_registration;

/* Prepares to warp depth (camera `depth`, rays ray_x, ray_y of its grid, each width*height floats,
 * read in this call only) into `color`. T_color_depth: p_color = T p_depth. */
RLF_API rlf_result rlf_registration_create(const rlf_camera *depth, const float *ray_x,
                                           const float *ray_y, const rlf_camera *color,
                                           const rlf_pose *T_color_depth, rlf_registration **out);
/* Frees it and nulls the pointer. NULL and a NULL registration are allowed. */
RLF_API void rlf_registration_destroy(rlf_registration **registration);

/* Warps `depth` (width*height floats, metres, 0 = missing) into the colour camera with a z-buffer.
 * out_depth and out_state have the colour camera's size; out_depth is z in the colour camera frame,
 * 0 where out_state is EMPTY. out_state->data NULL = not wanted. Allocates nothing. */
RLF_API void rlf_registration_apply(rlf_registration *registration, const float *depth,
                                    const rlf_plane_f32 *out_depth, const rlf_plane_u8 *out_state);

/* Only rows begin <= y < end, for pictures in which few rows are looked at: of the others nothing
 * is known afterwards. */
RLF_API void rlf_registration_apply_rows(rlf_registration *registration, const float *depth,
                                         int32_t begin, int32_t end, const rlf_plane_f32 *out_depth,
                                         const rlf_plane_u8 *out_state);

/* Depth aligned with the colour image, and both images' maps. */
typedef struct rlf_aligned {
    rlf_plane_f32 depth; /* the colour camera's size: z in its frame, 0 = EMPTY */
    rlf_plane_u8 state;  /* alike, rlf_registered: VISIBLE, FILLED (hidden from depth) or EMPTY */
    uint8_t *seen;       /* the depth grid's size, rlf_registered: VISIBLE, HIDDEN (from colour),
                            OUTSIDE or EMPTY; NULL = not wanted */
} rlf_aligned;

/* rlf_registration_apply into out->depth and out->state, and the depth image's own map into
 * out->seen: a pixel is HIDDEN when what lands where it does is nearer by more than 2 %. Allocates
 * nothing. */
RLF_API void rlf_registration_align(rlf_registration *registration, const float *depth,
                                    const rlf_aligned *out);

/* Where the pixels of row y of the depth grid are seen, 0 <= y < height: for each the byte of an
 * RGBA8 picture of the colour camera's size whose rows are `stride` bytes apart; -1 where it has no
 * depth or is beyond the picture. What something nearer hides gets that one's. `depth` is the whole
 * grid's. Allocates nothing. Thread-safety: any number of calls at a time. */
RLF_API void rlf_registration_find_pixels(const rlf_registration *registration, const float *depth,
                                          int32_t y, ptrdiff_t stride, int32_t *out_bytes);

#ifdef __cplusplus
}
#endif
#endif
