/* Numbers of files are little-endian, whatever the machine. */
#ifndef RLF_IO_LITTLE_H
#define RLF_IO_LITTLE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define IO_IS_BIG_ENDIAN 1
#else
#define IO_IS_BIG_ENDIAN 0
#endif

/* Turns `count` numbers of `size` bytes, in place, from this machine's order to that of files, or
 * back. */
static inline void io_little(void *numbers, size_t count, size_t size)
{
    uint8_t *bytes = numbers;
    for (size_t i = 0; IO_IS_BIG_ENDIAN && i < count; i++, bytes += size) {
        for (size_t k = 0; k < size / 2; k++) {
            const uint8_t byte = bytes[k];
            bytes[k] = bytes[size - 1 - k];
            bytes[size - 1 - k] = byte;
        }
    }
}

/* One number of a file. */
static inline void io_little_read(const void *bytes, void *out, size_t size)
{
    memcpy(out, bytes, size);
    io_little(out, 1, size);
}

#endif
