/* Log, assert and allocator hooks, the only global state of the library, and how failures are told.
 */
#include "relief/base.h"

#include "base/messages.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ALIGNMENT 64

static void log_to_stderr(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    if (level <= RLF_LOG_WARNING) {
        fprintf(stderr, "relief: %s%s\n", level == RLF_LOG_WARNING ? "warning: " : "", line);
    }
}

static bool assert_default(void *context, const char *condition, const char *file, int line)
{
    (void)context;
    rlf_log(RLF_LOG_ERROR, "%s:%d: the call breaks its contract: %s", file, line, condition);
#ifdef NDEBUG
    return false;
#else
    return true;
#endif
}

static rlf_log_fn log_fn = log_to_stderr;
static void *log_context;
static rlf_assert_fn assert_fn = assert_default;
static void *assert_context;
static rlf_alloc_fn alloc_fn = rlf_default_alloc;
static rlf_free_fn free_fn = rlf_default_free;
static void *alloc_context;
static atomic_uint_fast64_t alloc_calls;

void rlf_set_log(rlf_log_fn fn, void *context)
{
    log_fn = fn;
    log_context = context;
}

void rlf_log(rlf_log_level level, const char *format, ...)
{
    if (!RLF_ASSERT(format != NULL) || log_fn == NULL) {
        return;
    }
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof(line), format, arguments);
    va_end(arguments);
    rlf_line_clean(line);
    log_fn(log_context, level, line);
}

void rlf_set_assert(rlf_assert_fn fn, void *context)
{
    assert_fn = fn != NULL ? fn : assert_default;
    assert_context = context;
}

bool rlf_assert_failed(const char *condition, const char *file, int line)
{
    char text[RLF_ERROR_LINE_SIZE];
    (void)snprintf(text, sizeof(text), "%s:%d: the call breaks its contract: %s", file, line,
                   condition);
    rlf_error_line_set(text);
    if (assert_fn(assert_context, condition, file, line)) {
        abort();
    }
    return false;
}

rlf_result rlf_fail(rlf_result result, const char *format, ...)
{
    if (!RLF_ASSERT(format != NULL)) {
        return RLF_ERROR_INVALID;
    }
    /* Formatted into a copy first: an argument may be the old error line. */
    char text[RLF_ERROR_LINE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    rlf_error_line_set(text);
    return result;
}

void rlf_set_allocator(rlf_alloc_fn alloc, rlf_free_fn release, void *context)
{
    bool is_complete = alloc != NULL && release != NULL;
    alloc_fn = is_complete ? alloc : rlf_default_alloc;
    free_fn = is_complete ? release : rlf_default_free;
    alloc_context = context;
}

/* Whether memory of the default allocator is zero as it comes. A WebAssembly module's is until it
 * is used, and the allocator lays blocks one behind another: what lies behind all blocks so far,
 * but for its own words next to the last one, is new. A page's first picture need not wait until
 * 150 MB have been written. What the module's memory has grown by later is not asked. */
#if defined(__wasm__)
#define ALLOCATOR_WORDS 64 /* bytes; it has two words of 8 there */
#define LAST_PAGE 65536    /* of the first memory: the allocator ends it with words of its own */

static bool is_new(const void *memory, size_t size)
{
    static uintptr_t used, end;
    const uintptr_t from = (uintptr_t)memory;
    end = end == 0 ? __builtin_wasm_memory_size(0) * 65536 - LAST_PAGE : end;
    const bool is_behind = used > 0 && from >= used && from + size <= end;
    used = from + size + ALLOCATOR_WORDS > used ? from + size + ALLOCATOR_WORDS : used;
    return is_behind && alloc_fn == rlf_default_alloc;
}
#else
static bool is_new(const void *memory, size_t size)
{
    (void)memory;
    (void)size;
    return false;
}
#endif

void *rlf_alloc(size_t size)
{
    if (size > SIZE_MAX - ALIGNMENT) {
        rlf_fail(RLF_ERROR_MEMORY, "out of memory: %zu bytes asked for", size);
        return NULL;
    }
    size_t rounded = size == 0 ? ALIGNMENT : (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    atomic_fetch_add_explicit(&alloc_calls, 1, memory_order_relaxed);
    void *memory = alloc_fn(alloc_context, rounded);
    if (memory == NULL) {
        rlf_fail(RLF_ERROR_MEMORY, "out of memory: %zu bytes asked for", size);
        return NULL;
    }
    if (!is_new(memory, rounded)) {
        memset(memory, 0, rounded);
    }
    return memory;
}

void *rlf_alloc_array(size_t count, size_t size)
{
    if (size != 0 && count > SIZE_MAX / size) {
        rlf_fail(RLF_ERROR_MEMORY, "out of memory: %zu x %zu bytes asked for", count, size);
        return NULL;
    }
    return rlf_alloc(count * size);
}

void rlf_free(void *memory)
{
    if (memory != NULL) {
        free_fn(alloc_context, memory);
    }
}

uint64_t rlf_alloc_count(void)
{
    return atomic_load_explicit(&alloc_calls, memory_order_relaxed);
}
