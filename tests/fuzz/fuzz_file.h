/* For harnesses of formats that are read from a file: writes the input, opens and plays it. */
#ifndef RLF_TEST_FUZZ_FILE_H
#define RLF_TEST_FUZZ_FILE_H

#include "fuzz.h"

#include "relief/backend.h"

#include <stdio.h>
#include <unistd.h>

/* `rig` NULL: the file's own calibration. */
static inline void fuzz_play(const rlf_backend *backend, const rlf_rig *rig, const uint8_t *data,
                             size_t size)
{
    char path[64];
    snprintf(path, sizeof(path), "fuzz-%s-%ld", backend->scheme, (long)getpid());
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        return;
    }
    fwrite(data, 1, size, file);
    fclose(file);
    const rlf_address address = {
        .source = path, .place = path, .rig = rig, .units_per_metre = 1000.0};
    rlf_opened opened;
    if (backend->open(&address, &opened) == RLF_OK) {
        rlf_frame frame;
        for (int i = 0; i < 8 && opened.methods.next(opened.self, &frame) != RLF_END; i++) {
        }
        opened.methods.destroy(opened.self);
    }
    remove(path);
}

#endif
