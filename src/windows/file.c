/* Open files: by name, by descriptor, by position. */
#include "windows/posix.h"

#include "windows/wide.h"

#include <errno.h>
#include <stdarg.h>
#include <windows.h>

#undef open
#undef fopen

/* _wopen refuses folders; who opens one here wants to see that it is none of its files. */
static int open_folder(const wchar_t *wide)
{
    HANDLE handle = CreateFileW(wide, FILE_READ_ATTRIBUTES,
                                FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                                OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    return handle != INVALID_HANDLE_VALUE ? _open_osfhandle((intptr_t)handle, 0) : win_fail();
}

int win_open(const char *path, int flags, ...)
{
    wchar_t wide[WIDE_MAX];
    va_list arguments;
    va_start(arguments, flags);
    const int mode = (flags & O_CREAT) != 0 ? va_arg(arguments, int) : 0;
    va_end(arguments);
    if (!win_wide(path, wide)) {
        return -1;
    }
    const DWORD attributes = GetFileAttributesW(wide);
    if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0 &&
        (flags & (O_WRONLY | O_RDWR)) == 0) {
        return open_folder(wide);
    }
    return _wopen(wide, flags | _O_BINARY, mode & (_S_IREAD | _S_IWRITE));
}

FILE *win_fopen(const char *path, const char *mode)
{
    wchar_t wide[WIDE_MAX], wide_mode[8];
    const bool is_binary = strchr(mode, 'b') != NULL;
    (void)swprintf(wide_mode, sizeof(wide_mode) / sizeof(wide_mode[0]),
                   is_binary ? L"%hs" : L"%hsb", mode);
    return win_wide(path, wide) ? _wfopen(wide, wide_mode) : NULL;
}

static time_t time_of(const FILETIME *time)
{
    const uint64_t ticks = (uint64_t)time->dwHighDateTime << 32 | time->dwLowDateTime;
    return (time_t)(ticks / 10000000) - 11644473600; /* from 1601 to 1970 */
}

static int describe(HANDLE handle, struct win_stat *out)
{
    memset(out, 0, sizeof(*out));
    const DWORD type = GetFileType(handle);
    if (type != FILE_TYPE_DISK) {
        out->st_mode = type == FILE_TYPE_PIPE ? S_IFIFO : S_IFCHR;
        return 0;
    }
    BY_HANDLE_FILE_INFORMATION info;
    if (!GetFileInformationByHandle(handle, &info)) {
        return win_fail();
    }
    const bool is_folder = (info.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    out->st_mode = is_folder ? S_IFDIR : S_IFREG;
    out->st_dev = info.dwVolumeSerialNumber;
    out->st_ino = (uint64_t)info.nFileIndexHigh << 32 | info.nFileIndexLow;
    out->st_nlink = info.nNumberOfLinks;
    out->st_size = (int64_t)((uint64_t)info.nFileSizeHigh << 32 | info.nFileSizeLow);
    out->st_mtime = time_of(&info.ftLastWriteTime);
    return 0;
}

int win_fstat(int descriptor, struct win_stat *out)
{
    return describe((HANDLE)_get_osfhandle(descriptor), out);
}

int win_stat(const char *path, struct win_stat *out)
{
    wchar_t wide[WIDE_MAX];
    if (!win_wide(path, wide)) {
        return -1;
    }
    HANDLE handle = CreateFileW(wide, FILE_READ_ATTRIBUTES,
                                FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                                OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (handle == INVALID_HANDLE_VALUE) {
        return win_fail();
    }
    const int result = describe(handle, out);
    CloseHandle(handle);
    return result;
}

ssize_t win_pread(int descriptor, void *out, size_t size, off_t position)
{
    OVERLAPPED place = {.Offset = (DWORD)position, .OffsetHigh = (DWORD)((uint64_t)position >> 32)};
    DWORD got = 0;
    const DWORD wanted = size < INT_MAX ? (DWORD)size : INT_MAX;
    if (!ReadFile((HANDLE)_get_osfhandle(descriptor), out, wanted, &got, &place)) {
        return GetLastError() == ERROR_HANDLE_EOF ? 0 : win_fail();
    }
    return (ssize_t)got;
}

int win_fcntl(int descriptor, int command)
{
    (void)command; /* F_GETFD: whether it is open */
    return _get_osfhandle(descriptor) == -1 ? -1 : 0;
}

/* Locks here keep others from the bytes as well, so a byte is taken where no file has any. */
int win_flock(int descriptor, int operation)
{
    OVERLAPPED place = {.OffsetHigh = INT_MAX};
    const DWORD flags = ((operation & LOCK_EX) != 0 ? LOCKFILE_EXCLUSIVE_LOCK : 0) |
                        ((operation & LOCK_NB) != 0 ? LOCKFILE_FAIL_IMMEDIATELY : 0);
    return LockFileEx((HANDLE)_get_osfhandle(descriptor), flags, 0, 1, 0, &place) ? 0 : win_fail();
}
