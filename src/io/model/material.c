/* Colour and texture of imported materials. */
#include "io/model/import.h"
#include "io/model/beside.h"
#include "io/picture/picture.h"

#include <stdlib.h>
#include <string.h>

/* Of all textures before they are made smaller: 32 of the largest size that is kept. */
#define PIXELS_MAX ((int64_t)32 * RLF_MODEL_TEXTURE_MAX * RLF_MODEL_TEXTURE_MAX)

/* IEC 61966-2-1. */
static float srgb_of_linear(float linear)
{
    double x = rlf_clamp((double)linear, 0.0, 1.0);
    return (float)(x <= 0.0031308 ? 12.92 * x : 1.055 * rlf_exp(rlf_log_e(x) / 2.4) - 0.055);
}

static float share_of(float x)
{
    return x >= 0.0f && x <= 1.0f ? x : 1.0f;
}

static void read_color(const io_model_draft *d, const struct aiMaterial *material, float out[3])
{
    struct aiString name;
    struct aiColor4D c = {1.0f, 1.0f, 1.0f, 1.0f};
    out[0] = out[1] = out[2] = 1.0f;
    if (d->format != IO_MODEL_OBJ) {
        (void)aiGetMaterialColor(material, AI_MATKEY_BASE_COLOR, &c);
        out[0] = srgb_of_linear(share_of(c.r));
        out[1] = srgb_of_linear(share_of(c.g));
        out[2] = srgb_of_linear(share_of(c.b));
        return;
    }
    bool is_made_up = aiGetMaterialString(material, AI_MATKEY_NAME, &name) == aiReturn_SUCCESS &&
                      strcmp(name.data, AI_DEFAULT_MATERIAL_NAME) == 0;
    if (!is_made_up) {
        (void)aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &c);
        out[0] = share_of(c.r);
        out[1] = share_of(c.g);
        out[2] = share_of(c.b);
    }
}

bool io_model_is_two_sided(const io_model_draft *d, const struct aiMesh *mesh)
{
    int is_two_sided = 0;
    unsigned max = 1;
    if (d->format == IO_MODEL_OBJ || mesh->mMaterialIndex >= d->scene->mNumMaterials) {
        return false;
    }
    const struct aiMaterial *material = d->scene->mMaterials[mesh->mMaterialIndex];
    return aiGetMaterialIntegerArray(material, AI_MATKEY_TWOSIDED, &is_two_sided, &max) ==
               aiReturn_SUCCESS &&
           is_two_sided != 0;
}

/* Pictures inside the file are called "*0", "*1", ... */
static rlf_result decode_embedded(const io_model_draft *d, const char *name, io_picture *picture)
{
    char *end = NULL;
    long index = strtol(name + 1, &end, 10);
    if (*end != '\0' || index < 0 || index >= (long)d->scene->mNumTextures ||
        d->scene->mTextures[index]->mHeight != 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: no PNG or JPEG of that name in the file", name);
    }
    const struct aiTexture *texture = d->scene->mTextures[index];
    io_bytes bytes = {name, (const uint8_t *)texture->pcData, texture->mWidth};
    return io_picture_decode(&bytes, picture);
}

static rlf_result decode_file(const io_model_draft *d, const char *name, io_picture *picture)
{
    if (d->is_alone) {
        return rlf_fail(RLF_ERROR_IO, "%s: other files are not read", name);
    }
    char path[IO_PATH_MAX], real[IO_PATH_MAX];
    char folder[IO_PATH_MAX] = ".";
    const char *slash = strrchr(d->name, '/');
    if (slash != NULL && (size_t)(slash - d->name) + 1 < IO_PATH_MAX) {
        memcpy(folder, d->name, (size_t)(slash - d->name) + 1);
        folder[slash - d->name + 1] = '\0';
    }
    io_buffer buffer = {0};
    io_bytes bytes;
    rlf_result result = io_path_join(folder, name, path);
    if (result == RLF_OK) {
        result = io_model_beside(d->name, path, real);
    }
    if (result == RLF_OK) {
        result = io_file_read(real, IO_MODEL_FILE_MAX, "put it beside the model", &buffer, &bytes);
    }
    if (result == RLF_OK) {
        result = io_picture_decode(&bytes, picture);
    }
    io_buffer_free(&buffer);
    return result;
}

/* *out is the index of the texture of that name, which is decoded when it is new; -1 = it cannot be
 * had, which was warned of. */
static rlf_result find_texture(io_model_draft *d, const char *name, int32_t *out)
{
    *out = -1;
    for (int32_t i = 0; i < d->slot_count; i++) {
        if (strcmp(d->image_names[i], name) == 0) {
            *out = d->image_slot[i];
            return RLF_OK;
        }
    }
    if (d->slot_count == RLF_MODEL_TEXTURES_MAX || strlen(name) >= sizeof(d->image_names[0])) {
        rlf_log(RLF_LOG_WARNING, "%s: more than %d textures: the others are left out", d->name,
                RLF_MODEL_TEXTURES_MAX);
        return RLF_OK;
    }
    int32_t slot = d->slot_count++;
    (void)snprintf(d->image_names[slot], sizeof(d->image_names[slot]), "%s", name);
    d->image_slot[slot] = -1;
    io_picture picture = {.size_max = RLF_MODEL_IMAGE_MAX,
                          .pixels_max = PIXELS_MAX + 1 - d->pixels};
    rlf_result result =
        name[0] == '*' ? decode_embedded(d, name, &picture) : decode_file(d, name, &picture);
    if (result != RLF_OK) {
        if (result != RLF_ERROR_MEMORY) {
            rlf_log(RLF_LOG_WARNING, "%s: its texture is left out: %s", d->name, rlf_error_text());
        }
        return result == RLF_ERROR_MEMORY ? result : RLF_OK;
    }
    d->pixels += (int64_t)picture.width * picture.height;
    d->images[d->image_count] = (rlf_image_rgba8){picture.data, picture.width, picture.height,
                                                  4 * (ptrdiff_t)picture.width};
    *out = d->image_slot[slot] = d->image_count++;
    return RLF_OK;
}

rlf_result io_model_material(io_model_draft *draft, const struct aiMaterial *material,
                             rlf_model_part *out)
{
    struct aiString path;
    read_color(draft, material, out->color);
    bool has_texture = aiGetMaterialTexture(material, aiTextureType_BASE_COLOR, 0, &path, NULL,
                                            NULL, NULL, NULL, NULL, NULL) == aiReturn_SUCCESS ||
                       aiGetMaterialTexture(material, aiTextureType_DIFFUSE, 0, &path, NULL, NULL,
                                            NULL, NULL, NULL, NULL) == aiReturn_SUCCESS;
    out->texture = -1;
    return has_texture && path.length > 0 ? find_texture(draft, path.data, &out->texture) : RLF_OK;
}
