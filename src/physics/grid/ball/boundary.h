/* Where a face ends that a ball all but touches: on its contour in the image, or where it meets
 * other seen faces at an edge or a corner. */
#ifndef RLF_PHYSICS_GRID_BALL_BOUNDARY_H
#define RLF_PHYSICS_GRID_BALL_BOUNDARY_H

#include "physics/grid/ball/patch.h"

#define CONTOUR_POINTS_MAX                                                                         \
    (2 * PATCH_SIDE * (PATCH_SIDE - 1)) /* one between any two neighbours                          \
                                         */

/* A place where a face ends. */
typedef struct contour_point {
    double u, v;              /* in the image: that is where errors are alike */
    rlf_vec3 point;           /* on the face */
    const patch_sample *next; /* of another face that begins here, or NULL */
} contour_point;

typedef struct face_contour {
    contour_point points[CONTOUR_POINTS_MAX];
    int32_t count;
} face_contour;

/* A line in the image: (u, v) + t (du, dv), |(du, dv)| = 1, from t = begin to end, pixels. */
typedef struct image_line {
    double u, v, du, dv, begin, end;
} image_line;

/* Where the face of `mean` ends within the patch. */
void face_contour_find(const grid_patch *p, const patch_mean *mean, face_contour *out);

/* The one nearest to q; -1 when there is none. */
int32_t face_contour_nearest(const face_contour *contour, rlf_vec3 q);

/* The line through `centre` on which most points near it are. False for want of any. */
bool face_contour_fit_line(const grid_patch *p, const face_contour *contour,
                           const contour_point *centre, image_line *out);

/* A point's weight in that contour; 0 for one that is off the line or far from `centre`. */
double face_contour_weight(const grid_patch *p, const contour_point *point,
                           const contour_point *centre, const image_line *line);

/* Where the ray through the image's place (u, v) meets the face, which has moved since it was seen.
 */
rlf_vec3 face_contour_on_face(const grid_patch *p, const patch_mean *mean, double u, double v);

#define CORNER_FACES 3

/* The solid behind all of these planes. */
typedef struct patch_corner {
    patch_plane faces[CORNER_FACES];
    int32_t count;
} patch_corner;

/* The faces of a patch that bend away from its face, where the place of their solid that is nearest
 * to the ball is seen. False where there are none, or where that place is on no seen face. */
bool corner_find(const grid_patch *p, const patch_mean *face, patch_corner *out);

/* The place of the solid that is nearest to `centre`, which is outside. */
rlf_vec3 corner_nearest(const patch_corner *corner, rlf_vec3 centre);

/* On a line from `begin` to `end` about its point under the ball's centre; where faces meet, the
 * corner instead. */
typedef struct face_boundary {
    patch_corner corner;   /* of one face or none: the line */
    rlf_vec3 point, along; /* unit */
    double begin, end;     /* metres along; both 0: a point */
} face_boundary;

/* Replaces the mean's plane by the one near the nearest sample that holds most samples. */
void patch_find_face(const grid_patch *p, patch_mean *mean);

/* The end of a face that ends before its point under the ball's centre; the nearest sample where it
 * is on no line. Pixels that are no averages over time are not asked for their planes' corner. */
void patch_find_boundary(const grid_patch *p, const patch_mean *mean, bool is_averaged,
                         face_boundary *out);

/* The end's point that is nearest to the ball's centre. */
rlf_vec3 patch_boundary_nearest(const face_boundary *end, rlf_vec3 centre);

#endif
