/* The command's arguments in UTF-8, with / in names, and standard streams that carry bytes. */
#include "windows/posix.h"

#include "windows/wide.h"

#include <windows.h>

int main(int argc, char **argv);
int wmain(int argc, wchar_t **wide);

/* A name's backslashes; others Relief's arguments do not have. */
static char *narrow(const wchar_t *wide)
{
    const size_t size = 3 * wcslen(wide) + 1; /* bytes, at most */
    char *text = malloc(size);
    if (text == NULL || !win_narrow(wide, text, size)) {
        abort();
    }
    for (char *c = text; *c != '\0'; c++) {
        *c = *c == '\\' ? '/' : *c;
    }
    return text;
}

int wmain(int argc, wchar_t **wide)
{
    char **arguments = calloc((size_t)argc + 1, sizeof(*arguments));
    if (arguments == NULL) {
        abort();
    }
    for (int i = 0; i < argc; i++) {
        arguments[i] = narrow(wide[i]);
    }
    for (int i = STDIN_FILENO; i <= STDERR_FILENO; i++) {
        (void)_setmode(i, _O_BINARY);
    }
    SetConsoleOutputCP(CP_UTF8);
    return main(argc, arguments);
}
