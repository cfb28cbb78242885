/* Shared objects: drivers and plug-ins. */
#ifndef RLF_IO_SOURCE_OBJECT_FILE_H
#define RLF_IO_SOURCE_OBJECT_FILE_H

#include "relief/base.h"

/* Opens a shared object: a path, whose file is looked at first, since one that is cut short would
 * end the program with SIGBUS inside dlopen, which maps it unseen; or a name without a slash, which
 * the system looks for. NULL with what is wrong in *out_fault. */
void *io_object_open(const char *path, const char **out_fault);

#endif
