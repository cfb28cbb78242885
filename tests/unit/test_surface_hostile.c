/* The surface stage on frames that no room shows: no false word about them, no NaN, no crash. What
 * they cost is printed by lab/bench/bench_hostile.c. */

#include "hostile.h"
#include "seen_view.h"
#include "surface_check.h"
#include "test.h"

typedef struct run {
    rlf_rig rig;
    rlf_reconstruct *stage;
    uint16_t *depth;
} run;

static run run_make(int32_t width, int32_t height)
{
    run r = {.rig = analytic_rig(width, height)};
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &r.rig);
    r.stage = stage_of(&def);
    r.depth = rlf_alloc_array((size_t)width * (size_t)height, sizeof *r.depth);
    assert_non_null(r.depth);
    return r;
}

static void run_free(run *r)
{
    rlf_reconstruct_destroy(&r->stage);
    rlf_free(r->depth);
}

static const rlf_surface *run_frame(run *r, hostile_pattern pattern, int32_t number)
{
    const rlf_surface *surface = NULL;
    hostile_draw(&r->rig, pattern, number, r->depth);
    rlf_frame frame = hostile_frame(&r->rig, r->depth, number);
    surface = surface_of(r->stage, &frame);
    surface_check(surface);
    return surface;
}

TEST_CASE(every_pattern_is_survived)
{
    for (int pattern = 0; pattern < HOSTILE_PATTERN_COUNT; pattern++) {
        run r = run_make(97, 61);
        for (int32_t t = 0; t < 16; t++) {
            run_frame(&r, (hostile_pattern)pattern, t);
        }
        /* and the room is found again afterwards */
        const rlf_surface *surface = NULL;
        for (int32_t t = 16; t < 40; t++) {
            surface = run_frame(&r, HOSTILE_WALL, t);
        }
        assert_int_equal(surface->valid_count, 97 * 61);
        run_free(&r);
    }
}

TEST_CASE(large_frames_are_survived)
{
    run r = run_make(641, 479);
    for (int32_t t = 0; t < 7; t++) {
        run_frame(&r, t < 6 ? HOSTILE_CHECKER_HOLES : HOSTILE_BLOCKS, t);
    }
    run_free(&r);
}

TEST_CASE(what_is_out_of_range_is_missing)
{
    run r = run_make(97, 61);
    for (int32_t t = 0; t < 12; t++) {
        const rlf_surface *s = run_frame(&r, HOSTILE_SATURATED, t);
        assert_int_equal(s->valid_count, 0);
        assert_int_equal(s->reason[0], RLF_REASON_TOO_FAR);
        s = run_frame(&r, HOSTILE_MISSING, t);
        assert_int_equal(s->valid_count, 0);
        assert_int_equal(s->reason[0], RLF_REASON_NO_RETURN);
    }
    run_free(&r);
}
