/* ROS 1 bags: any bytes give frames or an error line. */
#include "fuzz_file.h"

#include "bag_sample.h"
#include "io/source/backends.h"

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    if (index > 2) {
        return 0;
    }
    bag_file *b = index < 2 ? bag_sample_make(index == 0) : bag_file_new();
    if (index == 2) {
        byte_file *packed = calloc(1, sizeof(*packed));
        bag_sample_chunk(b, 0);
        bag_sample_lz4(&b->chunk, packed);
        bag_file_flush(b, "lz4", packed, true);
        free(packed);
    }
    const size_t size = b->file.size < capacity ? b->file.size : 0;
    memcpy(out, b->file.data, size);
    free(b);
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_play(&io_backend_rosbag, NULL, data, size);
    return 0;
}
