/* Driver libraries that are opened when a camera is asked for: a program made without a vendor's
 * development files still runs every camera whose library is installed. */
#ifndef RLF_IO_DRIVER_LIBRARY_H
#define RLF_IO_DRIVER_LIBRARY_H

#include "relief/base.h"

/* A function of the library, and where its pointer goes in the caller's table. */
typedef struct io_symbol {
    const char *name;
    size_t offset;
    bool is_optional; /* its pointer stays NULL in versions that have none */
} io_symbol;

typedef struct io_library_def {
    const char *variable;     /* of the environment: path of the library to take instead */
    const char *const *names; /* tried in turn; NULL past the last */
    const char *cure;         /* what to install */
    const io_symbol *symbols;
    int32_t symbol_count;
} io_library_def;

/* Fills the pointers of `table`. The library stays loaded: drivers leave threads behind. False with
 * a line in out_reason that says what is missing and what to do. */
bool io_library_load(const io_library_def *def, void *table, char *out_reason, size_t reason_size);

#endif
