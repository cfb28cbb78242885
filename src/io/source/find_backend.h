/* Which back end opens a SOURCE. */
#ifndef RLF_IO_SOURCE_FIND_BACKEND_H
#define RLF_IO_SOURCE_FIND_BACKEND_H

#include "io/source/address.h"
#include "relief/backend.h"

/* By scheme, else by the file name's extension, else by what the back ends recognise. Fails with a
 * line that says what this build can open. */
rlf_result io_backend_find(const char *source, const io_address *address, const rlf_backend **out);

#endif
