/* Recordings of other programs that are not opened as they are. */
#ifndef RLF_IO_SOURCE_FOREIGN_FILE_H
#define RLF_IO_SOURCE_FOREIGN_FILE_H

#include "relief/base.h"

/* RLF_OK, or an error that says what the path is and how it is opened: a ROS 2 recording's folder
 * or database, a compressed file. */
rlf_result io_foreign_check(const char *source, const char *path);

#endif
