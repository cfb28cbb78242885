/* Sums over places that are off solids, and places beside axes, against their definitions. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "analytic.h"
#include "kernel/touch.h"

#include <math.h>

static double random_about(analytic_random *r, double middle, double reach)
{
    return middle + reach * (2.0 * random_uniform(r) - 1.0);
}

/* One touch after the other, and no sum but those at and left of the diagonal. */
static void touches_are_added_in_order(void **state)
{
    (void)state;
    analytic_random r = {3};
    rlf_kernel_equations sum = {0};
    double a[RLF_KERNEL_SLOPES][RLF_KERNEL_SLOPES] = {{0.0}}, b[RLF_KERNEL_SLOPES] = {0.0};
    for (int32_t count = 1; count <= RLF_KERNEL_RAYS; count++) {
        rlf_kernel_touches touches;
        double weight[RLF_KERNEL_RAYS];
        for (int32_t i = 0; i < count; i++) {
            weight[i] = i % 3 == 1 ? 0.0 : random_about(&r, 1.0, 0.9);
            touches.distance[i] = random_about(&r, 0.0, 0.1);
            for (int32_t k = 0; k < RLF_KERNEL_SLOPES; k++) {
                touches.slope[k][i] = (i + k) % 4 == 0 ? 0.0 : random_about(&r, 0.0, 1.0);
                double part = weight[i] * touches.slope[k][i];
                b[k] -= part * touches.distance[i];
                for (int32_t c = 0; c <= k; c++) {
                    a[k][c] += part * touches.slope[c][i];
                }
            }
        }
        rlf_kernel_add_touches(&touches, weight, count, &sum);
        for (int32_t k = 0; k < RLF_KERNEL_SLOPES; k++) {
            assert_true(sum.b[k] == b[k]);
            assert_memory_equal(sum.a[k], a[k], (size_t)(k + 1) * sizeof(double));
        }
    }
}

/* Places move along their rays to where these are nearest to the axis: no step along the ray is
 * nearer. */
static void places_beside_axes_are_nearest(void **state)
{
    (void)state;
    analytic_random r = {5};
    for (int32_t t = 0; t < 100; t++) {
        rlf_kernel_legs legs = {.least_aslant = 0.1};
        rlf_kernel_places places = {.count = RLF_KERNEL_RAYS};
        double axis[RLF_KERNEL_RAYS], length = 0.0;
        for (int32_t k = 0; k < 3; k++) {
            legs.unit[1][k] = random_about(&r, 0.0, 1.0);
            legs.axis[1].begin[k] = random_about(&r, 0.0, 1.0);
            length += legs.unit[1][k] * legs.unit[1][k];
            legs.camera[k] = k == 2 ? -3.0 : 0.0;
        }
        for (int32_t k = 0; k < 3; k++) {
            legs.unit[1][k] /= sqrt(length);
        }
        for (int32_t i = 0; i < RLF_KERNEL_RAYS; i++) {
            axis[i] = 1.0;
            places.side[i] = random_about(&r, 0.0, 1.0);
            places.down[i] = random_about(&r, 0.0, 1.0);
            places.ahead[i] = random_about(&r, 0.0, 0.5);
        }
        rlf_kernel_places moved = places;
        rlf_kernel_legs_beside(&legs, axis, &moved);
        for (int32_t i = 0; i < RLF_KERNEL_RAYS; i++) {
            const double *b = legs.axis[1].begin, *u = legs.unit[1];
            double way[3] = {places.side[i], places.down[i], places.ahead[i] + 3.0};
            double p[3] = {moved.side[i] - b[0], moved.down[i] - b[1], moved.ahead[i] - b[2]};
            double along = p[0] * u[0] + p[1] * u[1] + p[2] * u[2], change = 0.0, size = 0.0;
            double cosine = way[0] * u[0] + way[1] * u[1] + way[2] * u[2];
            for (int32_t k = 0; k < 3; k++) { /* of the squared distance, per step */
                change += way[k] * (p[k] - along * u[k]);
                size += way[k] * way[k];
            }
            if (1.0 - cosine * cosine / size > 0.1001) {
                assert_true(fabs(change) < 1e-9);
            } else if (1.0 - cosine * cosine / size < 0.0999) {
                assert_true(moved.side[i] == places.side[i]);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(touches_are_added_in_order),
                                       cmocka_unit_test(places_beside_axes_are_nearest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
