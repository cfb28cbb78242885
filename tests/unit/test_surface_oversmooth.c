/* Pixels that a plane has moved go back where they were seen if those about them are there, and
 * stay where it has put them if those are. */

#include "surface/steps.h"
#include "test.h"

#include <string.h>

enum { SIDE = 16, COUNT = SIDE * SIDE, STEP_X = 8, AT = 8 * SIDE + STEP_X };

static const float near_z = 2.7f, far_z = 2.8f; /* left and right of STEP_X */

typedef struct fixture {
    rlf_reconstruct stage; /* of which only the grid is looked at */
    float seen[COUNT], smooth[COUNT], normal[3][COUNT];
} fixture;

static int set_up(void **state)
{
    static fixture f;
    memset(&f, 0, sizeof f);
    f.stage.grid.width = f.stage.grid.height = SIDE;
    f.stage.grid.count = COUNT;
    for (int32_t i = 0; i < COUNT; i++) {
        f.seen[i] = f.smooth[i] = i % SIDE < STEP_X ? near_z : far_z;
        f.normal[2][i] = -1.0f;
    }
    *state = &f;
    return 0;
}

static void undo(fixture *f)
{
    float *const normal[3] = {f->normal[0], f->normal[1], f->normal[2]};
    oversmooth_undo(&f->stage, f->seen, f->smooth, normal);
}

TEST_CASE(what_was_moved_between_two_surfaces_goes_back)
{
    fixture *f = *state;
    f->smooth[AT] = 2.75f;
    f->smooth[AT - 1] = 2.74f;
    undo(f);
    assert_memory_equal(f->smooth, f->seen, sizeof f->seen);
    assert_true(f->normal[2][AT] == 0.0f && f->normal[2][AT - 1] == 0.0f);
    assert_true(f->normal[2][AT + 1] == -1.0f && f->normal[2][AT - 2] == -1.0f);
}

TEST_CASE(a_wrong_pixel_stays_where_its_neighbours_are)
{
    fixture *f = *state;
    f->seen[AT + 3] = 2.75f;
    undo(f);
    assert_true(f->smooth[AT + 3] == far_z && f->normal[2][AT + 3] == -1.0f);
}

/* 3 cm from column to column: of its neighbours only those above and below are at its depth. */
TEST_CASE(a_steep_face_is_smoothed)
{
    fixture *f = *state;
    for (int32_t i = 0; i < COUNT; i++) {
        f->seen[i] = f->smooth[i] = 2.5f + 0.03f * (float)(i % SIDE);
    }
    f->smooth[AT] += 0.015f;
    undo(f);
    assert_true(f->smooth[AT] > f->seen[AT]);
}

TEST_CASE(noise_is_smoothed_and_what_is_missing_stays_so)
{
    fixture *f = *state;
    f->smooth[AT] += 0.01f;
    f->seen[AT + 2] = f->smooth[AT + 2] = 0.0f;
    undo(f);
    assert_true(f->smooth[AT] > far_z && f->smooth[AT + 2] == 0.0f);
}

TEST_EACH(set_up, NULL)
