/* What the two steps of reading glTF share: its JSON, and the bytes that it names. */
#ifndef RLF_IO_MODEL_GLTF_H
#define RLF_IO_MODEL_GLTF_H

#include "io/json.h"
#include "io/model/model.h"

typedef struct gltf {
    io_model_draft *draft;
    json_t *top;
    io_bytes binary;    /* of a .glb; size 0 = none */
    io_buffer *storage; /* of the buffers that are not the binary one */
    io_bytes *buffers;
    int32_t buffer_count;
} gltf;

/* Numbers of one kind: `count` elements of `width` each. */
typedef struct gltf_accessor {
    const uint8_t *data;
    size_t stride, component_size;
    int32_t count, width, component;
    bool is_normalized;
} gltf_accessor;

/* The member `key` of the list `list` at the top that `object` names by its index; NULL = none. */
json_t *gltf_named(const gltf *g, const json_t *object, const char *key, const char *list);
/* A whole number of 0 .. 2^31 - 1, or what it is when it is not there; -1 = it is something else.
 */
int64_t gltf_whole(const json_t *object, const char *key, int64_t otherwise);
rlf_result gltf_fail(const gltf *g, const char *problem);

/* Finds the text in the file and parses it; then opens its buffers. */
rlf_result gltf_open(gltf *g, const io_bytes *file);
void gltf_close(gltf *g);

/* The bytes of a bufferView. */
rlf_result gltf_view(const gltf *g, const json_t *view, io_bytes *out);
/* The bytes of a "data:" address into the buffer. */
rlf_result gltf_data(const gltf *g, const char *uri, io_buffer *buffer, io_bytes *out);

/* `type` is "SCALAR", "VEC2", "VEC3". */
rlf_result gltf_access(const gltf *g, const json_t *accessor, const char *type, gltf_accessor *out);
void gltf_get(const gltf_accessor *a, int32_t index, double *out);

#endif
