/* Libraries that are opened at run time. */
#include "windows/posix.h"

#include "windows/wide.h"

#include <dlfcn.h>
#include <windows.h>

static _Thread_local char fault[256];

static void note_fault(void)
{
    wchar_t text[200] = L"";
    FormatMessageW(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, NULL, GetLastError(),
                   0, text, 200, NULL);
    text[wcscspn(text, L"\r\n")] = L'\0';
    if (!win_narrow(text, fault, sizeof(fault))) {
        fault[0] = '\0';
    }
}

void *win_dlopen(const char *path, int flags)
{
    (void)flags;
    wchar_t wide[WIDE_MAX];
    fault[0] = '\0';
    void *library = win_wide(path, wide) ? (void *)LoadLibraryW(wide) : NULL;
    if (library == NULL) {
        /* What library.c takes for absence. */
        const bool is_missing = GetLastError() == ERROR_MOD_NOT_FOUND;
        is_missing ? (void)snprintf(fault, sizeof(fault), "No such file") : note_fault();
    }
    return library;
}

void *win_dlsym(void *library, const char *name)
{
    FARPROC address = GetProcAddress(library, name);
    void *symbol = NULL;
    memcpy(&symbol, &address, sizeof(symbol));
    return symbol;
}

int win_dlclose(void *library)
{
    return FreeLibrary(library) ? 0 : -1;
}

const char *win_dlerror(void)
{
    return fault[0] != '\0' ? fault : NULL;
}
