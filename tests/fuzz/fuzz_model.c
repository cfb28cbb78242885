/* glTF and OBJ: any bytes give a model that is sane, or an error line. */
#include "fuzz.h"

#include "io/model/model.h"
#include "model_file.h"

#include <stdlib.h>

static const char obj[] = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nvt 0 0\n"
                          "vt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4//1\nf -1 -2 -3\n";

static void put_word(uint8_t *out, uint32_t word)
{
    for (int i = 0; i < 4; i++) {
        out[i] = (uint8_t)(word >> (8 * i));
    }
}

/* A GLB of one chunk of JSON. */
static size_t put_glb(const model_text *text, uint8_t *out, size_t capacity)
{
    const size_t json = (text->length + 3) / 4 * 4;
    if (20 + json > capacity) {
        return 0;
    }
    memset(out, ' ', 20 + json);
    memcpy(out, "glTF", 4);
    put_word(out + 4, 2);
    put_word(out + 8, (uint32_t)(20 + json));
    put_word(out + 12, (uint32_t)json);
    memcpy(out + 16, "JSON", 4);
    memcpy(out + 20, text->text, text->length);
    return 20 + json;
}

/* The first byte of a seed tells the format; the rest is the file. */
size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    static model_text text;
    if (index > 3 || capacity < 2) {
        return 0;
    }
    if (index == 2) {
        out[0] = (uint8_t)IO_MODEL_OBJ;
        return 1 + fuzz_copy(obj, out + 1, capacity - 1);
    }
    model_write(&text, index == 0 ? &model_plain : &model_textured);
    if (index == 3) {
        out[0] = (uint8_t)IO_MODEL_GLB;
        return 1 + put_glb(&text, out + 1, capacity - 1);
    }
    out[0] = (uint8_t)IO_MODEL_GLTF;
    return 1 + fuzz_copy(text.text, out + 1, capacity - 1);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[4] = {"fuzz.obj", "fuzz.obj", "fuzz.gltf", "fuzz.glb"};
    rlf_model *model = NULL;
    if (size < 2) {
        return 0;
    }
    const io_bytes file = {names[data[0] % 4], data + 1, size - 1};
    rlf_set_log(NULL, NULL);
    if (io_model_import(&file, io_model_format_of(file.name), true, &model) != RLF_OK) {
        return 0;
    }
    for (int32_t i = 0; i < 3 * model->triangle_count; i++) {
        const int32_t corner = model->triangles[i];
        if (corner < 0 || corner >= model->vertex_count || !(model->radius < 1e8)) {
            abort();
        }
    }
    rlf_model_destroy(&model);
    return 0;
}
