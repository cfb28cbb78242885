/* .oni recordings: any bytes give frames or an error line. */
#include "fuzz.h"

#include "io/source/backends.h"
#include "oni_sample.h"

#include <stdio.h>
#include <unistd.h>

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    static oni_bytes b;
    if (index > 3) {
        return 0;
    }
    oni_sample(&b, index >= 2, index % 2 == 1);
    const size_t size = b.size <= capacity ? b.size : 0;
    memcpy(out, b.data, size);
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[64];
    snprintf(path, sizeof(path), "fuzz-oni-%ld.oni", (long)getpid());
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        return 0;
    }
    fwrite(data, 1, size, file);
    fclose(file);
    const rlf_address address = {.source = path, .place = path};
    rlf_opened opened;
    if (io_backend_oni.open(&address, &opened) == RLF_OK) {
        rlf_frame frame;
        for (int i = 0; i < 8 && opened.methods.next(opened.self, &frame) != RLF_END; i++) {
        }
        opened.methods.destroy(opened.self);
    }
    remove(path);
    return 0;
}
