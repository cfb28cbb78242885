/* Separating axes in lanes. */
#include "kernel/lanes.h"
#include "kernel/kernel.h"

#include <stdbool.h>

#define FACE_GAIN 1e-6

RLF_KERNEL_PART double magnitude(double x)
{
    return x < 0.0 ? -x : x;
}

typedef double lanes[RLF_SAT_LANES];

/* The cosines between the axes of the boxes, their sizes, and the way along the axes. */
typedef struct sat_frame {
    lanes size[3][3], along_a[3], along_b[3];
} sat_frame;

RLF_KERNEL_PART void dot(const double (*restrict a)[RLF_SAT_LANES],
                         const double (*restrict b)[RLF_SAT_LANES], double *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t lane = 0; lane < RLF_SAT_LANES; lane++) {
        out[lane] = a[0][lane] * b[0][lane] + a[1][lane] * b[1][lane] + a[2][lane] * b[2][lane];
    }
}

RLF_KERNEL_PART void set_frame(const rlf_sat_pairs *restrict p, sat_frame *restrict f,
                               rlf_sat_axes *restrict axes)
{
    for (int32_t i = 0; i < 3; i++) {
        dot(p->way, p->axis_a[i], f->along_a[i]);
        dot(p->way, p->axis_b[i], f->along_b[i]);
        for (int32_t k = 0; k < 3; k++) {
            const double *c = axes->cosine[3 * i + k];
            dot(p->axis_a[i], p->axis_b[k], axes->cosine[3 * i + k]);
            RLF_KERNEL_WHOLE
            for (int32_t lane = 0; lane < RLF_SAT_LANES; lane++) {
                f->size[i][k][lane] = magnitude(c[lane]);
            }
        }
    }
}

/* Takes a face where it is better. What is no number is. `own` is the half side along it, `other`
 * and `sizes` those of the other box and their cosines. */
RLF_KERNEL_PART void try_face(const double *restrict along, const double *restrict own,
                              const double (*restrict other)[RLF_SAT_LANES],
                              const double *const sizes[3], int32_t code,
                              rlf_sat_axes *restrict axes)
{
    const double gain = code > 0 ? FACE_GAIN : 0.0, own_code = code;
    RLF_KERNEL_WHOLE
    for (int32_t lane = 0; lane < RLF_SAT_LANES; lane++) {
        double reach = own[lane] + other[0][lane] * sizes[0][lane] +
                       other[1][lane] * sizes[1][lane] + other[2][lane] * sizes[2][lane];
        double gap = magnitude(along[lane]) - reach, best = axes->gap[lane];
        double sign = along[lane] < 0.0 ? -1.0 : 1.0;
        bool is_worse = gap <= best + gain;
        axes->gap[lane] = is_worse ? best : gap;
        axes->code[lane] = is_worse ? axes->code[lane] : own_code;
        axes->sign[lane] = is_worse ? axes->sign[lane] : sign;
    }
}

RLF_KERNEL_PART void try_faces(const rlf_sat_pairs *restrict p, const sat_frame *restrict f,
                               rlf_sat_axes *restrict axes)
{
    for (int32_t lane = 0; lane < RLF_SAT_LANES; lane++) {
        axes->gap[lane] = -1e30;
        axes->code[lane] = 0.0;
        axes->sign[lane] = 1.0;
        axes->edges[lane] = 0.0;
    }
    for (int32_t i = 0; i < 3; i++) {
        const double *const sizes[3] = {f->size[i][0], f->size[i][1], f->size[i][2]};
        try_face(f->along_a[i], p->half_a[i], p->half_b, sizes, i, axes);
    }
    for (int32_t k = 0; k < 3; k++) {
        const double *const sizes[3] = {f->size[0][k], f->size[1][k], f->size[2][k]};
        try_face(f->along_b[k], p->half_b[k], p->half_a, sizes, 3 + k, axes);
    }
}

/* a_i x b_k = c[i1][k] a_i2 - c[i2][k] a_i1, no longer than 1: a gap below 0 only falls when it is
 * divided by that. */
RLF_KERNEL_PART void try_edges(const rlf_sat_pairs *restrict p, const sat_frame *restrict f,
                               int32_t i, int32_t k, rlf_sat_axes *restrict axes)
{
    const int32_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    const double *c1 = axes->cosine[3 * i1 + k], *c2 = axes->cosine[3 * i2 + k];
    const double bit = (double)(1 << (3 * i + k));
    RLF_KERNEL_WHOLE
    for (int32_t lane = 0; lane < RLF_SAT_LANES; lane++) {
        double along = c1[lane] * f->along_a[i2][lane] - c2[lane] * f->along_a[i1][lane];
        double reach = p->half_a[i1][lane] * f->size[i2][k][lane] +
                       p->half_a[i2][lane] * f->size[i1][k][lane] +
                       p->half_b[k1][lane] * f->size[i][k2][lane] +
                       p->half_b[k2][lane] * f->size[i][k1][lane];
        double gap = magnitude(along) - reach, limit = axes->gap[lane] + p->edge_gain[lane];
        bool is_worse = (gap < 0.0) & (gap <= limit);
        bool is_asked = axes->gap[lane] <= p->margin[lane];
        axes->edge_gap[3 * i + k][lane] = gap;
        axes->edge_along[3 * i + k][lane] = along;
        axes->edges[lane] += is_worse | !is_asked ? 0.0 : bit;
    }
}

RLF_KERNEL void rlf_kernel_sat_find(const rlf_sat_pairs *restrict pairs,
                                    rlf_sat_axes *restrict axes)
{
    sat_frame f;
    set_frame(pairs, &f, axes);
    try_faces(pairs, &f, axes);
    for (int32_t i = 0; i < 3; i++) {
        for (int32_t k = 0; k < 3; k++) {
            try_edges(pairs, &f, i, k, axes);
        }
    }
}
