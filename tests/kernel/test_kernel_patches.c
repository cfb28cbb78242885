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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patches_are_copies_with_zeros_about),
        cmocka_unit_test(recall_patch_is_its_definition),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
