/* An allocator that counts bytes, and is the default one beside that. */
#include "bench/bench.h"

#include <stdatomic.h>

#define HEADER 64 /* keeps the alignment that rlf_alloc_fn asks for */

static atomic_llong bytes_now;

static void *counted_alloc(void *context, size_t size)
{
    (void)context;
    size_t whole = (size + HEADER - 1) / HEADER * HEADER + HEADER;
    unsigned char *memory = rlf_default_alloc(NULL, whole);
    if (memory == NULL) {
        return NULL;
    }
    *(size_t *)(void *)memory = size;
    atomic_fetch_add(&bytes_now, (long long)size);
    return memory + HEADER;
}

static void counted_free(void *context, void *memory)
{
    (void)context;
    unsigned char *start = (unsigned char *)memory - HEADER;
    atomic_fetch_sub(&bytes_now, (long long)*(size_t *)(void *)start);
    rlf_default_free(NULL, start);
}

void bench_memory_start(void)
{
    rlf_set_allocator(counted_alloc, counted_free, NULL);
}

int64_t bench_memory_now(void)
{
    return atomic_load(&bytes_now);
}
