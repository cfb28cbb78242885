/* Where memory comes from, unless a program says otherwise. */
#include "relief/base.h"

#include <malloc.h>

#define ALIGNMENT 64

void *rlf_default_alloc(void *context, size_t size)
{
    (void)context;
    return _aligned_malloc(size, ALIGNMENT);
}

void rlf_default_free(void *context, void *memory)
{
    (void)context;
    _aligned_free(memory);
}
