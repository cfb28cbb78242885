/* Convex hulls that tests throw and lay down. */
#ifndef RLF_TEST_HULLS_H
#define RLF_TEST_HULLS_H

#include "relief/math.h"
#include "relief/world.h"

/* Of an octahedron whose corners are +x, -x, +y, -y, +z, -z. */
static const int32_t OCTAHEDRON_FACES[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                             2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

/* A body turned about the y axis, as on a lathe: rings of corners, from the one with the largest y
 * on. Flat at both ends. */
#define TURNED_RINGS 24
#define TURNED_SIDES 24

typedef struct turned_ring {
    double y, radius;
} turned_ring;

typedef struct turned_hull {
    rlf_vec3 vertices[TURNED_RINGS * TURNED_SIDES];
    int32_t triangles[6 * TURNED_RINGS * TURNED_SIDES];
    rlf_hull hull;
} turned_hull;

static inline void turned_hull_make(turned_hull *out, const turned_ring *rings, int count,
                                    int sides)
{
    int32_t n = 0;
    for (int r = 0; r < count; r++) {
        for (int s = 0; s < sides; s++) {
            const double turn = 2 * RLF_PI * s / sides, radius = rings[r].radius;
            const int32_t a = r * sides + s, b = r * sides + (s + 1) % sides;
            const int32_t side[6] = {a, b, a + sides, b, b + sides, a + sides};
            out->vertices[a] =
                rlf_vec3_make(radius * rlf_cos(turn), rings[r].y, radius * rlf_sin(turn));
            for (int k = 0; k < 6 && r + 1 < count; k++) {
                out->triangles[n++] = side[k];
            }
        }
    }
    for (int s = 1; s + 1 < sides; s++) {
        const int32_t last = (count - 1) * sides;
        const int32_t caps[6] = {0, s + 1, s, last, last + s, last + s + 1};
        for (int k = 0; k < 6; k++) {
            out->triangles[n++] = caps[k];
        }
    }
    out->hull = (rlf_hull){out->vertices, count * sides, out->triangles, n / 3};
}

#endif
