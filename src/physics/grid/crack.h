/* The outline of a face in the image: places, and lines through them. */
#ifndef RLF_PHYSICS_GRID_CRACK_H
#define RLF_PHYSICS_GRID_CRACK_H

#include "physics/grid/patch.h"

#define CRACK_SIDE (2 * PATCH_PX + 1)
#define CRACKS_MAX (2 * CRACK_SIDE * (CRACK_SIDE - 1)) /* one between any two neighbours */

/* A place where a face ends. */
typedef struct edge_crack {
    double u, v;              /* in the image: that is where errors are alike */
    rlf_vec3 point;           /* on the face */
    const patch_sample *next; /* of another face that begins here, or NULL */
} edge_crack;

typedef struct edge_cracks {
    edge_crack cracks[CRACKS_MAX];
    int32_t count;
} edge_cracks;

/* A line in the image: (u, v) + t (du, dv), |(du, dv)| = 1, from t = begin to end, pixels. */
typedef struct image_line {
    double u, v, du, dv, begin, end;
} image_line;

/* Where the face of `mean` ends within the patch. */
void crack_find(const grid_patch *p, const patch_mean *mean, edge_cracks *out);

/* The one nearest to q; -1 when there is none. */
int32_t crack_nearest(const edge_cracks *fit, rlf_vec3 q);

/* The line through `centre` on which most cracks near it are. False for want of any. */
bool crack_fit_line(const grid_patch *p, const edge_cracks *fit, const edge_crack *centre,
                    image_line *out);

/* The crack's weight in that fit; 0 for one that is off the line or far from `centre`. */
double crack_weight(const grid_patch *p, const edge_crack *crack, const edge_crack *centre,
                    const image_line *line);

/* Where the ray through the image's place (u, v) meets the face, which has moved since it was seen.
 */
rlf_vec3 crack_on_face(const grid_patch *p, const patch_mean *mean, double u, double v);

#endif
