/* Shared objects: Windows itself looks whether they are whole. */
#include "io/source/backends.h"

#include <dlfcn.h>

void *io_object_open(const char *path, const char **out_fault)
{
    void *object = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    *out_fault = object == NULL ? dlerror() : NULL;
    return object;
}
