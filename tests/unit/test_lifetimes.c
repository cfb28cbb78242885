/* Whatever is made and destroyed a hundred times leaves nothing behind: every block that the
 * library asks for comes back. With sanitizers the leak checker looks at the rest. */
#include "relief/hands.h"
#include "created.h"
#include "pinhole.h"
#include "seen_view.h"

#include <stdatomic.h>
#include <stdlib.h>

enum { TURNS = 100, WIDTH = 40, HEIGHT = 30 };

static atomic_long blocks; /* that are out */

static void *count_alloc(void *context, size_t size)
{
    void *memory = rlf_default_alloc(context, size);
    atomic_fetch_add(&blocks, memory != NULL ? 1 : 0);
    return memory;
}

static void count_free(void *context, void *memory)
{
    atomic_fetch_sub(&blocks, memory != NULL ? 1 : 0);
    rlf_default_free(context, memory);
}

static int start(void **state)
{
    (void)state;
    rlf_set_allocator(count_alloc, count_free, NULL);
    return 0;
}

static int stop(void **state)
{
    (void)state;
    rlf_set_allocator(NULL, NULL, NULL);
    return 0;
}

TEST_CASE(test_worlds)
{
    for (int i = 0; i < TURNS; i++) {
        rlf_world_def def = rlf_world_def_default();
        def.body_capacity = 4;
        def.contact_capacity = 64;
        rlf_world *world = world_of(&def);
        const rlf_body_def body = rlf_body_def_default();
        add_body(world, &body);
        rlf_world_advance(world, NULL, 0.01);
        assert_true(atomic_load(&blocks) > 0);
        rlf_world_destroy(&world);
    }
    assert_int_equal(atomic_load(&blocks), 0);
}

static rlf_rig small_rig(void)
{
    rlf_rig rig = rlf_rig_default();
    rig.depth = pinhole(WIDTH, HEIGHT, 30.0);
    return rig;
}

TEST_CASE(test_surfaces)
{
    const rlf_rig rig = small_rig();
    for (int i = 0; i < TURNS; i++) {
        const rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
        rlf_reconstruct *reconstruct = stage_of(&def);
        rlf_reconstruct_destroy(&reconstruct);
    }
    assert_int_equal(atomic_load(&blocks), 0);
}

static void push_floor(rlf_pipeline *pipeline)
{
    static float depth[WIDTH * HEIGHT];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        depth[i] = 2.0f;
    }
    for (int i = 0; i < 2; i++) {
        const rlf_frame frame = {.sequence = (uint64_t)i,
                                 .time_ns = INT64_C(33000000) * i,
                                 .depth_f32 = depth,
                                 .depth_stride = WIDTH * (ptrdiff_t)sizeof(float)};
        rlf_pipeline_output out;
        assert_int_equal(rlf_pipeline_push(pipeline, &frame, &out), RLF_OK);
        assert_true(out.surface->valid_count > 0);
    }
}

TEST_CASE(test_pipelines)
{
    const rlf_rig rig = small_rig();
    for (int i = 0; i < TURNS; i++) {
        rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &rig, NULL);
        def.enable_render = i % 2 == 0;
        def.enable_hands = true;
        def.world.body_capacity = 4;
        def.world.contact_capacity = 64;
        rlf_pipeline *pipeline = pipeline_of(&def);
        if (i % 20 == 0) {
            push_floor(pipeline);
        }
        rlf_pipeline_destroy(&pipeline);
    }
    assert_int_equal(atomic_load(&blocks), 0);
}

TEST_CASE(test_failures)
{
    rlf_rig rig = small_rig();
    rig.depth_min_m = 5.0;
    rig.depth_max_m = 1.0;
    for (int i = 0; i < TURNS; i++) {
        rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &rig, NULL);
        rlf_pipeline *pipeline = NULL;
        def.world.step_hz = -1.0;
        assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_ERROR_INVALID);
        assert_null(pipeline);
    }
    assert_int_equal(atomic_load(&blocks), 0);
}

TEST_EACH(start, stop)
