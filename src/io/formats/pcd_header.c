/* The header of a PCD file: lines of a key and its words, up to DATA. */
#include "io/formats/pcd.h"

#include "relief/image.h"

#include <stdlib.h>
#include <string.h>

#define LINE_SIZE 1024
#define LINES_MAX 64

typedef struct header_line {
    char text[LINE_SIZE];
    char *words[IO_PCD_FIELDS_MAX + 1];
    int32_t count;
} header_line;

static rlf_result fail(const io_bytes *file, const char *what)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: is damaged or no PCD file: %s: write it again with PCL or Open3D",
                    file->name, what);
}

/* Takes the next line apart; false at the file's end or where the line has no end. */
static bool read_line(const io_bytes *file, size_t *at, header_line *out)
{
    size_t length = 0;
    while (*at + length < file->size && file->data[*at + length] != '\n') {
        length++;
    }
    if (*at + length >= file->size || length >= LINE_SIZE ||
        memchr(file->data + *at, '\0', length) != NULL) {
        return false;
    }
    memcpy(out->text, file->data + *at, length);
    out->text[length] = '\0';
    *at += length + 1;
    out->count = 0;
    for (char *c = out->text; *c != '\0' && out->count <= IO_PCD_FIELDS_MAX;) {
        c += strspn(c, " \t\r");
        if (*c == '\0') {
            break;
        }
        out->words[out->count++] = c;
        c += strcspn(c, " \t\r");
        if (*c != '\0') {
            *c++ = '\0';
        }
    }
    return true;
}

/* A whole number from 0 to a billion; -1 otherwise. */
static int64_t number_of(const char *text)
{
    char *end = NULL;
    if (strspn(text, "0123456789") != strlen(text) || strlen(text) > 10) {
        return -1;
    }
    const long long value = strtoll(text, &end, 10);
    return end != text && value <= 1000000000 ? value : -1;
}

static bool take_field(io_pcd_header *h, int32_t i, const char *key, const char *word)
{
    io_pcd_field *f = &h->fields[i];
    const int64_t number = number_of(word);
    if (strcmp(key, "FIELDS") == 0) {
        strncpy(f->name, word, sizeof(f->name) - 1);
        f->size = 4;
        f->count = 1;
        f->type = 'F';
        return true;
    }
    if (strcmp(key, "SIZE") == 0) {
        f->size = (int32_t)number;
        return number == 1 || number == 2 || number == 4 || number == 8;
    }
    if (strcmp(key, "TYPE") == 0) {
        f->type = word[0];
        return strlen(word) == 1 && strchr("FIU", word[0]) != NULL;
    }
    f->count = (int32_t)number; /* COUNT */
    return number >= 1 && number <= 65536;
}

static bool take_fields(io_pcd_header *h, const header_line *l)
{
    const bool is_first = strcmp(l->words[0], "FIELDS") == 0;
    const int32_t count = l->count - 1;
    if (count < 1 || count > IO_PCD_FIELDS_MAX || (!is_first && count != h->field_count)) {
        return false;
    }
    h->field_count = count;
    for (int32_t i = 0; i < count; i++) {
        if (!take_field(h, i, l->words[0], l->words[i + 1])) {
            return false;
        }
    }
    return true;
}

static bool take_data(io_pcd_header *h, const char *word)
{
    static const char *const names[] = {"ascii", "binary", "binary_compressed"};
    for (int i = 0; i < 3; i++) {
        if (strcmp(word, names[i]) == 0) {
            h->data = (io_pcd_data)i;
            return true;
        }
    }
    return false;
}

/* False when the line's value cannot be. */
static bool take_line(io_pcd_header *h, const header_line *l, int32_t *points)
{
    const char *key = l->words[0];
    const bool is_field_line = strcmp(key, "FIELDS") == 0 || strcmp(key, "SIZE") == 0 ||
                               strcmp(key, "TYPE") == 0 || strcmp(key, "COUNT") == 0;
    if (is_field_line) {
        return take_fields(h, l);
    }
    if (l->count < 2) {
        return true; /* VERSION and VIEWPOINT do not matter, nor what is not known */
    }
    const struct {
        const char *key;
        int32_t *out;
        int32_t least;
    } numbers[] = {{"WIDTH", &h->width, 1}, {"HEIGHT", &h->height, 1}, {"POINTS", points, 0}};
    for (int i = 0; i < 3; i++) {
        if (strcmp(key, numbers[i].key) == 0) {
            *numbers[i].out = (int32_t)number_of(l->words[1]);
            return *numbers[i].out >= numbers[i].least;
        }
    }
    return strcmp(key, "DATA") != 0 || take_data(h, l->words[1]);
}

static void place_fields(io_pcd_header *h)
{
    for (int32_t i = 0; i < h->field_count; i++) {
        io_pcd_field *f = &h->fields[i];
        f->offset = h->point_size;
        h->point_size += (size_t)f->count * (h->data == IO_PCD_ASCII ? 1 : (size_t)f->size);
    }
}

static rlf_result check(const io_bytes *file, const io_pcd_header *h, int32_t points)
{
    const char *const needed[] = {"x", "y", "z"};
    for (int i = 0; i < 3; i++) {
        const io_pcd_field *f = io_pcd_field_find(h, needed[i]);
        if (f == NULL || f->type != 'F' || f->size < 4) {
            return fail(file, "its points have no x, y and z of type F");
        }
    }
    if (h->height < 2 || h->width < 2) {
        return rlf_fail(
            RLF_ERROR_UNSUPPORTED,
            "%s: is a heap of %lld points and no picture (HEIGHT %d): give an organised "
            "cloud, as the camera made it",
            file->name, (long long)h->width * h->height, (int)h->height);
    }
    if (h->width > RLF_IMAGE_SIZE_MAX || h->height > RLF_IMAGE_SIZE_MAX) {
        return fail(file, "WIDTH or HEIGHT is too large");
    }
    return points < 0 || points == (int64_t)h->width * h->height
               ? RLF_OK
               : fail(file, "POINTS is not WIDTH times HEIGHT");
}

rlf_result io_pcd_header_parse(const io_bytes *file, io_pcd_header *out)
{
    memset(out, 0, sizeof(*out));
    size_t at = 0;
    int32_t points = -1;
    for (int line = 0; line < LINES_MAX; line++) {
        header_line l;
        if (!read_line(file, &at, &l)) {
            return fail(file, "the header has no end");
        }
        if (l.count == 0 || l.words[0][0] == '#') {
            continue;
        }
        if (!take_line(out, &l, &points)) {
            char what[64] = "the header's line ";
            strncat(what, l.words[0], 32);
            return fail(file, what);
        }
        if (strcmp(l.words[0], "DATA") == 0) {
            out->data_offset = at;
            place_fields(out);
            return check(file, out, points);
        }
    }
    return fail(file, "the header has no end");
}

const io_pcd_field *io_pcd_field_find(const io_pcd_header *header, const char *name)
{
    for (int32_t i = 0; i < header->field_count; i++) {
        if (strcmp(header->fields[i].name, name) == 0) {
            return &header->fields[i];
        }
    }
    return NULL;
}
