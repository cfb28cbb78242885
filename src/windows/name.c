/* What is done to files by their names. */
#include "windows/posix.h"

#include "windows/wide.h"

#include <errno.h>
#include <windows.h>

int win_mkdir(const char *path, int mode)
{
    (void)mode; /* the folder's own rights are inherited */
    wchar_t wide[WIDE_MAX];
    if (!win_wide(path, wide)) {
        return -1;
    }
    return CreateDirectoryW(wide, NULL) ? 0 : win_fail();
}

char *win_mkdtemp(char *pattern)
{
    wchar_t wide[WIDE_MAX];
    const bool is_made = _mktemp(pattern) != NULL && win_wide(pattern, wide);
    return is_made && CreateDirectoryW(wide, NULL) ? pattern : NULL;
}

int win_rename(const char *from, const char *to)
{
    wchar_t wide_from[WIDE_MAX], wide_to[WIDE_MAX];
    if (!win_wide(from, wide_from) || !win_wide(to, wide_to)) {
        return -1;
    }
    return MoveFileExW(wide_from, wide_to, MOVEFILE_REPLACE_EXISTING) ? 0 : win_fail();
}

int win_remove(const char *path)
{
    wchar_t wide[WIDE_MAX];
    if (!win_wide(path, wide)) {
        return -1;
    }
    return DeleteFileW(wide) || RemoveDirectoryW(wide) ? 0 : win_fail();
}

int win_access(const char *path, int mode)
{
    wchar_t wide[WIDE_MAX];
    return win_wide(path, wide) ? _waccess(wide, mode & (R_OK | W_OK)) : -1;
}

static void turn_slashes(char *path)
{
    for (; *path != '\0'; path++) {
        *path = *path == '\\' ? '/' : *path;
    }
}

/* The name by which Windows itself knows a file begins with \\?\, which is left out. */
static char *real_name(const char *path, char out[PATH_MAX])
{
    wchar_t wide[WIDE_MAX];
    if (!win_wide(path, wide)) {
        return NULL;
    }
    HANDLE handle = CreateFileW(wide, FILE_READ_ATTRIBUTES,
                                FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                                OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (handle == INVALID_HANDLE_VALUE) {
        win_fail();
        return NULL;
    }
    const DWORD length = GetFinalPathNameByHandleW(handle, wide, WIDE_MAX, FILE_NAME_NORMALIZED);
    CloseHandle(handle);
    const wchar_t *name = wcsncmp(wide, L"\\\\?\\", 4) == 0 ? wide + 4 : wide;
    if (length == 0 || length >= WIDE_MAX || !win_narrow(name, out, PATH_MAX)) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    turn_slashes(out);
    return out;
}

char *win_realpath(const char *path, char *out)
{
    char *made = out == NULL ? malloc(PATH_MAX) : NULL;
    char *name = out != NULL || made != NULL ? real_name(path, out != NULL ? out : made) : NULL;
    if (name == NULL) {
        free(made);
    }
    return name;
}

ssize_t win_readlink(const char *path, char *out, size_t size)
{
    wchar_t wide[WIDE_MAX];
    if (strcmp(path, "/proc/self/exe") != 0) {
        errno = EINVAL;
        return -1;
    }
    const DWORD length = GetModuleFileNameW(NULL, wide, WIDE_MAX);
    if (length == 0 || length >= WIDE_MAX || !win_narrow(wide, out, size)) {
        errno = ENAMETOOLONG;
        return -1;
    }
    turn_slashes(out);
    return (ssize_t)strlen(out);
}
