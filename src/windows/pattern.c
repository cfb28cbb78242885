/* Patterns of names. */
#include <fnmatch.h>

int win_fnmatch(const char *pattern, const char *text, int flags)
{
    const char *star = 0, *from = text; /* the last *, and where what it stands for ends */
    while (*text != '\0') {
        if (*pattern == '*') {
            star = ++pattern;
            from = text;
        } else if (*pattern == '?' || *pattern == *text) {
            pattern++;
            text++;
        } else if (star != 0) {
            pattern = star;
            text = ++from;
        } else {
            return 1;
        }
    }
    while (*pattern == '*') {
        pattern++;
    }
    return *pattern != '\0' || flags != 0;
}
