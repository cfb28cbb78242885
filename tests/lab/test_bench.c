/* What `relief-lab bench` stands on: its rooms, its floor, its counting of memory, its files. */

#include "bench/bench.h"
#include "created.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const rlf_surface *surface_after(rlf_source *source, rlf_reconstruct *stage, int frames)
{
    const rlf_surface *surface = NULL;
    for (int k = 0; k < frames; k++) {
        rlf_frame frame = frame_of(source);
        assert_int_equal(rlf_reconstruct_process(stage, &frame, &surface), RLF_OK);
    }
    return surface;
}

static int32_t found_regions(int32_t width, int32_t height, int32_t people, int32_t plates)
{
    const bench_room room = {width, height, people, plates, false};
    rlf_source *source = NULL;
    rlf_reconstruct *stage = NULL;
    assert_int_equal(bench_source_create(&room, &source), RLF_OK);
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
    assert_int_equal(rlf_reconstruct_create(&def, &stage), RLF_OK);
    const rlf_surface *s = surface_after(source, stage, BENCH_EMPTY_FRAMES + 6);
    int32_t count = 0;
    for (int32_t r = 0; r < s->region_count; r++) {
        count += s->regions[r].layer == RLF_LAYER_FOREGROUND;
    }
    rlf_reconstruct_destroy(&stage);
    rlf_source_destroy(&source);
    return count;
}

TEST_CASE(rooms_have_the_regions_they_were_asked_for)
{
    assert_int_equal(found_regions(320, 240, 0, 0), 0);
    assert_int_equal(found_regions(320, 240, 0, 4), 4);
    assert_int_equal(found_regions(512, 424, 0, 64), 64);
    assert_int_equal(found_regions(320, 240, 1, 0), 1);
    assert_int_equal(found_regions(320, 240, 0, 9), 9);
}

/* Half pixels of people side by side, in the first frame that shows them. */
static int32_t people_pixels(int32_t people)
{
    const bench_room room = {320, 240, people, 0, true};
    rlf_source *source = NULL;
    rlf_frame frame;
    int32_t count = 0;
    assert_int_equal(bench_source_create(&room, &source), RLF_OK);
    for (int k = 0; k <= BENCH_EMPTY_FRAMES; k++) {
        frame = frame_of(source);
    }
    for (int i = 0; i < 120 * 320; i++) { /* rows before the floor comes as near */
        int32_t mm = frame.depth_u16[i];  /* beside an outline, on both sides, it is 0 */
        count += mm == 0 ? 1 : (mm < 3100 ? 2 : 0);
    }
    rlf_source_destroy(&source);
    return count;
}

TEST_CASE(people_side_by_side_fill_as_many_pixels)
{
    int32_t two = people_pixels(2), four = people_pixels(4), eight = people_pixels(8);
    assert_true(two > 10000);
    assert_in_range(100 * four / two, 85, 105); /* near ones are seen under a wider angle */
    assert_in_range(100 * eight / two, 85, 105);
}

/* The middle ray meets wall, then plate; the noise is the rig's. */
TEST_CASE(rooms_are_where_they_should_be)
{
    const bench_room room = {101, 83, 0, 1, false};
    rlf_source *source = NULL;
    rlf_frame frame;
    assert_int_equal(bench_source_create(&room, &source), RLF_OK);
    double sum = 0, square = 0;
    for (int k = 0; k < BENCH_EMPTY_FRAMES; k++) {
        frame = frame_of(source);
        for (int i = 0; i < 30 * 101; i++) { /* rows above the floor */
            double error = frame.depth_u16[i] * 1e-3 - 3.2;
            sum += error / (BENCH_EMPTY_FRAMES * 30 * 101);
            square += error * error / (BENCH_EMPTY_FRAMES * 30 * 101);
        }
    }
    double sigma = rlf_depth_noise_sigma(&rlf_source_get_info(source)->rig.noise, 3.2);
    assert_true(fabs(sum) < 3e-4);
    assert_true(fabs(sqrt(square) / sigma - 1.0) < 0.05);
    frame = frame_of(source);
    double plate = frame.depth_u16[30 * 101 + 40] * 1e-3;
    assert_true(fabs(plate - 2.6) < 0.02);
    rlf_source_destroy(&source);
}

/* Another set of buffers each time, so that none is in a cache when its turn comes. */
TEST_CASE(floor_goes_round_more_memory_than_a_cache_holds)
{
    bench_floor f;
    assert_int_equal(bench_floor_open(512, 424, &f), RLF_OK);
    size_t bytes = f.pixels * (BENCH_FLOOR_READ + BENCH_FLOOR_WRITTEN);
    assert_true((size_t)f.set_count * bytes > ((size_t)128 << 20));
    for (int k = 0; k < f.set_count + 1; k++) {
        assert_int_equal(f.next, k % f.set_count);
        bench_floor_run(&f);
    }
    assert_int_equal(f.times.count, f.set_count + 1);
    assert_true(timing_percentile(&f.times, 50) > 0.0);
    /* the last byte plane of the last set was written: no depth is nearer than 2 m */
    assert_int_equal(f.memory[bytes - 1], 1);
    bench_floor_close(&f);
}

TEST_CASE(table_finds_rows_and_files_compare)
{
    static bench_table old, now;
    bench_add(&old, "live_1", "surface", "ms", 12.0, 13.0, 20.0);
    bench_add(&now, "live_1", "surface", "ms", 6.0, 7.0, NAN);
    bench_add(&now, "live_1", "new step", "ms", 1.0, 1.0, NAN);
    assert_true(bench_find(&old, "live_1", "surface")->p95 == 13.0);
    assert_null(bench_find(&old, "live_1", "new step"));
    assert_null(bench_find(&old, "live_8", "surface"));
    bench_options o = {
        .source = "s", .json_path = "bench_test.json", .compare_path = "bench_test.json"};
    assert_int_equal(bench_write_json(&o, &old, NULL), RLF_OK);
    assert_int_equal(bench_compare(&o, &now), RLF_OK); /* the new step has nothing beside it */
    o.compare_path = RLF_TEST_ROOT "/README.md";
    assert_int_equal(bench_compare(&o, &now), RLF_ERROR_FORMAT);
    assert_non_null(strstr(rlf_error_text(), "README.md"));
}

/* Last of all tests: it changes the allocator for good. */
TEST_CASE(memory_is_counted_to_the_byte)
{
    bench_memory_start();
    int64_t before = bench_memory_now();
    void *a = rlf_alloc(6400), *b = rlf_alloc(1);
    assert_int_equal(bench_memory_now() - before, 6400 + 64); /* rounded to 64 */
    assert_int_equal((uintptr_t)a % 64, 0);
    memset(a, 255, 6400);
    rlf_free(a);
    assert_int_equal(bench_memory_now() - before, 64);
    rlf_free(b);
    assert_int_equal(bench_memory_now(), before);
}
