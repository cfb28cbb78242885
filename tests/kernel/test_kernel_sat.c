/* Separating axes in lanes against the corners of the boxes. */

#include "analytic.h"
#include "kernel/lanes.h"
#include "relief/math.h"
#include "test.h"

#include <math.h>

#define EXACT 1e-12
#define GAIN 1e-3

typedef struct box {
    rlf_vec3 centre, axis[3];
    double half[3];
} box;

static double between(analytic_random *r, double low, double high)
{
    return low + (high - low) * random_uniform(r);
}

static box random_box(analytic_random *r, double spread)
{
    rlf_vec3 turn = {between(r, -3, 3), between(r, -3, 3), between(r, -3, 3)};
    rlf_mat3 R = rlf_quat_to_mat3(rlf_quat_from_rotation_vector(turn));
    box b = {.half = {between(r, 0.01, 0.2), between(r, 0.01, 0.2), between(r, 0.01, 0.2)}};
    b.centre = rlf_vec3_make(between(r, -spread, spread), between(r, -spread, spread), 2.0);
    for (int32_t i = 0; i < 3; i++) {
        b.axis[i] = rlf_vec3_make(R.m[0][i], R.m[1][i], R.m[2][i]);
    }
    return b;
}

/* Half the length of the box's shadow on n, from its corners. */
static double shadow(const box *b, rlf_vec3 n)
{
    double most = 0.0;
    for (int32_t corner = 0; corner < 8; corner++) {
        rlf_vec3 p = {0, 0, 0};
        for (int32_t i = 0; i < 3; i++) {
            p = rlf_mad(p, b->axis[i], (corner >> i & 1) != 0 ? b->half[i] : -b->half[i]);
        }
        most = rlf_max(most, rlf_dot(p, n));
    }
    return most;
}

static double gap_along(const box *a, const box *b, rlf_vec3 n)
{
    return fabs(rlf_dot(rlf_sub(a->centre, b->centre), n)) - shadow(a, n) - shadow(b, n);
}

static void load(rlf_sat_pairs *p, int32_t lane, const box *a, const box *b)
{
    rlf_vec3 way = rlf_sub(a->centre, b->centre);
    const double ways[3] = {way.x, way.y, way.z};
    for (int32_t i = 0; i < 3; i++) {
        const double of_a[3] = {a->axis[i].x, a->axis[i].y, a->axis[i].z};
        const double of_b[3] = {b->axis[i].x, b->axis[i].y, b->axis[i].z};
        for (int32_t k = 0; k < 3; k++) {
            p->axis_a[i][k][lane] = of_a[k];
            p->axis_b[i][k][lane] = of_b[k];
        }
        p->half_a[i][lane] = a->half[i];
        p->half_b[i][lane] = b->half[i];
        p->way[i][lane] = ways[i];
    }
    p->margin[lane] = 0.01;
    p->edge_gain[lane] = GAIN;
}

static void check_faces(const rlf_sat_axes *axes, int32_t lane, const box *a, const box *b)
{
    double best = -1e30;
    int32_t code = (int32_t)axes->code[lane];
    for (int32_t i = 0; i < 3; i++) {
        best = rlf_max(best, rlf_max(gap_along(a, b, a->axis[i]), gap_along(a, b, b->axis[i])));
    }
    rlf_vec3 n = code < 3 ? a->axis[code] : b->axis[code - 3];
    assert_true(fabs(axes->gap[lane] - gap_along(a, b, n)) < EXACT);
    assert_true(axes->gap[lane] > best - 1e-5);
    assert_true(axes->sign[lane] * rlf_dot(n, rlf_sub(a->centre, b->centre)) >= 0.0);
}

/* Those that are not to be looked at are no better than the face. Returns how many are. */
static int32_t check_edges(const rlf_sat_axes *axes, int32_t lane, const box *a, const box *b)
{
    int32_t edges = (int32_t)axes->edges[lane], count = 0;
    if (axes->gap[lane] > 0.01) {
        assert_int_equal(edges, 0);
        return 0;
    }
    for (int32_t n = 0; n < 9; n++) {
        rlf_vec3 cross = rlf_cross(a->axis[n / 3], b->axis[n % 3]);
        double length = rlf_length(cross);
        assert_true(fabs(axes->cosine[n][lane] - rlf_dot(a->axis[n / 3], b->axis[n % 3])) < EXACT);
        if (length > 1e-3) {
            double gap = gap_along(a, b, rlf_scale(cross, 1.0 / length));
            assert_true(fabs(axes->edge_gap[n][lane] / length - gap) < 1e-9);
            assert_true((edges >> n & 1) != 0 || gap <= axes->gap[lane] + GAIN + 1e-9);
        }
        count += edges >> n & 1;
    }
    return count;
}

TEST_CASE(axes_are_those_of_the_corners)
{
    analytic_random r = {9};
    int32_t count = 0;
    for (int32_t run = 0; run < 500; run++) {
        box a[RLF_SAT_LANES], b[RLF_SAT_LANES];
        rlf_sat_pairs pairs;
        rlf_sat_axes axes;
        for (int32_t lane = 0; lane < RLF_SAT_LANES; lane++) {
            a[lane] = random_box(&r, 0.15);
            b[lane] = random_box(&r, 0.15);
            load(&pairs, lane, &a[lane], &b[lane]);
        }
        rlf_kernel_sat_find(&pairs, &axes);
        for (int32_t lane = 0; lane < RLF_SAT_LANES; lane++) {
            check_faces(&axes, lane, &a[lane], &b[lane]);
            count += check_edges(&axes, lane, &a[lane], &b[lane]);
        }
    }
    assert_true(count > 100);
}
