/* Unpacking of zlib streams whose size is known. */
#ifndef RLF_IO_PICTURE_INFLATE_H
#define RLF_IO_PICTURE_INFLATE_H

#include "io/file.h"

/* Unpacks `in` into exactly out_size bytes, never more; another size is an error. */
rlf_result io_inflate(const io_bytes *in, void *out, size_t out_size);

#endif
