/* What a harness gives to libFuzzer, and to the driver that stands in for it. */
#ifndef RLF_TEST_FUZZ_H
#define RLF_TEST_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Reads arbitrary bytes as the format under test. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Valid inputs to start from: copies seed `index` and returns its size; 0 = there are no more. */
size_t fuzz_seed(int index, uint8_t *out, size_t capacity);

/* A seed from text; 0 when it does not fit. */
static inline size_t fuzz_copy(const char *text, uint8_t *out, size_t capacity)
{
    size_t size = strlen(text);
    if (size > capacity) {
        return 0;
    }
    memcpy(out, text, size);
    return size;
}

#endif
