/* The system's name. */
#ifndef RLF_WINDOWS_UTSNAME_H
#define RLF_WINDOWS_UTSNAME_H

struct utsname {
    char sysname[16], machine[16];
};
int win_uname(struct utsname *out);
#define uname win_uname

#endif
