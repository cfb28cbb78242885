/* Walks over the records of an .oni file.
 *
 * File:   "NI10", version, longest time (24 bytes), then records.
 * Record: "NIR\0", type, node, size of header and fields, size of payload, each u32; the place of
 *         the record that this one replaces, u64 (u32 in the oldest files); fields; payload.
 * All numbers are little-endian, and so are the machines that this is built for. */
#include "io/formats/oni.h"

#include "io/file.h"
#include "io/little.h"

#include <stdlib.h>
#include <string.h>

#define FILE_HEADER 24
#define RECORD_MAGIC 0x0052494Eu
#define HEADER_64 28
#define HEADER_32 24
#define FIELDS_MAX 1024 /* of the records that matter; longer ones are passed over */
#define NAME_MAX_SIZE 64

enum {
    RECORD_INT = 3,
    RECORD_GENERAL = 6,
    RECORD_DATA = 10,
    RECORD_END = 11,
    RECORD_ADDED_OLDEST = 2,
    RECORD_ADDED_OLD = 12,
    RECORD_ADDED = 13
};
enum { NODE_DEPTH = 2, NODE_IMAGE = 3 };

typedef struct record {
    uint32_t magic, type, node, fields_size, payload_size;
} record;

/* The fields of a record, read from the front. */
typedef struct fields {
    uint8_t data[FIELDS_MAX];
    size_t size, at;
} fields;

static bool take(fields *f, void *out, size_t size)
{
    if (f->size - f->at < size) {
        return false;
    }
    memcpy(out, f->data + f->at, size);
    f->at += size;
    return true;
}

static bool take_numbers(fields *f, void *out, size_t count, size_t size)
{
    if (!take(f, out, count * size)) {
        return false;
    }
    io_little(out, count, size);
    return true;
}

/* A text with its length in front. */
static bool take_name(fields *f, char out[NAME_MAX_SIZE])
{
    uint32_t size = 0;
    if (!take_numbers(f, &size, 1, 4) || size == 0 || size > NAME_MAX_SIZE || !take(f, out, size)) {
        return false;
    }
    out[size - 1] = '\0';
    return true;
}

static oni_node *node_of(oni_index *index, uint32_t id)
{
    if (index->depth.is_there && index->depth.id == id) {
        return &index->depth;
    }
    return index->color.is_there && index->color.id == id ? &index->color : NULL;
}

/* The first depth node and the first image node are read. */
static void add_node(oni_index *index, const record *r, fields *f)
{
    char name[NAME_MAX_SIZE];
    uint32_t type = 0;
    uint32_t codec = 0;
    if (!take_name(f, name) || !take_numbers(f, &type, 1, 4) || !take_numbers(f, &codec, 1, 4)) {
        return;
    }
    oni_node *node = type == NODE_DEPTH ? &index->depth : type == NODE_IMAGE ? &index->color : NULL;
    if (node != NULL && !node->is_there) {
        node->is_there = true;
        node->id = r->node;
        node->codec = codec;
    }
}

static void set_number(oni_node *node, const char *name, uint64_t value)
{
    const int32_t number = value <= INT32_MAX ? (int32_t)value : 0;
    if (strcmp(name, "xnMirror") == 0) {
        node->is_mirrored = value != 0;
    } else if (strcmp(name, "AlternativeViewPoint") == 0) {
        node->is_registered = value != 0;
    } else if (strcmp(name, "xnDeviceMaxDepth") == 0) {
        node->max_depth = number;
    } else if (strcmp(name, "oniPixelFormat") == 0) {
        node->pixel_format = number;
    } else if (strcmp(name, "xnPixelFormat") == 0) {
        node->rgb_format = number;
    }
}

/* Properties that come after the first picture change nothing: one clip has one calibration. */
static void set_property(oni_node *node, const record *r, fields *f)
{
    char name[NAME_MAX_SIZE];
    uint32_t size = 0;
    uint64_t number = 0;
    uint32_t mode[3];
    double fov[2];
    if (node == NULL || node->pictures.count > 0 || !take_name(f, name) ||
        !take_numbers(f, &size, 1, 4)) {
        return;
    }
    if (r->type == RECORD_INT) {
        if (take_numbers(f, &number, 1, 8)) {
            set_number(node, name, number);
        }
    } else if (strcmp(name, "xnMapOutputMode") == 0 && take_numbers(f, mode, 3, sizeof(mode[0]))) {
        node->width = mode[0] <= INT32_MAX ? (int32_t)mode[0] : 0;
        node->height = mode[1] <= INT32_MAX ? (int32_t)mode[1] : 0;
    } else if (strcmp(name, "xnFOV") == 0 && take_numbers(f, fov, 2, sizeof(fov[0]))) {
        node->fov_x = fov[0];
        node->fov_y = fov[1];
    }
}

/* Pictures of time 0 and number 0 are no pictures: some recorders write them first. */
static rlf_result add_picture(oni_node *node, const char *name, const record *r, fields *f,
                              int64_t offset)
{
    uint64_t time_us = 0;
    uint32_t number = 0;
    if (node == NULL || r->payload_size == 0 || !take_numbers(f, &time_us, 1, 8) ||
        !take_numbers(f, &number, 1, 4) || time_us > INT64_MAX / 1000 ||
        (time_us == 0 && number == 0)) {
        return RLF_OK;
    }
    const io_shot shot = {(int64_t)time_us * 1000, offset, r->payload_size};
    return io_shots_add(&node->pictures, name, shot);
}

static rlf_result use_record(oni_index *index, const char *name, const record *r, fields *f,
                             int64_t payload_offset)
{
    switch (r->type) {
    case RECORD_ADDED_OLDEST:
    case RECORD_ADDED_OLD:
    case RECORD_ADDED: add_node(index, r, f); return RLF_OK;
    case RECORD_INT:
    case RECORD_GENERAL: set_property(node_of(index, r->node), r, f); return RLF_OK;
    case RECORD_DATA: return add_picture(node_of(index, r->node), name, r, f, payload_offset);
    default: return RLF_OK;
    }
}

static bool read_at(const io_file *file, int64_t position, void *out, size_t size)
{
    return io_file_read_at(file, position, out, size) == size;
}

/* Reads a record's header and fields; *position goes behind them. False at the end of what is
 * whole. */
static bool read_record(const io_file *file, int64_t *position, uint32_t header_size, record *out,
                        fields *f)
{
    f->size = 0;
    f->at = 0;
    if (!read_at(file, *position, out, sizeof(*out))) {
        return false;
    }
    io_little(out, sizeof(*out) / sizeof(out->magic), sizeof(out->magic));
    if (out->magic != RECORD_MAGIC || out->fields_size < header_size) {
        return false;
    }
    const int64_t begin = *position + header_size;
    const uint32_t size = out->fields_size - header_size;
    f->size = size <= FIELDS_MAX ? size : 0;
    *position = begin + size;
    return *position <= file->size && read_at(file, begin, f->data, f->size);
}

/* In the oldest files the length of the first node's name stands where newer ones have the upper
 * half of a place, which is 0. */
static rlf_result read_file_header(const io_file *file, uint32_t *out_header_size)
{
    uint8_t head[FILE_HEADER + HEADER_64];
    uint32_t upper = 0;
    if (!read_at(file, 0, head, sizeof(head)) || memcmp(head, "NI10", 4) != 0) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is no OpenNI recording (it does not start with NI10)", file->path);
    }
    memcpy(&upper, head + FILE_HEADER + HEADER_32, 4);
    *out_header_size = upper == 0 ? HEADER_64 : HEADER_32;
    return RLF_OK;
}

static void sort_by_time(oni_node *node, const char *name)
{
    if (io_shots_sort(&node->pictures)) {
        rlf_log(RLF_LOG_WARNING, "%s: the time goes back: the pictures are sorted by time", name);
    }
}

static rlf_result walk(const io_file *file, uint32_t header_size, oni_index *out)
{
    record r = {0};
    fields f;
    int64_t position = FILE_HEADER;
    out->is_cut = true;
    while (read_record(file, &position, header_size, &r, &f)) {
        if (r.type == RECORD_END) {
            out->is_cut = false;
            break;
        }
        if (file->size - position < (int64_t)r.payload_size) {
            break;
        }
        rlf_result result = use_record(out, file->path, &r, &f, position);
        if (result != RLF_OK) {
            return result;
        }
        position += r.payload_size;
    }
    return RLF_OK;
}

rlf_result oni_index_read(const io_file *file, oni_index *out)
{
    memset(out, 0, sizeof(*out));
    uint32_t header_size = 0;
    rlf_result result = read_file_header(file, &header_size);
    result = result == RLF_OK ? walk(file, header_size, out) : result;
    if (result == RLF_OK) {
        sort_by_time(&out->depth, file->path);
        sort_by_time(&out->color, file->path);
    }
    return result;
}

void oni_index_free(oni_index *index)
{
    io_shots_free(&index->depth.pictures);
    io_shots_free(&index->color.pictures);
    memset(index, 0, sizeof(*index));
}
