/* Small glTF files made by tests: one quad or box, with what a test wants to be wrong about it. */
#ifndef RLF_TEST_MODEL_FILE_H
#define RLF_TEST_MODEL_FILE_H

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define MODEL_TEXT_MAX 16384

typedef struct model_text {
    char text[MODEL_TEXT_MAX];
    size_t length;
} model_text;

static inline void model_base64(model_text *out, const void *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *p = data;
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = (uint32_t)p[i] << 16;
        bits |= i + 1 < size ? (uint32_t)p[i + 1] << 8 : 0;
        bits |= i + 2 < size ? p[i + 2] : 0;
        for (int k = 0; k < 4; k++) {
            bool is_there = i + (size_t)k <= size;
            out->text[out->length++] = is_there ? digits[bits >> (18 - 6 * k) & 63] : '=';
        }
    }
    out->text[out->length] = '\0';
}

/* What the file holds: a box of 1 x 2 x 3 about (0, 0, 1.5), its triangles outwards, uv (x, y). */
typedef struct model_options {
    const char *material; /* JSON of the only material */
    const char *images;   /* JSON members "images" and "textures", with a comma behind; or "" */
    const char *node;     /* JSON members of the node behind "mesh":0, with a comma before */
    int mode;             /* 4 = triangles, 0 = points */
    float first_x;        /* replaces the first vertex's x unless 0 */
} model_options;

static const float model_corners[8][3] = {{-0.5f, -1, 0}, {0.5f, -1, 0},  {0.5f, 1, 0},
                                          {-0.5f, 1, 0},  {-0.5f, -1, 3}, {0.5f, -1, 3},
                                          {0.5f, 1, 3},   {-0.5f, 1, 3}};
static const uint16_t model_faces[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                         1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};

static inline void model_write(model_text *out, const model_options *o)
{
    struct {
        float position[8][3];
        float uv[8][2];
        uint16_t index[36];
    } data;
    memcpy(data.position, model_corners, sizeof(data.position));
    memcpy(data.index, model_faces, sizeof(data.index));
    if (o->first_x != 0.0f) {
        data.position[0][0] = o->first_x;
    }
    for (int i = 0; i < 8; i++) {
        data.uv[i][0] = model_corners[i][0] + 0.5f;
        data.uv[i][1] = 0.5f * model_corners[i][1] + 0.5f;
    }
    out->length = (size_t)snprintf(
        out->text, MODEL_TEXT_MAX,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
        "\"nodes\":[{\"mesh\":0%s}],\"meshes\":[{\"primitives\":[{\"mode\":%d,\"indices\":2,"
        "\"material\":0,\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1}}]}],"
        "\"materials\":[%s],%s"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":8,\"type\":\"VEC3\","
        "\"min\":[-0.5,-1,0],\"max\":[0.5,1,3]},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":8,\"type\":\"VEC2\"},"
        "{\"bufferView\":2,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":96},"
        "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":64},"
        "{\"buffer\":0,\"byteOffset\":160,\"byteLength\":72}],"
        "\"buffers\":[{\"byteLength\":232,\"uri\":\"data:application/octet-stream;base64,",
        o->node, o->mode, o->material, o->images);
    model_base64(out, &data, 232);
    out->length +=
        (size_t)snprintf(out->text + out->length, MODEL_TEXT_MAX - out->length, "\"}]}\n");
}

static const model_options model_plain = {"{}", "", "", 4, 0.0f};
static const model_options model_textured = {
    "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
    "\"baseColorFactor\":[1,0.5,0,1]}}",
    "\"images\":[{\"uri\":\"paint.png\"}],\"textures\":[{\"source\":0}],", "", 4, 0.0f};

#endif
