/* Error line, allocator hooks and the worker pool. */

#include "count_assert.h"
#include "relief/base.h"
#include "created.h"
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TEST_CASE(error_line_is_one_line)
{
    assert_int_equal(rlf_fail(RLF_ERROR_IO, "a\nb %d", 3), RLF_ERROR_IO);
    assert_string_equal(rlf_error_text(), "a b 3");
    assert_int_equal(rlf_fail(RLF_ERROR_IO, "file: %s", rlf_error_text()), RLF_ERROR_IO);
    assert_string_equal(rlf_error_text(), "file: a b 3");
    assert_string_equal(rlf_result_name(RLF_ERROR_FORMAT), "RLF_ERROR_FORMAT");
}

TEST_CASE(allocations_are_aligned_zeroed_and_counted)
{
    uint64_t before = rlf_alloc_count();
    unsigned char *memory = rlf_alloc(100);
    assert_non_null(memory);
    assert_int_equal((uintptr_t)memory % 64, 0);
    for (int i = 0; i < 100; i++) {
        assert_int_equal(memory[i], 0);
    }
    rlf_free(memory);
    assert_null(rlf_alloc_array(SIZE_MAX / 2, 4));
    assert_int_equal(rlf_alloc_count() - before, 1);
}

TEST_CASE(failed_assertion_is_a_safe_no_op)
{
    int count = 0;
    rlf_set_assert(count_assert, &count);
    rlf_parallel_for(NULL, 10, 0, NULL, NULL);
    assert_int_equal(count, 1);
    rlf_set_assert(NULL, NULL);
}

typedef struct sums {
    int64_t chunk[100];
} sums;

static void sum_chunk(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    sums *s = context;
    for (int32_t i = begin; i < end; i++) {
        s->chunk[begin / 7] += i;
    }
}

TEST_CASE(parallel_for_covers_the_range_once)
{
    for (int32_t workers = 1; workers <= 4; workers++) {
        rlf_pool *pool = pool_of(workers);
        for (int repeat = 0; repeat < 200; repeat++) {
            sums s = {{0}};
            rlf_parallel_for(pool, 500, 7, sum_chunk, &s);
            int64_t total = 0;
            for (int i = 0; i < 100; i++) {
                total += s.chunk[i];
            }
            assert_int_equal(total, 499 * 500 / 2);
        }
        rlf_pool_destroy(&pool);
        assert_null(pool);
    }
    rlf_pool *pool = NULL;
    assert_int_equal(rlf_pool_create(-1, &pool), RLF_ERROR_INVALID);
}

typedef struct mark {
    int32_t job; /* what each chunk writes */
    int32_t written[3];
} mark;

static void write_job(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)end;
    (void)worker;
    mark *m = context;
    m->written[begin] += m->job;
}

/* Most of these are over before a sleeping worker wakes: it must not touch the next one's chunks
 * with this one's function, nor this one's context, which is gone by then. */
TEST_CASE(tiny_jobs_in_a_row_do_not_mix)
{
    rlf_pool *pool = pool_of(4);
    for (int32_t job = 1; job <= 20000; job++) {
        mark m = {.job = job};
        rlf_parallel_for(pool, 3, 1, write_job, &m);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(m.written[i], job);
        }
    }
    rlf_pool_destroy(&pool);
}

TEST_CASE(the_version_is_that_of_the_headers)
{
    char version[32];
    snprintf(version, sizeof(version), "%d.%d.%d", RLF_VERSION_MAJOR, RLF_VERSION_MINOR,
             RLF_VERSION_PATCH);
    assert_string_equal(rlf_version(), version);
}

TEST_CASE(instruction_set_has_a_name)
{
    const char *name = rlf_isa_name();
    bool is_known = strcmp(name, "AVX-512 (x86-64-v4)") == 0 || strcmp(name, "AVX2") == 0 ||
                    strcmp(name, "portable") == 0;
    assert_true(is_known);
    assert_ptr_equal(rlf_isa_name(), name);
}
