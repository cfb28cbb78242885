/* What wasi-libc asks of its host, answered here: the module imports nothing. There are no files,
 * no environment and no clock; what is printed is lost, for a page reads the error line. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <wasi/api.h>

#define NO_FILE __WASI_ERRNO_BADF

__wasi_errno_t __wasi_environ_sizes_get(__wasi_size_t *out_count, __wasi_size_t *out_size)
{
    *out_count = 0;
    *out_size = 0;
    return __WASI_ERRNO_SUCCESS;
}

__wasi_errno_t __wasi_environ_get(uint8_t **environment, uint8_t *text)
{
    (void)environment;
    (void)text;
    return __WASI_ERRNO_SUCCESS;
}

/* Each call is a microsecond later than the one before: time that is measured means nothing here.
 */
__wasi_errno_t __wasi_clock_time_get(__wasi_clockid_t id, __wasi_timestamp_t precision,
                                     __wasi_timestamp_t *out_ns)
{
    static uint64_t calls;
    (void)id;
    (void)precision;
    *out_ns = ++calls * 1000;
    return __WASI_ERRNO_SUCCESS;
}

__wasi_errno_t __wasi_fd_close(__wasi_fd_t file)
{
    (void)file;
    return NO_FILE;
}

__wasi_errno_t __wasi_fd_fdstat_get(__wasi_fd_t file, __wasi_fdstat_t *out)
{
    (void)file;
    (void)out;
    return NO_FILE;
}

__wasi_errno_t __wasi_fd_seek(__wasi_fd_t file, __wasi_filedelta_t offset, __wasi_whence_t whence,
                              __wasi_filesize_t *out_position)
{
    (void)file;
    (void)offset;
    (void)whence;
    (void)out_position;
    return NO_FILE;
}

__wasi_errno_t __wasi_fd_write(__wasi_fd_t file, const __wasi_ciovec_t *parts, size_t count,
                               __wasi_size_t *out_size)
{
    (void)file;
    *out_size = 0;
    for (size_t i = 0; i < count; i++) {
        *out_size += parts[i].buf_len;
    }
    return __WASI_ERRNO_SUCCESS;
}

_Noreturn void __wasi_proc_exit(__wasi_exitcode_t status)
{
    (void)status;
    __builtin_trap();
}
