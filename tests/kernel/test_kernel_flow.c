/* Kernels of what moves and how thick it is against their definition. */

#include "analytic.h"
#include "kernel/flow.h"
#include "test.h"

#include <math.h>

enum { LONGEST = 70 };

static bool near_enough(float a, float b, float tolerance)
{
    return (a > b ? a - b : b - a) <= tolerance;
}

/* Straight from knot to knot, then the mean of 3x3 pixels: of squares, over one plane body. */
TEST_CASE(spread_row_is_its_definition)
{
    enum { KNOTS = 12, WIDE = 2 * KNOTS };
    analytic_random r = {7};
    for (int t = 0; t < 50; t++) {
        float depth[KNOTS + 2], value[3][KNOTS + 2], at[KNOTS], out[2][KNOTS];
        double rows[5][WIDE + 3];
        bool is_between = t % 2 != 0;
        for (int k = 0; k < KNOTS + 2; k++) {
            depth[k] = 2.0f;
            for (int row = 0; row < 3; row++) {
                value[row][k] = (float)random_uniform(&r);
            }
        }
        for (int y = 0; y < 5; y++) {
            for (int x = 0; x < WIDE + 3; x++) {
                double sum = 0.0;
                for (int k = 0; k < 4; k++) {
                    double v = value[(y + k / 2) / 2][(x + k % 2) / 2];
                    sum += 0.25 * v * v;
                }
                rows[y][x] = sum;
            }
        }
        for (int k = 0; k < KNOTS; k++) {
            at[k] = 2.0f;
        }
        rlf_kernel_knots knots = {.weight = {is_between ? 0.0f : 1.0f, is_between ? 3.0f : 4.0f,
                                             is_between ? 3.0f : 1.0f}};
        for (int row = 0; row < 3; row++) {
            knots.depth[row] = depth + 1;
            knots.value[row] = value[row] + 1;
        }
        rlf_kernel_spread_row(&knots, KNOTS, 0.04f, at, at, out[0], out[1]);
        for (int x = 0; x < WIDE; x++) {
            double sum = 0.0;
            for (int k = 0; k < 9; k++) {
                sum += rows[(is_between ? 2 : 1) + k / 3][x + 1 + k % 3] / 9.0;
            }
            double off = out[x % 2][x / 2] - sqrt(sum);
            assert_true(off < 1e-6 && off > -1e-6);
        }
        const float others[3] = {1.5f, 2.5f,
                                 -2.5f}; /* nearer ones and background, not their value */
        for (int k = 0; k < 3; k++) {
            float before = out[1][1];
            depth[2] = others[k];
            value[0][2] = value[1][2] = value[2][2] = 1e9f;
            rlf_kernel_spread_row(&knots, KNOTS, 0.04f, at, at, out[0], out[1]);
            assert_true(out[0][0] < 2.0f && out[1][1] < 2.0f);
            assert_true(k != 1 || out[1][1] < before); /* 0 where the body ends before another */
            assert_true(k != 2 || out[1][1] == before);
        }
    }
}

/* Cells of two limbs, one that rests and one that is not known. */
TEST_CASE(flow_row_is_its_definition)
{
    analytic_random r = {3};
    for (int32_t count = 1; count <= LONGEST; count++) {
        float depth[LONGEST], ray[2][LONGEST], out[3][LONGEST];
        for (int32_t i = 0; i < count; i++) {
            depth[i] = random_uniform(&r) < 0.5 ? 2.0f : 2.3f;
            ray[0][i] = (float)random_uniform(&r);
            ray[1][i] = (float)random_uniform(&r);
        }
        rlf_kernel_flow f = {.cell = {{{1, 2, 3}, 2.0f, true, false},
                                      {{-1, 0, 9}, 2.05f, true, false},
                                      {{7, 7, 7}, 2.3f, true, count % 3 == 0},
                                      {{5, 5, 5}, 2.0f, false, false}},
                             .twist = {{0.1, 0.2, 2.0}, {0.5, 0.6, 0.7}, {1.0, -2.0, 3.0}},
                             .moves = count % 2 == 0,
                             .first = 4,
                             .inverse = 1.0f / (float)(count + 2),
                             .column = -1.0f,
                             .down = 0.3f,
                             .limb = 0.1f,
                             .fastest = count % 5 == 0 ? 2.0f : 50.0f};
        float *const planes[3] = {out[0], out[1], out[2]};
        rlf_kernel_flow_row(&f, depth, ray[0], ray[1], count, planes);
        for (int32_t i = 0; i < count; i++) {
            double across = (4.0 + i + 0.5) / (count + 2) + 0.5, sum = 0.0;
            double z = depth[i], x = z * ray[0][i] - 0.1, y = z * ray[1][i] - 0.2;
            rlf_vec3 spin = rlf_cross(rlf_vec3_make(1, -2, 3), rlf_vec3_make(x, y, z - 2.0));
            rlf_vec3 whole = rlf_scale(rlf_add(rlf_vec3_make(0.5, 0.6, 0.7), spin), f.moves);
            rlf_vec3 v = {0, 0, 0};
            for (int k = 0; k < 3; k++) {
                const rlf_kernel_flow_cell *c = &f.cell[k];
                rlf_vec3 own = rlf_vec3_make(c->velocity[0], c->velocity[1], c->velocity[2]);
                double w = (k % 2 ? across : 1.0 - across) * (k / 2 ? 0.3 : 0.7) + 1e-4;
                w = near_enough(c->depth, depth[i], f.limb) ? w : 0.0;
                v = rlf_mad(v, c->is_whole ? whole : own, w);
                sum += w;
            }
            v = sum > 0.0 ? rlf_scale(v, 1.0 / sum) : whole;
            v = rlf_scale(v, rlf_min(1.0, f.fastest / rlf_max(rlf_length(v), 1e-9)));
            rlf_vec3 off = rlf_sub(v, rlf_vec3_make(out[0][i], out[1][i], out[2][i]));
            assert_true(rlf_length(off) < 1e-3);
        }
    }
}

/* Before a level wall, seen a frame ago from 3 cm nearer; the sample to the right leaves the view,
 * and one pixel saw nothing that moves. */
TEST_CASE(flow_residuals_are_distances)
{
    enum { WIDE = 20, HIGH = 3, COUNT = 20 };
    float depth[WIDE * HIGH], ray_x[WIDE * HIGH], ray_y[WIDE * HIGH], seen[WIDE * HIGH];
    uint8_t reason[WIDE * HIGH], front[WIDE * HIGH];
    for (int32_t i = 0; i < WIDE * HIGH; i++) {
        depth[i] = 2.0f;
        ray_x[i] = 0.01f * (float)(i % WIDE);
        ray_y[i] = 0.01f * (float)(i / WIDE);
        reason[i] = i == WIDE + 4 ? RLF_REASON_FILLED : RLF_REASON_OK;
        front[i] = i != WIDE + 7;
    }
    rlf_kernel_front_row(depth, reason, front, WIDE * HIGH, seen);
    const rlf_kernel_flow_view view = {seen, ray_x, ray_y, WIDE, HIGH, 100.0f, 100.0f, 0.05f};
    rlf_kernel_flow_samples s = {.nz = {0.0f}};
    for (int32_t i = 0; i < COUNT; i++) {
        s.column[i] = (float)i;
        s.row[i] = 1.0f;
        s.ray_x[i] = ray_x[i];
        s.ray_y[i] = 0.01f;
        s.x[i] = 2.03f * s.ray_x[i];
        s.y[i] = 2.03f * s.ray_y[i];
        s.z[i] = i == 9 ? 2.2f : 2.03f; /* another limb */
        s.nz[i] = -1.0f;
    }
    float out[COUNT];
    int32_t is_seen[COUNT];
    const float step[3] = {-0.02f, 0.0f, 0.0f}; /* one pixel to the right */
    rlf_kernel_flow_residuals(&view, &s, step, 2, COUNT - 2, out, is_seen);
    for (int32_t i = 2; i < COUNT; i++) {
        assert_int_equal(is_seen[i - 2], i != 3 && i != 6 && i != 9 && i != COUNT - 1);
        assert_true(!is_seen[i - 2] || near_enough(out[i - 2], -0.03f, 1e-5f));
    }
}

/* What chords of a region are cut in, of short and long rows. */
TEST_CASE(knots_are_their_definition)
{
    enum { LENGTH = 70, LABEL = 9 };
    analytic_random r = {29};
    float raw[2 * LENGTH], depth[2 * LENGTH], front[2 * LENGTH], inverse[LENGTH], knot[LENGTH];
    int32_t label[LENGTH];
    for (int32_t i = 0; i < 2 * LENGTH; i++) {
        raw[i] = random_uniform(&r) < 0.3 ? 0.0f : (float)(1.0 + random_uniform(&r));
        depth[i] = (float)(1.0 + random_uniform(&r));
        front[i] = random_uniform(&r) < 0.3 ? 0.0f : depth[i];
    }
    for (int32_t count = 0; count <= LENGTH; count++) {
        for (int32_t step = 1; step <= 2; step++) {
            rlf_kernel_knot_row(front, depth, step, count, knot);
            for (int32_t k = 0; k < count; k++) {
                float at = front[step * k];
                assert_true(knot[k] == (at > 0.0f ? at : -depth[step * k]));
            }
        }
        float own[LENGTH];
        rlf_kernel_chord_front(raw, depth, LABEL, count, own, inverse, label);
        for (int32_t i = 0; i < count; i++) {
            assert_true(own[i] == depth[i] && label[i] == LABEL);
            assert_true(inverse[i] == (raw[i] > 0.0f ? 1.0f / raw[i] : 0.0f));
        }
    }
}
