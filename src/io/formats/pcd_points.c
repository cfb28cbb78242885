/* The points of a PCD file: as text, as bytes point by point, or compressed field by field. */
#include "io/formats/pcd.h"
#include "io/file.h"
#include "io/little.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TOKEN_SIZE 64

static rlf_result fail(const io_bytes *file, const char *what)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s: %s: copy or write the file again", file->name, what);
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof(bits));
    return bits;
}

static void put_color(uint8_t *rgba, uint32_t bits)
{
    rgba[0] = (uint8_t)(bits >> 16);
    rgba[1] = (uint8_t)(bits >> 8);
    rgba[2] = (uint8_t)bits;
    rgba[3] = 255;
}

static const io_pcd_field *find_color(const io_pcd_header *h)
{
    const io_pcd_field *f = io_pcd_field_find(h, "rgb");
    f = f != NULL ? f : io_pcd_field_find(h, "rgba");
    return f != NULL && f->size == 4 ? f : NULL;
}

static float number_at(const uint8_t *at, const io_pcd_field *f)
{
    if (f->size == 8) {
        double value;
        io_little_read(at, &value, sizeof(value));
        return (float)value;
    }
    float value;
    io_little_read(at, &value, sizeof(value));
    return value;
}

/* Where the fields' bytes are: of point i at first + i * step. */
static void take_bytes(const uint8_t *first, size_t step, size_t count, const io_pcd_field *f,
                       float *out)
{
    for (size_t i = 0; i < count; i++) {
        out[i] = number_at(first + i * step, f);
    }
}

static void take_color_bytes(const uint8_t *first, size_t step, size_t count, uint8_t *out)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        io_little_read(first + i * step, &bits, sizeof(bits));
        put_color(out + 4 * i, bits);
    }
}

/* Point by point, or (`is_planar`) field by field. */
static void take_all(const uint8_t *data, const io_pcd_header *h, bool is_planar,
                     io_pcd_points *out)
{
    const size_t count = (size_t)h->width * (size_t)h->height;
    const char *const names[3] = {"x", "y", "z"};
    float *const planes[3] = {out->x, out->y, out->z};
    for (int k = 0; k < 3; k++) {
        const io_pcd_field *f = io_pcd_field_find(h, names[k]);
        take_bytes(data + f->offset * (is_planar ? count : 1),
                   is_planar ? (size_t)f->count * (size_t)f->size : h->point_size, count, f,
                   planes[k]);
    }
    const io_pcd_field *f = find_color(h);
    if (f != NULL) {
        take_color_bytes(data + f->offset * (is_planar ? count : 1),
                         is_planar ? (size_t)f->count * (size_t)f->size : h->point_size, count,
                         out->rgba);
    }
}

static rlf_result read_compressed(const io_bytes *file, const io_pcd_header *h, io_pcd_points *out)
{
    const size_t size = (size_t)h->width * (size_t)h->height * h->point_size;
    uint32_t sizes[2]; /* compressed, whole */
    if (file->size - h->data_offset < sizeof(sizes)) {
        return fail(file, "is cut short");
    }
    memcpy(sizes, file->data + h->data_offset, sizeof(sizes));
    io_little(sizes, 2, sizeof(sizes[0]));
    const size_t there = file->size - h->data_offset - sizeof(sizes);
    if (sizes[0] > there) {
        return fail(file, "is cut short");
    }
    if (sizes[1] != size || size / IO_LZF_RATIO_MAX > sizes[0]) {
        return fail(file, "the compressed data cannot be the points of the header");
    }
    uint8_t *whole = rlf_alloc(size);
    if (whole == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const bool is_right =
        io_lzf_decode(file->data + h->data_offset + sizeof(sizes), sizes[0], whole, size);
    if (is_right) {
        take_all(whole, h, true, out);
    }
    rlf_free(whole);
    return is_right ? RLF_OK : fail(file, "the compressed data is damaged");
}

/* Words of the text part. */
typedef struct words {
    const uint8_t *at, *end;
} words;

static bool next_word(words *w, char out[TOKEN_SIZE])
{
    while (w->at < w->end && *w->at <= ' ') {
        w->at++;
    }
    size_t length = 0;
    while (w->at<w->end && * w->at> ' ') {
        if (length + 1 < TOKEN_SIZE) {
            out[length++] = (char)*w->at;
        }
        w->at++;
    }
    out[length] = '\0';
    return length > 0;
}

static void take_word(const io_pcd_header *h, size_t place, const char *word, size_t i,
                      io_pcd_points *out)
{
    const io_pcd_field *color = find_color(h);
    const char *const names[3] = {"x", "y", "z"};
    float *const planes[3] = {out->x, out->y, out->z};
    double value = NAN; /* "nan" is no number here */
    if (!io_number_parse(word, &value)) {
        value = NAN;
    }
    for (int k = 0; k < 3; k++) {
        if (io_pcd_field_find(h, names[k])->offset == place) {
            planes[k][i] = (float)value;
        }
    }
    if (color != NULL && color->offset == place) {
        const bool is_number = value >= 0.0 && value <= 4294967295.0;
        put_color(out->rgba + 4 * i, color->type == 'F' ? bits_of((float)value)
                                     : is_number        ? (uint32_t)value
                                                        : 0);
    }
}

static rlf_result read_ascii(const io_bytes *file, const io_pcd_header *h, io_pcd_points *out)
{
    const size_t count = (size_t)h->width * (size_t)h->height;
    words w = {file->data + h->data_offset, file->data + file->size};
    char word[TOKEN_SIZE];
    for (size_t i = 0; i < count; i++) {
        for (size_t place = 0; place < h->point_size; place++) {
            if (!next_word(&w, word)) {
                return fail(file, "is cut short");
            }
            take_word(h, place, word, i, out);
        }
    }
    return RLF_OK;
}

static rlf_result allocate(const io_pcd_header *h, io_pcd_points *out)
{
    const size_t count = (size_t)h->width * (size_t)h->height;
    out->x = rlf_alloc_array(count, sizeof(float));
    out->y = rlf_alloc_array(count, sizeof(float));
    out->z = rlf_alloc_array(count, sizeof(float));
    const bool has_color = find_color(h) != NULL;
    out->rgba = has_color ? rlf_alloc_array(count, 4) : NULL;
    const bool is_whole = out->x != NULL && out->y != NULL && out->z != NULL;
    return is_whole && (out->rgba != NULL || !has_color) ? RLF_OK : RLF_ERROR_MEMORY;
}

/* The file has so many bytes as the points need at least: nothing is allocated for a wrong claim.
 */
static rlf_result check_size(const io_bytes *file, const io_pcd_header *h)
{
    const size_t count = (size_t)h->width * (size_t)h->height;
    const size_t there = file->size - h->data_offset;
    if (h->data == IO_PCD_ASCII && (there + 1) / 2 / h->point_size < count) {
        return fail(file, "is cut short"); /* a word is a digit and what follows it */
    }
    if (h->data == IO_PCD_BINARY && there / h->point_size < count) {
        return fail(file, "is cut short");
    }
    return h->data != IO_PCD_COMPRESSED || count * h->point_size / IO_LZF_RATIO_MAX <= there
               ? RLF_OK
               : fail(file, "is cut short");
}

rlf_result io_pcd_points_read(const io_bytes *file, const io_pcd_header *header, io_pcd_points *out)
{
    memset(out, 0, sizeof(*out));
    rlf_result result = check_size(file, header);
    result = result == RLF_OK ? allocate(header, out) : result;
    if (result == RLF_OK) {
        switch (header->data) {
        case IO_PCD_ASCII: result = read_ascii(file, header, out); break;
        case IO_PCD_BINARY: take_all(file->data + header->data_offset, header, false, out); break;
        case IO_PCD_COMPRESSED: result = read_compressed(file, header, out); break;
        }
    }
    if (result != RLF_OK) {
        io_pcd_points_free(out);
    }
    return result;
}

void io_pcd_points_free(io_pcd_points *points)
{
    rlf_free(points->x);
    rlf_free(points->y);
    rlf_free(points->z);
    rlf_free(points->rgba);
    memset(points, 0, sizeof(*points));
}

/* ---- LZF: literal bytes, and references to what was written before ----------------------- */

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
