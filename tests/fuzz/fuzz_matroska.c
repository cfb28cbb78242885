/* Recordings of Azure Kinect cameras: any bytes give frames or an error line. */
#include "fuzz_file.h"

#include "io/source/backends.h"
#include "mkv_sample.h"

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    static const uint32_t sizes[2][2] = {{320, 288}, {4, 3}};
    if (index > 1) {
        return 0;
    }
    byte_file *b = mkv_sample_make(sizes[index], true);
    /* The head alone of the first, whose pictures are too large. */
    const size_t size = b->size < capacity ? b->size : capacity;
    memcpy(out, b->data, size);
    free(b);
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    /* With the calibration that the file holds, and with the user's. */
    static const rlf_rig rig = {.depth = {.width = 4, .height = 3, .fx = 5, .fy = 5},
                                .color = {.width = 16, .height = 8, .fx = 9, .fy = 9},
                                .T_color_depth = {.q = {0, 0, 0, 1}},
                                .has_color = true,
                                .depth_max_m = 8};
    fuzz_play(&io_backend_matroska, NULL, data, size);
    fuzz_play(&io_backend_matroska, &rig, data, size);
    return 0;
}
