/* How .oni files pack depth: the 16z codec of PrimeSense. */
#ifndef RLF_IO_ONI_DEPTH_CODEC_H
#define RLF_IO_ONI_DEPTH_CODEC_H

#include "relief/base.h"

/* Unpacks exactly `count` pixels. `has_table`: the values are indices into a table that comes
 * first. False: the data is not of this kind, or ends too early. */
bool oni_depth_decode(const uint8_t *data, size_t size, bool has_table, uint16_t *out,
                      size_t count);

#endif
