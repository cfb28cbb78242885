/* An address that lives longer than the call that gave it. */
#ifndef RLF_IO_LIVE_ADDRESS_COPY_H
#define RLF_IO_LIVE_ADDRESS_COPY_H

#include "relief/backend.h"

typedef struct live_address {
    rlf_address address;
    rlf_rig rig;
    char *text; /* owned: all strings */
} live_address;

/* Do not move *out afterwards. */
rlf_result live_address_copy(const rlf_address *address, live_address *out);
void live_address_free(live_address *address);

#endif
