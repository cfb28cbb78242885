/* PNG and JPEG: any bytes give a picture or an error line. */
#include "fuzz.h"

#include "relief/io.h"
#include "io/picture/picture.h"
#include "jpeg_sample.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* A PNG made by the library's own writer: noise in grey of 16 bits, or RGBA. */
static size_t png_seed(bool is_depth, uint8_t *out, size_t capacity)
{
    static uint8_t cache[2][4096];
    static size_t sizes[2];
    if (sizes[is_depth] == 0) {
        uint16_t pixels[24 * 16 * 2];
        for (int i = 0; i < 24 * 16 * 2; i++) {
            pixels[i] = (uint16_t)(500 + i % 24 + (i * 40503u >> 9) % 7);
        }
        rlf_image_rgba8 image = {(uint8_t *)pixels, 24, 16, 96};
        char name[64];
        snprintf(name, sizeof(name), "fuzz-seed-%ld.png", (long)getpid());
        rlf_result result =
            is_depth ? rlf_png_write_u16(name, pixels, 24, 16) : rlf_png_write_rgba(name, &image);
        FILE *file = result == RLF_OK ? fopen(name, "rb") : NULL;
        if (file != NULL) {
            sizes[is_depth] = fread(cache[is_depth], 1, sizeof(cache[0]), file);
            fclose(file);
        }
        remove(name);
    }
    size_t size = sizes[is_depth] < capacity ? sizes[is_depth] : capacity;
    memcpy(out, cache[is_depth], size);
    return size;
}

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    if (index < 2) {
        return png_seed(index == 0, out, capacity);
    }
    if (index > 2 || sizeof(jpeg_sample) > capacity) {
        return 0;
    }
    memcpy(out, jpeg_sample, sizeof(jpeg_sample));
    return sizeof(jpeg_sample);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    io_bytes file = {"picture", data, size};
    io_picture any = {0};
    if (io_picture_decode(&file, &any) == RLF_OK) {
        rlf_free(any.data);
    }
    io_picture depth = {0};
    if (io_png_decode_u16(&file, &depth) == RLF_OK) {
        rlf_free(depth.data);
    }
    uint16_t pixels[24 * 16];
    io_picture fixed = {.width = 24, .height = 16, .data = pixels};
    (void)io_png_decode_u16(&file, &fixed);
    return 0;
}
