/* Batch kernels against their definition written out pixel by pixel. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "analytic.h"
#include "kernel/outline.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 41, HEIGHT = 7, COUNT = WIDTH * HEIGHT };

static void windows_are_copies_with_zeros_about(void **state)
{
    (void)state;
    float plane[COUNT];
    for (int32_t i = 0; i < COUNT; i++) {
        plane[i] = (float)(i + 1);
    }
    for (int32_t i = 0; i < COUNT; i++) {
        rlf_windows w;
        int32_t lane = i % RLF_BATCH;
        rlf_windows_read(plane, WIDTH, HEIGHT, i % WIDTH, i / WIDTH, lane, &w);
        for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
            int32_t x = i % WIDTH + k % 5 - 2, y = i / WIDTH + k / 5 - 2;
            bool inside = x >= 0 && y >= 0 && x < WIDTH && y < HEIGHT;
            assert_true(w.at[k][lane] == (inside ? plane[y * WIDTH + x] : 0.0f));
        }
    }
}

static int about_by_definition(const rlf_windows *seen, float inverse, int32_t i)
{
    int about = 0;
    for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
        int dx = abs(k % 5 - 2), dy = abs(k / 5 - 2), far = dx > dy ? dx : dy;
        double z = seen->at[k][i], off = fabs((double)inverse * fabs(z) - 1.0);
        about |= z < 0.0 ? RLF_ABOUT_MOVED : 0;
        about |= z != 0.0 && off <= 0.01 * far + 0.01 ? RLF_ABOUT_CONTINUED : 0;
    }
    return about;
}

static void recall_batch_is_its_definition(void **state)
{
    (void)state;
    analytic_random r = {8};
    int counts[4] = {0};
    for (int32_t t = 0; t < 400; t++) {
        rlf_windows seen;
        float inverse[RLF_BATCH];
        uint8_t about[RLF_BATCH];
        double moved = t % 2 == 0 ? 0.0 : 0.03, share = 0.4 * random_uniform(&r);
        for (int32_t k = 0; k < RLF_WINDOW_SIZE * RLF_BATCH; k++) {
            double u = random_uniform(&r), sign = u < moved ? -1.0 : u < share + moved ? 1.0 : 0.0;
            double z = 2.0 + 1.5 * random_uniform(&r);
            seen.at[k / RLF_BATCH][k % RLF_BATCH] = (float)(sign * z);
        }
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            inverse[i] = (float)(1.0 / (2.0 + 1.5 * random_uniform(&r)));
        }
        rlf_kernel_recall_batch(&seen, inverse, about);
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            assert_int_equal(about[i], about_by_definition(&seen, inverse[i], i));
            counts[about[i]]++;
        }
    }
    for (int k = 0; k < 4; k++) {
        assert_true(counts[k] > 100);
    }
}

/* Steps from the middle to the first pixel with depth. */
static int steps_to_depth(const rlf_gap_patch *p, int32_t i, int32_t dx, int32_t dy)
{
    for (int d = 1; d <= RLF_FILL_GAP; d++) {
        if (p->has[RLF_FILL_GAP + d * dy][RLF_FILL_GAP + i + d * dx] != 0) {
            return d;
        }
    }
    return RLF_FILL_GAP + 1;
}

static void gap_patch_finds_the_shortest_gap(void **state)
{
    (void)state;
    static const int32_t along[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    analytic_random r = {9};
    int counts[5] = {0};
    for (int32_t t = 0; t < 600; t++) {
        rlf_gap_patch p;
        rlf_gaps gaps;
        double share = 0.25 * random_uniform(&r);
        for (int32_t k = 0; k < RLF_GAP_HEIGHT * RLF_GAP_WIDTH; k++) {
            p.has[k / RLF_GAP_WIDTH][k % RLF_GAP_WIDTH] = random_uniform(&r) < share;
        }
        rlf_kernel_gap_patch(&p, &gaps);
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            int line = RLF_LINE_NONE, best = RLF_FILL_GAP + 2;
            for (int k = 0; k < 4 && (k < 2 || line == RLF_LINE_NONE); k++) {
                int span = steps_to_depth(&p, i, -along[k][0], -along[k][1]) +
                           steps_to_depth(&p, i, along[k][0], along[k][1]);
                bool taken = span < best && span <= (k < 2 ? RLF_FILL_GAP + 1 : 4);
                line = taken ? k : line;
                best = taken ? span : best;
            }
            assert_int_equal(gaps.line[i], line);
            if (line != RLF_LINE_NONE) {
                const int32_t *d = along[line];
                assert_int_equal(gaps.to_before[i], steps_to_depth(&p, i, -d[0], -d[1]));
                assert_int_equal(gaps.to_after[i], steps_to_depth(&p, i, d[0], d[1]));
            }
            counts[line]++;
        }
    }
    for (int k = 0; k < 5; k++) {
        assert_true(counts[k] > 50);
    }
}

/* A missing pixel between a wall at 3 m and, right of it, above and below, one at `right`. */
static void fill_column(float right, float out[RLF_BATCH], uint8_t kind[RLF_BATCH])
{
    rlf_windows depth;
    rlf_gap_ends ends;
    float votes[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
            depth.at[k][i] = k % 5 < 2 ? 3.0f : right;
        }
        depth.at[12][i] = 0.0f;
        ends.before[i] = 3.0f;
        ends.after[i] = right;
        ends.to_before[i] = ends.to_after[i] = 1.0f;
        ends.most_apart[i] = 0.05f;
    }
    rlf_kernel_fill_votes(&depth, &ends, votes);
    rlf_kernel_fill_batch(&depth, &ends, votes, out, kind);
}

static void fill_batch_continues_the_side_with_more_votes(void **state)
{
    (void)state;
    float out[RLF_BATCH];
    uint8_t kind[RLF_BATCH];
    fill_column(2.0f, out, kind);
    assert_int_equal(kind[8], RLF_FILL_NEAR);
    assert_true(out[8] == 2.0f);
    fill_column(4.0f, out, kind);
    assert_int_equal(kind[8], RLF_FILL_FAR);
    assert_true(out[8] == 4.0f);
    fill_column(3.03f, out, kind); /* one slanted surface */
    assert_int_equal(kind[8], RLF_FILL_BETWEEN);
    double off = out[8] - 2.0 / (1.0 / 3.0 + 1.0 / 3.03);
    assert_true(off < 1e-6 && off > -1e-6);
}

/* Columns that are missing between one at `left` and, as wide, one at `right`. */
static void fill_batch_gives_a_tie_to_the_nearer_side(void **state)
{
    (void)state;
    rlf_windows depth;
    rlf_gap_ends ends;
    float votes[RLF_BATCH], out[RLF_BATCH];
    uint8_t kind[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float left = i % 2 == 0 ? 2.0f : 4.0f, right = 6.0f - left;
        for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
            depth.at[k][i] = k % 5 < 2 ? left : k % 5 > 2 ? right : 0.0f;
        }
        ends.before[i] = left;
        ends.after[i] = right;
        ends.to_before[i] = ends.to_after[i] = 1.0f;
        ends.most_apart[i] = 0.05f;
    }
    rlf_kernel_fill_votes(&depth, &ends, votes);
    rlf_kernel_fill_batch(&depth, &ends, votes, out, kind);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        assert_int_equal(kind[i], RLF_FILL_NEAR);
        assert_true(out[i] == 2.0f);
    }
}

/* A box's front at 2 m before a wall at 4 m, and another one's, at 2.5 m or 1.6 m, in the rows
 * above that the hole is in: the front goes on as it is. */
static void fill_batch_leaves_a_third_surface_out(void **state)
{
    (void)state;
    rlf_windows depth;
    rlf_gap_ends ends;
    float votes[RLF_BATCH], out[RLF_BATCH];
    uint8_t kind[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
            float third = i % 2 == 0 ? 2.5f : 1.6f;
            depth.at[k][i] = k < 5 ? third : k % 5 < 3 ? 2.0f : 4.0f;
        }
        depth.at[12][i] = 0.0f;
        ends.before[i] = 2.0f;
        ends.after[i] = 4.0f;
        ends.to_before[i] = ends.to_after[i] = 1.0f;
        ends.most_apart[i] = 0.05f;
    }
    rlf_kernel_fill_votes(&depth, &ends, votes);
    rlf_kernel_fill_batch(&depth, &ends, votes, out, kind);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        assert_int_equal(kind[i], RLF_FILL_NEAR);
        assert_true(out[i] == 2.0f);
    }
}

/* Half of what is about the pixels lies a metre behind: the outline is at its border. */
static void outlines_point_to_what_is_behind(void **state)
{
    (void)state;
    for (int32_t t = 0; t < 8; t++) {
        double angle = 0.25 * 3.14159265358979 * t, x = cos(angle), y = sin(angle);
        rlf_windows depth;
        rlf_outlines found;
        for (int32_t k = 0; k < RLF_WINDOW_SIZE * RLF_BATCH; k++) {
            int32_t at = k / RLF_BATCH;
            bool behind = x * (at % 5 - 2) + y * (at / 5 - 2) > 0.9;
            depth.at[at][k % RLF_BATCH] = behind && k % 2 == 0 ? 3.0f : 2.0f;
        }
        rlf_kernel_outline_find(&depth, RLF_OUTLINE_STEP_FILLED, &found);
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            if (i % 2 != 0) {
                assert_true(found.distance[i] == 0.0f);
                continue;
            }
            assert_true(fabs(found.x[i] - x) < 0.01 && fabs(found.y[i] - y) < 0.01);
            double nearest = t % 2 == 0 ? 1.0 : sqrt(2.0);
            assert_true(fabs(found.distance[i] + 0.5 - nearest) < 1e-6);
        }
    }
}

/* A face, or a slope of 0.4 percent of the depth a pixel, and what lies 1.5, 2.5 or 4.5 percent
 * farther behind it: an outline where that is more than the step asked for, on both alike. */
static void slopes_have_no_outlines(void **state)
{
    (void)state;
    const float slopes[2] = {0.0f, 0.004f}, steps[4] = {0.0f, 0.015f, 0.025f, 0.045f};
    rlf_windows depth;
    rlf_outlines seen, filled;
    for (int32_t k = 0; k < RLF_WINDOW_SIZE * RLF_BATCH; k++) {
        int32_t x = k / RLF_BATCH % RLF_WINDOW_SIDE - RLF_WINDOW_ABOUT, i = k % RLF_BATCH;
        float z = 2.0f + 2.0f * slopes[i / 4 % 2] * (float)x;
        depth.at[k / RLF_BATCH][i] = x == RLF_WINDOW_ABOUT ? z + 2.0f * steps[i % 4] : z;
    }
    rlf_kernel_outline_find(&depth, RLF_OUTLINE_STEP_SEEN, &seen);
    rlf_kernel_outline_find(&depth, RLF_OUTLINE_STEP_FILLED, &filled);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        assert_true((seen.distance[i] > 0.0f) == (i % 4 >= 1));
        assert_true((filled.distance[i] > 0.0f) == (i % 4 >= 2));
        assert_true(seen.distance[i] == 0.0f || seen.x[i] > 0.99f);
    }
}

/* On a ball or a cylinder the sine of the angle to the ray falls linearly from 1 at the outline;
 * windows find it 1.2 pixels farther in. A flat face has no outline that it turns to. */
static void windows_near_an_outline_are_moved_out(void **state)
{
    (void)state;
    const double radius = 20.0, inside = 1.2;
    rlf_outlines at;
    rlf_way_in in;
    memset(&in, 0, sizeof in);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        at.x[i] = 1.0f;
        at.y[i] = 0.0f;
        at.distance[i] = 0.5f + 0.25f * (float)i;
        in.moves[i] = 1.0f;
        for (int32_t k = 0; k < RLF_OUTLINE_STEPS; k++) {
            in.s[k][i] = at.distance[i] + (float)k;
            double out = i % 2 != 0 ? 0.5 : 1.0 - (in.s[k][i] + inside) / radius;
            in.normal[k].x[i] = (float)out;
            in.normal[k].z[i] = (float)-sqrt(1.0 - out * out);
        }
    }
    rlf_normals found;
    rlf_kernel_outline_near(&at, &in, &found);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        double out = 1.0 - at.distance[i] / radius, z = -sqrt(1.0 - out * out);
        bool turns = i % 2 == 0;
        assert_true(fabs(found.x[i] - (turns ? out : 0.0)) < 1e-5);
        assert_true(fabs(found.z[i] - (turns ? z : 0.0)) < 1e-5);
    }
}

/* Two faces or folds, in turn, beside an outline: what is not flat leans out by a tangent of 0.4
 * within two pixels of it, unless it is known of less than three pixels. */
static void what_is_uneven_leans_out_beside_its_outline(void **state)
{
    (void)state;
    const double lean = 0.4;
    rlf_outlines at;
    rlf_way_in in;
    memset(&in, 0, sizeof in);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        at.x[i] = 1.0f;
        at.y[i] = 0.0f;
        at.distance[i] = i < 8 ? 1.5f : 2.5f;
        in.moves[i] = 1.0f;
        double by = i % 2 == 0 ? 0.05 : 0.01; /* of a flat thing's noise, or more */
        for (int32_t k = 0; k < (i % 4 < 2 ? RLF_OUTLINE_STEPS : 2); k++) {
            double out = 0.2 + (k % 2 == 0 ? by : -by);
            in.s[k][i] = at.distance[i] + (float)k;
            in.normal[k].x[i] = (float)out;
            in.normal[k].z[i] = (float)-sqrt(1.0 - out * out);
        }
    }
    rlf_normals found;
    rlf_kernel_outline_near(&at, &in, &found);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        double own = in.normal[0].x[i], length = sqrt(1.0 + 2.0 * own * lean + lean * lean);
        bool leans = i < 8 && i % 4 == 0;
        assert_true(fabs(found.x[i] - (leans ? (own + lean) / length : 0.0)) < 1e-5);
        assert_true(fabs(found.z[i] - (leans ? in.normal[0].z[i] / length : 0.0)) < 1e-5);
    }
}

/* What is known of one face leans by 0.3: something rounded leans out more beside it, as a face it
 * has no other normal; nor has anything about which nothing is known. */
static void what_is_rounded_leans_out_beside_its_outline(void **state)
{
    (void)state;
    const double known = 0.3, lean = 0.5, length = sqrt(1.0 + 2.0 * known * lean + lean * lean);
    rlf_outlines at = {.x = {0}};
    rlf_normals aside = {.x = {0}}, window[RLF_WINDOW_SIZE] = {{.x = {0}}}, found;
    float rounded[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        at.x[i] = aside.x[i] = 1.0f;
        rounded[i] = i % 2 == 0 ? 1.0f : 0.0f;
        for (int32_t k = 0; k < RLF_WINDOW_SIZE && i < 12; k++) {
            bool is_known = k % RLF_WINDOW_SIDE < RLF_WINDOW_ABOUT;
            window[k].x[i] = is_known ? (float)known : 0.0f;
            window[k].z[i] = is_known ? (float)-sqrt(1.0 - known * known) : 0.0f;
        }
    }
    rlf_kernel_outline_face(&at, &aside, window, rounded, &found);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        double out = i % 2 == 0 && i < 12 ? (known + lean) / length : 0.0;
        assert_true(fabs(found.x[i] - out) < 1e-5);
        assert_true(found.y[i] == 0.0f && (found.z[i] < 0.0f) == (out > 0.0));
    }
}

/* A surface of ten columns, one of them filled, before a wall: the ways go from its right side
 * inwards and end with it, or with the image. */
static void ways_end_with_their_surface(void **state)
{
    (void)state;
    enum { ACROSS = 24, DOWN = 6, FIRST = 8, FILLED = 15, LAST = 17, STEPS = RLF_OUTLINE_STEPS };
    float depth[ACROSS * DOWN], ray[ACROSS * DOWN], nx[ACROSS * DOWN], nz[ACROSS * DOWN];
    uint8_t known[ACROSS * DOWN];
    for (int32_t i = 0; i < ACROSS * DOWN; i++) {
        int32_t x = i % ACROSS;
        depth[i] = x >= FIRST && x <= LAST ? 2.0f : 3.0f;
        known[i] = x != FILLED;
        ray[i] = (float)i;
        nx[i] = 0.01f * (float)x;
        nz[i] = -1.0f;
    }
    float *const normal[3] = {nx, nx, nz};
    const rlf_way way = {ACROSS, DOWN, ray, ray, depth, known, normal};
    rlf_way_from from;
    rlf_way_in in;
    int32_t inner[RLF_BATCH];
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        bool to_left = k < 10; /* the other ways are on the wall and run out of the image */
        from.x[k] = to_left ? LAST - k : ACROSS - 3;
        from.y[k] = k % DOWN;
        from.outline.x[k] = to_left ? 1.0f : -1.0f;
        from.outline.y[k] = 0.0f;
        from.outline.distance[k] = 0.5f;
    }
    rlf_kernel_way_in(&way, &from, 0, &in, inner);
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        int32_t x = from.x[k], row = from.y[k] * ACROSS, way_x = k < 10 ? -1 : 1;
        int32_t most = k < 10 ? x - FIRST : 2, last = most < STEPS ? most : STEPS - 1;
        assert_int_equal(inner[k], row + x + way_x * last);
        assert_true(in.ray_x[k] == (float)(row + x));
        for (int32_t step = 0; step < STEPS; step++) {
            int32_t at = x + way_x * step;
            float has = step <= last && at != FILLED ? 1.0f : 0.0f;
            assert_true(in.s[step][k] == 0.5f + (float)step);
            assert_true(in.normal[step].x[k] == (has > 0.0f ? nx[at] : 0.0f));
            assert_true(in.normal[step].z[k] == -has);
        }
    }
}

/* Depth of what ends at a straight line through the middle of the image, a wall behind it. */
static void draw_end(int32_t width, int32_t height, double out_x, double out_y, float *depth)
{
    for (int32_t i = 0; i < width * height; i++) {
        double x = i % width - width / 2, y = i / width - height / 2;
        depth[i] = out_x * x + out_y * y > 0.2 ? 3.0f : 2.0f;
    }
}

/* Pixels one to six steps in from a straight end, in eight directions: the outline is square to it,
 * as near as what is behind, and none where that is farther than four rows, columns or both. */
static void outlines_are_seen_from_four_pixels(void **state)
{
    (void)state;
    enum { W = 40, H = 30, STEPS = 6, APART = RLF_NEAR_EDGE_APART };
    static float depth[W * H];
    const rlf_way way = {.width = W, .height = H, .depth = depth};
    for (int32_t t = 0; t < 8; t++) {
        double angle = 0.25 * 3.14159265358979 * t, x = cos(angle), y = sin(angle);
        int32_t step_x = (int32_t)round(x), step_y = (int32_t)round(y);
        rlf_way_from from;
        rlf_outlines found;
        draw_end(W, H, x, y, depth);
        for (int32_t k = 0; k < RLF_BATCH; k++) {
            from.x[k] = W / 2 - k % STEPS * step_x;
            from.y[k] = H / 2 - k % STEPS * step_y;
        }
        rlf_kernel_outline_apart(&way, &from, &found);
        for (int32_t k = 0; k < RLF_BATCH; k++) {
            int32_t steps = k % STEPS + 1;
            double pixel = t % 2 == 0 ? 1.0 : sqrt(0.5); /* from row to row of pixels */
            double least = pixel * (t % 2 == 0 ? steps : 2 * steps - 1);
            if (steps > APART) {
                assert_true(found.distance[k] == 0.0f);
                continue;
            }
            assert_true(fabs(found.x[k] - x) < 1e-5 && fabs(found.y[k] - y) < 1e-5);
            assert_true(found.distance[k] + 0.5 > least - 1e-5);
            assert_true(found.distance[k] + 0.5 < least + 0.3);
        }
    }
}

/* A thing of 12 columns before a wall: those within four of the wall, where something was in
 * front before. */
static void near_edge_row_marks_what_is_seen_beside_a_jump(void **state)
{
    (void)state;
    enum { ACROSS = 32, DOWN = 9, FIRST = 10, COLUMNS = 12 };
    float depth[ACROSS * DOWN];
    uint8_t known[ACROSS * DOWN], front[ACROSS * DOWN], mark[ACROSS];
    for (int32_t i = 0; i < ACROSS * DOWN; i++) {
        int32_t x = i % ACROSS;
        depth[i] = x >= FIRST && x < FIRST + COLUMNS ? 2.0f : 3.0f;
        known[i] = x != FIRST;
        front[i] = x >= FIRST && x < FIRST + 4;
    }
    ptrdiff_t row = 4 * ACROSS;
    rlf_kernel_was_front_row(front + row, known + row, ACROSS, 4, ACROSS - 4, mark);
    rlf_kernel_near_edge_row(depth + row, ACROSS, 4, ACROSS - 4, mark);
    for (int32_t x = 4; x < ACROSS - 4; x++) {
        bool beside = (x > FIRST && x < FIRST + 4) || (x >= FIRST + 8 && x < FIRST + COLUMNS);
        bool was_front = x < FIRST + 8;
        assert_int_equal(mark[x], beside && was_front);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(windows_are_copies_with_zeros_about),
        cmocka_unit_test(recall_batch_is_its_definition),
        cmocka_unit_test(gap_patch_finds_the_shortest_gap),
        cmocka_unit_test(fill_batch_continues_the_side_with_more_votes),
        cmocka_unit_test(fill_batch_gives_a_tie_to_the_nearer_side),
        cmocka_unit_test(fill_batch_leaves_a_third_surface_out),
        cmocka_unit_test(outlines_point_to_what_is_behind),
        cmocka_unit_test(slopes_have_no_outlines),
        cmocka_unit_test(windows_near_an_outline_are_moved_out),
        cmocka_unit_test(what_is_uneven_leans_out_beside_its_outline),
        cmocka_unit_test(what_is_rounded_leans_out_beside_its_outline),
        cmocka_unit_test(ways_end_with_their_surface),
        cmocka_unit_test(outlines_are_seen_from_four_pixels),
        cmocka_unit_test(near_edge_row_marks_what_is_seen_beside_a_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
