/* .pcd: any bytes give points, or an error line. */
#include "fuzz.h"

#include "io/formats/pcd.h"

#include <stdlib.h>

#define HEAD "VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"

static const char *const seeds[] = {
    HEAD
    "WIDTH 2\nHEIGHT 2\nPOINTS 4\nDATA ascii\n0 0 1 255\nnan nan nan 0\n0.1 -2e-3 1 65280\n1 1 "
    "1 1\n",
    HEAD "WIDTH 2\nHEIGHT 2\nDATA binary\n0123456789abcdef0123456789abcdef0123456789abcdef"
         "0123456789abcdef",
    "# .PCD v0.7\nFIELDS label x y z n\nSIZE 2 4 8 4 1\nTYPE U F F F I\nCOUNT 1 1 1 1 3\nWIDTH "
    "2\nHEIGHT 2\nDATA binary\n0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"
    "0123456789abcdef01234567",
};

/* 64 bytes: 'a', then references of all kinds. The two sizes come first. */
static const uint8_t packed[] = {8, 0, 0, 0, 64, 0, 0, 0, 0, 'a', 7 << 5, 52, 0, 1 << 5, 3, 0};

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    const int count = (int)(sizeof seeds / sizeof seeds[0]);
    if (index < count) {
        return fuzz_copy(seeds[index], out, capacity);
    }
    const size_t size =
        fuzz_copy(HEAD "WIDTH 2\nHEIGHT 2\nDATA binary_compressed\n", out, capacity);
    if (index > count || size == 0 || size + sizeof(packed) > capacity) {
        return 0;
    }
    memcpy(out + size, packed, sizeof(packed));
    return size + sizeof(packed);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const io_bytes file = {"cloud.pcd", data, size};
    io_pcd_header header;
    io_pcd_points points;
    rlf_camera camera;
    if (io_pcd_header_parse(&file, &header) != RLF_OK ||
        io_pcd_points_read(&file, &header, &points) != RLF_OK) {
        return 0;
    }
    if (io_pcd_lens_fit(&header, &points, &camera) && !(camera.fx > 0.0)) {
        abort();
    }
    io_pcd_points_free(&points);
    return 0;
}
