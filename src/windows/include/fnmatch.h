/* Patterns with * and ?; 0 = it matches. */
#ifndef RLF_WINDOWS_FNMATCH_H
#define RLF_WINDOWS_FNMATCH_H

int win_fnmatch(const char *pattern, const char *text, int flags);
#define fnmatch win_fnmatch

#endif
