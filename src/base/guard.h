/* Memory that no one may touch: a build with AddressSanitizer stops at a read or a write of it. */
#ifndef RLF_BASE_GUARD_H
#define RLF_BASE_GUARD_H

#include <stddef.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define RLF_GUARDS_MEMORY 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define RLF_GUARDS_MEMORY 1
#endif

#ifdef RLF_GUARDS_MEMORY
#include <sanitizer/asan_interface.h>

static inline void rlf_guard(const void *memory, size_t size)
{
    __asan_poison_memory_region(memory, size);
}

static inline void rlf_unguard(const void *memory, size_t size)
{
    __asan_unpoison_memory_region(memory, size);
}
#else
static inline void rlf_guard(const void *memory, size_t size)
{
    (void)memory;
    (void)size;
}

static inline void rlf_unguard(const void *memory, size_t size)
{
    (void)memory;
    (void)size;
}
#endif

#endif
