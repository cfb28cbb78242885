/* Libraries that are opened at run time. */
#ifndef RLF_WINDOWS_DLFCN_H
#define RLF_WINDOWS_DLFCN_H

#define RTLD_NOW 0
#define RTLD_LOCAL 0

void *win_dlopen(const char *path, int flags);
void *win_dlsym(void *library, const char *name);
int win_dlclose(void *library);
const char *win_dlerror(void); /* of this thread's last call; NULL = none */

#define dlopen win_dlopen
#define dlsym win_dlsym
#define dlclose win_dlclose
#define dlerror win_dlerror

#endif
