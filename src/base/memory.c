/* Where memory comes from, unless a program says otherwise. */
#define _DEFAULT_SOURCE
#include "relief/base.h"

#include <stdlib.h>
#if defined(__linux__)
#include <sys/mman.h>
#endif

#define ALIGNMENT 64

/* Blocks that fill some of them ask for pages of this size: with pages of 4 KiB a frame's planes
 * need more entries of address translation than a processor holds. */
#define LARGE_PAGE ((size_t)2 << 20)
#define LARGE_BLOCK (2 * LARGE_PAGE)

void *rlf_default_alloc(void *context, size_t size)
{
    (void)context;
#ifdef MADV_HUGEPAGE
    if (size >= LARGE_BLOCK) {
        size_t rounded = (size + LARGE_PAGE - 1) / LARGE_PAGE * LARGE_PAGE;
        void *memory = rounded >= size ? aligned_alloc(LARGE_PAGE, rounded) : NULL;
        if (memory != NULL) {
            madvise(memory, rounded, MADV_HUGEPAGE); /* a wish: refused, it is memory as any */
        }
        return memory;
    }
#endif
    size_t rounded = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    return rounded >= size ? aligned_alloc(ALIGNMENT, rounded) : NULL;
}

void rlf_default_free(void *context, void *memory)
{
    (void)context;
    free(memory);
}
