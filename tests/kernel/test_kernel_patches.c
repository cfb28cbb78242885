/* Patch kernels against their definition written out pixel by pixel, inside images and at their
 * borders. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "analytic.h"
#include "kernel/patch.h"

#include <stdlib.h>

enum { WIDTH = 41, HEIGHT = 7, COUNT = WIDTH * HEIGHT };

static bool is_inside(int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && x < WIDTH && y < HEIGHT;
}

static void patches_are_copies_with_zeros_about(void **state)
{
    (void)state;
    float plane[COUNT];
    uint8_t bytes[COUNT];
    for (int32_t i = 0; i < COUNT; i++) {
        plane[i] = (float)(i + 1);
        bytes[i] = (uint8_t)(i % 255 + 1);
    }
    for (int32_t i = 0; i < COUNT; i++) {
        rlf_patch p;
        rlf_byte_patch b;
        rlf_patch_read(plane, WIDTH, HEIGHT, i % WIDTH, i / WIDTH, &p);
        rlf_byte_patch_read(bytes, WIDTH, HEIGHT, i % WIDTH, i / WIDTH, &b);
        for (int32_t k = 0; k < RLF_PATCH_HEIGHT * RLF_PATCH_WIDTH; k++) {
            int32_t row = k / RLF_PATCH_WIDTH, column = k % RLF_PATCH_WIDTH;
            int32_t x = i % WIDTH + column - RLF_PATCH_ABOUT, y = i / WIDTH + row - RLF_PATCH_ABOUT;
            bool inside = is_inside(x, y);
            assert_true(p.at[row][column] == (inside ? plane[y * WIDTH + x] : 0.0f));
            assert_int_equal(b.at[row][column], inside ? bytes[y * WIDTH + x] : 0);
        }
    }
}

static int about_by_definition(const rlf_patch *z, const rlf_byte_patch *change, float inverse,
                               int32_t i)
{
    int about = 0;
    for (int32_t dy = -2; dy <= 2; dy++) {
        for (int32_t dx = -2; dx <= 2; dx++) {
            int32_t row = dy + 2, column = i + 2 + dx;
            int far = abs(dx) > abs(dy) ? abs(dx) : abs(dy);
            double off = (double)inverse * (double)z->at[row][column] - 1.0;
            bool near = off <= 0.01 * far + 0.01 && -off <= 0.01 * far + 0.01;
            about |= change->at[row][column] == RLF_CHANGE_MOVED ? RLF_ABOUT_MOVED : 0;
            about |= change->at[row][column] != RLF_CHANGE_UNSEEN && near ? RLF_ABOUT_CONTINUED : 0;
        }
    }
    return about;
}

static void recall_patch_is_its_definition(void **state)
{
    (void)state;
    analytic_random r = {8};
    int counts[4] = {0};
    for (int32_t t = 0; t < 400; t++) {
        rlf_patch z;
        rlf_byte_patch change;
        float inverse[RLF_PATCH];
        uint8_t about[RLF_PATCH];
        double moved = t % 2 == 0 ? 0.0 : 0.03, seen = 0.4 * random_uniform(&r);
        for (int32_t k = 0; k < RLF_PATCH_HEIGHT * RLF_PATCH_WIDTH; k++) {
            double u = random_uniform(&r);
            bool is_seen = u < seen + moved;
            z.at[k / RLF_PATCH_WIDTH][k % RLF_PATCH_WIDTH] =
                (float)(2.0 + 1.5 * random_uniform(&r));
            change.at[k / RLF_PATCH_WIDTH][k % RLF_PATCH_WIDTH] = u < moved ? RLF_CHANGE_MOVED
                                                                  : is_seen ? RLF_CHANGE_STILL
                                                                            : 0;
        }
        for (int32_t i = 0; i < RLF_PATCH; i++) {
            inverse[i] = (float)(1.0 / (2.0 + 1.5 * random_uniform(&r)));
        }
        rlf_kernel_recall_patch(&z, &change, inverse, about);
        for (int32_t i = 0; i < RLF_PATCH; i++) {
            assert_int_equal(about[i], about_by_definition(&z, &change, inverse[i], i));
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
        for (int32_t i = 0; i < RLF_PATCH; i++) {
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

/* Column 8 is missing; left of it is a wall at 3 m, right of it another at `right`. */
static void fill_column(float right, float out[RLF_PATCH], uint8_t kind[RLF_PATCH])
{
    rlf_patch p;
    rlf_gaps gaps;
    rlf_gap_ends ends;
    memset(&gaps, 0, sizeof gaps);
    memset(&ends, 0, sizeof ends);
    for (int32_t k = 0; k < RLF_PATCH_HEIGHT * RLF_PATCH_WIDTH; k++) {
        int32_t x = k % RLF_PATCH_WIDTH - RLF_PATCH_ABOUT;
        p.at[k / RLF_PATCH_WIDTH][k % RLF_PATCH_WIDTH] = x < 8 ? 3.0f : x > 8 ? right : 0.0f;
    }
    p.at[2][10] = 0.0f;
    p.at[0][10] = p.at[1][10] = p.at[3][10] = p.at[4][10] = right; /* the edge is left of it */
    gaps.to_before[8] = gaps.to_after[8] = 1;
    ends.before[8] = 3.0f;
    ends.after[8] = right;
    rlf_kernel_fill_patch(&p, &gaps, &ends, out, kind);
}

static void fill_patch_continues_the_side_with_more_votes(void **state)
{
    (void)state;
    float out[RLF_PATCH];
    uint8_t kind[RLF_PATCH];
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patches_are_copies_with_zeros_about),
        cmocka_unit_test(recall_patch_is_its_definition),
        cmocka_unit_test(gap_patch_finds_the_shortest_gap),
        cmocka_unit_test(fill_patch_continues_the_side_with_more_votes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
