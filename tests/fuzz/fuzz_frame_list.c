/* depth.txt: any bytes give a list in order of time, or an error line. */
#include "fuzz.h"

#include "io/folder/folder.h"

#include <stdlib.h>

static const char *const seeds[] = {
    "# timestamp filename\n0.000000 depth/000000.png\n0.033333 depth/000001.png\n"
    "0.066667 depth/000002.png\n",
    "1305031229.528784 a b.png\r\n\n1305031229.5 c.png\n  # end\n7 d"};

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    int count = (int)(sizeof seeds / sizeof seeds[0]);
    return index < count ? fuzz_copy(seeds[index], out, capacity) : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    io_bytes file = {"depth.txt", data, size};
    io_frame_list list;
    if (io_frame_list_parse(&file, &list) != RLF_OK) {
        return 0;
    }
    for (int32_t i = 0; i < list.count; i++) {
        const io_list_entry *e = &list.entries[i];
        int64_t before = i > 0 ? list.entries[i - 1].time_ns : 0;
        if (e->time_ns < before || e->name[0] == '\0') {
            abort();
        }
    }
    io_frame_list_free(&list);
    return 0;
}
