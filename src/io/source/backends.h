/* The back ends of this build, and those of plug-ins. */
#ifndef RLF_IO_SOURCE_BACKENDS_H
#define RLF_IO_SOURCE_BACKENDS_H

#include "relief/backend.h"

extern const rlf_backend io_backend_folder;
extern const rlf_backend io_backend_mcap;

/* Built-in ones first, in the order in which they are asked for a file; NULL past the last. */
const rlf_backend *io_backend_at(int32_t index);

/* A format or a driver that this build was made without. */
typedef struct io_backend_absent {
    const char *scheme, *extensions, *option, *summary;
} io_backend_absent;

/* NULL past the last. */
const io_backend_absent *io_backend_absent_at(int32_t index);

/* Makes a source of its parts; they are destroyed when that fails. */
rlf_result io_source_create(const rlf_opened *opened, rlf_source **out);

#endif
