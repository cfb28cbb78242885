/* Unpacking of zlib streams whose size is known. */
#include "io/picture/inflate.h"

#include <zlib.h>

rlf_result io_inflate(const io_bytes *in, void *out, size_t out_size)
{
    uLongf size = (uLongf)out_size;
    const int code = uncompress(out, &size, in->data, (uLong)in->size);
    if (code == Z_MEM_ERROR) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory while reading it", in->name);
    }
    if (code != Z_OK || size != out_size) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: packed depth is damaged or of another size than %zu bytes: copy the "
                        "file again, or check the calibration's size",
                        in->name, out_size);
    }
    return RLF_OK;
}
