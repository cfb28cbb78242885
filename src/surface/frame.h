/* The planes of a frame, which every step reads and some write. */
#ifndef RLF_SURFACE_FRAME_H
#define RLF_SURFACE_FRAME_H

#include "relief/reconstruct.h"

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct rlf_rect {
    int32_t x0, y0, x1, y1;
} rlf_rect;

/* Takes pixel (x, y) in; pixels come in the order of their rows. */
static inline void rlf_rect_add(rlf_rect *r, int32_t x, int32_t y)
{
    r->x0 = x < r->x0 ? x : r->x0;
    r->x1 = x + 1 > r->x1 ? x + 1 : r->x1;
    r->y0 = y < r->y0 ? y : r->y0;
    r->y1 = y + 1;
}

/* The planes of a grid that every step reads. */
typedef struct image_grid {
    int32_t width, height, count;
    int32_t factor;
    rlf_camera camera;
    const float *ray_x, *ray_y;
    const uint8_t *has_ray;
} image_grid;

/* The point that pixel i shows, and a vector of three planes there. */
static inline rlf_vec3 image_grid_point(const image_grid *grid, const float *depth, ptrdiff_t i)
{
    double z = depth[i];
    return rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
}

static inline rlf_vec3 image_grid_vector(float *const plane[3], ptrdiff_t i)
{
    return rlf_vec3_make(plane[0][i], plane[1][i], plane[2][i]);
}

/* Two faces, each the plane through a pixel with its normal: where they lie, and how they meet. */
typedef struct rlf_faces {
    const float *ray_x, *ray_y, *depth;
    float *const *normal;
} rlf_faces;

/* CONVEX: a ray meets the farther one; CONCAVE: the nearer one. */
typedef enum rlf_meeting { RLF_FACES_APART, RLF_FACES_CONVEX, RLF_FACES_CONCAVE } rlf_meeting;

/* Depth of the face through pixel `face` on the ray of pixel `at`; 0 where that does not meet it.
 */
static inline float rlf_face_depth(const rlf_faces *f, ptrdiff_t face, ptrdiff_t at)
{
    const float least_facing = 0.02f; /* a face may be seen edge-on, not from behind */
    float nx = f->normal[0][face], ny = f->normal[1][face], nz = f->normal[2][face];
    float offset = f->depth[face] * (nx * f->ray_x[face] + ny * f->ray_y[face] + nz);
    float facing = nx * f->ray_x[at] + ny * f->ray_y[at] + nz;
    return facing < -least_facing ? offset / facing : 0.0f;
}

/* Of the faces that pixels a and b are on. `a_at_b` is the depth of a's face at pixel b. */
static inline rlf_meeting rlf_faces_meet(float at_a, float b_at_a, float at_b, float a_at_b)
{
    bool convex = b_at_a > 0.0f && a_at_b > 0.0f && at_a > b_at_a && at_b > a_at_b;
    bool concave = (!(b_at_a > 0.0f) || at_a < b_at_a) && (!(a_at_b > 0.0f) || at_b < a_at_b);
    return convex ? RLF_FACES_CONVEX : (concave ? RLF_FACES_CONCAVE : RLF_FACES_APART);
}

/* Most pixels of a row that are looked at together. */
enum { RLF_PART = 128 };

/* Pixels x0 <= x < x1 of one row. */
typedef struct rlf_span {
    int32_t x0, x1;
} rlf_span;

/* The smallest that holds both. */
static inline rlf_span rlf_span_unite(rlf_span a, rlf_span b)
{
    if (a.x0 >= a.x1 || b.x0 >= b.x1) {
        return a.x0 >= a.x1 ? b : a;
    }
    const rlf_span both = {a.x0 < b.x0 ? a.x0 : b.x0, a.x1 > b.x1 ? a.x1 : b.x1};
    return both;
}

static inline int32_t rlf_least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* The buffers of one published surface. */
typedef struct rlf_slot {
    rlf_surface surface;
    float *depth;
    float *normal[3];
    float *velocity[3];
    float *thickness;
    int32_t *label;
    uint8_t *reason, *foreground;
    rlf_span *moved; /* per row, where the velocity planes were written */
    rlf_span *thick; /* the same of thickness */
    rlf_region *regions;
    int32_t *region_points;
    int32_t foreground_region_first, foreground_region_count; /* in regions */
} rlf_slot;

#endif
