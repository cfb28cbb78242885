/* Boxes in lanes against boxes one by one. */

#include "analytic.h"
#include "kernel/lanes.h"
#include "test.h"

#include <math.h>
#include <stdbool.h>

enum { BOXES = 70, STRIDE = BOXES + RLF_BOX_LANES };

static float uniform(analytic_random *r, double size)
{
    return (float)(size * random_uniform(r));
}

static bool meets(const float *ends, int32_t k, const float box[6])
{
    bool does = true;
    for (int32_t axis = 0; axis < 3; axis++) {
        does = does && ends[axis * STRIDE + k] <= box[axis + 3] &&
               ends[(axis + 3) * STRIDE + k] >= box[axis];
    }
    return does;
}

/* Any range of them, with boxes that touch and one that is no number. */
TEST_CASE(boxes_are_found_as_one_by_one)
{
    analytic_random r = {5};
    int32_t sum = 0;
    for (int32_t run = 0; run < 400; run++) {
        float ends[6 * STRIDE] = {0}, box[6];
        for (int32_t axis = 0; axis < 3; axis++) {
            for (int32_t k = 0; k < STRIDE; k++) {
                ends[axis * STRIDE + k] = (float)(int32_t)uniform(&r, 8.0);
                ends[(axis + 3) * STRIDE + k] =
                    ends[axis * STRIDE + k] + (float)(int32_t)uniform(&r, 4.0);
            }
            box[axis] = (float)(int32_t)uniform(&r, 8.0);
            box[axis + 3] = box[axis] + 1.0f;
        }
        ends[(run % 6) * STRIDE + run % BOXES] = NAN;
        int32_t begin = run % 20, end = begin + run % (BOXES - 19), count = 0;
        int32_t found[BOXES + 1];
        int32_t found_count = rlf_kernel_boxes_meet(ends, STRIDE, begin, end, box, found);
        for (int32_t k = begin; k < end; k++) {
            if (meets(ends, k, box)) {
                assert_true(count < found_count);
                assert_int_equal(found[count++], k);
            }
        }
        assert_int_equal(count, found_count);
        sum += count;
    }
    assert_true(sum > 400);
}

static float square_distance(const float box[6], const float p[3])
{
    float square = 0.0f;
    for (int32_t axis = 0; axis < 3; axis++) {
        float off = p[axis] < box[axis]
                        ? box[axis] - p[axis]
                        : (p[axis] > box[axis + 3] ? p[axis] - box[axis + 3] : 0.0f);
        square += off * off;
    }
    return square;
}

/* Points inside, beside and at corners of boxes; none at all is far. */
TEST_CASE(points_are_as_far_from_boxes_as_one_by_one)
{
    analytic_random r = {7};
    for (int32_t run = 0; run < 400; run++) {
        float boxes[BOXES][6], at[3][RLF_BOX_LANES], distance2[RLF_BOX_LANES];
        int32_t count = run % BOXES;
        for (int32_t i = 0; i < BOXES * 3; i++) {
            boxes[i / 3][i % 3] = uniform(&r, 4.0);
            boxes[i / 3][i % 3 + 3] = boxes[i / 3][i % 3] + uniform(&r, 1.0);
        }
        for (int32_t i = 0; i < 3 * RLF_BOX_LANES; i++) {
            at[i / RLF_BOX_LANES][i % RLF_BOX_LANES] = uniform(&r, 5.0);
        }
        rlf_kernel_boxes_distance2((const float(*)[6])boxes, count, at[0], at[1], at[2], distance2);
        for (int32_t k = 0; k < RLF_BOX_LANES; k++) {
            const float p[3] = {at[0][k], at[1][k], at[2][k]};
            float least = 1e30f;
            for (int32_t i = 0; i < count; i++) {
                float square = square_distance(boxes[i], p);
                least = square < least ? square : least;
            }
            assert_true(distance2[k] == least);
        }
    }
}
