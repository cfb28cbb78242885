/* What must hold for every pixel of every surface, whatever the frame was. Included after cmocka.h.
 */
#ifndef RLF_TEST_SURFACE_CHECK_H
#define RLF_TEST_SURFACE_CHECK_H

#include "test.h"
#include "relief/surface.h"

/* Finite values; depth exactly where the reason says so; unit normals or none; nothing in front,
 * and no label, where there is no depth. */
static inline void surface_check(const rlf_surface *s)
{
    int32_t valid = 0;
    for (int32_t i = 0; i < s->width * s->height; i++) {
        const float values[] = {s->depth[i],      s->normal_x[i],   s->normal_y[i],
                                s->normal_z[i],   s->velocity_x[i], s->velocity_y[i],
                                s->velocity_z[i], s->thickness[i],  s->background_depth[i]};
        for (size_t k = 0; k < sizeof values / sizeof values[0]; k++) {
            assert_true(values[k] - values[k] == 0.0f);
        }
        bool has_depth = s->depth[i] > 0.0f;
        bool usable = s->reason[i] == RLF_REASON_OK || s->reason[i] == RLF_REASON_FILLED;
        assert_int_equal(has_depth, usable);
        assert_true(has_depth || (!s->foreground[i] && s->label[i] == 0));
        double length = s->normal_x[i] * s->normal_x[i] + s->normal_y[i] * s->normal_y[i] +
                        s->normal_z[i] * s->normal_z[i];
        assert_true(length == 0.0 || (length > 0.9999 && length < 1.0001));
        assert_true(has_depth || length == 0.0);
        valid += has_depth;
    }
    assert_int_equal(valid, s->valid_count);
}

#endif
