/* Cutting polygons with planes. */
#ifndef RLF_PHYSICS_PAIR_CLIP_H
#define RLF_PHYSICS_PAIR_CLIP_H

#include "relief/math.h"

/* Sutherland and Hodgman 1974: keeps the part of a convex polygon with n.p <= d; of two corners, a
 * segment's. Returns the corners left: one more than before at most, but where rounding makes
 * corners in a line lie on both sides, half as many more. */
static inline int32_t pair_clip(const rlf_vec3 *in, int32_t count, rlf_vec3 n, double d,
                                rlf_vec3 *out)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 p = in[i], q = in[i + 1 < count ? i + 1 : 0];
        double dp = rlf_dot(n, p) - d, dq = rlf_dot(n, q) - d;
        if (dp <= 0.0) {
            out[kept++] = p;
        }
        if ((dp < 0.0 && dq > 0.0) || (dp > 0.0 && dq < 0.0)) {
            out[kept++] = rlf_mad(p, rlf_sub(q, p), dp / (dp - dq));
        }
    }
    return kept;
}

#endif
