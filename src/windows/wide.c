/* Names of files as Windows has them, and its errors as POSIX has them. */
#include "windows/wide.h"

#include <errno.h>
#include <string.h>
#include <windows.h>

bool win_wide(const char *utf8, wchar_t out[WIDE_MAX])
{
    const char *name = strcmp(utf8, "/dev/null") == 0 ? "NUL" : utf8;
    if (MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, name, -1, out, WIDE_MAX) > 0) {
        return true;
    }
    errno = GetLastError() == ERROR_INSUFFICIENT_BUFFER ? ENAMETOOLONG : EILSEQ;
    return false;
}

bool win_narrow(const wchar_t *wide, char *out, size_t size)
{
    return WideCharToMultiByte(CP_UTF8, 0, wide, -1, out, (int)size, NULL, NULL) > 0;
}

int win_fail(void)
{
    static const struct {
        DWORD theirs;
        int ours;
    } table[] = {
        {ERROR_FILE_NOT_FOUND, ENOENT},      {ERROR_PATH_NOT_FOUND, ENOENT},
        {ERROR_INVALID_NAME, ENOENT},        {ERROR_BAD_NETPATH, ENOENT},
        {ERROR_ACCESS_DENIED, EACCES},       {ERROR_SHARING_VIOLATION, EACCES},
        {ERROR_LOCK_VIOLATION, EWOULDBLOCK}, {ERROR_ALREADY_EXISTS, EEXIST},
        {ERROR_FILE_EXISTS, EEXIST},         {ERROR_DISK_FULL, ENOSPC},
        {ERROR_HANDLE_DISK_FULL, ENOSPC},    {ERROR_DIRECTORY, ENOTDIR},
        {ERROR_INVALID_HANDLE, EBADF},       {ERROR_WRITE_PROTECT, EROFS},
    };
    const DWORD code = GetLastError();
    errno = EIO;
    for (size_t i = 0; i < sizeof(table) / sizeof(table[0]); i++) {
        if (table[i].theirs == code) {
            errno = table[i].ours;
        }
    }
    return -1;
}
