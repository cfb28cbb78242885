/* glTF and OBJ: any bytes give a model that is sane, or an error line. */
#include "fuzz.h"

#include "io/model/model.h"
#include "model_file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static const char obj[] = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nvt 0 0\n"
                          "vt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4//1\nf -1 -2 -3\n"
                          "g b\no c\nusemtl b\nl 1 2\np 3\ns 1\nf 1 2 3 4 \\\n 3 2\n";

/* A 2 x 1 PNG, as an embedded picture. */
static const char picture[] =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAEElEQVR4nGP4z8DAwPAfAAcAAf8"
    "q8m2kAAAAAElFTkSuQmCC";

typedef struct text {
    char *to;
    size_t size, capacity;
} text;

static void put(text *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(t->to + t->size, t->capacity - t->size, format, arguments);
    va_end(arguments);
    t->size += length > 0 && (size_t)length < t->capacity - t->size ? (size_t)length : 0;
}

/* All that one primitive may have: morph targets, bones, keys, a sparse accessor, a picture. */
static void put_rich(text *t)
{
    put(t,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":["
        "{\"mesh\":0,\"skin\":0,\"children\":[1,2],\"scale\":[1,2,3],\"weights\":[0.5]},"
        "{\"camera\":0,\"rotation\":[0,0,0,1]},{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,"
        "0,0,1]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}"
        "],\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":4}],\"animations\":[{\"channels\":"
        "[{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}}],\"samplers\":[{"
        "\"input\":3,\"output\":0}]}],");
    put(t,
        "\"meshes\":[{\"weights\":[1],\"primitives\":[{\"material\":0,\"mode\":4,\"indices\":2,"
        "\"attributes\":{\"POSITION\":0,\"NORMAL\":0,\"TEXCOORD_0\":1,\"JOINTS_0\":5,"
        "\"WEIGHTS_0\":6},\"targets\":[{\"POSITION\":0}]},{\"mode\":5,\"attributes\":{"
        "\"POSITION\":0}}]}],\"materials\":[{\"doubleSided\":true,\"pbrMetallicRoughness\":{"
        "\"baseColorTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"offset\":["
        "0,1],\"scale\":[2,2]}}}}}],\"textures\":[{\"source\":0,\"sampler\":0}],\"samplers\":[{"
        "\"wrapS\":10497}],\"images\":[{\"uri\":\"data:image/png;base64,%s\"}],",
        picture);
    put(t,
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},{"
        "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"},{\"bufferView\":0,"
        "\"byteOffset\":36,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"},{\"bufferView\":"
        "0,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\"},{\"bufferView\":1,"
        "\"componentType\":5126,\"count\":2,\"type\":\"MAT4\"},{\"bufferView\":1,\"componentType\":"
        "5121,\"count\":3,\"type\":\"VEC4\"},{\"bufferView\":1,\"componentType\":5126,\"count\":3,"
        "\"type\":\"VEC4\",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"byteOffset\":36,"
        "\"componentType\":5123},\"values\":{\"bufferView\":0}}}],\"bufferViews\":[{\"buffer\":0,"
        "\"byteLength\":42},{\"buffer\":0,\"byteLength\":128,\"byteStride\":16}],\"buffers\":[{"
        "\"byteLength\":128,\"uri\":\"data:application/octet-stream;base64,");
    for (int i = 0; i < 171; i++) {
        put(t, "%c", i % 5 == 0 ? '/' : 'A');
    }
    put(t, "=\"}]}");
}

/* Nodes in a chain that is as deep as may be, and the box at its end. */
static void put_deep(text *t, const char *box)
{
    const char *nodes = strstr(box, "\"nodes\":[{\"mesh\"");
    put(t, "%.*s\"nodes\":[", (int)(nodes - box), box);
    for (int i = 1; i < IO_MODEL_DEPTH_MAX; i++) {
        put(t, "{\"children\":[%d],\"translation\":[0,0,1]},", i);
    }
    put(t, "%s", nodes + strlen("\"nodes\":["));
}

/* A binary file of one chunk of JSON, and one of bytes. */
static void put_glb(text *t, const char *json, size_t length)
{
    static const char head[20] = "glTF\2\0\0\0    ____JSON";
    memcpy(t->to, head, sizeof(head));
    memset(t->to + sizeof(head), ' ', (length + 3) / 4 * 4);
    memcpy(t->to + sizeof(head), json, length);
    t->size = sizeof(head) + (length + 3) / 4 * 4;
    memcpy(t->to + t->size, "\20\0\0\0BIN\0", 8);
    memset(t->to + t->size + 8, 0x3f, 16);
    t->size += 24;
}

/* The first byte of a seed tells the format; the rest is the file. */
size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    static const io_model_format formats[7] = {IO_MODEL_GLTF, IO_MODEL_GLTF, IO_MODEL_GLTF,
                                               IO_MODEL_GLTF, IO_MODEL_GLB,  IO_MODEL_GLB,
                                               IO_MODEL_OBJ};
    static model_text box;
    static char json[1 << 16];
    text rich = {.to = json, .capacity = sizeof(json)};
    text t = {.to = (char *)out + 1, .capacity = capacity - 1};
    if (index > 6 || capacity < (1 << 17)) {
        return 0;
    }
    out[0] = (uint8_t)formats[index];
    model_write(&box, index == 1 ? &model_textured : &model_plain);
    put_rich(&rich);
    switch (index) {
    case 2: put_rich(&t); break;
    case 3: put_deep(&t, box.text); break;
    case 4: put_glb(&t, box.text, box.length); break;
    case 5: put_glb(&t, rich.to, rich.size); break;
    case 6: put(&t, "%s", obj); break;
    default: put(&t, "%s", box.text); break;
    }
    return 1 + t.size;
}

/* Lengths that fit what a mutation left, so that it is not found at the first look. */
static void mend_lengths(uint8_t *data, size_t size)
{
    if (size < 24 || memcmp(data, "glTF", 4) != 0) {
        return;
    }
    const uint32_t whole = (uint32_t)size;
    memcpy(data + 8, &whole, 4);
    for (size_t i = size - 4; i > 20; i--) {
        if (memcmp(data + i, "BIN", 4) == 0) {
            const uint32_t json = (uint32_t)(i - 24);
            const uint32_t rest = (uint32_t)(size - i - 4);
            memcpy(data + 12, &json, 4);
            memcpy(data + i - 4, &rest, 4);
            return;
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[4] = {"fuzz.obj", "fuzz.obj", "fuzz.gltf", "fuzz.glb"};
    rlf_model *model = NULL;
    uint8_t *copy = size >= 2 ? malloc(size - 1) : NULL;
    if (copy == NULL) {
        return 0;
    }
    memcpy(copy, data + 1, size - 1);
    mend_lengths(copy, size - 1);
    const io_bytes file = {names[data[0] % 4], copy, size - 1};
    rlf_set_log(NULL, NULL);
    if (io_model_import(&file, io_model_format_of(file.name), true, &model) == RLF_OK) {
        for (int32_t i = 0; i < 3 * model->triangle_count; i++) {
            const int32_t corner = model->triangles[i];
            if (corner < 0 || corner >= model->vertex_count || !(model->radius < 1e8)) {
                abort();
            }
        }
        rlf_model_destroy(&model);
    }
    free(copy);
    return 0;
}
