/* Batch kernels against their definition written out pixel by pixel. */

#include "analytic.h"
#include "kernel/batch.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 41, HEIGHT = 7, COUNT = WIDTH * HEIGHT };

TEST_CASE(windows_are_copies_with_zeros_about)
{
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

TEST_CASE(recall_batch_is_its_definition)
{
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

TEST_CASE(gap_patch_finds_the_shortest_gap)
{
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

/* A batch of gaps of one pixel: what is about each, and what it is filled with. */
static struct fills {
    rlf_windows depth;
    rlf_gap_ends ends;
    float votes[RLF_BATCH], out[RLF_BATCH];
    uint8_t kind[RLF_BATCH];
} fills;

static void set_ends(int32_t i, float before, float after)
{
    fills.depth.at[12][i] = 0.0f;
    fills.ends.before[i] = before;
    fills.ends.after[i] = after;
    fills.ends.to_before[i] = fills.ends.to_after[i] = 1.0f;
    fills.ends.most_apart[i] = 0.05f;
}

static void fill(void)
{
    rlf_kernel_fill_votes(&fills.depth, &fills.ends, fills.votes);
    rlf_kernel_fill_batch(&fills.depth, &fills.ends, fills.votes, fills.out, fills.kind);
}

static void check_all_near(float z)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        assert_int_equal(fills.kind[i], RLF_FILL_NEAR);
        assert_true(fills.out[i] == z);
    }
}

/* A missing pixel between a wall at 3 m and, right of it, above and below, one at `right`. */
static void fill_column(float right)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
            fills.depth.at[k][i] = k % 5 < 2 ? 3.0f : right;
        }
        set_ends(i, 3.0f, right);
    }
    fill();
}

TEST_CASE(fill_batch_continues_the_side_with_more_votes)
{
    fill_column(2.0f);
    assert_int_equal(fills.kind[8], RLF_FILL_NEAR);
    assert_true(fills.out[8] == 2.0f);
    fill_column(4.0f);
    assert_int_equal(fills.kind[8], RLF_FILL_FAR);
    assert_true(fills.out[8] == 4.0f);
    fill_column(3.03f); /* one slanted surface */
    assert_int_equal(fills.kind[8], RLF_FILL_BETWEEN);
    double off = fills.out[8] - 2.0 / (1.0 / 3.0 + 1.0 / 3.03);
    assert_true(off < 1e-6 && off > -1e-6);
}

/* Columns that are missing between one at `left` and, as wide, one at `right`. */
TEST_CASE(fill_batch_gives_a_tie_to_the_nearer_side)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float left = i % 2 == 0 ? 2.0f : 4.0f, right = 6.0f - left;
        for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
            fills.depth.at[k][i] = k % 5 < 2 ? left : k % 5 > 2 ? right : 0.0f;
        }
        set_ends(i, left, right);
    }
    fill();
    check_all_near(2.0f);
}

/* A box's front at 2 m before a wall at 4 m, and another one's, at 2.5 m or 1.6 m, in the rows
 * above that the hole is in: the front goes on as it is. */
TEST_CASE(fill_batch_leaves_a_third_surface_out)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float third = i % 2 == 0 ? 2.5f : 1.6f;
        for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
            fills.depth.at[k][i] = k < 5 ? third : k % 5 < 3 ? 2.0f : 4.0f;
        }
        set_ends(i, 2.0f, 4.0f);
    }
    fill();
    check_all_near(2.0f);
}
