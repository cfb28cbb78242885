/* The text of a glTF, and the numbers in its buffers. */
#include "io/model/gltf.h"
#include "io/little.h"

#include <string.h>

#define VALUES_MAX (1 << 20)
#define HEAD 20 /* of .glb: "glTF", version, length; length and kind of the first chunk */

rlf_result gltf_fail(const gltf *g, const char *problem)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: cannot be read as a model (%s): export it again as glTF 2.0",
                    g->draft->name, problem);
}

/* ---- the text ------------------------------------------------------------------------------- */

/* Jansson bounds the depth; so many values would take a hundred times their file. */
static rlf_result check_values(const gltf *g, const io_bytes *text)
{
    int64_t values = 0;
    for (size_t i = 0; i < text->size; i++) {
        values += text->data[i] == ',' || text->data[i] == '[' || text->data[i] == '{' ? 1 : 0;
    }
    return values <= VALUES_MAX ? RLF_OK : gltf_fail(g, "its JSON has too many values");
}

static uint32_t u32_at(const uint8_t *at)
{
    uint32_t value;
    io_little_read(at, &value, sizeof(value));
    return value;
}

/* The JSON of either kind of file, and the bytes behind it. */
static rlf_result find_text(gltf *g, const io_bytes *file, io_bytes *out)
{
    *out = *file;
    if (file->size < 4 || memcmp(file->data, "glTF", 4) != 0) {
        return RLF_OK;
    }
    if (file->size < HEAD || u32_at(file->data + 4) != 2 ||
        u32_at(file->data + 12) > file->size - HEAD || memcmp(file->data + 16, "JSON", 4) != 0) {
        return gltf_fail(g, "no binary glTF 2.0, or cut short");
    }
    out->data = file->data + HEAD;
    out->size = u32_at(file->data + 12);
    const size_t left = file->size - HEAD - out->size;
    const uint8_t *chunk = out->data + out->size;
    if (left >= 8 && memcmp(chunk + 4, "BIN", 4) == 0) {
        const size_t size = u32_at(chunk);
        g->binary = (io_bytes){file->name, chunk + 8, size < left - 8 ? size : left - 8};
    }
    return RLF_OK;
}

static rlf_result parse(gltf *g, const io_bytes *text)
{
    json_error_t error;
    size_t size = text->size;
    while (size > 0 && text->data[size - 1] == '\0') { /* padding */
        size--;
    }
    g->top =
        json_loadb((const char *)text->data, size, JSON_REJECT_DUPLICATES | JSON_ALLOW_NUL, &error);
    if (g->top == NULL) {
        const bool lacks_memory = json_error_code(&error) == json_error_out_of_memory;
        return rlf_fail(lacks_memory ? RLF_ERROR_MEMORY : RLF_ERROR_FORMAT,
                        "%s:%d:%d: cannot be read as a model (%s): export it again as glTF 2.0",
                        text->name, error.line, error.column, error.text);
    }
    const char *version =
        json_string_value(json_object_get(json_object_get(g->top, "asset"), "version"));
    if (version == NULL || version[0] != '2') {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: cannot be read as a model (asset.version is %.20s): export it again "
                        "as glTF 2.0",
                        text->name, version != NULL ? version : "missing");
    }
    return RLF_OK;
}

int64_t gltf_whole(const json_t *object, const char *key, int64_t otherwise)
{
    const json_t *value = json_object_get(object, key);
    if (value == NULL) {
        return otherwise;
    }
    const json_int_t number = json_integer_value(value);
    return json_is_integer(value) && number >= 0 && number <= INT32_MAX ? (int64_t)number : -1;
}

json_t *gltf_named(const gltf *g, const json_t *object, const char *key, const char *list)
{
    const int64_t index = gltf_whole(object, key, -1);
    return index >= 0 ? json_array_get(json_object_get(g->top, list), (size_t)index) : NULL;
}

/* ---- buffers -------------------------------------------------------------------------------- */

static int digit_of(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = c != '\0' ? strchr(digits, c) : NULL;
    return at != NULL ? (int)(at - digits) : -1;
}

rlf_result gltf_data(const gltf *g, const char *uri, io_buffer *buffer, io_bytes *out)
{
    static const char mark[] = ";base64,";
    const char *text = strstr(uri, mark);
    if (text == NULL) {
        return gltf_fail(g, "data that is not base64");
    }
    text += sizeof(mark) - 1;
    rlf_result result = io_buffer_reserve(buffer, strlen(text) / 4 * 3 + 3);
    if (result != RLF_OK) {
        return result;
    }
    size_t size = 0;
    uint32_t bits = 0;
    for (int count = 0; digit_of(*text) >= 0; text++) {
        bits = bits << 6 | (uint32_t)digit_of(*text);
        count += 6;
        if (count >= 8) {
            count -= 8;
            buffer->data[size++] = (uint8_t)(bits >> count);
        }
    }
    *out = (io_bytes){"embedded data", buffer->data, size};
    return *text == '\0' || *text == '=' ? RLF_OK : gltf_fail(g, "data that is not base64");
}

static rlf_result open_buffer(gltf *g, const json_t *object, int32_t index)
{
    const char *uri = json_string_value(json_object_get(object, "uri"));
    const int64_t size = gltf_whole(object, "byteLength", -1);
    io_bytes *b = &g->buffers[index];
    rlf_result result = RLF_OK;
    if (uri == NULL) {
        *b = g->binary;
    } else if (strncmp(uri, "data:", 5) == 0) {
        result = gltf_data(g, uri, &g->storage[index], b);
    } else {
        result = io_model_read_beside(g->draft, uri, &g->storage[index], b);
    }
    if (result == RLF_OK && (size < 0 || (size_t)size > b->size)) {
        result = gltf_fail(g, "a buffer has fewer bytes than it says");
    }
    return result;
}

rlf_result gltf_open(gltf *g, const io_bytes *file)
{
    io_bytes text;
    rlf_result result = find_text(g, file, &text);
    result = result == RLF_OK ? check_values(g, &text) : result;
    result = result == RLF_OK ? parse(g, &text) : result;
    if (result != RLF_OK) {
        return result;
    }
    const json_t *buffers = json_object_get(g->top, "buffers");
    const size_t count = json_array_size(buffers);
    g->storage = rlf_alloc_array(count + 1, sizeof(g->storage[0]));
    g->buffers = rlf_alloc_array(count + 1, sizeof(g->buffers[0]));
    if (g->storage == NULL || g->buffers == NULL) {
        return RLF_ERROR_MEMORY;
    }
    g->buffer_count = (int32_t)count;
    for (int32_t i = 0; i < g->buffer_count && result == RLF_OK; i++) {
        result = open_buffer(g, json_array_get(buffers, (size_t)i), i);
    }
    return result;
}

void gltf_close(gltf *g)
{
    for (int32_t i = 0; i < g->buffer_count; i++) {
        io_buffer_free(&g->storage[i]);
    }
    rlf_free(g->storage);
    rlf_free(g->buffers);
    json_decref(g->top);
}

rlf_result gltf_view(const gltf *g, const json_t *view, io_bytes *out)
{
    const int64_t index = gltf_whole(view, "buffer", -1);
    const int64_t offset = gltf_whole(view, "byteOffset", 0);
    const int64_t length = gltf_whole(view, "byteLength", -1);
    if (index < 0 || index >= g->buffer_count || offset < 0 || length < 0 ||
        (size_t)(offset + length) > g->buffers[index].size) {
        return gltf_fail(g, "a bufferView names bytes that are not there");
    }
    *out = (io_bytes){"embedded data", g->buffers[index].data + offset, (size_t)length};
    return RLF_OK;
}

/* ---- numbers -------------------------------------------------------------------------------- */

/* Bytes of a component; 0 = there is none of that kind. */
static size_t size_of(int32_t component)
{
    switch (component) {
    case 5120:
    case 5121: return 1;
    case 5122:
    case 5123: return 2;
    case 5125:
    case 5126: return 4;
    default: return 0;
    }
}

/* Where `a->count` elements of a view begin. */
static rlf_result find_elements(const gltf *g, const json_t *object, gltf_accessor *a)
{
    const json_t *view = gltf_named(g, object, "bufferView", "bufferViews");
    const int64_t offset = gltf_whole(object, "byteOffset", 0);
    const size_t size = a->component_size * (size_t)a->width;
    const int64_t stride = gltf_whole(view, "byteStride", (int64_t)size);
    io_bytes bytes;
    rlf_result result = gltf_view(g, view, &bytes);
    if (result != RLF_OK) {
        return result;
    }
    if (offset < 0 || stride < (int64_t)size || (size_t)offset > bytes.size ||
        (a->count > 0 &&
         (bytes.size - (size_t)offset < size ||
          (bytes.size - (size_t)offset - size) / (size_t)stride < (size_t)a->count - 1))) {
        return gltf_fail(g, "an accessor names bytes that are not there");
    }
    a->data = bytes.data + offset;
    a->stride = (size_t)stride;
    return RLF_OK;
}

rlf_result gltf_access(const gltf *g, const json_t *accessor, const char *type, gltf_accessor *out)
{
    const char *is = json_string_value(json_object_get(accessor, "type"));
    const int64_t count = gltf_whole(accessor, "count", -1);
    *out = (gltf_accessor){.width = strcmp(type, "SCALAR") == 0 ? 1 : type[3] - '0',
                           .component = (int32_t)gltf_whole(accessor, "componentType", 0),
                           .is_normalized = json_is_true(json_object_get(accessor, "normalized"))};
    out->component_size = size_of(out->component);
    if (is == NULL || strcmp(is, type) != 0 || count < 0 || out->component_size == 0 ||
        json_object_get(accessor, "sparse") != NULL) {
        return gltf_fail(g, "an accessor is sparse, or not of the kind that it should be");
    }
    /* Each costs at least a corner of a triangle, as it is drawn. */
    if (count > 3 * (int64_t)RLF_MODEL_VERTICES_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: a mesh has %lld vertices or corners: simplify it",
                        g->draft->name, (long long)count);
    }
    out->count = (int32_t)count;
    return find_elements(g, accessor, out);
}

/* One component as the number it means. */
static double value_of(const gltf_accessor *a, const uint8_t *at)
{
    uint16_t half;
    uint32_t word;
    float real;
    const bool is_share = a->is_normalized;
    switch (a->component) {
    case 5120: return is_share ? rlf_max((int8_t)at[0] / 127.0, -1.0) : (int8_t)at[0];
    case 5121: return is_share ? at[0] / 255.0 : at[0];
    case 5122:
        io_little_read(at, &half, sizeof(half));
        return is_share ? rlf_max((int16_t)half / 32767.0, -1.0) : (int16_t)half;
    case 5123: io_little_read(at, &half, sizeof(half)); return is_share ? half / 65535.0 : half;
    case 5125: io_little_read(at, &word, sizeof(word)); return word;
    default: io_little_read(at, &real, sizeof(real)); return (double)real;
    }
}

void gltf_get(const gltf_accessor *a, int32_t index, double *out)
{
    for (int32_t i = 0; i < a->width; i++) {
        out[i] = value_of(a, a->data + (size_t)index * a->stride + (size_t)i * a->component_size);
    }
}
