/* Matroska: one walk through a file. */
#include "io/formats/matroska.h"

#include <string.h>

/* ---- elements of EBML (RFC 8794), of which Matroska (RFC 9559) files are made --------------- */

/* Longest header of an element: id and size. */
#define EBML_HEADER_MAX 12

typedef struct ebml_element {
    uint32_t id;
    int32_t header_size; /* bytes in front of the data */
    int64_t size;        /* of the data; -1 = not known: up to the next element of its level */
} ebml_element;

/* Variable-length number, without its marker; returns its length, 0 when it is none. */
static int32_t ebml_number(const uint8_t *data, size_t size, uint64_t *out, bool *out_is_unknown)
{
    int32_t length = 1;
    while (length <= 8 && size > 0 && (data[0] & (0x100u >> length)) == 0) {
        length++;
    }
    if (length > 8 || (size_t)length > size) {
        return 0;
    }
    uint64_t value = data[0] & ((0x100u >> length) - 1);
    for (int32_t i = 1; i < length; i++) {
        value = value << 8 | data[i];
    }
    *out = value;
    *out_is_unknown = value == (UINT64_C(1) << (7 * length)) - 1;
    return length;
}

/* Unsigned integer, most significant byte first. */
static uint64_t ebml_unsigned(const uint8_t *data, size_t size)
{
    uint64_t value = 0;
    for (size_t i = 0; i < size && i < 8; i++) {
        value = value << 8 | data[i];
    }
    return value;
}

/* Reads the header of an element; false when the bytes are none. */
static bool ebml_read(const uint8_t *data, size_t size, ebml_element *out)
{
    uint64_t value = 0;
    bool is_unknown = false;
    const int32_t id_length = ebml_number(data, size, &value, &is_unknown);
    if (id_length < 1 || id_length > 4) {
        return false;
    }
    /* An id keeps its marker. */
    out->id = (uint32_t)ebml_unsigned(data, (size_t)id_length);
    const int32_t length =
        ebml_number(data + id_length, size - (size_t)id_length, &value, &is_unknown);
    out->header_size = id_length + length;
    out->size = is_unknown ? -1 : (int64_t)value;
    return length > 0;
}

/* ---- the walk ------------------------------------------------------------------------------ */

#define SMALL_MAX 256 /* bytes of an element that is read whole */

/* Ids are unique at all levels, so one walk that goes into the elements that hold others sees each
 * of them, whatever their sizes say. */
enum {
    ID_EBML = 0x1A45DFA3,
    ID_SEGMENT = 0x18538067,
    ID_INFO = 0x1549A966,
    ID_TIME_SCALE = 0x2AD7B1,
    ID_TRACKS = 0x1654AE6B,
    ID_TRACK = 0xAE,
    ID_TRACK_NUMBER = 0xD7,
    ID_TRACK_NAME = 0x536E,
    ID_CODEC = 0x86,
    ID_CODEC_PRIVATE = 0x63A2,
    ID_VIDEO = 0xE0,
    ID_WIDTH = 0xB0,
    ID_HEIGHT = 0xBA,
    ID_FOURCC = 0x2EB524,
    ID_ATTACHMENTS = 0x1941A469,
    ID_ATTACHED = 0x61A7,
    ID_FILE_NAME = 0x466E,
    ID_FILE_DATA = 0x465C,
    ID_TAGS = 0x1254C367,
    ID_TAG = 0x7373,
    ID_SIMPLE_TAG = 0x67C8,
    ID_TAG_NAME = 0x45A3,
    ID_TAG_STRING = 0x4487,
    ID_CLUSTER = 0x1F43B675,
    ID_CLUSTER_TIME = 0xE7,
    ID_BLOCK_GROUP = 0xA0,
    ID_BLOCK = 0xA1,
    ID_SIMPLE_BLOCK = 0xA3
};

typedef struct walk {
    mkv_file *file;
    mkv_track *track; /* the one being described; NULL = none, or one too many */
    int64_t scale_ns, cluster_time;
    char file_name[64]; /* of the attached file being described */
    int64_t data_position, data_size;
    char tag_name[40];
} walk;

static bool is_container(uint32_t id)
{
    static const uint32_t ids[] = {ID_SEGMENT, ID_INFO,        ID_TRACKS,   ID_TRACK,
                                   ID_VIDEO,   ID_ATTACHMENTS, ID_ATTACHED, ID_TAGS,
                                   ID_TAG,     ID_SIMPLE_TAG,  ID_CLUSTER,  ID_BLOCK_GROUP};
    for (size_t i = 0; i < sizeof(ids) / sizeof(ids[0]); i++) {
        if (ids[i] == id) {
            return true;
        }
    }
    return false;
}

static void enter(walk *w, uint32_t id)
{
    mkv_file *f = w->file;
    w->track = id == ID_VIDEO ? w->track : NULL;
    if (id == ID_TRACK) {
        w->track = f->track_count < MKV_TRACKS_MAX ? &f->tracks[f->track_count++] : NULL;
    } else if (id == ID_ATTACHED) {
        w->file_name[0] = '\0';
        w->data_size = 0;
    } else if (id == ID_SIMPLE_TAG) {
        w->tag_name[0] = '\0';
    } else if (id == ID_CLUSTER) {
        w->cluster_time = 0;
    }
}

static void set_text(char *out, size_t capacity, const uint8_t *data, size_t size)
{
    const size_t length = size < capacity ? size : capacity - 1;
    memcpy(out, data, length);
    out[length] = '\0';
}

static void set_fourcc(mkv_track *track, const uint8_t *data, size_t size)
{
    if (size >= 4) {
        set_text(track->fourcc, sizeof(track->fourcc), data, 4);
    }
}

/* Sizes that do not fit any picture are left at 0 and refused later. */
static int64_t size_of(uint64_t value)
{
    return value < INT32_MAX ? (int64_t)value : 0;
}

static void describe_track(mkv_track *track, uint32_t id, const uint8_t *data, size_t size)
{
    switch (id) {
    case ID_TRACK_NUMBER: track->number = ebml_unsigned(data, size); break;
    case ID_TRACK_NAME: set_text(track->name, sizeof(track->name), data, size); break;
    case ID_CODEC: set_text(track->codec, sizeof(track->codec), data, size); break;
    case ID_WIDTH: track->width = size_of(ebml_unsigned(data, size)); break;
    case ID_HEIGHT: track->height = size_of(ebml_unsigned(data, size)); break;
    case ID_FOURCC: set_fourcc(track, data, size); break;
    case ID_CODEC_PRIVATE:
        /* A BITMAPINFOHEADER: the four letters come after 16 bytes of sizes. */
        if (strcmp(track->codec, "V_MS/VFW/FOURCC") == 0 && size >= 20) {
            set_fourcc(track, data + 16, 4);
        }
        break;
    default: break;
    }
}

static void add_tag(walk *w, const uint8_t *data, size_t size)
{
    mkv_file *f = w->file;
    if (f->tag_count < MKV_TAGS_MAX) {
        mkv_tag *tag = &f->tags[f->tag_count++];
        memcpy(tag->name, w->tag_name, sizeof(tag->name));
        set_text(tag->value, sizeof(tag->value), data, size);
    }
}

/* The first attached file that ends in .json counts; its name and its bytes come in any order. */
static void take_attached(walk *w)
{
    mkv_file *f = w->file;
    const size_t length = strlen(w->file_name);
    if (f->attached_name[0] == '\0' && w->data_size > 0 && length > 5 &&
        strcmp(w->file_name + length - 5, ".json") == 0) {
        memcpy(f->attached_name, w->file_name, sizeof(f->attached_name));
        f->attached_position = w->data_position;
        f->attached_size = w->data_size;
    }
}

static void take_small(walk *w, uint32_t id, const uint8_t *data, size_t size)
{
    if (w->track != NULL) {
        describe_track(w->track, id, data, size);
    }
    const uint64_t number = ebml_unsigned(data, size);
    switch (id) {
    case ID_TIME_SCALE:
        w->scale_ns = number >= 1 && number <= 1000000000 ? (int64_t)number : 1;
        break;
    case ID_CLUSTER_TIME: w->cluster_time = number < INT64_MAX / 4 ? (int64_t)number : 0; break;
    case ID_FILE_NAME:
        set_text(w->file_name, sizeof(w->file_name), data, size);
        take_attached(w);
        break;
    case ID_TAG_NAME: set_text(w->tag_name, sizeof(w->tag_name), data, size); break;
    case ID_TAG_STRING: add_tag(w, data, size); break;
    default: break;
    }
}

/* Track number, two bytes of time since the cluster's, flags; then the picture. */
static rlf_result add_block(walk *w, int64_t position, int64_t size)
{
    mkv_file *f = w->file;
    uint8_t head[EBML_HEADER_MAX];
    uint64_t number = 0;
    bool is_unknown = false;
    const size_t got = io_file_read_at(&f->file, position, head, sizeof(head));
    const int32_t length = ebml_number(head, got, &number, &is_unknown);
    if (length == 0 || (size_t)length + 3 > got || size < length + 3 || size > UINT32_MAX) {
        return RLF_OK;
    }
    const bool is_laced = (head[length + 2] & 0x06) != 0;
    const int16_t since = (int16_t)(uint16_t)(head[length] << 8 | head[length + 1]);
    const int64_t ticks = w->cluster_time + since;
    if (is_laced || ticks < 0 || ticks > INT64_MAX / 4 / w->scale_ns) {
        return RLF_OK;
    }
    for (int32_t i = 0; i < f->track_count; i++) {
        if (f->tracks[i].number == number && f->tracks[i].codec[0] == 'V') {
            const io_shot shot = {ticks * w->scale_ns, position + length + 3,
                                  (uint32_t)(size - length - 3)};
            return io_shots_add(&f->tracks[i].pictures, f->file.path, shot);
        }
    }
    return RLF_OK;
}

static rlf_result take(walk *w, const ebml_element *e, int64_t position)
{
    if (e->id == ID_BLOCK || e->id == ID_SIMPLE_BLOCK) {
        return add_block(w, position, e->size);
    }
    if (e->id == ID_FILE_DATA) {
        w->data_position = position;
        w->data_size = e->size;
        take_attached(w);
        return RLF_OK;
    }
    uint8_t data[SMALL_MAX];
    const size_t wanted = e->size < SMALL_MAX ? (size_t)e->size : SMALL_MAX;
    take_small(w, e->id, data, io_file_read_at(&w->file->file, position, data, wanted));
    return RLF_OK;
}

static rlf_result look_through(walk *w)
{
    mkv_file *f = w->file;
    rlf_result result = RLF_OK;
    int64_t position = 0;
    while (result == RLF_OK && position < f->file.size) {
        uint8_t head[EBML_HEADER_MAX];
        ebml_element e;
        const size_t got = io_file_read_at(&f->file, position, head, sizeof(head));
        const bool is_read = ebml_read(head, got, &e);
        const bool is_master = is_read && is_container(e.id);
        const int64_t data = position + (is_read ? e.header_size : 0);
        if (!is_read || (!is_master && (e.size < 0 || e.size > f->file.size - data))) {
            rlf_log(RLF_LOG_WARNING,
                    "%s: is damaged or cut short at byte %lld of %lld: what is before is read",
                    f->file.path, (long long)position, (long long)f->file.size);
            break;
        }
        if (is_master) {
            enter(w, e.id);
            position = data;
            continue;
        }
        result = take(w, &e, data);
        position = data + e.size;
    }
    return result;
}

static rlf_result check_head(const mkv_file *self)
{
    uint8_t head[EBML_HEADER_MAX];
    ebml_element e;
    const size_t got = io_file_read_at(&self->file, 0, head, sizeof(head));
    if (!ebml_read(head, got, &e) || e.id != ID_EBML) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is no Matroska file: give the right file",
                        self->file.path);
    }
    return RLF_OK;
}

rlf_result mkv_file_open(const char *path, mkv_file *out)
{
    memset(out, 0, sizeof(*out));
    walk w = {.file = out, .scale_ns = 1000000};
    rlf_result result = io_file_open(&out->file, path, "check the name");
    result = result == RLF_OK ? check_head(out) : result;
    result = result == RLF_OK ? look_through(&w) : result;
    if (result != RLF_OK) {
        mkv_file_close(out);
    }
    return result;
}

void mkv_file_close(mkv_file *self)
{
    io_file_close(&self->file);
    for (int32_t i = 0; i < self->track_count; i++) {
        io_shots_free(&self->tracks[i].pictures);
    }
}

const char *mkv_file_tag(const mkv_file *self, const char *name)
{
    for (int32_t i = 0; i < self->tag_count; i++) {
        if (strcmp(self->tags[i].name, name) == 0) {
            return self->tags[i].value;
        }
    }
    return NULL;
}
