/* LZF: runs of literal bytes, and references to what was written before. */
#include "io/formats/pcd.h"

#include <string.h>

bool io_lzf_decode(const uint8_t *in, size_t in_size, uint8_t *out, size_t size)
{
    const uint8_t *end = in + in_size;
    size_t done = 0;
    while (in < end) {
        const size_t control = *in++;
        if (control < 32) { /* control + 1 literal bytes */
            const size_t count = control + 1;
            if ((size_t)(end - in) < count || size - done < count) {
                return false;
            }
            memcpy(out + done, in, count);
            in += count;
            done += count;
            continue;
        }
        size_t count = control >> 5; /* a reference: length - 2, and 13 bits of distance - 1 */
        if (count == 7) {
            if (in == end) {
                return false;
            }
            count += *in++;
        }
        count += 2;
        if (in == end) {
            return false;
        }
        const size_t distance = ((control & 31) << 8 | *in++) + 1;
        if (distance > done || size - done < count) {
            return false;
        }
        for (size_t i = 0; i < count; i++, done++) { /* may overlap itself */
            out[done] = out[done - distance];
        }
    }
    return done == size;
}
