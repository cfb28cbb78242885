/* A camera without hardware, for tests and for people without one. */
#ifndef RLF_IO_SIMULATED_SIMULATED_H
#define RLF_IO_SIMULATED_SIMULATED_H

#include "relief/source.h"

typedef rlf_result (*io_open_fn)(const char *source, rlf_pool *pool, rlf_source **out);

/* Lends it the function that opens what it plays. It cannot call it by name: that function knows
 * all back ends, this one among them. Thread-safe. */
void io_simulated_lend_open(io_open_fn opener);

#endif
