/* Opens a camera without what rlf_open_source puts round it (its own thread, coming back after a
 * fault), so that a test plays picture by picture. */
#ifndef RLF_TEST_BARE_SOURCE_H
#define RLF_TEST_BARE_SOURCE_H

#include "io/source/address.h"
#include "io/source/backends.h"
#include "io/source/find_backend.h"
#include "relief/io.h"

#include <string.h>

static inline rlf_result bare_open(const char *source, rlf_source **out)
{
    static io_address parts;
    const rlf_backend *backend = NULL;
    rlf_rig rig;
    rlf_opened opened;
    memset(&opened, 0, sizeof(opened));
    rlf_result result = io_address_parse(source, &parts);
    rlf_address address = {.source = source};
    const char *camera = result == RLF_OK ? io_address_take(&parts, "camera") : NULL;
    if (result == RLF_OK && camera != NULL) {
        result = rlf_rig_load(camera, &rig, &address.units_per_metre);
        address.rig = &rig;
    }
    if (result == RLF_OK) {
        result = io_backend_find(source, &parts, &backend);
    }
    address.place = parts.place;
    address.key_count = parts.key_count;
    for (int32_t i = 0; i < parts.key_count; i++) {
        address.keys[i] = parts.keys[i];
        address.values[i] = parts.values[i];
    }
    if (result == RLF_OK) {
        result = backend->open(&address, &opened);
    }
    return result == RLF_OK ? io_source_create(&opened, out) : result;
}

#endif
