/* Names of files as Windows has them. */
#ifndef RLF_WINDOWS_WIDE_H
#define RLF_WINDOWS_WIDE_H

#include <stdbool.h>
#include <stddef.h>
#include <wchar.h>

#define WIDE_MAX 4096

/* False with errno set: too long, or no UTF-8. "/dev/null" is NUL. */
bool win_wide(const char *utf8, wchar_t out[WIDE_MAX]);
/* False when it does not fit. */
bool win_narrow(const wchar_t *wide, char *out, size_t size);
/* errno of GetLastError; returns -1. */
int win_fail(void);

#endif
