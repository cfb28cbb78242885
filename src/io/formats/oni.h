/* Recordings of OpenNI. */
#ifndef RLF_IO_FORMATS_ONI_H
#define RLF_IO_FORMATS_ONI_H

#include "io/clip/clip.h"
#include "relief/base.h"

/* ---- What an .oni file holds and where: its records are walked over once ---- */

#define ONI_CODEC(a, b, c, d)                                                                      \
    ((uint32_t)(a) | (uint32_t)(b) << 8 | (uint32_t)(c) << 16 | (uint32_t)(d) << 24)
#define ONI_CODEC_NONE ONI_CODEC('N', 'O', 'N', 'E')
#define ONI_CODEC_JPEG ONI_CODEC('J', 'P', 'E', 'G')
#define ONI_CODEC_16Z ONI_CODEC('1', '6', 'z', 'P')
#define ONI_CODEC_16Z_TABLE ONI_CODEC('1', '6', 'z', 'T')

/* A stream of the file. */
typedef struct oni_node {
    bool is_there;
    uint32_t id, codec;
    int32_t width, height;
    int32_t max_depth;    /* 0 = not told */
    int32_t pixel_format; /* OpenNI2's number; 0 = not told */
    int32_t rgb_format;   /* OpenNI 1's number: 1 = RGB; 0 = not told */
    double fov_x, fov_y;  /* radians; 0 = not told */
    bool is_mirrored, is_registered;
    io_shots pictures; /* in the order of time */
} oni_node;

typedef struct oni_index {
    oni_node depth, color;
    bool is_cut; /* ends without an end record: what is whole was found */
} oni_index;

/* Walks over the file. Free the index even when this fails. */
rlf_result oni_index_read(const io_file *file, oni_index *out);
void oni_index_free(oni_index *index);

/* ---- How .oni files pack depth: the 16z codec of PrimeSense ---- */

/* Unpacks exactly `count` pixels. `has_table`: the values are indices into a table that comes
 * first. False: the data is not of this kind, or ends too early. */
bool oni_depth_decode(const uint8_t *data, size_t size, bool has_table, uint16_t *out,
                      size_t count);

#endif
