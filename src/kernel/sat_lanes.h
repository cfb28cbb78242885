/* Separating axes of eight pairs of boxes at once (Gottschalk, Lin and Manocha 1996). Doubles;
 * every clone gives the same bits. */
#ifndef RLF_KERNEL_SAT_LANES_H
#define RLF_KERNEL_SAT_LANES_H

#include <stdint.h>

#define RLF_SAT_LANES 8

/* Pairs of boxes, metres. */
typedef struct rlf_sat_pairs {
    double axis_a[3][3][RLF_SAT_LANES]; /* a's axes, each by its x, y, z */
    double axis_b[3][3][RLF_SAT_LANES];
    double half_a[3][RLF_SAT_LANES], half_b[3][RLF_SAT_LANES];
    double way[3][RLF_SAT_LANES];    /* from b's centre to a's */
    double margin[RLF_SAT_LANES];    /* beyond which edges are not asked */
    double edge_gain[RLF_SAT_LANES]; /* an edge must be better than a face by so much */
} rlf_sat_pairs;

typedef struct rlf_sat_axes {
    double gap[RLF_SAT_LANES];           /* along the best face's normal; below 0: they overlap */
    double code[RLF_SAT_LANES];          /* 0..2 a's face, 3..5 b's */
    double sign[RLF_SAT_LANES];          /* -1 where that normal points from a to b, else 1 */
    double edges[RLF_SAT_LANES];         /* bit 3 i + k: a's edge i and b's edge k may be better */
    double edge_gap[9][RLF_SAT_LANES];   /* along their cross product, as long as it is */
    double edge_along[9][RLF_SAT_LANES]; /* the way along it */
    double cosine[9][RLF_SAT_LANES];     /* between the two edges */
} rlf_sat_axes;

/* The best of the faces, and which edges have to be looked at: none where a face shows a gap above
 * the margin. A later face must be better by a micrometre. */
void rlf_kernel_sat_find(const rlf_sat_pairs *restrict pairs, rlf_sat_axes *restrict axes);

#endif
