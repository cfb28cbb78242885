/* Whether a file is a whole shared object. */
#ifndef RLF_IO_SOURCE_OBJECT_FILE_H
#define RLF_IO_SOURCE_OBJECT_FILE_H

#include "relief/base.h"

/* A file cut short would end the program with SIGBUS inside dlopen, which maps it unseen. NULL = it
 * looks whole; else what is wrong. */
const char *io_object_file_fault(const char *path);

#endif
