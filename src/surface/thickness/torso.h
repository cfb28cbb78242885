/* The trunks of people, each a solid that is followed from frame to frame.
 *
 * Of a person seen from the side the near arm hides the trunk, and the trunk the far shoulder, so
 * that no ray there shows where it leaves the body. But a trunk has a plane of symmetry, which the
 * head above tells, and a shape that it keeps: what is hidden now was seen a little earlier, when
 * the arm had swung aside or the person stood turned otherwise. So a trunk and the bar of its
 * shoulders (thickness/torso_solid.c) hang below each head that thickness/head.c finds, and how it
 * is turned, how far it leans and its measures are fitted to every frame's points
 * (thickness/torso_fit.c): an extended Kalman filter, which begins with the means of ANSUR II.
 * Where a ray goes on from what it sees into this solid without a gap, it leaves the body where it
 * leaves the solid (thickness/torso_back.c). */
#ifndef RLF_SURFACE_THICKNESS_TORSO_H
#define RLF_SURFACE_THICKNESS_TORSO_H

#include "kernel/touch.h"
#include "surface/thickness/thickness.h"

/* Depths between which a ray is in one part of a solid. */
typedef struct rlf_torso_cut {
    double enter, leave;
} rlf_torso_cut;

/* Heights below the head's top between which there is any of a usual torso, metres. */
extern const double rlf_torso_first, rlf_torso_last;
/* Below the shoulders' middle: there a trunk's rays end, and legs begin. */
extern const double rlf_torso_crotch;

/* ---- thickness/torso_solid.c ---- */
/* A torso as people are on average, and the covariance of the unknowns among them. */
void rlf_torso_usual(double unknown[RLF_TORSO_UNKNOWNS],
                     double covariance[RLF_TORSO_UNKNOWNS][RLF_TORSO_UNKNOWNS]);
/* The point in the torso's own axes: to the side and ahead (x, z) of the head's middle, and
 * downwards (y) from the shoulders' middle. */
rlf_vec3 rlf_torso_place(const rlf_torso *torso, rlf_vec3 p);
/* The point at a place: the other way round. */
rlf_vec3 rlf_torso_point(const rlf_torso *torso, rlf_vec3 place);
/* Up to RLF_KERNEL_RAYS places for kernels. */
void rlf_places_read(const rlf_vec3 *place, int32_t count, rlf_kernel_places *out);
/* How far up to RLF_KERNEL_RAYS points are off the surface; there is none at the heights of the
 * head and of the legs. */
void rlf_torso_touch(const rlf_torso *torso, const rlf_vec3 *p, int32_t count,
                     rlf_kernel_touches *out);
/* The same of places on the trunk's outline, where the camera's rays touch it: how far the rays are
 * from the surface, and how much farther than p their places there are. */
void rlf_torso_touch_rim(const rlf_torso *torso, const rlf_vec3 *p, int32_t count,
                         rlf_kernel_touches *out, double moved_m[RLF_KERNEL_RAYS]);
/* Rays in the torso's own axes: none; one more, (x, y, 1); as many as kernels want. */
void rlf_torso_begin_rays(const rlf_torso *torso, rlf_kernel_ray_lanes *out);
void rlf_torso_add_ray(const rlf_torso *torso, double x, double y, rlf_kernel_ray_lanes *rays);
void rlf_torso_close_rays(rlf_kernel_ray_lanes *rays);
/* Cuts the trunk, down to the crotch. */
void rlf_torso_cut_rays(const rlf_torso *torso, const rlf_kernel_ray_lanes *rays,
                        rlf_kernel_cuts *out);
/* Cuts the shoulders; false when no ray is near them. */
bool rlf_torso_cut_shoulders(const rlf_torso *torso, const rlf_kernel_ray_lanes *rays,
                             rlf_kernel_cuts *out);

/* ---- thickness/torso_points.c ---- */
/* Points of a person around the place of the torso. */
typedef struct rlf_torso_points {
    rlf_vec3 *p;
    int32_t count;
    double area_m2; /* that one stands for */
    rlf_vec3 *rim;  /* places on its outline, where it ends before something farther */
    int32_t rim_count;
} rlf_torso_points;

/* Where points are looked for: how far from the head to the side, from how far below its top to
 * how far, metres; and the most there may be, of them and of the rim. */
typedef struct rlf_torso_window {
    double beside, top, bottom;
    int32_t most, most_rim;
} rlf_torso_window;

/* Finds points of the torso's region, evenly in the image, and those of its rim in the same rows;
 * out->p and out->rim have room for window->most and most_rim. */
void rlf_torso_find_points(const rlf_chord_job *job, const rlf_torso *torso,
                           const rlf_torso_window *window, rlf_torso_points *out);

/* ---- thickness/torso_fit.c ---- */
/* Improves the torso, whose `unknown` and `doubt` are expected, by the points, in so many passes.
 */
void rlf_torso_improve(rlf_torso *torso, const rlf_torso_points *points, int32_t passes);

/* ---- thickness/torso.c ---- */
/* Before the heads of a frame are found, dt s after the last one; 0 = there was none lately. */
void rlf_torsos_expect(rlf_torsos *torsos, double dt);
/* Follows the torso of the region `label` below its head: x and z of its middle, y of its top; and
 * how wide it is at its brow, as a ray's x, 0 = not seen. */
void rlf_torso_follow(const rlf_chord_job *job, int32_t label, rlf_vec3 head, double brow);

/* ---- thickness/skull.c ---- */
/* Follows the head above the torso, which is so wide at its brow, as a ray's x, dt s after the last
 * frame. */
void rlf_skull_follow(const rlf_chord_job *job, rlf_torso *torso, double brow, double dt);
/* Cuts it by the ray (x, y, 1); enter > leave where it misses. */
rlf_torso_cut rlf_skull_cut_ray(const rlf_skull *skull, double x, double y);

/* ---- thickness/torso_back.c ---- */
/* Thickens the block's knots of the rows begin <= y < end by the torsos seen. */
void rlf_torsos_thicken(const rlf_chord_job *job, int32_t begin, int32_t end);

#endif
