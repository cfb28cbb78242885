/* What this build was made without. */
#ifndef RLF_IO_SOURCE_ABSENT_H
#define RLF_IO_SOURCE_ABSENT_H

#include <stdint.h>

/* A format or a driver that this build was made without. */
typedef struct io_backend_absent {
    const char *scheme, *extensions, *option, *summary;
    const char *cure; /* how to get it */
} io_backend_absent;

/* NULL past the last. */
const io_backend_absent *io_backend_absent_at(int32_t index);

#endif
