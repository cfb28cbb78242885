/* Relief: result codes, hooks (log, assert, allocator), clock and worker pool.
 *
 * Everything else in Relief stands on this header. It needs only the C library.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_BASE_H
#define RELIEF_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of these headers; the libraries' sonames carry as much of it as may break: before 1.0
 * major and minor, then major. CMake reads it from here. */
#define RLF_VERSION_MAJOR 0
#define RLF_VERSION_MINOR 1 /* counts changes that may break programs */
#define RLF_VERSION_PATCH 0 /* counts those that break none */

/* Marks what the libraries show; everything else in them is hidden. */
#if defined(__GNUC__) && !defined(_WIN32)
#define RLF_API __attribute__((visibility("default")))
#else
#define RLF_API
#endif

/* Marks what a program does when something is wrong: the way there is kept off the hot one. */
#if defined(__GNUC__)
#define RLF_COLD __attribute__((cold))
#else
#define RLF_COLD
#endif

#if defined(__MINGW32__) /* not the formats of Windows' own C library */
#define RLF_PRINTF(format_index, first_index)                                                      \
    __attribute__((format(gnu_printf, format_index, first_index)))
#elif defined(__GNUC__)
#define RLF_PRINTF(format_index, first_index)                                                      \
    __attribute__((format(printf, format_index, first_index)))
#else
/* Lets the compiler check the arguments of a function like printf. */
#define RLF_PRINTF(format_index, first_index)
#endif

/* Outcome of a call that depends on the world outside the program.
 *
 * 0 is success, > 0 is not an error, < 0 is an error whose cause rlf_error_text() tells in one
 * line: what, where, and what to do. A caller's own mistake (NULL where none is allowed, a def
 * that did not come from its _default function) goes through RLF_ASSERT instead. */
typedef enum rlf_result {
    RLF_OK = 0,
    RLF_NO_FRAME = 1,           /* nothing new yet: ask again */
    RLF_END = 2,                /* the source has no more frames */
    RLF_ERROR_INVALID = -1,     /* a value that cannot be used (caller's def or a file's content) */
    RLF_ERROR_MEMORY = -2,      /* out of memory */
    RLF_ERROR_IO = -3,          /* a file or device could not be opened, read or written */
    RLF_ERROR_FORMAT = -4,      /* a file is not what its name says, or is damaged */
    RLF_ERROR_UNSUPPORTED = -5, /* not compiled in, or not on this machine */
    RLF_ERROR_CAPACITY = -6,    /* more than the def's capacity allows */
    RLF_ERROR_DEVICE = -7       /* a camera or graphics device failed */
} rlf_result;

/* Version of the library that runs, e.g. "0.1.0"; its patch may be later than that of the headers.
 * Never NULL. Thread-safety: safe. */
RLF_API const char *rlf_version(void);

/* Name of a result, e.g. "RLF_ERROR_IO". Never NULL. Thread-safety: safe. */
RLF_API const char *rlf_result_name(rlf_result result);

/* Sets this thread's error line (printf-like, cut at 1023 bytes) and returns `result`, so that a
 * failing function ends with `return rlf_fail(RLF_ERROR_IO, "%s: ...", path);`.
 * Thread-safety: safe, the line belongs to the calling thread. */
RLF_API rlf_result rlf_fail(rlf_result result, const char *format, ...) RLF_PRINTF(2, 3);

/* This thread's error line, without a newline: that of the last call on this thread that failed, a
 * broken contract included; "" when none has. Every call that returns an error (< 0), and every one
 * that returns NULL or false where its comment names errors, replaces it as a whole; calls that
 * succeed leave it or not, so look at the result first. Valid until the next call of Relief on this
 * thread: copy what is to stay. Never NULL. */
RLF_API const char *rlf_error_text(void);

/* ---- hooks: set them before anything else, from one thread ------------------------------- */

/* How much a log line matters. */
typedef enum rlf_log_level {
    RLF_LOG_ERROR = 0,   /* something does not work */
    RLF_LOG_WARNING = 1, /* it works, but not as asked for */
    RLF_LOG_INFO = 2     /* of interest when looking for a cause; not written by default */
} rlf_log_level;

/* Receives every log line, without a newline. Called from any thread. */
typedef void (*rlf_log_fn)(void *context, rlf_log_level level, const char *line);

/* Replaces the log writer (default: warnings and errors to stderr). NULL silences. */
RLF_API void rlf_set_log(rlf_log_fn fn, void *context);
/* Writes a line (printf-like, without a newline, cut at 1023 bytes) to the log. Allocates nothing.
 * Thread-safety: safe, if the writer is. */
RLF_API void rlf_log(rlf_log_level level, const char *format, ...) RLF_PRINTF(2, 3);

/* Called when RLF_ASSERT fails, on the thread that called. Return true to abort(), false to go on:
 * the call is then a safe no-op that returns RLF_ERROR_INVALID, NULL, false, 0 or a struct of zeros
 * (a rotation is then none), and the error line names the condition. The default logs the place and
 * aborts in builds without NDEBUG. */
typedef bool (*rlf_assert_fn)(void *context, const char *condition, const char *file, int line);
/* Replaces the handler; NULL brings back the default. */
RLF_API void rlf_set_assert(rlf_assert_fn fn, void *context);

/* Reports a failed assertion through the handler. Always returns false. Used by RLF_ASSERT. */
RLF_API RLF_COLD bool rlf_assert_failed(const char *condition, const char *file, int line);

/* True when `condition` holds; otherwise reports it and is false, so that a function can write
 * `if (!RLF_ASSERT(world != NULL)) { return; }` and stay safe in release builds. */
#define RLF_ASSERT(condition)                                                                      \
    ((condition) ? true : rlf_assert_failed(#condition, __FILE__, __LINE__))

/* Memory functions; `alloc` gets the size in bytes and returns memory aligned to at least 64
 * bytes, or NULL. Both may be called from any thread. NULL functions bring back the default, which
 * on Linux asks for pages of 2 MiB for blocks of 4 MiB and more. */
typedef void *(*rlf_alloc_fn)(void *context, size_t size);
/* Gives back what rlf_alloc_fn gave. */
typedef void (*rlf_free_fn)(void *context, void *memory);
/* Replaces the memory functions: before anything else of Relief is called. */
RLF_API void rlf_set_allocator(rlf_alloc_fn alloc, rlf_free_fn release, void *context);
/* The default functions, for those that do something beside them, as counting; `context` is not
 * used. */
RLF_API void *rlf_default_alloc(void *context, size_t size);
/* As above, for memory of rlf_default_alloc; NULL is allowed. */
RLF_API void rlf_default_free(void *context, void *memory);

/* Zeroed memory aligned to 64 bytes, or NULL (then the error line is set). `size` 0 gives 64. */
RLF_API void *rlf_alloc(size_t size);
/* Zeroed memory for count elements; NULL also when count * size overflows. */
RLF_API void *rlf_alloc_array(size_t count, size_t size);
/* Gives back memory from rlf_alloc; NULL is allowed. */
RLF_API void rlf_free(void *memory);
/* Number of rlf_alloc calls since the program started: a test asserts that frames add none. */
RLF_API uint64_t rlf_alloc_count(void);

/* ---- machine --------------------------------------------------------------------------------- */

/* Instruction set of the hot loops on this machine, for reports: "AVX-512 (x86-64-v4)", "AVX2" or
 * "portable". Never NULL; results do not depend on it. Thread-safety: safe. */
RLF_API const char *rlf_isa_name(void);

/* ---- clock ----------------------------------------------------------------------------------- */

/* Times lie within this of 0, 146 years either way, so that any two can be subtracted. */
#define RLF_TIME_MAX_NS ((INT64_C(1) << 62) - 1)

/* Monotonic time in nanoseconds (CLOCK_MONOTONIC: stands still while the machine sleeps); only
 * differences mean anything. Thread-safety: safe. */
RLF_API int64_t rlf_clock_ns(void);

/* ---- worker pool ----------------------------------------------------------------------------- */

/* Threads that share the rows of a stage. Thread-safety: one parallel_for at a time per pool. */
typedef struct rlf_pool rlf_pool;

/* Work on items [begin, end). `worker` is 0..worker_count-1, stable during one call. */
typedef void (*rlf_range_fn)(void *context, int32_t begin, int32_t end, int32_t worker);

/* Starts worker_count - 1 threads (the caller is worker 0). 0 means one per processor, at most 64.
 */
RLF_API rlf_result rlf_pool_create(int32_t worker_count, rlf_pool **out_pool);
/* Joins the threads and nulls the pointer. NULL and a NULL pool are allowed. */
RLF_API void rlf_pool_destroy(rlf_pool **pool);
/* Number of workers; 1 for a NULL pool. */
RLF_API int32_t rlf_pool_worker_count(const rlf_pool *pool);
/* Runs fn over [0, count) in chunks of `grain` items (>= 1) and waits. The split depends only on
 * count and grain, never on the worker count, so results that are a function of the chunk are the
 * same on every machine. A NULL pool runs all chunks on the caller. */
RLF_API void rlf_parallel_for(rlf_pool *pool, int32_t count, int32_t grain, rlf_range_fn fn,
                              void *context);

#ifdef __cplusplus
}
#endif
#endif
