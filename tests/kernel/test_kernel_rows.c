/* Row kernels against their definition written out pixel by pixel, at odd sizes. */

#include "analytic.h"
#include "kernel/kernel.h"
#include "test.h"

#include <math.h>

enum { LONGEST = 70 };

/* Depth with holes and jumps. */
static void random_depth(analytic_random *r, float *depth, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        double u = random_uniform(r);
        depth[i] = u < 0.15 ? 0.0f : (float)(u < 0.6 ? 2.0 + 0.02 * u : 1.0 + u);
    }
}

TEST_CASE(depth_row_is_units_and_reasons)
{
    analytic_random r = {1};
    const rlf_kernel_range range = {0.5f, 4.5f, 0.001f};
    for (int32_t count = 1; count <= LONGEST; count++) {
        for (int32_t step = 1; step <= 3; step++) {
            uint16_t source[3 * LONGEST];
            float depth[LONGEST + 1] = {0};
            uint8_t reason[LONGEST + 1] = {0};
            for (int32_t i = 0; i < count * step; i++) {
                source[i] = (uint16_t)(random_uniform(&r) < 0.2 ? 0 : 6000 * random_uniform(&r));
            }
            depth[count] = -7.0f;
            reason[count] = 99;
            rlf_kernel_depth_row_u16(source, step, count, range, depth, reason);
            for (int32_t i = 0; i < count; i++) {
                int mm = source[i * step];
                int expected = mm == 0     ? RLF_REASON_NO_RETURN
                               : mm < 500  ? RLF_REASON_TOO_NEAR
                               : mm > 4500 ? RLF_REASON_TOO_FAR
                                           : RLF_REASON_OK;
                assert_int_equal(reason[i], expected);
                assert_true(depth[i] == (expected == RLF_REASON_OK ? (float)mm * 0.001f : 0.0f));
            }
            assert_true(depth[count] == -7.0f && reason[count] == 99);
        }
    }
}

static int near_enough(float a, float b, float tolerance)
{
    return (a > b ? a - b : b - a) <= tolerance;
}

static bool kept_by_definition(float rows[3][LONGEST + 2], int32_t i)
{
    float z = rows[1][i + 1];
    float tolerance = 0.012f * z + 0.004f;
    int close = 0, pairs = 0;
    for (int dy = -1; dy <= 1; dy++) {
        for (int dx = -1; dx <= 1; dx++) {
            if (dx == 0 && dy == 0) {
                continue;
            }
            float a = rows[1 + dy][i + 1 + dx], b = rows[1 - dy][i + 1 - dx];
            close += near_enough(a, z, tolerance);
            bool first = dy < 0 || (dy == 0 && dx < 0);
            pairs +=
                first && near_enough(a + b, 2.0f * z, tolerance) && near_enough(a, z, 0.06f * z);
        }
    }
    return close >= 3 || pairs >= 2;
}

TEST_CASE(flying_row_is_its_definition)
{
    analytic_random r = {2};
    int removed = 0, kept = 0;
    for (int32_t count = 1; count <= LONGEST; count++) {
        float rows[3][LONGEST + 2];
        float depth[LONGEST];
        uint8_t reason[LONGEST] = {0};
        memset(rows, 0, sizeof rows);
        for (int k = 0; k < 3; k++) {
            random_depth(&r, rows[k] + 1, count);
        }
        const float *const in[3] = {rows[0] + 1, rows[1] + 1, rows[2] + 1};
        rlf_kernel_flying_row(in, count, depth, reason);
        for (int32_t i = 0; i < count; i++) {
            float z = rows[1][i + 1];
            bool keep = kept_by_definition(rows, i);
            assert_true(depth[i] == (keep ? z : 0.0f));
            assert_int_equal(reason[i], z > 0.0f && !keep ? RLF_REASON_FLYING : RLF_REASON_OK);
            removed += z > 0.0f && !keep;
            kept += keep;
        }
    }
    assert_true(removed > 50 && kept > 50);
}

static float size_of(float a)
{
    return a < 0.0f ? -a : a;
}

/* Both steps from the middle one of five are long, in one direction, alike, and twice those beyond.
 */
static bool half_way_by_definition(const float five[5])
{
    float down = five[1] - five[2], up = five[2] - five[3];
    float least = size_of(down) < size_of(up) ? size_of(down) : size_of(up);
    bool level =
        2.0f * size_of(five[0] - five[1]) < least && 2.0f * size_of(five[4] - five[3]) < least;
    bool alike = size_of(down) + size_of(up) < 6.0f * least;
    return down * up > 0.0f && least > 0.0025f * five[2] * five[2] + 0.003f && alike && level;
}

/* Rows of random depths, with two pixels and two rows around. */
TEST_CASE(half_way_row_is_its_definition)
{
    enum { AT = 2 };
    analytic_random r = {21};
    int removed = 0, kept = 0;
    for (int32_t count = 1; count <= LONGEST; count++) {
        float rows[5][LONGEST + 2 * AT], depth[LONGEST + 2 * AT];
        uint8_t reason[LONGEST + 2 * AT] = {0};
        const float *in[5];
        for (int k = 0; k < 5; k++) {
            int32_t edge = (int32_t)(random_uniform(&r) * (count + 2 * AT));
            for (int32_t i = 0; i < count + 2 * AT; i++) { /* noise about two levels and between */
                double level = i < edge ? 2.0 : i > edge ? 2.1 : 2.05;
                rows[k][i] = (float)(level + 0.01 * random_uniform(&r));
            }
            in[k] = rows[k];
        }
        memcpy(depth, rows[AT], sizeof depth);
        rlf_kernel_half_way_row(in, AT, count + AT, depth, reason);
        for (int32_t i = AT; i < count + AT; i++) {
            const float *at = rows[AT] + i;
            const float across[5] = {at[-2], at[-1], at[0], at[1], at[2]};
            const float along[5] = {rows[0][i], rows[1][i], at[0], rows[3][i], rows[4][i]};
            bool half_way = half_way_by_definition(across) || half_way_by_definition(along);
            assert_true(depth[i] == (half_way ? 0.0f : at[0]));
            assert_int_equal(reason[i], half_way ? RLF_REASON_FLYING : RLF_REASON_OK);
            removed += half_way;
            kept += !half_way;
        }
    }
    assert_true(removed > 50 && kept > 50);
}

/* A column of mixed pixels between two levels goes; a plane as steep as its steps stays. */
TEST_CASE(a_column_half_way_is_flying)
{
    const float edge[7] = {2.8f, 2.8f, 2.8f, 2.75f, 2.7f, 2.7f, 2.7f};
    const float steep[7] = {2.9f, 2.85f, 2.8f, 2.75f, 2.7f, 2.65f, 2.6f};
    const float *const edges[5] = {edge, edge, edge, edge, edge};
    const float *const slope[5] = {steep, steep, steep, steep, steep};
    float depth[7];
    uint8_t reason[7] = {0};
    memcpy(depth, edge, sizeof depth);
    rlf_kernel_half_way_row(edges, 2, 5, depth, reason);
    for (int i = 0; i < 7; i++) {
        assert_int_equal(reason[i], i == 3 ? RLF_REASON_FLYING : RLF_REASON_OK);
        assert_true(depth[i] == (i == 3 ? 0.0f : edge[i]));
    }
    memset(reason, 0, sizeof reason);
    memcpy(depth, steep, sizeof depth);
    rlf_kernel_half_way_row(slope, 2, 5, depth, reason);
    for (int i = 0; i < 7; i++) {
        assert_int_equal(reason[i], RLF_REASON_OK);
    }
}

TEST_CASE(majority_row_is_its_definition)
{
    analytic_random r = {3};
    for (int32_t count = 1; count <= LONGEST; count++) {
        uint8_t seen[3][LONGEST], out[LONGEST];
        for (int k = 0; k < 3; k++) {
            for (int32_t i = 0; i < count; i++) {
                bool missing = random_uniform(&r) < 0.1;
                seen[k][i] = (uint8_t)(missing ? RLF_SEEN_MISSING : 2.2 * random_uniform(&r));
            }
        }
        const uint8_t *const rows[3] = {seen[0], seen[1], seen[2]};
        rlf_kernel_majority_row(rows, count, out);
        for (int32_t i = 0; i < count; i++) {
            int votes = 0, valid = 0;
            for (int k = 0; k < 3; k++) {
                for (int32_t x = i - 1; x <= i + 1; x++) {
                    bool inside = x >= 0 && x < count;
                    votes += inside && seen[k][x] == RLF_SEEN_FOREGROUND;
                    valid += inside && seen[k][x] != RLF_SEEN_MISSING;
                }
            }
            int expected = seen[1][i] == RLF_SEEN_UNKNOWN ? RLF_SEEN_UNKNOWN
                           : seen[1][i] == RLF_SEEN_FOREGROUND && 2 * votes > valid
                               ? RLF_SEEN_FOREGROUND
                               : RLF_SEEN_BACKGROUND;
            assert_int_equal(out[i], expected);
        }
    }
}

/* The model of one pixel, told as a story. */
TEST_CASE(background_row_follows_the_evidence)
{
    rlf_kernel_background params = {{0.0015f, -0.0005f, 0.0003f}, 6.0f, 0.02f, true};
    float mean = 0.0f, deviation = 0.0f;
    uint8_t weight = 0, beyond = 0, seen = 9;
    const rlf_kernel_model model = {&mean, &deviation, &weight, &beyond};
    const float learnt[3] = {2.0f, 2.004f, 0.0f};
    for (int k = 0; k < 3; k++) {
        rlf_kernel_background_row(&params, &learnt[k], 1, &model, &seen);
        assert_int_equal(seen, learnt[k] > 0.0f ? RLF_SEEN_BACKGROUND : RLF_SEEN_MISSING);
    }
    assert_true(near_enough(mean, 2.002f, 1e-6f));
    assert_int_equal(weight, 2);
    assert_true(near_enough(deviation, 0.002f, 1e-6f));
    params.learning = false;
    const float nearer = 1.9f, farther = 2.5f, missing = 0.0f, same = 2.002f;
    rlf_kernel_background_row(&params, &nearer, 1, &model, &seen);
    assert_int_equal(seen, RLF_SEEN_FOREGROUND);
    for (int k = 0; k < 2; k++) { /* twice, then interrupted: no proof */
        rlf_kernel_background_row(&params, &farther, 1, &model, &seen);
    }
    rlf_kernel_background_row(&params, &same, 1, &model, &seen);
    assert_int_equal(beyond, 0);
    assert_true(near_enough(mean, 2.002f, 1e-5f));
    for (int k = 0; k < 3; k++) { /* a missing sample says nothing */
        int32_t changed = rlf_kernel_background_row(&params, &farther, 1, &model, &seen);
        assert_int_equal(changed, k == 2);
        rlf_kernel_background_row(&params, &missing, 1, &model, &seen);
    }
    assert_true(mean == 2.5f);
    assert_int_equal(weight, 1);
    for (int k = 0; k < 300; k++) { /* long memory, but not endless */
        rlf_kernel_background_row(&params, &farther, 1, &model, &seen);
    }
    assert_int_equal(weight, 32);
    mean = 0.0f;
    rlf_kernel_background_row(&params, &same, 1, &model, &seen);
    assert_int_equal(seen, RLF_SEEN_UNKNOWN);
    assert_true(mean == 0.0f);
}

/* Tiles write their own pixels only, whatever their size. */
TEST_CASE(plane_tile_stays_in_its_tile)
{
    enum { W = 75, H = 71 };
    static float depth[W * H], ray_x[W * H], ray_y[W * H], out[3][W * H];
    for (int i = 0; i < W * H; i++) {
        ray_x[i] = 0.01f * (float)(i % W - 30);
        ray_y[i] = 0.01f * (float)(i / W - 30);
        depth[i] = 2.0f;
        out[0][i] = out[1][i] = out[2][i] = 5.0f;
    }
    rlf_kernel_tile tile = {.width = W,
                            .height = H,
                            .x0 = 64,
                            .y0 = 64,
                            .x1 = W,
                            .y1 = H,
                            .depth = depth,
                            .ray_x = ray_x,
                            .ray_y = ray_y,
                            .noise = {0.0015f, -0.0005f, 0.0003f},
                            .out_x = out[0],
                            .out_y = out[1],
                            .out_z = out[2]};
    rlf_kernel_plane_tile(&tile);
    for (int i = 0; i < W * H; i++) {
        bool inside = i % W >= 64 && i / W >= 64;
        assert_true(near_enough(out[2][i], inside ? -1.0f : 5.0f, 1e-4f));
    }
}

/* One pixel by itself: what is off the mean by more than the gate begins again, what is not seen in
 * front any more is forgotten as soon as something farther is seen. */
TEST_CASE(still_row_is_its_definition)
{
    enum { COUNT = 200 };
    analytic_random r = {17};
    const rlf_kernel_still p = {{0.0015, -0.0005, 0.0003}, 3.0, 0.01f, 5000, 33};
    float depth[COUNT], still[COUNT], was[COUNT];
    uint16_t ms[COUNT], was_ms[COUNT];
    uint8_t front[COUNT], is_due[COUNT];
    for (int32_t i = 0; i < COUNT; i++) {
        front[i] = random_uniform(&r) < 0.7 ? 1 : 0;
        was[i] = still[i] = (float)(1.0 + 2.0 * random_uniform(&r));
        depth[i] = random_uniform(&r) < 0.2 ? 0.0f : still[i] + (float)(0.03 * random_uniform(&r));
        double ages = random_uniform(&r);
        was_ms[i] = ms[i] = ages < 0.2 ? 0 : ages < 0.4 ? 4990 : (uint16_t)(4000.0 * ages);
    }
    rlf_kernel_still_row(&p, front, depth, COUNT, still, ms, is_due);
    for (int32_t i = 0; i < COUNT; i++) {
        double gate = rlf_max(3.0 * rlf_depth_noise_sigma(&p.noise, depth[i]), (double)p.least);
        float off = depth[i] - was[i], mean = was[i] + off / 8.0f;
        bool is_new = was_ms[i] == 0 || rlf_max(off, -off) > (double)(float)gate;
        int32_t age = was_ms[i] + 33, ms_front = is_new ? 1 : age > 5000 ? 5000 : age;
        assert_true(still[i] == (!front[i] ? was[i] : is_new ? depth[i] : mean));
        assert_int_equal(ms[i], front[i] ? ms_front : depth[i] > 0.0f ? 0 : was_ms[i]);
        assert_int_equal(is_due[i], front[i] && !is_new && age >= 5000);
    }
}

TEST_CASE(chord_sums_are_their_definition)
{
    analytic_random r = {13};
    const rlf_kernel_chord_noise noise = {1e-5f, {2e-5f, 3e-5f}, 0.006f, 0.5f, 2.0f};
    for (int32_t count = 1; count <= RLF_CHORD_RUN; count++) {
        const rlf_kernel_chord chord = {4.5f, 5.5f + (float)count};
        float seen[RLF_CHORD_RUN];
        double n = 0.0, hy = 0.0;
        for (int32_t i = 0; i < count; i++) {
            seen[i] = random_uniform(&r) < 0.2 ? 0.0f : (float)(0.5 + 0.02 * random_uniform(&r));
            double k = 5 + i, left = k - chord.begin, right = chord.end - k;
            double h = noise.metres * sqrt(left * right);
            double below = noise.noise * left * right + noise.blur[0] * right * right +
                           noise.blur[1] * left * left;
            double weight = seen[i] > 0.0f ? left * right / below : 0.0;
            n += weight;
            hy += weight * h * (0.5 - (double)seen[i]) * 4.0;
        }
        rlf_kernel_chord_sums sums = {0};
        rlf_kernel_chord_sum(&chord, &noise, seen, 5, count, &sums);
        assert_true(rlf_max(sums.n - n, n - sums.n) <= 1e-5 * n);
        assert_true(rlf_max(sums.hy - hy, hy - sums.hy) <= 1e-4 * rlf_max(-hy, 1e-3));
    }
}

TEST_CASE(chord_solid_is_its_definition)
{
    const rlf_kernel_chord_solid solid = {0.7f, 0.5f, 0.001f, 0.02f};
    for (int32_t count = 1; count <= RLF_CHORD_RUN; count++) {
        const int32_t step = 1 + count % 2;
        const rlf_kernel_chord chord = {4.5f, 5.5f + (float)(step * count)};
        float weight[RLF_CHORD_RUN], middle[RLF_CHORD_RUN], half[RLF_CHORD_RUN];
        rlf_kernel_chord_solid_run(&chord, &solid, 5, step, count, weight, middle, half);
        for (int32_t i = 0; i < count; i++) {
            double k = 5 + step * i, left = k - chord.begin, right = chord.end - k;
            double w = solid.share / (left * right);
            double h = w * solid.half * sqrt(left * right);
            double m = w * (solid.middle + solid.slope * k);
            assert_true(rlf_max(weight[i] - w, w - weight[i]) <= 1e-5 * w);
            assert_true(rlf_max(middle[i] - m, m - middle[i]) <= 1e-5 * m);
            assert_true(rlf_max(half[i] - h, h - half[i]) <= 1e-5 * h);
        }
    }
}

TEST_CASE(thickness_ends_at_the_background)
{
    const rlf_kernel_thickness limits = {0.02f, 0.5f};
    const float depth[5] = {2.0f, 2.0f, 2.0f, 2.0f, 2.0f};
    const float behind[5] = {0.0f, 3.0f, 2.125f, 1.9f, 3.0f};
    float thickness[5] = {0.7f, 0.01f, 0.3f, 0.3f, 0.3f};
    const float expected[5] = {0.5f, 0.02f, 0.125f, 0.0f, 0.3f};
    rlf_kernel_thickness_row(&limits, depth, behind, 5, thickness);
    for (int i = 0; i < 5; i++) {
        assert_true(thickness[i] == expected[i]);
    }
}

/* A row that faces the camera and from `crease` on to the right; no normal from `end` on. Rows
 * above and below are the same. */
static void bend_of_faces(int32_t crease, int32_t end, uint8_t bend[16])
{
    float nx[16], ny[16] = {0}, nz[16], depth[16];
    for (int32_t i = 0; i < 16; i++) {
        nx[i] = i >= crease && i < end ? 1.0f : 0.0f;
        nz[i] = i < crease ? -1.0f : 0.0f;
        depth[i] = 2.0f;
    }
    const rlf_kernel_bend_in row = {{nx, ny, nz}, depth};
    const rlf_kernel_bend_in rows[5] = {row, row, row, row, row};
    rlf_kernel_bend_row(rows, 16, bend);
}

TEST_CASE(normals_bend_within_two_pixels_of_a_crease)
{
    uint8_t bend[16];
    bend_of_faces(8, 16, bend);
    for (int32_t i = 0; i < 16; i++) {
        assert_int_equal(bend[i], i >= 6 && i < 10 ? RLF_BEND_ACROSS : 0);
    }
}

TEST_CASE(a_face_of_two_pixels_is_not_all_crease)
{
    uint8_t bend[16];
    bend_of_faces(8, 10, bend);
    assert_int_equal(bend[7], RLF_BEND_ACROSS);
    assert_int_equal(bend[8], RLF_BEND_ACROSS);
    assert_int_equal(bend[9], 0);
    bend_of_faces(8, 9, bend);
    assert_int_equal(bend[8], RLF_BEND_ACROSS);
    bend_of_faces(8, 8, bend);
    for (int32_t i = 0; i < 8; i++) {
        assert_int_equal(bend[i], 0);
    }
}

/* In two runs, as a region's rows are. */
TEST_CASE(region_rows_are_sums_and_extents)
{
    enum { SUMS = 9 };
    analytic_random r = {2};
    for (int32_t count = 1; count <= LONGEST; count++) {
        float depth[LONGEST], ray[2][LONGEST];
        rlf_region_lanes lanes = {0}, turned;
        double sums[SUMS] = {0}, least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
        const rlf_region_axes axes = {{{0.6, 0.0, 0.8}, {0, 1, 0}, {0.8, 0.0, -0.6}},
                                      {0.1, 0.2, 2}};
        for (int32_t k = 0; k < 3 * RLF_REGION_LANES; k++) {
            lanes.least[k / RLF_REGION_LANES][k % RLF_REGION_LANES] = INFINITY;
            lanes.most[k / RLF_REGION_LANES][k % RLF_REGION_LANES] = -INFINITY;
        }
        turned = lanes;
        for (int32_t i = 0; i < count; i++) {
            depth[i] = 1.0f + (float)random_uniform(&r);
            ray[0][i] = (float)random_uniform(&r) - 0.5f;
            ray[1][i] = (float)random_uniform(&r) - 0.5f;
            double z = depth[i], x = z * ray[0][i], y = z * ray[1][i];
            double along = 0.6 * (x - 0.1) + 0.8 * (z - 2.0);
            const double of[SUMS] = {x, y, z, x * x, x * y, x * z, y * y, y * z, z * z};
            for (int k = 0; k < SUMS; k++) {
                sums[k] += of[k];
            }
            least[0] = fmin(least[0], y);
            most[0] = fmax(most[0], y);
            least[1] = fmin(least[1], along);
            most[1] = fmax(most[1], along);
        }
        int32_t part = count / 3;
        rlf_kernel_region_row(depth, ray[0], ray[1], part, &lanes);
        rlf_kernel_region_row(depth + part, ray[0] + part, ray[1] + part, count - part, &lanes);
        rlf_kernel_extent_row(&axes, depth, ray[0], ray[1], part, &turned);
        rlf_kernel_extent_row(&axes, depth + part, ray[0] + part, ray[1] + part, count - part,
                              &turned);
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (int32_t k = 0; k < RLF_REGION_LANES; k++) {
            for (int j = 0; j < SUMS; j++) {
                sums[j] -= j < 3 ? lanes.sum[j][k] : lanes.square[j - 3][k];
            }
            low[0] = fmin(low[0], lanes.least[1][k]);
            high[0] = fmax(high[0], lanes.most[1][k]);
            low[1] = fmin(low[1], turned.least[0][k]);
            high[1] = fmax(high[1], turned.most[0][k]);
        }
        for (int j = 0; j < SUMS; j++) {
            assert_true(fabs(sums[j]) < 1e-10);
        }
        for (int j = 0; j < 2; j++) {
            assert_true(fabs(low[j] - least[j]) < 1e-12 && fabs(high[j] - most[j]) < 1e-12);
        }
    }
}
