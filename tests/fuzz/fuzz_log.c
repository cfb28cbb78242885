/* .klg and .sens: any bytes give frames or an error line. */
#include "fuzz_file.h"

#include "io/source/backends.h"
#include "log_sample.h"

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    if (index > 2) {
        return 0;
    }
    byte_file *b = index == 0 ? klg_sample_make(LOG_SAMPLE_FRAMES)
                              : sens_sample_make((uint32_t)index - 1, LOG_SAMPLE_FRAMES);
    const size_t size = b->size < capacity ? b->size : capacity;
    memcpy(out, b->data, size);
    free(b);
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const rlf_rig rig = {.depth = {.width = 16, .height = 8, .fx = 5, .fy = 5},
                                .color = {.width = 16, .height = 8, .fx = 9, .fy = 9},
                                .T_color_depth = {.q = {0, 0, 0, 1}},
                                .has_color = true,
                                .depth_max_m = 8};
    fuzz_play(&io_backend_klg, &rig, data, size);
    fuzz_play(&io_backend_sens, NULL, data, size);
    return 0;
}
