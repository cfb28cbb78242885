/* Looks through a glTF before assimp does, which takes memory and stack without a limit: a few
 * bytes must not ask for more than a model that can be drawn needs. Assimp is then given only what
 * is drawn: its readers of bones, keys, morph targets and cameras crash on damaged files. */
#include "io/model/import.h"
#include "io/json.h"

#include <string.h>

#define NESTING_MAX 128
#define VALUES_MAX (1 << 20)
#define ENTRIES_MAX 65536 /* of a list at the top: nodes, meshes, accessors, ... */
#define ELEMENTS_MAX                                                                               \
    ((int64_t)16 * RLF_MODEL_VERTICES_MAX) /* positions, normals, corners, keys                    \
                                            */

#define GLB_HEAD 20 /* "glTF", version, length; length and kind of the first chunk */

typedef struct gltf {
    const char *name;
    json_t *top;
    json_t *nodes, *meshes, *accessors, *views;
    int64_t elements, image_bytes;
} gltf;

/* ---- the text --------------------------------------------------------------------------------
 */

/* Depth and number of values, without a stack: a parser that calls itself has none that is deep
 * enough. */
static rlf_result check_text(const io_bytes *text)
{
    int64_t values = 0;
    int32_t depth = 0;
    bool is_in_string = false;
    for (size_t i = 0; i < text->size; i++) {
        const uint8_t c = text->data[i];
        if (is_in_string) {
            i += c == '\\' ? 1 : 0;
            is_in_string = c != '"';
            continue;
        }
        is_in_string = c == '"';
        depth += c == '[' || c == '{' ? 1 : (c == ']' || c == '}' ? -1 : 0);
        values += c == '[' || c == '{' || c == ',' ? 1 : 0;
        if (depth > NESTING_MAX || values > VALUES_MAX) {
            return rlf_fail(RLF_ERROR_FORMAT, "%s: %s more than %d: export it again as glTF 2.0",
                            text->name,
                            depth > NESTING_MAX ? "its JSON is nested deeper than can be read,"
                                                : "its JSON has too many values,",
                            depth > NESTING_MAX ? NESTING_MAX : VALUES_MAX);
        }
    }
    return RLF_OK;
}

/* The JSON of either kind of file. */
static rlf_result find_text(const io_bytes *file, io_bytes *out)
{
    *out = *file;
    if (file->size < 4 || memcmp(file->data, "glTF", 4) != 0) {
        return RLF_OK;
    }
    uint32_t head[5];
    memcpy(head, file->data, file->size < GLB_HEAD ? file->size : GLB_HEAD);
    if (file->size < GLB_HEAD || head[1] != 2 || head[3] > file->size - GLB_HEAD ||
        memcmp(&head[4], "JSON", 4) != 0) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: cannot be read as a model (no binary glTF 2.0, or cut short): export "
                        "it again as glTF 2.0",
                        file->name);
    }
    out->data = file->data + GLB_HEAD;
    out->size = head[3];
    return RLF_OK;
}

static rlf_result parse(const io_bytes *text, json_t **out)
{
    json_error_t error;
    size_t size = text->size;
    while (size > 0 && text->data[size - 1] == '\0') { /* padding */
        size--;
    }
    /* Of a key that is there twice the other one might be read. */
    *out =
        json_loadb((const char *)text->data, size, JSON_REJECT_DUPLICATES | JSON_ALLOW_NUL, &error);
    if (*out == NULL) {
        const bool lacks_memory = json_error_code(&error) == json_error_out_of_memory;
        return rlf_fail(lacks_memory ? RLF_ERROR_MEMORY : RLF_ERROR_FORMAT,
                        "%s:%d:%d: cannot be read as a model (%s): export it again as glTF 2.0",
                        text->name, error.line, error.column, error.text);
    }
    const char *version =
        json_string_value(json_object_get(json_object_get(*out, "asset"), "version"));
    if (version == NULL || version[0] != '2') {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: cannot be read as a model (asset.version is %.20s): export it again "
                        "as glTF 2.0",
                        text->name, version != NULL ? version : "missing");
    }
    return RLF_OK;
}

/* ---- what is drawn ----------------------------------------------------------------------------
 */

static void keep(json_t *object, const char *const *keys)
{
    const char *key;
    json_t *value;
    void *next;
    json_object_foreach_safe(object, next, key, value)
    {
        int i = 0;
        while (keys[i] != NULL && strcmp(key, keys[i]) != 0) {
            i++;
        }
        if (keys[i] == NULL) {
            json_object_del(object, key);
        }
    }
}

static void keep_drawn(json_t *top)
{
    static const char *const tops[] = {
        "asset",  "scene",    "scenes",    "nodes",       "meshes",  "materials",      "textures",
        "images", "samplers", "accessors", "bufferViews", "buffers", "extensionsUsed", NULL};
    static const char *const nodes[] = {"mesh",     "children", "matrix", "translation",
                                        "rotation", "scale",    NULL};
    static const char *const meshes[] = {"primitives", NULL};
    static const char *const primitives[] = {"attributes", "indices",    "material",
                                             "mode",       "extensions", NULL};
    static const char *const packings[] = {"KHR_draco_mesh_compression", NULL};
    static const char *const attributes[] = {"POSITION", "NORMAL", "TEXCOORD_0", NULL};
    size_t i, k;
    json_t *node, *mesh, *primitive;
    keep(top, tops);
    json_array_foreach(json_object_get(top, "nodes"), i, node)
    {
        keep(node, nodes);
    }
    json_array_foreach(json_object_get(top, "meshes"), i, mesh)
    {
        keep(mesh, meshes);
        json_array_foreach(json_object_get(mesh, "primitives"), k, primitive)
        {
            keep(primitive, primitives);
            json_t *extensions = json_object_get(primitive, "extensions");
            json_t *packed = json_object_get(extensions, packings[0]);
            keep(extensions, packings);
            keep(json_object_get(packed, "attributes"), attributes);
            keep(json_object_get(primitive, "attributes"), attributes);
        }
    }
}

/* The file again, with the JSON that is left; `text` was its JSON. */
static rlf_result write_reduced(const io_bytes *file, const io_bytes *text, const json_t *top,
                                io_buffer *buffer, io_bytes *out)
{
    const size_t flags = JSON_COMPACT | JSON_REAL_PRECISION(17);
    const size_t head = (size_t)(text->data - file->data);
    const size_t rest = file->size - head - text->size;
    const size_t size = json_dumpb(top, NULL, 0, flags);
    const size_t padded = (size + 3) / 4 * 4;
    if (size == 0 || io_buffer_reserve(buffer, head + padded + rest) != RLF_OK) {
        return RLF_ERROR_MEMORY;
    }
    uint8_t *to = buffer->data;
    memcpy(to, file->data, head);
    memset(to + head, ' ', padded);
    (void)json_dumpb(top, (char *)to + head, size, flags);
    memcpy(to + head + padded, text->data + text->size, rest);
    *out = (io_bytes){file->name, to, head + padded + rest};
    if (head == GLB_HEAD) {
        const uint32_t lengths[2] = {(uint32_t)out->size, (uint32_t)padded};
        memcpy(to + 8, &lengths[0], 4);
        memcpy(to + 12, &lengths[1], 4);
    }
    return RLF_OK;
}

/* ---- nodes -----------------------------------------------------------------------------------
 */

/* What is no index has -1, as has one outside the list. */
static int64_t index_in(const json_t *value, const json_t *list)
{
    const int64_t index = json_is_integer(value) ? (int64_t)json_integer_value(value) : -1;
    return index >= 0 && index < (int64_t)json_array_size(list) ? index : -1;
}

static rlf_result fail_child(const gltf *g, int64_t node, const char *problem)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s: nodes[%lld] %s: export it again as glTF 2.0", g->name,
                    (long long)node, problem);
}

/* Each node has one parent: what is there twice would be read twice, and its children four times.
 */
static rlf_result note_children(const gltf *g, const json_t *children, int32_t parent,
                                int32_t *parents)
{
    for (size_t k = 0; k < json_array_size(children); k++) {
        const int64_t child = index_in(json_array_get(children, k), g->nodes);
        if (child < 0) {
            return fail_child(g, parent, "names a child that is not there");
        }
        if (parents[child] != -1) {
            return fail_child(g, child, "has more than one parent");
        }
        parents[child] = parent;
    }
    return RLF_OK;
}

static rlf_result check_depth(const gltf *g, int32_t count, const int32_t *parents)
{
    for (int32_t i = 0; i < count; i++) {
        int depth = 0;
        for (int32_t at = i; at >= 0; at = parents[at]) {
            if (++depth > IO_MODEL_DEPTH_MAX) {
                return rlf_fail(RLF_ERROR_FORMAT, "%s: its parts are nested more than %d deep",
                                g->name, IO_MODEL_DEPTH_MAX);
            }
        }
    }
    return RLF_OK;
}

/* A scene begins at nodes that nobody has as a child, each once. `marks` is zeroed. */
static rlf_result check_roots(const gltf *g, const int32_t *parents, int32_t *marks)
{
    const json_t *scenes = json_object_get(g->top, "scenes");
    for (size_t s = 0; s < json_array_size(scenes); s++) {
        const json_t *roots = json_object_get(json_array_get(scenes, s), "nodes");
        for (size_t k = 0; k < json_array_size(roots); k++) {
            const int64_t root = index_in(json_array_get(roots, k), g->nodes);
            if (root < 0) {
                continue;
            }
            if (parents[root] != -1 || marks[root] == (int32_t)s + 1) {
                return fail_child(g, root, "is in a scene more than once");
            }
            marks[root] = (int32_t)s + 1;
        }
    }
    return RLF_OK;
}

static rlf_result check_nodes(const gltf *g)
{
    const int32_t count = (int32_t)json_array_size(g->nodes);
    int32_t *parents = rlf_alloc_array(2 * (size_t)count + 1, sizeof(*parents));
    if (parents == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < count; i++) {
        parents[i] = -1;
    }
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        result = note_children(g, json_object_get(json_array_get(g->nodes, (size_t)i), "children"),
                               i, parents);
    }
    if (result == RLF_OK) {
        result = check_depth(g, count, parents);
    }
    if (result == RLF_OK) {
        result = check_roots(g, parents, parents + count);
    }
    rlf_free(parents);
    return result;
}

/* ---- what is copied once for every time it is named -------------------------------------------
 */

static void add_accessor(gltf *g, const json_t *value)
{
    const int64_t index = index_in(value, g->accessors);
    const json_t *accessor = index >= 0 ? json_array_get(g->accessors, (size_t)index) : NULL;
    const json_t *number = json_object_get(accessor, "count");
    const int64_t count = json_is_integer(number) ? (int64_t)json_integer_value(number) : 0;
    const bool is_sane = count >= 0 && count <= ELEMENTS_MAX;
    g->elements += index < 0 ? 0 : (is_sane ? count : ELEMENTS_MAX + 1);
}

static void add_members(gltf *g, json_t *object)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        add_accessor(g, value);
    }
}

static void add_meshes(gltf *g)
{
    for (size_t m = 0; m < json_array_size(g->meshes); m++) {
        const json_t *primitives = json_object_get(json_array_get(g->meshes, m), "primitives");
        for (size_t p = 0; p < json_array_size(primitives); p++) {
            const json_t *primitive = json_array_get(primitives, p);
            add_members(g, json_object_get(primitive, "attributes"));
            add_accessor(g, json_object_get(primitive, "indices"));
        }
    }
}

static void add_images(gltf *g)
{
    const json_t *images = json_object_get(g->top, "images");
    for (size_t i = 0; i < json_array_size(images); i++) {
        const json_t *view = json_object_get(json_array_get(images, i), "bufferView");
        const int64_t index = index_in(view, g->views);
        const json_t *object = index >= 0 ? json_array_get(g->views, (size_t)index) : NULL;
        const json_t *length = json_object_get(object, "byteLength");
        const int64_t bytes = json_is_integer(length) ? (int64_t)json_integer_value(length) : 0;
        const int64_t most = (int64_t)IO_MODEL_FILE_MAX;
        g->image_bytes += bytes >= 0 && bytes <= most ? bytes : most + 1;
    }
}

/* ---- all of it -------------------------------------------------------------------------------
 */

static rlf_result check_lists(const gltf *g)
{
    const char *key;
    json_t *list;
    json_object_foreach(g->top, key, list)
    {
        const bool is_materials = strcmp(key, "materials") == 0;
        const size_t most = is_materials ? RLF_MODEL_PARTS_MAX : ENTRIES_MAX;
        if (json_array_size(list) > most) {
            return rlf_fail(RLF_ERROR_FORMAT, "%s: has %zu %.40s, at most %zu: join some", g->name,
                            json_array_size(list), key, most);
        }
    }
    return RLF_OK;
}

static rlf_result check_budget(gltf *g)
{
    add_meshes(g);
    add_images(g);
    if (g->elements > ELEMENTS_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: its meshes name %lld vertices and corners in all, at most %lld "
                        "are read: simplify it",
                        g->name, (long long)g->elements, (long long)ELEMENTS_MAX);
    }
    if (g->image_bytes > (int64_t)IO_MODEL_FILE_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: its pictures have more than %zu bytes in all: make them smaller",
                        g->name, IO_MODEL_FILE_MAX);
    }
    return RLF_OK;
}

static rlf_result check_parts(gltf *g)
{
    g->nodes = json_object_get(g->top, "nodes");
    g->meshes = json_object_get(g->top, "meshes");
    g->accessors = json_object_get(g->top, "accessors");
    g->views = json_object_get(g->top, "bufferViews");
    rlf_result result = check_lists(g);
    if (result == RLF_OK) {
        result = check_nodes(g);
    }
    return result == RLF_OK ? check_budget(g) : result;
}

rlf_result io_model_reduce_gltf(const io_bytes *file, io_buffer *buffer, io_bytes *out)
{
    io_bytes text;
    gltf g = {.name = file->name};
    rlf_result result = find_text(file, &text);
    if (result == RLF_OK) {
        result = check_text(&text);
    }
    if (result == RLF_OK) {
        result = parse(&text, &g.top);
    }
    if (result == RLF_OK) {
        keep_drawn(g.top);
        result = check_parts(&g);
    }
    if (result == RLF_OK) {
        result = write_reduced(file, &text, g.top, buffer, out);
    }
    json_decref(g.top);
    return result;
}
